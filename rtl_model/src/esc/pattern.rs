//! Pattern: the cells, coarse triangles and coarse edges of a patch, its grid, and the parameters
//! of the grid's lines.
//!
//! Concheiro et al. 2014, section 3: 3 x 3 cells, two coarse triangles each. The paper does not say
//! which diagonal divides a cell; here it is b-c in every one, so that rows run parallel to it.
//!
//! ```text
//!   v   3  ┌──┬──┬──┐     c────d    first triangle: apex a, left a-b, right a-c, bottom b-c
//!   ▲   2  ├──┼──┼──┤     │╲ 2 │    second:         apex d, left d-c, right d-b, bottom c-b
//!   │   1  ├──┼──┼──┤     │ ╲  │
//!   └─► 0  └──┴──┴──┘     │1 ╲ │    both counter-clockwise with u right and v up
//!    u     0  1  2  3     a────b
//! ```
//!
//! Cells come row by row. At level L a coarse edge has R = L + 1 segments, and the patch a grid of
//! 3 R + 1 lines either way, of which line i lies at i / (3 R). An edge of the patch has a level of
//! its own, at most the interior's: candidate k of a third of it, at k / R' of the third, is
//! carried by the candidate of the interior's pattern that is nearest to it ([`slot`]), and stands
//! at its own place. The mesh inside knows the slots only, so it is that of the uniform pattern.

use super::{Insertion, LEVEL_MAX, Levels, Site};
use crate::patch::ONE;

/// Coarse triangles of a patch.
pub const COARSE_TRIANGLES: usize = 18;

/// Coarse edges of a patch: 12 along u, 12 along v, 9 diagonals.
pub const COARSE_EDGES: usize = 33;

/// Lines of the finest grid, either way.
pub(super) const LINES_MAX: usize = 3 * (LEVEL_MAX as usize + 1) + 1;

/// A corner of cells, `[u, v]` in thirds: 0 to 3 each.
pub type Corner = [u8; 2];

/// A crossing of the grid's lines, `[along u, along v]`: 0 to 3 R each.
pub type Place = [u8; 2];

/// An edge that coarse triangles share, in the direction of the growing parameter; a diagonal in
/// that of v.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CoarseEdge {
    /// Where it begins.
    pub from: Corner,
    /// Where it ends.
    pub to: Corner,
}

impl CoarseEdge {
    /// All, in the order of their numbers: along u row by row, along v likewise, diagonals.
    pub const ALL: [Self; COARSE_EDGES] = coarse_edges();

    /// The grid's crossing at `position`, 0 to R, for R segments.
    #[must_use]
    pub const fn place(self, position: u8, segments: u8) -> Place {
        [
            self.from[0] * (segments - position) + self.to[0] * position,
            self.from[1] * (segments - position) + self.to[1] * position,
        ]
    }

    /// The edge of the patch on which it lies, as in [`crate::patch::EDGES`], and which third of it
    /// it is; none inside.
    #[must_use]
    pub const fn third(self) -> Option<(usize, u8)> {
        let ([u, v], [to_u, to_v]) = (self.from, self.to);
        match (u == to_u, v == to_v) {
            (false, true) if v == 0 => Some((0, u)),
            (false, true) if v == 3 => Some((2, u)),
            (true, false) if u == 3 => Some((1, v)),
            (true, false) if u == 0 => Some((3, v)),
            _ => None,
        }
    }

    /// Candidates of it: its own level.
    #[must_use]
    pub const fn level(self, levels: Levels) -> u8 {
        match self.third() {
            Some((edge, _)) => levels.edges[edge],
            None => levels.interior,
        }
    }
}

const fn coarse_edges() -> [CoarseEdge; COARSE_EDGES] {
    let mut all = [CoarseEdge { from: [0; 2], to: [0; 2] }; COARSE_EDGES];
    let mut p = 0;
    while p < 4 {
        let mut q = 0;
        while q < 4 {
            if p < 3 {
                all[along_u(p, q)] = CoarseEdge { from: [p, q], to: [p + 1, q] };
            }
            if q < 3 {
                all[along_v(p, q)] = CoarseEdge { from: [p, q], to: [p, q + 1] };
            }
            if p < 3 && q < 3 {
                all[diagonal(p, q)] = CoarseEdge { from: [p + 1, q], to: [p, q + 1] };
            }
            q += 1;
        }
        p += 1;
    }
    all
}

const fn along_u(p: u8, q: u8) -> usize {
    (3 * q + p) as usize
}

const fn along_v(p: u8, q: u8) -> usize {
    (12 + 4 * q + p) as usize
}

const fn diagonal(p: u8, q: u8) -> usize {
    (24 + 3 * q + p) as usize
}

/// One of the two triangles of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CoarseTriangle {
    /// The cell's corner a.
    pub cell: Corner,
    /// Whether it is the cell's second triangle, whose apex is d: all three of its edges then run
    /// against the coarse edges' direction.
    pub second: bool,
    /// Numbers of the left, right and bottom edge.
    pub edges: [usize; 3],
}

