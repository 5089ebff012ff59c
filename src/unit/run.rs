//! A run: carries out the commands of a trace, frame by frame.

use super::attributes::Corners;
use super::batch::{self, Batch, Tally};
use super::clock::{Clock, Tokens};
use super::frame::FrameState;
use super::pipeline::Make;
use super::resident::Resident;
use super::timeline::Recorder;
use super::{blocks, chain, work};
use crate::config::{Config, Unit};
use crate::error::Result;
use crate::link::{self, Transfer};
use crate::report::timeline::Wanted;
use crate::report::{Frame as FrameReport, Report};
use crate::sink::{FrameInfo, Grid, Sink};
use crate::trace::command::{Command, Frame, Points, Tessellation};
use rtl_model::counter::standard::{Stage, Work};
use rtl_model::counter::{Counter, Counters};
use rtl_model::level::State;
use rtl_model::patch::View;
use std::collections::HashMap;
use std::sync::Arc;

pub(super) struct Run<'a, M: Make> {
    pub(super) config: &'a Config,
    sink: &'a mut dyn Sink,
    pub(super) points: HashMap<u32, Points>,
    pub(super) attributes: HashMap<u32, Arc<Corners>>,
    pub(super) state: State,
    pub(super) frame: Option<FrameState>,
    /// Patches of the frame so far.
    pub(super) patches: u64,
    /// What each draw of the frame so far sends, apart from its triangles, where the host
    /// tessellates, and the bytes of its vertices.
    pub(super) draws: Vec<(Transfer, u64)>,
    tallies: Vec<Tally>,
    pub(super) batch: Batch,
    clock: Clock<M::Lists>,
    pub(super) scratch: Vec<[f32; 4]>,
    /// Of the current frame; before the first frame, what that frame will be charged with.
    pub(super) counters: Counters,
    /// The blocks that are timed.
    chain: Vec<Stage>,
    /// Counters and work of the frames that have ended; their times come at the end of the run.
    frames: Vec<(Counters, Vec<Work>)>,
    host_link_bytes: u64,
    pub(super) resident: Resident,
    /// Instances of draws so far.
    pub(super) instances: u64,
}

impl<'a, M: Make> Run<'a, M> {
    pub(super) fn new(config: &'a Config, sink: &'a mut dyn Sink) -> Self {
        Self {
            config,
            sink,
            points: HashMap::new(),
            attributes: HashMap::new(),
            state: Tessellation::default().state(),
            frame: None,
            patches: 0,
            draws: Vec::new(),
            tallies: Vec::new(),
            batch: Batch::default(),
            clock: Clock::new(config),
            scratch: Vec::new(),
            counters: Counters::default(),
            chain: chain(config),
            frames: Vec::new(),
            host_link_bytes: 0,
            resident: Resident::default(),
            instances: 0,
        }
    }

    /// A run of which only what an engine would be given is wanted.
    pub(super) fn recording(config: &'a Config, sink: &'a mut dyn Sink) -> Self {
        Self { clock: Clock::recording(config), ..Self::new(config, sink) }
    }

    /// A run of whose times a part is wanted.
    pub(super) fn watched(config: &'a Config, sink: &'a mut dyn Sink, wanted: &Wanted) -> Self {
        Self { clock: Clock::watched(config, wanted), ..Self::new(config, sink) }
    }

    pub(super) fn finish_recording(mut self) -> Result<Tokens<M::Lists>> {
        self.end_frame()?;
        Ok(self.clock.into_recording().expect("it was recorded"))
    }

    pub(super) fn command(&mut self, command: &Command) -> Result<()> {
        if let Command::Frame(_) = command {
            self.end_frame()?;
        }
        if !self.config.unit.host_tessellates() {
            let transfer = link::to(self.config, command);
            transfer.count(&self.config.link, &mut self.counters);
            let written = link::write_resident(command, self.config, &mut self.counters);
            self.send(transfer.payload(), written)?;
        }
        match command {
            Command::Header(_) | Command::End => Ok(()),
            Command::Frame(frame) => self.begin_frame(command, frame),
            Command::Points(points) => {
                self.resident.replace_points(points.id);
                self.points.insert(points.id, points.clone());
                Ok(())
            }
            Command::Tessellation(t) => {
                self.state = t.state();
                Ok(())
            }
            Command::Attributes(attributes) => {
                self.resident.replace_attributes(attributes.id);
                let corners = Corners::new(attributes, self.config);
                self.counters.add(Counter::PortAttributesSaturated, corners.saturated);
                self.attributes.insert(attributes.id, Arc::new(corners));
                Ok(())
            }
            Command::Draw(draw) => self.draw(draw),
        }
    }

