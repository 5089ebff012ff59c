//! Levels and dyadic lists: every criterion and termination, on every width.

use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use rtl_model::level::{self, Criterion, State};
use rtl_model::patch::{DEPTH_MAX, Level, Patch, View};
use tessim::config::{Config, Termination};
use tessim::gpu::{self, LEVELS, LISTS, PATCH, Settings, push_patch};

/// A patch and its tessellation state.
struct Input {
    patch: Patch,
    state: State,
    culled: bool,
}

fn draw(random: &mut Random, view: &View) -> Input {
    let max = view.position.max();
    let kind = random.of(Kind::ALL);
    let mut patch = random::patch(random, kind, max);
    let mut pixels = random.octaves(1.0, 2f64.powi(28)) as u32;
    match random.integer(0, 7) {
        // Too near, behind, or so near that the projection does not fit.
        0 | 1 => {
            for point in &mut patch.points {
                if random.integer(0, 3) == 0 {
                    point[3] = random.octaves(1.0, max as f64) as i64 - i64::from(max < 4096);
                    point[3] *= random.of([-1, 1, 1, 1]);
                }
            }
        }
        // Quotients that are ties.
        2 => {
            let w = 1 << random.integer(0, view.position.width - 2);
            patch.points = patch.points.map(|[x, y, z, _]| [x, y, z, w]);
        }
        3 => pixels = ledge(random, view, &mut patch),
        4 if random.integer(0, 3) == 0 => pixels = bulge(random, view, &mut patch),
        _ => {}
    }
    Input { patch, state: state(random, pixels.max(1)), culled: random.integer(0, 15) == 0 }
}

/// Rows and columns that leave their chord by one height, or chords of no length by one distance:
/// returned in 2^-16 pixels, or one more or less, so that being flat is a matter of a single ulp.
fn ledge(random: &mut Random, view: &View, patch: &mut Patch) -> u32 {
    let max = view.position.max();
    let length = i64::from(random.integer(0, 1)) * (max / 8);
    let [along, height] = [(); 2].map(|()| (random.octaves(1.0, 1024.0) as i64).min(max / 16));
    let w = 1 << (view.position.width - 2);
    patch.points = std::array::from_fn(|k| {
        let [i, j] = [k as i64 / 4, k as i64 % 4];
        let [out, up] = [i, j].map(|k| i64::from(k % 3 != 0));
        [j * length + height * out + along * up, i * length + along * out + height * up, 0, w]
    });
    let ulps =
        |c: i64, size: u32| (i128::from(c) * (i128::from(size) << 15) / i128::from(w)) as u64;
    let [x, y] = [ulps(along, view.viewport[0]), ulps(height, view.viewport[1])];
    let reach = if length == 0 { (x * x + y * y).isqrt() } else { y };
    reach as u32 + random.integer(0, 2) - u32::from(reach > 0)
}

/// A net whose inner rows (or columns) are longer than the edges along them, and need more
/// segments, while across one segment is enough: returned is how long one may be.
fn bulge(random: &mut Random, view: &View, patch: &mut Patch) -> u32 {
    let unit = view.position.max() / 64;
    let w = 1 << (view.position.width - 2);
    let across = random.bits() & 1 == 0;
    patch.points = std::array::from_fn(|k| {
        let [i, j] = if across { [k % 4, k / 4] } else { [k / 4, k % 4] };
        let x = j as i64 * if i % 3 == 0 { 10 * unit } else { 12 * unit };
        if across { [0, x, 0, w] } else { [x, 0, 0, w] }
    });
    let size = view.viewport[usize::from(across)];
    let ulps = i128::from(unit) * (i128::from(size) << 15) / i128::from(w);
    ulps as u32 * random.integer(12, 20)
}

/// Bounds and a level: whole, a power of two, or anything between.
fn state(random: &mut Random, pixels: u32) -> State {
    let level = |random: &mut Random| {
        let any = random.octaves(65536.0, 8_388_608.0) as u32;
        Level::clamped(match random.integer(0, 4) {
            0 => u64::from(any) & !0xffff,
            1 => 65536 << random.integer(0, 7),
            2 => (65536 << random.integer(0, 7)) + 1,
            _ => any.into(),
        })
    };
    let criterion = match random.integer(0, 7) {
        0 => Criterion::Fixed { level: level(random) },
        1..=3 => Criterion::EdgeLength { pixels: if pixels > 9 { pixels } else { 1 } },
        _ => Criterion::Flatness { pixels },
    };
    let [a, b] = match random.integer(0, 3) {
        0 => [level(random), level(random)],
        1 => [level(random), Level::MAX],
        _ => [Level::MIN, Level::MAX],
    };
    State { criterion, min: a.min(b), max: a.max(b) }
}

fn state_words(state: &State) -> [u32; 4] {
    let [criterion, number] = match state.criterion {
        Criterion::Flatness { pixels } => [0, pixels],
        Criterion::EdgeLength { pixels } => [1, pixels],
        Criterion::Fixed { level } => [2, level.fx16()],
    };
    [criterion, number, state.min.fx16(), state.max.fx16()]
}

