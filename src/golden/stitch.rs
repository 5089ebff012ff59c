//! Stitch: places of vertices in, the triangles between them out, as a set.
//!
//! Moreton 2001, section 5.1, by its meaning rather than its registers: of the segments of two
//! facing half-rows, the one whose midpoint comes first on the half-edge gets the next triangle,
//! the inner one of two that tie. So all midpoints are sorted as exact fractions. Triangles are
//! turned counter-clockwise by the sign of their area over row numbers, which no coincidence of
//! parameters can make 0.

mod zipper;

use super::place::{Entry, Fraction, Placed};
use rtl_model::patch::{Triangle, Vertex};
use std::collections::HashSet;

pub use zipper::zipped;

/// A vertex: its number, and whole coordinates that grow as u and v do.
#[derive(Clone, Copy, Debug)]
struct Corner {
    number: usize,
    x: i64,
    y: i64,
}

/// Triangles whose corners stand at fewer than three positions.
#[must_use]
pub fn degenerate(vertices: &[Vertex], triangles: &[Triangle]) -> u64 {
    let positions = |t: &Triangle| -> HashSet<_> {
        t.iter().map(|&k| vertices[usize::from(k)].position).collect()
    };
    triangles.iter().filter(|t| positions(t).len() < 3).count() as u64
}

/// The triangles by vertex number, each with its least number first, sorted.
#[must_use]
pub fn triangles(placed: &Placed) -> Vec<[usize; 3]> {
    let boundary: usize = placed.edges.iter().map(|edge| edge.len() - 1).sum();
    if placed.columns.is_empty() {
        return canonical(vec![[0, 1, 2], [0, 2, 3]]);
    }
    let mut out = grid(placed, boundary);
    for side in 0..4 {
        Side::new(placed, boundary, side).stitch(&mut out);
    }
    canonical(out)
}

