//! The programmable stages and the tessellator of unit `d3d11`, as keys `hull.*`, `tessellator.*`
//! and `domain.*`. Plain data.

use super::Config;
use rtl_model::d3d11::Partitioning;
use serde::{Deserialize, Serialize};

/// Most points of a SIMD wave.
pub const WIDTH_MAX: u32 = 1024;
/// Most candidate positions of a cell of an edge, under [`FactorPolicy::Adaptive`]: 3 x 21 segments
/// are within a tessellation factor of 64.
pub const CANDIDATES_MAX: u32 = 20;

/// What the hull shader computes tessellation factors from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FactorPolicy {
    /// The trace's criterion, or the one of `level.*` that overrides it: the levels of the other
    /// units.
    #[default]
    Criterion,
    /// The distance test of Concheiro et al. 2014, section 2.2, edge by edge: their AdptTess.
    Adaptive,
}

/// How often a domain shader reads the control points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DomainKind {
    /// All sixteen for every point, of which it then forms the whole product (Concheiro et al.
    /// 2014, section 2.2).
    Naive,
    /// Once a patch; a point reads its parameters.
    #[default]
    Basis,
}

/// The order of operations in which a point of a bicubic is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Bernstein sums from u and 1 - u, paired from both ends, so that an edge gives the same bits
    /// from either.
    #[default]
    Paired,
    /// The same weights, summed from left to right as shader samples do. Cracks where sums round.
    Sequential,
    /// The power basis, `[U][N][B][M]^T[V]` (Concheiro et al. 2014, Equation 6). Cracks.
    Power,
}

impl Form {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Paired, Self::Sequential, Self::Power];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paired => "paired",
            Self::Sequential => "sequential",
            Self::Power => "power",
        }
    }
}

/// What the domain shader's numbers are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Arithmetic {
    /// IEEE 754 singles, as today's shader cores have them.
    #[default]
    F32,
    /// Fixed point: positions in the position format, weights in a format of their own.
    Fixed,
}

impl Arithmetic {
    /// All of them, the default first.
    pub const ALL: [Self; 2] = [Self::F32, Self::Fixed];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::Fixed => "fixed",
        }
    }
}

/// The hull shader.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Hull {
    /// What factors are computed from.
    pub policy: FactorPolicy,
    /// Distance in pixels above which [`FactorPolicy::Adaptive`] inserts a vertex.
    pub pixels: f64,
    /// Candidate positions in each of an edge's three cells, 1..=[`CANDIDATES_MAX`].
    pub candidates: u32,
    /// Whether what it hands to the domain shader goes through device memory.
    pub to_memory: bool,
}

/// The fixed-function tessellator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Tessellator {
    /// How factors divide edges.
    pub partitioning: Partitioning,
}

/// The domain shader.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Domain {
    /// How often it reads the control points.
    pub shader: DomainKind,
    /// In which form it evaluates; absent: as its kind does ([`Config::form`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<Form>,
    /// In which numbers.
    pub arithmetic: Arithmetic,
    /// Fraction bits of a weight, 16..=30 ([`Arithmetic::Fixed`]).
    pub weight_bits: u32,
    /// Shaded points that are kept for the triangles that follow, first in first out, 0..=65536;
    /// absent: all of a patch's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cache_entries: Option<u32>,
    /// Points that a wave shades side by side, 1..=[`WIDTH_MAX`]. A wave is of one patch.
    pub width: u32,
    /// Bytes of a point's parameters.
    pub bytes_in: u32,
    /// Bytes of a shaded point without its attributes.
    pub bytes_out: u32,
}

impl Default for Hull {
    /// L = 3 as in the paper's tables; half a pixel, as flatness has it.
    fn default() -> Self {
        Self { policy: FactorPolicy::Criterion, pixels: 0.5, candidates: 3, to_memory: false }
    }
}

impl Default for Domain {
    /// Position and colour leave, as from the vertex shader; u and v come in.
    fn default() -> Self {
        Self {
            shader: DomainKind::Basis,
            form: None,
            arithmetic: Arithmetic::F32,
            weight_bits: 24,
            cache_entries: None,
            width: 64,
            bytes_in: 8,
            bytes_out: 32,
        }
    }
}

impl Config {
    /// The form in which the domain shader evaluates: as configured, else the whole product for a
    /// naive one, and the paired form otherwise.
    #[must_use]
    pub fn form(&self) -> Form {
        self.domain.form.unwrap_or(match self.domain.shader {
            DomainKind::Naive => Form::Power,
            DomainKind::Basis => Form::Paired,
        })
    }

    /// Whether the domain shader gives the same bits from either end of an edge.
    #[must_use]
    pub fn is_order_invariant(&self) -> bool {
        self.form() == Form::Paired
    }
}
