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
//! - `normal_cone` (after Shirmun, Abi-Ezzi 1993): a cone around the points against a cone around
//!   the normals. Conservative, with fewer products; keeps more.
//! - `net_facets`: the 36 triangles of the control net, both diagonals of each facet. Closest to
//!   the paper; can drop a visible patch.
//! - `hull_literal`: the paper's word, to measure what comes of it.
//!
//! A coefficient of zero counts as away. A patch with a saturated point is kept: its surface is not
//! the user's. Each test looks at its facets (or coefficients, or directions) in an order of its
//! own until one of them keeps the patch, and says how many that took; none does for a patch that
//! is removed.

mod cone;
mod hull;
mod tangent;

use crate::patch::{Patch, Point, View};
use serde::{Deserialize, Serialize};

pub use cone::normal_cone;
pub use hull::hull_literal;
pub use tangent::{coefficients, tangent_plane};

/// Triangles of the control net: 9 facets, two diagonals, two sides of each.
const TRIANGLES: u32 = 36;

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
    /// A cone around the points at right angles or more to a cone around the normals: conservative.
    NormalCone,
    /// The facets of the convex hull: removes what has the viewer within its hull, nothing else.
    HullLiteral,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Off, Self::NetFacets, Self::TangentPlane, Self::NormalCone, Self::HullLiteral];

    /// How many facets, coefficients or directions the test has: what it looks at in a patch that
    /// it removes.
    #[must_use]
    pub const fn facets(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::NetFacets => TRIANGLES,
            Self::TangentPlane => tangent::COEFFICIENTS,
            Self::NormalCone => cone::DIRECTIONS,
            Self::HullLiteral => hull::TRIPLES,
        }
    }
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

/// Tests a patch. Returns the verdict, and how many facets a test that stops at the first that
/// keeps the patch looks at: 0 if it is not tested.
#[must_use]
pub fn accept(patch: &Patch, view: &View, method: Method) -> (Verdict, u32) {
    if !patch.cull || patch.saturated {
        return (Verdict::Untested, 0);
    }
    let front = if patch.reversed { -view.facing } else { view.facing };
    // Rows x, y, w, and x mirrored where a negative determinant is the front: from here on positive
    // is front.
    let points = patch.points.map(|[x, y, _, w]: Point| [x * front, y, w]);
    let width = view.position.width;
    let kept_by = match method {
        Method::Off => return (Verdict::Untested, 0),
        Method::NetFacets => net_facets(&points),
        Method::TangentPlane => tangent_plane(&points, width),
        Method::NormalCone => normal_cone(&points),
        Method::HullLiteral => hull_literal(&points, width),
    };
    kept_by.map_or((Verdict::Culled, method.facets()), |looked_at| (Verdict::Kept, looked_at))
}

/// How many of the 36 facet triangles are looked at until one faces the viewer, `None` if none
/// does: facet by facet, row by row, the two triangles of either diagonal. `points` are x, y, w
/// with positive volumes in front.
#[must_use]
pub fn net_facets(points: &[[i64; 3]; 16]) -> Option<u32> {
    let facet = |k: usize| {
        let (a, b, c, d) = (points[k], points[k + 1], points[k + 5], points[k + 4]);
        [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
    };
    let mut facets = (0..3).flat_map(|i| (0..3).map(move |j| 4 * i + j)).flat_map(facet);
    let first = facets.position(|[a, b, c]| {
        // Differences first: 48-bit coordinates would need 3 * 48 + 3 bits, and do not fit 128.
        tangent::exact_sign(a, tangent::minus(b, a), tangent::minus(c, a)).is_gt()
    });
    first.map(|k| k as u32 + 1)
}
