//! Golden models: what each block is to compute, from its definition and by another algorithm
//! than the hardware's.
//!
//! ```text
//!   control_point  f64 matrix product            level      the bounds, in real pixels
//!   port           rounding of a real number     place      sets of exact fractions
//!   assemble       cells of a lattice, by sets   evaluate   Bernstein sums, cross products
//!   clip           greatest distance to a plane  stitch     midpoints sorted as fractions
//!   backface       power basis, 256 bits         emit       x / w in f64
//!   hull           hats, one denominator         domain     de Casteljau in f64
//!   d3d11          ranks in one order of points, sorted segments
//!   esc            lists of the uniform pattern, rewritten rule by rule; levels as quotients;
//!                  places as fractions of the square, Bernstein sums in f64
//! ```
//!
//! A golden model has the name of its block, `rtl_model/src/NAME.rs`. `tests/agreement` compares
//! the two under one table of error budgets.
//!
//! **Architecture invariant.** Nothing of `rtl_model` is imported but the tokens in `patch`, and
//! the policy enums by way of `config`: a golden model that shared code with its block would
//! agree with its mistakes.

pub mod assemble;
pub mod attribute;
pub mod backface;
pub mod clip;
pub mod control_point;
pub mod d3d11;
pub mod domain;
pub mod emit;
pub mod esc;
pub mod evaluate;
pub mod hull;
pub mod level;
pub mod place;
pub mod port;
pub mod stitch;

use rtl_model::patch::Point;

/// A homogeneous point `[x, y, z, w]` of real coordinates.
pub type Real = [f64; 4];

/// Points in position ulps as reals. Exact, for a position has at most 48 bits.
#[must_use]
pub fn real<const N: usize>(points: &[Point; N]) -> [Real; N] {
    points.map(|p| p.map(|c| c as f64))
}
