//! Budgets: bounds of an error by the roundings that make it.

use super::At;
use rtl_model::number::Rounding;

/// Half an ulp, or a whole one for a floor.
pub(crate) fn rounding(at: &At) -> f64 {
    if at.rounding == Rounding::Floor { 1.0 } else { 0.5 }
}

/// What f64 itself is off by: sixteen terms of a coordinate's size.
pub(crate) fn reference(at: &At) -> f64 {
    16.0 * 2f64.powi(at.width as i32 - 1 - 53)
}

/// The accumulator after n steps: D1, D2, D3 each off by half an ulp of 2^-guard, and h^3
/// truncated to 2^-64 under |a| <= 8 * 2^(W-1).
pub(crate) fn accumulator(at: &At, n: u32) -> f64 {
    let n = f64::from(n);
    let coefficients = (n + n * (n - 1.0) / 2.0 + n * (n - 1.0) * (n - 2.0) / 6.0) / 2.0;
    coefficients * 2f64.powi(-(at.guard as i32)) + n.powi(3) * 2f64.powi(at.width as i32 + 2 - 64)
}

pub(crate) fn forward_curve(at: &At) -> f64 {
    rounding(at) + accumulator(at, at.steps[0]) + reference(at)
}

pub(crate) fn forward_surface(at: &At) -> f64 {
    2.0 * rounding(at) + accumulator(at, at.steps[0]) + accumulator(at, at.steps[1]) + reference(at)
}

/// Whether accumulators may be off by more than the output's rounding.
pub(crate) fn drifts(at: &At) -> bool {
    accumulator(at, at.steps[0]) + accumulator(at, at.steps[1]) > 2.0 * rounding(at)
}

pub(crate) fn casteljau_curve(at: &At) -> f64 {
    3.0 * rounding(at) + reference(at)
}

pub(crate) fn casteljau_surface(at: &At) -> f64 {
    6.0 * rounding(at) + reference(at)
}

/// Weighted sums along u and along v: `spread` is what a weight's ulp makes of the largest point.
pub(crate) fn weighted(at: &At) -> f64 {
    rounding(at) * (24.0 * at.spread + 8.0) + reference(at)
}

/// Whether the weights' roundings count for more than those of products.
pub(crate) fn weights_matter(at: &At) -> bool {
    24.0 * at.spread > 8.0
}

/// A product's rounding, in ulps of the output.
pub(crate) fn guarded(at: &At) -> f64 {
    rounding(at) * 2f64.powi(-(at.guard as i32))
}

/// Horner's rule at t <= 1/2: three products, of which two are multiplied by t and t^2.
pub(crate) fn half_run(at: &At) -> f64 {
    rounding(at) + 1.75 * guarded(at) + at.spread + reference(at)
}

/// Horner's rule along v for four coefficients, then along u.
pub(crate) fn horner(at: &At) -> f64 {
    rounding(at) + 15.0 * guarded(at) + at.spread + reference(at)
}

/// Whether the products' roundings count for more than the output's.
pub(crate) fn guard_matters(at: &At) -> bool {
    15.0 * guarded(at) > rounding(at)
}

/// Whether the parameters' roundings count for more than the others.
pub(crate) fn parameter_matters(at: &At) -> bool {
    at.spread > rounding(at) + 15.0 * guarded(at) + reference(at)
}
