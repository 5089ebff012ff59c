//! Fixed-point numbers whose format is chosen at run time.

mod format;

pub use format::{Format, Overflow, Rounding};
