//! The surface-level shader: levels, vertices, triangles and counts of random patches, on every
//! width, under every policy.

use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use rtl_model::esc::resolution::{self, Policy, Resolution};
use rtl_model::esc::{Input, Settings as Shader, Surface, Threshold};
use rtl_model::level::{Criterion, State};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, Level, ONE, Patch, Point, View};
use rtl_model::{clip, stitch};
use tessim::config::{
    Boundary, Config, ControlMesh, LevelPolicy, LevelScope, Normals, Overflow, Reuse, Rounding,
    Space, Unit,
};
use tessim::gpu::{Backend, Device, Esc, Made, Settings, decide, esc, push_patch, words};
use tessim::study::check::Ledger;

mod corners;
mod expected;

use expected::{Expected, is_kept, threshold};

/// Patches of a batch, and what both are told of them.
pub(crate) struct Batch {
    config: Config,
    view: View,
    object_format: Format,
    patches: Vec<Patch>,
    states: Vec<State>,
    objects: Vec<[Point; 16]>,
    /// The driver's levels, where it chooses.
    given: Option<Vec<u32>>,
    components: Vec<u32>,
}

/// The words of a batch.
struct Flat {
    patches: Vec<u32>,
    objects: Vec<u32>,
}

impl Batch {
    fn flat(&self) -> Flat {
        let mut patches = Vec::new();
        for (patch, state) in self.patches.iter().zip(&self.states) {
            let (criterion, number) = match state.criterion {
                Criterion::Flatness { pixels } => (0, pixels),
                Criterion::EdgeLength { pixels } => (1, pixels),
                Criterion::Fixed { level } => (2, level.fx16()),
            };
            let state = [criterion, number, state.min.fx16(), state.max.fx16()];
            push_patch(&mut patches, patch, state, [0; 3]);
        }
        let coordinates = self.objects.iter().flatten().flatten();
        Flat { patches, objects: coordinates.flat_map(|&c| words(c)).collect() }
    }

    fn work<'a>(&'a self, flat: &'a Flat) -> Esc<'a> {
        Esc {
            config: &self.config,
            settings: Settings::new(&self.config, &self.view, self.view.position),
            position: self.view.position,
            object_format: self.object_format,
            patches: &flat.patches,
            object: self.config.esc.tests_in_object_space().then_some(&flat.objects),
            object_levels: self.given.as_deref(),
            components: &self.components,
        }
    }

    fn describe(&self, at: usize) -> String {
        let Config { esc, position, evaluate, .. } = &self.config;
        format!(
            "{:?} {:?} {:?} {esc:?} {:?} {:x?}",
            position.width,
            position.overflow,
            evaluate.rounding,
            self.states.get(at),
            self.patches.get(at).map(|patch| patch.points)
        )
    }
}

/// A batch of `count` patches under random settings.
fn draw(random: &mut Random, width: u32, count: usize) -> Batch {
    let config = configuration(random, width);
    config.check().expect("a configuration that serves");
    let view = View {
        depth: random.of([Depth::ZeroToOne, Depth::MinusOneToOne]),
        viewport: random.of([[1280, 1024], [1, 16384], [333, 77]]),
        near: random.of([0, 1, 1 << (width - 4)]),
        position: Format::of_range(width, random.integer(0, 5) as i32),
        ..support::view(width)
    };
    let object_format = Format::of_range(width, random.integer(0, 4) as i32);
    let patches: Vec<_> = (0..count).map(|_| patch(random, view.position.max())).collect();
    let one = (1_i64 << object_format.fraction).min(object_format.max());
    let objects = (0..count)
        .map(|_| {
            let kind = random.of([Kind::Wild, Kind::Sheet, Kind::Sheet]);
            let mut points = random::patch(random, kind, object_format.max()).points;
            if random.integer(0, 9) == 0 {
                points = at_the_end(random, object_format.max());
            }
            let affine = random.integer(0, 2) > 0;
            points.map(|[x, y, z, w]| [x, y, z, if affine { one } else { w }])
        })
        .collect();
    let given = (config.esc.scope == LevelScope::Object)
        .then(|| (0..count).map(|_| random.integer(0, config.esc.level_max + 1)).collect());
    Batch {
        states: (0..count).map(|_| state(random)).collect(),
        components: (0..count).map(|_| random.integer(0, 9)).collect(),
        config,
        view,
        object_format,
        patches,
        objects,
        given,
    }
}