impl CoarseTriangle {
    /// All: cell by cell, the first triangle and the second.
    pub const ALL: [Self; COARSE_TRIANGLES] = coarse_triangles();

    /// The insertion whose edges have these masks, bit p for position p in the coarse edge's
    /// direction.
    #[must_use]
    pub fn insertion(self, level: u8, masks: &[u16; COARSE_EDGES]) -> Insertion {
        let [left, right, bottom] = self
            .edges
            .map(|edge| if self.second { reversed(masks[edge], level) } else { masks[edge] });
        Insertion::new(level, left, right, bottom)
    }

    /// The grid's crossing at `site`, for R segments.
    #[must_use]
    pub const fn place(self, site: Site, segments: u8) -> Place {
        let [p, q] = self.cell;
        let (along_u, along_v) = (site.row - site.place, site.place);
        if self.second {
            [(p + 1) * segments - along_u, (q + 1) * segments - along_v]
        } else {
            [p * segments + along_u, q * segments + along_v]
        }
    }
}

const fn coarse_triangles() -> [CoarseTriangle; COARSE_TRIANGLES] {
    let mut all = [CoarseTriangle { cell: [0; 2], second: false, edges: [0; 3] }; COARSE_TRIANGLES];
    let mut n = 0;
    while n < COARSE_TRIANGLES as u8 {
        let (p, q, second) = (n / 2 % 3, n / 6, n % 2 == 1);
        let edges = if second {
            [along_u(p, q + 1), along_v(p + 1, q), diagonal(p, q)]
        } else {
            [along_u(p, q), along_v(p, q), diagonal(p, q)]
        };
        all[n as usize] = CoarseTriangle { cell: [p, q], second, edges };
        n += 1;
    }
    all
}

/// Bits 1 to `level` the other way round.
const fn reversed(mask: u16, level: u8) -> u16 {
    // Position p goes to L + 1 - p: bit p of 16 goes to 15 - p, and that down by 14 - L.
    let turned = (mask as u32).reverse_bits() >> 16; // 15 - p, all of 1 to 15
    ((turned << 1) >> (15 - level)) as u16
}

/// The candidate of the interior's pattern that carries candidate `k`, 1 to `level`, of a third of
/// an edge of the patch: round(k R / R'), half up. Different ones for different k, for R' <= R.
#[must_use]
pub const fn slot(k: u8, level: u8, interior: u8) -> u8 {
    let [k, own, inner] = [k as u16, level as u16 + 1, interior as u16 + 1];
    ((2 * k * inner + own) / (2 * own)) as u8
}

/// All candidates of every coarse edge: the uniform pattern, thinned on edges of lower levels.
#[must_use]
pub fn uniform(levels: Levels) -> [u16; COARSE_EDGES] {
    CoarseEdge::ALL.map(|edge| {
        let level = edge.level(levels);
        (1..=level).map(|k| 1 << slot(k, level, levels.interior)).sum()
    })
}

/// Where the lines of the grid of each level are: round(i 2^F / n) in U1.F, n = 3 (L + 1) of a
/// level L. No ties but exact values, so that line i and line n - i are at t and 1 - t, and the
/// thirds are the same at every level.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    fx: Vec<[u64; LINES_MAX]>,
    fx16: Vec<[u32; LINES_MAX]>,
}

impl Parameters {
    /// Of `bits` fraction bits.
    pub(super) fn new(bits: u32) -> Self {
        let line = |level: u8, i: usize, bits: u32| {
            let (n, i) = (3 * (u64::from(level) + 1), i as u64);
            // 46 + 1 bits times 6 bits
            ((i.min(n) << (bits + 1)) + n) / (2 * n)
        };
        let levels = 0..=LEVEL_MAX;
        Self {
            fx: levels.clone().map(|l| std::array::from_fn(|i| line(l, i, bits))).collect(),
            fx16: levels.map(|l| std::array::from_fn(|i| line(l, i, 16) as u32)).collect(),
        }
    }

    /// Line `i` of a level, in U1.F.
    pub(super) fn fx(&self, level: u8, i: u8) -> u64 {
        self.fx[usize::from(level)][usize::from(i)]
    }

    /// Line `i` of a level, in U1.16.
    pub(super) fn fx16(&self, level: u8, i: u8) -> u32 {
        self.fx16[usize::from(level)][usize::from(i)]
    }
}

/// The fraction i / n, reduced, that a vertex's parameter (U1.16) stands for. Of fractions with n
/// of at most 48, two are at least 1/2256, or 29 ulps, apart.
///
/// # Panics
/// Where the parameter is none of a vertex of this shader.
#[must_use]
pub fn fraction(fx16: u32) -> (u32, u32) {
    let most = 3 * (u32::from(LEVEL_MAX) + 1);
    let nearest = |n: u32| (fx16 * n + ONE / 2) / ONE;
    let found = (1..=most).find(|&n| (2 * nearest(n) * ONE + n) / (2 * n) == fx16);
    let n = found.expect("a parameter is a fraction of at most 48 parts");
    (nearest(n), n) // the least n makes it reduced
}
