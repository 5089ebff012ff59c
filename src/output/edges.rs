//! The distinct edges of a patch's triangles, each once, in the order of first use.
//!
//! For `pattern`'s topology `line` and for wireframes. Within one patch only: between patches
//! nothing is merged.

use rtl_model::patch::Triangle;
use std::collections::HashMap;

/// Each edge as a pair of vertices, in the direction of its first use, with the set of sides (bit 0
/// back, bit 1 front) of the triangles that it bounds. `front` says which side a triangle shows;
/// `None` leaves it out.
#[must_use]
pub fn distinct(
    triangles: &[Triangle],
    front: impl Fn(&Triangle) -> Option<bool>,
) -> Vec<([u16; 2], u8)> {
    let mut edges: Vec<([u16; 2], u8)> = Vec::with_capacity(triangles.len() * 3 / 2 + 2);
    let mut known = HashMap::with_capacity(edges.capacity());
    for triangle in triangles {
        let Some(front) = front(triangle) else { continue };
        let side = if front { FRONT } else { BACK };
        let [a, b, c] = *triangle;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let at = *known.entry((from.min(to), from.max(to))).or_insert_with(|| {
                edges.push(([from, to], 0));
                edges.len() - 1
            });
            edges[at].1 |= side;
        }
    }
    edges
}

/// The edge bounds a triangle that shows its back.
pub const BACK: u8 = 1;
/// The edge bounds a triangle that shows its front.
pub const FRONT: u8 = 2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_edge_appears_once_in_the_direction_of_its_first_use() {
        let quad = [[0, 1, 2], [2, 1, 3]];
        let edges: Vec<_> = distinct(&quad, |_| Some(true)).into_iter().map(|e| e.0).collect();
        assert_eq!(edges, [[0, 1], [1, 2], [2, 0], [1, 3], [3, 2]]);
    }

    #[test]
    fn an_edge_knows_which_sides_it_bounds() {
        let quad = [[0, 1, 2], [2, 1, 3], [3, 4, 5]];
        let side = |t: &Triangle| match t[0] {
            0 => Some(true),
            2 => Some(false),
            _ => None,
        };
        let sides: Vec<_> = distinct(&quad, side).into_iter().map(|e| e.1).collect();
        assert_eq!(sides, [FRONT, FRONT | BACK, FRONT, BACK, BACK]);
    }
}
