//! List: a strip in, its vertices as the paper lists them out, for a triangle strip of old.
//!
//! Concheiro and others 2014, section 3, rules 3 and 4. A virtual vertex counts as one of the row
//! in which it lies. The list is at most as long as the uniform pattern's, 2 k + 1.

use super::Site;
use super::row::{Row, Spread};
use super::strip::Strip;

/// The vertices of a strip, in the order of the paper's list.
#[derive(Clone, Copy, Debug)]
pub struct List {
    lower: Row,
    upper: Spread,
    /// Which of the two rows' 2 k + 1 vertices comes next, from the left, in turn.
    place: u8,
    /// The last two listed, the later one last.
    last: [Option<Site>; 2],
    /// What comes after a replica.
    held: Option<Site>,
}

impl Strip {
    /// The strip as the paper prints it: without equal neighbours (rule 3), and alternating between
    /// rows (rule 4). Which triangles there are does not depend on it.
    #[must_use]
    pub fn list(self) -> List {
        List::new(self)
    }
}

impl List {
    pub(super) fn new(strip: Strip) -> Self {
        let (lower, upper) = strip.rows();
        Self { lower, upper, place: 0, last: [None; 2], held: None }
    }

    /// The next vertex of the rows in turn, before any rule.
    fn alternate(&mut self) -> Option<Site> {
        let place = self.place;
        if place > 2 * self.lower.number {
            return None;
        }
        self.place += 1;
        let lower = place.is_multiple_of(2);
        Some(if lower { self.lower.entry(place / 2) } else { self.upper.step() })
    }

    /// The next one that is not the last one again (rule 3).
    fn fresh(&mut self) -> Option<Site> {
        loop {
            let site = self.alternate()?;
            if Some(site) != self.last[1] {
                return Some(site);
            }
        }
    }
}

impl Iterator for List {
    type Item = Site;

    fn next(&mut self) -> Option<Site> {
        let site = match self.held.take() {
            Some(held) => held,
            None => {
                let site = self.fresh()?;
                match self.last {
                    // Rule 4: v_i v_j v_k, the last two of one row, becomes v_i v_j v_i v_k.
                    [Some(i), Some(j)] if j.row == site.row => {
                        self.held = Some(site);
                        i
                    }
                    _ => site,
                }
            }
        };
        self.last = [self.last[1], Some(site)];
        Some(site)
    }
}
