//! Patches on their way through the unit: collected until a batch is full, quantised and
//! tessellated on all threads, handed to the sink in draw order.
//!
//! A batch is bounded, so memory does not grow with the trace; meshes are kept only where the sink
//! wants them, a wave of patches at a time. Patches that are only measured (`union`) go first: what
//! they ask for must be known before any patch of their instance is drawn, and they stand before
//! all of those.

mod pieces;
mod port;
mod timing;

use super::attributes::Corners;
use super::chain::Work as Done;
use super::clock::{Clock, Fetch};
use super::edges::{EdgeDatabase, Held};
use super::frame::FrameState;
use super::host::Hosted;
use super::pipeline::{Input, Make, Pipeline};
use super::union::{Pass, Share, Shared, Site};
use crate::config::Config;
use crate::error::Result;
use crate::sink::Sink;
use glam::Mat4;
use rayon::prelude::*;
use rtl_model::counter::{Counter, Counters};
use rtl_model::level::State;
use rtl_model::patch::{Patch, View};
use rtl_model::port::Quantised;
use std::ops::Range;
use std::sync::Arc;

use pieces::Pieces;
use timing::Timing;

pub(super) use pieces::add;

/// Patches of a full batch: 4 MB of points, and few enough batches that threads seldom wait.
pub(super) const PATCHES_MAX: usize = 4096;

/// Patches whose meshes are held at once: 64 of level 128 take 70 MB.
const WAVE: usize = 64;

/// Patches that a thread takes at a time.
const GRAIN: usize = 16;

/// A patch whose points stand in the batch.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// Number within the frame.
    pub(super) id: u32,
    /// Its sixteen points, as indices into the batch.
    pub(super) indices: [u32; 16],
    /// Its corners in the draw's attributes.
    corners: [u32; 4],
    /// Its draw, as an index into the batch.
    pub(super) draw: u32,
    /// What brings its points.
    fetch: Fetch,
    /// Where it is in its primitive.
    site: Site,
}

/// A command that crosses the link among the patches.
#[derive(Clone, Copy, Debug)]
struct Sent {
    /// Patches of the batch before it.
    before: usize,
    payload: u64,
    written: u64,
}

/// What the patches of a draw share.
#[derive(Clone, Debug)]
pub(super) struct DrawState {
    /// Number of the draw within the frame.
    pub(super) number: u32,
    /// Back-facing patches may be removed.
    pub(super) cull: bool,
    /// The front is where Su x Sv does not point.
    pub(super) reversed: bool,
    /// Tessellation state.
    pub(super) state: State,
    /// Takes a vertex to world space, column-major.
    pub(super) to_world: [f64; 16],
    /// What a host that tessellates knows of its instance.
    pub(super) hosted: Hosted,
    /// The attributes of its corners.
    pub(super) attributes: Option<Arc<Corners>>,
    /// Rows and columns of patches, where they share edges.
    pub(super) edges: Option<(u64, u64)>,
    /// What its patches share, where their lists are unified.
    pub(super) shared: Option<Shared>,
    /// Bytes that a hull shader hands on for a patch (unit `d3d11`).
    pub(super) hull_bytes: u32,
    /// The level that the driver chose for it, where it does (unit `esc`).
    pub(super) object_level: Option<u8>,
}

impl DrawState {
    /// What a pipeline is told of each of its patches, without the patch itself.
    fn input<'a>(
        &'a self,
        patch: &'a Patch,
        shaded: &'a [[f32; 4]; 16],
        view: &'a View,
    ) -> Input<'a> {
        Input {
            patch,
            seen: patch,
            shaded,
            state: &self.state,
            share: None,
            components: self.attributes.as_ref().map_or(0, |a| a.table.components() as u64),
            hull_bytes: self.hull_bytes,
            object: None,
            view,
            object_level: self.object_level,
        }
    }

    fn measures(&self) -> bool {
        self.shared.as_ref().is_some_and(|shared| shared.pass == Pass::Measure)
    }
}

/// Vertices and triangles that came of one draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Number of the draw within the frame.
    pub(super) draw: u32,
    /// Vertices.
    pub(super) vertices: u64,
    /// Triangles.
    pub(super) triangles: u64,
}

/// Points under one matrix.
#[derive(Clone, Debug)]
struct Span {
    clip_from_object: Mat4,
    points: Range<usize>,
    /// How many of the first points were received, and counted, before.
    repeated: usize,
}

