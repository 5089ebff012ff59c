//! A format is a value: a width and the place of the binary point.

use super::{Overflow, OverflowMode};

/// A signed fixed-point format: `width` bits in all, of which `fraction` stand behind the binary
/// point. `fraction` may be negative or exceed `width`: the point then lies outside the bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Format {
    /// Bits in all, with the sign: 2..=48.
    pub width: u32,
    /// Bits behind the binary point.
    pub fraction: i32,
}

impl Format {
    /// The format of `width` bits whose range is +-2^`range_log2`.
    ///
    /// # Panics
    /// When the width is not 2..=48.
    #[must_use]
    pub fn of_range(width: u32, range_log2: i32) -> Self {
        assert!((2..=48).contains(&width), "a width of {width} bits is outside 2..=48");
        Self { width, fraction: width as i32 - 1 - range_log2 }
    }

    /// The largest raw integer, 2^(width-1) - 1.
    #[must_use]
    #[inline]
    pub const fn max(self) -> i64 {
        (1 << (self.width - 1)) - 1
    }

    /// The raw integer that `value` becomes, and whether it did not fit.
    ///
    /// Saturation keeps to the symmetric range; wrapping uses all of two's complement.
    #[must_use]
    #[inline]
    pub fn fit<O: OverflowMode>(self, value: i64) -> (i64, bool) {
        let fitted = match O::MODE {
            Overflow::Saturate => value.clamp(-self.max(), self.max()),
            Overflow::Wrap => {
                let unused = 64 - self.width;
                (value << unused) >> unused
            }
        };
        (fitted, fitted != value)
    }
}
