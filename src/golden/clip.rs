//! Clip: control points in, whether all are outside one plane out (Sfarti et al. 2005, section 3).
//!
//! Maximum form: a plane's function is linear, so its maximum over the hull, and over the
//! surface, is attained at a control point; the patch is outside where that maximum is negative.
//! Exact for what comes from the port: its coordinates have at most 48 bits.

use super::{Real, real};
use rtl_model::patch::{Depth, Point};

/// Whether the greatest distance to the inner side of some plane is negative.
#[must_use]
pub fn outside(points: &[Point; 16], depth: Depth) -> bool {
    outside_real(&real(points), depth)
}

/// The same of points that were never quantised.
#[must_use]
pub fn outside_real(points: &[Real; 16], depth: Depth) -> bool {
    let distances = points.map(|p| inward(p, depth));
    let greatest = |plane: usize| distances.iter().map(|d| d[plane]).fold(f64::MIN, f64::max);
    (0..6).map(greatest).fold(f64::MAX, f64::min) < 0.0
}

/// Whether a point is outside none of the planes.
#[must_use]
pub fn inside(point: Real, depth: Depth) -> bool {
    inward(point, depth).iter().all(|&distance| distance >= 0.0)
}

/// How far a point lies inside each of the six planes, times w: left, right, lower, upper, near,
/// far.
#[must_use]
pub fn inward([x, y, z, w]: Real, depth: Depth) -> [f64; 6] {
    let nearest = match depth {
        Depth::ZeroToOne => z,
        Depth::MinusOneToOne => z + w,
    };
    [w + x, w - x, w + y, w - y, nearest, w - z]
}
