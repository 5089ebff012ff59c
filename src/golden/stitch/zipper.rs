//! Zippers: the triangles between dyadic lists, as a set.
//!
//! Said of each segment alone, where the block walks: a segment of the outer row has as its apex
//! the last inner vertex before the segment's end, or the first of all; a segment of the inner row
//! the last outer vertex that is not beyond the segment's end.

use super::{Corner, Side, canonical, counter_clockwise};
use crate::golden::place::{Fraction, Placed};

type Row = Vec<(Fraction, Corner)>;

/// The triangles by vertex number, each with its least number first, sorted.
#[must_use]
pub fn zipped(placed: &Placed) -> Vec<[usize; 3]> {
    let boundary: usize = placed.edges.iter().map(|edge| edge.len() - 1).sum();
    let has = |edge: usize| placed.edges[edge].len() > 2;
    let mut out = Vec::new();
    if !placed.columns.is_empty() {
        grid(placed, boundary, &mut out);
        for side in 0..4 {
            let Side { outer, inner, .. } = Side::new(placed, boundary, side);
            zip(&outer, &inner, &mut out);
        }
    } else if has(0) || has(2) {
        let away = |row: Row| row.into_iter().map(|(t, c)| (t, Corner { y: 1, ..c })).collect();
        let [outer, inner] = [0, 2].map(|edge| Side::edge(placed, boundary, edge));
        zip(&outer, &away(inner), &mut out);
    } else if has(1) || has(3) {
        let away = |row: Row| row.into_iter().map(|(t, c)| (t, Corner { x: 1, ..c })).collect();
        let [outer, inner] = [3, 1].map(|edge| Side::edge(placed, boundary, edge));
        zip(&outer, &away(inner), &mut out);
    } else {
        out = vec![[0, 1, 2], [0, 2, 3]];
    }
    canonical(out)
}

/// Cells of the interior; a diagonal rises where its cell lies in the same half of its row as of
/// its column, the cell in the middle of an odd number in the first.
fn grid(placed: &Placed, boundary: usize, out: &mut Vec<[usize; 3]>) {
    let [columns, rows] = [placed.columns.len(), placed.rows.len()];
    let first_half = |k: usize, cells: usize| (k as f64 + 0.5) <= cells as f64 / 2.0;
    for k in 0..(columns - 1) * (rows - 1) {
        let (i, j) = (k % (columns - 1), k / (columns - 1));
        let a = boundary + j * columns + i;
        let [b, c, d] = [a + 1, a + columns + 1, a + columns];
        let rises = first_half(i, columns - 1) == first_half(j, rows - 1);
        out.extend(if rises { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
}

fn zip(outer: &Row, inner: &Row, out: &mut Vec<[usize; 3]>) {
    for segment in outer.windows(2) {
        let before = inner.iter().rev().find(|(t, _)| *t < segment[1].0);
        let apex = before.unwrap_or(&inner[0]).1;
        out.push(counter_clockwise([segment[0].1, segment[1].1, apex]));
    }
    for segment in inner.windows(2) {
        let up_to = outer.iter().filter(|(t, _)| *t <= segment[1].0);
        let apex = up_to.max_by_key(|(t, _)| *t).unwrap_or(&outer[0]).1;
        out.push(counter_clockwise([segment[0].1, segment[1].1, apex]));
    }
}
