//! The arithmetic of the back-face tests: a method and how many of its facets were looked at in;
//! operations out.
//!
//! Counted for all facets this is what a frame's `ops` rows hold, as everywhere: no early exit. For
//! fewer it is what hardware does that looks at them one after the other, and forms the
//! differences, products and sums that several of them share when the first needs them.

use super::{Formats, Piece, quotient, reciprocal, root};
use crate::config::{BackfaceMethod, Config};
use rtl_model::counter::Block;
use rtl_model::counter::standard::Ops;
use std::collections::BTreeSet;

/// Bits of a direction, of an axis and of a cosine in `rtl_model/src/backface/cone.rs`.
const DIRECTION: u64 = 20;
const AXIS: u64 = 12;
const COSINE: u64 = 20;

pub(super) const TANGENT_PLANE: Piece = Piece {
    block: Block::Backface,
    meaning: "tangent_plane, a patch tested: 81 coefficients by convolution, 144 cross \
              products and 576 dot products of x, y, w, and their signs",
    times: |f| f.tested(BackfaceMethod::TangentPlane),
    once: |f| tangent_plane(f, 81),
};

pub(super) const NET_FACETS: Piece = Piece {
    block: Block::Backface,
    meaning: "net_facets, a patch tested: 36 determinants over the net's 39 differences that \
              they need, and their signs",
    times: |f| f.tested(BackfaceMethod::NetFacets),
    once: |f| net_facets(f, 36),
};

pub(super) const NORMAL_CONE: Piece = Piece {
    block: Block::Backface,
    meaning: "normal_cone, a patch tested: 144 cross products into 36 coefficients, two axes, \
              the squared cosines of 52 directions, the least of each cone, and the two angles",
    times: |f| f.tested(BackfaceMethod::NormalCone),
    once: |f| normal_cone(f, 53),
};

pub(super) const HULL_LITERAL: Piece = Piece {
    block: Block::Backface,
    meaning: "hull_literal, a patch tested: 560 planes through three points over 119 differences, \
              each against the 13 other points and the viewer",
    times: |f| f.tested(BackfaceMethod::HullLiteral),
    once: |f| hull_literal(f, 560),
};

/// What a test costs that looks at `facets` of its facets, coefficients or directions, in order.
///
/// # Panics
/// When the method has fewer.
#[must_use]
pub fn test(method: BackfaceMethod, facets: u32, config: &Config) -> Ops {
    assert!(facets <= method.facets(), "{method:?} has {} facets", method.facets());
    let formats = Formats::of(config);
    match method {
        BackfaceMethod::Off => Ops::default(),
        _ if facets == 0 => Ops::default(),
        BackfaceMethod::NetFacets => net_facets(formats, facets),
        BackfaceMethod::TangentPlane => tangent_plane(formats, facets),
        BackfaceMethod::NormalCone => normal_cone(formats, facets),
        BackfaceMethod::HullLiteral => hull_literal(formats, facets),
    }
}

/// x, y, w.
const fn vectors(n: usize) -> u64 {
    3 * n as u64
}

/// A row and a column, of coefficients.
type At = (usize, usize);

/// Pairs of coefficients of two polynomials whose product goes into the coefficient `at`; sizes are
/// rows and columns.
fn factors(at: At, a: At, b: At) -> impl Iterator<Item = (At, At)> {
    let all = (0..a.0).flat_map(move |i| (0..a.1).map(move |j| (i, j)));
    let other = move |(i, j): At| Some((at.0.checked_sub(i)?, at.1.checked_sub(j)?));
    all.filter_map(move |p| other(p).filter(|q| q.0 < b.0 && q.1 < b.1).map(|q| (p, q)))
}

