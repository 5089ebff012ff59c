//! Pipeline: one patch in, its vertices, screen positions and triangles out: what all units have in
//! common around what each makes of a patch (`Make`).
//!
//! ```text
//!   patch ─► clip ─► backface ─► [levels, points, triangles] ─► emit ─► vertex shader
//!                                 `surface`, `d3d11` or `esc`
//! ```

use super::chain::{Fate, Flow, Work};
use super::frame::FrameState;
use super::union::{Pass, Share};
use crate::config::{Config, Normals};
use crate::sink::Arrived;
use rtl_model::backface::{self, Verdict};
use rtl_model::clip;
use rtl_model::counter::{Counter, Counters};
use rtl_model::emit::{self, Screen};
use rtl_model::level::{Criterion, Events, State};
use rtl_model::patch::{Patch, Point, Triangle, Vertex, View};

/// What a unit makes of a patch that is in sight.
pub(super) trait Make: Send + 'static {
    /// What the triangles of a patch depend on.
    type Lists: Flow;
    /// Whether patches are clipped and culled.
    const CULLS: bool;

    /// The blocks of a frame.
    fn new(config: &Config, frame: &FrameState) -> Self;

    /// What is known of a patch before it is placed.
    fn enter(&self, _input: &Input<'_>) -> Self::Lists {
        Self::Lists::default()
    }

    /// Counts a patch that is culled, where the unit does that itself.
    fn cull(&self, _counters: &mut Counters) {}

    /// Chooses levels and places the vertices.
    fn place(&mut self, work: Placing<'_>, counters: &mut Counters) -> Placed<Self::Lists>;

    /// Evaluates the vertices of the patch that was placed last, and joins them. Returns how many
    /// leave for emit.
    fn shape(
        &mut self,
        lists: &mut Self::Lists,
        input: &Input<'_>,
        vertices: &mut Vec<Vertex>,
        counters: &mut Counters,
    ) -> u64;

    /// Triangles of the last patch.
    fn triangles(&self) -> &[Triangle];

    /// Whether triangles leave as indices, and not as strips of vertices.
    fn is_indexed(&self) -> bool {
        true
    }
}

/// A patch, and what its draw says of it.
#[derive(Clone, Copy)]
pub(super) struct Input<'a> {
    /// What the unit works on.
    pub(super) patch: &'a Patch,
    /// What levels are chosen from: the same, but where they come from before the unit.
    pub(super) seen: &'a Patch,
    /// Its control points in clip space as the shaders have them, where a unit goes on in f32.
    pub(super) shaded: &'a [[f32; 4]; 16],
    pub(super) state: &'a State,
    /// Its part in its primitive's unions, where it has one.
    pub(super) share: Option<Share<'a>>,
    /// Components of the attributes of a vertex.
    pub(super) components: u64,
    /// Bytes that a hull shader hands on for it.
    pub(super) hull_bytes: u32,
    /// Its control points in object space, where a unit wants them beside those in clip space.
    pub(super) object: Option<&'a [Point; 16]>,
    /// The frame's camera.
    pub(super) view: &'a View,
    /// The level of resolution that the driver chose for all of its draw (unit `esc`).
    pub(super) object_level: Option<u8>,
}

impl Input<'_> {
    /// What a sink is told of it.
    pub(super) fn arrived(&self) -> Arrived {
        let elsewhere = !std::ptr::eq(self.patch, self.seen);
        Arrived {
            patch: *self.patch,
            seen: elsewhere.then_some(*self.seen),
            shaded: *self.shaded,
            object: self.object.copied(),
            object_level: self.object_level,
            state: *self.state,
            components: self.components as u32, // of a vertex: a few
            hull_bytes: self.hull_bytes,
        }
    }
}

/// What levels are chosen from.
pub(super) struct Placing<'a> {
    pub(super) config: &'a Config,
    pub(super) input: &'a Input<'a>,
}

/// What became of it.
pub(super) struct Placed<T> {
    pub(super) lists: T,
    pub(super) events: Events,
    /// By which the level block computed; `Fixed` where it computed nothing.
    pub(super) criterion: Criterion,
    /// What the level block does one after another; 0 where it has done it before.
    pub(super) levels: u16,
    /// Reciprocals formed.
    pub(super) reciprocals: u8,
}

