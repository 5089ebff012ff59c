//! A run: carries out the commands of a trace, frame by frame.

use super::batch::{self, Batch, DrawState, Tally};
use super::clock::{Clock, Fetch, Recording};
use super::frame::FrameState;
use super::{blocks, chain, hybrid, work};
use crate::config::{Config, Unit};
use crate::error::{Error, Result};
use crate::link::{self, Transfer};
use crate::report::{Frame as FrameReport, Report};
use crate::shader::control_point;
use crate::sink::{FrameInfo, Sink};
use crate::trace::command::{Command, Draw, Frame, Points, Primitive, Tessellation};
use glam::Mat4;
use rtl_model::counter::standard::{Stage, Work};
use rtl_model::counter::{Counter, Counters};
use rtl_model::level::State;
use rtl_model::patch::Level;
use std::collections::HashMap;
use std::ops::Range;

/// Bytes that the control-point shader writes: a vec4.
const SHADED_POINT: u64 = 16;

pub(super) struct Run<'a> {
    config: &'a Config,
    sink: &'a mut dyn Sink,
    points: HashMap<u32, Points>,
    state: State,
    frame: Option<FrameState>,
    /// Patches of the frame so far.
    patches: u64,
    /// What each draw of the frame so far sends, apart from its triangles, where the host
    /// tessellates.
    draws: Vec<Transfer>,
    tallies: Vec<Tally>,
    batch: Batch,
    clock: Clock,
    /// Points of the instance that have been fetched.
    fetched: u64,
    scratch: Vec<[f32; 4]>,
    /// Of the current frame; before the first frame, what that frame will be charged with.
    counters: Counters,
    /// The blocks that are timed.
    chain: Vec<Stage>,
    /// Counters and work of the frames that have ended; their times come at the end of the run.
    frames: Vec<(Counters, Vec<Work>)>,
    host_link_bytes: u64,
}

impl<'a> Run<'a> {
    pub(super) fn new(config: &'a Config, sink: &'a mut dyn Sink) -> Self {
        Self {
            config,
            sink,
            points: HashMap::new(),
            state: state(&Tessellation::default()),
            frame: None,
            patches: 0,
            draws: Vec::new(),
            tallies: Vec::new(),
            batch: Batch::default(),
            clock: Clock::new(config),
            fetched: 0,
            scratch: Vec::new(),
            counters: Counters::default(),
            chain: chain(config),
            frames: Vec::new(),
            host_link_bytes: 0,
        }
    }

    /// A run of which only what an engine would be given is wanted.
    pub(super) fn recording(config: &'a Config, sink: &'a mut dyn Sink) -> Self {
        Self { clock: Clock::recording(config), ..Self::new(config, sink) }
    }

    pub(super) fn finish_recording(mut self) -> Result<Recording> {
        self.end_frame()?;
        Ok(self.clock.into_recording().expect("it was recorded"))
    }

    pub(super) fn command(&mut self, command: &Command) -> Result<()> {
        if let Command::Frame(_) = command {
            self.end_frame()?;
        }
        if self.config.unit == Unit::Hybrid {
            let transfer = link::patches(command);
            transfer.count(&self.config.link, &mut self.counters);
            let written = link::write_resident(command, self.config, &mut self.counters);
            self.send(transfer.payload(), written)?;
        }
        match command {
            Command::Header(_) | Command::End => Ok(()),
            Command::Frame(frame) => self.begin_frame(command, frame),
            Command::Points(points) => {
                self.points.insert(points.id, points.clone());
                Ok(())
            }
            Command::Tessellation(t) => {
                self.state = state(t);
                Ok(())
            }
            Command::Draw(draw) => self.draw(link::patches(command), draw),
        }
    }

