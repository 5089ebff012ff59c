//! Rounded operations: each forms its exact result and rounds it once.

use super::{Rounding, RoundingMode};
use std::cmp::Ordering;

/// What is added before an arithmetic shift by `n >= 1` places, so that the shift rounds as `R`
/// says.
///
/// `odd`: the integer part is odd. `negative`: the value is negative. Half a unit is `half`; ties
/// are moved below the next integer by taking one unit in the last place off it.
#[inline(always)]
fn bias<R: RoundingMode>(half: i64, odd: i64, negative: i64) -> i64 {
    match R::MODE {
        Rounding::Floor => 0,
        Rounding::NearestUp => half,
        Rounding::NearestEven => half - 1 + odd,
        Rounding::NearestAway => half - negative,
    }
}

/// `round(value / 2^n)`, for |value| < 2^62 and n < 62.
#[must_use]
#[inline(always)]
pub fn shift_right<R: RoundingMode>(value: i64, n: u32) -> i64 {
    if n == 0 {
        return value;
    }
    let half = 1 << (n - 1);
    (value + bias::<R>(half, value >> n & 1, i64::from(value < 0))) >> n
}

/// `round(value / 2^n)`, for |value| < 2^126 and n < 126.
#[must_use]
#[inline]
pub fn shift_right_wide<R: RoundingMode>(value: i128, n: u32) -> i128 {
    if n == 0 {
        return value;
    }
    let half = 1_i128 << (n - 1);
    let bias = match R::MODE {
        Rounding::Floor => 0,
        Rounding::NearestUp => half,
        Rounding::NearestEven => half - 1 + (value >> n & 1),
        Rounding::NearestAway => half - i128::from(value < 0),
    };
    (value + bias) >> n
}

/// `round(numerator / denominator)`, correctly rounded. Both below 2^125 in magnitude.
///
/// # Panics
/// When the denominator is not positive.
#[must_use]
#[inline]
pub fn divide<R: RoundingMode>(numerator: i128, denominator: i128) -> i128 {
    if let (Ok(n), Ok(d)) = (i64::try_from(numerator), i64::try_from(denominator))
        && d < 1 << 62
    {
        return divide_narrow::<R>(n, d).into();
    }
    assert!(denominator > 0, "a denominator is positive");
    let (quotient, rest) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
    let up = rounds_up::<R>((2 * rest).cmp(&denominator), quotient & 1 != 0, numerator < 0);
    quotient + i128::from(up)
}

/// [`divide`] in 64 bits; the denominator below 2^62.
///
/// # Panics
/// When the denominator is not positive.
#[must_use]
#[inline]
fn divide_narrow<R: RoundingMode>(numerator: i64, denominator: i64) -> i64 {
    assert!(denominator > 0, "a denominator is positive");
    let (quotient, rest) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
    let up = rounds_up::<R>((2 * rest).cmp(&denominator), quotient & 1 != 0, numerator < 0);
    quotient + i64::from(up)
}

/// A divisor of several numerators, whose reciprocal is formed once: one division, then a
/// multiplication each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divisor {
    value: u64,
    /// floor(2^63 / value)
    reciprocal: u64,
}

impl Divisor {
    /// The divisor `value`, below 2^62.
    ///
    /// # Panics
    /// When the value is 0.
    #[must_use]
    #[inline]
    pub fn new(value: u64) -> Self {
        Self { value, reciprocal: (1 << 63) / value }
    }

