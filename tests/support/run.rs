//! Whole runs in tests: how long a campaign is, a sink that keeps meshes, cameras and commands.

use glam::camera::rh::proj::directx;
use glam::camera::rh::view::look_at_mat4;
use rtl_model::patch::{Triangle, Vertex};
use tessim::error::Result;
use tessim::sink::{FrameInfo, PatchMesh, Sink};
use tessim::trace::command::{Command, Draw, Frame, Points, Primitive};
use tessim::trace::points::PointSource;

/// How many times over a campaign runs: `TESSIM_LONG=1` asks for the long one.
pub(crate) fn scale(short: usize, long: usize) -> usize {
    if std::env::var_os("TESSIM_LONG").is_some_and(|v| v == "1") { long } else { short }
}

/// A patch's mesh, kept.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mesh {
    pub(crate) frame: u64,
    pub(crate) patch: u32,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
}

/// Keeps every mesh of every frame.
#[derive(Default)]
pub(crate) struct Keep {
    pub(crate) frames: Vec<FrameInfo>,
    pub(crate) meshes: Vec<Mesh>,
}

impl Sink for Keep {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.frames.push(*frame);
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        self.meshes.push(Mesh {
            frame: self.frames.len() as u64 - 1,
            patch: mesh.patch,
            vertices: mesh.vertices.to_vec(),
            triangles: mesh.triangles.to_vec(),
        });
        Ok(())
    }
}

/// A camera at `eye` that looks at the origin, z up unless it looks along z.
pub(crate) fn camera(eye: glam::Vec3, near: f32, far: f32) -> Frame {
    let up = if eye.truncate().length() < 1e-3 { glam::Vec3::Y } else { glam::Vec3::Z };
    Frame {
        viewport: [1280, 1024],
        view: look_at_mat4(eye, glam::Vec3::ZERO, up).to_cols_array(),
        projection: directx::perspective(0.8, 1.25, near, far).to_cols_array(),
        depth: Default::default(),
        range: Default::default(),
    }
}

/// Points under an id.
pub(crate) fn points(id: u32, points: Vec<[f32; 3]>) -> Command {
    Command::Points(Points { id, source: PointSource::Xyz(points).into(), resident: false })
}

/// A draw that culls nothing.
pub(crate) fn draw(primitive: Primitive, points: u32, first: u64) -> Draw {
    Draw { first, cull: false, ..Draw::new(primitive, points) }
}
