//! Patches on their way through the unit: collected until a batch is full, quantised and
//! tessellated on all threads, handed to the sink in draw order.
//!
//! A batch is bounded, so memory does not grow with the trace; meshes are kept only where the sink
//! wants them, a wave of patches at a time. Patches that are only measured (`union`) go first: what
//! they ask for must be known before any patch of their instance is drawn, and they stand before
//! all of those.

mod pieces;

use super::attributes::Corners;
use super::chain::Work as Done;
use super::clock::{Clock, Fetch};
use super::frame::FrameState;
use super::pipeline::{Front, Pipeline};
use super::union::{Pass, Share, Shared, Site};
use crate::config::Config;
use crate::error::Result;
use crate::shader::control_point;
use crate::sink::Sink;
use glam::Mat4;
use rayon::prelude::*;
use rtl_model::counter::{Counter, Counters};
use rtl_model::level::State;
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::patch::Patch;
use rtl_model::port::{self, Quantised};
use rtl_model::strip::Topology;
use std::ops::Range;
use std::sync::Arc;

use pieces::Pieces;

pub(super) use pieces::add;

/// Patches of a full batch: 4 MB of points, and few enough batches that threads seldom wait.
pub(super) const PATCHES_MAX: usize = 4096;

/// Patches whose meshes are held at once: 64 of level 128 take 70 MB.
const WAVE: usize = 64;

/// Patches that a thread takes at a time.
const GRAIN: usize = 16;

/// Points in a piece of work, at most: a span may have all points of a large draw.
const POINT_GRAIN: usize = 512;

/// Pieces of points that a thread takes at a time, at least: a span may have a line of a mesh only.
const WORK_GRAIN: usize = 4;

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
    /// Bytes of a vertex on the link, where the host tessellates.
    pub(super) vertex_bytes: u64,
    /// The attributes of its corners.
    pub(super) attributes: Option<Arc<Corners>>,
    /// What its patches share, where their lists are unified.
    pub(super) shared: Option<Shared>,
}

impl DrawState {
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
    spans: Vec<Span>,
    patches: Vec<Pending>,
    draws: Vec<DrawState>,
    commands: Vec<Sent>,
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
    pub(super) fn flush<F: Front>(
        &mut self,
        config: &Config,
        frame: &FrameState,
        sink: Option<&mut dyn Sink>,
        counters: &mut Counters,
        clock: &mut Clock<F::Lists>,
    ) -> Result<Vec<Tally>> {
        self.quantise(config, frame, counters);
        let mut work = Work::<F> { batch: self, config, frame, measured: Vec::new() };
        work.measure(counters);
        let mut timed = Timing { batch: self, clock, patches: 0, commands: 0 };
        let tallies = match sink {
            None => work.count(counters, &mut timed),
            Some(sink) => work.stream(sink, counters, &mut timed)?,
        };
        timed.commands();
        self.commands.clear();
        self.points.clear();
        self.shaded = 0;
        self.spans.clear();
        self.patches.clear();
        self.draws.clear();
        Ok(tallies)
    }

    /// Control-point shader and port, on all threads.
    fn quantise(&mut self, config: &Config, frame: &FrameState, counters: &mut Counters) {
        let mut quantised = std::mem::take(&mut self.quantised);
        let [points, overflows, saturated] = if config.unit.in_object_space() {
            let mut seen = std::mem::take(&mut self.seen);
            self.port(config, frame.view.position, true, &mut seen);
            self.seen = seen;
            self.port(config, frame.object, false, &mut quantised)
        } else {
            self.port(config, frame.view.position, true, &mut quantised)
        };
        self.quantised = quantised;
        counters.add(Counter::PortPoints, points);
        counters.add(Counter::PortOverflows, overflows);
        counters.add(Counter::PortSaturated, saturated);
    }

    /// Quantises all points, transformed or as they are. Returns points received, coordinates that
    /// did not fit, points with such a coordinate.
    fn port(
        &self,
        config: &Config,
        format: Format,
        transformed: bool,
        out: &mut Vec<Quantised>,
    ) -> [u64; 3] {
        out.resize(self.shaded, Quantised { point: [0; 4], overflows: 0 });
        let mut rest = &mut out[..];
        let mut works = Vec::with_capacity(self.spans.len());
        for span in &self.spans {
            let (out, after) = rest.split_at_mut(span.points.len());
            rest = after;
            let pieces = self.points[span.points.clone()].chunks(POINT_GRAIN);
            for (k, (points, out)) in pieces.zip(out.chunks_mut(POINT_GRAIN)).enumerate() {
                let repeated = span.repeated.saturating_sub(k * POINT_GRAIN).min(out.len());
                let matrix = transformed.then_some(&span.clip_from_object);
                works.push(PortWork { matrix, points, repeated, format, out });
            }
        }
        let (rounding, overflow) = (config.position.rounding, config.position.overflow);
        let port = |work| dispatch(rounding, overflow, work);
        let counts = works.into_par_iter().with_min_len(WORK_GRAIN).map(port);
        counts.reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

struct PortWork<'a> {
    /// What the control-point shader transforms with; `None` where there is none.
    matrix: Option<&'a Mat4>,
    points: &'a [[f32; 4]],
    /// How many of the first points were received, and counted, before.
    repeated: usize,
    format: Format,
    out: &'a mut [Quantised],
}

impl Modal for PortWork<'_> {
    /// Points received, coordinates that did not fit, points with such a coordinate.
    type Output = [u64; 3];

