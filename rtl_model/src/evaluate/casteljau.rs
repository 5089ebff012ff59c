//! De Casteljau's triangle at the reported parameters, each interpolation rounded once and
//! symmetric in its ends: so a reversed edge gives the same bits, for its parameters are exactly 1
//! - u.

use crate::number::{RoundingMode, lerp};
use crate::patch::Point;

use super::Slot;

/// The point of a cubic at `t` (U1.16): six interpolations of a vec4.
#[must_use]
pub fn curve_point<R: RoundingMode>(curve: &[Point; 4], t: u32) -> Point {
    triangle::<R>(curve, t)[2]
}

/// The last two points of the triangle, whose difference is a third of the derivative, and the
/// point between them.
pub(super) fn triangle<R: RoundingMode>([a, b, c, d]: &[Point; 4], t: u32) -> [Point; 3] {
    let mix =
        |p: &Point, q: &Point| -> Point { std::array::from_fn(|i| lerp::<R>(p[i], q[i], t, 16)) };
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    let (abc, bcd) = (mix(&ab, &bc), mix(&bc, &cd));
    [abc, bcd, mix(&abc, &bcd)]
}

/// Evaluates at a list's inner entries; `out` has a place for each. Returns half-runs (none) and
/// points evaluated.
pub(super) fn run<R: RoundingMode, S: Slot>(
    curve: &[Point; 4],
    parameters: &[u32],
    out: &mut [S],
) -> (u64, u64) {
    for (slot, &t) in out.iter_mut().zip(&parameters[1..]) {
        slot.put(curve_point::<R>(curve, t));
    }
    (0, out.len() as u64)
}
