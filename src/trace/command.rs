//! The commands of a trace, checked and ready to be carried out: what the readers make and the
//! units consume.
//!
//! Matrices are column-major, points column vectors, clip = projection * view * model * p. Sizes
//! and ids are checked by the reader: a unit may rely on every invariant stated here.

use rtl_model::level::{Criterion, State};
use rtl_model::patch::{Depth, Level};
use std::sync::Arc;

use super::indices::Indices;
use super::points::PointSource;
use crate::attribute::AttributeTable;

pub use rtl_model::assemble::{FanEncoding, Primitive};

/// One command.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// The first command of every trace.
    Header(Header),
    /// Begins a frame.
    Frame(Frame),
    /// Defines or replaces the points of an id.
    Points(Points),
    /// Defines or replaces the attributes of an id.
    Attributes(Attributes),
    /// Sets the tessellation state of the draws that follow.
    Tessellation(Tessellation),
    /// Draws surfaces.
    Draw(Draw),
    /// The last command.
    End,
}

/// What the trace says of itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// Title, possibly empty.
    pub title: String,
    /// Where the data come from, possibly empty.
    pub source: String,
    /// The licence of the data, possibly empty.
    pub licence: String,
}

/// The camera of a frame. View and projection are finite and invertible.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Width and height in pixels, each 1..=16384.
    pub viewport: [u32; 2],
    /// World to eye, column-major.
    pub view: [f32; 16],
    /// Eye to clip, column-major.
    pub projection: [f32; 16],
    /// The depth range of clip space.
    pub depth: Depth,
    /// Powers of two that the port scales by, where the trace gives them.
    pub range: Range,
}

/// The largest magnitude a coordinate is expected to have: powers of two, or `None` where it is to
/// be derived.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// In clip space: log2.
    pub clip: Option<i32>,
    /// In object space: log2.
    pub object: Option<i32>,
}

/// Points under an id.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// The id that draws name.
    pub id: u32,
    /// The points. Cheap to clone.
    pub source: Arc<PointSource>,
    /// Crosses the link once; every draw reads it from device memory.
    pub resident: bool,
}

/// Attributes under an id: values at the corners of patches.
#[derive(Clone, Debug, PartialEq)]
pub struct Attributes {
    /// The id that draws name; those of points are others.
    pub id: u32,
    /// What a corner has and its values. Cheap to clone.
    pub table: Arc<AttributeTable>,
    /// Crosses the link once; every draw reads it from device memory.
    pub resident: bool,
}

/// Tessellation state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tessellation {
    /// How levels are chosen, its numbers already quantised as the level block takes them.
    pub criterion: Criterion,
    /// Least level, UQ8.16.
    pub min_level: u32,
    /// Greatest level, UQ8.16.
    pub max_level: u32,
}

impl Tessellation {
    /// The state that the command sets.
    #[must_use]
    pub fn state(&self) -> State {
        let [min, max] = [self.min_level, self.max_level].map(|fx16| Level::clamped(fx16.into()));
        State { criterion: self.criterion, min, max }
    }
}

impl Default for Tessellation {
    /// What holds before the first tessellation command: flatness within half a pixel, levels from
    /// 1 to 64.
    fn default() -> Self {
        let criterion = Criterion::Flatness { pixels: 1 << 15 };
        Self { criterion, min_level: 1 << 16, max_level: 64 << 16 }
    }
}

/// The matrix that changes nothing.
pub const IDENTITY: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

/// A draw of surfaces that share their state.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// What the points mean.
    pub primitive: Primitive,
    /// The id of the points.
    pub points: u32,
    /// Index of the first point used.
    pub first: u64,
    /// Which points and corners each patch has, where the primitive is indexed, and only there.
    pub indices: Option<Arc<Indices>>,
    /// The id of the attributes of its corners, from the first one on.
    pub attributes: Option<u32>,
    /// Object to world, one for each instance; one identity when the trace gives none.
    pub models: Vec<[f32; 16]>,
    /// Whether `model` or `instances` was given, and so crosses the link.
    pub models_sent: bool,
    /// `"front":"reversed"`.
    pub reversed: bool,
    /// Back-facing patches may be removed (default true).
    pub cull: bool,
}

impl Draw {
    /// A draw of the points under an id, from the first on, with everything else as a trace leaves
    /// it: no model, the front where the normal points, back-facing patches removed.
    #[must_use]
    pub fn new(primitive: Primitive, points: u32) -> Self {
        Self {
            primitive,
            points,
            first: 0,
            indices: None,
            attributes: None,
            models: vec![IDENTITY],
            models_sent: false,
            reversed: false,
            cull: true,
        }
    }
}