/// Triangles in an order of their own: each with its least number first, sorted.
#[must_use]
pub fn canonical(mut triangles: Vec<[usize; 3]>) -> Vec<[usize; 3]> {
    for t in &mut triangles {
        let [a, b, c] = *t;
        *t = [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or(*t);
    }
    triangles.sort_unstable();
    triangles
}

/// Cells of the interior; each diagonal runs towards the centre, and so from (0, 0) to (1, 1) in
/// a cell that holds it.
fn grid(placed: &Placed, boundary: usize) -> Vec<[usize; 3]> {
    let columns = placed.columns.len();
    let corner = |i: usize, j: usize| Corner {
        number: boundary + j * columns + i,
        x: i as i64,
        y: j as i64,
    };
    // Twice the middle of a cell, against twice the centre.
    let before = |list: &[Entry], k: usize| {
        let ([Fraction(a, b), Fraction(c, d)], half) =
            ([list[k].parameter, list[k + 1].parameter], Fraction::HALF);
        Fraction(a * d + c * b, 2 * b * d).cmp(&half)
    };
    let mut out = Vec::new();
    for j in 1..placed.rows.len() {
        for i in 1..columns {
            let [a, b, c, d] =
                [corner(i - 1, j - 1), corner(i, j - 1), corner(i, j), corner(i - 1, j)];
            let (u, v) = (before(&placed.columns, i - 1), before(&placed.rows, j - 1));
            let halves = if u == v { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            out.extend(halves.map(counter_clockwise));
        }
    }
    out
}

fn counter_clockwise([a, b, c]: [Corner; 3]) -> [usize; 3] {
    let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if area > 0 { [a.number, b.number, c.number] } else { [a.number, c.number, b.number] }
}

/// An edge and the interior's row (column) that faces it, both along the growing parameter.
struct Side {
    outer: Vec<(Fraction, Corner)>,
    inner: Vec<(Fraction, Corner)>,
    side: usize,
}

impl Side {
    fn new(placed: &Placed, boundary: usize, side: usize) -> Self {
        // Along the side and away from the edge, as growing x and y.
        let corner = |number: usize, along: usize, away: i64| {
            let along = along as i64;
            let (x, y) = [(along, away), (-away, along), (along, -away), (away, along)][side];
            Corner { number, x, y }
        };
        let (columns, rows) = (placed.columns.len(), placed.rows.len());
        let list = if side.is_multiple_of(2) { &placed.columns } else { &placed.rows };
        let inner = list.iter().enumerate().map(|(k, entry)| {
            let (i, j) = [(k, 0), (columns - 1, k), (k, rows - 1), (0, k)][side];
            (entry.parameter, corner(boundary + j * columns + i, k, 1))
        });
        let outer = Self::edge(placed, boundary, side);
        Self { outer, inner: inner.collect(), side }
    }

    /// The vertices of an edge along its growing parameter.
    fn edge(placed: &Placed, boundary: usize, side: usize) -> Vec<(Fraction, Corner)> {
        let start: usize = placed.edges[..side].iter().map(|edge| edge.len() - 1).sum();
        let edge = &placed.edges[side];
        let vertex = |k: usize| {
            let number = if side < 2 { start + k } else { start + edge.len() - 1 - k };
            let (x, y) = if side.is_multiple_of(2) { (k as i64, 0) } else { (0, k as i64) };
            (edge[k].parameter, Corner { number: number % boundary, x, y })
        };
        (0..edge.len()).map(vertex).collect()
    }

    fn stitch(&self, out: &mut Vec<[usize; 3]>) {
        let near = |list: &[(Fraction, Corner)]| -> Vec<Corner> {
            list.iter().filter(|p| p.0 <= Fraction::HALF).map(|p| p.1).collect()
        };
        let far = |list: &[(Fraction, Corner)]| -> Vec<Corner> {
            list.iter().rev().filter(|p| p.0 >= Fraction::HALF).map(|p| p.1).collect()
        };
        let halves = [(near(&self.outer), near(&self.inner)), (far(&self.outer), far(&self.inner))];
        let ends = halves.each_ref().map(|(outer, inner)| half(outer, inner, out));
        self.middle(ends, out);
    }

    /// What is left between the two halves where no vertex of the edge stands at its centre.
    fn middle(&self, [near, far]: [[Corner; 2]; 2], out: &mut Vec<[usize; 3]>) {
        if near[0].number == far[0].number {
            return;
        }
        if near[1].number == far[1].number {
            out.push(counter_clockwise([near[0], far[0], near[1]]));
            return;
        }
        // A quad: the diagonal starts at the edge's vertex that is nearer to (0, 0) or (1, 1).
        let (a, b) = if matches!(self.side, 0 | 3) { (near, far) } else { (far, near) };
        out.push(counter_clockwise([a[0], b[0], b[1]]));
        out.push(counter_clockwise([a[0], b[1], a[1]]));
    }
}

/// The triangles between two half-rows, both from the corner on. Returns the ends of both.
fn half(outer: &[Corner], inner: &[Corner], out: &mut Vec<[usize; 3]>) -> [Corner; 2] {
    let midpoints = |row: &[Corner]| -> Vec<Fraction> {
        let segments = row.len() as u64 - 1;
        (0..segments).map(|k| Fraction(2 * k + 1, 2 * segments)).collect()
    };
    let mut next: Vec<(Fraction, bool)> =
        midpoints(inner).into_iter().map(|m| (m, false)).collect();
    next.extend(midpoints(outer).into_iter().map(|m| (m, true)));
    next.sort_unstable(); // of two that tie the inner one, `false`, comes first
    let (mut o, mut i) = (0, 0);
    for (_, is_outer) in next {
        let (row, k) = if is_outer { (outer, &mut o) } else { (inner, &mut i) };
        let base = [row[*k], row[*k + 1]];
        *k += 1;
        let apex = if is_outer { inner[i] } else { outer[o] };
        out.push(counter_clockwise([base[0], base[1], apex]));
    }
    [outer[o], inner[i]]
}
