//! Where triangles go: the interface between the units and whoever consumes their meshes. A leaf.

use crate::attribute::Attribute;
use crate::error::Result;
use rtl_model::emit::Screen;
use rtl_model::level::State;
use rtl_model::number::Format;
use rtl_model::patch::{Patch, Point, Triangle, Vertex, View};

/// A frame whose meshes follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameInfo {
    /// Number from 0.
    pub number: u64,
    /// Format of the mesh's positions, viewport, depth range.
    pub view: View,
    /// What the parameters of its vertices stand for.
    pub grid: Grid,
    /// The camera, with the format of clip space: that of `view`, but in a unit that works in
    /// object space.
    pub eye: View,
    /// The format of object space.
    pub object: Format,
    /// The near threshold as a shader or the driver has it.
    pub near: f32,
}

/// What parameters in U1.16 stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grid {
    /// Themselves.
    Fx16,
    /// Fractions of at most 48 parts: each the one that is nearest (unit `esc`, whose grid is
    /// thirds).
    Thirds,
}

/// A patch after the port, as a unit's blocks are given it.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrived {
    /// What the unit works on.
    pub patch: Patch,
    /// What levels are chosen from, where that is another space's.
    pub seen: Option<Patch>,
    /// Its control points in clip space as the shaders have them; all 0 in units that do not go on
    /// in f32.
    pub shaded: [[f32; 4]; 16],
    /// Its control points in object space, where the unit has them beside those in clip space.
    pub object: Option<[Point; 16]>,
    /// The level of resolution that the driver chose for all of its draw (unit `esc`).
    pub object_level: Option<u8>,
    /// The tessellation state of its draw.
    pub state: State,
    /// Components of the attributes of a vertex.
    pub components: u32,
    /// Bytes that a hull shader hands on for it.
    pub hull_bytes: u32,
}

/// What a unit made of one patch.
#[derive(Clone, Copy, Debug)]
pub struct PatchMesh<'a> {
    /// Number of the patch within its frame, before culling, in draw order.
    pub patch: u32,
    /// `"front":"reversed"`: the side where `Su x Sv` points is the back.
    pub reversed: bool,
    /// Vertices: boundary counter-clockwise from (0, 0), then the interior row by row; in unit
    /// `d3d11` in the order of its tessellator, in `esc` in that of their first use.
    pub vertices: &'a [Vertex],
    /// Their screen positions, one each; empty when `emit.divide` is off.
    pub screen: &'a [Screen],
    /// Triangles over `vertices`.
    pub triangles: &'a [Triangle],
    /// Takes a position of the mesh, homogeneous and in real units, to world space: column-major.
    pub to_world: &'a [f64; 16],
    /// What each vertex has besides, in order; nothing where the draw has no attributes.
    pub layout: &'a [Attribute],
    /// Components of attributes, vertex after vertex, raw in the configured attribute format.
    pub attributes: &'a [i64],
}

impl Default for PatchMesh<'_> {
    /// No mesh at all, in a world that is its own space.
    fn default() -> Self {
        const SAME: &[f64; 16] = &[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
        Self {
            patch: 0,
            reversed: false,
            vertices: &[],
            screen: &[],
            triangles: &[],
            to_world: SAME,
            layout: &[],
            attributes: &[],
        }
    }
}

/// A consumer of meshes. Patches arrive in draw order, whatever the number of threads.
pub trait Sink {
    /// Whether the meshes of this frame are wanted; those of other frames are not kept.
    fn wants(&self, frame: u64) -> bool;

    /// A wanted frame begins.
    ///
    /// # Errors
    /// The sink's own.
    fn frame(&mut self, frame: &FrameInfo) -> Result<()>;

    /// A patch of the frame that began last. Culled patches do not appear.
    ///
    /// # Errors
    /// The sink's own.
    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()>;

    /// Whether it wants to see the patches themselves, too.
    fn taps(&self) -> bool {
        false
    }

    /// A patch of the frame that began last, whatever becomes of it: before its mesh, and in draw
    /// order.
    ///
    /// # Errors
    /// The sink's own.
    fn arrived(&mut self, _patch: &Arrived) -> Result<()> {
        Ok(())
    }
}

/// Takes no meshes: counters only.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoMesh;

impl Sink for NoMesh {
    fn wants(&self, _frame: u64) -> bool {
        false
    }

    fn frame(&mut self, _frame: &FrameInfo) -> Result<()> {
        Ok(())
    }

    fn patch(&mut self, _mesh: &PatchMesh<'_>) -> Result<()> {
        Ok(())
    }
}