/// A patch, in some cases wholly outside.
fn patch(random: &mut Random, max: i64) -> Patch {
    let kind = random.of(Kind::ALL);
    let mut patch = random::patch(random, kind, max);
    // Most of the random ones have their backs turned.
    patch.cull = random.integer(0, 4) == 0;
    if random.integer(0, 9) == 0 {
        patch.points = patch.points.map(|[_, y, z, w]| [(w + 1).min(max), y, z, w]);
    }
    if random.integer(0, 9) == 0 {
        patch.points = at_the_end(random, max);
    }
    patch
}

/// At the end of the range, beyond which roundings go.
fn at_the_end(random: &mut Random, max: i64) -> [Point; 16] {
    [(); 16].map(|()| [(); 4].map(|()| max - i64::from(random.integer(0, 3))))
}

/// A tessellation state; a level of 1, between 1 and 2, 2, and others.
fn state(random: &mut Random) -> State {
    let level = |random: &mut Random| {
        let any = random.integer(ONE, 60 * ONE);
        Level::clamped(random.of([ONE, ONE + 1, 2 * ONE, 3 * ONE, 6 * ONE, any]).into())
    };
    let pixels = random.octaves(0.01, 3000.0) * 65536.0;
    let pixels = random.of([pixels as u32, 1 << 16, 1]);
    let criterion = match random.integer(0, 4) {
        0 | 1 => Criterion::Flatness { pixels },
        2 | 3 => Criterion::EdgeLength { pixels },
        _ => Criterion::Fixed { level: level(random) },
    };
    let (a, b) = (level(random), level(random));
    let greatest = random.of([Level::MAX, a.max(b)]);
    State { criterion, min: random.of([Level::MIN, a.min(b)]), max: greatest }
}

fn configuration(random: &mut Random, width: u32) -> Config {
    let mut config = Config { unit: Unit::Esc, ..Config::default() };
    config.position.width = width;
    config.position.overflow = random.of(Overflow::ALL);
    config.evaluate.rounding = random.of(Rounding::ALL);
    config.evaluate.normals = random.of([Normals::Off, Normals::TangentPlane]);
    config.clip.enabled = random.integer(0, 2) == 0;
    let esc = &mut config.esc;
    esc.level = random.of([
        LevelPolicy::Criterion,
        LevelPolicy::Criterion,
        LevelPolicy::Fixed,
        LevelPolicy::Distance,
        LevelPolicy::ScreenSize,
    ]);
    if esc.level != LevelPolicy::Criterion {
        esc.scope = random.of([LevelScope::Patch, LevelScope::Patch, LevelScope::Object]);
    }
    let any = random.integer(0, 15);
    esc.level_max = random.of([0, 1, 3, 7, 15, any]);
    esc.fixed_level = random.integer(0, esc.level_max);
    esc.full_distance = random.octaves(0.001, 4.0);
    esc.full_pixels = random.octaves(0.1, 4000.0);
    esc.control_mesh = random.of(ControlMesh::ALL);
    esc.space = random.of([Space::Pixels, Space::Pixels, Space::Object]);
    let mu = match esc.space {
        Space::Pixels => random.octaves(0.01, 500.0),
        Space::Object => random.octaves(1e-4, 0.5),
    };
    esc.mu = random.of([0.0, mu, mu, 65535.0, 1e-9]);
    esc.boundary = random.of([Boundary::Symmetric, Boundary::Symmetric, Boundary::Plain]);
    esc.reuse = random.of(Reuse::ALL);
    let room = Shader::guard_max(width);
    let guard = random.integer(0, room);
    esc.guard = random.of([0, room, guard]);
    let bits = random.integer(16, 46);
    esc.parameter_bits = random.of([16, 46, 40, bits]);
    esc.bytes_out = random.of([4, 16, 32]);
    let longest = 2 * esc.level_max + 3;
    let more = random.integer(0, 3 * longest * longest);
    let values = esc.bytes_out / 4 * (longest + random.of([0, more]));
    esc.output_values = random.of([None, None, Some(values)]);
    config
}

#[test]
fn surfaces_are_tessellated_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(2014);
    for width in 8..=48 {
        for _ in 0..3 * support::effort() {
            let batch = draw(&mut random, width, 5);
            compare(&mut ledger, device, &batch);
        }
    }
    support::settle(&ledger, Quantity::KernelEscRandom);
}

