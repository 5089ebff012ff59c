//! Domain: control points and a domain point in, the point of the patch out, in f64, by
//! de Casteljau; and the magnitudes that rounding errors are relative to.
//!
//! The shader sums Bernstein polynomials, or powers; here there are only interpolations. Magnitudes
//! are sums of products as the paper writes them (004, Eq. 5 and 7), each with its sign dropped.

use super::{Real, evaluate};

/// `[N]` of Concheiro et al. 2014, Equation 4, from u^3 down to 1.
const N: [[f64; 4]; 4] =
    [[-1.0, 3.0, -3.0, 1.0], [3.0, -6.0, 3.0, 0.0], [-3.0, 3.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]];

/// The point at (u, v) of a patch in row-major order, u along the rows.
#[must_use]
pub fn point(points: &[Real; 16], u: f64, v: f64) -> Real {
    let column = |j: usize| curve(&[points[j], points[4 + j], points[8 + j], points[12 + j]], v);
    curve(&[column(0), column(1), column(2), column(3)], u)
}

/// The point of a cubic at `t`.
#[must_use]
pub fn curve(points: &[Real; 4], t: f64) -> Real {
    let mut level = *points;
    for n in (1..4).rev() {
        for k in 0..n {
            level[k] = std::array::from_fn(|c| level[k][c] * (1.0 - t) + level[k + 1][c] * t);
        }
    }
    level[0]
}

/// The sum of the magnitudes of B_i(v) B_j(u) P_ij.
#[must_use]
pub fn magnitude(points: &[Real; 16], u: f64, v: f64) -> Real {
    evaluate::surface(&points.map(|p| p.map(f64::abs)), u, v)
}

/// The sum of the magnitudes of all products in `[U][N][B][M]^T[V]`.
#[must_use]
pub fn power_magnitude(points: &[Real; 16], u: f64, v: f64) -> Real {
    let weight = |t: f64, j: usize| -> f64 {
        (0..4).map(|row| t.powi(3 - row) * N[row as usize][j].abs()).sum()
    };
    let term = |k: usize, axis: usize| weight(v, k / 4) * weight(u, k % 4) * points[k][axis].abs();
    std::array::from_fn(|axis| (0..16).map(|k| term(k, axis)).sum())
}
