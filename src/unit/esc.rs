//! `esc`: the surface-level shader of Concheiro, Amor, Boo, Padron 2014. One invocation makes all
//! of a patch: a fixed pattern, a test on each candidate of its coarse edges, the points, the
//! strips. What all samples of a surface share is computed once.
//!
//! ```text
//!   patch ─► clip ─► backface ─► level ─► group ─► surface shader ─► emit
//!                                         waves    net, tests, points, strips
//! ```
//!
//! Levels of resolution belong to edges, so that patches of different levels meet; or the driver
//! chooses one for a whole draw (`esc.scope`), and then only draws of one level do.

use super::chain::{self, Lane, Meshed};
use super::frame::FrameState;
use super::pipeline::{Input, Make, Placed, Placing};
use crate::config::{Config, LevelPolicy, LevelScope, Normals, Reuse, Unit};
use crate::error::Result;
use crate::shader::object_level::{self, Bounds};
use crate::trace::command::Draw;
use crate::trace::points::PointSource;
use glam::Mat4;
use rtl_model::counter::{Counter, Counters};
use rtl_model::esc::resolution::{self, Policy, Resolution};
use rtl_model::esc::{self, Made, Settings, Threshold};
use rtl_model::level::Criterion;
use rtl_model::number::Format;
use rtl_model::patch::{Triangle, Vertex};
use rtl_model::stitch::degenerate;

/// Bytes of a patch's control points: 16 vec4.
const NET_BYTES: u64 = 16 * 16;
/// And of those in object space, three components each.
const OBJECT_BYTES: u64 = 16 * 12;
/// Control points that the driver looks at at a time.
const POINTS: usize = 1 << 16;
/// Levels of a patch by distance or size: four edges and the interior.
const LEVELS: u16 = 5;

/// The surface shader of a frame.
pub(super) struct Esc {
    config: Config,
    resolution: Resolution,
    surface: esc::Surface,
}

impl Esc {
    fn settings(config: &Config, frame: &FrameState) -> Settings {
        let esc = &config.esc;
        Settings {
            position: frame.view.position,
            object: frame.object,
            guard: esc.guard,
            parameter_bits: esc.parameter_bits,
            rounding: config.evaluate.rounding,
            overflow: config.position.overflow,
            mesh: esc.control_mesh,
            threshold: if esc.tests_in_object_space() {
                Threshold::object(scaled(esc.mu, f64::from(frame.object.fraction + 8).exp2()))
            } else {
                Threshold::pixels(pixels(esc.mu))
            },
            boundary: esc.boundary,
            reuse: esc.reuse,
            output: config.output(),
        }
    }
}

/// A positive number in units of 1 / `scale`, to nearest and at least 1; 0 stays 0.
fn scaled(value: f64, scale: f64) -> u64 {
    if value > 0.0 { ((value * scale).round() as u64).max(1) } else { 0 }
}

/// Pixels in UQ16.16.
fn pixels(value: f64) -> u32 {
    scaled(value, 65536.0).min(u32::MAX.into()) as u32
}

/// A w in the position format.
fn raw(w: f64, format: Format) -> i64 {
    let raw = (w * f64::from(format.fraction).exp2()).round();
    raw.clamp(1.0, format.max() as f64) as i64
}

/// What levels depend on, in a frame.
fn policy(config: &Config, frame: &FrameState) -> Policy {
    let esc = &config.esc;
    match esc.level {
        LevelPolicy::Criterion => Policy::Criterion,
        LevelPolicy::Fixed => Policy::Fixed(esc.fixed_level as u8), // at most 15
        LevelPolicy::Distance => {
            Policy::Distance { full: raw(esc.full_distance, frame.view.position) }
        }
        LevelPolicy::ScreenSize => Policy::ScreenSize { pixels: pixels(esc.full_pixels) },
    }
}

