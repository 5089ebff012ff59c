//! Factor processing against a slow, exact definition, around every bit that decides something.

use crate::draw::{DOMAINS, PARTITIONINGS, Random, pattern};
use num_bigint::BigInt;
use num_rational::BigRational;
use rtl_model::d3d11::{Domain, Factors, Output, Partitioning};

fn ratio(numerator: i64, denominator: i64) -> BigRational {
    BigRational::new(BigInt::from(numerator), BigInt::from(denominator))
}

/// What a factor is: `None` for no number, infinity as something greater than all others.
fn value(bits: u32) -> Option<BigRational> {
    match f32::from_bits(bits) {
        x if x.is_nan() => None,
        f32::INFINITY => Some(ratio(1 << 40, 1)),
        f32::NEG_INFINITY => Some(ratio(-(1 << 40), 1)),
        x => Some(BigRational::from_float(x).expect("finite")),
    }
}

/// The points of a factor, both ends included, straight from the specification; `inner` where a
/// single segment cannot be.
fn points(partitioning: Partitioning, value: Option<BigRational>, least: &BigRational) -> usize {
    let most = ratio(if partitioning == Partitioning::Odd { 63 } else { 64 }, 1);
    let clamped = value.unwrap_or_else(|| least.clone()).max(least.clone()).min(most);
    let count = |rounded: BigRational| -> i64 { rounded.to_integer().try_into().expect("small") };
    let segments = match partitioning {
        Partitioning::Integer | Partitioning::Pow2 => count(clamped.ceil()),
        _ => {
            // To nearest, ties to even, in units of 2^-16.
            let scaled = clamped * ratio(1 << 16, 1);
            let (floor, rest) = (scaled.floor(), scaled.fract());
            let floor = count(floor);
            let up = rest > ratio(1, 2) || (rest == ratio(1, 2) && floor % 2 != 0);
            let exact = ratio(floor + i64::from(up), 1 << 16);
            if partitioning == Partitioning::Even {
                2 * count((exact / ratio(2, 1)).ceil())
            } else {
                2 * count(((exact + ratio(1, 1)) / ratio(2, 1)).ceil()) - 1
            }
        }
    };
    usize::try_from(segments + 1).expect("positive")
}

/// Points of all edges and of the inner partitions; `None`: culled.
fn define(domain: Domain, partitioning: Partitioning, bits: &[u32]) -> Option<Vec<usize>> {
    let values: Vec<Option<BigRational>> = bits.iter().map(|&bits| value(bits)).collect();
    let (edges, inside) = values.split_at(domain.edges());
    if edges.iter().any(|value| value.as_ref().is_none_or(|value| *value <= ratio(0, 1))) {
        return None;
    }
    let least = ratio(if partitioning == Partitioning::Even { 2 } else { 1 }, 1);
    let above = |value: &Option<BigRational>| {
        value.as_ref().is_some_and(|value| *value > ratio((1 << 17) + 1, 1 << 17))
    };
    let framed = partitioning == Partitioning::Odd && values.iter().any(above);
    let least_inside = if framed { ratio((1 << 16) + 1, 1 << 16) } else { least.clone() };
    let mut counts: Vec<usize> =
        edges.iter().map(|value| points(partitioning, value.clone(), &least)).collect();
    if domain == Domain::Isoline {
        counts[0] = points(Partitioning::Integer, edges[0].clone(), &least.min(ratio(1, 1)));
        return Some(counts);
    }
    counts.extend(inside.iter().map(|v| points(partitioning, v.clone(), &least_inside)));
    if counts.iter().any(|&points| points > 2) {
        let edges = edges.len();
        counts[edges..].iter_mut().for_each(|points| *points = (*points).max(3));
    }
    Some(counts)
}

fn made(factors: &Factors) -> Vec<usize> {
    let edges = factors.domain().edges();
    let inside = factors.domain().factors() - edges;
    (0..edges)
        .map(|edge| factors.edge_points(edge))
        .chain((0..inside).map(|axis| factors.inner_points(axis)))
        .collect()
}

