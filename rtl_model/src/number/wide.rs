//! Exact products for decisions: the same code on 128 and on 256 bits.

use ethnum::I256;
use std::ops::{Add, Mul, Sub};

/// A signed integer wide enough for a decision to be exact.
pub trait Wide:
    Copy + Ord + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// The integer.
    fn of(value: i64) -> Self;
}

impl Wide for i64 {
    fn of(value: i64) -> Self {
        value
    }
}

impl Wide for i128 {
    fn of(value: i64) -> Self {
        value.into()
    }
}

impl Wide for I256 {
    fn of(value: i64) -> Self {
        value.into()
    }
}
