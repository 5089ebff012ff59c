//! Bandwidth: what a surface costs on the link as patches, and what its triangles would.
//!
//! Sfarti et al. 2005, sections 1 and 6: control points cross the link instead of vertices, twelve
//! of them a patch in a strip, nine in a mesh, with colour and texture at two corners or one. In
//! come levels and a number of patches; out come rows, one a form, corner and level, each with the
//! bytes by closed form ([`closed`]), and by running the tool on such a surface (engine `none`).
//! Measured are unit `hybrid`, and `triangles`; two forms of triangles that no unit sends have
//! closed forms only.
//!
//! Everything is immediate: it crosses the link anew in each frame, and nothing but an index stands
//! for what was sent before. Patches are tessellated at one level throughout; `hybrid` has an even
//! number of segments from 2 on, so the levels that it reaches are 1 and the even ones.

pub mod closed;
mod plot;
mod scene;
mod table;

use crate::config::{Config, Engine, Unit};
use crate::error::Result;
use crate::sink::NoMesh;
use crate::unit::simulate;
use rtl_model::counter::Counter;

pub use closed::Bytes;
pub use plot::svg;
pub use table::{CSV_HEADER, csv, text};

/// Greatest level.
pub const LEVEL_MAX: u32 = 128;

/// Bytes of a corner: none, or colour (`unorm8x4`) and texture coordinates (`float32x2`).
pub const CORNERS: [u64; 2] = [12, 0];

/// How much is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Least and greatest level, 1..=[`LEVEL_MAX`].
    pub levels: [u32; 2],
    /// Patches of the surface, at least one; a mesh of them is as square as can be.
    pub patches: u32,
    /// Instances that the one draw has, at least one.
    pub instances: u32,
}

/// How a surface crosses the link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Sixteen points a patch.
    Patches,
    /// A strip of patches.
    Strip,
    /// A fan, as the paper counts its points.
    FanCompact,
    /// A fan with all of its points.
    FanFull,
    /// A mesh.
    Mesh,
    /// The mesh's points once, and sixteen indices a patch.
    IndexedMesh,
    /// Each patch's vertices once, and three indices a triangle: unit `triangles`.
    IndexedTriangles,
    /// A triangle strip for each row of each patch's grid. Closed form only.
    TriangleStrips,
    /// Each vertex of the mesh once, and not a byte that says what to make of it: less than any way
    /// to send its triangles. Closed form only.
    VerticesOnce,
}

impl Form {
    /// All of them: patches, then triangles.
    pub const ALL: [Self; 9] = [
        Self::Patches,
        Self::Strip,
        Self::FanCompact,
        Self::FanFull,
        Self::Mesh,
        Self::IndexedMesh,
        Self::IndexedTriangles,
        Self::TriangleStrips,
        Self::VerticesOnce,
    ];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Patches => "patches",
            Self::Strip => "strip",
            Self::FanCompact => "fan, compact",
            Self::FanFull => "fan, full",
            Self::Mesh => "mesh",
            Self::IndexedMesh => "indexed mesh",
            Self::IndexedTriangles => "indexed triangles",
            Self::TriangleStrips => "triangle strips",
            Self::VerticesOnce => "vertices once",
        }
    }

    /// Whether triangles cross the link.
    #[must_use]
    pub const fn is_triangles(self) -> bool {
        matches!(self, Self::IndexedTriangles | Self::TriangleStrips | Self::VerticesOnce)
    }

    /// The unit that takes it, if one does.
    #[must_use]
    pub const fn unit(self) -> Option<Unit> {
        match self {
            Self::TriangleStrips | Self::VerticesOnce => None,
            Self::IndexedTriangles => Some(Unit::Triangles),
            _ => Some(Unit::Hybrid),
        }
    }
}

/// A surface, and how it is tessellated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Patches along v; those of a strip or fan are `rows * columns` in a row.
    pub rows: u64,
    /// Patches along u.
    pub columns: u64,
    /// Instances.
    pub instances: u64,
    /// Bytes of a corner, one of [`CORNERS`].
    pub corner_bytes: u64,
    /// Segments of each edge.
    pub level: u64,
}

impl Size {
    /// Patches in one instance.
    #[must_use]
    pub fn patches(&self) -> u64 {
        self.rows * self.columns
    }

    /// Triangles over all instances.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        2 * self.level * self.level * self.patches() * self.instances
    }
}

/// A form at a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The form.
    pub form: Form,
    /// The surface.
    pub size: Size,
    /// Bytes by the closed form.
    pub closed: Bytes,
    /// What a run counted, where a unit takes the form.
    pub measured: Option<Measured>,
}

/// What a run counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// What the closed form gives.
    pub data: Bytes,
    /// Headers of commands.
    pub commands: u64,
    /// The frame's matrices and the instances'.
    pub matrices: u64,
    /// Framing of packets.
    pub framing: u64,
    /// All of it.
    pub total: u64,
    /// Triangles made.
    pub triangles: u64,
}

impl Row {
    /// Bytes of the surface: points, attributes, vertices, indices.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.closed.total()
    }

    /// Whether what was measured is what the closed form says.
    #[must_use]
    pub fn agrees(&self) -> bool {
        let Some(measured) = self.measured else { return true };
        measured.data == self.closed && measured.triangles == self.size.triangles()
    }
}

/// Carries out the study in the current rayon pool.
///
/// # Errors
/// None that can be expected: those of [`simulate`].
pub fn run(options: Options) -> Result<Vec<Row>> {
    let [rows, columns] = shape(options.patches.into());
    let mut all = Vec::new();
    for corner_bytes in CORNERS {
        for form in Form::ALL {
            for level in levels(options.levels) {
                let instances = options.instances.into();
                let size = Size { rows, columns, instances, corner_bytes, level };
                all.push(row(form, size)?);
            }
        }
    }
    Ok(all)
}

/// One row.
///
/// # Errors
/// As [`run`].
pub fn row(form: Form, size: Size) -> Result<Row> {
    let measured = form.unit().map(|unit| measure(form, size, unit)).transpose()?;
    Ok(Row { form, size, closed: closed::bytes(form, &size), measured })
}

/// The levels between two, both included, that have as many segments.
fn levels([least, most]: [u32; 2]) -> impl Iterator<Item = u64> {
    (least..=most).filter(|level| *level == 1 || level.is_multiple_of(2)).map(u64::from)
}

/// Rows and columns of a mesh of so many patches, as square as can be.
fn shape(patches: u64) -> [u64; 2] {
    let rows = (1..=patches.isqrt()).rev().find(|rows| patches.is_multiple_of(*rows)).unwrap_or(1);
    [rows, patches / rows]
}

fn measure(form: Form, size: Size, unit: Unit) -> Result<Measured> {
    let mut config = Config { unit, engine: Engine::None, ..Config::default() };
    // All patches are to be counted.
    config.clip.enabled = false;
    let commands = scene::commands(form, &size).into_iter().map(Ok);
    let totals = simulate(commands, &config, &mut NoMesh)?.totals();
    Ok(Measured {
        data: Bytes {
            control_points: totals.get(Counter::LinkControlPoints),
            attributes: totals.get(Counter::LinkAttributes),
            vertices: totals.get(Counter::LinkVertices),
            indices: totals.get(Counter::LinkIndices),
        },
        commands: totals.get(Counter::LinkCommands),
        matrices: totals.get(Counter::LinkMatrices),
        framing: totals.get(Counter::LinkOverhead) + totals.get(Counter::LinkRequests),
        total: totals.get(Counter::LinkTotal),
        triangles: totals.get(Counter::EmitTriangles),
    })
}

#[cfg(test)]
mod tests;
