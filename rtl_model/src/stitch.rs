//! Stitch: rows of points in, the triangles between them out, one at a time.
//!
//! Moreton 2001, section 5.1: a Bresenham walk. Of the outer row's next segment and the inner row's, the one whose
//! midpoint comes first on the edge gets the next triangle. Midpoints are never formed: `error` is their difference
//! over the common denominator, so that no rounding can change the topology. Each half of a side is walked from its
//! corner to the middle, and the walk is counted: no end needs a special case.
//!
//! ```text
//!     outer  o───o─────o─────o      n segments of the half-edge
//!            │ ╲ │  ╲ ╱ ╲    │
//!     inner  i─────i─────────i      m segments of the interior's first row
//! ```
//!
//! The interior is a grid whose diagonals point at the patch's centre. Triangles are counter-clockwise with u right
//! and v up: half 1 of a side and the sides v1 and u0 are walked mirrored, so they swap two vertices.

use crate::patch::{Level, Triangle};
use crate::place::Placement;

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

    /// This cycle's triangle. `error` keeps to -128..=126 for half-rows of up to 64 segments: 8 bits.
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

/// Appends the triangles of a patch to `out`.
pub fn accept(placement: &Placement, out: &mut Vec<Triangle>) {
    let stitcher = Stitcher::new(placement);
    if stitcher.columns * stitcher.rows == 0 {
        out.extend([[0, 1, 2], [0, 2, 3]]); // every level is 1
        return;
    }
    stitcher.grid(out);
    for side in 0..4 {
        stitcher.side(side, out);
    }
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
        for j in 0..self.rows - 1 {
            for i in 0..self.columns - 1 {
                let a = self.interior(i, j);
                let (b, d) = (a + 1, a + self.columns as u16);
                let c = d + 1;
                if (2 * i < self.columns - 1) == (2 * j < self.rows - 1) {
                    out.extend([[a, b, c], [a, c, d]]);
                } else {
                    out.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }

    /// One side: two half-stitches, and the segment across the centre where there is one.
    fn side(&self, side: usize, out: &mut Vec<Triangle>) {
        let edge = &self.placement.edges[side];
        let along = if side % 2 == 0 { self.columns } else { self.rows };
        let outer_half = edge.half_segments();
        let inner_half = if self.below_two { 0 } else { (along - 1) / 2 };
        let outer = |end: usize, k: usize| {
            let k = if end == 0 { k } else { edge.segments() - k };
            self.placement.boundary_vertex(&self.starts, side, k) as u16
        };
        let inner = |end: usize, k: usize| {
            let k = if end == 0 { k } else { along - 1 - k };
            match side {
                0 => self.interior(k, 0),
                1 => self.interior(self.columns - 1, k),
                2 => self.interior(k, self.rows - 1),
                _ => self.interior(0, k),
            }
        };
        let mut triangle = |a: u16, b: u16, c: u16, end: usize| {
            out.push(if (side >= 2) != (end == 1) { [a, c, b] } else { [a, b, c] });
        };
        for end in 0..2 {
            let (mut i, mut o) = (0, 0);
            for step in Walk::new(outer_half, inner_half) {
                match step {
                    Side::Inner => {
                        triangle(inner(end, i), outer(end, o), inner(end, i + 1), end);
                        i += 1;
                    }
                    Side::Outer => {
                        triangle(outer(end, o), outer(end, o + 1), inner(end, i), end);
                        o += 1;
                    }
                }
            }
        }
        if edge.crosses_centre() {
            // The diagonal starts at the end that lies at (0, 0) or (1, 1).
            let end = usize::from(side == 1 || side == 2);
            let (first, last) = (outer(end, outer_half), outer(1 - end, outer_half));
            if self.below_two {
                triangle(inner(end, 0), first, inner(1 - end, 0), end);
                triangle(first, last, inner(1 - end, 0), end);
            } else {
                triangle(first, last, inner(end, inner_half), end);
            }
        }
    }
}
