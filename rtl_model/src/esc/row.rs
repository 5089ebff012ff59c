//! Row: the vertices of one row, or those that stand for them, one after another.
//!
//! Concheiro and others 2014, section 3, rules 1 and 2, and the rules for empty rows.

use super::{Edge, Insertion, Site};

/// The set bit of `chain` that is nearest to `position`; of two equally near, the greater. The
/// chain has bit 0 and a bit at or above `position`, so that both searches end.
pub(super) const fn nearest(chain: u32, position: u8) -> u8 {
    let after = (chain >> position).trailing_zeros() as u8; // 0 to 16
    let before = (chain << (31 - position)).leading_zeros() as u8; // 0 to 16
    if after <= before { position + after } else { position - before }
}

/// A row that is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) insertion: Insertion,
    /// 0 to 16.
    pub(super) number: u8,
}

impl Row {
    /// What stands at a place of the row: 0 to its number.
    pub(super) fn entry(self, place: u8) -> Site {
        let Self { insertion, number } = self;
        if number == insertion.segments() {
            return Site { row: number, place: insertion.stand_in(Edge::Bottom, place) };
        }
        // Inner sites of a row that is not empty are all there. The apex is on either edge.
        if place == 0 {
            Site { row: insertion.stand_in(Edge::Left, number), place: 0 }
        } else if place == number {
            let row = insertion.stand_in(Edge::Right, number);
            Site { row, place: row }
        } else {
            Site { row: number, place }
        }
    }
}

/// An upper row spread over the places of the row below it.
///
/// Place j of the v that are not a virtual vertex's takes vertex floor(j m / v) of the row's own m:
/// `rest` counts j m modulo v. Where no row between is empty, v is m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    row: Row,
    /// Whether the first place, and the last, is a virtual vertex's.
    virtual_ends: [bool; 2],
    /// m, 1 to 16.
    own: u8,
    /// v, m to 16.
    places: u8,
    /// Places handed out, 0 to 16.
    handed: u8,
    /// The next own vertex, by its place in the row.
    next: u8,
    /// Below `places`; 5 bits while it is formed.
    rest: u8,
}

impl Spread {
    /// The row over `places` places, more than its number.
    pub(super) fn new(row: Row, places: u8) -> Self {
        let Row { insertion, number } = row;
        let missing = |edge| insertion.chain(edge) >> number & 1 == 0;
        let virtual_ends = [missing(Edge::Left), missing(Edge::Right)];
        let ends = virtual_ends.map(u8::from);
        let stand_ins = ends[0] + ends[1];
        let own = number + 1 - stand_ins;
        Self {
            row,
            virtual_ends,
            own,
            places: places - stand_ins,
            handed: 0,
            next: ends[0],
            rest: 0,
        }
    }

    /// What stands at the next place. Not to be asked more often than there are places.
    pub(super) fn step(&mut self) -> Site {
        let first = self.handed == 0;
        let last = self.handed == u8::from(self.virtual_ends[0]) + self.places;
        self.handed += 1;
        match self.virtual_ends {
            [true, _] if first => return self.row.entry(0),
            [_, true] if last => return self.row.entry(self.row.number),
            _ => {}
        }
        let site = self.row.entry(self.next);
        self.rest += self.own;
        if self.rest >= self.places {
            self.rest -= self.places;
            self.next += 1;
        }
        site
    }
}
