//! The bits of an IEEE 754 single in, an integer out: the port's converter. No floating-point arithmetic.

use super::{RoundingMode, shift_right_wide};

/// A magnitude that fits no format and whose low 48 bits are zero, so that wrapping it is right as well.
const HUGE: i128 = 1 << 126;

/// `round(value * 2^fraction)` of the single with these bits, exact and rounded once.
///
/// Infinities become a magnitude that fits no format; a NaN becomes `None`: the port says what it does with one.
#[must_use]
pub fn from_f32_bits<R: RoundingMode>(bits: u32, fraction: i32) -> Option<i128> {
    let exponent = (bits >> 23 & 0xff) as i32;
    let stored = i128::from(bits & 0x7f_ffff);
    let magnitude = match exponent {
        0xff if stored != 0 => return None,
        0xff => HUGE,
        0 => return Some(scale::<R>(sign(bits) * stored, -149 + fraction)), // subnormal
        _ => return Some(scale::<R>(sign(bits) * (stored | 1 << 23), exponent - 150 + fraction)),
    };
    Some(sign(bits) * magnitude)
}

fn sign(bits: u32) -> i128 {
    if bits >> 31 == 0 { 1 } else { -1 }
}

/// `round(mantissa * 2^shift)`; the mantissa has at most 24 bits and a sign.
fn scale<R: RoundingMode>(mantissa: i128, shift: i32) -> i128 {
    match shift {
        _ if mantissa == 0 => 0,
        102.. => mantissa.signum() * HUGE,
        0..102 => mantissa << shift,
        // Beyond 26 places only the sign of what is left matters; 100 keeps it.
        _ => shift_right_wide::<R>(mantissa, shift.unsigned_abs().min(100)),
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
            exponent in 0u32..170, rest in 0u32..1 << 24, fraction in -40i32..50,
        ) {
            // Below 2^44 nothing is replaced by the stand-in for "fits no format".
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
    }
}
