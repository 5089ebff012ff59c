//! Where the rows of a patch stand in its numbering of vertices, whatever its lists are.

use super::{Kind, Row, Strip};
use crate::place::Numbering;

/// Where the rows of a patch are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch<T> {
    pub(super) lists: T,
    pub(super) columns: usize,
    pub(super) rows: usize,
    starts: [usize; 5],
}

impl<T: Numbering> Patch<T> {
    pub(super) fn new(lists: T) -> Self {
        let ([columns, rows], starts) = (lists.interior(), lists.starts());
        Self { lists, columns, rows, starts }
    }

    fn interior(&self, column: usize, row: usize) -> u16 {
        (self.starts[4] + row * self.columns + column) as u16
    }

    /// The number after the last boundary vertex.
    pub(super) fn end(&self) -> u16 {
        self.starts[4] as u16
    }

    /// Rows of interior cells, where there are any.
    pub(super) fn grid_strips(&self) -> usize {
        if self.columns < 2 { 0 } else { self.rows - 1 }
    }

    /// A strip that stands alone and needs no interior row.
    pub(super) fn strip(kind: Kind, outer: Row, inner: Row, [n, m]: [usize; 2]) -> Strip {
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

    /// A patch without any vertex but its corners: their cell.
    pub(super) fn whole(&self) -> Strip {
        let (outer, inner) = (Row { first: 0, step: 1 }, Row { first: 3, step: -1 });
        Self::strip(Kind::Cells { lower: true }, outer, inner, [1, 1])
    }

    /// The cells between interior rows `row` and `row + 1`.
    pub(super) fn grid(&self, row: usize) -> Strip {
        let [outer, inner] = [row, row + 1].map(|j| Row { first: self.interior(0, j), step: 1 });
        let kind = Kind::Cells { lower: 2 * row < self.rows - 1 };
        let strip = Self::strip(kind, outer, inner, [self.columns - 1; 2]);
        Strip { rows_needed: row as u8 + 2, ..strip }
    }

    /// The boundary vertices of a side, from one of its ends.
    pub(super) fn outer(&self, side: usize, end: usize) -> Row {
        // v1 and u0 run against the numbering, which ends where it began: at vertex 0.
        if (side < 2) == (end == 0) {
            Row { first: self.starts[side] as u16, step: 1 }
        } else {
            Row { first: self.starts[side + 1] as u16, step: -1 }
        }
    }

    /// The interior's vertices along a side, from one of its ends.
    pub(super) fn inner(&self, side: usize, end: usize) -> Row {
        let (along, beside) = (end == 1, side == 1 || side == 2);
        let (right, top) = if side.is_multiple_of(2) { (along, beside) } else { (beside, along) };
        let column = if right { self.columns - 1 } else { 0 };
        let row = if top { self.rows - 1 } else { 0 };
        let step = if side.is_multiple_of(2) { 1 } else { self.columns as i16 };
        Row { first: self.interior(column, row), step: if end == 0 { step } else { -step } }
    }
}
