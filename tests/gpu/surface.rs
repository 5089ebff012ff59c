//! Whole batches: the units whose patches have lists, from clip to emit, against the first
//! implementation's blocks one after another; and a batch that is cut into small pieces.

use crate::batch::{Division, Expected};
use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use rtl_model::backface::{self, Verdict};
use rtl_model::emit::{self, Screen};
use rtl_model::evaluate::{self, Evaluate};
use rtl_model::level::{self, Criterion, Events, State};
use rtl_model::patch::{Level, Patch, View};
use rtl_model::{clip, number};
use std::collections::HashMap;
use tessim::config::{BackfaceMethod, Config, Normals, Scheme, Termination, Union, Unit};
use tessim::gpu::surface::{Source, Surface, surface};
use tessim::gpu::{Backend, Device, Made, Name, Settings, push_patch};
use tessim::study::check::Ledger;

const UNITS: [Unit; 4] = [Unit::Hybrid, Unit::Triangles, Unit::Moreton, Unit::Sfarti];

/// A batch, and what decides what becomes of it.
struct Batch {
    config: Config,
    view: View,
    patches: Vec<(Patch, State)>,
    /// What levels are chosen from.
    seen: Vec<(Patch, State)>,
    components: Vec<u32>,
}

fn state(random: &mut Random, most: u32) -> State {
    let pixels = random.octaves(2000.0, 1e7) as u32;
    let level = Level::clamped(random.integer(1 << 16, most << 16).into());
    let criterion = match random.integer(0, 2) {
        0 => Criterion::Flatness { pixels },
        1 => Criterion::EdgeLength { pixels },
        _ => Criterion::Fixed { level },
    };
    State { criterion, min: Level::MIN, max: Level::clamped(u64::from(most) << 16) }
}

impl Batch {
    fn draw(random: &mut Random, unit: Unit, width: u32, count: usize, most: u32) -> Self {
        let mut config = Config { unit, ..Config::default() };
        config.position.width = width;
        config.position.overflow = random.of(number::Overflow::ALL);
        config.evaluate.rounding = random.of(number::Rounding::ALL);
        config.evaluate.scheme = random.of([Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau]);
        config.evaluate.normals = random.of([Normals::Off, Normals::TangentPlane]);
        config.level.termination = random.of([Termination::EightCurves, Termination::Bounded]);
        config.emit.rounding = random.of(number::Rounding::ALL);
        config.emit.divide = random.integer(0, 7) > 0;
        config.backface.method = random.of([BackfaceMethod::Off, BackfaceMethod::NetFacets]);
        let view = support::view(width);
        let mut draw = || {
            let kind = random.of(Kind::ALL);
            (random::patch(random, kind, view.position.max()), state(random, most))
        };
        let patches: Vec<_> = (0..count).map(|_| draw()).collect();
        let seen = patches.iter().map(|&(_, state)| (draw().0, state)).collect();
        let components = (0..count as u32).map(|k| k % 7).collect();
        Self { config, view, patches, seen, components }
    }

    fn run(&self, device: &Device) -> Made {
        let flat = |patches: &[(Patch, State)]| {
            let mut words = Vec::new();
            patches.iter().for_each(|(patch, s)| push_patch(&mut words, patch, coded(s), [0; 3]));
            words
        };
        let (patches, seen) = (flat(&self.patches), flat(&self.seen));
        let work = Surface {
            config: &self.config,
            settings: Settings::new(&self.config, &self.view, self.view.position),
            patches: &patches,
            seen: (self.config.unit == Unit::Moreton).then_some(&seen),
            components: &self.components,
        };
        surface(device, &work).unwrap()
    }
}

/// The words of a tessellation state.
fn coded(state: &State) -> [u32; 4] {
    let [criterion, number] = match state.criterion {
        Criterion::Flatness { pixels } => [0, pixels],
        Criterion::EdgeLength { pixels } => [1, pixels],
        Criterion::Fixed { level } => [2, level.fx16()],
    };
    [criterion, number, state.min.fx16(), state.max.fx16()]
}

/// What the first implementation makes of a batch, and counts.
#[derive(Default)]
struct Reference {
    patches: Vec<Option<Expected>>,
    screen: Vec<Vec<Screen>>,
    counts: HashMap<Name, u64>,
}

