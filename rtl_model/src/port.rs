//! Port: the bits of f32 coordinates in, points in the position format out.
//!
//! Rounds to nearest even and saturates to +-(2^(W-1) - 1) unless configured otherwise. Both are
//! odd and monotone, so quantisation alone never moves an inside point outside: `x <= w` before
//! means `x <= w` after.
//!
//! The scale is a power of two that the whole frame shares; it is part of the format
//! (`Format::of_range`).

use crate::number::{Format, OverflowMode, RoundingMode, from_f32_bits};
use crate::patch::Point;

/// A quantised point and how many of its coordinates did not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantised {
    /// The point.
    pub point: Point,
    /// Coordinates that did not fit, 0..=4.
    pub overflows: u32,
}

/// Quantises a homogeneous point given as f32 bits.
///
/// A NaN (a transform that overflowed) becomes 0 and counts as a coordinate that did not fit.
#[must_use]
#[inline]
pub fn accept<R: RoundingMode, O: OverflowMode>(bits: [u32; 4], format: Format) -> Quantised {
    let mut quantised = Quantised { point: [0; 4], overflows: 0 };
    for (raw, bits) in quantised.point.iter_mut().zip(bits) {
        let exact = from_f32_bits::<R>(bits, format.fraction);
        let (fitted, overflowed) = format.fit::<O>(exact.unwrap_or(0));
        *raw = fitted;
        quantised.overflows += u32::from(overflowed || exact.is_none());
    }
    quantised
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{NearestEven, Saturate};
    use proptest::prelude::*;

    fn quantise(p: [f32; 4], format: Format) -> Point {
        accept::<NearestEven, Saturate>(p.map(f32::to_bits), format).point
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5_000))]
        #[test]
        fn an_inside_coordinate_stays_inside(
            w in -100f32..100.0, t in -1f32..=1.0, width in 8u32..=48, range in -2i32..8,
        ) {
            let format = Format::of_range(width, range);
            let [x, .., q] = quantise([w.abs() * t, 0.0, 0.0, w.abs()], format);
            prop_assert!(x <= q && -x <= q);
        }

        #[test]
        fn quantisation_is_odd(x in -100f32..100.0, width in 8u32..=48) {
            let format = Format::of_range(width, 4);
            prop_assert_eq!(quantise([x; 4], format)[0], -quantise([-x; 4], format)[0]);
        }
    }

    #[test]
    fn what_does_not_fit_is_counted() {
        let format = Format::of_range(8, 0);
        let got =
            accept::<NearestEven, Saturate>([1.0, -3.0, f32::NAN, 0.5].map(f32::to_bits), format);
        assert_eq!(got, Quantised { point: [127, -127, 0, 64], overflows: 3 });
    }
}
