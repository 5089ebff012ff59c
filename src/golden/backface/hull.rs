//! The convex hull taken at its word: control points in, whether the viewer is within it out.
//!
//! A viewer sees a facet of a closed hull from outside it exactly when he is outside the hull. So
//! no facet is looked for: the viewer is the origin of x, y, w, and within the hull if he is within
//! a tetrahedron of four of the points (Carathéodory; where the hull has a volume, tetrahedra with
//! a volume suffice). Points in one plane make no tetrahedron; there the plane itself is the facet,
//! and only a viewer in it sees none.
//!
//! With d(a, b, c) the volume under the viewer of a triangle, the tetrahedron of a, b, c, d has the
//! volume d(b,c,d) - d(a,c,d) + d(a,b,d) - d(a,b,c), and its terms are the viewer's barycentric
//! coordinates.

use super::{ROWS, leibniz};
use ethnum::I256;
use rtl_model::patch::Point;

/// Whether no facet of the hull of the control points faces the viewer.
#[must_use]
pub fn holds_viewer(points: &[Point; 16]) -> bool {
    let mut volumes = [[[I256::ZERO; 16]; 16]; 16]; // filled where the indices grow
    let mut in_sight = false;
    for (a, b, c) in (0..16).flat_map(|a| (0..a).flat_map(move |b| (0..b).map(move |c| (a, b, c))))
    {
        let volume = leibniz([c, b, a].map(|k| ROWS.map(|row| points[k][row])));
        volumes[c][b][a] = volume;
        in_sight |= volume != I256::ZERO;
    }
    let mut solid = false;
    for a in 0..16 {
        for b in a + 1..16 {
            for c in b + 1..16 {
                for d in c + 1..16 {
                    let shares =
                        [volumes[b][c][d], -volumes[a][c][d], volumes[a][b][d], -volumes[a][b][c]];
                    let whole = shares.iter().fold(I256::ZERO, |sum, &share| sum + share);
                    solid |= whole != I256::ZERO;
                    let within = |&share: &I256| share.signum() * whole.signum() >= I256::ZERO;
                    if whole != I256::ZERO && shares.iter().all(within) {
                        return true;
                    }
                }
            }
        }
    }
    !solid && !in_sight
}
