//! Degenerate triangles: those with two equal clip positions. They stay in the mesh, and are
//! counted.

use crate::patch::{Triangle, Vertex};
use crate::place::Numbering;

/// How many of these triangles have two equal positions, of any numbering.
#[must_use]
pub fn degenerate(vertices: &[Vertex], triangles: &[Triangle]) -> u64 {
    let at = |k: u16| &vertices[usize::from(k)].position;
    let is_degenerate = |t: &&Triangle| {
        let (a, b, c) = (at(t[0]), at(t[1]), at(t[2]));
        // Almost always x tells, without a branch a comparison.
        let same_x = (a[0] == b[0]) | (b[0] == c[0]) | (c[0] == a[0]);
        same_x && (a == b || b == c || c == a)
    };
    triangles.iter().filter(is_degenerate).count() as u64
}

/// The counter and its store.
///
/// Three comparisons of positions a triangle would cost as much as making it. So neighbours of the
/// interior grid are first compared by 32-bit fingerprints, whole rows at a time: where none agree,
/// and mostly none do, no triangle of the grid is degenerate.
#[derive(Clone, Debug, Default)]
pub struct Degenerate {
    fingerprints: Vec<u32>,
}

impl Degenerate {
    /// How many of a patch's triangles, in the order of [`super::accept`], have two equal
    /// positions.
    pub fn count(
        &mut self,
        placement: &impl Numbering,
        vertices: &[Vertex],
        triangles: &[Triangle],
    ) -> u64 {
        let [columns, rows] = placement.interior();
        let grid = 2 * columns.saturating_sub(1) * rows.saturating_sub(1); // the first ones
        let sure = if self.neighbours_agree(placement, vertices) { 0 } else { grid };
        degenerate(vertices, &triangles[sure..])
    }

    /// Whether two neighbours of the interior grid might be equal: along a row, a column or either
    /// diagonal.
    fn neighbours_agree(&mut self, placement: &impl Numbering, vertices: &[Vertex]) -> bool {
        let interior = &vertices[placement.boundary()..];
        self.fingerprints.clear();
        self.fingerprints.extend(interior.iter().map(|vertex| {
            let [x, y, z, w] = vertex.position;
            let mixed = x ^ y.rotate_left(16) ^ z.rotate_left(32) ^ w.rotate_left(48);
            (mixed ^ mixed >> 32) as u32
        }));
        let all = &self.fingerprints;
        let [columns, _] = placement.interior();
        // Beyond a row's end this compares with the next row's start: a needless look, never a
        // missed one.
        [1, columns.saturating_sub(1), columns, columns + 1].iter().any(|&apart| {
            let later = all.get(apart.max(1)..).unwrap_or_default();
            all.iter().zip(later).fold(false, |any, (a, b)| any | (a == b))
        })
    }
}
