//! Hull: factors of shared edges, and what thresholds do.

use crate::random::Random;
use crate::sides::{SIDES, with_edge};
use rtl_model::patch::EDGES;
use tessim::config::d3d11::CANDIDATES_MAX;
use tessim::shader::hull::{Adaptive, Settings};

/// Where the factors of v0, u1, v1, u0 stand in Direct3D's order.
const FACTOR_OF: [usize; 4] = [1, 2, 3, 0];

fn settings(random: &mut Random) -> Settings {
    Settings {
        candidates: random.integer(1, CANDIDATES_MAX),
        pixels: random.octaves(0.1, 10_000.0) as f32,
        viewport: [random.integer(1, 16384), random.integer(1, 4096)],
        near: random.single(0.0, 1.0),
    }
}

/// Points of which some are too near, rational or not.
fn patch(random: &mut Random) -> [[f32; 4]; 16] {
    let rational = random.bits() & 1 == 0;
    let near = random.of([0.9, 0.9, -0.5]);
    [(); 16].map(|()| {
        let mut real = |least| random.single(least, 1.0);
        [real(-1.0), real(-1.0), real(-1.0), if rational { real(near) } else { 1.0 }]
    })
}

/// Bits 1..n of a mask in the opposite order, n being 3 (L + 1).
fn reversed(mask: u64, candidates: u32) -> u64 {
    let n = 3 * (candidates + 1);
    (1..n).filter(|k| mask >> k & 1 == 1).map(|k| 1 << (n - k)).sum()
}

#[test]
fn decisions_are_the_same_from_either_end() {
    let mut random = Random::new(0x4011_0001);
    let (mut compared, mut inserted) = (0, 0);
    for _ in 0..20_000 {
        let settings = settings(&mut random);
        let adaptive = Adaptive::new(settings);
        let [a, b, c, d, ..] = patch(&mut random);
        let mask = adaptive.insertions(&[a, b, c, d]);
        let back = adaptive.insertions(&[d, c, b, a]);
        assert_eq!(mask, reversed(back, settings.candidates), "{settings:?}");
        compared += 3 * settings.candidates;
        inserted += mask.count_ones();
    }
    println!("compared {compared} decisions, {inserted} to insert");
    assert!(compared > 500_000 && inserted > compared / 10 && inserted < compared / 10 * 9);
}

/// The least threshold, as the bits of a positive single, at which bit `k` is no longer set: the
/// distance that the shader sees, to the bit.
fn seen(settings: Settings, curve: &[[f32; 4]; 4], k: u32) -> u32 {
    let (mut low, mut high) = (0, f32::MAX.to_bits());
    while low < high {
        let middle = low + (high - low) / 2;
        let at = Settings { pixels: f32::from_bits(middle), ..settings };
        let inserted = Adaptive::new(at).insertions(curve) >> k & 1 == 1;
        (low, high) = if inserted { (middle + 1, high) } else { (low, middle) };
    }
    low
}

#[test]
fn distances_are_the_same_to_the_bit_from_either_end() {
    // A decision close to its threshold is rare; a threshold close to its decision is not.
    let mut random = Random::new(0x4011_0007);
    let mut compared = 0;
    for _ in 0..600 {
        let settings = Settings { near: 0.0, ..settings(&mut random) };
        let l = settings.candidates;
        let [a, b, c, d, ..] = [(); 16].map(|()| {
            let mut real = |least| random.single(least, 1.0);
            [real(-1.0), real(-1.0), 0.0, real(0.1)]
        });
        let k = random.integer(1, l) + random.integer(0, 2) * (l + 1);
        let there = seen(settings, &[a, b, c, d], k);
        let back = seen(settings, &[d, c, b, a], 3 * (l + 1) - k);
        assert_eq!(there, back, "{settings:?} at {k}");
        compared += u32::from(there > 0);
    }
    assert!(compared > 550, "{compared}");
}

