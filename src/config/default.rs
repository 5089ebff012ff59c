//! What holds where nothing is configured: the preset `modern`, and the reasons for it.

use super::{
    Assemble, Attributes, Backface, BackfaceMethod, Blocks, Clip, Config, Domain, Emit, Engine,
    Esc, Evaluate, Frames, Hull, Level, Link, Memory, Normals, Overflow, Place, Position, Rounding,
    Scheme, Termination, Tessellator, Triangles, Union, Unit, VertexShader,
};

impl Default for Config {
    /// The preset `modern`.
    fn default() -> Self {
        Self {
            unit: Unit::default(),
            engine: Engine::default(),
            clock_mhz: 2000,
            frames: Frames::default(),
            position: Position::default(),
            assemble: Assemble::default(),
            hull: Hull::default(),
            level: Level::default(),
            clip: Clip::default(),
            backface: Backface::default(),
            tessellator: Tessellator::default(),
            place: Place::default(),
            evaluate: Evaluate::default(),
            domain: Domain::default(),
            esc: Esc::default(),
            attributes: Attributes::default(),
            emit: Emit::default(),
            vertex_shader: VertexShader::default(),
            link: Link::default(),
            memory: Memory::default(),
            triangles: Triangles::default(),
            block: Blocks::default(),
        }
    }
}

impl Default for Position {
    fn default() -> Self {
        Self {
            width: 32,
            rounding: Rounding::NearestEven,
            overflow: Overflow::Saturate,
            clip_range_log2: None,
            object_range_log2: 4,
        }
    }
}

impl Default for Level {
    fn default() -> Self {
        Self {
            criterion: None,
            pixels: None,
            level: None,
            min_level: None,
            max_level: None,
            near: None,
            termination: Termination::EightCurves,
            union: Union::Off,
        }
    }
}

impl Default for Assemble {
    /// Twice the sixteen points of a patch: that of a mesh's neighbour is still there.
    fn default() -> Self {
        Self { cache_entries: 32 }
    }
}

impl Default for Attributes {
    /// Q16.16: colours to more than their 8 bits, texture coordinates up to 32768 repeats.
    fn default() -> Self {
        Self { width: 32, fraction: 16, rounding: Rounding::NearestEven }
    }
}

impl Default for Clip {
    fn default() -> Self {
        Self { enabled: true }
    }
}

impl Default for Backface {
    fn default() -> Self {
        Self { method: BackfaceMethod::TangentPlane }
    }
}

impl Default for Place {
    /// Twice the bits of a parameter.
    fn default() -> Self {
        Self { reciprocal_bits: rtl_model::place::RECIPROCAL_BITS }
    }
}

impl Default for Evaluate {
    fn default() -> Self {
        Self {
            scheme: Scheme::Forward,
            guard: None,
            rounding: Rounding::NearestEven,
            normals: Normals::Off,
        }
    }
}

impl Default for Emit {
    fn default() -> Self {
        Self {
            divide: true,
            subpixel_bits: 8,
            rounding: Rounding::NearestEven,
            vertex_bytes: 16,
            index_bytes: 2,
        }
    }
}

impl Default for VertexShader {
    fn default() -> Self {
        Self { bytes_in: 24, bytes_in_normal: 16, bytes_out: 32, to_memory: false }
    }
}
