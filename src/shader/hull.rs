//! The hull shader's adaptive policy: control points in clip space in, tessellation factors out.
//!
//! The distance test of Concheiro et al. 2014 (Equation 9; AdptTess, section 4): the control
//! polygon of an edge is divided in its three cells, each with L candidate positions. At each, V_S
//! on the control polygon and V_B on the curve are projected to pixels, and a vertex is inserted
//! where they are more than a threshold apart:
//!
//! ```text
//!              P1 ·──·──·──·──· P2       k = 1 .. 3 (L + 1) - 1, no multiple of L + 1
//!              ·    V_S  │      ·        t = k / (3 (L + 1))
//!            ·          V_B       ·      V_S on the polygon, linear in its cell
//!       P0 ·                        · P3 V_B on the curve, paired as the domain shader's
//! ```
//!
//! The hardware places vertices evenly, so of the decisions only their number is used: the factor
//! is 3 and one more for each vertex inserted, at most 3 (L + 1).
//!
//! Each decision is a function of the edge's own four points, from weights of t and of 1 - t, each
//! rounded by itself, and of sums that only commute: the same bits from either end, so neighbours
//! agree. Operations are f32, in this order, none fused.

use super::domain::{Arithmetic, Singles, bernstein, paired};
use crate::config::d3d11::CANDIDATES_MAX;
use glam::{Vec2, Vec4, Vec4Swizzles};
use rtl_model::counter::standard::Ops;
use rtl_model::patch::EDGES;

/// Rows 1 and 2 of the net, then columns 1 and 2: what decides with the edges on the interior.
const INNER: [[usize; 4]; 4] = [[4, 5, 6, 7], [8, 9, 10, 11], [1, 5, 9, 13], [2, 6, 10, 14]];

/// The test's parameters. Constant over a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Candidate positions in each of an edge's three cells, L: 1..=[`CANDIDATES_MAX`].
    pub candidates: u32,
    /// Pixels that V_S and V_B are apart where no vertex is inserted yet: at least 0.
    pub pixels: f32,
    /// Width and height in pixels.
    pub viewport: [u32; 2],
    /// A point whose w is below this, or not above 0, has no projection and is inserted.
    pub near: f32,
}

/// Tessellation factors of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// Ueq0 Veq0 Ueq1 Veq1 InU InV, each a whole number 3..=3 (L + 1).
    pub factors: [f32; 6],
    /// Distance tests done.
    pub tests: u32,
}

/// A candidate position of a curve.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Bernstein weights.
    weights: [f32; 4],
    /// The cell, 0..3, and the weights of its two ends.
    cell: usize,
    ends: [f32; 2],
}

/// The policy and its table of positions, made once a draw.
#[derive(Clone, Debug)]
pub struct Adaptive {
    settings: Settings,
    candidates: Vec<Candidate>,
}

impl Adaptive {
    /// The policy of these settings.
    ///
    /// # Panics
    /// When the candidates are not 1..=20, or the threshold is negative or no number.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let l = settings.candidates;
        assert!((1..=CANDIDATES_MAX).contains(&l), "{l} candidates are outside 1..=20");
        assert!(settings.pixels >= 0.0, "a distance of {} pixels is below 0", settings.pixels);
        let candidates = positions(l).map(|k| candidate(k, l + 1)).collect();
        Self { settings, candidates }
    }

    /// The factors of a patch, from its points in clip space, row-major, u along the rows.
    ///
    /// Along u, the interior has the greatest factor of the edges v0 and v1 and of the net's rows 1
    /// and 2, tested as an edge is; along v, of u0, u1 and the columns.
    #[must_use]
    pub fn factors(&self, points: &[[f32; 4]; 16]) -> Factors {
        let points = points.map(Vec4::from_array);
        let factor = |curve: [usize; 4]| {
            let inserted = self.inserted(curve.map(|k| points[k]));
            3 + inserted.count_ones()
        };
        let [v0, u1, v1, u0] = EDGES.map(factor);
        let [row1, row2, column1, column2] = INNER.map(factor);
        let inner_u = v0.max(v1).max(row1).max(row2);
        let inner_v = u0.max(u1).max(column1).max(column2);
        let factors = [u0, v0, u1, v1, inner_u, inner_v].map(|n| n as f32);
        Factors { factors, tests: 8 * self.candidates.len() as u32 }
    }

    /// Where vertices are inserted on a curve of these control points in clip space: bit k stands
    /// for t = k / (3 (L + 1)).
    #[must_use]
    pub fn insertions(&self, curve: &[[f32; 4]; 4]) -> u64 {
        self.inserted(curve.map(Vec4::from_array))
    }

    fn inserted(&self, curve: [Vec4; 4]) -> u64 {
        let tested = positions(self.settings.candidates).zip(&self.candidates);
        tested.map(|(k, candidate)| u64::from(self.test(candidate, curve)) << k).sum()
    }

    /// |V_S - V_B| > pixels; also where one of them has no projection.
    #[inline]
    fn test(&self, at: &Candidate, curve: [Vec4; 4]) -> bool {
        let d = Singles;
        let ends = [curve[at.cell], curve[at.cell + 1]];
        let polygon = d.sum(d.scale(at.ends[0], ends[0]), d.scale(at.ends[1], ends[1]));
        let curve = paired(d, &at.weights, curve);
        let (Some(s), Some(b)) = (self.project(polygon), self.project(curve)) else { return true };
        let apart = s - b;
        let square = apart.x * apart.x + apart.y * apart.y;
        let near_enough = square <= self.settings.pixels * self.settings.pixels;
        !near_enough // of what is no number, neither is known
    }

    /// Pixels from the viewport's centre: differences do not depend on it, nor distances on which
    /// way y goes.
    fn project(&self, p: Vec4) -> Option<Vec2> {
        let half = Vec2::from(self.settings.viewport.map(|side| side as f32 / 2.0));
        let projected = p.w >= self.settings.near && p.w > 0.0;
        projected.then(|| p.xy() * (1.0 / p.w) * half)
    }
}

/// The numerators of the candidates' parameters, ascending.
fn positions(l: u32) -> impl Iterator<Item = u32> {
    (1..3 * (l + 1)).filter(move |k| k % (l + 1) != 0)
}

/// The candidate at k / (3 `cell`), `cell` being the positions from one cell's end to the next.
fn candidate(k: u32, cell: u32) -> Candidate {
    // Both from integers: 1 - t of a rounded t is another number than what the other end has.
    let of = |n: u32, of: u32| n as f32 / of as f32;
    let (whole, rest) = (3 * cell, k % cell);
    Candidate {
        weights: bernstein(Singles, of(k, whole), of(whole - k, whole)),
        cell: (k / cell) as usize,
        ends: [of(cell - rest, cell), of(rest, cell)],
    }
}

/// Reciprocals of w, to 24 bits, in a test: of V_S and of V_B.
pub const RECIPROCALS: u64 = 2;

/// What one distance test costs besides its reciprocals: the weights are constants. x, y and w only
/// of V_S (2 products, 1 sum) and V_B (4 and 3); each held against the threshold; two projected
/// coordinates each, times 1 / w and times the viewport; their difference, its square, and the
/// comparison.
#[must_use]
pub fn test() -> Ops {
    Ops::default()
        .muls(3 * (2 + 4) + 2 * 4 + 2, 24, 24)
        .adds(3 * (1 + 3) + 2 + 1, 24)
        .compares(3, 24)
}
