//! Edges: the database of tessellated edges that a primitive keeps while it is drawn. The places of
//! patches and what became of them come in, in order; what an earlier patch has left for them goes
//! out.
//!
//! Sfarti et al. 2005, section 6: "Within one patch strip, the edge database must be retained for
//! zippering reasons but no information needs to be stored between two abutting patches." A strip
//! and a fan keep the edge towards the next patch, a mesh the upper edges of a row besides. What
//! is kept is not needed to meet the neighbour, whose edge comes out the same; it is what need not
//! be evaluated again, and a patch that was culled leaves nothing.

use super::union::Site;

/// The vertices of shared edges, an edge with both its ends, that later patches will meet.
#[derive(Clone, Debug, Default)]
pub(super) struct EdgeDatabase {
    /// Of the edge towards the next patch of the row.
    beside: u64,
    /// Of the edges towards the row above, by column.
    above: Vec<u64>,
    /// All of those.
    row: u64,
}

/// What the database did for a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Held {
    /// Vertices of the patch that it had from earlier patches.
    pub(super) shared: u64,
    /// Vertices that it holds now.
    pub(super) entries: u64,
}

impl EdgeDatabase {
    /// The patch at `site` of a primitive of so many rows and columns, with the vertices of its
    /// edges v0, u1, v1, u0 (an edge with both its ends), if it was tessellated.
    pub(super) fn pass(
        &mut self,
        (rows, columns): (u64, u64),
        site: Site,
        edges: Option<[u64; 4]>,
    ) -> Held {
        let (row, column) = (u64::from(site.row), u64::from(site.column));
        if (row, column) == (0, 0) {
            self.above.clear();
            self.above.resize(if rows > 1 { columns as usize } else { 0 }, 0);
            self.row = 0;
        }
        if column == 0 {
            self.beside = 0;
        }
        let above = self.above.get_mut(column as usize);
        let below = above.as_ref().map_or(0, |vertices| **vertices);
        let shared = match (edges, below, self.beside) {
            (None, ..) => 0,
            // The corner between them is of both.
            (Some(_), 1.., 1..) => below + self.beside - 1,
            (Some(_), below, beside) => below + beside,
        };
        let [_, u1, v1, _] = edges.unwrap_or_default();
        self.beside = if column + 1 < columns { u1 } else { 0 };
        if let Some(above) = above {
            let left = if row + 1 < rows { v1 } else { 0 };
            self.row = self.row - *above + left;
            *above = left;
        }
        Held { shared, entries: self.beside + self.row }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shared vertices in all and the most held, where `kept` says which patches are tessellated,
    /// all at one level.
    fn drawn(rows: u32, columns: u32, level: u64, kept: impl Fn(u32, u32) -> bool) -> [u64; 2] {
        let mut database = EdgeDatabase::default();
        let mut sum = [0; 2];
        for row in 0..rows {
            for column in 0..columns {
                let edges = kept(row, column).then_some([level + 1; 4]);
                let site = Site { row, column };
                let held = database.pass((rows.into(), columns.into()), site, edges);
                sum = [sum[0] + held.shared, sum[1].max(held.entries)];
            }
        }
        assert_eq!((database.beside, database.row), (0, 0), "nothing is held for nobody");
        sum
    }

    #[test]
    fn a_primitive_holds_what_its_later_patches_meet() {
        for level in [1, 8, 63] {
            let edge = level + 1;
            for n in 1..6 {
                let strip = if n > 1 { edge } else { 0 };
                assert_eq!(drawn(1, n, level, |_, _| true), [u64::from(n - 1) * edge, strip]);
                for m in 2..5 {
                    let (rows, columns) = (u64::from(m), u64::from(n));
                    let inner = (rows - 1) * (columns - 1);
                    let shared = rows * (columns - 1) * edge + (rows - 1) * columns * edge - inner;
                    let most = columns * edge + if n > 1 { edge } else { 0 };
                    let [got, held] = drawn(m, n, level, |_, _| true);
                    assert_eq!(got, shared, "{m} x {n} at {level}");
                    // The last patch of a row holds nothing beside.
                    assert!(held == most || (n > 1 && held == most - edge && m == 2), "{held}");
                }
            }
        }
        // A culled patch neither takes nor leaves.
        assert_eq!(drawn(1, 3, 8, |_, column| column != 1), [0, 9]);
        assert_eq!(drawn(2, 1, 8, |row, _| row != 0), [0, 0]);
    }
}
