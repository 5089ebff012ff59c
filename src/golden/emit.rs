//! Emit: clip positions in, pixels out: the divide and the viewport as a textbook has them, in
//! f64 and unrounded.

use super::Real;

/// The greatest magnitude of a screen coordinate, in pixels.
pub const BAND: f64 = 32768.0;

/// Pixels from the upper left corner; `None` behind the eye.
#[must_use]
pub fn screen([x, y, _, w]: Real, [width, height]: [u32; 2]) -> Option<[f64; 2]> {
    let (x, y) = (x / w, y / w); // normalised device coordinates
    (w > 0.0).then(|| [f64::from(width) * 0.5 * (1.0 + x), f64::from(height) * 0.5 * (1.0 - y)])
}
