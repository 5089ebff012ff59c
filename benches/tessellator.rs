//! How fast is the fixed-function tessellator? Patterns a second on one thread, from the bits of
//! their factors to points and indices in memory, counter-clockwise.
//!
//! Every factor of every pattern is drawn by itself, so nothing of one pattern serves the next: the
//! patterns are more than any cache of whole patterns could hold. Beside each measurement stands
//! what the published C++ implementation makes of integer factors, on a machine of the same kind.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rtl_model::d3d11::{Domain, Factors, Output, Partitioning, Tessellator};
use std::hint::black_box;

/// A domain, a factor, and how many patterns a second the C++ implementation makes of it.
const REFERENCE: [(Domain, u16, u32); 6] = [
    (Domain::Quad, 8, 1_240_000),
    (Domain::Quad, 16, 398_000),
    (Domain::Quad, 64, 27_400),
    (Domain::Tri, 8, 1_730_000),
    (Domain::Tri, 16, 516_000),
    (Domain::Tri, 64, 36_700),
];

const PARTITIONINGS: [Partitioning; 4] =
    [Partitioning::Integer, Partitioning::Pow2, Partitioning::Odd, Partitioning::Even];

/// Patterns a measurement goes round.
const PATTERNS: usize = 1000;

/// Factors in `least..most`, by SplitMix64 (Steele, Lea, Flood 2014).
fn draw(domain: Domain, least: f32, most: f32) -> Vec<u32> {
    let mut state = 0x7e55_1a7e_u64;
    let factor = |_| {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        let fraction = ((z ^ z >> 31) >> 40) as f32 / (1 << 24) as f32;
        (least + (most - least) * fraction).to_bits()
    };
    (0..PATTERNS * domain.factors()).map(factor).collect()
}

/// Makes all patterns; their triangles.
fn make(
    tessellator: &mut Tessellator,
    domain: Domain,
    partitioning: Partitioning,
    bits: &[u32],
) -> usize {
    let mut indices = 0;
    for bits in bits.chunks_exact(domain.factors()) {
        let factors = Factors::process(domain, partitioning, bits).expect("no factor culls");
        tessellator.accept(&factors, Output::Ccw);
        black_box(tessellator.points());
        indices += black_box(tessellator.indices()).len();
    }
    indices / 3
}

fn tessellator(criterion: &mut Criterion) {
    let mut tessellator = Tessellator::default();
    let mut group = criterion.benchmark_group("tessellator");
    group.sample_size(20).throughput(Throughput::Elements(PATTERNS as u64));
    let near = REFERENCE.map(|(domain, factor, reference)| {
        let factor = f32::from(factor);
        let name = format!("{domain:?} {factor} +-2, C++ {reference}");
        (name, domain, factor - 2.0, (factor + 2.0).min(64.0))
    });
    let all = [Domain::Quad, Domain::Tri].map(|d| (format!("{d:?} 1 to 64"), d, 1.0, 64.0));
    for (name, domain, least, most) in near.into_iter().chain(all) {
        let bits = draw(domain, least, most);
        for partitioning in PARTITIONINGS {
            let id = BenchmarkId::new(&name, format!("{partitioning:?}"));
            group.bench_with_input(id, &bits, |bencher, bits| {
                bencher.iter(|| make(&mut tessellator, domain, partitioning, black_box(bits)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, tessellator);
criterion_main!(benches);
