//! Control points: object space in, clip space out, in f64. The definition is clip = M p; the
//! shader's f32 and its order of operations are what is to be compared with it.

use super::Real;

/// `m * p`; `m` is column-major.
#[must_use]
pub fn transform(m: &[f64; 16], p: Real) -> Real {
    std::array::from_fn(|row| (0..4).map(|column| m[4 * column + row] * p[column]).sum())
}

/// `a * b`, both column-major.
#[must_use]
pub fn concatenate(a: &[f64; 16], b: &[f64; 16]) -> [f64; 16] {
    let column = |c: usize| transform(a, std::array::from_fn(|row| b[4 * c + row]));
    let columns = [0, 1, 2, 3].map(column);
    std::array::from_fn(|k| columns[k / 4][k % 4])
}

/// The sum of the magnitudes that each coordinate of `m * p` is made of: what its rounding errors
/// are relative to.
#[must_use]
pub fn magnitude(m: &[f64; 16], p: Real) -> Real {
    transform(&m.map(f64::abs), p.map(f64::abs))
}
