//! `hybrid`: Sfarti's place in the pipeline and his culling, Moreton's fractional levels, forward
//! differencing and stitcher. One patch in, its vertices, screen positions and triangles out.
//!
//! ```text
//!   patch ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit ─► vertex shader
//! ```

use super::chain::{self, Fate, Work};
use crate::config::{Config, Normals};
use rtl_model::backface::Verdict;
use rtl_model::counter::{Counter, Counters};
use rtl_model::emit::Screen;
use rtl_model::evaluate::Evaluate;
use rtl_model::number::Format;
use rtl_model::patch::{Level, Patch, Triangle, Vertex, View};
use rtl_model::place::Placement;
use rtl_model::stitch::{Degenerate, Stitch};
use rtl_model::strip::strip_count;
use rtl_model::{backface, clip, emit, evaluate, level};

/// The blocks of one pipeline and what they made of the patch before.
#[derive(Clone, Debug)]
pub(super) struct Pipeline<'a> {
    config: &'a Config,
    view: View,
    placement: Placement,
    evaluate: Evaluate,
    /// Vertices of the last patch.
    pub(super) vertices: Vec<Vertex>,
    /// Their screen positions, where the divide is on.
    pub(super) screen: Vec<Screen>,
    stitch: Stitch,
    degenerate: Degenerate,
    /// What became of the last patch.
    pub(super) work: Work,
    /// What all patches cost.
    pub(super) counters: Counters,
}

impl<'a> Pipeline<'a> {
    /// A pipeline for a frame.
    #[must_use]
    pub(super) fn new(config: &'a Config, view: View) -> Self {
        Self {
            config,
            view,
            placement: Placement::default(),
            evaluate: Evaluate::new(settings(config, view.position)),
            vertices: Vec::new(),
            screen: Vec::new(),
            stitch: Stitch::default(),
            degenerate: Degenerate::default(),
            work: Work::clipped(),
            counters: Counters::default(),
        }
    }

    /// Triangles of the last patch.
    #[must_use]
    pub(super) fn triangles(&self) -> &[Triangle] {
        self.stitch.triangles()
    }

    /// Takes a patch through all blocks. Returns whether anything is left of it.
    pub(super) fn accept(&mut self, patch: &Patch, state: &level::State) -> bool {
        self.screen.clear();
        self.work = Work::clipped();
        self.keeps(patch) && {
            self.place(patch, state);
            self.shape(patch);
            self.send();
            true
        }
    }

    /// Clip and backface.
    fn keeps(&mut self, patch: &Patch) -> bool {
        let counters = &mut self.counters;
        counters.add(Counter::ClipIn, 1);
        if self.config.clip.enabled && clip::outside(patch, self.view.depth) {
            counters.add(Counter::ClipCulled, 1);
            return false;
        }
        counters.add(Counter::BackfaceIn, 1);
        let method = self.config.backface.method;
        let (verdict, facets) = backface::accept(patch, &self.view, method);
        counters.add(Counter::BackfaceTested, u64::from(verdict != Verdict::Untested));
        counters.add(Counter::BackfaceFacets, facets.into());
        counters.add(Counter::BackfaceCulled, u64::from(verdict == Verdict::Culled));
        self.work.tested = verdict != Verdict::Untested;
        self.work.fate = if verdict == Verdict::Culled { Fate::Culled } else { Fate::Kept };
        verdict != Verdict::Culled
    }

    /// Level and place.
    fn place(&mut self, patch: &Patch, state: &level::State) {
        let (levels, events) = level::accept(patch, &self.view, state);
        self.placement.set(&levels);
        self.work.levels = chain::levels(state.criterion);
        self.work.reciprocals = self.placement.reciprocals() as u8; // at most 6
        self.work.segments = self.placement.segments();
        let [columns, rows] = self.placement.interior();
        let parameters = self.placement.boundary() + columns + rows;
        let counters = &mut self.counters;
        counters.add(Counter::LevelPatches, 1);
        match state.criterion {
            level::Criterion::Flatness { .. } => counters.add(Counter::LevelFlatness, 1),
            level::Criterion::EdgeLength { .. } => counters.add(Counter::LevelEdgeLength, 1),
            level::Criterion::Fixed { .. } => {}
        }
        counters.add(Counter::LevelClamped, events.clamped.into());
        counters.add(Counter::LevelNear, events.near.into());
        counters.add(Counter::LevelOverflows, events.overflows.into());
        counters.add(Counter::PlaceReciprocals, self.placement.reciprocals().into());
        counters.add(Counter::PlaceParameters, parameters as u64);
    }

