//! `mesh.ply`: the mesh of one frame, binary little endian, exact.
//!
//! Patches come in, and go out as they come: vertices and faces into two spools, because the head
//! of a PLY file states their numbers and all vertices stand before all faces. Memory does not grow
//! with the mesh. Vertices are never merged across patches, so that a crack stays visible in the
//! data.

use super::file::{AtomicFile, spool, unspool};
use super::space::{parameter, real, ulp, world};
use crate::error::{Error, Result};
use crate::sink::{FrameInfo, PatchMesh};
use std::fs::File;
use std::io::{self, BufWriter, Write};

/// A PLY file under construction.
#[derive(Debug)]
pub struct Ply {
    out: AtomicFile,
    vertices: BufWriter<File>,
    faces: BufWriter<File>,
    vertex_count: u32,
    face_count: u64,
}

impl Ply {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written there.
    pub fn create(out: AtomicFile) -> Result<Self> {
        let (vertices, faces) = (spool(out.path())?, spool(out.path())?);
        Ok(Self { out, vertices, faces, vertex_count: 0, face_count: 0 })
    }

    /// Appends a patch.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written, [`Error::Usage`] beyond 2^32 - 1 vertices.
    pub fn patch(&mut self, frame: &FrameInfo, mesh: &PatchMesh<'_>) -> Result<()> {
        let first = self.vertex_count;
        let count = u32::try_from(mesh.vertices.len()).expect("a patch has few vertices");
        self.vertex_count = first.checked_add(count).ok_or_else(|| {
            Error::Usage("--mesh ply: a PLY file holds at most 4294967295 vertices".to_owned())
        })?;
        self.face_count += mesh.triangles.len() as u64;
        write_vertices(&mut self.vertices, frame, mesh)
            .and_then(|()| write_faces(&mut self.faces, first, mesh))
            .map_err(|error| Error::system(self.out.path(), error))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn finish(self) -> Result<()> {
        let Self { mut out, vertices, faces, vertex_count, face_count } = self;
        let path = out.path().to_owned();
        let head = head(vertex_count, face_count);
        out.write_all(head.as_bytes()).map_err(|error| Error::system(&path, error))?;
        unspool(vertices, &mut out, &path)?;
        unspool(faces, &mut out, &path)?;
        out.commit()
    }
}

fn head(vertices: u32, faces: u64) -> String {
    format!(
        "ply\n\
         format binary_little_endian 1.0\n\
         comment tessim: x y z world space; cx cy cz cw exact fixed-point coordinates\n\
         element vertex {vertices}\n\
         property float x\nproperty float y\nproperty float z\n\
         property double cx\nproperty double cy\nproperty double cz\nproperty double cw\n\
         property double u\nproperty double v\n\
         property uint patch\n\
         element face {faces}\n\
         property list uchar uint vertex_indices\n\
         property uint patch\n\
         end_header\n"
    )
}

fn write_vertices(out: &mut impl Write, frame: &FrameInfo, mesh: &PatchMesh<'_>) -> io::Result<()> {
    let ulp = ulp(frame.view.position);
    for vertex in mesh.vertices {
        let clip = real(vertex.position, ulp);
        for c in world(frame, clip) {
            out.write_all(&c.to_le_bytes())?;
        }
        for c in clip.into_iter().chain([parameter(vertex.u), parameter(vertex.v)]) {
            out.write_all(&c.to_le_bytes())?;
        }
        out.write_all(&mesh.patch.to_le_bytes())?;
    }
    Ok(())
}

fn write_faces(out: &mut impl Write, first: u32, mesh: &PatchMesh<'_>) -> io::Result<()> {
    for triangle in mesh.triangles {
        out.write_all(&[3])?;
        for index in triangle {
            out.write_all(&(first + u32::from(*index)).to_le_bytes())?;
        }
        out.write_all(&mesh.patch.to_le_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::space::tests::frame;
    use super::*;
    use rtl_model::patch::{HALF, ONE, Vertex};

    #[test]
    fn every_byte_is_where_the_head_says() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.ply");
        let mut ply = Ply::create(AtomicFile::create(&path).unwrap()).unwrap();
        let vertex = |x: i64, u, v| Vertex { position: [x << 16, -1, 0, 1 << 16], u, v };
        let vertices = [vertex(0, 0, 0), vertex(2, ONE, 0), vertex(4, HALF, ONE)];
        for patch in [5, 9] {
            let triangles = &[[0, 1, 2]];
            let mesh = PatchMesh { patch, vertices: &vertices, triangles, ..PatchMesh::default() };
            ply.patch(&frame(), &mesh).unwrap();
        }
        ply.finish().unwrap();

        let bytes = std::fs::read(&path).unwrap();
        let head = head(6, 2);
        let body = bytes.strip_prefix(head.as_bytes()).expect("six vertices and two faces");
        let (vertex_bytes, face_bytes) = (3 * 4 + 6 * 8 + 4, 1 + 3 * 4 + 4);
        assert_eq!(body.len(), 6 * vertex_bytes + 2 * face_bytes);
        let float = |at: usize| f32::from_le_bytes(body[at..at + 4].try_into().unwrap());
        let double = |at: usize| f64::from_le_bytes(body[at..at + 8].try_into().unwrap());
        let uint = |at: usize| u32::from_le_bytes(body[at..at + 4].try_into().unwrap());
        // The third vertex: the world is the clip space halved.
        let third = 2 * vertex_bytes;
        assert_eq!(float(third), 2.0);
        assert_eq!(double(third + 12), 4.0);
        assert_eq!(double(third + 20), -1.0 / 65536.0);
        assert_eq!((double(third + 44), double(third + 52)), (0.5, 1.0));
        assert_eq!(uint(third + 60), 5);
        // The second face counts on from the first patch's vertices.
        let second = 6 * vertex_bytes + face_bytes;
        assert_eq!(body[second], 3);
        assert_eq!([1, 5, 9, 13].map(|at| uint(second + at)), [3, 4, 5, 9]);
    }
}
