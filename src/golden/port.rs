//! Port: a real coordinate in, the integer that stands for it out (DESIGN: numbers along the way).
//!
//! The block shifts a mantissa; here the scaled number is rounded as a real. Every step is exact
//! in f64: an f32 times a power of two keeps its 24 bits, and so do its floor and its remainder.

use crate::config::{Overflow, Rounding};

/// The integer nearest to `value * 2^fraction` in the sense of `rounding`, fitted to `width`
/// bits, and whether it fits.
///
/// A NaN becomes 0, and infinities either end of the range or, wrapped, 0; none of them fits.
#[must_use]
pub fn quantise(
    value: f32,
    (width, fraction): (u32, i32),
    rounding: Rounding,
    overflow: Overflow,
) -> (i64, bool) {
    let max = 2f64.powi(width as i32 - 1) - 1.0;
    if !value.is_finite() {
        let end = if value.is_nan() { 0.0 } else { max.copysign(value.into()) };
        return (if overflow == Overflow::Saturate { end as i64 } else { 0 }, false);
    }
    let whole = rounded(f64::from(value) * 2f64.powi(fraction), rounding);
    let fitted = match overflow {
        Overflow::Saturate => whole.clamp(-max, max),
        Overflow::Wrap => {
            let span = 2.0 * (max + 1.0);
            let low = whole.rem_euclid(span);
            if low > max { low - span } else { low }
        }
    };
    (fitted as i64, fitted == whole)
}

/// A real number as an integer.
#[must_use]
pub fn rounded(x: f64, rounding: Rounding) -> f64 {
    match rounding {
        Rounding::Floor => x.floor(),
        Rounding::NearestEven => x.round_ties_even(),
        Rounding::NearestAway => x.round(),
        Rounding::NearestUp if x - x.floor() >= 0.5 => x.floor() + 1.0,
        Rounding::NearestUp => x.floor(),
    }
}
