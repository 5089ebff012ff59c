//! What of the tessellator's configuration OpenGL has words for, and the shaders that say it.
//!
//! OpenGL's equal spacing is integer partitioning, and that in powers of two as well: the shader
//! rounds to powers of two, and what D3D11's tessellator does in either is the same. Isolines have
//! the number of lines for their first outer level and the segments of a line for their second;
//! the levels of the other domains come in the order of D3D11's factors. The origin of OpenGL's
//! parameters is at the lower left, of D3D11's at the upper left: what is clockwise in one is
//! counter-clockwise in the other.

use crate::gl::Sources;
use rtl_model::d3d11::{Domain, Output, Partitioning};

/// A tessellator's configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mode {
    pub(crate) domain: Domain,
    pub(crate) partitioning: Partitioning,
    pub(crate) output: Output,
}

/// One vertex a patch carries the factors through; the rest is the tessellator's.
const VERTEX: &str = "
    #version 400 core
    #extension GL_ARB_explicit_attrib_location : require
    layout(location = 0) in uvec4 edges;
    layout(location = 1) in uvec2 inside;
    out uvec4 patch_edges;
    out uvec2 patch_inside;
    void main() { patch_edges = edges; patch_inside = inside; }
";

const CONTROL: &str = "
    #version 400 core
    layout(vertices = 1) out;
    in uvec4 patch_edges[];
    in uvec2 patch_inside[];
    void main() {
        for (int i = 0; i < 4; i++) gl_TessLevelOuter[i] = uintBitsToFloat(patch_edges[0][i]);
        for (int i = 0; i < 2; i++) gl_TessLevelInner[i] = uintBitsToFloat(patch_inside[0][i]);
    }
";

impl Mode {
    /// All that OpenGL has: lines of isolines only.
    pub(crate) fn all() -> Vec<Self> {
        let mut modes = Vec::new();
        for domain in [Domain::Quad, Domain::Tri, Domain::Isoline] {
            let outputs: &[Output] = match domain {
                Domain::Isoline => &[Output::Point, Output::Line],
                Domain::Quad | Domain::Tri => &[Output::Point, Output::Cw, Output::Ccw],
            };
            use Partitioning::{Even, Integer, Odd, Pow2};
            for partitioning in [Integer, Pow2, Odd, Even] {
                let mode = |&output| Self { domain, partitioning, output };
                modes.extend(outputs.iter().map(mode));
            }
        }
        modes
    }

    /// Vertices of a primitive.
    pub(crate) fn corners(self) -> u32 {
        match self.output {
            Output::Point => 1,
            Output::Line => 2,
            Output::Cw | Output::Ccw => 3,
        }
    }

    /// Which of a patch's six levels, the outer before the inner, this domain's factors are.
    pub(crate) fn levels(self) -> &'static [usize] {
        match self.domain {
            Domain::Quad => &[0, 1, 2, 3, 4, 5],
            Domain::Tri => &[0, 1, 2, 4],
            Domain::Isoline => &[0, 1],
        }
    }

    /// Shaders that ask for this mode and capture 16 bytes a vertex.
    pub(crate) fn sources(self) -> Sources {
        let domain = match self.domain {
            Domain::Quad => "quads",
            Domain::Tri => "triangles",
            Domain::Isoline => "isolines",
        };
        let spacing = match self.partitioning {
            Partitioning::Integer | Partitioning::Pow2 => "equal_spacing",
            Partitioning::Odd => "fractional_odd_spacing",
            Partitioning::Even => "fractional_even_spacing",
        };
        let output = match self.output {
            Output::Point => ", point_mode",
            Output::Line => "",
            Output::Cw => ", ccw",
            Output::Ccw => ", cw",
        };
        let evaluation = format!(
            "#version 400 core
            layout({domain}, {spacing}{output}) in;
            out vec3 coordinate;
            out int patch_number;
            void main() {{
                coordinate = gl_TessCoord;
                patch_number = gl_PrimitiveID;
                gl_Position = vec4(gl_TessCoord, 1.0);
            }}"
        );
        Sources {
            vertex: VERTEX.trim_start(),
            control: CONTROL.trim_start(),
            evaluation,
            captured: ["coordinate", "patch_number"],
        }
    }
}