impl Reference {
    fn of(batch: &Batch) -> Self {
        let config = &batch.config;
        let mut evaluate = Evaluate::new(evaluate::Settings {
            position: batch.view.position,
            guard: config.guard(),
            scheme: config.scheme(),
            rounding: config.evaluate.rounding,
            overflow: config.position.overflow,
        });
        let mut all = Self::default();
        for (k, (patch, state)) in batch.patches.iter().enumerate() {
            let kept = config.unit == Unit::Moreton || all.keeps(batch, patch);
            let made = kept.then(|| {
                let seen = if config.unit == Unit::Moreton { &batch.seen[k].0 } else { patch };
                let (division, events) = divide(batch, seen, state);
                all.count_levels(state, events);
                let source = match config.unit {
                    Unit::Moreton => Source::EdgeLevels,
                    _ => Source::Levels,
                };
                division.expected(source, patch, &mut evaluate)
            });
            let mut screen = Vec::new();
            if let Some(made) = &made {
                all.count(batch, patch, made, batch.components[k]);
                if config.divides() {
                    let own = emit::Settings {
                        subpixel_bits: config.emit.subpixel_bits,
                        rounding: config.emit.rounding,
                    };
                    let left = emit::accept(&made.vertices, &batch.view, own, &mut screen);
                    all.add("emit", "vertices.to_clipper", left);
                }
            }
            all.patches.push(made);
            all.screen.push(screen);
        }
        all
    }

    fn add(&mut self, block: &'static str, name: &'static str, n: u64) {
        *self.counts.entry((block, name)).or_default() += n;
    }

    fn keeps(&mut self, batch: &Batch, patch: &Patch) -> bool {
        self.add("clip", "patches.in", 1);
        if batch.config.clip.enabled && clip::outside(patch, batch.view.depth) {
            self.add("clip", "patches.culled", 1);
            return false;
        }
        let (verdict, facets) = backface::accept(patch, &batch.view, batch.config.backface.method);
        self.add("backface", "patches.in", 1);
        self.add("backface", "patches.tested", u64::from(verdict != Verdict::Untested));
        self.add("backface", "facets.tested", facets.into());
        self.add("backface", "patches.culled", u64::from(verdict == Verdict::Culled));
        verdict != Verdict::Culled
    }

    fn count_levels(&mut self, state: &State, events: Events) {
        self.add("level", "patches", 1);
        let [criterion, ..] = coded(state);
        self.add("level", "patches.flatness", u64::from(criterion == 0));
        self.add("level", "patches.edge_length", u64::from(criterion == 1));
        self.add("level", "splits", events.splits.into());
        self.add("level", "levels.clamped", events.clamped.into());
        self.add("level", "edges.near", events.near.into());
        self.add("level", "overflows", events.overflows.into());
    }

    fn count(&mut self, batch: &Batch, patch: &Patch, made: &Expected, components: u32) {
        let (config, components) = (&batch.config, u64::from(components));
        let (vertices, triangles) = (made.vertices.len() as u64, made.triangles.len() as u64);
        let attributes = components * vertices * config.attributes.component_bytes();
        let indices = 3 * triangles * u64::from(config.emit.index_bytes);
        let bytes = vertices * u64::from(config.emit.vertex_bytes) + attributes + indices;
        let shader = &config.vertex_shader;
        let mut bytes_in = u64::from(shader.bytes_in);
        if config.evaluate.normals == Normals::TangentPlane {
            bytes_in += u64::from(shader.bytes_in_normal);
            let plane = |v: &rtl_model::patch::Vertex| evaluate::tangent_plane(patch, v.u, v.v);
            let none = made.vertices.iter().filter(|v| plane(v) == [0; 4]).count();
            self.add("evaluate", "normals", vertices);
            self.add("evaluate", "normals.degenerate", none as u64);
        }
        for (block, name, n) in [
            ("place", "reciprocals", made.reciprocals.into()),
            ("place", "parameters", made.parameters as u64),
            ("evaluate", "invocations", made.cost.invocations),
            ("evaluate", "vertices", vertices),
            ("evaluate", "strips", made.strips as u64),
            ("evaluate", "curves", made.cost.curves),
            ("evaluate", "steps", made.cost.steps),
            ("evaluate", "overflows", made.cost.overflows),
            ("evaluate", "attributes", components * vertices),
            ("stitch", "triangles", triangles),
            ("stitch", "triangles.degenerate", made.degenerate),
            ("emit", "vertices", vertices),
            ("emit", "triangles", triangles),
            ("emit", "bytes.attributes", attributes),
            ("emit", "bytes", bytes),
            ("vertex_shader", "invocations", vertices),
            ("vertex_shader", "bytes.in", vertices * bytes_in + attributes),
            ("vertex_shader", "bytes.out", vertices * u64::from(shader.bytes_out)),
        ] {
            self.add(block, name, n);
        }
    }

