//! The tokens that flow: points, patches, levels, vertices and triangles.
//!
//! A patch is bicubic: 16 points, row-major, point `4i + j`; `u` runs along `j`, `v` along `i`.
//!
//! ```text
//!      v1 (row 3)              edge   points              corners in order
//!   P12─13──14──15             v0     0  1  2  3          P0 P3 P12 P15
//!    │           │             u1     3  7 11 15
//! u0 8   9  10  11 u1          v1    12 13 14 15
//!    │           │             u0     0  4  8 12
//!    4   5   6   7
//!    │           │             Every edge is listed in the direction of the growing parameter.
//!    0───1───2───3
//!      v0 (row 0)
//! ```

mod dyadic;

use crate::number::Format;

pub use dyadic::{DEPTH_MAX, Dyadic, Lists};

/// A homogeneous point `[x, y, z, w]`: raw integers in the frame's position format.
pub type Point = [i64; 4];

/// The control points of each edge, in the order v0, u1, v1, u0, each along its growing parameter.
pub const EDGES: [[usize; 4]; 4] = [[0, 1, 2, 3], [3, 7, 11, 15], [12, 13, 14, 15], [0, 4, 8, 12]];

/// The parameter 1 in U1.16.
pub const ONE: u32 = 1 << 16;

/// The parameter 1/2 in U1.16.
pub const HALF: u32 = ONE / 2;

/// Which side of a clip volume's depth range is `z = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Depth {
    /// Visible points have `0 <= z <= w` (Direct3D, Vulkan, WebGPU).
    #[default]
    ZeroToOne,
    /// Visible points have `-w <= z <= w` (OpenGL).
    MinusOneToOne,
}

/// What every block needs to know of the frame. Constant from the frame's first point to its last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// The format of every position.
    pub position: Format,
    /// Width and height in pixels, 1..=16384.
    pub viewport: [u32; 2],
    /// The depth range of clip space.
    pub depth: Depth,
    /// Points whose raw `w` is below this are too near to be projected (position format).
    pub near: i64,
    /// +1 where a positive `det[S, Su, Sv]` over the rows x, y, w faces the viewer, -1 where a
    /// negative one does.
    pub facing: i64,
}

/// Sixteen control points and what the draw says of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Number within the frame, before culling, in draw order.
    pub id: u32,
    /// Control points, row-major.
    pub points: [Point; 16],
    /// Whether the port saturated one of the 16 points.
    pub saturated: bool,
    /// Whether back-facing patches of this draw may be removed.
    pub cull: bool,
    /// `"front":"reversed"`: the side where `Su x Sv` points is the back.
    pub reversed: bool,
}

/// A tessellation level: segments per whole edge, UQ8.16, from 1 to 128.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Level(u32);

impl Level {
    /// One segment.
    pub const MIN: Self = Self(ONE);
    /// Two segments.
    pub const TWO: Self = Self(2 * ONE);
    /// 128 segments.
    pub const MAX: Self = Self(128 * ONE);

    /// The level of the UQ8.16 integer `fx16`, clamped to 1..=128.
    #[must_use]
    pub fn clamped(fx16: u64) -> Self {
        Self(fx16.clamp(u64::from(Self::MIN.0), u64::from(Self::MAX.0)) as u32)
    }

    /// The UQ8.16 integer.
    #[must_use]
    pub const fn fx16(self) -> u32 {
        self.0
    }
}

/// What the level block decides for a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// Levels of the edges v0, u1, v1, u0. Each is a function of that edge's own four points only.
    pub edges: [Level; 4],
    /// Levels of the interior along u and along v.
    pub interior: [Level; 2],
}

/// A tessellated vertex: its position and its parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vertex {
    /// Homogeneous position in the frame's position format.
    pub position: Point,
    /// `u` in U1.16.
    pub u: u32,
    /// `v` in U1.16.
    pub v: u32,
}

/// Three vertices by their number within the patch, counter-clockwise with u right and v up.
pub type Triangle = [u16; 3];
