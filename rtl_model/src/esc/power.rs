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

use crate::number::{RoundingMode, shift_right, shift_right_wide};
use crate::patch::Point;

/// Bits that the power basis of a surface needs above a coordinate's.
pub(super) const NET_BITS: u32 = 8;

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
        std::array::from_fn(|k| {
            let second = c2[k] + product::<R, NARROW>(c3[k], t);
            let first = c1[k] + product::<R, NARROW>(second, t);
            c0[k] + product::<R, NARROW>(first, t)
        })
    }
}

/// `round(c * t)`; both fit 62 bits together where NARROW.
#[inline(always)]
fn product<R: RoundingMode, const NARROW: bool>(c: i64, t: Parameter) -> i64 {
    if NARROW {
        shift_right::<R>(c * t.fx as i64, t.bits)
    } else {
        shift_right_wide::<R>(i128::from(c) * i128::from(t.fx), t.bits) as i64
    }
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
        Cubic([0, 1, 2, 3].map(|power: usize| self.by_u[power].at::<R, NARROW>(v)))
    }
}
