//! Samples: where the tokens come from. Seeds are constants, so a run always compares the same
//! items.

use super::blocks;
use super::dyadic;
use super::insertions;
use super::ledger::Ledger;
use super::levels;
use super::patterns;
use super::planes::{self, Source};
use super::random::{Kind, Random, patch};
use super::resolutions;
use super::shaders;
use super::surfaces;
use super::table::{At, Quantity as Q};
use super::walk;
use glam::{DMat4, DVec3};
use rtl_model::assemble::{FanEncoding, Primitive};
use rtl_model::emit;
use rtl_model::evaluate::Settings;
use rtl_model::level::{Criterion, State, Termination};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Dyadic, Level, Levels, Lists, Patch, Vertex, View};
use rtl_model::place::Numbering;
use tessim::config::{Config, Scheme};
use tessim::golden::{Real, control_point};

const SCHEMES: [Scheme; 3] = [Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau];

/// All blocks on random tokens; `scale` multiplies their number.
pub(crate) fn random(ledger: &mut Ledger, scale: u32) {
    let mut random = Random::new(0x7e55_1a7e);
    for _ in 0..40_000 * scale {
        port(ledger, &mut random);
    }
    for rows in 1..8 {
        let count = rows.into();
        blocks::assemble(ledger, Primitive::Patches { count });
        blocks::assemble(ledger, Primitive::Strip { count });
        for encoding in [FanEncoding::Compact, FanEncoding::Full] {
            blocks::assemble(ledger, Primitive::Fan { count, encoding });
        }
        for columns in 1..10 {
            blocks::assemble(ledger, Primitive::Mesh { rows, columns });
        }
    }
    for entries in [0, 1, 3, 16, 32, 100] {
        for _ in 0..10 * scale {
            let range = random.of([4, 30, 200]);
            let indices: Vec<u32> = (0..500).map(|_| random.integer(0, range)).collect();
            blocks::cache(ledger, &indices, entries);
        }
    }
    for _ in 0..20_000 * scale {
        let bits = random.integer(1, 45);
        let corners = [0; 4].map(|_: i64| random.bits() as i64 >> (64 - bits));
        let at = [0; 2].map(|_: u32| random.integer(0, 65536));
        blocks::attribute(ledger, corners, at, random.of(Rounding::ALL));
    }
    for k in 0..2_800 * scale {
        culling_and_levels(ledger, &mut random, Kind::ALL[k as usize % 7]);
    }
    for k in 0..2_400 * scale {
        surface(ledger, &mut random, Kind::ALL[k as usize % 7]);
    }
    for k in 0..2_800 * scale {
        subdivision(ledger, &mut random, Kind::ALL[k as usize % 7]);
    }
    for _ in 0..2_000 * scale {
        screen(ledger, &mut random);
    }
    for _ in 0..600 * scale {
        planes(ledger, &mut random);
    }
    for _ in 0..10_000 * scale {
        patterns::compare(ledger, &mut random);
    }
    for _ in 0..4_000 * scale {
        shaders::random(ledger, &mut random);
    }
    for k in 0..8_400 * scale {
        resolutions::random(ledger, &mut random, Kind::ALL[k as usize % 7]);
    }
    insertions::all(ledger);
    for _ in 0..10_000 * scale {
        insertions::random(ledger, &mut random);
    }
    for _ in 0..1_500 * scale {
        let width = random.integer(8, 48);
        let view = view(&mut random, width);
        surfaces::random(ledger, &mut random, &view);
    }
}

fn port(ledger: &mut Ledger, random: &mut Random) {
    let format = Format::of_range(random.integer(2, 48), random.integer(0, 20) as i32 - 6);
    let size = 2f64.powi(format.width as i32 - format.fraction);
    let value = match random.integer(0, 3) {
        0 => f32::from_bits(random.bits() as u32), // all encodings, with NaNs and subnormals
        1 => (random.real(-1.5, 1.5) * size) as f32,
        // Ties, and the ends of the range.
        2 => ((random.real(-1.0, 1.0) * 1000.0).floor() + 0.5) as f32 * 2f32.powi(-format.fraction),
        _ => (random.of([-0.5, 0.5]) * size) as f32 * random.of([1.0, 1.0 - f32::EPSILON]),
    };
    let modes = (random.of(Rounding::ALL), random.of(Overflow::ALL));
    blocks::port(ledger, value, format, modes);
}

