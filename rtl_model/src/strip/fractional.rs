//! The strips of a patch with fractional lists: the rows of the interior grid, then for each side
//! half 0, half 1 and the segment across the centre, as far as they have triangles.

use super::rows::Patch;
use super::{Kind, Segments, Strip, Topology};
use crate::place::Numbering;

impl Topology for Segments {
    type Strips = Strips;

    fn strips(self) -> Strips {
        Strips { patch: Patch::new(self), count: self.strip_count(), made: 0, part: 0 }
    }

    /// 1 where every level is 1, else 4 to 138.
    fn strip_count(self) -> usize {
        let patch = Patch::new(self);
        if patch.columns == 0 {
            return 1;
        }
        let side = |side| {
            let halves = if patch.outer_half(side) + patch.inner_half(side) > 0 { 2 } else { 0 };
            halves + self.edge(side) % 2
        };
        patch.grid_strips() + (0..4).map(side).sum::<usize>()
    }
}

/// The strips of a patch, in order.
#[derive(Clone, Debug)]
pub struct Strips {
    patch: Patch<Segments>,
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

impl Patch<Segments> {
    /// Half 0 or 1 of a side, or (2) the segment across its centre. That one's diagonal starts at
    /// the end that lies at (0, 0) or (1, 1).
    #[inline]
    fn side(&self, side: usize, part: usize) -> Option<Strip> {
        let (n, m) = (self.outer_half(side), self.inner_half(side));
        let mirrored = |end| (side >= 2) != (end == 1);
        let strip = |end, outer, inner, segments| Strip {
            mirrored: mirrored(end),
            end: self.end(),
            rows_needed: self.rows as u8,
            ..Self::strip(Kind::Bresenham, outer, inner, segments)
        };
        if part < 2 {
            let (outer, inner) = (self.outer(side, part), self.inner(side, part));
            return (n + m > 0).then(|| strip(part, outer, inner, [n, m]));
        }
        let end = usize::from(side == 1 || side == 2);
        let (outer, inner) = (self.outer(side, end).from(n), self.inner(side, end).from(m));
        let segments = [1, self.lists.below_two().into()];
        (self.lists.edge(side) % 2 == 1).then(|| strip(end, outer, inner, segments))
    }

    /// Segments of half an edge, not counting one across its centre.
    fn outer_half(&self, side: usize) -> usize {
        self.lists.edge(side) / 2
    }

    /// Segments of half an interior row, or column, along a side.
    fn inner_half(&self, side: usize) -> usize {
        let along = if side.is_multiple_of(2) { self.columns } else { self.rows };
        if self.lists.below_two() { 0 } else { (along - 1) / 2 }
    }
}
