//! The configuration: everything that changes what a run computes. Formats and policies as plain
//! data. A leaf.
//!
//! In come a preset, a TOML file and single settings ([`layers`]); out comes a checked [`Config`],
//! which prints itself as commented TOML that reads back as the same configuration ([`mod@print`]).
//! Threads are no part of it: any number of them gives the same bytes.

pub mod block;
pub mod check;
pub mod d3d11;
mod default;
pub mod esc;
pub mod keys;
pub mod layers;
pub mod link;
pub mod preset;
pub mod print;
pub mod triangles;
mod union;

use serde::{Deserialize, Serialize};

pub use block::{BackfaceCosts, BlockCosts, Blocks, DomainCosts, EvaluateCosts, SurfaceCosts};
pub use d3d11::{Arithmetic, Domain, DomainKind, FactorPolicy, Form, Hull, Tessellator};
pub use esc::{Esc, LevelPolicy, LevelScope, Space};
pub use link::{Bus, Channels, Link, Memory, TransferMode};
pub use rtl_model::backface::Method as BackfaceMethod;
pub use rtl_model::d3d11::Partitioning;
pub use rtl_model::esc::{Boundary, ControlMesh, Reuse};
pub use rtl_model::evaluate::{Normals, Scheme};
pub use rtl_model::level::Termination;
pub use rtl_model::number::{Overflow, Rounding};
pub use rtl_model::time::{Frames, LaneOrder};
pub use triangles::{
    CachePolicy, IndexWidth, MeshTopology, Residency, Triangles, Upload, VertexCache,
};
pub use union::Union;

/// Widest position format.
pub const WIDTH_MAX: u32 = 48;

/// Which unit runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Sfarti's place and culling, Moreton's fractional levels, forward differencing and stitcher.
    #[default]
    Hybrid,
    /// The host tessellates: the same triangles, but vertices and indices cross the link.
    Triangles,
    /// Sfarti's unit: midpoint subdivision, de Casteljau, zippers.
    Sfarti,
    /// GeForce3's: before transform, with levels from the driver, and no culling.
    Moreton,
    /// What ships today: hull shader, fixed-function tessellator, domain shader.
    D3d11,
    /// The surface-level shader of Concheiro et al.: one invocation a patch.
    Esc,
}

impl Unit {
    /// All of them, the default first.
    pub const ALL: [Self; 6] =
        [Self::Hybrid, Self::Triangles, Self::Sfarti, Self::Moreton, Self::D3d11, Self::Esc];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hybrid => "hybrid",
            Self::Triangles => "triangles",
            Self::Sfarti => "sfarti",
            Self::Moreton => "moreton",
            Self::D3d11 => "d3d11",
            Self::Esc => "esc",
        }
    }

    /// Whether the host tessellates, and vertices cross the link.
    #[must_use]
    pub const fn host_tessellates(self) -> bool {
        matches!(self, Self::Triangles)
    }

    /// Whether strips, fans and meshes cross the link as such. Where they do not, they are indexed
    /// patches.
    #[must_use]
    pub const fn has_surface_primitives(self) -> bool {
        !matches!(self, Self::D3d11)
    }

    /// Whether a vertex shader lights what leaves the unit: where there is none, the domain shader
    /// or the surface shader does.
    #[must_use]
    pub const fn has_vertex_shader(self) -> bool {
        !matches!(self, Self::D3d11 | Self::Esc)
    }

    /// Whether the unit works in object space, and a vertex program transforms what leaves it.
    #[must_use]
    pub const fn in_object_space(self) -> bool {
        matches!(self, Self::Moreton)
    }
}

/// Which engine lays time over the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Engine {
    /// Visits each token once.
    #[default]
    Timed,
    /// Goes cycle by cycle: slow, and what makes the other believable.
    Stepped,
    /// Function only: no cycles.
    None,
}

