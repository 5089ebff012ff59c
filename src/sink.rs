//! Where triangles go: the interface between the units and whoever consumes their meshes. A leaf.

use crate::attribute::Attribute;
use crate::error::Result;
use rtl_model::emit::Screen;
use rtl_model::patch::{Triangle, Vertex, View};

/// A frame whose meshes follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameInfo {
    /// Number from 0.
    pub number: u64,
    /// Format of the mesh's positions, viewport, depth range.
    pub view: View,
    /// What the parameters of its vertices stand for.
    pub grid: Grid,
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
