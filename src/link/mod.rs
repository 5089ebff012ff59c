//! What crosses the link from the host, and what moves in device memory: bytes by kind.
//!
//! Sizes on the wire: a command's header 8 (every command but the trace's own header and end), a
//! matrix 64, a float 4, an index 2 or 4. A command is one transfer, cut as [`framing`] says; the
//! next command starts a packet of its own. How long bytes hold a wire says [`wire`],
//! and what that means for what is behind, [`schedule`].

pub mod framing;
pub mod schedule;
pub mod wire;

use crate::config::{Config, Link, Memory};
use crate::trace::command::{Command, Draw, Points};
use framing::Framed;
use rtl_model::counter::{Counter, Counters};

/// Bytes of a command's header.
const COMMAND: u64 = 8;
/// Bytes of a matrix.
const MATRIX: u64 = 64;
/// Bytes of a float.
const FLOAT: u64 = 4;
/// Most vertices that 2-byte indices reach.
const SHORT_INDEX_MAX: u64 = 1 << 16;

/// The payload of one command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Transfer {
    /// Its header.
    pub command: u64,
    /// Its matrices.
    pub matrices: u64,
    /// Its control points.
    pub control_points: u64,
    /// Its vertices (unit `triangles`).
    pub vertices: u64,
    /// Its indices (unit `triangles`).
    pub indices: u64,
}

impl Transfer {
    /// Bytes of all kinds, without framing.
    #[must_use]
    pub fn payload(&self) -> u64 {
        self.command + self.matrices + self.control_points + self.vertices + self.indices
    }

    /// Bytes in both directions, with framing and read requests.
    #[must_use]
    pub fn total(&self, link: &Link) -> u64 {
        Framed::of(self.payload(), link).total()
    }

    /// The same transfer with the triangles that a tessellating host sends, indexed over the whole
    /// draw.
    #[must_use]
    pub fn with_triangles(self, vertices: u64, triangles: u64, config: &Config) -> Self {
        let index = if vertices > SHORT_INDEX_MAX { 4 } else { 2 };
        Self {
            vertices: vertices * u64::from(config.triangles.vertex_bytes),
            indices: 3 * triangles * index,
            ..self
        }
    }

    /// Adds the transfer to the counters.
    pub fn count(&self, link: &Link, counters: &mut Counters) {
        counters.add(Counter::LinkCommands, self.command);
        counters.add(Counter::LinkMatrices, self.matrices);
        counters.add(Counter::LinkControlPoints, self.control_points);
        counters.add(Counter::LinkVertices, self.vertices);
        counters.add(Counter::LinkIndices, self.indices);
        let framed = Framed::of(self.payload(), link);
        counters.add(Counter::LinkOverhead, framed.overhead);
        counters.add(Counter::LinkRequests, framed.request_bytes);
        counters.add(Counter::LinkTotal, framed.total());
    }
}

/// What a command sends to a unit that tessellates.
#[must_use]
pub fn patches(command: &Command) -> Transfer {
    let command_only = Transfer { command: COMMAND, ..Transfer::default() };
    match command {
        Command::Header(_) | Command::End => Transfer::default(),
        Command::Frame(_) => Transfer { matrices: 2 * MATRIX, ..command_only },
        Command::Points(points) => {
            Transfer { control_points: points.source.len() * point_bytes(points), ..command_only }
        }
        Command::Tessellation(_) => command_only,
        Command::Draw(draw) => Transfer { matrices: models(draw), ..command_only },
    }
}

fn models(draw: &Draw) -> u64 {
    if draw.models_sent { draw.models.len() as u64 * MATRIX } else { 0 }
}

/// Bytes of a control point: three floats, or four.
#[must_use]
pub fn point_bytes(points: &Points) -> u64 {
    FLOAT * u64::from(points.source.components())
}

/// Resident points written to device memory as they arrive. Returns the bytes of their bursts.
pub fn write_resident(command: &Command, config: &Config, counters: &mut Counters) -> u64 {
    match command {
        Command::Points(points) if points.resident => {
            let bytes = points.source.len() * point_bytes(points);
            counters.add(Counter::MemoryWrittenControlPoints, bytes);
            burst(bytes, config, counters)
        }
        _ => 0,
    }
}

/// Resident points read by one instance of a draw, `count` in a row.
pub fn read_resident(points: &Points, count: u64, config: &Config, counters: &mut Counters) {
    if points.resident {
        let bytes = count * point_bytes(points);
        counters.add(Counter::MemoryReadControlPoints, bytes);
        burst(bytes, config, counters);
    }
}

/// Bursts that `bytes` in a row take, from the start of a burst.
#[must_use]
pub fn bursts(bytes: u64, memory: &Memory) -> u64 {
    bytes.div_ceil(memory.burst.into())
}

fn burst(bytes: u64, config: &Config, counters: &mut Counters) -> u64 {
    let bursts = bursts(bytes, &config.memory);
    let moved = bursts * u64::from(config.memory.burst);
    counters.add(Counter::MemoryBursts, bursts);
    counters.add(Counter::MemoryWasted, moved - bytes);
    moved
}