/// Where the driver chooses a level for each instance of a draw: what it needs to know of the
/// draw's points. Others under their id are another object's.
pub(super) fn bounds(draw: &Draw, points: &PointSource, config: &Config) -> Result<Option<Bounds>> {
    if config.unit != Unit::Esc || config.esc.scope == LevelScope::Patch {
        return Ok(None);
    }
    let mut bounds = Bounds::default();
    let mut some = Vec::new();
    let mut include = |first: u64, count: u64| -> Result<()> {
        points.read(draw.first + first, count as usize, &mut some)?;
        some.iter().for_each(|&point| bounds.include(point));
        Ok(())
    };
    if let Some(indices) = &draw.indices {
        let mut named = indices.points.concat();
        named.sort_unstable();
        named.dedup();
        named.into_iter().try_for_each(|index| include(index.into(), 1))?;
    } else {
        let count = draw.primitive.points().expect("a draw without indices says how many");
        for first in (0..count).step_by(POINTS) {
            include(first, (count - first).min(POINTS as u64))?;
        }
    }
    Ok(Some(bounds))
}

/// The level that the driver then chooses.
pub(super) fn object_level(
    bounds: &Bounds,
    clip_from_object: &Mat4,
    config: &Config,
    frame: &FrameState,
) -> u8 {
    let esc = &config.esc;
    let policy = match esc.level {
        // The configuration's check refuses a criterion.
        LevelPolicy::Criterion | LevelPolicy::Fixed => return esc.fixed_level as u8,
        LevelPolicy::Distance => object_level::Policy::Distance { full: esc.full_distance as f32 },
        LevelPolicy::ScreenSize => {
            object_level::Policy::ScreenSize { pixels: esc.full_pixels as f32 }
        }
    };
    let settings = object_level::Settings {
        policy,
        level_max: esc.level_max as u8, // at most 15
        viewport: frame.view.viewport,
        near: frame.near(),
    };
    object_level::level(bounds, clip_from_object, &settings)
}

impl Make for Esc {
    type Lists = Meshed;
    const CULLS: bool = true;

    fn new(config: &Config, frame: &FrameState) -> Self {
        let policy = policy(config, frame);
        let level_max = config.esc.level_max as u8; // at most 15
        Self {
            config: config.clone(),
            resolution: Resolution { policy, level_max },
            surface: esc::Surface::new(Self::settings(config, frame)),
        }
    }

    fn place(&mut self, work: Placing<'_>, _counters: &mut Counters) -> Placed<Meshed> {
        let Input { patch, state, view, object_level, .. } = *work.input;
        let policy = object_level.map_or(self.resolution.policy, Policy::Object);
        let resolution = Resolution { policy, ..self.resolution };
        let (levels, events) = resolution::accept(patch, view, state, &resolution);
        let (criterion, count) = match policy {
            Policy::Criterion => (state.criterion, chain::levels(state.criterion)),
            // It projects and measures as that criterion does.
            Policy::ScreenSize { pixels } => (Criterion::EdgeLength { pixels }, LEVELS),
            Policy::Distance { .. } => (NONE, LEVELS),
            Policy::Fixed(_) => (NONE, 1),
            Policy::Object(_) => (NONE, 0),
        };
        let lists = Meshed { levels, ..Meshed::default() };
        Placed { lists, events, criterion, levels: count, reciprocals: 0 }
    }

    fn shape(
        &mut self,
        lists: &mut Meshed,
        input: &Input<'_>,
        vertices: &mut Vec<Vertex>,
        counters: &mut Counters,
    ) -> u64 {
        let work = esc::Input {
            patch: input.patch,
            object: input.object,
            view: input.view,
            levels: lists.levels,
        };
        let made = self.surface.accept(&work, vertices);
        let triangles = self.surface.triangles();
        let leave = self.leaves(&made);
        lists.lane = Lane {
            phases: made.sections,
            vertices: leave as u32, // at most 18 x 16 x 33 strip vertices
            triangles: triangles.len() as u32,
        };
        count_points(&made, counters);
        counters.add(Counter::SurfaceTriangles, triangles.len() as u64);
        counters.add(Counter::SurfaceDegenerate, degenerate(vertices, triangles));
        self.count_data(&made, leave, input.components, counters);
        leave
    }

