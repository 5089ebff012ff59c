//! Clip: patches in; those wholly outside one plane of the clip volume go no further.
//!
//! Sfarti et al. 2005, section 3: if the 16 control points all lie outside the same plane, so does
//! the surface. In clip space the planes are linear, so the test holds for every sign of w and for
//! rational patches with positive weights; a point on a plane is inside.

use crate::patch::{Depth, Patch, Point};

/// The planes that a point lies outside of, a bit each: x < -w, x > w, y < -w, y > w, nearer,
/// farther.
#[must_use]
#[inline]
pub fn outcode([x, y, z, w]: Point, depth: Depth) -> u8 {
    let nearest = match depth {
        Depth::ZeroToOne => 0,
        Depth::MinusOneToOne => -w,
    };
    u8::from(x < -w)
        | u8::from(x > w) << 1
        | u8::from(y < -w) << 2
        | u8::from(y > w) << 3
        | u8::from(z < nearest) << 4
        | u8::from(z > w) << 5
}

/// Whether the patch is wholly outside one plane.
#[must_use]
pub fn outside(patch: &Patch, depth: Depth) -> bool {
    let mut common = 0x3f;
    for &point in &patch.points {
        common &= outcode(point, depth);
        if common == 0 {
            return false;
        }
    }
    true
}