    /// A command crosses the link, behind the patches so far.
    fn send(&mut self, payload: u64, written: u64) -> Result<()> {
        if self.batch.is_empty() {
            self.clock.command(payload, written);
        } else if !self.batch.command(payload, written) {
            self.flush()?;
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<Report> {
        self.end_frame()?;
        // What stands behind the trace's last frame, or in a trace without any, is in no frame.
        let times = if self.frames.is_empty() { None } else { self.clock.finish() };
        let (mut times, occupancy) = match times {
            None => (None, Vec::new()),
            Some(times) => (Some(times.frames.into_iter()), times.occupancy),
        };
        let frames = self.frames.into_iter().map(|(counters, work)| {
            let times = times.as_mut().map(|times| times.next().expect("every frame was timed"));
            FrameReport::new(&self.chain, counters, work, times)
        });
        let frames = frames.collect();
        let report = Report {
            config: self.config.effective(),
            blocks: blocks(self.config.unit),
            chain: self.chain,
            frames,
            occupancy,
            host_link_bytes: self.host_link_bytes,
        };
        report.check();
        Ok(report)
    }

    fn begin_frame(&mut self, command: &Command, frame: &Frame) -> Result<()> {
        let state = FrameState::new(frame, self.config)?;
        let number = self.frames.len() as u64;
        if self.sink.wants(number) {
            self.sink.frame(&FrameInfo { number, view: state.view, to_world: state.to_world })?;
        }
        self.counters.add(Counter::TraceFrames, 1);
        self.frame = Some(state);
        self.patches = 0;
        let transfer = link::patches(command);
        self.host(transfer);
        self.send_as_host(transfer)
    }

    /// Where the host tessellates: a command, which its vertices follow.
    fn send_as_host(&mut self, transfer: Transfer) -> Result<()> {
        match self.config.unit {
            Unit::Hybrid => Ok(()),
            Unit::Triangles => self.send(transfer.payload(), 0),
        }
    }

    fn end_frame(&mut self) -> Result<()> {
        if self.frame.is_none() {
            return Ok(());
        }
        self.flush()?;
        self.frame = None;
        let mut tallies = std::mem::take(&mut self.tallies).into_iter().peekable();
        for (number, transfer) in std::mem::take(&mut self.draws).into_iter().enumerate() {
            let tally = tallies.next_if(|t| t.draw as usize == number).unwrap_or_default();
            self.host(transfer.with_triangles(tally.vertices, tally.triangles, self.config));
        }
        let counters = std::mem::take(&mut self.counters);
        let sent = self.clock.end_frame();
        sent.check(self.config, &counters);
        let work = work(&self.chain, &counters, sent.tokens, self.config);
        self.frames.push((counters, work));
        Ok(())
    }

    /// What crosses the link where the host tessellates: frames and draws, these with their
    /// triangles. Points and tessellation state stay with the host.
    fn host(&mut self, transfer: Transfer) {
        self.host_link_bytes += transfer.total(&self.config.link);
        if self.config.unit == Unit::Triangles {
            transfer.count(&self.config.link, &mut self.counters);
        }
    }

    fn draw(&mut self, transfer: Transfer, draw: &Draw) -> Result<()> {
        let frame = self.frame.expect("the reader refuses a draw before any frame");
        let points = self.points.get(&draw.points).expect("the reader refuses unknown ids").clone();
        let instances = draw.models.len() as u64;
        let received = draw.primitive.points();
        let patches = draw.primitive.patches() * instances;
        if self.patches + patches > u64::from(u32::MAX) {
            let count = self.patches + patches;
            let most = u32::MAX;
            return Err(Error::Usage(format!(
                "a frame of {count} patches: expected at most {most}"
            )));
        }
        let counters = &mut self.counters;
        counters.add(Counter::TraceDraws, 1);
        counters.add(Counter::TracePatches, patches);
        let point_bytes = link::point_bytes(&points);
        counters.add(Counter::TransformInvocations, received * instances);
        counters.add(Counter::TransformBytesIn, received * instances * point_bytes);
        counters.add(Counter::TransformBytesOut, received * instances * SHADED_POINT);
        counters.add(Counter::AssembleReceived, received * instances);
        counters.add(Counter::AssembleReused, 16 * patches - received * instances);
        counters.add(Counter::AssemblePatches, patches);
        counters.add(Counter::AssembleEdgePeak, draw.primitive.edge_entries_peak());
        let number = self.draws.len() as u32;
        self.draws.push(transfer);
        self.send_as_host(transfer)?;
        let state = DrawState {
            number,
            cull: draw.cull,
            reversed: draw.reversed,
            state: hybrid::state(&self.state, self.config),
        };
        // The spans of the instance before, while the batch holds all of it.
        let mut whole: Option<Range<usize>> = None;
        for model in &draw.models {
            link::read_resident(&points, received, self.config, &mut self.counters);
            self.fetched = 0;
            let model = Mat4::from_cols_array(model);
            let matrix = control_point::concatenate(&frame.clip_from_world, &model);
            match whole.clone() {
                Some(spans) if self.batch.room() as u64 >= draw.primitive.patches() => {
                    self.batch.draw(state);
                    let base = self.batch.again(matrix, spans);
                    self.patches(draw, &points, Block::whole(draw.primitive), base);
                }
                _ => whole = self.instance(draw, &points, matrix, state)?,
            }
        }
        Ok(())
    }

    /// One instance, in blocks that fit a batch: whole rows of patches, or parts of a row. Returns
    /// its spans, if one block took it all.
    fn instance(
        &mut self,
        draw: &Draw,
        points: &Points,
        matrix: Mat4,
        state: DrawState,
    ) -> Result<Option<Range<usize>>> {
        let Block { rows, columns, .. } = Block::whole(draw.primitive);
        let (mut row, mut column) = (0, 0);
        let mut whole = None;
        while row < rows {
            if self.batch.room() == 0 {
                self.flush()?;
            }
            let room = self.batch.room() as u64;
            let block = if column > 0 || columns > room {
                Block { row, column, rows: 1, columns: room.min(columns - column) }
            } else {
                Block { row, column, rows: (room / columns).min(rows - row), columns }
            };
            let first = self.batch.spans();
            self.batch.draw(state);
            self.block(draw, points, matrix, block)?;
            whole =
                (block.rows * block.columns == rows * columns).then(|| first..self.batch.spans());
            column += block.columns;
            if column == columns {
                (row, column) = (row + block.rows, 0);
            }
        }
        Ok(whole)
    }

    fn block(&mut self, draw: &Draw, points: &Points, matrix: Mat4, block: Block) -> Result<()> {
        let Block { row, column, rows, columns } = block;
        let mesh = match draw.primitive {
            Primitive::Patches { .. } => None,
            Primitive::Mesh { columns, .. } => Some(3 * u64::from(columns) + 1),
        };
        let Some(stride) = mesh else {
            points.source.read(
                draw.first + 16 * column,
                16 * columns as usize,
                &mut self.scratch,
            )?;
            let base = self.batch.points(matrix, &self.scratch, 0);
            self.patches(draw, points, block, base);
            return Ok(());
        };
        let mut base = None;
        let width = 3 * columns as usize + 1;
        for line in 3 * row..=3 * (row + rows) {
            let first = draw.first + line * stride + 3 * column;
            points.source.read(first, width, &mut self.scratch)?;
            // A block's first line and column were received with the block below and to the left.
            let seen_line = line == 3 * row && row > 0;
            let seen_column = usize::from(column > 0);
            let repeated = if seen_line { width } else { seen_column };
            let index = self.batch.points(matrix, &self.scratch, repeated);
            base.get_or_insert(index);
        }
        self.patches(draw, points, block, base.expect("a block has lines"));
        Ok(())
    }

    /// The patches of a block whose points stand in the batch from `base` on.
    fn patches(&mut self, draw: &Draw, points: &Points, block: Block, base: u32) {
        let Block { row, column, rows, columns } = block;
        let local = match draw.primitive {
            Primitive::Patches { .. } => Primitive::Patches { count: columns },
            Primitive::Mesh { .. } => {
                Primitive::Mesh { rows: rows as u32, columns: columns as u32 }
            }
        };
        let across = Block::whole(draw.primitive).columns;
        for n in 0..local.patches() {
            let indices = local.indices(n).map(|i| base + i as u32);
            let number = (row + n / columns) * across + column + n % columns;
            let fetch = self.fetch(points, draw.primitive.received(number));
            self.batch.patch(self.patches as u32, indices, fetch);
            self.patches += 1;
        }
    }

    /// The next `count` points of an instance: resident ones share bursts with those before.
    fn fetch(&mut self, points: &Points, count: u64) -> Fetch {
        let memory = &self.config.memory;
        let bursts = |fetched| link::bursts(fetched * link::point_bytes(points), memory);
        let before = self.fetched;
        self.fetched += count;
        let bursts = if points.resident { bursts(self.fetched) - bursts(before) } else { 0 };
        Fetch { points: count as u8, read: bursts as u32 * memory.burst }
    }

    fn flush(&mut self) -> Result<()> {
        if self.batch.is_empty() {
            return Ok(());
        }
        let frame = self.frame.expect("patches belong to a frame");
        let wanted = self.sink.wants(self.frames.len() as u64);
        let sink: Option<&mut dyn Sink> = if wanted { Some(&mut *self.sink) } else { None };
        let tallies =
            self.batch.flush(self.config, &frame, sink, &mut self.counters, &mut self.clock)?;
        for tally in tallies {
            batch::add(&mut self.tallies, tally);
        }
        Ok(())
    }
}

/// The tessellation state that a command sets.
fn state(command: &Tessellation) -> State {
    let level = |fx16: u32| Level::clamped(fx16.into());
    let (min, max) = (level(command.min_level), level(command.max_level));
    State { criterion: command.criterion, min, max }
}

/// Patches of one instance that are drawn together.
#[derive(Clone, Copy)]
struct Block {
    row: u64,
    column: u64,
    rows: u64,
    columns: u64,
}

impl Block {
    /// All patches of an instance; those of no mesh are a row.
    fn whole(primitive: Primitive) -> Self {
        let (rows, columns) = match primitive {
            Primitive::Patches { count } => (1, count),
            Primitive::Mesh { rows, columns } => (rows.into(), columns.into()),
        };
        Self { row: 0, column: 0, rows, columns }
    }
}
