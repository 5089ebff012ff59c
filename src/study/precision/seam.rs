//! Seams: the edges that two patches of a frame share, and whether both put their vertices at the
//! same places there.
//!
//! Two edges are one where their four control points are the same in f64, from either end, and both
//! are tessellated under the same state. A collapsed edge, four times the same point, has nothing
//! to crack.

use crate::golden::Real;
use rtl_model::emit::Screen;
use rtl_model::level::State;
use rtl_model::patch::{EDGES, ONE, Point, Vertex};
use std::collections::HashMap;

/// An edge of one patch and the edge of another that it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seam {
    /// Patches by number.
    pub(super) patches: [usize; 2],
    /// Which of their edges, in the order v0, u1, v1, u0.
    pub(super) edges: [usize; 2],
    /// Whether the second runs the other way.
    pub(super) reversed: bool,
}

/// A vertex as it leaves evaluate, and emit.
pub(super) type Station = (Point, Screen);

/// The vertices of an edge, along its growing parameter.
pub(super) type Strand = Vec<Station>;

type Bits = [[u64; 4]; 4];

/// The seams of a frame, of its patches' control points and tessellation states. Of more than two
/// patches at an edge, each is compared with the first.
pub(super) fn seams(patches: &[(&[Real; 16], &State)]) -> Vec<Seam> {
    let mut firsts: HashMap<Bits, (usize, usize, bool)> = HashMap::new();
    let mut seams = Vec::new();
    for (patch, (points, state)) in patches.iter().enumerate() {
        for (edge, line) in EDGES.iter().enumerate() {
            let bits = line.map(|k| bits(&points[k]));
            let mut reversed = bits;
            reversed.reverse();
            if bits.iter().all(|point| *point == bits[0]) {
                continue;
            }
            let turned = reversed < bits;
            let key = if turned { reversed } else { bits };
            let &mut (first, other, was) = firsts.entry(key).or_insert((patch, edge, turned));
            if (first, other) != (patch, edge) && patches[first].1 == *state {
                let reversed = turned != was;
                seams.push(Seam { patches: [first, patch], edges: [other, edge], reversed });
            }
        }
    }
    seams
}

/// The bits of a point; of two zeros the positive one.
fn bits(point: &Real) -> [u64; 4] {
    point.map(|c| (c + 0.0).to_bits())
}

/// The four edges of a mesh, whose boundary comes first, counter-clockwise from (0, 0).
pub(super) fn strands(vertices: &[Vertex], screen: &[Screen]) -> [Strand; 4] {
    let outer = |t: u32| t == 0 || t == ONE;
    let count = vertices.iter().take_while(|v| outer(v.u) || outer(v.v)).count();
    let corner = |u, v| {
        let at = vertices[..count].iter().position(|vertex| (vertex.u, vertex.v) == (u, v));
        at.expect("a patch has four corners")
    };
    let corners = [0, corner(ONE, 0), corner(ONE, ONE), corner(0, ONE), count];
    [0, 1, 2, 3].map(|edge| {
        let around = corners[edge]..=corners[edge + 1];
        let mut strand: Strand =
            around.map(|k| k % count).map(|k| (vertices[k].position, screen[k])).collect();
        if edge >= 2 {
            strand.reverse();
        }
        strand
    })
}

/// Vertices compared along a seam, and how many of them differ. A vertex without its like differs.
pub(super) fn compare(a: &[Station], b: &[Station], reversed: bool) -> [u64; 2] {
    let (count, most) = (a.len().min(b.len()), a.len().max(b.len()));
    let other = |k: usize| if reversed { &b[b.len() - 1 - k] } else { &b[k] };
    let different = (0..count).filter(|&k| a[k] != *other(k)).count();
    [most, different + most - count].map(|n| n as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtl_model::level::Criterion;
    use rtl_model::patch::Level;

    type Edges = ([Real; 16], State);

    fn flat(x: f64) -> Edges {
        let points = std::array::from_fn(|k| [x + (k % 4) as f64, (k / 4) as f64, 0.0, 1.0]);
        let criterion = Criterion::Fixed { level: Level::TWO };
        let state = State { criterion, min: Level::MIN, max: Level::MAX };
        (points, state)
    }

    fn seams(patches: &[Edges]) -> Vec<Seam> {
        super::seams(&patches.iter().map(|(points, state)| (points, state)).collect::<Vec<_>>())
    }

    #[test]
    fn edges_with_the_same_points_are_seams_from_either_end() {
        let mut turned = flat(3.0);
        turned.0.reverse(); // its u1 is where u0 was
        let found = seams(&[flat(0.0), turned, flat(20.0)]);
        assert_eq!(found, [Seam { patches: [0, 1], edges: [1, 1], reversed: true }]);
        let seam = seams(&[flat(0.0), flat(3.0)]);
        assert_eq!(seam, [Seam { patches: [0, 1], edges: [1, 3], reversed: false }]);
        let mut finer = flat(3.0);
        finer.1.min = Level::TWO;
        assert!(seams(&[flat(0.0), finer]).is_empty(), "states differ");
        let mut collapsed = flat(3.0);
        for k in [0, 4, 8, 12] {
            collapsed.0[k] = [3.0, 0.0, 0.0, 1.0];
        }
        assert_eq!(seams(&[collapsed, collapsed]).len(), 3);
    }

    #[test]
    fn a_vertex_elsewhere_is_a_crack_and_so_is_one_too_many() {
        let vertex = |k: i64| ([k, 0, 0, 1], Screen::default());
        let strand: Strand = (0..5).map(vertex).collect();
        let mut back = strand.clone();
        back.reverse();
        assert_eq!(compare(&strand, &strand, false), [5, 0]);
        assert_eq!(compare(&strand, &back, true), [5, 0]);
        assert_eq!(compare(&strand, &back, false), [5, 4], "the middle is its own mirror image");
        back[2].0[1] = 7;
        assert_eq!(compare(&strand, &back, true), [5, 1]);
        back[2] = strand[2];
        back[1].1.x = 1;
        assert_eq!(compare(&strand, &back, true), [5, 1], "the screen counts too");
        assert_eq!(compare(&strand[..3], &strand, false), [5, 2]);
    }

    #[test]
    fn the_boundary_of_a_mesh_is_four_strands_along_their_parameters() {
        // A square of two segments an edge, its middle last.
        let at = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1], [1, 1]];
        let vertex = |[u, v]: [u32; 2]| Vertex {
            position: [i64::from(u), i64::from(v), 0, 1],
            u: u * ONE / 2,
            v: v * ONE / 2,
        };
        let strands = strands(&at.map(vertex), &[Screen::default(); 9]);
        let places = strands.map(|s| s.iter().map(|v| [v.0[0], v.0[1]]).collect::<Vec<_>>());
        assert_eq!(places[0], [[0, 0], [1, 0], [2, 0]]);
        assert_eq!(places[1], [[2, 0], [2, 1], [2, 2]]);
        assert_eq!(places[2], [[0, 2], [1, 2], [2, 2]]);
        assert_eq!(places[3], [[0, 0], [0, 1], [0, 2]]);
    }
}