    /// `round(numerator / value)`, correctly rounded where it lies in -`zero`..`zero`, and
    /// otherwise some integer outside of that; for |numerator| < 2^60 and value * `zero` <
    /// 2^61.
    #[must_use]
    #[inline(always)]
    pub fn divide<R: RoundingMode>(self, numerator: i64, zero: u64) -> i64 {
        // From -zero on the number line is positive, and floor is what a truncated product gives.
        // Rounding to nearest is the floor of one half more.
        let half = if matches!(R::MODE, Rounding::Floor) { 0 } else { self.value };
        let (double, shifted) = (2 * self.value, (2 * numerator) as u64);
        let from_zero = shifted.wrapping_add(double.wrapping_mul(zero)).wrapping_add(half);
        // The reciprocal takes less than from_zero / 2^64 off: the quotient, or one less.
        let estimate = ((u128::from(from_zero) * u128::from(self.reciprocal)) >> 64) as u64;
        let rest = from_zero.wrapping_sub(estimate.wrapping_mul(double));
        let short = rest >= double;
        let quotient = estimate.wrapping_add(u64::from(short)).wrapping_sub(zero) as i64;
        let tie = rest == 0 || rest == double; // half an ulp past the integer below
        quotient
            - i64::from(
                tie && match R::MODE {
                    Rounding::Floor | Rounding::NearestUp => false,
                    Rounding::NearestEven => quotient & 1 != 0,
                    Rounding::NearestAway => quotient <= 0,
                },
            )
    }
}

/// Whether a floored quotient goes one up; `past_half` compares what was cut off with a half.
#[inline(always)]
fn rounds_up<R: RoundingMode>(past_half: Ordering, odd: bool, negative: bool) -> bool {
    match R::MODE {
        Rounding::Floor => false,
        Rounding::NearestUp => past_half.is_ge(),
        Rounding::NearestEven => past_half.is_gt() || past_half.is_eq() && odd,
        Rounding::NearestAway => past_half.is_gt() || past_half.is_eq() && !negative,
    }
}

/// `round(a * (1 - t) + b * t)` with `t` an unsigned fraction of `n` bits, 0 to 2^n: one rounding,
/// so that swapping the ends gives the same bits (a + (b - a) * t would not).
#[must_use]
#[inline]
pub fn lerp<R: RoundingMode>(a: i64, b: i64, t: u32, n: u32) -> i64 {
    let t = i128::from(t);
    shift_right_wide::<R>(i128::from(a) * ((1 << n) - t) + i128::from(b) * t, n) as i64
}