    /// Evaluate and stitch.
    fn shape(&mut self, patch: &Patch) {
        let cost = self.evaluate.accept(patch, &self.placement, &mut self.vertices);
        let triangles = self.stitch.accept(&self.placement);
        let degenerate = self.degenerate.count(&self.placement, &self.vertices, triangles);
        let counters = &mut self.counters;
        counters.add(Counter::EvaluateInvocations, cost.invocations);
        counters.add(Counter::EvaluateVertices, self.vertices.len() as u64);
        counters.add(Counter::EvaluateStrips, strip_count(self.work.segments) as u64);
        counters.add(Counter::EvaluateCurves, cost.curves);
        counters.add(Counter::EvaluateSteps, cost.steps);
        counters.add(Counter::EvaluateOverflows, cost.overflows);
        counters.add(Counter::StitchTriangles, triangles.len() as u64);
        counters.add(Counter::StitchDegenerate, degenerate);
        if self.config.evaluate.normals == Normals::TangentPlane {
            let planes = self.vertices.iter().map(|v| evaluate::tangent_plane(patch, v.u, v.v));
            let degenerate = planes.filter(|plane| *plane == [0; 4]).count() as u64;
            counters.add(Counter::EvaluateNormals, self.vertices.len() as u64);
            counters.add(Counter::EvaluateNormalsDegenerate, degenerate);
        }
    }

    /// Emit, and the vertex shader's invocations.
    fn send(&mut self) {
        let (vertices, triangles) = (self.vertices.len() as u64, self.triangles().len() as u64);
        let (emit, shader) = (&self.config.emit, &self.config.vertex_shader);
        let counters = &mut self.counters;
        if emit.divide {
            let settings =
                emit::Settings { subpixel_bits: emit.subpixel_bits, rounding: emit.rounding };
            let homogeneous = emit::accept(&self.vertices, &self.view, settings, &mut self.screen);
            counters.add(Counter::EmitToClipper, homogeneous);
        }
        let indices = 3 * triangles * u64::from(emit.index_bytes);
        counters.add(Counter::EmitVertices, vertices);
        counters.add(Counter::EmitTriangles, triangles);
        counters.add(Counter::EmitBytes, vertices * u64::from(emit.vertex_bytes) + indices);
        let normal = match self.config.evaluate.normals {
            Normals::Off => 0,
            Normals::TangentPlane => shader.bytes_in_normal,
        };
        counters.add(Counter::VertexShaderInvocations, vertices);
        counters.add(Counter::VertexShaderBytesIn, vertices * u64::from(shader.bytes_in + normal));
        counters.add(Counter::VertexShaderBytesOut, vertices * u64::from(shader.bytes_out));
    }
}

fn settings(config: &Config, position: Format) -> evaluate::Settings {
    evaluate::Settings {
        position,
        guard: config.guard(),
        scheme: config.evaluate.scheme,
        rounding: config.evaluate.rounding,
        overflow: config.position.overflow,
    }
}

/// The tessellation state of a draw: the trace's, with what the configuration overrides.
///
/// Levels are quantised to UQ8.16, pixels to UQ16.16 with at least one ulp, both to the nearest.
#[must_use]
pub(super) fn state(trace: &level::State, config: &Config) -> level::State {
    use crate::config::Criterion as Name;
    let over = &config.level;
    let fx16 = |value: f64| (value * 65536.0).round_ties_even() as u64;
    let bound = |value: Option<f64>, other| value.map_or(other, |v| Level::clamped(fx16(v)));
    let pixels = || fx16(over.pixels.unwrap_or(0.5)).clamp(1, u32::MAX.into()) as u32;
    let criterion = match over.chosen() {
        None => trace.criterion,
        Some(Name::Flatness) => level::Criterion::Flatness { pixels: pixels() },
        Some(Name::EdgeLength) => level::Criterion::EdgeLength { pixels: pixels() },
        Some(Name::Fixed) => level::Criterion::Fixed { level: bound(over.level, Level::MIN) },
    };
    let max = bound(over.max_level, trace.max);
    // One of the bounds may come from the trace and the other from the configuration: the greatest
    // wins.
    level::State { criterion, min: bound(over.min_level, trace.min).min(max), max }
}