/// `tangent.rs`, its definition: no estimate.
fn tangent_plane(f: Formats, facets: u32) -> Ops {
    // With their binomials, up to 9 and 6, s and the differences take 4 bits more than a position.
    let (factor, normal, coefficient) = (f.w + 4, 2 * f.w + 9, 3 * f.w + 14);
    let corners = [(0, 0), (0, 8), (8, 0), (8, 8)];
    let all = (0..81).map(|k| (k / 9, k % 9)).filter(|at| !corners.contains(at));
    let (mut points, mut normals, mut dots) = (BTreeSet::new(), BTreeSet::new(), 0);
    for at in corners.into_iter().chain(all).take(facets as usize) {
        for (s, n) in factors(at, (4, 4), (6, 6)) {
            points.insert(s);
            normals.insert(n);
            dots += 1;
        }
    }
    let (mut su, mut sv, mut crosses) = (BTreeSet::new(), BTreeSet::new(), 0);
    for &at in &normals {
        for (u, v) in factors(at, (4, 3), (3, 4)) {
            su.insert(u);
            sv.insert(v);
            crosses += 1;
        }
    }
    // C(3,1) and C(3,2) are an addition each, 9 = 8 + 1 and 6 = 2 * 3 as well; C(2,1) is a shift.
    let three = |i: usize| i == 1 || i == 2;
    let scaled = points.iter().filter(|p| three(p.0) || three(p.1)).count()
        + su.iter().filter(|u| three(u.0)).count()
        + sv.iter().filter(|v| three(v.1)).count();
    Ops::default()
        .adds(vectors(su.len() + sv.len()), f.w + 1)
        .adds(vectors(scaled), factor)
        .muls(crosses * 6, factor, factor)
        .adds(crosses * 3 + vectors(crosses as usize - normals.len()), normal)
        .muls(dots * 3, factor, normal)
        .adds(dots * 2 + dots - u64::from(facets), coefficient)
        .compares(facets.into(), coefficient)
}

