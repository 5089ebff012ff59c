//! Datapath: the formats that samples are computed in, and how a register becomes a position.

use super::Boundary;
use crate::number::{Format, OverflowMode, RoundingMode, shift_right};
use crate::patch::Point;

/// How samples are computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Datapath {
    pub(super) format: Format,
    pub(super) guard: u32,
    /// Fraction bits of a parameter.
    pub(super) bits: u32,
    pub(super) boundary: Boundary,
}

impl Datapath {
    /// A register without `bits` bits of its fraction, rounded and fitted; and how many coordinates
    /// did not fit.
    #[inline(always)]
    pub(super) fn output<R: RoundingMode, O: OverflowMode>(
        &self,
        register: Point,
        bits: u32,
    ) -> (Point, u64) {
        let (mut point, mut overflows) = (register, 0);
        for c in &mut point {
            let (fitted, overflowed) = self.format.fit::<O>(shift_right::<R>(*c, bits));
            *c = fitted;
            overflows += u64::from(overflowed);
        }
        (point, overflows)
    }
}