    fn triangles(&self) -> &[Triangle] {
        self.surface.triangles()
    }

    fn is_indexed(&self) -> bool {
        self.config.esc.reuse != Reuse::None
    }
}

/// Where the level block computes nothing that a criterion defines.
const NONE: Criterion = Criterion::Fixed { level: rtl_model::patch::Level::MIN };

impl Esc {
    /// Vertices that leave for emit: each where it was evaluated or copied, and without reuse each
    /// that a strip names.
    fn leaves(&self, made: &Made) -> u64 {
        match self.config.esc.reuse {
            Reuse::None => made.strip_vertices,
            Reuse::CoarseTriangle | Reuse::Patch => {
                made.corners + made.boundary + made.coarse + made.interior
            }
        }
    }

    /// What the shader moves and holds.
    fn count_data(&self, made: &Made, leave: u64, components: u64, counters: &mut Counters) {
        let Config { esc, attributes, .. } = &self.config;
        let width = u64::from(self.config.position.width);
        let corner = components * attributes.component_bytes();
        let invocations = u64::from(made.sections.sections);
        let object = if made.object_nets > 0 { OBJECT_BYTES } else { 0 };
        let registers = 64 * u64::from(self.config.net_bits()) + 32 * u64::from(esc.registers);
        counters.add(Counter::SurfaceInvocations, invocations);
        counters.add(Counter::SurfaceControlPoints, 16 * invocations);
        counters.add(Counter::SurfaceBytesIn, invocations * (NET_BYTES + object + 4 * corner));
        counters.add(Counter::SurfaceBufferPeak, made.buffer * 4 * width);
        counters.add(Counter::SurfaceRegistersPeak, registers);
        counters.add(Counter::SurfaceAttributes, leave * components);
        counters.add(Counter::SurfaceBytesOut, leave * (u64::from(esc.bytes_out) + corner));
        if self.config.evaluate.normals == Normals::TangentPlane {
            counters.add(Counter::SurfaceNormals, leave);
        }
    }
}

/// What was tested, evaluated and joined.
fn count_points(made: &Made, counters: &mut Counters) {
    let evaluated = made.boundary + made.coarse + made.interior + made.tested;
    counters.add(Counter::SurfaceNets, made.nets);
    counters.add(Counter::SurfaceObjectNets, made.object_nets);
    counters.add(Counter::SurfaceTests, made.tests);
    counters.add(Counter::SurfaceInserted, made.inserted);
    counters.add(Counter::SurfaceEvaluations, evaluated);
    counters.add(Counter::SurfaceBoundary, made.boundary);
    counters.add(Counter::SurfaceCoarse, made.coarse);
    counters.add(Counter::SurfaceInterior, made.interior);
    counters.add(Counter::SurfaceTested, made.tested);
    counters.add(Counter::SurfaceTestedBoundary, made.tested_boundary);
    counters.add(Counter::SurfaceCorners, made.corners);
    counters.add(Counter::SurfacePoints, made.distinct);
    counters.add(Counter::SurfaceStripVertices, made.strip_vertices);
    counters.add(Counter::SurfaceSlots, made.slots);
    counters.add(Counter::SurfaceMoved, made.moved);
    counters.add(Counter::SurfaceCracks, made.cracks);
    counters.add(Counter::SurfaceOverflows, made.overflows);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_become_integers_that_are_zero_only_where_they_are() {
        assert_eq!((pixels(0.0), pixels(0.5), pixels(1e-9)), (0, 32768, 1));
        assert_eq!(pixels(65535.0), 65535 << 16);
        assert_eq!(scaled(1.5, 256.0), 384);
        let format = Format::of_range(16, 4); // 11 fraction bits
        assert_eq!((raw(1.0, format), raw(1e9, format)), (1 << format.fraction, format.max()));
    }
}