/// Patches that wait to be tessellated.
#[derive(Clone, Debug, Default)]
pub(super) struct Batch {
    points: Vec<[f32; 4]>,
    /// Points after the control-point shader: more than `points` where instances share them.
    shaded: usize,
    quantised: Vec<Quantised>,
    /// The same points in clip space, where the unit works in object space: what the driver sees.
    seen: Vec<Quantised>,
    /// The same points in object space, where the unit wants them too.
    object: Vec<Quantised>,
    /// The same points as the shaders have them, where the unit goes on in f32.
    clip: Vec<[f32; 4]>,
    spans: Vec<Span>,
    patches: Vec<Pending>,
    draws: Vec<DrawState>,
    commands: Vec<Sent>,
    edges: EdgeDatabase,
}

impl Batch {
    /// Whether nothing waits.
    #[must_use]
    pub(super) fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    /// A command of `payload` bytes, of which memory gets `written` in bursts, is sent behind the
    /// patches so far. Returns whether there is room for another.
    pub(super) fn command(&mut self, payload: u64, written: u64) -> bool {
        self.commands.push(Sent { before: self.patches.len(), payload, written });
        self.commands.len() < PATCHES_MAX
    }

    /// Patches that still fit.
    #[must_use]
    pub(super) fn room(&self) -> usize {
        PATCHES_MAX - self.patches.len()
    }

    /// Adds a draw; its patches follow.
    pub(super) fn draw(&mut self, draw: DrawState) {
        self.draws.push(draw);
    }

    /// Adds points under a matrix, of which the first `repeated` were received before.
    pub(super) fn points(&mut self, clip_from_object: Mat4, points: &[[f32; 4]], repeated: usize) {
        let first = self.points.len();
        self.points.extend_from_slice(points);
        self.span(Span { clip_from_object, points: first..self.points.len(), repeated });
    }

    /// Adds the points of earlier spans again, under another matrix. Returns the index of the
    /// first.
    pub(super) fn again(&mut self, clip_from_object: Mat4, spans: Range<usize>) -> u32 {
        let first = self.shaded as u32;
        for k in spans {
            let span = Span { clip_from_object, ..self.spans[k].clone() };
            self.span(span);
        }
        first
    }

    fn span(&mut self, span: Span) {
        self.shaded += span.points.len();
        self.spans.push(span);
    }

    /// The index that the next point will have.
    pub(super) fn next_point(&self) -> u32 {
        self.shaded as u32
    }

    /// Spans so far.
    pub(super) fn spans(&self) -> usize {
        self.spans.len()
    }

    /// Adds a patch of the draw that was added last.
    pub(super) fn patch(
        &mut self,
        id: u32,
        site: Site,
        indices: [u32; 16],
        corners: [u32; 4],
        fetch: Fetch,
    ) {
        let draw = self.draws.len() as u32 - 1;
        self.patches.push(Pending { id, indices, corners, draw, fetch, site });
    }

    /// Tessellates what waits and empties the batch. Returns vertices and triangles by draw.
    ///
    /// # Errors
    /// The sink's.
    pub(super) fn flush<M: Make>(
        &mut self,
        config: &Config,
        frame: &FrameState,
        sink: Option<&mut dyn Sink>,
        counters: &mut Counters,
        clock: &mut Clock<M::Lists>,
    ) -> Result<Vec<Tally>> {
        self.quantise(config, frame, counters);
        let mut edges = std::mem::take(&mut self.edges);
        let taps = sink.as_ref().is_some_and(|sink| sink.taps());
        let mut work = Work::<M> { batch: self, config, frame, taps, measured: Vec::new() };
        work.measure(counters);
        let (batch, edges_now) = (&*self, &mut edges);
        let mut timed = Timing::new(batch, config, clock, edges_now);
        let tallies = match sink {
            None => work.count(counters, &mut timed),
            Some(sink) => work.stream(sink, counters, &mut timed)?,
        };
        timed.finish();
        let Held { shared, entries } = timed.held;
        counters.merge(&timed.waves.counters);
        counters.add(Counter::EvaluateShared, shared);
        counters.add(Counter::EvaluateHeldPeak, entries);
        self.edges = edges;
        self.commands.clear();
        self.points.clear();
        self.shaded = 0;
        self.spans.clear();
        self.patches.clear();
        self.draws.clear();
        Ok(tallies)
    }
}

/// A batch whose points are quantised.
struct Work<'a, M: Make> {
    batch: &'a Batch,
    config: &'a Config,
    frame: &'a FrameState,
    /// Whether the sink sees the patches themselves.
    taps: bool,
    /// What became of the patches that are only measured, patch by patch; empty where none is.
    measured: Vec<Option<Done<M::Lists>>>,
}

