//! `mesh.ply`: the mesh of one frame, binary little endian, exact.
//!
//! Patches come in, and go out as they come: vertices and faces into two spools, because the head
//! of a PLY file states their numbers and all vertices stand before all faces. Memory does not grow
//! with the mesh. Vertices are never merged across patches, so that a crack stays visible in the
//! data.
//!
//! Attributes are properties by their names, `color.0`, `color.1` and so on where there are several
//! components. All vertices of a file have the same properties, so where draws of a frame differ
//! in their attributes, the properties are those of all of them, and NaN stands for what a vertex
//! has not.

use super::file::{AtomicFile, respool, spool, unspool};
use super::space::{parameter, real, ulp, world};
use crate::attribute::Attribute;
use crate::config::Attributes;
use crate::error::{Error, Result};
use crate::sink::{FrameInfo, PatchMesh};
use std::fs::File;
use std::io::{self, BufWriter, Read, Write};

/// A PLY file under construction.
#[derive(Debug)]
pub struct Ply {
    out: AtomicFile,
    vertices: BufWriter<File>,
    faces: BufWriter<File>,
    vertex_count: u32,
    face_count: u64,
    /// All properties so far that are attributes.
    columns: Vec<String>,
    /// Vertices in a row with the same attributes, and which of the columns those are.
    runs: Vec<(u32, Vec<usize>)>,
    /// What one unit of an attribute is worth.
    attribute_ulp: f64,
}

impl Ply {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written there.
    pub fn create(out: AtomicFile, attributes: &Attributes) -> Result<Self> {
        let (vertices, faces) = (spool(out.path())?, spool(out.path())?);
        Ok(Self {
            out,
            vertices,
            faces,
            vertex_count: 0,
            face_count: 0,
            columns: Vec::new(),
            runs: Vec::new(),
            attribute_ulp: f64::from(attributes.fraction).exp2().recip(),
        })
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
        self.lay_out(count, mesh.layout);
        write_vertices(&mut self.vertices, frame, mesh, self.attribute_ulp)
            .and_then(|()| write_faces(&mut self.faces, first, mesh))
            .map_err(|error| Error::system(self.out.path(), error))
    }

    /// Notes which columns the next `count` vertices have.
    fn lay_out(&mut self, count: u32, layout: &[Attribute]) {
        let mut columns = Vec::new();
        for name in layout.iter().flat_map(properties) {
            let known = self.columns.iter().position(|column| *column == name);
            columns.push(known.unwrap_or_else(|| {
                self.columns.push(name);
                self.columns.len() - 1
            }));
        }
        match self.runs.last_mut() {
            // A run is as long as fits 32 bits, like all vertices of a file.
            Some((run, same)) if *same == columns => *run += count,
            _ => self.runs.push((count, columns)),
        }
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn finish(self) -> Result<()> {
        let Self { mut out, vertices, faces, vertex_count, face_count, columns, runs, .. } = self;
        let path = out.path().to_owned();
        let head = head(vertex_count, face_count, &columns);
        out.write_all(head.as_bytes()).map_err(|error| Error::system(&path, error))?;
        let whole: Vec<usize> = (0..columns.len()).collect();
        if runs.iter().all(|(_, present)| *present == whole) {
            unspool(vertices, &mut out, &path)?;
        } else {
            let padded = Padded { columns: columns.len(), runs: &runs };
            let mut spooled = respool(vertices, &path)?;
            padded.copy(&mut spooled, &mut out).map_err(|error| Error::system(&path, error))?;
        }
        unspool(faces, &mut out, &path)?;
        out.commit()
    }
}

/// Bytes of a vertex before its attributes.
const VERTEX_BYTES: usize = 3 * 4 + 6 * 8 + 4;

/// Vertices of which not all have all columns.
struct Padded<'a> {
    columns: usize,
    runs: &'a [(u32, Vec<usize>)],
}

impl Padded<'_> {
    fn copy(&self, from: &mut impl Read, to: &mut impl Write) -> io::Result<()> {
        for (count, present) in self.runs {
            let mut vertex = vec![0; VERTEX_BYTES + 8 * present.len()];
            for _ in 0..*count {
                from.read_exact(&mut vertex)?;
                let (own, attributes) = vertex.split_at(VERTEX_BYTES);
                to.write_all(own)?;
                let mut row = vec![f64::NAN.to_le_bytes(); self.columns];
                let (values, _) = attributes.as_chunks();
                for (&column, value) in present.iter().zip(values) {
                    row[column] = *value;
                }
                to.write_all(row.as_flattened())?;
            }
        }
        Ok(())
    }
}