/// The blocks of one pipeline and what they made of the patch before.
pub(super) struct Pipeline<'a, M: Make> {
    config: &'a Config,
    view: View,
    make: M,
    /// Vertices of the last patch.
    pub(super) vertices: Vec<Vertex>,
    /// Their screen positions, where the divide is on.
    pub(super) screen: Vec<Screen>,
    /// What became of the last patch.
    pub(super) work: Work<M::Lists>,
    /// What all patches cost.
    pub(super) counters: Counters,
}

impl<'a, M: Make> Pipeline<'a, M> {
    /// A pipeline for a frame.
    #[must_use]
    pub(super) fn new(config: &'a Config, frame: &FrameState) -> Self {
        Self {
            config,
            view: frame.view,
            make: M::new(config, frame),
            vertices: Vec::new(),
            screen: Vec::new(),
            work: Work::clipped(M::Lists::default()),
            counters: Counters::default(),
        }
    }

    /// Triangles of the last patch.
    #[must_use]
    pub(super) fn triangles(&self) -> &[Triangle] {
        self.make.triangles()
    }

    /// Takes a patch through all blocks. Returns whether anything is left of it.
    pub(super) fn accept(&mut self, input: &Input<'_>) -> bool {
        self.screen.clear();
        self.work = Work::clipped(self.make.enter(input));
        if M::CULLS && self.config.culls_patches() && !self.keeps(input.patch) {
            self.make.cull(&mut self.counters);
            return false;
        }
        self.work.fate = Fate::Kept;
        self.place(input);
        let lists = &mut self.work.lists;
        let leave = self.make.shape(lists, input, &mut self.vertices, &mut self.counters);
        self.send(leave, input.components);
        true
    }

    /// Takes a patch as far as its lists, which go into the unions of its primitive.
    pub(super) fn measure(&mut self, input: &Input<'_>) {
        self.work = Work::clipped(self.make.enter(input));
        if M::CULLS && !self.keeps(input.patch) {
            let clipped = self.work.fate == Fate::Clipped;
            let culled = if clipped { Counter::ClipMeasured } else { Counter::BackfaceMeasured };
            self.counters.add(culled, 1);
            return;
        }
        self.work.fate = Fate::Measured;
        self.place(input);
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

    /// Levels and places.
    fn place(&mut self, input: &Input<'_>) {
        let placing = Placing { config: self.config, input };
        let placed = self.make.place(placing, &mut self.counters);
        self.work.levels = placed.levels;
        self.work.reciprocals = placed.reciprocals;
        self.work.lists = placed.lists;
        if input.share.map(|share| share.shared.pass) != Some(Pass::Draw) {
            self.count_levels(placed.criterion, placed.events);
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

    /// Emit, with so many vertices, and the vertex shader's invocations.
    fn send(&mut self, vertices: u64, components: u64) {
        let triangles = self.triangles().len() as u64;
        let (emit, shader) = (&self.config.emit, &self.config.vertex_shader);
        let counters = &mut self.counters;
        if self.config.divides() {
            let settings =
                emit::Settings { subpixel_bits: emit.subpixel_bits, rounding: emit.rounding };
            let homogeneous = emit::accept(&self.vertices, &self.view, settings, &mut self.screen);
            counters.add(Counter::EmitToClipper, homogeneous);
        }
        let indexed = u64::from(self.make.is_indexed());
        let indices = 3 * triangles * indexed * u64::from(emit.index_bytes);
        let attributes = vertices * components * self.config.attributes.component_bytes();
        let bytes = vertices * u64::from(emit.vertex_bytes) + attributes + indices;
        counters.add(Counter::EmitVertices, vertices);
        counters.add(Counter::EmitTriangles, triangles);
        counters.add(Counter::EmitAttributeBytes, attributes);
        counters.add(Counter::EmitBytes, bytes);
        let unit = self.config.unit;
        // Which vertices are shaded depends on the patches before, where the host tessellates.
        if !unit.has_vertex_shader() || unit.host_tessellates() {
            return;
        }
        let normal = match self.config.evaluate.normals {
            Normals::Off => 0,
            Normals::TangentPlane => shader.bytes_in_normal,
        };
        let bytes = vertices * u64::from(shader.bytes_in + normal) + attributes;
        counters.add(Counter::VertexShaderInvocations, vertices);
        counters.add(Counter::VertexShaderBytesIn, bytes);
        counters.add(Counter::VertexShaderBytesOut, vertices * u64::from(shader.bytes_out));
    }
}
