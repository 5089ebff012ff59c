//! Closed forms: the bytes of a surface, by the sums of Sfarti et al. 2005, section 6, and not by
//! what the blocks do.
//!
//! With N = m n patches of m rows and n columns, K instances, level L, and bytes G = 12 of a point,
//! A of a corner, V of a vertex, I of an index:
//!
//! ```text
//!                      points                                attributes
//! patches              16 N G                                4 N A
//! strip                (16 + 12 (N-1)) G                     (4 + 2 (N-1)) A
//! fan, compact         (1 + 11 + 8 (N-1)) G                  (1 + 2 + (N-1)) A
//! fan, full            (1 + 12 + 9 (N-1)) G                  (1 + 2 + (N-1)) A
//! mesh                 (16 + 12 (m-1 + n-1)                  (4 + 2 (m-1 + n-1)
//!                         + 9 (m-1) (n-1)) G                    + (m-1) (n-1)) A
//! indexed mesh         as the mesh; indices 16 N I, and 4 N I more with attributes
//!
//!                      vertices                              indices
//! indexed triangles    K N (L+1)^2 V                         K N 6 L^2 I
//! triangle strips      K N 2 L (L+1) V
//! vertices once        K (m L + 1) (n L + 1) V
//! ```
//!
//! Of instances the patches cross once and the vertices K times: they are tessellated for the view.
//! An index has 2 bytes, or 4 where it must tell more than 65536 points, or vertices of the draw.

use super::{Form, Size};

/// Bytes of a point: three floats.
const POINT: u64 = 12;
/// Bytes of a vertex without its corner's: position and normal.
const BARE_VERTEX: u64 = 24;
/// Bytes of a vertex of a surface whose corners have nothing: with texture coordinates.
const VERTEX: u64 = 32;

/// Bytes by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bytes {
    /// Control points.
    pub control_points: u64,
    /// Attributes of corners.
    pub attributes: u64,
    /// Vertices of triangles.
    pub vertices: u64,
    /// Indices, of an indexed mesh or of triangles.
    pub indices: u64,
}

impl Bytes {
    /// Their sum.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.control_points + self.attributes + self.vertices + self.indices
    }
}

/// Bytes of a vertex whose corners have so many.
#[must_use]
pub fn vertex(corner_bytes: u64) -> u64 {
    if corner_bytes == 0 { VERTEX } else { BARE_VERTEX + corner_bytes }
}

/// Bytes of an index that tells so many things apart.
fn index(things: u64) -> u64 {
    if things > 1 << 16 { 4 } else { 2 }
}

/// The bytes of a surface in a form.
#[must_use]
pub fn bytes(form: Form, size: &Size) -> Bytes {
    let (points, corners) = sent(form, size);
    let (control_points, attributes) = (POINT * points, size.corner_bytes * corners);
    let patches = size.patches();
    let vertices = vertices(form, size) * size.instances;
    let indices = match form {
        Form::IndexedMesh => {
            let each = if size.corner_bytes == 0 { 16 } else { 16 + 4 };
            each * patches * index(points)
        }
        Form::IndexedTriangles => 3 * size.triangles() * index(vertices),
        _ => 0,
    };
    Bytes { control_points, attributes, vertices: vertices * vertex(size.corner_bytes), indices }
}

/// Points and corners.
fn sent(form: Form, size: &Size) -> (u64, u64) {
    let later = size.patches() - 1;
    match form {
        Form::Patches => (16 * (1 + later), 4 * (1 + later)),
        Form::Strip => (16 + 12 * later, 4 + 2 * later),
        Form::FanCompact => (1 + 11 + 8 * later, 1 + 2 + later),
        Form::FanFull => (1 + 12 + 9 * later, 1 + 2 + later),
        Form::Mesh | Form::IndexedMesh => {
            let (up, along) = (size.rows - 1, size.columns - 1);
            (16 + 12 * (up + along) + 9 * up * along, 4 + 2 * (up + along) + up * along)
        }
        Form::IndexedTriangles | Form::TriangleStrips | Form::VerticesOnce => (0, 0),
    }
}

/// Vertices of one instance.
fn vertices(form: Form, size: &Size) -> u64 {
    let (level, patches) = (size.level, size.patches());
    match form {
        Form::IndexedTriangles => patches * (level + 1) * (level + 1),
        Form::TriangleStrips => patches * level * 2 * (level + 1),
        Form::VerticesOnce => (size.rows * level + 1) * (size.columns * level + 1),
        _ => 0,
    }
}
