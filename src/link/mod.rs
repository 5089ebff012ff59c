//! What crosses the link from the host, and what moves in device memory: bytes by kind.
//!
//! Sizes on the wire: a command's header 8 (every command but the trace's own header and end), a
//! matrix 64, a float 4, an index 2 or 4. A command is one transfer, cut as [`framing`] says; the
//! next command starts a packet of its own. How long bytes hold a wire says [`wire`],
//! and what that means for what is behind, [`schedule`]. Where the host tessellates,
//! [`index_stream`] has the indices of its triangles, and [`vertex_cache`] which of them ask for a
//! vertex to be shaded.

pub mod framing;
pub mod index_stream;
pub mod schedule;
pub mod vertex_cache;
pub mod wire;

use crate::config::{Config, LevelScope, Link, Memory, Unit};
use crate::trace::command::{Attributes, Command, Draw, Points, Primitive};
use framing::Framed;
use rtl_model::counter::{Counter, Counters};

/// Bytes of a command's header.
pub const COMMAND: u64 = 8;
/// Bytes of a matrix.
const MATRIX: u64 = 64;
/// Bytes of a float.
const FLOAT: u64 = 4;
/// Levels of a patch that cross the link, where the driver chooses them (GL_NV_evaluators).
const FACTORS: u64 = 4;
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
    /// Its attributes.
    pub attributes: u64,
    /// Tessellation levels of its patches' edges (unit `moreton`).
    pub factors: u64,
    /// Its vertices (unit `triangles`).
    pub vertices: u64,
    /// Its indices: an indexed mesh's, or the triangles' (unit `triangles`).
    pub indices: u64,
}

impl Transfer {
    /// Bytes of all kinds, without framing.
    #[must_use]
    pub fn payload(&self) -> u64 {
        let Self { command, matrices, control_points, attributes, factors, vertices, indices } =
            self;
        command + matrices + control_points + attributes + factors + vertices + indices
    }

    /// Bytes in both directions, with framing and read requests.
    #[must_use]
    pub fn total(&self, link: &Link) -> u64 {
        Framed::of(self.payload(), link).total()
    }

    /// The same transfer with the triangles that a tessellating host sends, as lists indexed over
    /// the whole draw, a vertex of so many bytes: what every unit is compared with.
    #[must_use]
    pub fn with_triangles(self, vertices: u64, triangles: u64, vertex_bytes: u64) -> Self {
        let index = if vertices > SHORT_INDEX_MAX { 4 } else { 2 };
        Self { vertices: vertices * vertex_bytes, indices: 3 * triangles * index, ..self }
    }

    /// Adds the transfer to the counters.
    pub fn count(&self, link: &Link, counters: &mut Counters) {
        self.count_payload(counters);
        let framed = Framed::of(self.payload(), link);
        counters.add(Counter::LinkOverhead, framed.overhead);
        counters.add(Counter::LinkRequests, framed.request_bytes);
        counters.add(Counter::LinkTotal, framed.total());
    }

    /// Adds the payload alone, where its command is not over yet and is framed as a whole.
    pub fn count_payload(&self, counters: &mut Counters) {
        counters.add(Counter::LinkCommands, self.command);
        counters.add(Counter::LinkMatrices, self.matrices);
        counters.add(Counter::LinkControlPoints, self.control_points);
        counters.add(Counter::LinkAttributes, self.attributes);
        counters.add(Counter::LinkFactors, self.factors);
        counters.add(Counter::LinkVertices, self.vertices);
        counters.add(Counter::LinkIndices, self.indices);
    }
}

/// What a command sends to a unit that tessellates: to one that does not choose its levels itself,
/// those of each patch's four edges too, and no tessellation state; where the driver chooses one
/// level for an instance, that level.
#[must_use]
pub fn to(config: &Config, command: &Command) -> Transfer {
    let (unit, transfer) = (config.unit, patches(command));
    match (unit, command) {
        (Unit::Moreton, Command::Draw(draw)) => {
            let patches = draw.primitive.patches() * draw.models.len() as u64;
            Transfer { factors: patches * FACTORS * FLOAT, ..transfer }
        }
        (Unit::Moreton, Command::Tessellation(_)) => Transfer::default(),
        (Unit::Esc, Command::Draw(draw)) if config.esc.scope == LevelScope::Object => {
            Transfer { factors: draw.models.len() as u64 * FLOAT, ..transfer }
        }
        (_, Command::Draw(draw)) if draw.indices.is_none() && is_indexed(unit, draw) => {
            Transfer { indices: index_bytes(draw), ..transfer }
        }
        _ => transfer,
    }
}

/// Whether the patches of a draw name their points and corners by indices: those of an indexed
/// mesh, and, sent to a unit that knows nothing but patches, those of strips, fans and meshes.
#[must_use]
pub fn is_indexed(unit: Unit, draw: &Draw) -> bool {
    let by_itself = matches!(draw.primitive, Primitive::Patches { .. });
    draw.indices.is_some() || !(unit.has_surface_primitives() || by_itself)
}