impl<M: Make> Work<'_, M> {
    /// The patches that are only measured, before all others.
    fn measure(&mut self, counters: &mut Counters) {
        let Batch { patches, draws, .. } = self.batch;
        if !draws.iter().any(DrawState::measures) {
            return;
        }
        let measure = |pipeline: &mut Pipeline<'_, M>, part: &[Pending]| {
            let one = |pending: &Pending| {
                let draw = &draws[pending.draw as usize];
                let shared = draw.shared.as_ref().filter(|_| draw.measures())?;
                let patch = self.gather(pending, draw, &self.batch.quantised);
                let share = Some(Share { shared, site: pending.site });
                let view = &self.frame.view;
                let input = Input { share, ..draw.input(&patch, &[[0.0; 4]; 16], view) };
                pipeline.measure(&input);
                Some(pipeline.work)
            };
            let done: Vec<_> = part.iter().map(one).collect();
            (done, std::mem::take(&mut pipeline.counters))
        };
        let parts: Vec<_> =
            patches.par_chunks(GRAIN).map_init(|| self.pipeline(), measure).collect();
        let mut measured = Vec::with_capacity(patches.len());
        for (done, part) in parts {
            measured.extend(done);
            counters.merge(&part);
        }
        self.measured = measured;
    }

    /// Counters only.
    fn count(&self, counters: &mut Counters, timed: &mut Timing<'_, M::Lists>) -> Vec<Tally> {
        let all = &self.batch.patches;
        let parts: Vec<Pieces<M::Lists>> = all
            .par_chunks(GRAIN)
            .enumerate()
            .map_init(|| self.pipeline(), |p, (k, part)| self.run(p, k * GRAIN, part, false))
            .collect();
        let mut tallies = Vec::new();
        for part in parts {
            timed.patches(&part.done);
            part.account(counters, &mut tallies);
        }
        tallies
    }

    /// Counters and meshes.
    fn stream(
        &self,
        sink: &mut dyn Sink,
        counters: &mut Counters,
        timed: &mut Timing<'_, M::Lists>,
    ) -> Result<Vec<Tally>> {
        let mut tallies = Vec::new();
        for (n, wave) in self.batch.patches.chunks(WAVE).enumerate() {
            let first = |k: usize| n * WAVE + k * GRAIN;
            let parts: Vec<Pieces<M::Lists>> = wave
                .par_chunks(GRAIN)
                .enumerate()
                .map_init(|| self.pipeline(), |p, (k, part)| self.run(p, first(k), part, true))
                .collect();
            for part in parts {
                part.send(sink)?;
                timed.patches(&part.done);
                part.account(counters, &mut tallies);
            }
        }
        Ok(tallies)
    }

    fn pipeline(&self) -> Pipeline<'_, M> {
        Pipeline::new(self.config, self.frame)
    }

    /// Some patches that stand together, from the batch's patch `first` on.
    fn run(
        &self,
        pipeline: &mut Pipeline<'_, M>,
        first: usize,
        patches: &[Pending],
        keep: bool,
    ) -> Pieces<M::Lists> {
        let mut pieces = Pieces::default();
        for (number, pending) in (first..).zip(patches) {
            if let Some(&Some(measured)) = self.measured.get(number) {
                pieces.done.push(measured);
                continue;
            }
            let draw = &self.batch.draws[pending.draw as usize];
            let share = draw.shared.as_ref().map(|shared| Share { shared, site: pending.site });
            let patch = self.gather(pending, draw, &self.batch.quantised);
            let batch = self.batch;
            let seen = (!batch.seen.is_empty()).then(|| self.gather(pending, draw, &batch.seen));
            let seen = seen.as_ref().unwrap_or(&patch);
            let shaded = pending.indices.map(|i| batch.clip.get(i as usize).copied());
            let shaded = shaded.map(Option::unwrap_or_default);
            let object = (!batch.object.is_empty())
                .then(|| pending.indices.map(|i| batch.object[i as usize].point));
            let input = Input {
                seen,
                share,
                object: object.as_ref(),
                ..draw.input(&patch, &shaded, &self.frame.view)
            };
            if keep && self.taps {
                pieces.arrived.push(input.arrived());
            }
            if pipeline.accept(&input) {
                pieces.tally(draw.number, pipeline);
                if keep {
                    pieces.keep(pending, draw, pipeline, self.config.attributes.rounding);
                }
            }
            pieces.done.push(pipeline.work);
        }
        pieces.counters = std::mem::take(&mut pipeline.counters);
        pieces
    }

    fn gather(&self, pending: &Pending, draw: &DrawState, points: &[Quantised]) -> Patch {
        let points = pending.indices.map(|i| points[i as usize]);
        Patch {
            id: pending.id,
            points: points.map(|q| q.point),
            saturated: points.iter().any(|q| q.overflows > 0),
            cull: draw.cull,
            reversed: draw.reversed,
        }
    }
}
