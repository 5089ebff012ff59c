//! Evaluate: control points and a parameter in, the point of the curve or surface out, and its
//! tangents.
//!
//! The definition: S(u,v) = sum P_ij B_i(v) B_j(u) with the Bernstein polynomials of degree 3,
//! summed in f64. Forward differences are to be compared at their exact parameter t = k R / 2^32,
//! de Casteljau at the reported U1.16 one.

use super::Real;

/// The four cubic Bernstein polynomials.
#[must_use]
pub fn basis(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t]
}

/// Their derivatives.
#[must_use]
pub fn basis_derivative(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

/// The point of a cubic at `t`.
#[must_use]
pub fn curve(points: &[Real; 4], t: f64) -> Real {
    let b = basis(t);
    std::array::from_fn(|axis| (0..4).map(|i| b[i] * points[i][axis]).sum())
}

/// The point of a bicubic.
#[must_use]
pub fn surface(points: &[Real; 16], u: f64, v: f64) -> Real {
    weighted(points, &basis(u), &basis(v))
}

/// Su and Sv of a bicubic.
#[must_use]
pub fn derivatives(points: &[Real; 16], u: f64, v: f64) -> [Real; 2] {
    [
        weighted(points, &basis_derivative(u), &basis(v)),
        weighted(points, &basis(u), &basis_derivative(v)),
    ]
}

fn weighted(points: &[Real; 16], bu: &[f64; 4], bv: &[f64; 4]) -> Real {
    std::array::from_fn(|axis| (0..16).map(|k| bv[k / 4] * bu[k % 4] * points[k][axis]).sum())
}

/// Su x Sv of a polynomial surface: x, y, z of points whose w is 1. Not normalised.
#[must_use]
pub fn normal(points: &[Real; 16], u: f64, v: f64) -> [f64; 3] {
    let [a, b] = derivatives(points, u, v);
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