/// The indices of a draw that has none of its own: 16 a patch, and 4 of its corners' attributes, of
/// 2 bytes where they reach all points.
fn index_bytes(draw: &Draw) -> u64 {
    let points = draw.primitive.points().unwrap_or(u64::MAX);
    let index = if points > SHORT_INDEX_MAX { 4 } else { 2 };
    let corners = if draw.attributes.is_some() { 4 } else { 0 };
    draw.primitive.patches() * (16 + corners) * index
}

fn patches(command: &Command) -> Transfer {
    let bare = host(command);
    match command {
        Command::Points(points) => {
            let control_points = points.source.len() * point_bytes(points);
            Transfer { command: COMMAND, control_points, ..bare }
        }
        Command::Attributes(Attributes { table, .. }) => {
            let attributes = table.corners() * table.corner_bytes();
            Transfer { command: COMMAND, attributes, ..bare }
        }
        Command::Tessellation(_) => Transfer { command: COMMAND, ..bare },
        Command::Draw(draw) => {
            Transfer { indices: draw.indices.as_ref().map_or(0, |i| i.bytes()), ..bare }
        }
        Command::Header(_) | Command::End | Command::Frame(_) => bare,
    }
}

/// What a command sends where the host tessellates, without a draw's triangles: points, attributes
/// and tessellation state stay with the host.
#[must_use]
pub fn host(command: &Command) -> Transfer {
    match command {
        Command::Frame(_) => {
            Transfer { command: COMMAND, matrices: 2 * MATRIX, ..Transfer::default() }
        }
        Command::Draw(draw) => host_draw(draw),
        _ => Transfer::default(),
    }
}

/// What a draw sends where the host tessellates, without its triangles.
#[must_use]
pub fn host_draw(draw: &Draw) -> Transfer {
    let models = if draw.models_sent { draw.models.len() as u64 } else { 0 };
    Transfer { command: COMMAND, matrices: models * MATRIX, ..Transfer::default() }
}

/// Bytes of a control point: three floats, or four.
#[must_use]
pub fn point_bytes(points: &Points) -> u64 {
    FLOAT * u64::from(points.source.components())
}

/// Resident points and attributes written to device memory as they arrive. Returns the bytes of
/// their bursts.
pub fn write_resident(command: &Command, config: &Config, counters: &mut Counters) -> u64 {
    let (counter, bytes) = match command {
        Command::Points(points) if points.resident => {
            (Counter::MemoryWrittenControlPoints, points.source.len() * point_bytes(points))
        }
        Command::Attributes(Attributes { table, resident: true, .. }) => {
            (Counter::MemoryWrittenAttributes, table.corners() * table.corner_bytes())
        }
        _ => return 0,
    };
    let mut write = Bursts::default();
    write.next(0, bytes, &config.memory);
    counters.add(counter, bytes);
    write.count(&config.memory, counters)
}

/// Accesses to device memory, one after another: one that begins where the one before ended goes on
/// in its burst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bursts {
    end: Option<u64>,
    bytes: u64,
    bursts: u64,
}

impl Bursts {
    /// The next access. Returns the bursts that start in it.
    pub fn next(&mut self, address: u64, bytes: u64, memory: &Memory) -> u64 {
        let burst = u64::from(memory.burst);
        let end = address + bytes;
        let from = match self.end {
            Some(before) if before == address => before.div_ceil(burst),
            _ => address / burst,
        };
        self.end = Some(end);
        let bursts = if bytes == 0 { 0 } else { end.div_ceil(burst).saturating_sub(from) };
        self.bytes += bytes;
        self.bursts += bursts;
        bursts
    }

    /// Bytes asked for.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Adds the bursts to the counters. Returns their bytes.
    pub fn count(&self, memory: &Memory, counters: &mut Counters) -> u64 {
        let moved = self.bursts * u64::from(memory.burst);
        counters.add(Counter::MemoryBursts, self.bursts);
        counters.add(Counter::MemoryWasted, moved - self.bytes);
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_goes_on_in_its_burst_and_what_jumps_does_not() {
        let memory = Memory { burst: 32, ..Memory::default() };
        let mut reads = Bursts::default();
        let accesses =
            [(0, 12), (12, 12), (24, 12), (36, 28), (64, 1), (12, 12), (12, 12), (30, 4)];
        let bursts = accesses.map(|(address, bytes)| reads.next(address, bytes, &memory));
        assert_eq!(bursts, [1, 0, 1, 0, 1, 1, 1, 2]);
        let mut counters = Counters::default();
        assert_eq!(reads.count(&memory, &mut counters), 7 * 32);
        assert_eq!(counters.get(Counter::MemoryWasted), 7 * 32 - 93);
    }
}