/// `net_facets` of `backface.rs`: 9 + 12 differences along the net, 18 across its facets.
fn net_facets(f: Formats, facets: u32) -> Ops {
    let (difference, minor, volume) = (f.w + 1, 2 * f.w + 3, 3 * f.w + 3);
    let first = [0, 1, 2, 4, 5, 6, 8, 9, 10];
    let triangles = first.into_iter().flat_map(|k: usize| {
        let (a, b, c, d) = (k, k + 1, k + 5, k + 4);
        [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
    });
    let looked_at = triangles.take(facets as usize);
    let needed: BTreeSet<_> = looked_at.flat_map(|[a, b, c]| [(a, b), (a, c)]).collect();
    let facet = Ops::default()
        .muls(6, difference, difference)
        .adds(3, minor)
        .muls(3, f.w, minor)
        .adds(2, volume)
        .compares(1, volume);
    Ops::default().adds(vectors(needed.len()), difference).with(facets.into(), facet)
}

/// `hull.rs`: triples in the order of their indices, the first of which is the point that the
/// others are seen from.
fn hull_literal(f: Formats, facets: u32) -> Ops {
    let (difference, minor, volume) = (f.w + 1, 2 * f.w + 3, 3 * f.w + 5);
    // So many triples begin with each point; a difference and its negative are one.
    let beginning = (0..14).map(|i| (15 - i) * (14 - i) / 2);
    let before = beginning.scan(0, |sum, n| Some(std::mem::replace(sum, *sum + n)));
    let from = before.take_while(|&before| before < u64::from(facets)).count();
    let differences: usize = (0..from).map(|i| 15 - i).sum();
    let side = |a| Ops::default().muls(3, a, minor).adds(2, volume).compares(1, volume);
    let facet = Ops::default().muls(6, difference, difference).adds(3, minor);
    let facet = facet.with(13, side(difference)).with(1, side(f.w));
    Ops::default().adds(vectors(differences), difference).with(facets.into(), facet)
}

/// `cone.rs`. The coefficients are needed for the axis, before the first of them is looked at.
fn normal_cone(f: Formats, facets: u32) -> Ops {
    let (factor, normal) = (f.w + 4, 2 * f.w + 9);
    let axes = Ops::default()
        .adds(vectors(12 + 12), f.w + 1) // Su and Sv
        .adds(vectors(6 + 6), factor) // those with a binomial that 3 divides
        .muls(144 * 6, factor, factor)
        .adds(144 * 3 + vectors(144 - 36), normal)
        .adds(vectors(15 + 35), DIRECTION + 6) // sums of 16 and of 36 directions
        .muls(3, AXIS, AXIS)
        .adds(2, 2 * AXIS + 2)
        .compares(1, 2 * AXIS + 2);
    let mut ops = axes;
    if facets > 1 {
        // The squared lengths of the axes, and the sums of their components' magnitudes.
        ops = ops.muls(6, AXIS, AXIS).adds(4, 2 * AXIS + 2).adds(4, AXIS + 2);
    }
    let (along, length) = (DIRECTION + AXIS + 2, 2 * DIRECTION + 2);
    let direction = Ops::default()
        .muls(3, DIRECTION, AXIS)
        .adds(2 + 1, along)
        .compares(1, along)
        .adds(3, DIRECTION) // magnitudes rounded up
        .muls(3, DIRECTION, DIRECTION)
        .adds(2, length)
        .muls(1, along, along)
        .muls(2, 2 * along, length) // this ratio against the least so far
        .compares(1, 2 * along + length);
    ops = ops.with(u64::from(facets) - 1, direction);
    if facets == 53 { ops.with(1, angles(2 * along, length + 2 * AXIS + 2)) } else { ops }
}

/// The least ratio of each cone, of two squares so wide, and `apart` of `cone.rs`: two cosines and
/// two sines, the sine of the sum, and the axes' length.
fn angles(dividend: u64, divisor: u64) -> Ops {
    let ratio = reciprocal(2 * COSINE).with(1, quotient(dividend, divisor, 2 * COSINE));
    let length = 2 * AXIS + 2;
    Ops::default()
        .muls(2, 2 * AXIS + 2, divisor - 2 * AXIS - 2)
        .with(2, ratio)
        .with(4, root(COSINE))
        .muls(2, COSINE, COSINE) // 1 - cos^2
        .adds(2, 2 * COSINE)
        .compares(1, COSINE)
        .muls(2, COSINE, COSINE)
        .adds(1, 2 * COSINE)
        .muls(1, length, length)
        .with(1, root(length))
        .muls(1, length, 2 * COSINE)
        .compares(1, length + 2 * COSINE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_further_facet_costs_something_and_all_cost_what_a_frame_counts() {
        let config = Config::default();
        let pieces = [
            (BackfaceMethod::NetFacets, NET_FACETS),
            (BackfaceMethod::TangentPlane, TANGENT_PLANE),
            (BackfaceMethod::NormalCone, NORMAL_CONE),
            (BackfaceMethod::HullLiteral, HULL_LITERAL),
        ];
        for (method, piece) in pieces {
            let costs = (0..=method.facets()).map(|n| test(method, n, &config));
            let costs: Vec<Ops> = costs.collect();
            assert_eq!(costs[0], Ops::default());
            assert_eq!(costs.last(), Some(&piece.once(&config)), "{method:?}");
            for (n, pair) in costs.windows(2).enumerate() {
                assert!(pair[0].mul < pair[1].mul, "{method:?}: {n}");
                assert!(pair[0].add_bits < pair[1].add_bits, "{method:?}: {n}");
                assert!(pair[0].compare < pair[1].compare, "{method:?}: {n}");
            }
        }
        assert_eq!(test(BackfaceMethod::Off, 0, &config), Ops::default());
    }

    #[test]
    fn the_first_facet_costs_what_a_hand_counts_at_32_bits() {
        let one = |method| {
            let ops = test(method, 1, &Config::default());
            [ops.add, ops.mul, ops.compare]
        };
        // Two differences, a cross product, a dot product, a sign.
        assert_eq!(one(BackfaceMethod::TangentPlane), [6 + 3 + 2, 6 + 3, 1]);
        assert_eq!(one(BackfaceMethod::NetFacets), [6 + 3 + 2, 6 + 3, 1]);
        // Fifteen differences, a cross product, 13 points and the viewer.
        assert_eq!(one(BackfaceMethod::HullLiteral), [45 + 3 + 14 * 2, 6 + 14 * 3, 14]);
        // 24 differences, 12 with a factor, 144 cross products into 36, two axes, their product.
        let add = 72 + 36 + 144 * 3 + 108 * 3 + 150 + 2;
        assert_eq!(one(BackfaceMethod::NormalCone), [add, 144 * 6 + 3, 1]);
    }
}