/// The names of an attribute's components. An attribute's own name has no point, so none of these
/// is another's.
fn properties(attribute: &Attribute) -> Vec<String> {
    let name = match &*attribute.name {
        own @ ("x" | "y" | "z" | "cx" | "cy" | "cz" | "cw" | "u" | "v" | "patch") => {
            format!("attribute.{own}")
        }
        other => other.to_owned(),
    };
    match attribute.format.components() {
        1 => vec![name],
        count => (0..count).map(|k| format!("{name}.{k}")).collect(),
    }
}

fn head(vertices: u32, faces: u64, columns: &[String]) -> String {
    let columns: String = columns.iter().map(|name| format!("property double {name}\n")).collect();
    format!(
        "ply\n\
         format binary_little_endian 1.0\n\
         comment tessim: x y z world space; cx cy cz cw exact fixed-point coordinates\n\
         element vertex {vertices}\n\
         property float x\nproperty float y\nproperty float z\n\
         property double cx\nproperty double cy\nproperty double cz\nproperty double cw\n\
         property double u\nproperty double v\n\
         property uint patch\n\
         {columns}\
         element face {faces}\n\
         property list uchar uint vertex_indices\n\
         property uint patch\n\
         end_header\n"
    )
}

fn write_vertices(
    out: &mut impl Write,
    frame: &FrameInfo,
    mesh: &PatchMesh<'_>,
    attribute_ulp: f64,
) -> io::Result<()> {
    let ulp = ulp(frame.view.position);
    let components: usize = mesh.layout.iter().map(|a| a.format.components()).sum();
    for (k, vertex) in mesh.vertices.iter().enumerate() {
        let clip = real(vertex.position, ulp);
        for c in world(mesh.to_world, clip) {
            out.write_all(&c.to_le_bytes())?;
        }
        for c in clip
            .into_iter()
            .chain([parameter(vertex.u, frame.grid), parameter(vertex.v, frame.grid)])
        {
            out.write_all(&c.to_le_bytes())?;
        }
        out.write_all(&mesh.patch.to_le_bytes())?;
        for &raw in &mesh.attributes[k * components..(k + 1) * components] {
            out.write_all(&(raw as f64 * attribute_ulp).to_le_bytes())?;
        }
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
    use super::super::space::tests::{HALVED, frame};
    use super::*;
    use crate::attribute::AttributeFormat;
    use rtl_model::patch::{HALF, ONE, Vertex};

    #[test]
    fn every_byte_is_where_the_head_says() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.ply");
        let mut ply =
            Ply::create(AtomicFile::create(&path).unwrap(), &Attributes::default()).unwrap();
        let vertex = |x: i64, u, v| Vertex { position: [x << 16, -1, 0, 1 << 16], u, v };
        let vertices = [vertex(0, 0, 0), vertex(2, ONE, 0), vertex(4, HALF, ONE)];
        for patch in [5, 9] {
            let triangles = &[[0, 1, 2]];
            let mesh = PatchMesh {
                patch,
                vertices: &vertices,
                triangles,
                to_world: &HALVED,
                ..PatchMesh::default()
            };
            ply.patch(&frame(), &mesh).unwrap();
        }
        ply.finish().unwrap();

        let bytes = std::fs::read(&path).unwrap();
        let head = head(6, 2, &[]);
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

    #[test]
    fn vertices_without_an_attribute_have_nan_in_its_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.ply");
        let mut ply =
            Ply::create(AtomicFile::create(&path).unwrap(), &Attributes::default()).unwrap();
        let vertices = [Vertex { position: [0, 0, 0, 1 << 16], u: 0, v: 0 }];
        let attribute = |name: &str, format| Attribute {
            name: name.into(),
            format: AttributeFormat::named(format).unwrap(),
        };
        let color = [attribute("color", "float32x2")];
        let both = [attribute("u", "float32"), color[0].clone()];
        for (layout, attributes) in
            [(&color[..], &[1 << 16, -(1 << 15)][..]), (&[], &[]), (&both, &[3 << 16, 0, 1])]
        {
            let mesh =
                PatchMesh { vertices: &vertices, layout, attributes, ..PatchMesh::default() };
            ply.patch(&frame(), &mesh).unwrap();
        }
        ply.finish().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let names = ["color.0", "color.1", "attribute.u"].map(String::from);
        let body = bytes.strip_prefix(head(3, 0, &names).as_bytes()).expect("three vertices");
        let stride = VERTEX_BYTES + 3 * 8;
        assert_eq!(body.len(), 3 * stride);
        let rows = [0, 1, 2].map(|k| {
            let at = k * stride + VERTEX_BYTES;
            [0, 8, 16].map(|c| f64::from_le_bytes(body[at + c..at + c + 8].try_into().unwrap()))
        });
        assert_eq!(rows[0][..2], [1.0, -0.5]);
        assert!(rows[0][2].is_nan() && rows[1].iter().all(|c| c.is_nan()));
        assert_eq!(rows[2], [0.0, 2f64.powi(-16), 3.0]);
    }
}