pub(crate) fn view(random: &mut Random, width: u32) -> View {
    let position = Format::of_range(width, 0);
    View {
        position,
        viewport: [random.integer(1, 4096), random.integer(1, 16384)],
        depth: random.of([Depth::ZeroToOne, Depth::MinusOneToOne]),
        near: (position.max() as f64 * random.real(0.0, 0.5)) as i64,
        facing: random.of([-1, 1]),
    }
}

fn level(random: &mut Random) -> Level {
    Level::clamped(match random.integer(0, 5) {
        0 => u64::from(random.integer(1, 12)) << 16,
        1 => (u64::from(random.integer(1, 64)) << 17) + u64::from(random.integer(0, 8)) - 4,
        2 => random.real(65536.0, 131_072.0) as u64,
        3 => 65536,
        _ => (65536.0 * random.octaves(1.0, 128.0)) as u64,
    })
}

pub(crate) fn state(random: &mut Random) -> State {
    let (a, b) = (level(random), level(random));
    let (min, max) = match random.integer(0, 3) {
        0 => (a.min(b), a.max(b)),
        _ => (Level::MIN, Level::MAX),
    };
    let pixels = (random.octaves(2f64.powi(-16), 32.0) * 65536.0) as u32;
    let criterion = match random.integer(0, 6) {
        0 => Criterion::Fixed { level: level(random) },
        1 | 2 => Criterion::EdgeLength { pixels },
        _ => Criterion::Flatness { pixels },
    };
    State { criterion, min, max }
}

fn culling_and_levels(ledger: &mut Ledger, random: &mut Random, kind: Kind) {
    let width = random.integer(8, 48);
    let mut view = view(random, width);
    let mut patch = patch(random, kind, view.position.max());
    if random.bits() & 3 == 0 {
        view.near = random.of(patch.points)[3].max(0); // a point exactly on the threshold
    }
    patch.cull = random.integer(0, 15) > 0;
    patch.saturated = random.integer(0, 15) == 0;
    blocks::backface(ledger, &patch, &view);
    levels::level(ledger, &patch, &view, &state(random));
    // Pushed towards a plane of the clip volume, so that both verdicts occur.
    for _ in 0..2 {
        let (axis, by) = (random.integer(0, 2) as usize, random.real(-1.2, 1.2));
        let max = view.position.max();
        for p in &mut patch.points {
            p[axis] = (p[axis] + (by * max as f64) as i64).clamp(-max, max);
        }
        blocks::clip(ledger, &patch, &view);
        levels::level(ledger, &patch, &view, &state(random));
    }
}

fn settings(random: &mut Random) -> Settings {
    let width = random.integer(8, 48);
    Settings {
        position: Format::of_range(width, 0),
        guard: random.integer(6, 28).min(60 - width),
        scheme: random.of(SCHEMES),
        rounding: random.of(Rounding::ALL),
        overflow: random.of(Overflow::ALL),
    }
}

fn surface(ledger: &mut Ledger, random: &mut Random, kind: Kind) {
    let settings = settings(random);
    let patch = patch(random, kind, settings.position.max());
    let most = random.of([Level::MAX, Level::MAX, Level::MAX, Level::clamped(131_071)]);
    let levels = Levels {
        edges: [(); 4].map(|()| level(random).min(most)),
        interior: [(); 2].map(|()| level(random).min(most)),
    };
    let view = view(random, settings.position.width);
    let emit =
        emit::Settings { subpixel_bits: random.integer(0, 12), rounding: random.of(Rounding::ALL) };
    let reciprocal_bits = random.of([32, 32, 32, 24, 16, 12, 8]);
    pipeline(ledger, &patch, &view, &(levels, reciprocal_bits), settings, emit);
}

