//! Strip: two rows of a patch's vertices and what joins them. A patch's lists in, strips out: the
//! tokens between evaluate and stitch.
//!
//! Moreton 2001, section 5.1: what lies between two rows is stitched while they are at hand, with
//! nothing kept but two vertices and an error. There are three kinds of walk:
//!
//! ```text
//!   cells        inner  d───c───┬───┬───┐     a row of the interior grid, which is regular;
//!                       │ ╱ │ ╱ │ ╲ │ ╲ │     its diagonals point at the patch's centre
//!                outer  a───b───┴───┴───┘
//!
//!   Bresenham    outer  o───o─────o─────o     half of a side, from a corner to the middle:
//!                       │ ╲ │  ╲ ╱ ╲    │     n segments of the edge,
//!                inner  i─────i─────────i     m of the interior's first row or column
//!
//!   zipper       outer  o─o─o───o───────o     a whole side between dyadic lists, from its lower
//!                       │  ╲│  ╱ ╲   ╱  │     end: the row whose next parameter is the smaller
//!                inner  i───i───────i───i     advances, the outer one of two that tie
//! ```
//!
//! Bresenham: of the outer row's next segment and the inner row's, the one whose midpoint comes
//! first gets the next triangle. Midpoints are never formed: `error` is their difference over the
//! common denominator, so that no rounding can change the topology. The walk is counted, so no end
//! needs a special case; the segment across an edge's centre (levels below 2) is a strip of one
//! outer segment and of as many inner ones as there are. A patch of level 1 is a cell.
//!
//! Zipper (Sfarti et al. 2005, section 6; what it does is ours): a merge of two ascending lists,
//! which is decided from the lists' masks. So a strip carries the decisions, a bit a triangle, and
//! a side of more than 64 triangles is several strips.
//!
//! Triangles are counter-clockwise with u right and v up. Half 1 of a side, and the sides v1 and
//! u0, are walked mirrored, so they swap two vertices.

mod dyadic;
mod fractional;
mod rows;

use crate::patch::Triangle;
use crate::place::Numbering;
use std::fmt;

pub use crate::place::Segments;

/// How the two rows are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Pairs of triangles between rows of equally many segments.
    Cells {
        /// Whether the row lies below the patch's centre: the diagonals of the first half of its
        /// cells then start at the outer row.
        lower: bool,
    },
    /// A walk that puts each triangle where the next segment's midpoint is.
    Bresenham,
    /// A walk that is told which row advances.
    Zipper {
        /// Bit k: triangle k stands on the inner row. A strip has at most 64 triangles.
        steps: u64,
    },
}

/// Vertices at equal distances in the patch's numbering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Number of the first vertex: 15 bits.
    pub first: u16,
    /// From one vertex to the next: -127..=127.
    pub step: i16,
}

impl Row {
    /// The row from its vertex `k` on.
    fn from(self, k: usize) -> Self {
        Self { first: self.at(k as u16), ..self }
    }

    #[inline(always)]
    fn at(self, k: u16) -> u16 {
        self.first.wrapping_add(k.wrapping_mul(self.step as u16)) // a negative step wraps twice
    }

    #[inline(always)]
    fn next(self) -> Self {
        Self { first: self.first.wrapping_add_signed(self.step), ..self }
    }
}

/// A strip: everything that its triangles are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strip {
    /// How the rows are joined.
    pub kind: Kind,
    /// The row on the outside; its step is 1 or -1.
    pub outer: Row,
    /// The row on the inside.
    pub inner: Row,
    /// Segments of the outer row: 0 to 126.
    pub outer_segments: u8,
    /// Segments of the inner row: 0 to 126.
    pub inner_segments: u8,
    /// Whether the rows run clockwise, so that triangles swap their last two vertices.
    pub mirrored: bool,
    /// The number after the last boundary vertex, at most 512: an outer row that begins with it
    /// begins with vertex 0. It is 0 where the outer row is no edge's.
    pub end: u16,
    /// Interior rows of the patch that must be complete before the strip can be stitched, from the
    /// first one: 0 to 127. (Boundary vertices come before all interior ones.)
    pub rows_needed: u8,
    /// Whether it is its patch's first strip.
    pub first: bool,
    /// Whether it is its patch's last strip.
    pub last: bool,
}

impl Strip {
    /// How many triangles it has: 1 to 252. Each stands on a segment of one of the rows.
    #[must_use]
    pub fn count(&self) -> u32 {
        u32::from(self.outer_segments) + u32::from(self.inner_segments)
    }

    /// Its triangles, in order.
    #[must_use]
    pub fn triangles(&self) -> Triangles {
        Triangles { strip: *self, error: self.error(), left: self.count() as u8 }
    }

