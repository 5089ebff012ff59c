//! Tangent planes: the block works in clip space, the golden model crosses the derivatives of the
//! surface before the transform; `M^T plane` must point along them.

use super::ledger::Ledger;
use super::table::{At, Quantity as Q};
use rtl_model::evaluate;
use rtl_model::patch::Patch;
use tessim::golden::{Real, control_point, evaluate as golden};

/// By how many ulps each coordinate of S may be off: its control points by 1/2, six
/// interpolations by 1/2 each.
const POINT_ULPS: f64 = 3.5;

/// Su/3 and Sv/3 are differences of two points five interpolations deep.
const TANGENT_ULPS: f64 = 6.0;

/// The share of the worst case that the budget grants.
const SHARE: f64 = 0.4;

/// Directions that are known to less than this, in radians, tell nothing.
const SPREAD_MAX: f64 = 0.1;

/// A patch as it was before the transform `matrix` (column-major) to clip space, and `scale`,
/// ulps a unit.
pub(crate) struct Source<'a> {
    pub(crate) object: &'a [Real; 16],
    pub(crate) matrix: &'a [f64; 16],
    pub(crate) scale: f64,
}

pub(crate) fn plane(ledger: &mut Ledger, patch: &Patch, source: &Source<'_>, [u, v]: [u32; 2]) {
    let plane = evaluate::tangent_plane(patch, u, v).map(|c| c as f64);
    let (u, v) = (f64::from(u) / 65536.0, f64::from(v) / 65536.0);
    let want = golden::normal(source.object, u, v);
    let spread = spread(source, [u, v], norm(&want));
    if spread > SPREAD_MAX || spread.is_nan() {
        return;
    }
    let m = source.matrix;
    // det M decides which way the mapped plane points.
    let side = determinant(m).signum();
    let got = [0, 1, 2].map(|c| side * (0..4).map(|row| m[4 * c + row] * plane[row]).sum::<f64>());
    let cross = [
        got[1] * want[2] - got[2] * want[1],
        got[2] * want[0] - got[0] * want[2],
        got[0] * want[1] - got[1] * want[0],
    ];
    let dot: f64 = (0..3).map(|k| got[k] * want[k]).sum();
    let angle = norm(&cross).atan2(dot);
    ledger.error(Q::Plane, &At { spread, ..At::default() }, angle);
}

/// The angle that roundings of S, Su and Sv and of the plane's coefficients could turn the normal
/// by.
fn spread(source: &Source<'_>, [u, v]: [f64; 2], normal: f64) -> f64 {
    let clip = source.object.map(|p| control_point::transform(source.matrix, p));
    let clip = clip.map(|p| p.map(|c| c * source.scale));
    let vectors = golden::derivatives(&clip, u, v).map(|d| d.map(|c| c / 3.0));
    let point = golden::surface(&clip, u, v);
    let (s, [su, sv]) = (norm(&point), vectors.map(|d| norm(&d)));
    // |a ^ b ^ c| <= |a| |b| |c|; a vector of four coordinates within e is within 2 e.
    let (ds, dt) = (2.0 * POINT_ULPS, 2.0 * TANGENT_ULPS);
    let moved = (s + ds) * (su + dt) * (sv + dt) - s * su * sv;
    // The largest coefficient has 31 bits, of which the first is set, and all four are rounded.
    let coefficients = s * su * sv * 2f64.powi(-30);
    let columns = norm(&source.matrix[..12]);
    // M^T wedge = det M (Su x Sv) in object space; S, Su/3, Sv/3 are in ulps.
    let exact = determinant(source.matrix).abs() * normal * source.scale.powi(3) / 9.0;
    SHARE * columns * (moved + coefficients) / exact
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn determinant(m: &[f64; 16]) -> f64 {
    glam::DMat4::from_cols_array(m).determinant()
}
