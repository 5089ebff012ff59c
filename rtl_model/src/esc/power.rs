//! Power: control points in, `[N][B][M]^T` of the surface and the power basis of its edges out, and
//! samples of either.
//!
//! Concheiro et al. 2014, equation 8: what all samples of a surface share is computed once, and a
//! sample is `[U] [NBM] [V]`.
//!
//! Widths, for coordinates of W bits: the rows of N sum to 8, 12, 6 and 1 in magnitude, so that a
//! coefficient of a curve is at most 12 * 2^(W-1) and one of a surface at most 144 * 2^(W-1) <
//! 2^(W+7): W + 8 bits with the sign, exact. `guard` fraction bits are appended. What Horner's rule
//! makes of a curve's coefficients on the way is within the same: c3 t + c2 is at most 12 (at t =
//! 1, 6), the next a divided difference, at most 6, the last a point of the hull, 1. So registers
//! of W + 8 + guard bits hold everything, with room for the roundings.

use crate::number::{NearestEven, Rounding, RoundingMode, shift_right};
use crate::patch::Point;

/// Bits that the power basis of a surface needs above a coordinate's.
pub const NET_BITS: u32 = 8;

/// A parameter: U1.F and F.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameter {
    pub(super) fx: u64,
    pub(super) bits: u32,
}

/// A cubic's coefficients: of 1, t, t^2, t^3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cubic(pub(super) [Point; 4]);

impl Cubic {
    pub(super) const ZERO: Self = Self([[0; 4]; 4]);

    /// Of control points, exactly.
    pub(super) fn of([p0, p1, p2, p3]: [Point; 4]) -> Self {
        let each = |f: fn([i64; 4]) -> i64| -> Point {
            std::array::from_fn(|k| f([p0[k], p1[k], p2[k], p3[k]]))
        };
        Self([
            p0,
            each(|[a, b, _, _]| 3 * (b - a)),
            each(|[a, b, c, _]| 3 * (a - 2 * b + c)),
            each(|[a, b, c, d]| d - a + 3 * (b - c)),
        ])
    }

    /// The same in ulps of 2^-`guard`.
    pub(super) fn guarded(self, guard: u32) -> Self {
        Self(self.0.map(|point| point.map(|c| c << guard)))
    }

    /// Its value: each product is rounded once, sums are exact. Three multiply-adds a coordinate.
    #[inline(always)]
    pub(super) fn at<R: RoundingMode, const NARROW: bool>(&self, t: Parameter) -> Point {
        let [c0, c1, c2, c3] = &self.0;
        let mut point = [0; 4];
        // A loop, for closures of array methods are not always inlined.
        for k in 0..4 {
            let second = c2[k] + product::<R, NARROW>(c3[k], t);
            let first = c1[k] + product::<R, NARROW>(second, t);
            point[k] = c0[k] + product::<R, NARROW>(first, t);
        }
        point
    }
}

/// `round(c * t)`; both fit 62 bits together where NARROW.
#[inline(always)]
fn product<R: RoundingMode, const NARROW: bool>(c: i64, t: Parameter) -> i64 {
    if NARROW {
        return shift_right::<R>(c * t.fx as i64, t.bits);
    }
    // As `shift_right_wide` has it, in 64 bits: t is at most 1, so that the result fits.
    let exact = i128::from(c) * i128::from(t.fx);
    let (high, low) = ((exact >> 64) as u64, exact as u64);
    let floor = (high << (64 - t.bits) | low >> t.bits) as i64;
    let half = 1 << (t.bits - 1);
    let cut = low & (2 * half - 1);
    let up = match R::MODE {
        Rounding::Floor => false,
        Rounding::NearestUp => cut >= half,
        Rounding::NearestEven => cut + (floor as u64 & 1) > half,
        Rounding::NearestAway => cut >= half + u64::from(c < 0),
    };
    floor + i64::from(up)
}

/// `[N][B][M]^T` of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Net {
    /// By power of u: the polynomial in v that is its coefficient.
    by_u: [Cubic; 4],
}

impl Net {
    pub(super) const ZERO: Self = Self { by_u: [Cubic::ZERO; 4] };

    /// Of control points, exactly, then with guard bits.
    pub(super) fn of(points: &[Point; 16], guard: u32) -> Self {
        let rows = [0, 4, 8, 12]
            .map(|k| Cubic::of([points[k], points[k + 1], points[k + 2], points[k + 3]]));
        let column = |power: usize| Cubic::of(rows.map(|row| row.0[power])).guarded(guard);
        Self { by_u: [0, 1, 2, 3].map(column) }
    }

