//! Datapath: the operations that an evaluation is made of, in f32 and in fixed point. Each rounds
//! once; products are commutative in both, which is all that order-invariance needs.

use glam::Vec4;
use rtl_model::number::{RoundingMode, shift_right, shift_right_wide};
use rtl_model::patch::Point;
use std::marker::PhantomData;

/// Arithmetic on weights (scalars of 0..=1) and on values (homogeneous points).
pub(in crate::shader) trait Datapath: Copy {
    /// A parameter or a polynomial of it.
    type Weight: Copy;
    /// A point, a sum of points or a coefficient.
    type Value: Copy;

    /// The parameter `t`, U1.16 of 0..=65536: exact.
    fn parameter(self, t: u32) -> Self::Weight;

    /// a b
    fn product(self, a: Self::Weight, b: Self::Weight) -> Self::Weight;

    /// 3 a
    fn thrice(self, a: Self::Weight) -> Self::Weight;

    /// a p
    fn scale(self, a: Self::Weight, p: Self::Value) -> Self::Value;

    /// 3 p
    fn triple(self, p: Self::Value) -> Self::Value;

    /// p + q
    fn sum(self, p: Self::Value, q: Self::Value) -> Self::Value;

    /// p - q
    fn difference(self, p: Self::Value, q: Self::Value) -> Self::Value;
}

/// Singles, rounded to nearest even; a product and a sum are never fused.
#[derive(Clone, Copy, Debug)]
pub(in crate::shader) struct Singles;

impl Datapath for Singles {
    type Weight = f32;
    type Value = Vec4;

    #[inline(always)]
    fn parameter(self, t: u32) -> f32 {
        t as f32 / 65536.0 // 17 bits of 24
    }

    #[inline(always)]
    fn product(self, a: f32, b: f32) -> f32 {
        a * b
    }

    #[inline(always)]
    fn thrice(self, a: f32) -> f32 {
        3.0 * a
    }

    #[inline(always)]
    fn scale(self, a: f32, p: Vec4) -> Vec4 {
        p * a
    }

    #[inline(always)]
    fn triple(self, p: Vec4) -> Vec4 {
        p * 3.0
    }

    #[inline(always)]
    fn sum(self, p: Vec4, q: Vec4) -> Vec4 {
        p + q
    }

    #[inline(always)]
    fn difference(self, p: Vec4, q: Vec4) -> Vec4 {
        p - q
    }
}

/// Integers: weights with `bits` fraction bits, values in ulps of the position format. Products are
/// rounded by `R`; sums, and products by 3, are exact. `WIDE`: products with values may need more
/// than 62 bits.
#[derive(Debug)]
pub(super) struct Integers<R, const WIDE: bool> {
    bits: u32,
    mode: PhantomData<R>,
}

// Derived, both would ask it of the mode.
impl<R, const WIDE: bool> Clone for Integers<R, WIDE> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R, const WIDE: bool> Copy for Integers<R, WIDE> {}

impl<R, const WIDE: bool> Integers<R, WIDE> {
    /// With weights of `bits` fraction bits, 16..=30: below, u would not be exact; above, a product
    /// of two weights would not fit.
    pub(super) fn new(bits: u32) -> Self {
        Self { bits, mode: PhantomData }
    }
}

/// A coordinate at a time.
#[inline(always)]
fn each(p: Point, q: Point, f: impl Fn(i64, i64) -> i64) -> Point {
    std::array::from_fn(|k| f(p[k], q[k]))
}

impl<R: RoundingMode, const WIDE: bool> Datapath for Integers<R, WIDE> {
    type Weight = i64;
    type Value = Point;

    #[inline(always)]
    fn parameter(self, t: u32) -> i64 {
        i64::from(t) << (self.bits - 16)
    }

    #[inline(always)]
    fn product(self, a: i64, b: i64) -> i64 {
        shift_right::<R>(a * b, self.bits) // at most 2^60 before the shift
    }

    #[inline(always)]
    fn thrice(self, a: i64) -> i64 {
        3 * a
    }

    #[inline(always)]
    fn scale(self, a: i64, p: Point) -> Point {
        p.map(|c| {
            if WIDE {
                shift_right_wide::<R>(i128::from(a) * i128::from(c), self.bits) as i64
            } else {
                shift_right::<R>(a * c, self.bits)
            }
        })
    }

    #[inline(always)]
    fn triple(self, p: Point) -> Point {
        p.map(|c| 3 * c)
    }

    #[inline(always)]
    fn sum(self, p: Point, q: Point) -> Point {
        each(p, q, |a, b| a + b)
    }

    #[inline(always)]
    fn difference(self, p: Point, q: Point) -> Point {
        each(p, q, |a, b| a - b)
    }
}