/// Bits around everything that decides: ulps of f32 around all integers and half of a 16.16 ulp
/// from them, zero, the ends of the floats.
fn critical() -> Vec<u32> {
    let mut bits = vec![0, 1, 0x007f_ffff, 0x0080_0000, 0x7f7f_ffff, 0x7f80_0000, 0x7f80_0001];
    bits.extend([0x7fc0_0000, 0x7fff_ffff, 0x8000_0000, 0x8000_0001, 0xbf80_0000, 0xff80_0000]);
    bits.extend([0xffc0_0000, 0xffff_ffff]);
    for n in 1..=66 {
        let half_ulp = 2f32.powi(-17);
        for near in [0.0, half_ulp, 2.0 * half_ulp, 3.0 * half_ulp] {
            for x in [n as f32 + near, n as f32 - near] {
                bits.extend((0..7).map(|ulp| x.to_bits() + ulp - 3));
            }
        }
    }
    bits.extend((0..300).map(|ulp| 1f32.to_bits() + ulp)); // to 1 + 2^-16 and on
    bits.sort_unstable();
    bits.dedup();
    bits
}

#[test]
fn factors_are_processed_as_defined_around_everything_critical() {
    let critical = critical();
    let mut random = Random(20);
    let (mut compared, mut culled) = (0, 0);
    for &bits in &critical {
        for domain in DOMAINS {
            for partitioning in PARTITIONINGS {
                let count = domain.factors();
                // Each place in turn; beside ones, and beside anything.
                let place = compared % count;
                let mut given = vec![1f32.to_bits(); count];
                if compared % 3 == 0 {
                    given.iter_mut().for_each(|factor| *factor = random.factor());
                }
                given[place] = bits;
                let got = Factors::process(domain, partitioning, &given);
                let want = define(domain, partitioning, &given);
                let context = format!("{domain:?} {partitioning:?} {given:x?}");
                culled += usize::from(want.is_none());
                assert_eq!(got.as_ref().map(made), want, "{context}");
                compared += 1;
            }
        }
    }
    println!("compared {compared} sets of factors, {culled} of them culled");
    assert!(compared > 25_000 && culled > 100);
}

#[test]
fn integer_and_pow2_factors_make_the_same_patterns() {
    let mut random = Random(21);
    for _ in 0..2000 {
        for domain in DOMAINS {
            let bits: Vec<u32> = (0..domain.factors()).map(|_| random.factor()).collect();
            let [integer, pow2] = [Partitioning::Integer, Partitioning::Pow2]
                .map(|partitioning| Factors::process(domain, partitioning, &bits).unwrap());
            assert_eq!(integer, pow2);
        }
    }
}

/// Integer factors place points where both fractional kinds do, at factors of their parity.
#[test]
fn fractional_factors_meet_integer_ones() {
    let mut compared = 0;
    for n in 1..=64_u16 {
        let partitioning = if n % 2 == 0 { Partitioning::Even } else { Partitioning::Odd };
        for domain in DOMAINS {
            let bits = vec![f32::from(n).to_bits(); domain.factors()];
            let [a, b] = [partitioning, Partitioning::Integer]
                .map(|partitioning| Factors::process(domain, partitioning, &bits).unwrap());
            let output = if domain == Domain::Isoline { Output::Line } else { Output::Cw };
            // The lines of an isoline domain, too.
            assert_eq!(pattern(&a, output), pattern(&b, output), "{domain:?} {n}");
            compared += 1;
        }
    }
    assert_eq!(compared, 192);
}

#[test]
#[should_panic(expected = "as many factors as the domain has")]
fn a_wrong_number_of_factors_panics() {
    let _ = Factors::process(Domain::Tri, Partitioning::Odd, &[1f32.to_bits(); 6]);
}

#[test]
#[should_panic(expected = "no triangles")]
fn triangles_of_isolines_panic() {
    let lines = Factors::process(Domain::Isoline, Partitioning::Odd, &[1f32.to_bits(); 2]);
    let _ = lines.unwrap().indices(Output::Cw);
}
