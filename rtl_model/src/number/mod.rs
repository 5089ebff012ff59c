//! Fixed-point numbers whose format is chosen at run time: `i64` storage, `i128` products, 256 bits
//! for decisions.
//!
//! A value is a raw integer; what it stands for is a [`Format`] that its surroundings know. Every
//! operation computes exactly and then rounds once, by a named [`Rounding`], and fits once, by a
//! named [`Overflow`]. In hot loops both are type parameters ([`dispatch`]), so that the modes cost
//! nothing there; widths stay run-time values.

mod float;
mod format;
mod mode;
mod round;
mod wide;

pub use float::from_f32_bits;
pub use format::Format;
pub use mode::{
    Floor, Modal, NearestAway, NearestEven, NearestUp, Overflow, OverflowMode, Rounding,
    RoundingMode, Saturate, Wrap, dispatch,
};
pub use round::{Divisor, divide, lerp, shift_right, shift_right_wide, sqrt_ceil};
pub use wide::Wide;
