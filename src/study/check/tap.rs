//! Tap: what a unit was given and what it made, collected until there is enough of it for the
//! device.

use super::item::{Item, Mesh};
use super::ledger::Ledger;
use super::{blocks, counts, units};
use crate::config::Config;
use crate::error::Result;
use crate::gpu::{Device, Made, Name};
use crate::report::Report;
use crate::sink::{Arrived, FrameInfo, PatchMesh, Sink};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Patches of a batch.
const PATCHES: usize = 1024;

/// Vertices of a batch, but for those of its last patch.
const VERTICES: usize = 400_000;

/// The sink that collects.
pub(super) struct Tap<'a> {
    config: &'a Config,
    device: &'a Device,
    ledger: Ledger,
    frame: Option<FrameInfo>,
    items: Vec<Item>,
    vertices: usize,
    /// What the kernels counted, frame by frame.
    counts: Vec<BTreeMap<Name, u64>>,
    gpu: Duration,
    /// Patches that arrived.
    pub(super) patches: u64,
}

impl<'a> Tap<'a> {
    pub(super) fn new(config: &'a Config, device: &'a Device) -> Self {
        Self {
            config,
            device,
            ledger: Ledger::default(),
            frame: None,
            items: Vec::new(),
            vertices: 0,
            counts: Vec::new(),
            gpu: Duration::ZERO,
            patches: 0,
        }
    }

    /// The ledger, once the counters are compared too, and the time that the device took.
    pub(super) fn finish(mut self, report: &Report) -> Result<(Ledger, Duration)> {
        self.flush()?;
        for (number, (frame, counts)) in report.frames.iter().zip(&self.counts).enumerate() {
            counts::compare(&mut self.ledger, number, report.blocks, &frame.counters, counts);
        }
        Ok((self.ledger, self.gpu))
    }

    fn flush(&mut self) -> Result<()> {
        let items = std::mem::take(&mut self.items);
        self.vertices = 0;
        let Some(frame) = self.frame.filter(|_| !items.is_empty()) else { return Ok(()) };
        let started = Instant::now();
        let made = units::make(self.device, self.config, &frame, &items)?;
        self.gpu += started.elapsed();
        let counts = self.counts.last_mut().expect("a frame has begun");
        for &(name, value) in &made.counts {
            let sum = counts.entry(name).or_insert(0);
            *sum = if name.1.ends_with(".peak") { (*sum).max(value) } else { *sum + value };
        }
        self.compare(&frame, &items, &made);
        Ok(())
    }

    fn compare(&mut self, frame: &FrameInfo, items: &[Item], made: &Made) {
        blocks::compare(&mut self.ledger, self.config, frame, items, made);
        units::compare(&mut self.ledger, self.config.unit, frame, items, made);
    }
}

impl Sink for Tap<'_> {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.flush()?;
        self.frame = Some(*frame);
        self.counts.push(BTreeMap::new());
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let item = self.items.last_mut().expect("a patch arrives before its mesh");
        assert_eq!(item.arrived.patch.id, mesh.patch, "a mesh follows its patch");
        self.vertices += mesh.vertices.len();
        item.mesh = Some(Mesh::of(mesh));
        Ok(())
    }

    fn taps(&self) -> bool {
        true
    }

    fn arrived(&mut self, patch: &Arrived) -> Result<()> {
        if self.items.len() >= PATCHES || self.vertices >= VERTICES {
            self.flush()?;
        }
        self.patches += 1;
        self.items.push(Item { arrived: patch.clone(), mesh: None });
        Ok(())
    }
}
