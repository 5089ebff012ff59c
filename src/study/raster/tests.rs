//! Triangles whose pixels are known by hand, or by the definition: every centre against every
//! edge.

use super::*;
use proptest::prelude::*;
use std::collections::HashSet;

const SIZE: [u32; 2] = [150, 20];

fn at(bits: u32, [x, y]: [f64; 2]) -> Screen {
    let raw = |t: f64| (t * f64::from(1 << bits)) as i32;
    Screen { x: raw(x), y: raw(y), divided: true }
}

fn target(subpixel_bits: u32) -> Target {
    Target { viewport: SIZE, subpixel_bits, front_is_counter_clockwise: true }
}

/// Of triangles with corners in pixels.
fn counted(bits: u32, triangles: &[[[f64; 2]; 3]]) -> (Triangles, u64) {
    let (cover, mut out) = (Cover::new(SIZE), Triangles::default());
    for corners in triangles {
        triangle(&target(bits), corners.map(|c| at(bits, c)), &cover, &mut out);
    }
    (out, cover.pixels())
}

#[test]
fn every_triangle_is_in_one_class() {
    let (behind, mut out) = (Screen::default(), Triangles::default());
    let (a, b) = (at(8, [1.0, 1.0]), at(8, [5.0, 1.0]));
    triangle(&target(8), [a, b, behind], &Cover::new(SIZE), &mut out);
    assert_eq!((out.homogeneous, out.all()), (1, 1));
    for bits in [0, 1, 8, 12] {
        // On the screen y runs down: up, then to the right, is clockwise.
        let clockwise = [[2.0, 10.0], [2.0, 2.0], [10.0, 2.0]];
        let [p, q, r] = clockwise;
        let line = [[2.0, 2.0], [4.0, 4.0], [9.0, 9.0]];
        let left = [[-9.0, 2.0], [0.0, 4.0], [-3.0, 9.0]];
        let below = [[1.0, 20.0], [7.0, 20.0], [3.0, 30.0]];
        let (all, pixels) = counted(bits, &[clockwise, [p, r, q], line, left, below]);
        assert_eq!((all.back, all.front, all.zero_area, all.outside), (1, 1, 1, 2));
        assert_eq!((all.all(), all.no_sample), (5, 0));
        // 32 square pixels each, and of the centres on the diagonal, an edge to the right of the
        // inside, none: 8 + 7 + .. + 1 less 8.
        assert_eq!((all.samples, pixels, all.areas[6]), (2 * 28, 28, 2), "{bits}");
    }
}

#[test]
fn areas_are_classed_by_powers_of_four() {
    // A right triangle with sides of 2^k pixels has 2^(2k - 1) square pixels.
    let right = |k: i32| {
        let side = 2_f64.powi(k);
        [[1.0, 1.0], [1.0 + side, 1.0], [1.0, 1.0 + side]]
    };
    for k in -4..=3 {
        let (counts, _) = counted(8, &[right(k)]);
        let class = (k - 1 - LEAST as i32 + 1).max(0) as usize;
        assert_eq!(counts.areas[class], 1, "{k}: {counts:?}");
        assert_eq!(counts.sub_pixel(), u64::from(k <= 0), "{k}");
    }
    // At the limits of a class: of 4 and of 15.9 square pixels, and of 16.
    let wide = |base: f64| [[1.0, 1.0], [1.0 + base, 1.0], [1.0, 5.0]];
    for (base, class) in [(2.0, 5), (7.95, 5), (8.0, 6)] {
        assert_eq!(counted(8, &[wide(base)]).0.areas[class], 1, "{base}");
    }
}

#[test]
fn a_slender_triangle_shades_mostly_for_nothing() {
    // A line of pixels, one high: eight pixels in four quads.
    let flat = [[[2.0, 2.0], [10.0, 2.0], [10.0, 3.0]], [[2.0, 2.0], [10.0, 3.0], [2.0, 3.0]]];
    let (counts, pixels) = counted(8, &flat);
    assert_eq!((counts.samples, pixels), (8, 8));
    assert_eq!(counts.quads, 2 + 2);
    // Nothing of the least is a centre.
    let (counts, _) = counted(8, &[[[2.0, 2.0], [2.4, 2.0], [2.0, 2.4]]]);
    assert_eq!((counts.no_sample, counts.samples, counts.quads), (1, 0, 0));
}

/// Pixels by the definition: every centre against every edge.
fn direct(corners: [Screen; 3], bits: u32) -> HashSet<[i64; 2]> {
    let p = corners.map(|c| [2 * i64::from(c.x), 2 * i64::from(c.y)]);
    let cross = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let [a, b, c] = p;
    let [b, c] = if cross(a, b, c) > 0 { [b, c] } else { [c, b] };
    let pixel = 2_i64 << bits;
    let inside = |centre: [i64; 2]| {
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
            let top_left = to[1] < from[1] || to[1] == from[1] && to[0] > from[0];
            let side = cross(from, to, centre);
            side > 0 || side == 0 && top_left
        })
    };
    let all = (0..i64::from(SIZE[1])).flat_map(|y| (0..i64::from(SIZE[0])).map(move |x| [x, y]));
    all.filter(|at| cross(a, b, c) != 0 && inside(at.map(|t| t * pixel + pixel / 2))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    /// Spans, quads and marks are those of the definition, at any number of sub-pixel bits.
    #[test]
    fn spans_cover_what_the_definition_covers(
        bits in 0_u32..=12, coarse in any::<bool>(),
        raw in prop::array::uniform3([-0.3_f64..1.3, -0.3_f64..1.3]),
    ) {
        let step = if coarse { 0.5 } else { 1.0 / 4096.0 };
        let corner = |[x, y]: [f64; 2]| {
            let snap = |t: f64, size: u32| (t * f64::from(size) / step).round() * step;
            at(bits, [snap(x, SIZE[0]), snap(y, SIZE[1])])
        };
        let corners = raw.map(corner);
        let (cover, mut out) = (Cover::new(SIZE), Triangles::default());
        triangle(&target(bits), corners, &cover, &mut out);
        let pixels = direct(corners, bits);
        let quads: HashSet<[i64; 2]> = pixels.iter().map(|at| at.map(|t| t / 2)).collect();
        prop_assert_eq!(out.all(), 1);
        prop_assert_eq!((out.samples, out.quads), (pixels.len() as u64, quads.len() as u64));
        prop_assert_eq!(cover.pixels(), pixels.len() as u64);
    }

    /// Triangles round a point cover each pixel of the whole once.
    #[test]
    fn a_fan_covers_every_pixel_once(middle in [20.0_f64..60.0, 2.0_f64..17.0], bits in 0_u32..=8) {
        let corner = [[5.0, 1.0], [90.0, 0.5], [80.0, 19.0], [3.0, 17.5]];
        let fan = [0, 1, 2, 3].map(|k| [middle, corner[k], corner[(k + 1) % 4]]);
        let (counts, pixels) = counted(bits, &fan);
        prop_assert_eq!(counts.samples, pixels);
    }
}