    /// A command crosses the link, behind the patches so far.
    pub(super) fn send(&mut self, payload: u64, written: u64) -> Result<()> {
        if self.batch.is_empty() {
            self.clock.command(payload, written);
        } else if !self.batch.command(payload, written) {
            self.flush()?;
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<(Report, Option<Recorder>)> {
        self.end_frame()?;
        // What stands behind the trace's last frame, or in a trace without any, is in no frame.
        let times = if self.frames.is_empty() { None } else { self.clock.finish() };
        let (mut times, occupancy, recorder) = match times {
            None => (None, Vec::new(), None),
            Some((times, recorder)) => (Some(times.frames.into_iter()), times.occupancy, recorder),
        };
        let frames = self.frames.into_iter().map(|(counters, work)| {
            let times = times.as_mut().map(|times| times.next().expect("every frame was timed"));
            FrameReport::new(&self.chain, counters, work, times)
        });
        let frames = frames.collect();
        let report = Report {
            config: self.config.effective(),
            blocks: blocks(self.config),
            chain: self.chain,
            frames,
            occupancy,
            host_link_bytes: self.host_link_bytes,
        };
        report.check();
        Ok((report, recorder))
    }

    fn begin_frame(&mut self, command: &Command, frame: &Frame) -> Result<()> {
        let state = FrameState::new(frame, self.config)?;
        let number = self.frames.len() as u64;
        if self.sink.wants(number) {
            let view = View { position: state.position(self.config), ..state.view };
            self.sink.frame(&FrameInfo {
                number,
                view,
                grid: grid(self.config.unit),
                eye: state.view,
                object: state.object,
                near: state.near(),
            })?;
        }
        self.counters.add(Counter::TraceFrames, 1);
        self.frame = Some(state);
        self.patches = 0;
        let transfer = link::host(command);
        self.host(transfer);
        self.send_as_host(transfer)
    }

    /// Where the host tessellates: a command, which its vertices follow.
    pub(super) fn send_as_host(&mut self, transfer: Transfer) -> Result<()> {
        if self.config.unit.host_tessellates() {
            transfer.count_payload(&mut self.counters);
            return self.send(transfer.payload(), 0);
        }
        Ok(())
    }

    fn end_frame(&mut self) -> Result<()> {
        if self.frame.is_none() {
            return Ok(());
        }
        self.flush()?;
        self.frame = None;
        let mut tallies = std::mem::take(&mut self.tallies).into_iter().peekable();
        let draws = std::mem::take(&mut self.draws).into_iter().enumerate();
        for (number, (transfer, vertex_bytes)) in draws {
            let tally = tallies.next_if(|t| t.draw as usize == number).unwrap_or_default();
            self.host(transfer.with_triangles(tally.vertices, tally.triangles, vertex_bytes));
        }
        let mut counters = std::mem::take(&mut self.counters);
        let sent = self.clock.end_frame(&mut counters);
        self.clock.check()?;
        sent.check(self.config, &counters);
        let work = work(&self.chain, &counters, sent.tokens, self.config);
        self.frames.push((counters, work));
        Ok(())
    }

    /// What would cross the link if the host streamed its triangles: frames and draws, these with
    /// their triangles. Points and tessellation state stay with the host.
    fn host(&mut self, transfer: Transfer) {
        self.host_link_bytes += transfer.total(&self.config.link);
    }

    pub(super) fn flush(&mut self) -> Result<()> {
        if self.batch.is_empty() {
            return Ok(());
        }
        let frame = self.frame.expect("patches belong to a frame");
        let wanted = self.sink.wants(self.frames.len() as u64);
        let sink: Option<&mut dyn Sink> = if wanted { Some(&mut *self.sink) } else { None };
        let tallies = self.batch.flush::<M>(
            self.config,
            &frame,
            sink,
            &mut self.counters,
            &mut self.clock,
        )?;
        for tally in tallies {
            batch::add(&mut self.tallies, tally);
        }
        self.clock.check()
    }
}

/// What parameters of the unit's vertices stand for.
fn grid(unit: Unit) -> Grid {
    if unit == Unit::Esc { Grid::Thirds } else { Grid::Fx16 }
}