    /// Writes its triangles to `out`, which has as many places: faster than one by one.
    #[inline]
    pub fn fill(&self, out: &mut [Triangle]) {
        if let Kind::Cells { lower } = self.kind {
            let (cells, (pairs, _)) = (self.outer_segments, out.as_chunks_mut());
            let (before, after) = pairs.split_at_mut(usize::from(cells.div_ceil(2)));
            self.cells(0, lower, before);
            self.cells(cells.div_ceil(2).into(), !lower, after);
        } else if let Kind::Zipper { steps } = self.kind {
            let mut walk = self.triangles();
            for (k, triangle) in out.iter_mut().enumerate() {
                *triangle = walk.on(steps >> k & 1 != 0);
            }
        } else {
            let mut walk = self.triangles();
            out.iter_mut().for_each(|triangle| *triangle = walk.step());
        }
    }

    /// Hands its triangles to `take`, in order: as [`Self::triangles`], and faster.
    #[inline]
    pub fn for_each(&self, mut take: impl FnMut(Triangle)) {
        let lower = match self.kind {
            Kind::Cells { lower } => lower,
            Kind::Bresenham => {
                let mut walk = self.triangles();
                return (0..self.count()).for_each(|_| take(walk.step()));
            }
            Kind::Zipper { steps } => {
                let mut walk = self.triangles();
                return (0..self.count()).for_each(|k| take(walk.on(steps >> k & 1 != 0)));
            }
        };
        let cells = u16::from(self.outer_segments);
        for k in 0..cells {
            let [first, second] = self.cell(k, (2 * k < cells) == lower);
            take(first);
            take(second);
        }
    }

    /// Cells from number `first` on, whose diagonals all run the same way.
    fn cells(&self, first: u16, rising: bool, pairs: &mut [[Triangle; 2]]) {
        for (k, pair) in (first..).zip(pairs) {
            *pair = self.cell(k, rising);
        }
    }

    /// Cell `k` of a row of cells: its diagonal rises from its outer vertex `a`, or from `d`.
    #[inline(always)]
    fn cell(&self, k: u16, rising: bool) -> [Triangle; 2] {
        let [a, b] = [self.outer.at(k), self.outer.at(k + 1)];
        let [d, c] = [self.inner.at(k), self.inner.at(k + 1)];
        if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    }

    /// The error that a Bresenham walk starts with: -64..=63.
    fn error(&self) -> i16 {
        i16::from(self.inner_segments) - i16::from(self.outer_segments)
    }
}

/// The triangles of a strip, in order: the state that the hardware has.
#[derive(Clone, Debug)]
pub struct Triangles {
    /// The rows from where the walk is, in a Bresenham walk.
    strip: Strip,
    /// -128..=126 for rows of up to 64 segments: 8 bits.
    error: i16,
    /// Triangles still to come: 8 bits.
    left: u8,
}

impl Triangles {
    fn cell(&self, lower: bool) -> Triangle {
        let made = (self.strip.count() - u32::from(self.left)) as u16;
        let first_half = (made & !1) < u16::from(self.strip.outer_segments);
        self.strip.cell(made / 2, first_half == lower)[usize::from(made % 2)]
    }

    #[inline(always)]
    fn step(&mut self) -> Triangle {
        let advances = self.error >= 0;
        self.error += if advances {
            -2 * i16::from(self.strip.outer_segments)
        } else {
            2 * i16::from(self.strip.inner_segments)
        };
        self.on(advances)
    }

    /// The triangle on the inner row's next segment, or on the outer one's.
    #[inline(always)]
    fn on(&mut self, inner_advances: bool) -> Triangle {
        let Strip { outer, inner, end, .. } = self.strip;
        // Only the first vertex of a row can be the end: no walk goes on to the far corner.
        let (o, i) = (if outer.first == end { 0 } else { outer.first }, inner.first);
        let [a, b, c] = if inner_advances {
            self.strip.inner = inner.next();
            [i, o, self.strip.inner.first]
        } else {
            self.strip.outer = outer.next();
            [o, self.strip.outer.first, i]
        };
        if self.strip.mirrored { [a, c, b] } else { [a, b, c] }
    }
}

impl Iterator for Triangles {
    type Item = Triangle;

    #[inline]
    fn next(&mut self) -> Option<Triangle> {
        if self.left == 0 {
            return None;
        }
        let triangle = match self.strip.kind {
            Kind::Cells { lower } => self.cell(lower),
            Kind::Bresenham => self.step(),
            Kind::Zipper { steps } => {
                let made = self.strip.count() - u32::from(self.left);
                self.on(steps >> made & 1 != 0)
            }
        };
        self.left -= 1;
        Some(triangle)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left.into(), Some(self.left.into()))
    }
}

impl ExactSizeIterator for Triangles {}

/// A patch's lists, as far as its triangles depend on them: all that there is between them.
pub trait Topology: Numbering + Copy + Default + Eq + Send + Sync + fmt::Debug {
    /// The strips, in order.
    type Strips: ExactSizeIterator<Item = Strip>;

    /// The strips of the patch: the rows of the interior grid, then side by side.
    #[must_use]
    fn strips(self) -> Self::Strips;

    /// How many strips there are.
    #[must_use]
    fn strip_count(self) -> usize {
        self.strips().len()
    }
}

#[cfg(test)]
mod tests;