fn view(random: &mut Random, width: u32) -> View {
    let plain = support::view(width);
    let size = |random: &mut Random| match random.integer(0, 3) {
        0 => random.of([1, 2, 16383, 16384]),
        _ => random.octaves(1.0, 16385.0) as u32,
    };
    let near = match random.integer(0, 2) {
        0 => 1,
        1 => random.octaves(1.0, plain.position.max() as f64) as i64 / 2,
        _ => plain.position.max() / 4,
    };
    View { viewport: [size(random), size(random)], near: near.max(1), ..plain }
}

/// Words of a patch on either side, and what they were made of.
type Side = fn(&Input, &View, Termination) -> Vec<u32>;

/// Runs `each` on random batches of every width and termination; compares `words` a patch.
fn compare(
    rows: [&'static str; 3],
    words: usize,
    on_device: fn(&gpu::Device, &Settings, &gpu::Buffer, &gpu::Buffer) -> gpu::Buffer,
    cpu: Side,
    mut seen: impl FnMut(&Input, &[u32]),
) {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(74);
    for width in 8..=48 {
        for termination in [Termination::EightCurves, Termination::Bounded] {
            let view = view(&mut random, width);
            let mut config = Config::default();
            config.level.termination = termination;
            let inputs: Vec<_> =
                (0..80 * support::effort()).map(|_| draw(&mut random, &view)).collect();
            let mut flat = Vec::with_capacity(PATCH * inputs.len());
            for input in &inputs {
                push_patch(&mut flat, &input.patch, state_words(&input.state), [0; 3]);
            }
            let fates: Vec<_> =
                inputs.iter().flat_map(|i| [if i.culled { 1 } else { 2 }, 0, 0, 0]).collect();
            let flat = device.upload(&flat).unwrap();
            let fates = device.upload(&fates).unwrap();
            let settings = Settings::new(&config, &view, view.position).of(inputs.len());
            let out = on_device(device, &settings, &flat, &fates);
            let got = device.read(&out, 0, words * inputs.len()).unwrap();
            for (input, got) in inputs.iter().zip(got.chunks(words)) {
                let want =
                    if input.culled { vec![0; words] } else { cpu(input, &view, termination) };
                seen(input, &want);
                ledger.compare(
                    ("level", rows[state_words(&input.state)[0] as usize]),
                    &want,
                    got,
                    || format!("{width} bits, {termination:?}, {view:?}"),
                    || format!("{:?} {:?}", input.state, input.patch.points),
                );
            }
        }
    }
    support::settle(&ledger, Quantity::KernelLevelRandom);
}

#[test]
fn levels_agree() {
    let mut seen = [0; 6];
    let cpu: Side = |input, view, _| {
        let (levels, events) = level::accept(&input.patch, view, &input.state);
        let mut words: Vec<_> = levels.edges.iter().map(|l| l.fx16()).collect();
        words.extend(levels.interior.map(Level::fx16));
        words.extend([events.clamped, events.near, events.overflows, events.splits, 0, 0]);
        words
    };
    compare(
        ["levels by flatness", "levels by edge length", "fixed levels"],
        LEVELS,
        |device, settings, patches, fates| gpu::level(device, settings, patches, fates).unwrap(),
        cpu,
        |input, words| {
            if input.culled {
                return;
            }
            let [least, most] = [input.state.min.fx16(), input.state.max.fx16()];
            let edges = &words[..4];
            seen[0] += edges.iter().filter(|&&l| l == least).count();
            seen[1] += edges.iter().filter(|&&l| l == most).count();
            seen[2] += edges.iter().filter(|&&l| l > least && l < most).count();
            for (seen, &event) in seen[3..].iter_mut().zip(&words[6..9]) {
                *seen += event as usize;
            }
        },
    );
    println!("least, greatest, between, clamped, near, overflows: {seen:?}");
    let skipped = support::device().is_none();
    assert!(skipped || seen.iter().all(|&seen| seen >= 200), "{seen:?}");
}

#[test]
fn lists_agree() {
    // Uniform lists and others, lists clamped, splits.
    let mut seen = [0; 4];
    let cpu: Side = |input, view, termination| {
        let (lists, events) = level::subdivide(&input.patch, view, &input.state, termination);
        let masks = lists.edges().iter().copied().chain([lists.u(), lists.v()]);
        let mut words: Vec<_> =
            masks.flat_map(|list| [0, 32, 64, 96].map(|at| (list.mask() >> at) as u32)).collect();
        words.extend([events.clamped, events.near, events.overflows, events.splits]);
        words
    };
    compare(
        ["lists by flatness", "lists by edge length", "fixed lists"],
        LISTS,
        |device, settings, patches, fates| {
            gpu::subdivide(device, settings, patches, fates).unwrap()
        },
        cpu,
        |_, words| {
            for mask in words[..16].chunks(4) {
                let entries: u32 = mask.iter().map(|word| word.count_ones()).sum();
                let uniform = (0..=DEPTH_MAX).any(|depth| entries + 1 == 1 << depth);
                seen[usize::from(uniform)] += 1;
            }
            seen[2] += words[24] as usize;
            seen[3] += words[27] as usize;
        },
    );
    println!("uneven, uniform, clamped, splits: {seen:?}");
    let skipped = support::device().is_none();
    assert!(skipped || seen.iter().all(|&seen| seen >= 500), "{seen:?}");
}
