//! Level: control points in, the level of each edge and of the interior out, as real numbers of
//! pixels give it.
//!
//! Closed formulas (LITERATURE of the second-derivative bound: Wang 1984; of the surface: Filip,
//! Magedson, Markot 1986) in f64, from unrounded projections. A curve in n equal steps stays
//! within 1/8 max|B''| / n^2 of its chords, B'' being 6 times a mix of the second differences; a
//! surface in n by m within 1/8 (Muu/n^2 + 2 Muv/(n m) + Mvv/m^2).

mod subdivide;

use rtl_model::patch::{EDGES, Point, View};

pub use subdivide::{Piece, Verdict, verdict};

/// How levels are chosen, in real pixels and segments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// The surface stays within so many pixels of its triangles.
    Flatness(f64),
    /// Length of the projected control polygon over so many pixels.
    EdgeLength(f64),
    /// This level.
    Fixed(f64),
}

/// Levels; `None` where a point has no projection, which asks for the greatest level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Of the edges v0, u1, v1, u0.
    pub edges: [Option<f64>; 4],
    /// Of the interior along u and v.
    pub interior: [Option<f64>; 2],
}

/// A projected point in pixels from the centre of the viewport; `None` where there is none.
pub type Pixel = Option<[f64; 2]>;

/// The greatest magnitude of a projection: what Q24.16 holds after rounding.
const PIXEL_MAX: f64 = 8_388_608.0 - 1.5 / 65536.0;

/// Bounds of the differences of a control net, in pixels: second along u and v, and mixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bends {
    /// |P0 - 2 P1 + P2| along u.
    pub uu: f64,
    /// |P00 - P01 - P10 + P11|.
    pub uv: f64,
    /// Along v.
    pub vv: f64,
}

/// Projects the points of a patch. A point nearer than the threshold, or too far outside, has no
/// projection.
#[must_use]
pub fn project(points: &[Point; 16], view: &View) -> [Pixel; 16] {
    points.map(|p| {
        let [x, y, _, w] = p.map(|c| c as f64);
        let pixel = [0, 1].map(|k| [x, y][k] / w * f64::from(view.viewport[k]) / 2.0);
        let fits = pixel.iter().all(|c| c.abs() <= PIXEL_MAX);
        (p[3] > 0 && p[3] >= view.near && fits).then_some(pixel)
    })
}

/// What the criterion asks for; `range` bounds the levels that edges will get.
#[must_use]
pub fn asked(pixels: &[Pixel; 16], criterion: Criterion, range: [f64; 2]) -> Asked {
    match criterion {
        Criterion::Fixed(level) => Asked { edges: [Some(level); 4], interior: [Some(level); 2] },
        Criterion::EdgeLength(d) => {
            let level = |line: [usize; 4]| Some(length(take(pixels, line)?) / d);
            let longest = |axis| {
                let levels: Option<Vec<f64>> = lines(axis).map(level).into_iter().collect();
                Some(levels?.into_iter().fold(0.0, f64::max))
            };
            Asked { edges: EDGES.map(level), interior: [longest(0), longest(1)] }
        }
        Criterion::Flatness(d) => {
            let level = |line| Some(curve(bend(take(pixels, line)?), d));
            let edges = EDGES.map(level);
            let interior = bends(pixels).map(|bends| {
                let start = start(edges, bends, d, range);
                surface(bends, start, d).map(Some)
            });
            Asked { edges, interior: interior.unwrap_or([None; 2]) }
        }
    }
}

/// The level of a curve: 1/8 * 6 bend / n^2 = d.
#[must_use]
pub fn curve(bend: f64, d: f64) -> f64 {
    (6.0 * bend / (8.0 * d)).powf(0.5)
}

/// The differences of a net.
#[must_use]
pub fn bends(pixels: &[Pixel; 16]) -> Option<Bends> {
    let greatest =
        |axis| lines(axis).iter().try_fold(0f64, |most, &l| Some(most.max(bend(take(pixels, l)?))));
    let mut uv = 0f64;
    for k in [0, 1, 2, 4, 5, 6, 8, 9, 10] {
        let [a, b, c, d] = take(pixels, [k, k + 1, k + 4, k + 5])?;
        uv = uv.max((a[0] - b[0] - c[0] + d[0]).hypot(a[1] - b[1] - c[1] + d[1]));
    }
    Some(Bends { uu: greatest(0)?, uv, vv: greatest(1)? })
}

/// The levels along u and v that the edges and the net's own lines ask for, within `range`.
#[must_use]
pub fn start(edges: [Option<f64>; 4], bends: Bends, d: f64, range: [f64; 2]) -> [f64; 2] {
    let along = |a: Option<f64>, b: Option<f64>, bend| {
        let edges = a.unwrap_or(range[1]).max(b.unwrap_or(range[1]));
        edges.max(curve(bend, d)).clamp(range[0], range[1])
    };
    [along(edges[0], edges[2], bends.uu), along(edges[1], edges[3], bends.vv)]
}

/// Levels n by m, and their proportion kept, at which the surface is within `d`.
#[must_use]
pub fn surface(bends: Bends, [n, m]: [f64; 2], d: f64) -> [f64; 2] {
    let excess = (deviation(bends, [n, m]) / d).powf(0.5).max(1.0);
    [n * excess, m * excess]
}

/// The bound of a surface's distance from its triangles in n by m steps: 1/8 (Muu/n^2 + 2 Muv/(n
/// m) + Mvv/m^2).
#[must_use]
pub fn deviation(Bends { uu, uv, vv }: Bends, [n, m]: [f64; 2]) -> f64 {
    let (suu, suv, svv) = (6.0 * uu, 9.0 * uv, 6.0 * vv); // second derivatives of a bicubic
    (suu / (n * n) + 2.0 * suv / (n * m) + svv / (m * m)) / 8.0
}

/// The net's lines along u (0) or v (1).
fn lines(axis: usize) -> [[usize; 4]; 4] {
    [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| if axis == 0 { 4 * i + j } else { 4 * j + i }))
}

fn take(pixels: &[Pixel; 16], [a, b, c, d]: [usize; 4]) -> Option<[[f64; 2]; 4]> {
    Some([pixels[a]?, pixels[b]?, pixels[c]?, pixels[d]?])
}

/// The greater second difference of a cubic.
fn bend(p: [[f64; 2]; 4]) -> f64 {
    let second = |k: usize| {
        let axis = |i: usize| p[k][i] - 2.0 * p[k + 1][i] + p[k + 2][i];
        axis(0).hypot(axis(1))
    };
    second(0).max(second(1))
}

/// The length of a control polygon.
fn length(p: [[f64; 2]; 4]) -> f64 {
    p.windows(2).map(|s| (s[1][0] - s[0][0]).hypot(s[1][1] - s[0][1])).sum()
}
