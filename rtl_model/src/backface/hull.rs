//! The convex hull of the 16 points, taken at its word: points in, the first of its facets that
//! faces the viewer out.
//!
//! Sfarti et al. 2005, section 3: "we test the polyhedral faces of the convex hull to determine if
//! they are forward-facing. If any face is forward-facing, then the patch is not discarded." Over
//! the rows x, y, w the viewer is the origin; with weights 1 that space is the eye's, its axes
//! scaled. A hull is closed, so from outside one of its facets always faces the viewer and nothing
//! is discarded; from inside none does, and everything is, whatever the surface shows. It is here
//! so that this can be measured (`tessim study backface`).
//!
//! Exact: each of the C(16,3) = 560 triples is a facet if no point lies on the viewer's side of its
//! plane. Outward is away from the points, so which way the patch is parametrised plays no part. A
//! patch in one plane is a facet with two sides: it is discarded only by a viewer in that plane.
//! Three points in a line are no facet. Differences have W + 1 bits, normals 2 W + 3, volumes
//! 3 W + 5: 128 bits up to 36-bit positions, 256 beyond.

use super::tangent::{self, Row, WIDTH_MAX_128, cross, dot};
use crate::number::Wide;
use ethnum::I256;
use std::cmp::Ordering;

/// Triples of 16 points.
pub(super) const TRIPLES: u32 = 560;

/// How many triples are looked at, in the order of their indices, until one is a facet that faces
/// the viewer; `None` if none is. `points` are x, y, w of at most `width` bits.
#[must_use]
pub fn hull_literal(points: &[Row<i64>; 16], width: u32) -> Option<u32> {
    if width <= WIDTH_MAX_128 {
        first_towards::<i128>(points)
    } else {
        first_towards::<I256>(points)
    }
}

fn first_towards<T: Wide>(points: &[Row<i64>; 16]) -> Option<u32> {
    let mut looked_at = 0;
    for i in 0..16 {
        let from = points.map(|p| tangent::minus(p, points[i]).map(T::of));
        let viewer = points[i].map(|c| T::of(-c));
        for j in i + 1..16 {
            for k in j + 1..16 {
                looked_at += 1;
                let normal = cross(from[j], from[k]);
                let side = |p: Row<T>| dot(normal, p).cmp(&T::default());
                let viewer = side(viewer);
                if viewer != Ordering::Equal && from.iter().all(|&p| side(p) != viewer) {
                    return Some(looked_at);
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A net over the square -2..2 at the depth w = 10, with a ridge in the middle.
    fn sheet() -> [Row<i64>; 16] {
        std::array::from_fn(|k| {
            let (i, j) = (k as i64 / 4, k as i64 % 4);
            [3 * j - 4, 3 * i - 4, 10 + i * j * (3 - i) * (3 - j)]
        })
    }

    #[test]
    fn from_outside_a_facet_faces_the_viewer_and_from_inside_none_does() {
        let points = sheet();
        assert!(hull_literal(&points, 8).is_some());
        let turned = points.map(|[x, y, w]| [-x, y, w]);
        assert!(hull_literal(&turned, 8).is_some(), "outward is not how the patch is turned");
        let mean = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).sum::<i64>());
        let inside = points.map(|p| [0, 1, 2].map(|axis| 16 * p[axis] - mean[axis]));
        assert_eq!(hull_literal(&inside, 16), None);
        assert_eq!(hull_literal(&inside, 48), None);
    }

    #[test]
    fn a_patch_in_a_plane_has_two_sides_and_one_in_a_line_has_none() {
        let flat = sheet().map(|[x, y, _]| [x, y, 10]);
        assert_eq!(hull_literal(&flat, 8), Some(3), "two triples of a row, then one that is none");
        assert_eq!(hull_literal(&flat.map(|[x, y, w]| [x, y, -w]), 8), Some(3));
        assert_eq!(hull_literal(&flat.map(|[x, y, _]| [x, y, 0]), 8), None, "the viewer is in it");
        assert_eq!(hull_literal(&flat.map(|[x, _, w]| [x, 1, w]), 8), None);
    }

    #[test]
    fn facets_are_exact_where_128_bits_end() {
        // A tetrahedron round the viewer, who is 1 ulp inside its face x = -1, in it, and outside.
        let far = (1 << 47) - 1;
        let corners = |x| [[x, -far, -far], [x, far, -far], [x, 0, far], [far, 0, 0]];
        let patch = |x| -> [Row<i64>; 16] { std::array::from_fn(|k| corners(x)[k % 4]) };
        assert_eq!(hull_literal(&patch(-1), 48), None);
        assert_eq!(hull_literal(&patch(0), 48), None);
        assert!(hull_literal(&patch(1), 48).is_some());
    }
}