/// As shipped: what most runs have.
#[test]
fn surfaces_of_the_default_configuration_are_tessellated_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(2015);
    for _ in 0..2 * support::effort() {
        let mut batch = draw(&mut random, 32, 40);
        batch.config = Config { unit: Unit::Esc, ..Config::default() };
        batch.given = None;
        compare(&mut ledger, device, &batch);
    }
    support::settle(&ledger, Quantity::KernelEscRandom);
}

fn compare(ledger: &mut Ledger, device: &Device, batch: &Batch) {
    let flat = batch.flat();
    let work = batch.work(&flat);
    let made = esc(device, &work).unwrap();
    let decided = decide(device, &work).unwrap();
    let expected = Expected::of(batch);
    for (at, want) in expected.patches.iter().enumerate() {
        let mut row = |what, cpu: &[u32], gpu: &[u32]| {
            ledger.compare(
                ("esc", what),
                cpu,
                gpu,
                || format!("patch {at}"),
                || batch.describe(at),
            );
        };
        row("fate", &[want.fate], &made.fates[4 * at..4 * at + 1]);
        let levels = &decided.resolutions[12 * at..12 * at + 8];
        if want.fate == 2 {
            row("levels", &want.levels, levels);
        }
        let inserted: u32 =
            decided.masks[33 * at..33 * at + 33].iter().map(|mask| mask.count_ones()).sum();
        // In one section, every edge is tested once.
        let Config { esc, .. } = &batch.config;
        let once = esc.reuse == Reuse::Patch && esc.output_values.is_none();
        if want.fate == 2 && once && threshold(batch).is_some() {
            row("insertions", &[want.inserted], &[inserted]);
        }
        row("vertices", &want.vertices, slice(&made.vertices, &made.vertex_starts, at, 10));
        row("triangles", &want.triangles, slice(&made.triangles, &made.triangle_starts, at, 3));
    }
    for (name, want) in &expected.counts {
        let got = made.counts.iter().find(|(other, _)| other == name).map(|(_, count)| *count);
        let got: Vec<u32> = got.map_or(Vec::new(), |count| words(count as i64).to_vec());
        let want = words(*want as i64);
        ledger.compare(
            ("esc", "counts"),
            &want,
            &got,
            || format!("{name:?}"),
            || batch.describe(usize::MAX),
        );
    }
    let names: Vec<_> = made.counts.iter().map(|(name, _)| name).collect();
    let other: Vec<_> = expected.counts.iter().map(|(name, _)| name).collect();
    assert_eq!(names, other, "all that is counted");
}

/// A patch's part of a buffer.
fn slice<'a>(words: &'a [u32], starts: &[u32], at: usize, each: usize) -> &'a [u32] {
    &words[each * starts[at] as usize..each * starts[at + 1] as usize]
}

/// On the other interface too.
#[test]
fn surfaces_are_the_same_by_way_of_gl() {
    let Some(device) = support::device() else { return };
    let gl = match support::another(Backend::Gl) {
        Ok(gl) => gl,
        Err(reason) => return println!("SKIPPED the second implementation by way of GL: {reason}"),
    };
    let mut random = Random::new(31);
    for width in [9, 24, 48] {
        let batch = draw(&mut random, width, 6);
        let flat = batch.flat();
        let [a, b] = [device, &gl].map(|device| esc(device, &batch.work(&flat)).unwrap());
        assert!(!a.vertices.is_empty());
        assert_eq!(a, b, "{width} bits");
    }
}

/// However many patches fit the device at a time, the result is the same.
#[test]
fn lots_of_any_size_give_the_same() {
    let Some(device) = support::device() else { return };
    let Ok(mut small) = support::another(Backend::Auto) else { return };
    small.limit_words(60_000);
    let mut random = Random::new(7);
    for width in [16, 40] {
        let mut batch = draw(&mut random, width, 30);
        batch.config.esc.boundary = Boundary::Symmetric;
        let flat = batch.flat();
        let whole = esc(device, &batch.work(&flat)).unwrap();
        let parts: Made = esc(&small, &batch.work(&flat)).unwrap();
        assert!(whole.vertices.len() > 1000);
        assert_eq!(whole, parts);
    }
}
