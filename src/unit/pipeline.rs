//! Pipeline: one patch in, its vertices, screen positions and triangles out: what the units that
//! tessellate have in common, around what each has of its own (`Front`).
//!
//! ```text
//!   patch ─► [clip ─► backface ─► level ─► place] ─► evaluate ─► stitch ─► emit ─► vertex shader
//!             a front's own: which of these, how
//! ```

use super::chain::{Fate, Work};
use super::frame::FrameState;
use super::union::{Pass, Share};
use crate::config::{Config, Normals};
use rtl_model::backface::{self, Verdict};
use rtl_model::clip;
use rtl_model::counter::{Counter, Counters};
use rtl_model::emit::{self, Screen};
use rtl_model::evaluate::{self, Evaluate};
use rtl_model::level::{Criterion, Events, State};
use rtl_model::number::Format;
use rtl_model::patch::{Patch, Triangle, Vertex, View};
use rtl_model::place::{Numbering, Parameters, Placement};
use rtl_model::stitch::{Degenerate, Stitch};
use rtl_model::strip::Topology;

/// What a unit has of its own between the port and the evaluation of points.
pub(super) trait Front: Send + Sync + 'static {
    /// What the triangles of a patch depend on.
    type Lists: Topology + 'static;
    /// The parameters along one direction.
    type List: Parameters + Send;
    /// Whether patches are clipped and culled.
    const CULLS: bool;

    /// Chooses levels, places the vertices, and says what its blocks did for it.
    fn place(work: Placing<'_>, placement: &mut Placement<Self::List>) -> Placed<Self::Lists>;
}

/// What levels are chosen from.
pub(super) struct Placing<'a> {
    pub(super) config: &'a Config,
    pub(super) view: &'a View,
    pub(super) patch: &'a Patch,
    pub(super) state: &'a State,
    /// Its part in its primitive's unions, where it has one.
    pub(super) share: Option<Share<'a>>,
}

/// What became of it.
pub(super) struct Placed<T> {
    pub(super) lists: T,
    pub(super) events: Events,
    /// What the level block does one after another; 0 where it has done it before.
    pub(super) levels: u16,
    /// Reciprocals formed.
    pub(super) reciprocals: u8,
}

/// The blocks of one pipeline and what they made of the patch before.
pub(super) struct Pipeline<'a, F: Front> {
    config: &'a Config,
    view: View,
    placement: Placement<F::List>,
    evaluate: Evaluate,
    /// Vertices of the last patch.
    pub(super) vertices: Vec<Vertex>,
    /// Their screen positions, where the divide is on.
    pub(super) screen: Vec<Screen>,
    stitch: Stitch<F::Lists>,
    degenerate: Degenerate,
    /// What became of the last patch.
    pub(super) work: Work<F::Lists>,
    /// What all patches cost.
    pub(super) counters: Counters,
}

impl<'a, F: Front> Pipeline<'a, F> {
    /// A pipeline for a frame.
    #[must_use]
    pub(super) fn new(config: &'a Config, frame: &FrameState) -> Self {
        Self {
            config,
            view: frame.view,
            placement: Placement::default(),
            evaluate: Evaluate::new(settings(config, frame.position(config))),
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

    /// Takes a patch through all blocks. Its levels are chosen from `seen`: the patch itself, but
    /// where they come from before the unit. Returns whether anything is left of it.
    pub(super) fn accept(
        &mut self,
        patch: &Patch,
        seen: &Patch,
        state: &State,
        share: Option<Share<'_>>,
    ) -> bool {
        self.screen.clear();
        self.work = Work::clipped();
        if F::CULLS && !self.keeps(patch) {
            return false;
        }
        self.work.fate = Fate::Kept;
        self.place(seen, state, share);
        self.shape(patch);
        self.send();
        true
    }

    /// Takes a patch as far as its lists, which go into the unions of its primitive.
    pub(super) fn measure(&mut self, patch: &Patch, state: &State, share: Share<'_>) {
        self.work = Work::clipped();
        if F::CULLS && !self.keeps(patch) {
            let clipped = self.work.fate == Fate::Clipped;
            let culled = if clipped { Counter::ClipMeasured } else { Counter::BackfaceMeasured };
            self.counters.add(culled, 1);
            return;
        }
        self.work.fate = Fate::Measured;
        self.place(patch, state, Some(share));
        self.counters.add(Counter::PlaceMeasured, 1);
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
        self.work.fate = Fate::Culled;
        verdict != Verdict::Culled
    }

    /// Level and place.
    fn place(&mut self, patch: &Patch, state: &State, share: Option<Share<'_>>) {
        let Self { config, view, .. } = self;
        let placing = Placing { config, view, patch, state, share };
        let placed = F::place(placing, &mut self.placement);
        self.work.levels = placed.levels;
        self.work.reciprocals = placed.reciprocals;
        self.work.lists = placed.lists;
        let pass = share.map(|share| share.shared.pass);
        if pass != Some(Pass::Draw) {
            self.count_levels(state.criterion, placed.events);
        }
        if pass != Some(Pass::Measure) {
            let [columns, rows] = placed.lists.interior();
            let parameters = placed.lists.boundary() + columns + rows;
            self.counters.add(Counter::PlaceReciprocals, placed.reciprocals.into());
            self.counters.add(Counter::PlaceParameters, parameters as u64);
        }
    }

    fn count_levels(&mut self, criterion: Criterion, events: Events) {
        let counters = &mut self.counters;
        counters.add(Counter::LevelPatches, 1);
        match criterion {
            Criterion::Flatness { .. } => counters.add(Counter::LevelFlatness, 1),
            Criterion::EdgeLength { .. } => counters.add(Counter::LevelEdgeLength, 1),
            Criterion::Fixed { .. } => {}
        }
        counters.add(Counter::LevelSplits, events.splits.into());
        counters.add(Counter::LevelClamped, events.clamped.into());
        counters.add(Counter::LevelNear, events.near.into());
        counters.add(Counter::LevelOverflows, events.overflows.into());
    }

    /// Evaluate and stitch.
    fn shape(&mut self, patch: &Patch) {
        let cost = self.evaluate.accept(patch, &self.placement, &mut self.vertices);
        let triangles = self.stitch.accept(self.work.lists);
        let degenerate = self.degenerate.count(&self.work.lists, &self.vertices, triangles);
        let counters = &mut self.counters;
        counters.add(Counter::EvaluateInvocations, cost.invocations);
        counters.add(Counter::EvaluateVertices, self.vertices.len() as u64);
        counters.add(Counter::EvaluateStrips, self.work.lists.strip_count() as u64);
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
        if self.config.divides() {
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
        scheme: config.scheme(),
        rounding: config.evaluate.rounding,
        overflow: config.position.overflow,
    }
}
