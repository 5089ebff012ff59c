//! The fixed-function tessellator: patterns of factors of all kinds, in every domain, partitioning
//! and output.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use rtl_model::d3d11::{self as cpu, Partitioning, Tessellator};
use tessim::gpu::d3d11::{Domain, FACTORS, Output, Tessellation, patterns};
use tessim::gpu::{Backend, Device};
use tessim::study::check::Ledger;

const DOMAINS: [(Domain, cpu::Domain); 3] = [
    (Domain::Quad, cpu::Domain::Quad),
    (Domain::Tri, cpu::Domain::Tri),
    (Domain::Isoline, cpu::Domain::Isoline),
];

const OUTPUTS: [(Output, cpu::Output); 4] = [
    (Output::Point, cpu::Output::Point),
    (Output::Line, cpu::Output::Line),
    (Output::Clockwise, cpu::Output::Cw),
    (Output::CounterClockwise, cpu::Output::Ccw),
];

pub(crate) const PARTITIONINGS: [Partitioning; 4] =
    [Partitioning::Integer, Partitioning::Pow2, Partitioning::Odd, Partitioning::Even];

/// A factor: anywhere, around an integer or a half, around 1, or none that is drawn by chance.
fn factor(random: &mut Random) -> u32 {
    let near = |x: f32, ulps: u32| (x.to_bits() + ulps).wrapping_sub(3);
    match random.integer(0, 11) {
        0..5 => random.single(0.5, 20.0).to_bits(),
        5 => random.single(0.5, 66.0).to_bits(),
        6 => near(random.integer(1, 65) as f32, random.integer(0, 6)),
        7 => near(1.0, random.integer(0, 200)),
        8 => (random.integer(1, 8) as f32).to_bits(),
        9 => near(random.integer(1, 130) as f32 / 2.0, random.integer(0, 6)),
        10 => 1f32.to_bits(),
        _ => random
            .of([1.0, 1.5, 63.0, 64.0, 64.5, 1e9, 1.0, f32::INFINITY, 1e-40, 63.999, 2.0])
            .to_bits(),
    }
}

/// Factors of a patch: as they come, or all alike; now and then one that culls, or no number.
fn draw(random: &mut Random) -> [u32; FACTORS] {
    let mut factors = [(); FACTORS].map(|()| factor(random));
    if random.integer(0, 3) == 0 {
        factors = [factors[0]; FACTORS];
    }
    if random.integer(0, 5) == 0 {
        let odd = [0.0, -0.0, -3.0, f32::NAN, -f32::NAN, f32::NEG_INFINITY, -1e-40];
        factors[random.integer(0, 5) as usize] = random.of(odd).to_bits();
    }
    factors
}

/// Compares the patterns of a batch, in every domain and output.
fn compare(ledger: &mut Ledger, device: &Device, factors: &[u32], partitioning: Partitioning) {
    for (domain, cpu_domain) in DOMAINS {
        for (output, cpu_output) in OUTPUTS {
            if domain == Domain::Isoline && output.corners() == 3 {
                continue;
            }
            let tessellation = Tessellation { domain, partitioning, output };
            let made = patterns(device, tessellation, factors).unwrap();
            let slice = |all: &[u32], starts: &[u32], k: usize, words: usize| {
                all[words * starts[k] as usize..words * starts[k + 1] as usize].to_vec()
            };
            let mut tessellator = Tessellator::default();
            for (k, bits) in factors.chunks(FACTORS).enumerate() {
                let bits = &bits[..cpu_domain.factors()];
                let (mut points, mut indices) = (Vec::new(), Vec::new());
                let processed = cpu::Factors::process(cpu_domain, partitioning, bits);
                if let Some(processed) = processed {
                    tessellator.accept(&processed, cpu_output);
                    points = tessellator.points().as_flattened().to_vec();
                    indices = tessellator.indices().iter().map(|&k| k.into()).collect();
                }
                let place = || format!("{tessellation:?}");
                let inputs =
                    || format!("{:?}", bits.iter().map(|&b| f32::from_bits(b)).collect::<Vec<_>>());
                let got = slice(&made.points, &made.point_starts, k, 2);
                ledger.compare(("d3d11", "points"), &points, &got, place, inputs);
                let got = slice(&made.indices, &made.primitive_starts, k, output.corners());
                ledger.compare(("d3d11", "indices"), &indices, &got, place, inputs);
            }
        }
    }
}

#[test]
fn patterns_agree_in_every_domain_partitioning_and_output() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(1101);
    for partitioning in PARTITIONINGS {
        let factors: Vec<u32> =
            (0..100 * support::effort()).flat_map(|_| draw(&mut random)).collect();
        compare(&mut ledger, device, &factors, partitioning);
    }
    support::settle(&ledger, Quantity::KernelPatternRandom);
}

#[test]
fn patterns_agree_for_every_count_of_segments() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut factors = Vec::new();
    for a in 1..=64 {
        for b in [1, 3, a, 64] {
            let all: [i32; FACTORS] = [b, a, 65 - a, (a * b) % 64 + 1, a, b];
            factors.extend(all.map(|n| (n as f32).to_bits()));
        }
    }
    compare(&mut ledger, device, &factors, Partitioning::Integer);
    support::settle(&ledger, Quantity::KernelPatternRandom);
}

#[test]
fn patterns_are_the_same_where_buffers_are_small() {
    let Some(device) = support::device() else { return };
    let mut small = support::another(Backend::Auto).unwrap();
    small.limit_words(30_000); // a pattern of 4225 points has 24576 numbers
    let mut random = Random::new(1106);
    let factors: Vec<u32> = (0..400).flat_map(|_| draw(&mut random)).collect();
    for output in [Output::Line, Output::Clockwise] {
        let tessellation =
            Tessellation { domain: Domain::Quad, partitioning: Partitioning::Odd, output };
        let want = patterns(device, tessellation, &factors).unwrap();
        assert_eq!(patterns(&small, tessellation, &factors).unwrap(), want);
    }
}

#[test]
fn an_isoline_domain_has_no_triangles() {
    let Some(device) = support::device() else { return };
    let tessellation = Tessellation {
        domain: Domain::Isoline,
        partitioning: Partitioning::Integer,
        output: Output::Clockwise,
    };
    let error = patterns(device, tessellation, &[1; FACTORS]).expect_err("no triangles");
    assert!(error.to_string().contains("isoline"), "{error}");
}
