//! Pareto: rows in, those that no other is as good as out: bits of the datapath, estimated area and
//! largest position error, each the less the better. Rows that lose patches or vertices, or crack,
//! are none of them.

use super::Row;

/// What is to be small.
type Price = (u32, u64, f64);

fn price(row: &Row) -> Price {
    (row.widths.datapath(), row.area, row.measured.largest())
}

/// Whether `a` is at least as good as `b` in all, and better in one.
fn dominates(a: Price, b: Price) -> bool {
    a.0 <= b.0 && a.1 <= b.1 && a.2 <= b.2 && a != b
}

/// The numbers of the rows of the front, by bits, then area; of equal ones the first.
pub(super) fn front(rows: &[Row]) -> Vec<usize> {
    let usable = |&k: &usize| rows[k].measured.serves(f64::INFINITY);
    let usable: Vec<usize> = (0..rows.len()).filter(usable).collect();
    let beaten = |k: usize| {
        usable.iter().any(|&other| {
            let (a, b) = (price(&rows[other]), price(&rows[k]));
            dominates(a, b) || a == b && other < k
        })
    };
    let mut front: Vec<usize> = usable.iter().copied().filter(|&k| !beaten(k)).collect();
    front.sort_by_key(|&k| (rows[k].widths.datapath(), rows[k].area, k));
    front
}

#[cfg(test)]
mod tests {
    use super::super::{Formats, Measured, PositionError, Widths};
    use super::*;
    use crate::config::{Config, Overflow};

    fn row(width: u32, area: u64, error: f64) -> Row {
        let mut config = Config::default();
        config.position.width = width;
        let mut reported = PositionError::default();
        reported.take(error);
        let measured = Measured { reported, exact: reported, ..Measured::default() };
        let overflow = Overflow::Saturate;
        let formats =
            Formats { width, guard: 20, reciprocal: 32, subpixel: 8, rounding: None, overflow };
        Row { formats, widths: Widths::of(&config), area, measured }
    }

    #[test]
    fn what_another_row_beats_is_not_on_the_front() {
        let mut lost = row(8, 1, 0.0);
        lost.measured.lost = 1;
        let rows = [
            row(20, 50, 0.1),
            row(16, 60, 0.2),
            row(16, 40, 0.3),
            row(16, 40, 0.3), // the same again
            row(20, 50, 0.2), // beaten by the first
            row(24, 40, 0.25),
            lost,
        ];
        assert_eq!(front(&rows), [2, 1, 0, 5]);
    }
}
