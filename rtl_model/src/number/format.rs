//! A fixed-point format is a value: a width, a number of fraction bits. Rounding and overflow are named modes.

use serde::{Deserialize, Serialize};

/// How a value between two representable ones is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rounding {
    /// Towards minus infinity ("truncate").
    Floor,
    /// To nearest, ties towards plus infinity.
    NearestUp,
    /// To nearest, ties to the even integer.
    NearestEven,
    /// To nearest, ties away from zero.
    NearestAway,
}

/// What becomes of a value that does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Overflow {
    /// The low bits are kept, as two's complement.
    Wrap,
    /// The nearest of the two ends of the symmetric range +-(2^(width-1) - 1).
    Saturate,
}

/// A signed fixed-point format: `width` bits in all, of which `fraction` stand behind the binary point. `fraction` may
/// be negative or exceed `width`: the point then lies outside the bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Format {
    /// Bits in all, with the sign: 2..=48.
    pub width: u32,
    /// Bits behind the binary point.
    pub fraction: i32,
}
