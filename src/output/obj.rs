//! `mesh.obj`: the mesh of one frame as text, in world space, for programs that read nothing else.
//!
//! A group a patch, positions with their parameters as texture coordinates. Streamed: a face may
//! name any vertex above it. Not exact: who needs the hardware's integers takes the PLY.

use super::file::AtomicFile;
use super::space::{parameter, real, ulp, world};
use crate::error::{Error, Result};
use crate::sink::{FrameInfo, PatchMesh};
use std::io::{self, Write};

/// An OBJ file under construction.
#[derive(Debug)]
pub struct Obj {
    out: AtomicFile,
    vertex_count: u64,
}

impl Obj {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written there.
    pub fn create(mut out: AtomicFile) -> Result<Self> {
        let head = "# tessim: world space; texture coordinates are the patch's u v\n";
        out.write_all(head.as_bytes()).map_err(|error| Error::system(out.path(), error))?;
        Ok(Self { out, vertex_count: 0 })
    }

    /// Appends a patch.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn patch(&mut self, frame: &FrameInfo, mesh: &PatchMesh<'_>) -> Result<()> {
        let first = self.vertex_count;
        self.vertex_count += mesh.vertices.len() as u64;
        write_patch(&mut self.out, first, frame, mesh)
            .map_err(|error| Error::system(self.out.path(), error))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn finish(self) -> Result<()> {
        self.out.commit()
    }
}

fn write_patch(
    out: &mut impl Write,
    first: u64,
    frame: &FrameInfo,
    mesh: &PatchMesh<'_>,
) -> io::Result<()> {
    writeln!(out, "g patch{}", mesh.patch)?;
    let ulp = ulp(frame.view.position);
    for vertex in mesh.vertices {
        let [x, y, z] = world(mesh.to_world, real(vertex.position, ulp));
        writeln!(out, "v {x} {y} {z}")?;
    }
    for vertex in mesh.vertices {
        writeln!(
            out,
            "vt {} {}",
            parameter(vertex.u, frame.grid),
            parameter(vertex.v, frame.grid)
        )?;
    }
    for triangle in mesh.triangles {
        // OBJ counts from 1.
        let [a, b, c] = triangle.map(|index| first + u64::from(index) + 1);
        writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::space::tests::{HALVED, frame};
    use super::*;
    use rtl_model::patch::{ONE, Vertex};

    #[test]
    fn faces_count_on_from_patch_to_patch() {
        let mut text = Vec::new();
        let corner = |u, v| Vertex { position: [i64::from(u), 0, 0, 1 << 16], u, v };
        let vertices = [corner(0, 0), corner(ONE, 0), corner(ONE, ONE)];
        let mesh = PatchMesh {
            patch: 7,
            reversed: false,
            vertices: &vertices,
            triangles: &[[0, 1, 2]],
            to_world: &HALVED,
            ..PatchMesh::default()
        };
        write_patch(&mut text, 3, &frame(), &mesh).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "g patch7\nv 0 0 0\nv 0.5 0 0\nv 0.5 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 4/4 5/5 6/6\n"
        );
    }
}
