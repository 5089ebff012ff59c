//! The tessellator's patterns against their definition: factors of all kinds, all domains.

use super::ledger::Ledger;
use super::random::Random;
use super::table::{At, Quantity as Q};
use rtl_model::d3d11::{Domain, Factors, Output, Partitioning, Tessellator};
use tessim::golden;

const PARTITIONINGS: [Partitioning; 4] =
    [Partitioning::Integer, Partitioning::Pow2, Partitioning::Odd, Partitioning::Even];

/// A factor: anywhere, around an integer, around 1, or none that is drawn by chance.
fn factor(random: &mut Random) -> f32 {
    let near = |x: f32, ulps: u32| f32::from_bits((x.to_bits() + ulps).wrapping_sub(3));
    match random.integer(0, 9) {
        0..5 => random.single(0.5, 20.0),
        5 => random.single(0.5, 66.0),
        6 => near(random.integer(1, 65) as f32, random.integer(0, 6)),
        7 => near(1.0, random.integer(0, 200)),
        8 => random.integer(1, 8) as f32,
        _ if random.integer(0, 9) > 0 => 1.0,
        _ => random.of([0.0, -0.0, -3.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-40]),
    }
}

/// One pattern of each domain.
pub(crate) fn compare(ledger: &mut Ledger, random: &mut Random) {
    let partitioning = random.of(PARTITIONINGS);
    for domain in [Domain::Quad, Domain::Tri, Domain::Isoline] {
        let given: Vec<f32> = (0..domain.factors()).map(|_| factor(random)).collect();
        let bits: Vec<u32> = given.iter().map(|factor| factor.to_bits()).collect();
        let got = Factors::process(domain, partitioning, &bits);
        let want = golden::d3d11::process(partitioning, &given);
        ledger.equal(Q::D3d11Culled, got.is_none(), want.is_none());
        if let (Some(got), Some(want)) = (got, want) {
            pattern(ledger, &got, &golden::d3d11::pattern(&want));
        }
    }
}

fn pattern(ledger: &mut Ledger, factors: &Factors, want: &golden::d3d11::Pattern) {
    let output = if factors.domain() == Domain::Isoline { Output::Point } else { Output::Ccw };
    let mut tessellator = Tessellator::default();
    tessellator.accept(factors, output);
    let triangles = match output {
        Output::Point => Vec::new(),
        _ => sorted(tessellator.indices()),
    };
    let counts = |points: usize, indices: usize| (points, indices);
    let indices = if output == Output::Point { want.sites.len() } else { 3 * want.triangles.len() };
    ledger.equal(
        Q::D3d11Counts,
        counts(factors.points(), factors.indices(output)),
        counts(want.sites.len(), indices),
    );
    for (point, site) in tessellator.points().iter().zip(&want.sites) {
        for ((&got, want), steps) in point.iter().zip(site.at).zip(site.steps) {
            let error = (f64::from(got) - want * 65536.0).abs();
            let at = At { steps: [steps, 0], ..At::default() };
            let quantity = if site.set_off { Q::D3d11SetOff } else { Q::D3d11Parameter };
            ledger.error(quantity, &at, error);
        }
    }
    if output != Output::Point {
        ledger.equal(Q::D3d11Triangles, &triangles, &want.triangles);
    }
}

/// Triangles from their least numbers, sorted.
fn sorted(indices: &[u16]) -> Vec<[usize; 3]> {
    let (triangles, rest) = indices.as_chunks::<3>();
    assert!(rest.is_empty(), "whole triangles");
    let mut triangles: Vec<[usize; 3]> = triangles.iter().map(|t| t.map(usize::from)).collect();
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles
}
