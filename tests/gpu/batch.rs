//! A batch of random patches with levels or dyadic lists, and the first implementation's blocks
//! behind them, patch by patch.

use crate::random::{self, Kind, Random};
use crate::support;
use rtl_model::evaluate::{self, Cost, Evaluate};
use rtl_model::number::{Overflow, Rounding};
use rtl_model::patch::{Dyadic, Level, Levels, Lists, Patch, Triangle, Vertex};
use rtl_model::place::{DyadicPlacement, Placement};
use rtl_model::stitch;
use rtl_model::strip::Topology;
use tessim::config::{Config, Scheme};
use tessim::gpu::surface::{self, Placed, Placing, Source};
use tessim::gpu::{Buffer, Device, PATCH, Settings, push_patch, words};

/// What a patch is divided by.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Division {
    Fractional(Levels),
    Dyadic(Lists),
}

/// What the first implementation makes of a patch.
#[derive(Default)]
pub(crate) struct Expected {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) cost: Cost,
    pub(crate) strips: usize,
    pub(crate) parameters: usize,
    pub(crate) reciprocals: u32,
    pub(crate) degenerate: u64,
}

/// Patches of one width and one set of policies, all of them in sight.
pub(crate) struct Batch {
    pub(crate) config: Config,
    pub(crate) settings: Settings,
    pub(crate) source: Source,
    pub(crate) patches: Vec<Patch>,
    pub(crate) divisions: Vec<Division>,
    pub(crate) components: Vec<u32>,
}

/// What is uploaded, and the plans.
pub(crate) struct Uploaded {
    pub(crate) patches: Buffer,
    pub(crate) placed: Placed,
}

/// A level: 1, whole, a power of two, just beside one of these, or any to `most`.
fn level(random: &mut Random, most: u32) -> Level {
    let whole = random.integer(1, most) << 16;
    let power = 1 << random.integer(16, 16 + most.ilog2());
    let beside = random.integer(0, 2);
    Level::clamped(match random.integer(0, 9) {
        0 => 1 << 16,
        1 => whole.into(),
        2 => power,
        3 => u64::from(whole + beside) - 1,
        4 => power + u64::from(beside) - 1,
        5 => random.integer(1 << 16, 2 << 16).into(),
        _ => random.integer(1 << 16, most << 16).into(),
    })
}

pub(crate) fn levels(random: &mut Random, most: u32) -> Levels {
    let most = match random.integer(0, 7) {
        0 => 1,
        1 => 2,
        _ => most,
    };
    let uniform = random.integer(0, 3) == 0;
    let one = level(random, most);
    let mut draw = || if uniform { one } else { level(random, most) };
    Levels { edges: std::array::from_fn(|_| draw()), interior: std::array::from_fn(|_| draw()) }
}

/// A list of up to about so many segments: none, equal segments, or any.
fn list(random: &mut Random, most: u32) -> Dyadic {
    match random.integer(0, 5) {
        0 => Dyadic::NONE,
        1 => Dyadic::uniform(random.integer(0, most.ilog2())),
        _ => {
            let mut list = Dyadic::NONE;
            (0..random.integer(1, most)).for_each(|_| list.insert(random.integer(1, 127)));
            list
        }
    }
}

pub(crate) fn lists(random: &mut Random, most: u32) -> Lists {
    let [along_u, along_v] = [random.integer(0, 3) > 0, random.integer(0, 3) > 0];
    let mut draw = |any| if any { list(random, most) } else { Dyadic::NONE };
    let edges = [along_u, along_v, along_u, along_v].map(&mut draw);
    Lists::new(edges, draw(along_u), draw(along_v))
}

impl Batch {
    /// So many patches of this width, levels up to `most`; policies as they come.
    pub(crate) fn draw(
        random: &mut Random,
        width: u32,
        source: Source,
        count: usize,
        most: u32,
    ) -> Self {
        let mut config = Config::default();
        config.position.width = width;
        config.position.overflow = random.of(Overflow::ALL);
        config.evaluate.rounding = random.of(Rounding::ALL);
        config.evaluate.scheme = random.of([Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau]);
        // From the least to the most that fit.
        let guards = [1, 1, random.integer(1, 60 - width), 60 - width, config.guard()];
        config.evaluate.guard = Some(random.of(guards));
        let view = support::view(width);
        let settings = Settings::new(&config, &view, view.position);
        let mut batch = Self {
            config,
            settings,
            source,
            patches: Vec::new(),
            divisions: Vec::new(),
            components: Vec::new(),
        };
        for _ in 0..count {
            let kind = random.of(Kind::ALL);
            let mut patch = random::patch(random, kind, view.position.max());
            // At the ends of the range, where few guard bits let points leave it.
            if random.integer(0, 3) == 0 {
                let signs: [i64; 4] = std::array::from_fn(|_| random.of([-1, 1]));
                let mut near = || view.position.max() - i64::from(random.integer(0, 1));
                let corner = |_: usize| signs.map(|sign| sign * near());
                patch.points = std::array::from_fn(corner);
            }
            batch.patches.push(patch);
            batch.components.push(random.integer(0, 9));
            batch.divisions.push(match source {
                Source::Masks => Division::Dyadic(lists(random, most)),
                _ => Division::Fractional(levels(random, most)),
            });
        }
        batch
    }