/// The least integer whose square is at least `value`.
#[must_use]
#[inline]
pub fn sqrt_ceil(value: u128) -> u128 {
    let root = match u64::try_from(value) {
        Ok(narrow) => u128::from(narrow.isqrt()),
        Err(_) => value.isqrt(),
    };
    root + u128::from(root * root < value)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{
        Format, Modal, Overflow, OverflowMode, Saturate, Wrap, dispatch, from_f32_bits,
    };
    use super::*;
    use num_bigint::BigInt;
    use num_rational::Ratio;
    use proptest::prelude::*;

    /// Rounding by definition, on exact rationals.
    pub(in super::super) fn reference(value: &Ratio<BigInt>, mode: Rounding) -> BigInt {
        let floor = value.floor().to_integer();
        let cut = value - Ratio::from_integer(floor.clone());
        let half = Ratio::new(BigInt::from(1), BigInt::from(2));
        let odd = &floor % 2 != BigInt::from(0);
        let negative = value < &Ratio::from_integer(BigInt::from(0));
        let up = match mode {
            Rounding::Floor => false,
            Rounding::NearestUp => cut >= half,
            Rounding::NearestEven => cut > half || cut == half && odd,
            Rounding::NearestAway => cut > half || cut == half && !negative,
        };
        floor + BigInt::from(u8::from(up))
    }

    /// Rounding by definition on small rationals: enumerates the neighbours and picks.
    fn small(n: i64, d: i64, mode: Rounding) -> i64 {
        let floor = (n as f64 / d as f64).floor() as i64; // exact: |n|, d < 2^20
        let (below, above) = (n - floor * d, (floor + 1) * d - n); // distances, in 1/d
        match mode {
            Rounding::Floor => floor,
            _ if below < above => floor,
            _ if below > above => floor + 1,
            Rounding::NearestUp => floor + 1,
            Rounding::NearestEven => floor + (floor & 1),
            Rounding::NearestAway => {
                if n < 0 {
                    floor
                } else {
                    floor + 1
                }
            }
        }
    }

    fn fit_reference(value: i64, width: u32, mode: Overflow) -> i64 {
        let span = 1_i64 << width;
        match mode {
            Overflow::Saturate => value.max(1 - span / 2).min(span / 2 - 1),
            Overflow::Wrap => (value + span / 2).rem_euclid(span) - span / 2,
        }
    }

    /// All pairs of raw integers of one format, through every operation.
    struct Exhaust(Format);

    impl Modal for Exhaust {
        type Output = u64;

        fn run<R: RoundingMode, O: OverflowMode>(self) -> u64 {
            let Format { width, fraction } = self.0;
            let end = 1_i64 << (width - 1);
            let one = 1_i64 << fraction;
            let mut compared = 0;
            let mut same = |got: i64, (n, d): (i64, i64)| {
                let want = fit_reference(small(n, d, R::MODE), width, O::MODE);
                let (fitted, overflowed) = self.0.fit::<O>(got);
                assert_eq!(fitted, want, "{n}/{d} in {:?}, {:?} {:?}", self.0, R::MODE, O::MODE);
                assert_eq!(overflowed, small(n, d, R::MODE) != want);
                compared += 1;
            };
            for a in -end..end {
                for b in -end..end {
                    same(a + b, (a + b, 1));
                    same(a - b, (a - b, 1));
                    same(shift_right::<R>(a * b, fraction as u32), (a * b, one));
                    let wide =
                        shift_right_wide::<R>(i128::from(a) * i128::from(b), fraction as u32);
                    same(wide as i64, (a * b, one));
                    if b > 0 {
                        same(divide::<R>((a * one).into(), b.into()) as i64, (a * one, b));
                        same(Divisor::new(b as u64).divide::<R>(a * one, 1 << 20), (a * one, b));
                        // The same quotient through the 128-bit path.
                        let (n, d) = (i128::from(a * one) << 64, i128::from(b) << 64);
                        same(divide::<R>(n, d) as i64, (a * one, b));
                    }
                    for t in (0..=one).step_by((one as usize / 8).max(1)) {
                        let exact = a * (one - t) + b * t;
                        same(lerp::<R>(a, b, t as u32, fraction as u32), (exact, one));
                    }
                }
                // A quarter: rounds, and overflows at fraction 8.
                let single = (a as f32 / 4.0).to_bits();
                let got = from_f32_bits::<R>(single, fraction).expect("not a NaN");
                same(got, (a * one, 4));
            }
            compared
        }
    }

    #[test]
    fn every_operation_is_exact_on_every_format_of_up_to_8_bits() {
        let mut compared = 0;
        for width in 2..=8 {
            for fraction in 0..=width as i32 {
                for rounding in Rounding::ALL {
                    for overflow in Overflow::ALL {
                        compared +=
                            dispatch(rounding, overflow, Exhaust(Format { width, fraction }));
                    }
                }
            }
        }
        println!("compared {compared} results");
        assert!(compared > 60_000_000, "only {compared} compared");
    }

    fn same_as_i128<R: RoundingMode>(value: i64, n: u32) {
        assert_eq!(i128::from(shift_right::<R>(value, n)), shift_right_wide::<R>(value.into(), n));
        assert_eq!(shift_right_wide::<R>(value.into(), n), divide::<R>(value.into(), 1 << n));
    }

    fn same_as_divide<R: RoundingMode>(n: i64, d: u64, zero: u64) {
        let exact = divide::<R>(n.into(), d.into());
        let band = -i128::from(zero)..i128::from(zero);
        let got = i128::from(Divisor::new(d).divide::<R>(n, zero));
        assert_eq!(band.contains(&exact), band.contains(&got), "{n} / {d} within {zero}");
        assert!(!band.contains(&exact) || exact == got, "{n} / {d} is {exact}, not {got}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn shifts_and_divisions_agree_at_all_widths(
            value in -(1_i64 << 61)..1 << 61,
            n in 0u32..61,
        ) {
            same_as_i128::<super::super::Floor>(value, n);
            same_as_i128::<super::super::NearestUp>(value, n);
            same_as_i128::<super::super::NearestEven>(value, n);
            same_as_i128::<super::super::NearestAway>(value, n);
        }

        #[test]
        fn a_divisor_divides_as_a_division_does(
            numerator in -(1_i64 << 60)..1 << 60, shift in 0u32..50, bits in 1u32..38, d: u64,
            zero in 1u32..24,
        ) {
            let d = (d >> (64 - bits)).max(1);
            let (n, zero) = (numerator >> shift, 1_u64 << zero);
            same_as_divide::<super::super::Floor>(n, d, zero);
            same_as_divide::<super::super::NearestUp>(n, d, zero);
            same_as_divide::<super::super::NearestEven>(n, d, zero);
            same_as_divide::<super::super::NearestAway>(n, d, zero);
            let tie = (n % 100) * d as i64 + d as i64 / 2;
            same_as_divide::<super::super::NearestEven>(tie, d, zero);
            same_as_divide::<super::super::NearestAway>(tie, d, zero);
        }

        #[test]
        fn fits_as_modular_and_clamped_i128(value in -(1_i64 << 61)..1 << 61, width in 2u32..=48) {
            let format = Format { width, fraction: 0 };
            let span = 1_i64 << width;
            let wrapped = (value + span / 2).rem_euclid(span) - span / 2;
            prop_assert_eq!(format.fit::<Wrap>(value).0, wrapped);
            let saturated = value.max(1 - span / 2).min(span / 2 - 1);
            prop_assert_eq!(format.fit::<Saturate>(value).0, saturated);
        }

        #[test]
        fn agrees_with_the_fixed_crate(a: i32, b: i32) {
            type Q = fixed::types::I16F16;
            let (x, y) = (Q::from_bits(a), Q::from_bits(b));
            let q = Format { width: 32, fraction: 16 };
            let exact = i128::from(a) * i128::from(b);
            let product = shift_right_wide::<super::super::Floor>(exact, 16) as i64;
            prop_assert_eq!(q.fit::<Wrap>(product).0, i64::from(x.wrapping_mul(y).to_bits()));
            // The crate saturates to -2^31 where the symmetric range ends at 1 - 2^31.
            let symmetric = |v: Q| i64::from(v.to_bits()).max(-q.max());
            prop_assert_eq!(q.fit::<Saturate>(product).0, symmetric(x.saturating_mul(y)));
            let sum = i64::from(a) + i64::from(b);
            prop_assert_eq!(q.fit::<Wrap>(sum).0, i64::from(x.wrapping_add(y).to_bits()));
            prop_assert_eq!(q.fit::<Saturate>(sum).0, symmetric(x.saturating_add(y)));
            let even = shift_right::<super::super::NearestEven>(i64::from(a), 16) << 16;
            prop_assert_eq!(even as i32, x.wrapping_round_ties_even().to_bits());
        }

        #[test]
        fn lerp_does_not_see_which_end_is_first(a: i32, b: i32, t in 0u32..=65536) {
            let forth = lerp::<super::super::NearestEven>(a.into(), b.into(), t, 16);
            let back = lerp::<super::super::NearestEven>(b.into(), a.into(), 65536 - t, 16);
            prop_assert_eq!(forth, back);
        }

        #[test]
        fn sqrt_ceil_is_the_least_root(value in 0u128..1 << 120) {
            let root = sqrt_ceil(value);
            prop_assert!(root * root >= value && (root == 0 || (root - 1) * (root - 1) < value));
        }
    }
}
