//! The bits of an IEEE 754 single in, an integer out: the port's converter. No floating-point
//! arithmetic.

use super::{RoundingMode, shift_right};

/// Set in the magnitude of what fits no format. The 48 bits below are the value's own, so that
/// wrapping is right too.
const HUGE: i64 = 1 << 60;

/// Bits of the widest format.
const LOW: i64 = (1 << 48) - 1;

/// `round(value * 2^fraction)` of the single with these bits, exact and rounded once; from 2^62 on,
/// an integer beyond every format with the same low 48 bits. So are infinities; a NaN is `None`:
/// the port says what it does with one.
#[must_use]
#[inline]
pub fn from_f32_bits<R: RoundingMode>(bits: u32, fraction: i32) -> Option<i64> {
    let exponent = (bits >> 23 & 0xff) as i32;
    let stored = i64::from(bits & 0x7f_ffff);
    let negative = bits >> 31 == 1;
    let sign = |magnitude: i64| if negative { -magnitude } else { magnitude };
    match exponent {
        0xff if stored != 0 => None,
        0xff => Some(sign(HUGE)),
        0 => Some(scale::<R>(sign(stored), -149 + fraction)), // subnormal
        _ => Some(scale::<R>(sign(stored | 1 << 23), exponent - 150 + fraction)),
    }
}

/// `round(mantissa * 2^shift)`; the mantissa has at most 24 bits and a sign.
#[inline]
fn scale<R: RoundingMode>(mantissa: i64, shift: i32) -> i64 {
    match shift {
        // Beyond 26 places only the sign of what is left matters; 40 keeps it.
        ..0 => shift_right::<R>(mantissa, shift.unsigned_abs().min(40)),
        0..38 => mantissa << shift,
        _ if mantissa == 0 => 0,
        _ => {
            let low = mantissa.abs().checked_shl(shift.unsigned_abs()).unwrap_or(0) & LOW;
            mantissa.signum() * (HUGE | low)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Floor, NearestAway, NearestEven, NearestUp};
    use super::*;
    use num_bigint::BigInt;
    use num_rational::Ratio;
    use proptest::prelude::*;

    /// The value as an exact rational, by the definition of the encoding.
    fn exact(value: f32, fraction: i32) -> Ratio<BigInt> {
        let v = Ratio::from_float(value).expect("finite");
        let power = BigInt::from(1) << fraction.unsigned_abs() as usize;
        if fraction >= 0 { v * power } else { v / power }
    }

    fn check<R: RoundingMode>(value: f32, fraction: i32) {
        let got = from_f32_bits::<R>(value.to_bits(), fraction).expect("not a NaN");
        let want = super::super::round::tests::reference(&exact(value, fraction), R::MODE);
        assert_eq!(BigInt::from(got), want, "{value:e} at {fraction} as {:?}", R::MODE);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn every_finite_single_is_rounded_as_an_exact_rational(
            exponent in 0u32..150, rest in 0u32..1 << 24, fraction in -40i32..36,
        ) {
            // Below 2^61 nothing is replaced by the stand-in for "fits no format".
            let value = f32::from_bits((rest >> 23) << 31 | exponent << 23 | rest & 0x7f_ffff);
            check::<Floor>(value, fraction);
            check::<NearestUp>(value, fraction);
            check::<NearestEven>(value, fraction);
            check::<NearestAway>(value, fraction);
        }
    }

    #[test]
    fn what_is_no_number_fits_no_format() {
        assert_eq!(from_f32_bits::<Floor>(f32::NAN.to_bits(), 8), None);
        assert_eq!(from_f32_bits::<Floor>(f32::INFINITY.to_bits(), 8), Some(HUGE));
        assert_eq!(from_f32_bits::<Floor>(f32::NEG_INFINITY.to_bits(), 8), Some(-HUGE));
        assert_eq!(from_f32_bits::<Floor>(f32::MAX.to_bits(), 48), Some(HUGE));
        // 3 * 2^45 does not fit, and wraps to 2^46 + 2^45 in 48 bits.
        let wide = from_f32_bits::<Floor>(3f32.to_bits(), 45 + 18);
        assert_eq!(wide.map(|w| w & LOW), Some(0));
        let odd = from_f32_bits::<Floor>(16_777_215f32.to_bits(), 40);
        assert_eq!(odd, Some(HUGE | 16_777_215 << 40 & LOW));
    }
}
