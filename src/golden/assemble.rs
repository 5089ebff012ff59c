//! Assemble: the size of a primitive in, the points of each of its patches out (Sfarti et al.
//! 2005, section 6).
//!
//! The definition is geometric. Control points are the nodes of a lattice, a patch is a cell with
//! its 4 x 4 nodes, points are numbered by row and column, and a patch brings the nodes that no
//! patch before it had. The block knows closed formulas for all that; here they are sets.

use std::collections::{BTreeMap, BTreeSet};

/// A patch of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Its points as numbers within the primitive, row-major.
    pub points: [u64; 16],
    /// How many of them no earlier patch has brought.
    pub new: u64,
}

/// `rows` by `columns` patches that share the points of their common edges, row by row.
#[must_use]
pub fn mesh(rows: u32, columns: u32) -> Vec<Cell> {
    let cells: Vec<[(u32, u32); 16]> =
        (0..rows).flat_map(|r| (0..columns).map(move |c| nodes(3 * r, 3 * c))).collect();
    number(&cells)
}

/// Patches that share nothing: cells of one row, with a gap between them.
#[must_use]
pub fn patches(count: u32) -> Vec<Cell> {
    let nodes = |n: u32| nodes(0, 0).map(|(row, column)| (4 * n + row, column));
    number(&(0..count).map(nodes).collect::<Vec<_>>())
}

/// `count` patches in a row that share the points of their common edges, numbered column by column.
#[must_use]
pub fn strip(count: u32) -> Vec<Cell> {
    let transposed = |n: u32| nodes(0, 3 * n).map(|(row, column)| (column, row));
    number(&(0..count).map(transposed).collect::<Vec<_>>())
}

/// `count` patches around a centre: cells of a lattice of spokes, of which the innermost ring is
/// one node. A node is numbered by its sector, inner ones before those of the spoke that ends it,
/// then by ring. `merged`: of the innermost inner nodes of a sector there is only one.
#[must_use]
pub fn fan(count: u32, merged: bool) -> Vec<Cell> {
    let node = |n: u32, ring: u32, k: u32| match (ring, k) {
        (0, _) => (0, 0, 0, 0),
        (_, 0) => (n, 1, ring, 0),
        (_, 3) => (n + 1, 1, ring, 0),
        (1, _) if merged => (n + 1, 0, ring, 1),
        _ => (n + 1, 0, ring, k),
    };
    let cell = |n| std::array::from_fn(|i| node(n, i as u32 / 4, i as u32 % 4));
    number(&(0..count).map(cell).collect::<Vec<_>>())
}

/// The 4 x 4 nodes from (row, column) on.
fn nodes(row: u32, column: u32) -> [(u32, u32); 16] {
    std::array::from_fn(|k| (row + k as u32 / 4, column + k as u32 % 4))
}

fn number<N: Copy + Ord>(cells: &[[N; 16]]) -> Vec<Cell> {
    let lattice: BTreeSet<N> = cells.iter().flatten().copied().collect();
    let numbers: BTreeMap<_, u64> = lattice.into_iter().zip(0..).collect();
    let mut seen = BTreeSet::new();
    let cell = |nodes: &[N; 16]| Cell {
        points: nodes.map(|node| numbers[&node]),
        new: nodes.iter().filter(|&&node| seen.insert(node)).count() as u64,
    };
    cells.iter().map(cell).collect()
}

/// The most points that are held for a later patch while patches come in order.
#[must_use]
pub fn held_peak(cells: &[Cell]) -> u64 {
    let mut last_use = BTreeMap::new();
    for (n, cell) in cells.iter().enumerate() {
        last_use.extend(cell.points.map(|point| (point, n)));
    }
    let mut held = BTreeSet::new();
    let mut peak = 0;
    for (n, cell) in cells.iter().enumerate() {
        held.extend(cell.points);
        held.retain(|point| last_use[point] > n);
        peak = peak.max(held.len() as u64);
    }
    peak
}

/// For each of the points that an indexed mesh uses, in order, whether a first-in first-out cache
/// of so many entries lacks it: it was not among the last of those that were lacking before.
#[must_use]
pub fn lacking(indices: &[u32], entries: usize) -> Vec<bool> {
    let mut lacked: Vec<u32> = Vec::new();
    let lacks = |index: &u32| {
        let held = &lacked[lacked.len().saturating_sub(entries)..];
        let lacks = !held.contains(index);
        if lacks {
            lacked.push(*index);
        }
        lacks
    };
    indices.iter().map(lacks).collect()
}