/// All blocks of a unit that divides at midpoints: on the lists that it chooses, and on any.
fn subdivision(ledger: &mut Ledger, random: &mut Random, kind: Kind) {
    let settings = Settings { scheme: Scheme::DeCasteljau, ..settings(random) };
    let view = view(random, settings.position.width);
    let patch = patch(random, kind, view.position.max());
    let emit =
        emit::Settings { subpixel_bits: random.integer(0, 12), rounding: random.of(Rounding::ALL) };
    let termination = random.of([Termination::EightCurves, Termination::Bounded]);
    let chosen = dyadic::level(ledger, &patch, &view, &state(random), termination);
    let mut list = || {
        let many = |random: &mut Random| {
            u128::from(random.bits() & random.bits()) << 64 | u128::from(random.bits())
        };
        let dense = many(random);
        let sparse = dense & many(random) & many(random) & many(random);
        random.of([Dyadic::of(dense), Dyadic::of(sparse), Dyadic::of(sparse), Dyadic::NONE])
    };
    let any = Lists::new([list(), list(), list(), list()], list(), list());
    // What takes long, less often.
    if chosen.vertices() < 1_000 || random.integer(0, 15) == 0 {
        dyadic::pipeline(ledger, &patch, &view, &chosen, settings, emit);
    }
    if random.integer(0, 15) == 0 {
        dyadic::pipeline(ledger, &patch, &view, &any, settings, emit);
    }
}

/// Place, evaluate, stitch and emit; levels have the bits of their reciprocals beside them.
fn pipeline(
    ledger: &mut Ledger,
    patch: &Patch,
    view: &View,
    (levels, reciprocal_bits): &(Levels, u32),
    settings: Settings,
    emit: emit::Settings,
) {
    let (placement, placed) = blocks::place(ledger, levels, *reciprocal_bits);
    let triangles = blocks::stitch(ledger, &placement, &placed);
    let vertices = blocks::evaluate(ledger, patch, settings, (&placement, &placed));
    blocks::degenerate(ledger, &placement, &vertices, &triangles);
    blocks::emit(ledger, &vertices, view, emit);
}

/// Emit on positions that no surface has: w around 0, quotients around the ends of the band.
fn screen(ledger: &mut Ledger, random: &mut Random) {
    let width = random.integer(8, 48);
    let view = view(random, width);
    let max = view.position.max() as f64;
    let vertices = [(); 8].map(|()| {
        let [x, y] = [(); 2].map(|()| random.real(-max, max));
        let w = random.of([x, y, max]).abs() / random.octaves(0.5, 65536.0) - 1.0;
        let position = [x, y, 0.0, w * random.of([1.0, 1.0, 1.0, -1.0])].map(|c| c as i64);
        Vertex { position, u: 0, v: 0 }
    });
    let rounding = random.of(Rounding::ALL);
    let settings = emit::Settings { subpixel_bits: random.integer(0, 12), rounding };
    blocks::emit(ledger, &vertices, &view, settings);
}

