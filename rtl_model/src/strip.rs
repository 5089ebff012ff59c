//! Strip: two rows of a patch's vertices and what joins them. Segment counts in, strips out: the
//! tokens between evaluate and stitch.
//!
//! Moreton 2001, section 5.1: what lies between two rows is stitched while they are at hand, with
//! nothing kept but two vertices and an error. There are two kinds of walk:
//!
//! ```text
//!   cells        inner  d───c───┬───┬───┐     a row of the interior grid, which is regular;
//!                       │ ╱ │ ╱ │ ╲ │ ╲ │     its diagonals point at the patch's centre
//!                outer  a───b───┴───┴───┘
//!
//!   Bresenham    outer  o───o─────o─────o     half of a side, from a corner to the middle:
//!                       │ ╲ │  ╲ ╱ ╲    │     n segments of the edge,
//!                inner  i─────i─────────i     m of the interior's first row or column
//! ```
//!
//! Bresenham: of the outer row's next segment and the inner row's, the one whose midpoint comes
//! first gets the next triangle. Midpoints are never formed: `error` is their difference over the
//! common denominator, so that no rounding can change the topology. The walk is counted, so no end
//! needs a special case; the segment across an edge's centre (levels below 2) is a strip of one
//! outer segment and of as many inner ones as there are. A patch of level 1 is a cell.
//!
//! Triangles are counter-clockwise with u right and v up. Half 1 of a side, and the sides v1 and
//! u0, are walked mirrored, so they swap two vertices.

use crate::patch::Triangle;
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
        } else {
            let mut walk = self.triangles();
            out.iter_mut().for_each(|triangle| *triangle = walk.step());
        }
    }

    /// Hands its triangles to `take`, in order: as [`Self::triangles`], and faster.
    #[inline]
    pub fn for_each(&self, mut take: impl FnMut(Triangle)) {
        let Kind::Cells { lower } = self.kind else {
            let mut walk = self.triangles();
            return (0..self.count()).for_each(|_| take(walk.step()));
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
        let Strip { outer, inner, end, .. } = self.strip;
        // Only the first vertex of a row can be the end: no walk goes on to the far corner.
        let (o, i) = (if outer.first == end { 0 } else { outer.first }, inner.first);
        let [a, b, c] = if self.error >= 0 {
            self.error -= 2 * i16::from(self.strip.outer_segments);
            self.strip.inner = inner.next();
            [i, o, self.strip.inner.first]
        } else {
            self.error += 2 * i16::from(self.strip.inner_segments);
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
        };
        self.left -= 1;
        Some(triangle)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left.into(), Some(self.left.into()))
    }
}

impl ExactSizeIterator for Triangles {}

/// The strips of a patch: the rows of the interior grid, then for each side half 0, half 1 and the
/// segment across the centre, as far as they have triangles.
#[must_use]
pub fn strips(segments: Segments) -> Strips {
    Strips { patch: Patch::new(segments), count: strip_count(segments), made: 0, part: 0 }
}

/// The strips of a patch, in order.
#[derive(Clone, Debug)]
pub struct Strips {
    patch: Patch,
    count: usize,
    made: usize,
    /// The side's part that comes next: three a side.
    part: usize,
}

impl Iterator for Strips {
    type Item = Strip;

    #[inline]
    fn next(&mut self) -> Option<Strip> {
        let Self { patch, count, made, .. } = *self;
        if made == count {
            return None;
        }
        let mut strip = if patch.columns == 0 {
            patch.whole()
        } else if made < patch.grid_strips() {
            patch.grid(made)
        } else {
            loop {
                let part = self.part;
                self.part += 1;
                if let Some(strip) = patch.side(part / 3, part % 3) {
                    break strip;
                }
            }
        };
        self.made += 1;
        (strip.first, strip.last) = (made == 0, made + 1 == count);
        Some(strip)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count - self.made, Some(self.count - self.made))
    }
}

impl ExactSizeIterator for Strips {}

/// How many strips a patch has: 1 where every level is 1, else 4 to 138.
#[must_use]
pub fn strip_count(segments: Segments) -> usize {
    let patch = Patch::new(segments);
    if patch.columns == 0 {
        return 1;
    }
    let side = |side| {
        let halves = if patch.outer_half(side) + patch.inner_half(side) > 0 { 2 } else { 0 };
        halves + segments.edge(side) % 2
    };
    patch.grid_strips() + (0..4).map(side).sum::<usize>()
}

