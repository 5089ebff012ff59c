//! Back-face removal: patches in; those that no viewer can see from the front go no further.
//!
//! Sfarti et al. 2005, section 3, tests "the polyhedral faces of the convex hull". Taken at its
//! word that cannot work (a closed hull seen from outside always has a face towards the viewer), so
//! the test is an enum:
//!
//! - `tangent_plane` (Loop, Niessner, Eisenacher 2011): the sign of det[S, Su, Sv] over the rows x,
//!   y, w says which side of the surface the viewer is on. As a polynomial it has bidegree (8, 8);
//!   if none of its 81 Bernstein coefficients is towards the viewer, no point of the surface is.
//!   Conservative, and exact on the quantised points.
//! - `net_facets`: the 36 triangles of the control net, both diagonals of each facet. Closest to
//!   the paper; can drop a visible patch.
//!
//! A coefficient of zero counts as away. A patch with a saturated point is kept: its surface is not
//! the user's.

mod tangent;

use crate::patch::{Patch, Point, View};
use serde::{Deserialize, Serialize};

pub use tangent::{coefficients, tangent_plane};

/// The test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// No patch is removed.
    Off,
    /// The 36 facets of the control net, both diagonals: Sfarti's "faces of the hull". Not
    /// conservative.
    NetFacets,
    /// The 81 Bernstein coefficients of det[S, Su, Sv], none towards the viewer: conservative.
    TangentPlane,
}

/// What became of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Not tested: the draw does not cull, the method is off, or a point was saturated.
    Untested,
    /// Tested and kept.
    Kept,
    /// Removed.
    Culled,
}

/// Tests a patch.
#[must_use]
pub fn accept(patch: &Patch, view: &View, method: Method) -> Verdict {
    if !patch.cull || patch.saturated || method == Method::Off {
        return Verdict::Untested;
    }
    let front = if patch.reversed { -view.facing } else { view.facing };
    // Rows x, y, w, and x mirrored where a negative determinant is the front: from here on positive
    // is front.
    let points = patch.points.map(|[x, y, _, w]: Point| [x * front, y, w]);
    let away = match method {
        Method::Off => false,
        Method::NetFacets => net_facets(&points),
        Method::TangentPlane => tangent_plane(&points, view.position.width),
    };
    if away { Verdict::Culled } else { Verdict::Kept }
}

/// Whether none of the 36 facet triangles faces the viewer; `points` are x, y, w with positive
/// volumes in front.
#[must_use]
pub fn net_facets(points: &[[i64; 3]; 16]) -> bool {
    let facet = |k: usize| {
        let (a, b, c, d) = (points[k], points[k + 1], points[k + 5], points[k + 4]);
        [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
    };
    let mut facets = (0..3).flat_map(|i| (0..3).map(move |j| 4 * i + j)).flat_map(facet);
    facets.all(|[a, b, c]| {
        // Differences first: 48-bit coordinates would need 3 * 48 + 3 bits, and do not fit 128.
        tangent::exact_sign(a, tangent::minus(b, a), tangent::minus(c, a)).is_le()
    })
}