    fn run<R: RoundingMode, O: OverflowMode>(self) -> [u64; 3] {
        for (out, &point) in self.out.iter_mut().zip(self.points) {
            let point = self.matrix.map_or(point, |m| control_point::transform(m, point));
            *out = port::accept::<R, O>(point.map(f32::to_bits), self.format);
        }
        let received = &self.out[self.repeated..];
        let overflows = received.iter().map(|q| u64::from(q.overflows)).sum();
        let saturated = received.iter().filter(|q| q.overflows > 0).count();
        [received.len() as u64, overflows, saturated as u64]
    }
}

/// Puts patches and commands on the clock, in the order of the trace.
struct Timing<'a, T: Topology> {
    batch: &'a Batch,
    clock: &'a mut Clock<T>,
    patches: usize,
    commands: usize,
}

impl<T: Topology> Timing<'_, T> {
    fn patches(&mut self, done: &[Done<T>]) {
        for &work in done {
            self.commands();
            let patch = &self.batch.patches[self.patches];
            let vertex_bytes = self.batch.draws[patch.draw as usize].vertex_bytes;
            self.clock.patch(patch.fetch, work, vertex_bytes);
            self.patches += 1;
        }
    }

    /// Those that come before the next patch.
    fn commands(&mut self) {
        while let Some(command) = self.batch.commands.get(self.commands)
            && command.before <= self.patches
        {
            self.clock.command(command.payload, command.written);
            self.commands += 1;
        }
    }
}

/// A batch whose points are quantised.
struct Work<'a, F: Front> {
    batch: &'a Batch,
    config: &'a Config,
    frame: &'a FrameState,
    /// What became of the patches that are only measured, patch by patch; empty where none is.
    measured: Vec<Option<Done<F::Lists>>>,
}

impl<F: Front> Work<'_, F> {
    /// The patches that are only measured, before all others.
    fn measure(&mut self, counters: &mut Counters) {
        let Batch { patches, draws, .. } = self.batch;
        if !draws.iter().any(DrawState::measures) {
            return;
        }
        let measure = |pipeline: &mut Pipeline<'_, F>, part: &[Pending]| {
            let one = |pending: &Pending| {
                let draw = &draws[pending.draw as usize];
                let shared = draw.shared.as_ref().filter(|_| draw.measures())?;
                let patch = self.gather(pending, draw, &self.batch.quantised);
                pipeline.measure(&patch, &draw.state, Share { shared, site: pending.site });
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
    fn count(&self, counters: &mut Counters, timed: &mut Timing<'_, F::Lists>) -> Vec<Tally> {
        let all = &self.batch.patches;
        let parts: Vec<Pieces<F::Lists>> = all
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
        timed: &mut Timing<'_, F::Lists>,
    ) -> Result<Vec<Tally>> {
        let mut tallies = Vec::new();
        for (n, wave) in self.batch.patches.chunks(WAVE).enumerate() {
            let first = |k: usize| n * WAVE + k * GRAIN;
            let parts: Vec<Pieces<F::Lists>> = wave
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

    fn pipeline(&self) -> Pipeline<'_, F> {
        Pipeline::new(self.config, self.frame)
    }

    /// Some patches that stand together, from the batch's patch `first` on.
    fn run(
        &self,
        pipeline: &mut Pipeline<'_, F>,
        first: usize,
        patches: &[Pending],
        keep: bool,
    ) -> Pieces<F::Lists> {
        let mut pieces = Pieces::default();
        for (number, pending) in (first..).zip(patches) {
            if let Some(&Some(measured)) = self.measured.get(number) {
                pieces.done.push(measured);
                continue;
            }
            let draw = &self.batch.draws[pending.draw as usize];
            let share = draw.shared.as_ref().map(|shared| Share { shared, site: pending.site });
            let patch = self.gather(pending, draw, &self.batch.quantised);
            let seen =
                (!self.batch.seen.is_empty()).then(|| self.gather(pending, draw, &self.batch.seen));
            let seen = seen.as_ref().unwrap_or(&patch);
            if pipeline.accept(&patch, seen, &draw.state, share) {
                pieces.tally(draw.number, pipeline);
                let attributes = draw.attributes.as_deref();
                if let Some(attributes) = attributes {
                    attributes.count(self.config, pipeline);
                }
                if keep {
                    pieces.keep(pending, draw, pipeline);
                    let rounding = self.config.attributes.rounding;
                    if let Some(attributes) = attributes {
                        attributes.interpolate(
                            pending.corners,
                            &pipeline.vertices,
                            rounding,
                            &mut pieces.attributes,
                        );
                    }
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
