//! Strip: two rows in, the triangles between them out, one slot a cycle.
//!
//! The walk is the uniform pattern's, whatever is missing: the lower row's next vertex, then the
//! upper row's, in turn. Each makes a triangle with the two that came last from either row, unless
//! two of the three are one vertex.
//!
//! ```text
//!   upper      t───t───t        slot 0: low[0] low[1] top[0]
//!             ╱ ╲ ╱ ╲ ╱ ╲       slot 1: top[0] low[1] top[1]
//!   lower    l───l───l───l      slot 2: low[1] low[2] top[1]  ..
//! ```

use super::row::{Row, Spread};
use super::{Insertion, Site, Triangle};

/// What lies between a row and the closest row above it that is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strip {
    insertion: Insertion,
    upper: u8,
    lower: u8,
}

impl Strip {
    /// Between rows that are not empty and have none such between them.
    pub(super) const fn new(insertion: Insertion, upper: u8, lower: u8) -> Self {
        Self { insertion, upper, lower }
    }

    /// The number of the upper row, 0 to 15.
    #[must_use]
    pub const fn upper(self) -> u8 {
        self.upper
    }

    /// The number of the lower row, 1 to 16: the strip's own in the paper.
    #[must_use]
    pub const fn lower(self) -> u8 {
        self.lower
    }

    /// How many slots it has, 1 to 31.
    #[must_use]
    pub const fn slot_count(self) -> u32 {
        2 * self.lower as u32 - 1
    }

    /// The slots: a triangle each, or none where two vertices are equal.
    #[must_use]
    pub fn slots(self) -> Slots {
        let (lower, mut upper) = self.rows();
        Slots { strip: self, low: lower.entry(0), top: upper.step(), upper, slot: 0 }
    }

    pub(super) fn rows(self) -> (Row, Spread) {
        let row = |number| Row { insertion: self.insertion, number };
        (row(self.lower), Spread::new(row(self.upper), self.lower))
    }
}

/// The slots of a strip, from the left.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    strip: Strip,
    upper: Spread,
    /// The vertices that came last from either row.
    low: Site,
    top: Site,
    /// The next slot, 0 to 31.
    slot: u8,
}

impl Iterator for Slots {
    type Item = Option<Triangle>;

    fn next(&mut self) -> Option<Option<Triangle>> {
        let Self { strip, low, top, slot, .. } = *self;
        if u32::from(slot) == strip.slot_count() {
            return None;
        }
        self.slot += 1;
        let [a, b, c] = if slot.is_multiple_of(2) {
            self.low = Row { insertion: strip.insertion, number: strip.lower }.entry(slot / 2 + 1);
            [low, self.low, top]
        } else {
            self.top = self.upper.step();
            [top, low, self.top]
        };
        Some((a != b && b != c && c != a).then_some([a, b, c]))
    }
}