impl Engine {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Timed, Self::Stepped, Self::None];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Timed => "timed",
            Self::Stepped => "stepped",
            Self::None => "none",
        }
    }

    /// The engine of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|engine| engine.name() == name)
    }
}

/// The effective configuration of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// The unit.
    pub unit: Unit,
    /// The engine.
    pub engine: Engine,
    /// The clock of unit, link and memory in MHz, 1..=100000.
    pub clock_mhz: u32,
    /// What becomes of the pipeline between frames.
    pub frames: Frames,
    /// Positions behind the port.
    pub position: Position,
    /// Primitives to patches.
    pub assemble: Assemble,
    /// The hull shader (unit `d3d11`).
    pub hull: Hull,
    /// Levels.
    pub level: Level,
    /// Trivial clipping.
    pub clip: Clip,
    /// Back-face removal.
    pub backface: Backface,
    /// The fixed-function tessellator (unit `d3d11`).
    pub tessellator: Tessellator,
    /// Parameters from levels.
    pub place: Place,
    /// Points of the surface.
    pub evaluate: Evaluate,
    /// The domain shader (unit `d3d11`).
    pub domain: Domain,
    /// The surface shader (unit `esc`).
    pub esc: Esc,
    /// Attributes of corners, interpolated over the patch.
    pub attributes: Attributes,
    /// Divide and output.
    pub emit: Emit,
    /// The vertex shader.
    pub vertex_shader: VertexShader,
    /// The link from the host.
    pub link: Link,
    /// Device memory.
    pub memory: Memory,
    /// Unit `triangles`.
    pub triangles: Triangles,
    /// What the blocks cost in time.
    pub block: Blocks,
}

/// The position format and the port that makes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Position {
    /// Bits of a coordinate with its sign, 8..=48.
    pub width: u32,
    /// How the port rounds.
    pub rounding: Rounding,
    /// What the port, evaluate and emit do with values that do not fit.
    pub overflow: Overflow,
    /// log2 of the largest magnitude in clip space; the trace's `range`, else the far plane's w,
    /// when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_range_log2: Option<i32>,
    /// log2 of the largest magnitude in object space, where the trace's `range` does not say
    /// (unit `moreton`).
    pub object_range_log2: i32,
}

/// Primitives to patches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Assemble {
    /// Entries of the cache of an indexed mesh's transformed points, 0..=65536.
    pub cache_entries: u32,
}

/// Attributes of corners, interpolated over the patch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Attributes {
    /// Bits of a component with its sign, 8..=46.
    pub width: u32,
    /// Fraction bits of a component, 0..=width - 1.
    pub fraction: u32,
    /// How a component is rounded when it enters and when it is interpolated.
    pub rounding: Rounding,
}

/// Levels. Absent: as the trace says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Level {
    /// Overrides the trace's criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub criterion: Option<Criterion>,
    /// Pixels of `flatness` and `edge_length`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels: Option<f64>,
    /// Level of `fixed`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// Overrides the trace's least level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_level: Option<f64>,
    /// Overrides the trace's greatest level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_level: Option<f64>,
    /// Points with a smaller w give their edges the greatest level; the near plane's w when
    /// absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near: Option<f64>,
    /// When midpoint subdivision ends (unit `sfarti`).
    pub termination: Termination,
    /// Whose lists are unified (unit `sfarti`).
    pub union: Union,
}

/// The criterion's name; its number stands beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// Distance between the surface and its triangles.
    Flatness,
    /// Length of the projected control polygon.
    EdgeLength,
    /// The same level everywhere.
    Fixed,
}

/// Trivial clipping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Clip {
    /// Whether patches wholly outside one plane are removed.
    pub enabled: bool,
}

/// Back-face removal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Backface {
    /// The test.
    pub method: BackfaceMethod,
}

/// Parameters from levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Place {
    /// Fraction bits of a level's reciprocal, 8..=32 (units with fractional levels).
    pub reciprocal_bits: u32,
}

