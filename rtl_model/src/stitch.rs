//! Stitch: rows of points in, the triangles between them out, one at a time.
//!
//! Moreton 2001, section 5.1: a Bresenham walk. Of the outer row's next segment and the inner
//! row's, the one whose midpoint comes first on the edge gets the next triangle. Midpoints are
//! never formed: `error` is their difference over the common denominator, so that no rounding can
//! change the topology. Each half of a side is walked from its corner to the middle, and the walk
//! is counted: no end needs a special case.
//!
//! ```text
//!     outer  o───o─────o─────o      n segments of the half-edge
//!            │ ╲ │  ╲ ╱ ╲    │
//!     inner  i─────i─────────i      m segments of the interior's first row
//! ```
//!
//! The interior is a grid whose diagonals point at the patch's centre. Triangles are
//! counter-clockwise with u right and v up: half 1 of a side and the sides v1 and u0 are walked
//! mirrored, so they swap two vertices.

mod degenerate;

use crate::patch::{Level, Triangle};
use crate::place::Placement;

pub use degenerate::Degenerate;

/// One Bresenham walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Walk {
    outer: i16,
    inner: i16,
    error: i16,
    left: i16,
}

/// Which row's segment a triangle stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Outer,
    Inner,
}

impl Walk {
    fn new(outer: usize, inner: usize) -> Self {
        let (outer, inner) = (outer as i16, inner as i16);
        Self { outer, inner, error: inner - outer, left: inner + outer }
    }
}

impl Iterator for Walk {
    type Item = Side;

    /// This cycle's triangle. `error` keeps to -128..=126 for half-rows of up to 64 segments: 8
    /// bits.
    #[inline]
    fn next(&mut self) -> Option<Side> {
        if self.left == 0 {
            return None;
        }
        self.left -= 1;
        Some(if self.error >= 0 {
            self.error -= 2 * self.outer;
            Side::Inner
        } else {
            self.error += 2 * self.inner;
            Side::Outer
        })
    }
}

/// The block, which keeps the triangles of its last patch: the next one has the same where its
/// lists have as many segments, for topology depends on nothing else.
#[derive(Clone, Debug, Default)]
pub struct Stitch {
    segments: [usize; 6],
    triangles: Vec<Triangle>,
}

impl Stitch {
    /// Stitches a patch.
    pub fn accept(&mut self, placement: &Placement) -> &[Triangle] {
        let [a, b, c, d] = [0, 1, 2, 3].map(|edge| placement.edges[edge].segments());
        let segments = [a, b, c, d, placement.u.segments(), placement.v.segments()];
        if segments != self.segments {
            self.segments = segments;
            self.triangles.clear();
            accept(placement, &mut self.triangles);
        }
        &self.triangles
    }

    /// The triangles of the last patch.
    #[must_use]
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }
}

/// Appends the triangles of a patch to `out`: the interior grid's, then side by side.
pub fn accept(placement: &Placement, out: &mut Vec<Triangle>) {
    let stitcher = Stitcher::new(placement);
    out.reserve(2 * placement.vertices());
    if stitcher.columns * stitcher.rows == 0 {
        out.extend([[0, 1, 2], [0, 2, 3]]); // every level is 1
        return;
    }
    stitcher.grid(out);
    for side in 0..4 {
        stitcher.side(side, out);
    }
}

/// How many of a patch's triangles are the interior grid's: the first ones.
fn grid_triangles(placement: &Placement) -> usize {
    let [columns, rows] = placement.interior();
    2 * columns.saturating_sub(1) * rows.saturating_sub(1)
}

struct Stitcher<'a> {
    placement: &'a Placement,
    starts: [usize; 5],
    columns: usize,
    rows: usize,
    /// 1 < greatest level < 2: the interior is one cell and no vertex stands at a centre.
    below_two: bool,
}

impl<'a> Stitcher<'a> {
    fn new(placement: &'a Placement) -> Self {
        let [columns, rows] = placement.interior();
        let below_two = placement.u.level() < Level::TWO;
        Self { placement, starts: placement.starts(), columns, rows, below_two }
    }

    fn interior(&self, column: usize, row: usize) -> u16 {
        (self.starts[4] + row * self.columns + column) as u16
    }