    fn compare(&self, ledger: &mut Ledger, batch: &Batch, made: &Made) {
        let place = |k: usize| {
            format!("patch {k}, {} bits, {:?}", batch.view.position.width, batch.config.unit)
        };
        for (k, want) in self.patches.iter().enumerate() {
            let within = |words: &[u32], starts: &[u32], each: usize| {
                let [first, end] = [starts[k], starts[k + 1]].map(|n| each * n as usize);
                words.get(first..end).unwrap_or_default().to_vec()
            };
            let [vertices, triangles] = [&made.vertex_starts, &made.triangle_starts];
            let screen: Vec<u32> = self.screen[k]
                .iter()
                .flat_map(|s| [s.x as u32, s.y as u32, s.divided.into()])
                .collect();
            let none = Expected::default();
            let want = want.as_ref().unwrap_or(&none);
            for (what, want, got) in [
                ("vertices", want.vertex_words(), within(&made.vertices, vertices, 10)),
                ("triangles", want.triangle_words(), within(&made.triangles, triangles, 3)),
                ("screen", screen, within(&made.screen, vertices, 3)),
            ] {
                let inputs = || format!("{:?}", batch.patches[k].1);
                ledger.compare(("surface", what), &want, &got, || place(k), inputs);
            }
        }
        let got: HashMap<_, _> = made.counts.iter().copied().collect();
        assert_eq!(got.len(), made.counts.len(), "counters are counted once");
        let all = self.counts.keys().chain(got.keys()).collect::<std::collections::HashSet<_>>();
        for name in all {
            let words = |counts: &HashMap<Name, u64>| {
                let n = counts.get(name).copied().unwrap_or(0);
                vec![n as u32, (n >> 32) as u32]
            };
            let (want, got) = (words(&self.counts), words(&got));
            let inputs = || format!("{:?}", batch.config.evaluate);
            ledger.compare(("surface", "counts"), &want, &got, || format!("{name:?}"), inputs);
        }
    }
}

fn divide(batch: &Batch, seen: &Patch, state: &State) -> (Division, Events) {
    if batch.config.unit == Unit::Sfarti {
        let termination = batch.config.level.termination;
        let (lists, events) = level::subdivide(seen, &batch.view, state, termination);
        return (Division::Dyadic(lists), events);
    }
    let (levels, events) = level::accept(seen, &batch.view, state);
    (Division::Fractional(levels), events)
}

#[test]
fn batches_come_out_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(78);
    for width in 8..=48 {
        for _ in 0..support::effort() {
            let unit = UNITS[width as usize % 4];
            let batch = Batch::draw(&mut random, unit, width, 40, 12);
            let made = batch.run(device);
            Reference::of(&batch).compare(&mut ledger, &batch, &made);
        }
    }
    support::settle(&ledger, Quantity::KernelUnitRandom);
}

#[test]
fn a_batch_in_pieces_is_the_same() {
    if support::device().is_none() {
        return;
    }
    let mut small = Device::open(Backend::Auto, support::sources()).unwrap();
    // A patch of level 16 has a mesh of some 5000 words.
    small.limit_words(12_000);
    let mut random = Random::new(79);
    for unit in UNITS {
        let batch = Batch::draw(&mut random, unit, 32, 200, 16);
        let whole = batch.run(support::device().unwrap());
        assert!(whole.vertices.len() > 100_000, "more than fits in a piece");
        assert!(batch.run(&small) == whole, "{unit:?}: pieces differ from the whole");
    }
}

#[test]
fn what_has_no_kernels_is_an_error_that_says_so() {
    let Some(device) = support::device() else { return };
    let mut random = Random::new(80);
    let mut batch = Batch::draw(&mut random, Unit::Sfarti, 32, 1, 4);
    batch.config.level.union = Union::Primitive;
    let settings = Settings::new(&batch.config, &batch.view, batch.view.position);
    let refused = |config: &Config| {
        let work = Surface { config, settings, patches: &[], seen: None, components: &[] };
        surface(device, &work).unwrap_err().to_string()
    };
    assert!(refused(&batch.config).contains("level.union"));
    batch.config.unit = Unit::Esc;
    assert!(refused(&batch.config).contains("esc"));
}
