//! Rounding and overflow: modes as data, and the same modes as types.

use serde::{Deserialize, Serialize};

/// How a value between two representable ones is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rounding {
    /// Towards minus infinity ("truncate").
    Floor,
    /// To nearest, ties towards plus infinity ("half up").
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
    /// The nearest end of the symmetric range +-(2^(width-1) - 1), so that fitting is odd and
    /// monotone.
    Saturate,
}

impl Rounding {
    /// Every mode.
    pub const ALL: [Self; 4] = [Self::Floor, Self::NearestUp, Self::NearestEven, Self::NearestAway];
}

impl Overflow {
    /// Every mode.
    pub const ALL: [Self; 2] = [Self::Wrap, Self::Saturate];
}

/// A [`Rounding`] known at compile time.
pub trait RoundingMode {
    /// The mode.
    const MODE: Rounding;
}

/// An [`Overflow`] known at compile time.
pub trait OverflowMode {
    /// The mode.
    const MODE: Overflow;
}

/// [`Rounding::Floor`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Floor;
/// [`Rounding::NearestUp`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct NearestUp;
/// [`Rounding::NearestEven`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct NearestEven;
/// [`Rounding::NearestAway`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct NearestAway;
/// [`Overflow::Wrap`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Wrap;
/// [`Overflow::Saturate`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Saturate;

impl RoundingMode for Floor {
    const MODE: Rounding = Rounding::Floor;
}
impl RoundingMode for NearestUp {
    const MODE: Rounding = Rounding::NearestUp;
}
impl RoundingMode for NearestEven {
    const MODE: Rounding = Rounding::NearestEven;
}
impl RoundingMode for NearestAway {
    const MODE: Rounding = Rounding::NearestAway;
}
impl OverflowMode for Wrap {
    const MODE: Overflow = Overflow::Wrap;
}
impl OverflowMode for Saturate {
    const MODE: Overflow = Overflow::Saturate;
}

/// Work that wants its modes as types.
pub trait Modal {
    /// What it returns.
    type Output;

    /// The work.
    fn run<R: RoundingMode, O: OverflowMode>(self) -> Self::Output;
}

/// Runs `work` with the modes as types: one match a patch instead of one an operation.
pub fn dispatch<M: Modal>(rounding: Rounding, overflow: Overflow, work: M) -> M::Output {
    match overflow {
        Overflow::Wrap => dispatch_rounding::<M, Wrap>(rounding, work),
        Overflow::Saturate => dispatch_rounding::<M, Saturate>(rounding, work),
    }
}

fn dispatch_rounding<M: Modal, O: OverflowMode>(rounding: Rounding, work: M) -> M::Output {
    match rounding {
        Rounding::Floor => work.run::<Floor, O>(),
        Rounding::NearestUp => work.run::<NearestUp, O>(),
        Rounding::NearestEven => work.run::<NearestEven, O>(),
        Rounding::NearestAway => work.run::<NearestAway, O>(),
    }
}
