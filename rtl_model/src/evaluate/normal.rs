//! The tangent plane at a vertex, from which a shader takes its normal.
//!
//! A unit that works in clip space cannot cross Su with Sv: lengths mean nothing there. The plane
//! through S, Su and Sv does survive the transform: with `M` the matrix from world to clip space,
//! the world normal is the first three components of `M^T plane`. Its coefficients are the four 3 x
//! 3 minors of (S, Su, Sv), with the signs that make `plane . p` = det[p, S, Su, Sv].

use super::casteljau;
use crate::number::{NearestEven, Wide, shift_right_wide};
use crate::patch::{Patch, Point};
use ethnum::I256;

/// Bits, with the sign, of a coefficient: a block-floating plane, only its direction matters.
const COEFFICIENT_BITS: u32 = 32;

/// A tangent plane; all 0 where Su and Sv do not span one (a collapsed edge, a cusp).
pub type Plane = [i64; 4];

/// The tangent plane of the patch at (u, v), both U1.16.
///
/// S, Su, Sv are de Casteljau points rounded to nearest even in the position format. 3 W + 5 bits,
/// 256 from W = 41 on.
#[must_use]
pub fn tangent_plane(patch: &Patch, u: u32, v: u32) -> Plane {
    let p = &patch.points;
    let triangle = casteljau::triangle::<NearestEven>;
    let minus = |a: Point, b: Point| -> Point { std::array::from_fn(|i| a[i] - b[i]) };
    let rows = [0, 4, 8, 12].map(|k| triangle(&[p[k], p[k + 1], p[k + 2], p[k + 3]], u));
    let columns = [0, 1, 2, 3].map(|k| triangle(&[p[k], p[k + 4], p[k + 8], p[k + 12]], v));
    let [along_v_0, along_v_1, s] = triangle(&rows.map(|row| row[2]), v);
    let [along_u_0, along_u_1, _] = triangle(&columns.map(|column| column[2]), u);
    let (su, sv) = (minus(along_u_1, along_u_0), minus(along_v_1, along_v_0));
    let wide = [s, su, sv].iter().flatten().any(|c| c.unsigned_abs() >= 1 << 40);
    if wide { minors::<I256>(s, su, sv) } else { minors::<i128>(s, su, sv) }
}

/// A wide integer that can be shifted down to a coefficient.
trait Coefficient: Wide {
    fn bits(self) -> u32;
    fn shifted(self, down: u32) -> i64;
}

impl Coefficient for i128 {
    fn bits(self) -> u32 {
        Self::BITS - self.unsigned_abs().leading_zeros()
    }

    fn shifted(self, down: u32) -> i64 {
        shift_right_wide::<NearestEven>(self, down) as i64
    }
}

impl Coefficient for I256 {
    fn bits(self) -> u32 {
        Self::BITS - self.unsigned_abs().leading_zeros()
    }

    fn shifted(self, down: u32) -> i64 {
        // To 96 bits exactly enough: what is cut off is below the rounding of any tie that matters
        // to a direction.
        let coarse = down.saturating_sub(64);
        ((self >> coarse).as_i128()).shifted(down - coarse)
    }
}

fn minors<T: Coefficient>(s: Point, su: Point, sv: Point) -> Plane {
    let [s, su, sv] = [s, su, sv].map(|p| p.map(T::of));
    let minor = |i: usize, j: usize, k: usize| {
        s[i] * (su[j] * sv[k] - su[k] * sv[j])
            + s[j] * (su[k] * sv[i] - su[i] * sv[k])
            + s[k] * (su[i] * sv[j] - su[j] * sv[i])
    };
    let zero = T::default();
    let exact = [minor(1, 2, 3), zero - minor(0, 2, 3), minor(0, 1, 3), zero - minor(0, 1, 2)];
    let bits = exact.iter().map(|c| c.bits()).max().unwrap_or(0);
    let down = bits.saturating_sub(COEFFICIENT_BITS - 1);
    exact.map(|c| c.shifted(down))
}
