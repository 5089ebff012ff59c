//! The strips of a patch with dyadic lists: the rows of the interior grid, then a zipper along each
//! side, from its end at the smaller parameter.
//!
//! ```text
//!   both lists have inner entries     one has              none has
//!   v1 o───o───────o                  v1 o───o───────o     v1 o───────o
//!      │ ╲  ╲    ╱ │                     │  ╱  ╲     │        │     ╱ │
//!   u0 o───●───●───o u1                  │ ╱     ╲   │        │   ╱   │
//!      │ ╱  ╲ ╱  ╲ │                     │╱        ╲ │        │ ╱     │
//!   v0 o─────o─────o                  v0 o─────o─────o     v0 o───────o
//!   a grid, and four zippers          one zipper           a cell
//! ```
//!
//! Transposing a patch transposes its triangles, for every side runs along its growing parameter.

use super::rows::Patch;
use super::{Kind, Row, Strip, Topology};
use crate::patch::{Dyadic, Lists};
use crate::place::Numbering;

/// Most triangles of a strip: bits of its steps.
const TRIANGLES_MAX: u32 = u64::BITS;

impl Topology for Lists {
    type Strips = Zippers;

    fn strips(self) -> Zippers {
        let patch = Patch::new(self);
        Zippers { patch, count: patch.strips(), made: 0, sides: 0, zipper: None }
    }
}

/// The strips of a patch, in order.
#[derive(Clone, Debug)]
pub struct Zippers {
    patch: Patch<Lists>,
    count: usize,
    made: usize,
    /// Sides begun.
    sides: usize,
    /// What is left of the side that is stitched.
    zipper: Option<Zipper>,
}

impl Iterator for Zippers {
    type Item = Strip;

    fn next(&mut self) -> Option<Strip> {
        let Self { patch, count, made, .. } = *self;
        if made == count {
            return None;
        }
        let mut strip = if patch.is_whole() {
            patch.whole()
        } else if made < patch.grid_strips() {
            patch.grid(made)
        } else {
            let mut zipper = self.zipper.unwrap_or_else(|| {
                self.sides += 1;
                patch.zipper(self.sides - 1)
            });
            let strip = zipper.strip(&patch);
            self.zipper = (zipper.left() > 0).then_some(zipper);
            strip
        };
        self.made += 1;
        (strip.first, strip.last) = (made == 0, made + 1 == count);
        Some(strip)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count - self.made, Some(self.count - self.made))
    }
}

impl ExactSizeIterator for Zippers {}

impl Patch<Lists> {
    /// Whether there is nothing but the corners.
    fn is_whole(&self) -> bool {
        self.lists.vertices() == 4
    }

    /// How many strips there are.
    fn strips(&self) -> usize {
        if self.is_whole() {
            return 1;
        }
        let sides = if self.columns == 0 { 0..1 } else { 0..4 };
        let strips = |side| self.zipper(side).left().div_ceil(TRIANGLES_MAX) as usize;
        self.grid_strips() + sides.map(strips).sum::<usize>()
    }

    /// The zipper between a side's edge and the grid's first row or column. Without a grid there
    /// is one, between the two edges that have entries.
    fn zipper(&self, side: usize) -> Zipper {
        let [v0, u1, v1, u0] = *self.lists.edges();
        let (u, v) = (self.lists.u(), self.lists.v());
        if self.columns > 0 {
            let (edge, list) = [(v0, u), (u1, v), (v1, u), (u0, v)][side];
            let (outer, inner) = (self.outer(side, 0), self.inner(side, 0));
            return Zipper::new((outer, edge), (inner, Steps::inner(list)), side >= 2);
        }
        // The opposite edge as the inner row: it is no more than one of two.
        let (side, [edge, opposite]) =
            if u == Dyadic::NONE { (3, [u0, u1]) } else { (0, [v0, v1]) };
        let inner = (self.outer((side + 2) % 4, 0), Steps::edge(opposite));
        Zipper::new((self.outer(side, 0), edge), inner, side == 3)
    }
}

/// The segments of a row: bit k says that one ends at (k + 1)/128.
#[derive(Clone, Copy, Debug)]
struct Steps(u128);

impl Steps {
    /// An edge, from 0 to 1.
    fn edge(list: Dyadic) -> Self {
        Self(list.mask() >> 1 | 1 << 127)
    }

    /// A row of the interior, from the first inner entry to the last.
    fn inner(list: Dyadic) -> Self {
        let mask = list.mask() >> 1;
        Self(mask & mask.wrapping_sub(1))
    }

    fn left(self) -> u32 {
        self.0.count_ones()
    }
}

/// A walk along two rows, which merges their parameters.
#[derive(Clone, Copy, Debug)]
struct Zipper {
    outer: Row,
    inner: Row,
    outer_steps: Steps,
    inner_steps: Steps,
    mirrored: bool,
}

impl Zipper {
    fn new(
        (outer, edge): (Row, Dyadic),
        (inner, inner_steps): (Row, Steps),
        mirrored: bool,
    ) -> Self {
        Self { outer, inner, outer_steps: Steps::edge(edge), inner_steps, mirrored }
    }

    /// Triangles to come.
    fn left(&self) -> u32 {
        self.outer_steps.left() + self.inner_steps.left()
    }

    /// The next strip of it.
    fn strip(&mut self, patch: &Patch<Lists>) -> Strip {
        let (outer, inner) = (self.outer, self.inner);
        let (mut steps, mut segments) = (0_u64, [0, 0]);
        for k in 0..self.left().min(TRIANGLES_MAX) {
            let all = self.outer_steps.0 | self.inner_steps.0;
            let next = all & all.wrapping_neg(); // the smallest parameter
            if self.outer_steps.0 & next != 0 {
                self.outer_steps.0 ^= next;
                segments[0] += 1;
            } else {
                self.inner_steps.0 ^= next;
                segments[1] += 1;
                steps |= 1 << k;
            }
        }
        [self.outer, self.inner] = [outer.from(segments[0]), inner.from(segments[1])];
        Strip {
            mirrored: self.mirrored,
            end: patch.end(),
            rows_needed: patch.rows as u8,
            ..Patch::<Lists>::strip(Kind::Zipper { steps }, outer, inner, segments)
        }
    }
}