#[test]
fn an_edge_has_one_factor_in_all_its_patches() {
    let mut random = Random::new(0x4011_0002);
    let (mut compared, mut seen) = (0, std::collections::BTreeSet::new());
    for _ in 0..2_000 {
        let adaptive = Adaptive::new(settings(&mut random));
        let [a, b, c, d, ..] = patch(&mut random);
        let factors = SIDES.map(|side| {
            let points = with_edge(&patch(&mut random), &[a, b, c, d], side);
            adaptive.factors(&points).factors[FACTOR_OF[side.0]]
        });
        for factor in factors {
            assert_eq!(factor, factors[0]);
            compared += 1;
        }
        seen.insert(factors[0] as u32);
    }
    assert!(compared == 16_000 && seen.len() > 30, "{seen:?}");
}

#[test]
fn factors_are_three_and_the_vertices_inserted() {
    let mut random = Random::new(0x4011_0003);
    let mut compared = 0;
    for _ in 0..3_000 {
        let settings = settings(&mut random);
        let adaptive = Adaptive::new(settings);
        let points = patch(&mut random);
        let got = adaptive.factors(&points);
        let of = |curve: [usize; 4]| {
            3.0 + adaptive.insertions(&curve.map(|k| points[k])).count_ones() as f32
        };
        let greatest = |curves: [[usize; 4]; 4]| curves.map(of).into_iter().fold(0.0, f32::max);
        let along_u = greatest([0, 4, 8, 12].map(|k| [k, k + 1, k + 2, k + 3]));
        let along_v = greatest([0, 1, 2, 3].map(|k| [k, k + 4, k + 8, k + 12]));
        let [v0, u1, v1, u0] = EDGES.map(of);
        assert_eq!(got.factors, [u0, v0, u1, v1, along_u, along_v]);
        assert_eq!(got.tests, 24 * settings.candidates);
        compared += 6;
    }
    assert_eq!(compared, 18_000);
}

#[test]
fn a_greater_threshold_inserts_no_more() {
    let mut random = Random::new(0x4011_0004);
    let mut fewer = 0;
    for _ in 0..5_000 {
        let settings = settings(&mut random);
        let [a, b, c, d, ..] = patch(&mut random);
        let less = Settings { pixels: settings.pixels * random.single(0.0, 1.0), ..settings };
        let [few, many] = [settings, less].map(|s| Adaptive::new(s).insertions(&[a, b, c, d]));
        assert_eq!(few & !many, 0, "{settings:?}");
        fewer += u32::from(few != many);
    }
    assert!(fewer > 1_000, "{fewer}");
}

#[test]
fn no_tolerance_inserts_all_of_a_bend_and_any_tolerance_none() {
    let mut random = Random::new(0x4011_0005);
    for _ in 0..2_000 {
        let candidates = random.integer(1, CANDIDATES_MAX);
        let viewport = [1280, 1024];
        let mut real = || random.single(0.2, 1.0);
        // An arch: the curve is strictly inside its polygon, 1/27 of its height at the least.
        let points = std::array::from_fn(|k| {
            let (i, j) = (k / 4, k % 4);
            let rise = |k: usize| if k.is_multiple_of(3) { 0.0 } else { 1.0 };
            [j as f32, i as f32 + real() * (rise(j) + rise(i)), 0.0, 8.0]
        });
        let of = |pixels| {
            Adaptive::new(Settings { candidates, pixels, viewport, near: 0.1 }).factors(&points)
        };
        let most = (3 * (candidates + 1)) as f32;
        let all = of(0.0);
        // The edges along v may be straight on the screen.
        assert_eq!([all.factors[1], all.factors[3], all.factors[4]], [most; 3]);
        assert_eq!(of(1e6).factors, [3.0; 6]);
    }
}

#[test]
fn points_without_projection_are_inserted() {
    let mut random = Random::new(0x4011_0006);
    let mut compared = 0;
    for _ in 0..1_000 {
        let mut settings = Settings { pixels: 1e30, ..settings(&mut random) };
        settings.near = random.of([settings.near, 0.0, -1.0]);
        let all = |points: &[[f32; 4]; 16]| Adaptive::new(settings).factors(points).factors;
        let mut points = patch(&mut random);
        let w = random.of([settings.near.max(0.0) - 0.01, f32::NAN, 0.0, -1.0]);
        if w >= settings.near && w > 0.0 {
            continue;
        }
        points.iter_mut().for_each(|p| p[3] = w);
        assert_eq!(all(&points), [(3 * (settings.candidates + 1)) as f32; 6], "{settings:?}");
        compared += 1;
    }
    assert!(compared > 900, "{compared}");
}