/// Points of the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Evaluate {
    /// How boundary and interior points are computed.
    pub scheme: Scheme,
    /// Guard bits of the forward-difference accumulators; min(20, 60 - width) when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub guard: Option<u32>,
    /// How an output is rounded to the position format.
    pub rounding: Rounding,
    /// What the vertex shader gets to light with.
    pub normals: Normals,
}

/// Divide and output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Emit {
    /// Whether vertices are divided by w and snapped to the sub-pixel grid.
    pub divide: bool,
    /// Fraction bits of a screen coordinate (Q16.8: 8), 0..=12.
    pub subpixel_bits: u32,
    /// How a screen coordinate is rounded.
    pub rounding: Rounding,
    /// Bytes of a vertex record that leaves the unit.
    pub vertex_bytes: u32,
    /// Bytes of a triangle index that leaves the unit.
    pub index_bytes: u32,
}

/// The vertex shader, lighting only: positions are already in clip space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VertexShader {
    /// Bytes read a vertex, without normals: position 16, parameters 8.
    pub bytes_in: u32,
    /// Bytes of a tangent plane, read when normals are on.
    pub bytes_in_normal: u32,
    /// Bytes written a vertex: position 16, colour 16.
    pub bytes_out: u32,
    /// Whether shaded vertices are also written to device memory (stream output).
    pub to_memory: bool,
}

impl Attributes {
    /// Bytes of a component that leaves the unit.
    #[must_use]
    pub fn component_bytes(&self) -> u64 {
        self.width.div_ceil(8).into()
    }
}

impl Config {
    /// Guard bits: as configured, else min(20, 60 - width), so that width + guard + 3 stays
    /// within 63 bits.
    #[must_use]
    pub fn guard(&self) -> u32 {
        let room = 60u32.saturating_sub(self.position.width);
        self.evaluate.guard.unwrap_or(20.min(room))
    }

    /// How points are computed: as configured, but in unit `sfarti`, whose lists are not walked in
    /// equal steps, always by de Casteljau.
    #[must_use]
    pub fn scheme(&self) -> Scheme {
        match self.unit {
            Unit::Sfarti => Scheme::DeCasteljau,
            _ => self.evaluate.scheme,
        }
    }

    /// Whose lists are unified: as configured in unit `sfarti`; no other has lists of that kind.
    #[must_use]
    pub fn union(&self) -> Union {
        match self.unit {
            Unit::Sfarti => self.level.union,
            _ => Union::Off,
        }
    }

    /// Whether the unit divides by w: not where its vertices are still to be transformed.
    #[must_use]
    pub fn divides(&self) -> bool {
        self.emit.divide && !self.unit.in_object_space()
    }

    /// The same configuration with what it leaves to be derived from itself written out:
    /// `evaluate.guard`, `domain.form`, what the unit does whatever is set, and `level.criterion`
    /// where only its number was given. A bus whose numbers were changed is named no more.
    #[must_use]
    pub fn effective(&self) -> Self {
        let mut effective = self.clone();
        effective.evaluate.guard = Some(self.guard());
        effective.evaluate.scheme = self.scheme();
        effective.emit.divide = self.divides();
        effective.level.criterion = self.level.chosen();
        effective.level.union = self.union();
        effective.domain.form = Some(self.form());
        effective.link.bus = self.link.bus();
        effective
    }
}

impl Level {
    /// The criterion that overrides the trace's, if any. A number alone says which: `level` means
    /// `fixed`, `pixels` means `flatness`, which is the trace format's own default.
    #[must_use]
    pub fn chosen(&self) -> Option<Criterion> {
        self.criterion.or(match (self.pixels, self.level) {
            (_, Some(_)) => Some(Criterion::Fixed),
            (Some(_), None) => Some(Criterion::Flatness),
            (None, None) => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_named_as_in_the_configuration() {
        for unit in Unit::ALL {
            let printed = toml::Value::try_from(unit).expect("plain data");
            assert_eq!(printed.as_str(), Some(unit.name()));
        }
    }
}
