//! Item: a patch that arrived, and what the first implementation made of it.

use crate::gpu::{VERTEX, words};
use crate::sink::{Arrived, PatchMesh};
use rtl_model::patch::Patch;

/// What the first implementation made of a patch, in words as the kernels have them.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    pub(super) vertices: Vec<u32>,
    pub(super) screen: Vec<u32>,
    pub(super) triangles: Vec<u32>,
}

impl Mesh {
    pub(super) fn of(mesh: &PatchMesh<'_>) -> Self {
        let mut vertices = Vec::with_capacity(VERTEX * mesh.vertices.len());
        for vertex in mesh.vertices {
            vertices.extend(vertex.position.iter().flat_map(|&c| words(c)));
            vertices.extend([vertex.u, vertex.v]);
        }
        let screen = mesh.screen.iter().flat_map(|s| [s.x as u32, s.y as u32, s.divided.into()]);
        let triangles = mesh.triangles.iter().flatten().map(|&k| k.into());
        Self { vertices, screen: screen.collect(), triangles: triangles.collect() }
    }
}

/// A patch, and what became of it: no mesh, where it was clipped or culled.
pub(super) struct Item {
    pub(super) arrived: Arrived,
    pub(super) mesh: Option<Mesh>,
}

/// Control points, as a person can feed them to something.
pub(super) fn net(patch: &Patch) -> String {
    let points = patch.points.map(|p| p.map(|c| format!("{c:#x}")).join(" "));
    format!(
        "control points [{}], saturated {}, cull {}, reversed {}",
        points.join(", "),
        patch.saturated,
        patch.cull,
        patch.reversed
    )
}