/// Where the rows of a patch are.
#[derive(Clone, Copy, Debug)]
struct Patch {
    segments: Segments,
    starts: [usize; 5],
    columns: usize,
    rows: usize,
}

impl Patch {
    fn new(segments: Segments) -> Self {
        let [columns, rows] = segments.interior();
        Self { segments, starts: segments.starts(), columns, rows }
    }

    fn interior(&self, column: usize, row: usize) -> u16 {
        (self.starts[4] + row * self.columns + column) as u16
    }

    /// Rows of interior cells, where there are any.
    fn grid_strips(&self) -> usize {
        if self.columns < 2 { 0 } else { self.rows - 1 }
    }

    /// A strip that stands alone and needs no interior row.
    fn strip(kind: Kind, outer: Row, inner: Row, [n, m]: [usize; 2]) -> Strip {
        Strip {
            kind,
            outer,
            inner,
            outer_segments: n as u8,
            inner_segments: m as u8,
            mirrored: false,
            end: 0,
            rows_needed: 0,
            first: true,
            last: true,
        }
    }

    /// A patch of level 1: the cell of its corners.
    fn whole(&self) -> Strip {
        let (outer, inner) = (Row { first: 0, step: 1 }, Row { first: 3, step: -1 });
        Self::strip(Kind::Cells { lower: true }, outer, inner, [1, 1])
    }

    /// The cells between interior rows `row` and `row + 1`.
    fn grid(&self, row: usize) -> Strip {
        let [outer, inner] = [row, row + 1].map(|j| Row { first: self.interior(0, j), step: 1 });
        let kind = Kind::Cells { lower: 2 * row < self.rows - 1 };
        let strip = Self::strip(kind, outer, inner, [self.columns - 1; 2]);
        Strip { rows_needed: row as u8 + 2, ..strip }
    }

    /// Half 0 or 1 of a side, or (2) the segment across its centre. That one's diagonal starts at
    /// the end that lies at (0, 0) or (1, 1).
    #[inline]
    fn side(&self, side: usize, part: usize) -> Option<Strip> {
        let (n, m) = (self.outer_half(side), self.inner_half(side));
        let mirrored = |end| (side >= 2) != (end == 1);
        let strip = |end, outer, inner, segments| Strip {
            mirrored: mirrored(end),
            end: self.starts[4] as u16,
            rows_needed: self.rows as u8,
            ..Self::strip(Kind::Bresenham, outer, inner, segments)
        };
        if part < 2 {
            let (outer, inner) = (self.outer(side, part), self.inner(side, part));
            return (n + m > 0).then(|| strip(part, outer, inner, [n, m]));
        }
        let end = usize::from(side == 1 || side == 2);
        let (outer, inner) = (self.outer(side, end).from(n), self.inner(side, end).from(m));
        let segments = [1, self.segments.below_two().into()];
        (self.segments.edge(side) % 2 == 1).then(|| strip(end, outer, inner, segments))
    }

    /// Segments of half an edge, not counting one across its centre.
    fn outer_half(&self, side: usize) -> usize {
        self.segments.edge(side) / 2
    }

    /// Segments of half an interior row, or column, along a side.
    fn inner_half(&self, side: usize) -> usize {
        let along = if side.is_multiple_of(2) { self.columns } else { self.rows };
        if self.segments.below_two() { 0 } else { (along - 1) / 2 }
    }

    /// The boundary vertices of a side, from one of its ends.
    fn outer(&self, side: usize, end: usize) -> Row {
        // v1 and u0 run against the numbering, which ends where it began: at vertex 0.
        if (side < 2) == (end == 0) {
            Row { first: self.starts[side] as u16, step: 1 }
        } else {
            Row { first: self.starts[side + 1] as u16, step: -1 }
        }
    }

    /// The interior's vertices along a side, from one of its ends.
    fn inner(&self, side: usize, end: usize) -> Row {
        let (along, beside) = (end == 1, side == 1 || side == 2);
        let (right, top) = if side.is_multiple_of(2) { (along, beside) } else { (beside, along) };
        let column = if right { self.columns - 1 } else { 0 };
        let row = if top { self.rows - 1 } else { 0 };
        let step = if side.is_multiple_of(2) { 1 } else { self.columns as i16 };
        Row { first: self.interior(column, row), step: if end == 0 { step } else { -step } }
    }
}

#[cfg(test)]
mod tests;