    /// The curve of constant v.
    #[inline(always)]
    pub(super) fn row<R: RoundingMode, const NARROW: bool>(&self, v: Parameter) -> Cubic {
        let [a, b, c, d] = &self.by_u;
        let at = |curve: &Cubic| curve.at::<R, NARROW>(v);
        Cubic([at(a), at(b), at(c), at(d)])
    }
}

/// The power basis of a surface in registers of W + [`NET_BITS`] + guard bits, by itself: to be
/// compared with other evaluators. What is sampled of it is rounded to nearest even throughout, and
/// not fitted to a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PowerBasis {
    net: Net,
    guard: u32,
    parameter_bits: u32,
}

impl PowerBasis {
    /// Of control points of W bits, where W + [`NET_BITS`] + `guard` is at most 63.
    #[must_use]
    pub fn of(points: &[Point; 16], guard: u32, parameter_bits: u32) -> Self {
        Self { net: Net::of(points, guard), guard, parameter_bits }
    }

    /// The surface's point at u and v, fractions of `parameter_bits` bits, 0 to 1.
    #[must_use]
    pub fn at(&self, [u, v]: [u64; 2]) -> Point {
        let parameter = |fx| Parameter { fx, bits: self.parameter_bits };
        let row = self.net.row::<NearestEven, false>(parameter(v));
        let register = row.at::<NearestEven, false>(parameter(u));
        register.map(|c| shift_right::<NearestEven>(c, self.guard))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{Floor, NearestAway, NearestEven, NearestUp, shift_right_wide};
    use proptest::prelude::*;

    fn same<R: RoundingMode>(c: i64, t: Parameter) {
        let exact = shift_right_wide::<R>(i128::from(c) * i128::from(t.fx), t.bits) as i64;
        assert_eq!(product::<R, false>(c, t), exact, "{c} {t:?} {:?}", R::MODE);
        if (i128::from(c) * i128::from(t.fx)) >> 61 == i128::from(c >> 63) {
            assert_eq!(product::<R, true>(c, t), exact, "{c} {t:?} {:?}", R::MODE);
        }
    }

    fn all_same(c: i64, t: Parameter) {
        same::<Floor>(c, t);
        same::<NearestUp>(c, t);
        same::<NearestEven>(c, t);
        same::<NearestAway>(c, t);
    }

    /// By definition, exact: sum of P_ij N_i(v) N_j(u) over the power basis.
    fn coefficient(points: &[Point; 16], a: usize, b: usize, axis: usize) -> i64 {
        const N: [[i64; 4]; 4] = [[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]];
        (0..16).map(|k| N[a][k % 4] * N[b][k / 4] * points[k][axis]).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn a_product_is_rounded_as_the_wide_one(
            c in -(1_i64 << 62)..1 << 62, shift in 0u32..60, bits in 16u32..=46, fx: u64,
            tie: bool,
        ) {
            let fx = if tie { 1 << (bits - 1) } else { fx & ((1 << bits) - 1) };
            all_same(c >> shift, Parameter { fx, bits });
            all_same(c >> shift, Parameter { fx: 1 << bits, bits });
        }

        #[test]
        fn the_net_is_exact_and_fits_eight_bits_more(
            raw in proptest::array::uniform32(-(1_i64 << 47) + 1..1_i64 << 47), width in 8u32..=48,
            extreme: u16,
        ) {
            let max = (1_i64 << (width - 1)) - 1;
            let points: [Point; 16] = std::array::from_fn(|k| {
                let end = if extreme >> k & 1 == 1 { max } else { -max };
                [raw[k] >> (48 - width), raw[k + 16] >> (48 - width), end, 1]
            });
            let guard = (63 - NET_BITS - width).min(20);
            let net = Net::of(&points, guard);
            for (a, curve) in net.by_u.iter().enumerate() {
                for (b, got) in curve.0.iter().enumerate() {
                    for (axis, c) in got.iter().enumerate() {
                        let exact = coefficient(&points, a, b, axis);
                        prop_assert_eq!(*c, exact << guard);
                        prop_assert!(exact.abs() < 1 << (width + NET_BITS - 1));
                    }
                }
            }
        }
    }

    /// The checkerboard of extremes reaches 144 * 2^(W-1), so seven bits more would not do.
    #[test]
    fn a_coefficient_needs_the_eighth_bit() {
        let sign = |k: usize| [1, -1, 1, 1][k % 4] * [1, -1, 1, 1][k / 4];
        let max = (1 << 31) - 1;
        let points = std::array::from_fn(|k| [sign(k) * max; 4]);
        let largest = Net::of(&points, 0).by_u[2].0[2][0];
        assert_eq!(largest, 144 * max);
        assert!(largest > 1 << (32 + NET_BITS - 2));
    }
}
