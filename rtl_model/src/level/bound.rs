//! The two criteria that look at pixels: lengths of differences between projected control points,
//! and levels from them, all in integers and rounded up, so that a bound stays a bound.

use super::{Asked, Lengths, Pixel, State, clamp};
use crate::number::sqrt_ceil;
use crate::patch::EDGES;

/// Rounding moves a projected coordinate by up to half an ulp, a second difference by 2 and its
/// length by less than 3: added, so that the rounded points bound the true ones.
const SLACK: u128 = 3;

/// Lines of the net: rows along u, columns along v.
pub(super) const ROWS: [[usize; 4]; 4] =
    [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11], [12, 13, 14, 15]];
pub(super) const COLUMNS: [[usize; 4]; 4] =
    [[0, 4, 8, 12], [1, 5, 9, 13], [2, 6, 10, 14], [3, 7, 11, 15]];

/// Lengths of control polygons: of the edges, and the longest rows and columns.
pub(super) fn lengths(points: &[Pixel; 16]) -> Lengths {
    let length = |line: [usize; 4]| {
        let mut length = 0; // ulps of 2^-16 pixels
        for pair in line.windows(2) {
            let ([ax, ay], [bx, by]) = (points[pair[0]]?, points[pair[1]]?);
            length += norm(bx - ax, by - ay) as u64;
        }
        Some(length)
    };
    Lengths {
        edges: EDGES.map(length),
        interior: [ROWS, COLUMNS].map(|lines| largest(lines.map(length))),
    }
}

/// Lengths over `pixels` (UQ16.16).
pub(super) fn edge_length(Lengths { edges, interior }: Lengths, pixels: u32) -> Asked {
    let level = |length: Option<u64>| {
        let quotient = (u128::from(length?) << 16).div_ceil(u128::from(pixels));
        Some(quotient as u64)
    };
    Asked { edges: edges.map(level), interior: interior.map(level) }
}

/// Levels that keep boundary curves and interior within `pixels` (UQ16.16).
pub(super) fn flatness(points: &[Pixel; 16], pixels: u32, state: &State) -> Asked {
    let level = |line: [usize; 4]| Some(curve_level(bend(points, line)?, pixels));
    let edges = EDGES.map(level);
    let interior = interior(points, pixels, edges, state);
    Asked { edges, interior: interior.map_or([None; 2], |levels| levels.map(Some)) }
}

/// The greater of a cubic's two second differences, in ulps.
fn bend(points: &[Pixel; 16], line: [usize; 4]) -> Option<u128> {
    let [a, b, c, d] = line.map(|k| points[k]);
    let ([a, b], [c, d]) = ([a?, b?], [c?, d?]);
    let second = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        norm(p[0] + r[0] - 2 * q[0], p[1] + r[1] - 2 * q[1]) + SLACK
    };
    Some(second(a, b, c).max(second(b, c, d)))
}

/// n >= sqrt(3/4 bend / d), UQ.16: n^2 2^32 = 3/4 bend 2^32 / pixels.
fn curve_level(bend: u128, pixels: u32) -> u64 {
    sqrt_ceil(((3 * bend) << 30).div_ceil(u128::from(pixels))) as u64
}

/// Levels along u and v for which 6 Muu/n^2 + 18 Muv/(n m) + 6 Mvv/m^2 <= 8 d, M the second
/// differences of the net.
fn interior(
    points: &[Pixel; 16],
    pixels: u32,
    edges: [Option<u64>; 4],
    state: &State,
) -> Option<[u64; 2]> {
    let along = |lines: [[usize; 4]; 4]| {
        let bends = lines.map(|line| bend(points, line));
        bends.into_iter().try_fold(0, |most, bend| Some(bend?.max(most)))
    };
    let (uu, vv, uv) = (along(ROWS)?, along(COLUMNS)?, twist(points)?);
    // From the levels that the edges will really get, and the net's own lines, ...
    let start = |a: Option<u64>, b: Option<u64>, bend| {
        let level = a?.max(b?).max(curve_level(bend, pixels));
        Some(u128::from(clamp(level, state).fx16()))
    };
    let (n, m) = (start(edges[0], edges[2], uu)?, start(edges[1], edges[3], vv)?);
    // ... both are raised by sqrt(bound / d) where the bound exceeds d. 24 bits each for n and m,
    // 45 for M.
    let bound = 6 * uu * m * m + 18 * uv * n * m + 6 * vv * n * n;
    let pixels = u128::from(pixels);
    let raised = |level: u128, across: u128| {
        // level^2 * bound * 2^32 / (8 d n^2 m^2): of the two squares below, `level`'s own cancels
        let square = (bound << 29).div_ceil(pixels * across * across);
        sqrt_ceil(square).max(level) as u64
    };
    Some([raised(n, m), raised(m, n)])
}

/// The greatest mixed difference of the nine facets, in ulps.
fn twist(points: &[Pixel; 16]) -> Option<u128> {
    let mut most = 0;
    for k in (0..3).flat_map(|i| (0..3).map(move |j| 4 * i + j)) {
        let (a, b, c, d) = (points[k]?, points[k + 1]?, points[k + 4]?, points[k + 5]?);
        most = most.max(norm(a[0] - b[0] - c[0] + d[0], a[1] - b[1] - c[1] + d[1]) + SLACK);
    }
    Some(most)
}

fn largest(levels: [Option<u64>; 4]) -> Option<u64> {
    levels.into_iter().try_fold(0, |most, level| Some(level?.max(most)))
}

/// |(x, y)|, rounded up.
fn norm(x: i64, y: i64) -> u128 {
    let (x, y) = (i128::from(x), i128::from(y));
    sqrt_ceil((x * x + y * y) as u128)
}