    /// The words of all patches.
    pub(crate) fn words(&self) -> Vec<u32> {
        let mut flat = Vec::with_capacity(PATCH * self.patches.len());
        self.patches.iter().for_each(|patch| push_patch(&mut flat, patch, [0; 4], [0; 3]));
        flat
    }

    /// Takes the batch as far as its plans.
    pub(crate) fn place(&self, device: &Device) -> Uploaded {
        let count = self.patches.len();
        let patches = device.upload(&self.words()).unwrap();
        let fates = device.upload(&[2, 0, 0, 0].repeat(count)).unwrap();
        let flat: Vec<u32> = self.divisions.iter().flat_map(Division::words).collect();
        let levels = device.upload(&flat).unwrap();
        let components = device.upload(&self.components).unwrap();
        let work = Placing {
            patches: &patches,
            fates: &fates,
            levels: &levels,
            components: &components,
            source: self.source,
        };
        let placed = surface::place(device, &self.settings.of(count), &work).unwrap();
        Uploaded { patches, placed }
    }

    /// What the first implementation makes of them.
    pub(crate) fn expected(&self) -> Vec<Expected> {
        let mut evaluate = Evaluate::new(evaluate::Settings {
            position: support::view(self.settings.width).position,
            guard: self.config.guard(),
            scheme: self.config.scheme(),
            rounding: self.config.evaluate.rounding,
            overflow: self.config.position.overflow,
        });
        let both = self.patches.iter().zip(&self.divisions);
        both.map(|(patch, division)| division.expected(self.source, patch, &mut evaluate)).collect()
    }
}

impl Division {
    /// As the level block leaves them.
    fn words(&self) -> Vec<u32> {
        match self {
            Self::Fractional(levels) => {
                let all = levels.edges.iter().chain(&levels.interior);
                all.map(|level| level.fx16()).chain([0; 6]).collect()
            }
            Self::Dyadic(lists) => {
                let all = lists.edges().iter().copied().chain([lists.u(), lists.v()]);
                let masks =
                    all.flat_map(|list| (0..4).map(move |k| (list.mask() >> (32 * k)) as u32));
                masks.chain([0; 4]).collect()
            }
        }
    }

    pub(crate) fn expected(
        &self,
        source: Source,
        patch: &Patch,
        evaluate: &mut Evaluate,
    ) -> Expected {
        let mut made = Expected::default();
        match *self {
            Self::Fractional(levels) => {
                let mut placement = Placement::default();
                let [v0, u1, v1, u0] = levels.edges;
                let interior = match source {
                    Source::EdgeLevels => [v0.max(v1), u1.max(u0)],
                    _ => levels.interior,
                };
                placement.set(&Levels { interior, ..levels });
                made.cost = evaluate.accept(patch, &placement, &mut made.vertices);
                made.reciprocals = placement.reciprocals();
                made.join(placement.segments());
            }
            Self::Dyadic(lists) => {
                let mut placement = DyadicPlacement::default();
                placement.set_lists(&lists);
                made.cost = evaluate.accept(patch, &placement, &mut made.vertices);
                made.join(lists);
            }
        }
        made
    }
}

impl Expected {
    fn join(&mut self, lists: impl Topology) {
        stitch::accept(lists, &mut self.triangles);
        let [columns, rows] = lists.interior();
        self.strips = lists.strip_count();
        self.parameters = lists.boundary() + columns + rows;
        self.degenerate = stitch::degenerate(&self.vertices, &self.triangles);
    }

    pub(crate) fn vertex_words(&self) -> Vec<u32> {
        let of = |v: &Vertex| {
            let position = v.position.iter().flat_map(|&c| words(c));
            position.chain([v.u, v.v]).collect::<Vec<_>>()
        };
        self.vertices.iter().flat_map(of).collect()
    }

    pub(crate) fn triangle_words(&self) -> Vec<u32> {
        self.triangles.iter().flatten().map(|&k| k.into()).collect()
    }
}
