//! The two cones in f64: control points in; by how many radians they are apart, beyond the right
//! angle that removes a patch, out.
//!
//! The normal's coefficients come from the power basis, in 256 bits. The axes are defined as the
//! block's: the sum of all directions, each divided by the power of two that its largest component
//! reaches. Angles are those of arc cosines, unrounded; the block's cones are wider by up to
//! [`ROUNDING`].

use super::{ROWS, add_product, along_u, power, to_bernstein, transposed};
use ethnum::I256;
use rtl_model::patch::Point;

/// Radians that the block's roundings may cost it: cosines in 20 bits from directions in 20 widen a
/// cone by up to 0.004, and an axis in 12 bits, with its components cut off, turns by 0.001 and has
/// its cone wider by as much.
pub const ROUNDING: f64 = 0.012;

/// How far apart the cones are. At 0 or more the patch shows no front, and infinity stands for a
/// patch without area; `None` where a cone has no half-angle below 90 degrees.
#[must_use]
pub fn margin(points: &[Point; 16], front: i64) -> Option<f64> {
    let mirrored = |[x, y, w]: [f64; 3]| [x * front as f64, y, w];
    let directions: Vec<_> =
        points.iter().map(|p| mirrored(ROWS.map(|row| p[row] as f64))).collect();
    // The block multiplies mirrored rows, so that its normals are those of the mirrored surface.
    let turned = |[x, y, w]: [f64; 3]| [x, y * front as f64, w * front as f64];
    let normals: Vec<_> = normals(points).into_iter().map(turned).collect();
    if normals.iter().all(|n| *n == [0.0; 3]) {
        return Some(f64::INFINITY);
    }
    let (a, b) = (axis(&directions), axis(&normals));
    let between = angle(a, b);
    let widest = |axis, all: &[[f64; 3]]| {
        let some = all.iter().filter(|v| **v != [0.0; 3]);
        some.map(|&v| angle(axis, v)).fold(0.0, f64::max)
    };
    let (wide_a, wide_b) = (widest(a, &directions), widest(b, &normals));
    let right = std::f64::consts::FRAC_PI_2;
    (wide_a < right && wide_b < right).then_some(between - wide_a - wide_b - right)
}

/// The 36 Bernstein coefficients of Su x Sv over 9, times C(5,k) C(5,l).
fn normals(points: &[Point; 16]) -> Vec<[f64; 3]> {
    let s = ROWS.map(|row| power(points, row));
    let (su, sv) = (s.map(|p| along_u(&p)), s.map(|p| transposed(&along_u(&transposed(&p)))));
    let components = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let mut minor = [[I256::ZERO; 9]; 9];
        add_product(&mut minor, &su[j], &sv[k], I256::ONE);
        add_product(&mut minor, &su[k], &sv[j], I256::MINUS_ONE);
        let rows = minor.map(|row| to_bernstein(&row, 5));
        transposed(&transposed(&rows).map(|column| to_bernstein(&column, 5)))
    });
    let nine = I256::new(9);
    let at = |k: usize, l: usize| components.map(|c| (c[k][l] / nine).as_f64());
    (0..36).map(|k| at(k / 6, k % 6)).collect()
}

fn axis(directions: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for v in directions.iter().filter(|v| **v != [0.0; 3]) {
        let largest = v.iter().fold(0f64, |m, c| m.max(c.abs()));
        let scale = largest.log2().floor().exp2();
        sum = [0, 1, 2].map(|k| sum[k] + v[k] / scale);
    }
    sum
}

/// From 0 to pi: by the half-angle's tangent, exact where a cosine is not.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let unit = |v: [f64; 3]| v.map(|c| c / length(v));
    let (a, b) = (unit(a), unit(b));
    let [difference, sum] = [-1.0, 1.0].map(|s| length([0, 1, 2].map(|k| a[k] + s * b[k])));
    2.0 * difference.atan2(sum)
}
