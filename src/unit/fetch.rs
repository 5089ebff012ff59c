//! Fetch: a patch of a draw in, what must be brought for it out: control points, by the primitive's
//! order or as far as an indexed mesh's cache lacks them, and attributes of corners, with the
//! bursts of device memory that resident ones take.

use super::attributes::{Corners, NO_CORNERS};
use super::batch::DrawState;
use super::clock::Fetch;
use super::d3d11;
use crate::config::{Config, Memory, Unit};
use crate::link::{self, Bursts};
use crate::trace::command::{Draw, Points};
use glam::Mat4;
use rtl_model::assemble::Cache;
use rtl_model::counter::{Counter, Counters};
use std::sync::Arc;

/// Bytes that the control-point shader writes: a vec4.
const SHADED_POINT: u64 = 16;

/// A draw, and what it names.
pub(super) struct Source<'a> {
    pub(super) draw: &'a Draw,
    pub(super) points: Points,
    pub(super) attributes: Option<Arc<Corners>>,
    /// Whether its patches name their points and corners by indices.
    pub(super) indexed: bool,
}

/// What one instance has fetched so far.
pub(super) struct Instance {
    pub(super) matrix: Mat4,
    pub(super) state: DrawState,
    points: Bursts,
    corners: Bursts,
    /// Transformed points of an indexed mesh.
    pub(super) cache: Cache,
    /// Points, corners and patches without any of their own that its blocks brought.
    received: [u64; 3],
}

/// Which control points a patch brings.
#[derive(Clone, Copy)]
pub(super) enum Brought {
    /// So many that follow those before.
    Next(u64),
    /// Those of which the bit is set.
    Missed(u16),
}

impl Brought {
    fn points(self) -> u64 {
        match self {
            Self::Next(points) => points,
            Self::Missed(missed) => missed.count_ones().into(),
        }
    }
}

impl Source<'_> {
    /// The points of patch `number`.
    pub(super) fn row(&self, number: u64) -> [u32; 16] {
        match &self.draw.indices {
            Some(indices) => indices.points[number as usize],
            None => self.draw.primitive.indices(number).map(|point| point as u32), // in memory
        }
    }

    /// Components of the attributes of a vertex.
    pub(super) fn components(&self) -> u64 {
        self.attributes.as_ref().map_or(0, |corners| corners.table.components() as u64)
    }

    /// The corners of patch `number`, where it has attributes.
    pub(super) fn corners(&self, number: u64) -> [u32; 4] {
        match (&self.attributes, &self.draw.indices) {
            (None, _) => NO_CORNERS,
            (_, Some(indices)) => indices.corners[number as usize],
            // A reader has checked that there are so many, and they are in memory.
            _ => self.draw.primitive.corner_indices(number).map(|corner| corner as u32),
        }
    }
}

impl Instance {
    pub(super) fn new(matrix: Mat4, state: DrawState, config: &Config) -> Self {
        Self {
            matrix,
            state,
            points: Bursts::default(),
            corners: Bursts::default(),
            cache: Cache::new(config.assemble.cache_entries),
            received: [0; 3],
        }
    }

    /// What patch `number` brings.
    pub(super) fn fetch(
        &mut self,
        source: &Source<'_>,
        number: u64,
        brought: Brought,
        config: &Config,
    ) -> Fetch {
        let points = brought.points();
        let bursts = self.points(source, number, brought, config)
            + self.corners(source, number, &config.memory);
        self.received[0] += points;
        self.received[2] += u64::from(points == 0);
        let read = u32::try_from(bursts * u64::from(config.memory.burst));
        let read = read.expect("a patch's bursts are few");
        Fetch { points: points as u8, read, ..Fetch::default() }
    }

    /// Bursts that bring the patch's control points.
    fn points(
        &mut self,
        source: &Source<'_>,
        number: u64,
        brought: Brought,
        config: &Config,
    ) -> u64 {
        if !source.points.resident {
            return 0;
        }
        let (bytes, memory) = (link::point_bytes(&source.points), &config.memory);
        match brought {
            Brought::Missed(missed) => {
                let row = source.row(number);
                let missed = row.iter().enumerate().filter(|(k, _)| missed >> k & 1 == 1);
                missed.map(|(_, &i)| self.points.next(u64::from(i) * bytes, bytes, memory)).sum()
            }
            Brought::Next(points) => self.points.next(self.points.bytes(), points * bytes, memory),
        }
    }

    /// Bursts that bring the attributes of its corners.
    fn corners(&mut self, source: &Source<'_>, number: u64, memory: &Memory) -> u64 {
        let Some(Corners { table, resident, .. }) = source.attributes.as_deref() else { return 0 };
        let bytes = table.corner_bytes();
        let indexed = source.indexed;
        let received = if indexed { 4 } else { source.draw.primitive.corners_received(number) };
        self.received[1] += received;
        match (resident, indexed) {
            (false, _) => 0,
            (true, false) => self.corners.next(self.corners.bytes(), received * bytes, memory),
            (true, true) => {
                let corners = source.corners(number);
                corners.map(|c| self.corners.next(u64::from(c) * bytes, bytes, memory)).iter().sum()
            }
        }
    }

    /// What the instance brought.
    pub(super) fn count(&self, source: &Source<'_>, config: &Config, counters: &mut Counters) {
        let Source { draw, points, attributes, indexed } = source;
        let patches = draw.primitive.patches();
        let [received, corners, whole] = self.received;
        if !config.unit.in_object_space() {
            counters.add(Counter::TransformInvocations, received);
            counters.add(Counter::TransformBytesIn, received * link::point_bytes(points));
            counters.add(Counter::TransformBytesOut, received * SHADED_POINT);
        }
        if config.unit == Unit::D3d11 {
            let corners = attributes.as_ref().map_or(0, |a| 4 * a.table.corner_bytes());
            let bytes_in = 16 * link::point_bytes(points) + corners;
            d3d11::count_hull(patches, bytes_in, source.components(), config, counters);
        }
        counters.add(Counter::AssembleReceived, received);
        counters.add(Counter::AssembleReused, 16 * patches - received);
        counters.add(Counter::AssembleWhole, whole);
        if config.unit.host_tessellates() {
            return; // points and attributes stay with the host
        }
        if points.resident {
            counters.add(Counter::MemoryReadControlPoints, self.points.bytes());
            let uncached = if *indexed { 16 * patches } else { received };
            let bytes = uncached * link::point_bytes(points);
            counters.add(Counter::MemoryUncachedControlPoints, bytes);
            self.points.count(&config.memory, counters);
        }
        let Some(attributes) = attributes else { return };
        counters.add(Counter::AssembleCorners, corners);
        counters.add(Counter::AssembleCornersReused, 4 * patches - corners);
        if attributes.resident {
            counters.add(Counter::MemoryReadAttributes, self.corners.bytes());
            self.corners.count(&config.memory, counters);
        }
    }
}
