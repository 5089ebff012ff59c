//! Attribute: the values of four corners and parameters in, the value there out: the sum of the
//! corners under their bilinear weights.

/// The value at (u, v) of a component whose corners P0 P3 P12 P15 are given.
#[must_use]
pub fn bilinear(corners: [f64; 4], u: f64, v: f64) -> f64 {
    let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
    corners.iter().zip(weights).map(|(c, w)| c * w).sum()
}