    /// The cells of the interior.
    fn grid(&self, out: &mut Vec<Triangle>) {
        let (cells, width) = (self.columns - 1, self.columns as u16);
        for j in 0..self.rows - 1 {
            let start = out.len();
            out.resize(start + 2 * cells, [0; 3]);
            let first = self.interior(0, j);
            for (i, pair) in out[start..].chunks_exact_mut(2).enumerate() {
                let a = first + i as u16;
                let [b, c, d] = [a + 1, a + 1 + width, a + width];
                let towards_centre = (2 * i < cells) == (2 * j < self.rows - 1);
                let triangles =
                    if towards_centre { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                pair.copy_from_slice(&triangles);
            }
        }
    }

    /// One side: two half-stitches, and the segment across the centre where there is one.
    fn side(&self, side: usize, out: &mut Vec<Triangle>) {
        let edge = &self.placement.edges[side];
        let outer_half = edge.half_segments();
        let inner_half = if self.below_two { 0 } else { (self.along(side) - 1) / 2 };
        for end in 0..2 {
            let (outer, inner) = (self.outer(side, end), self.inner(side, end));
            let mirrored = (side >= 2) != (end == 1);
            let (mut i, mut o) = (0, 0);
            for step in Walk::new(outer_half, inner_half) {
                let [a, b, c] = match step {
                    Side::Inner => {
                        i += 1;
                        [inner.at(i - 1), outer.at(o), inner.at(i)]
                    }
                    Side::Outer => {
                        o += 1;
                        [outer.at(o - 1), outer.at(o), inner.at(i)]
                    }
                };
                out.push(if mirrored { [a, c, b] } else { [a, b, c] });
            }
        }
        if edge.crosses_centre() {
            self.across(side, outer_half, inner_half, out);
        }
    }

    /// The segment across the centre. Its diagonal starts at the end that lies at (0, 0) or (1, 1).
    fn across(&self, side: usize, outer: usize, inner: usize, out: &mut Vec<Triangle>) {
        let end = usize::from(side == 1 || side == 2);
        let first = self.outer(side, end).at(outer as i32);
        let last = self.outer(side, 1 - end).at(outer as i32);
        let mirrored = (side >= 2) != (end == 1);
        let mut push = |a, b, c| out.push(if mirrored { [a, c, b] } else { [a, b, c] });
        if self.below_two {
            let (near, far) = (self.inner(side, end).at(0), self.inner(side, 1 - end).at(0));
            push(near, first, far);
            push(first, last, far);
        } else {
            push(first, last, self.inner(side, end).at(inner as i32));
        }
    }

    /// Interior vertices along a side.
    fn along(&self, side: usize) -> usize {
        if side & 1 == 0 { self.columns } else { self.rows }
    }

    /// The boundary vertices of a side, from one of its ends.
    fn outer(&self, side: usize, end: usize) -> Row {
        // v1 and u0 run against the numbering, which ends where it began: at vertex 0.
        let end_of_all = self.starts[4] as i32;
        if (side < 2) == (end == 0) {
            Row { first: self.starts[side] as i32, step: 1, end_of_all }
        } else {
            Row { first: self.starts[side + 1] as i32, step: -1, end_of_all }
        }
    }

    /// The interior's vertices along a side, from one of its ends.
    fn inner(&self, side: usize, end: usize) -> Row {
        let (columns, rows) = (self.columns - 1, self.rows - 1);
        let from = [(0, 0), (columns, 0), (0, rows), (0, 0)][side];
        let to = [(columns, 0), (columns, rows), (columns, rows), (0, rows)][side];
        let (column, row) = if end == 0 { from } else { to };
        let step = if side & 1 == 0 { 1 } else { self.columns as i32 };
        Row {
            first: self.interior(column, row).into(),
            step: if end == 0 { step } else { -step },
            end_of_all: i32::MAX,
        }
    }
}

/// Vertices at equal distances in the numbering.
#[derive(Clone, Copy)]
struct Row {
    first: i32,
    step: i32,
    /// The number after the last, which is vertex 0 again.
    end_of_all: i32,
}

impl Row {
    #[inline(always)]
    fn at(self, k: i32) -> u16 {
        let vertex = self.first + k * self.step;
        if vertex == self.end_of_all { 0 } else { vertex as u16 }
    }
}