/// A patch before a random camera.
fn planes(ledger: &mut Ledger, random: &mut Random) {
    let width = random.integer(24, 48);
    let turn = |random: &mut Random| random.real(-1.0, 1.0);
    let object: [Real; 16] = std::array::from_fn(|k| {
        let (u, v) = ((k % 4) as f64 - 1.5, (k / 4) as f64 - 1.5);
        let [a, b, c] = [(); 3].map(|()| 0.3 * turn(random));
        [u + a, v + b, c, 1.0]
    });
    // Any rotation, then away from the eye; -w is depth. Mirrored or not.
    let [a, b] = [(); 2].map(|()| turn(random) * 3.0);
    let away = DMat4::from_translation(DVec3::new(turn(random), turn(random), -6.0));
    let mirror = DMat4::from_scale(DVec3::new(random.of([-1.0, 1.0]), 1.0, 1.0));
    let look = away * DMat4::from_rotation_x(a) * DMat4::from_rotation_y(b) * mirror;
    let projection = DMat4::from_cols_array(&[
        1.4, 0.0, 0.0, 0.0, 0.0, 1.9, 0.0, 0.0, 0.0, 0.0, -1.02, -1.0, 0.0, 0.0, -0.5, 0.0,
    ]);
    let matrix = (projection * look).to_cols_array();
    let scale = 2f64.powi(width as i32 - 6); // 32 units
    let raw = |p: Real| p.map(|c| (c * scale).round_ties_even() as i64);
    let points = object.map(|p| raw(control_point::transform(&matrix, p)));
    let patch = Patch { id: 0, points, saturated: false, cull: true, reversed: false };
    let source = Source { object: &object, matrix: &matrix, scale };
    for _ in 0..8 {
        let at = [random.integer(0, 65536), random.integer(0, 65536)];
        planes::plane(ledger, &patch, &source, at);
    }
}

/// All blocks on the patches of a shipped trace.
pub(crate) fn trace(ledger: &mut Ledger, name: &str) {
    let config = Config::default();
    let mut seen = 0;
    walk::walk(name, &config, |draw, drawn| {
        // Blocks of an indexed mesh are compared on samples of their own.
        if drawn.patch.id == 0 && draw.indices.is_none() {
            blocks::assemble(ledger, draw.primitive);
        }
        let (patch, view) = (&drawn.patch, &drawn.frame.view);
        shaded(ledger, drawn);
        for value in drawn.shaded.iter().flatten() {
            let modes = (config.position.rounding, config.position.overflow);
            blocks::port(ledger, *value, view.position, modes);
        }
        blocks::clip(ledger, patch, view);
        blocks::backface(ledger, patch, view);
        shaders::trace(ledger, drawn);
        surfaces::trace(ledger, drawn);
        let levels = levels::level(ledger, patch, view, &drawn.state);
        for (level_max, part) in [(3, [0.5, 0.25]), (15, [0.9, 0.05])] {
            resolutions::compare(ledger, (patch, view, &drawn.state), level_max, part);
        }
        for scheme in SCHEMES {
            let settings = Settings {
                position: view.position,
                guard: config.guard(),
                scheme,
                rounding: config.evaluate.rounding,
                overflow: config.position.overflow,
            };
            let emit = emit::Settings { subpixel_bits: 8, rounding: config.emit.rounding };
            pipeline(ledger, patch, view, &(levels, 32), settings, emit);
        }
        for termination in [Termination::EightCurves, Termination::Bounded] {
            let lists = dyadic::level(ledger, patch, view, &drawn.state, termination);
            let settings = Settings {
                position: view.position,
                guard: config.guard(),
                scheme: Scheme::DeCasteljau,
                rounding: config.evaluate.rounding,
                overflow: config.position.overflow,
            };
            let emit = emit::Settings { subpixel_bits: 8, rounding: config.emit.rounding };
            dyadic::pipeline(ledger, patch, view, &lists, settings, emit);
        }
        seen += 1;
    });
    println!("{name}: {seen} patches");
    assert!(seen >= 12, "{name}: {seen} patches");
}

/// The shader's f32 against f64, relative to what each coordinate is the sum of.
fn shaded(ledger: &mut Ledger, drawn: &walk::Drawn) {
    let matrix = drawn.matrix.map(f64::from);
    for (p, got) in drawn.object.iter().zip(&drawn.shaded) {
        let want = control_point::transform(&matrix, *p);
        let size = control_point::magnitude(&matrix, *p);
        for k in (0..4).filter(|&k| size[k] > 0.0) {
            let error = (f64::from(got[k]) - want[k]).abs() / size[k] * 2f64.powi(24);
            ledger.error(Q::Transform, &At::default(), error);
        }
    }
}
