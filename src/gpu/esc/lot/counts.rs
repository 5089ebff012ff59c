//! What a lot cost: sums over rows on the device in, counters by their names out.

use super::{COARSE_EDGES, COARSE_TRIANGLES, COST, DECISION, EVENTS, Lot, Mesh, RESOLUTION, WALK};
use crate::config::{Normals, Reuse};
use crate::error::Result;
use crate::gpu::device::Buffer;
use crate::gpu::esc::settings::{Tests, sections};
use crate::gpu::made::Name;

/// Bytes of a patch's control points, and of those in object space: 4 and 3 components in f32.
const NET_BYTES: u64 = 16 * 16;
const OBJECT_BYTES: u64 = 16 * 12;
/// Coefficients of a surface.
const COEFFICIENTS: u64 = 64;
/// Columns of resolutions, of walks, and of costs.
const CLAMPED: usize = 5;
const SLOTS: usize = 2;
const LISTED: usize = 3;
const KINDS: usize = 4;
const BUFFER: u32 = 10;
const MOVED: usize = 11;
const LEAVE: usize = 12;

/// Sums over a lot.
struct Sums {
    /// Clamped, near, overflows, kept, by flatness, by length.
    levels: [u64; 6],
    walks: Vec<u64>,
    costs: Vec<u64>,
    /// Most points that a section holds.
    held: u64,
    degenerate: u64,
    overflows: u64,
    cracks: u64,
}

/// What clip and backface did, from the fates of patches: these are few, and are read anyway.
pub(super) fn culled(fates: &[u32]) -> [(Name, u64); 6] {
    let of = |fate: u32| fates.chunks(4).filter(|words| words[0] == fate).count() as u64;
    let sum = |word: usize| fates.chunks(4).map(|words| u64::from(words[word])).sum();
    let (patches, clipped) = ((fates.len() / 4) as u64, of(0));
    [
        (("clip", "patches.in"), patches),
        (("clip", "patches.culled"), clipped),
        (("backface", "patches.in"), patches - clipped),
        (("backface", "patches.tested"), sum(1)),
        (("backface", "facets.tested"), sum(2)),
        (("backface", "patches.culled"), of(1)),
    ]
}

impl Lot<'_> {
    /// What was counted.
    pub(super) fn counts(
        &self,
        decisions: &Buffer,
        mesh: &Mesh,
        points: &Buffer,
        events: &Buffer,
    ) -> Result<Vec<(Name, u64)>> {
        let count = self.work.count();
        let costs = self.costs(decisions, &mesh.walks)?;
        let levels = self.summed(&self.resolutions, RESOLUTION, count)?;
        let tested = self.summed(decisions, DECISION, COARSE_EDGES * count)?;
        let vertices = *mesh.starts[0].last().expect("a sum") as usize;
        let evaluated = self.summed_by_blocks(events, EVENTS, vertices)?;
        let sums = Sums {
            levels: std::array::from_fn(|k| levels[CLAMPED + k]),
            walks: self.summed(&mesh.walks, WALK, COARSE_TRIANGLES * count)?,
            costs: self.summed(&costs, COST, count)?,
            held: self.peak(&costs, BUFFER)?,
            degenerate: self.degenerate(mesh, points)?,
            overflows: tested[1] + evaluated[0],
            cracks: evaluated[1],
        };
        let mut counts = sums.level();
        counts.extend(sums.shader());
        counts.extend(self.data(&sums));
        counts.extend(self.emitted(&sums));
        Ok(counts)
    }

    /// What the shader moves and holds.
    fn data(&self, sums: &Sums) -> Vec<(Name, u64)> {
        let config = self.work.config;
        let (leave, attributes, lanes) =
            (sums.costs[LEAVE], sums.costs[LEAVE + 1], sums.costs[LEAVE + 2]);
        let component = config.attributes.component_bytes();
        let each = u64::from(sections(config).1);
        let (kept, invocations) = (sums.levels[3], sums.levels[3] * each);
        let object = if Tests::of(config) == Tests::Object { OBJECT_BYTES } else { 0 };
        let registers =
            COEFFICIENTS * u64::from(config.net_bits()) + 32 * u64::from(config.esc.registers);
        let width = u64::from(config.position.width);
        let bytes_in = invocations * (NET_BYTES + object) + 4 * each * lanes * component;
        let bytes_out = leave * u64::from(config.esc.bytes_out) + attributes * component;
        let normals = config.evaluate.normals == Normals::TangentPlane;
        named(&[
            ("invocations", invocations),
            ("control_points", 16 * invocations),
            ("bytes.in", bytes_in),
            ("buffer.bits.peak", sums.held * 4 * width),
            ("registers.bits.peak", if kept > 0 { registers } else { 0 }),
            ("attributes", attributes),
            ("bytes.out", bytes_out),
            ("normals", if normals { leave } else { 0 }),
        ])
    }

    /// What leaves, but for how emit divides it.
    fn emitted(&self, sums: &Sums) -> [(Name, u64); 4] {
        let config = self.work.config;
        let (leave, triangles) = (sums.costs[LEAVE], sums.walks[1]);
        let attributes = sums.costs[LEAVE + 1] * config.attributes.component_bytes();
        // Strips leave without indices.
        let indexed = u64::from(config.esc.reuse != Reuse::None);
        let indices = 3 * triangles * indexed * u64::from(config.emit.index_bytes);
        let bytes = leave * u64::from(config.emit.vertex_bytes) + attributes + indices;
        [
            (("emit", "vertices"), leave),
            (("emit", "triangles"), triangles),
            (("emit", "bytes.attributes"), attributes),
            (("emit", "bytes"), bytes),
        ]
    }
}

impl Sums {
    fn level(&self) -> Vec<(Name, u64)> {
        let [clamped, near, overflows, kept, flatness, length] = self.levels;
        vec![
            (("level", "patches"), kept),
            (("level", "patches.flatness"), flatness),
            (("level", "patches.edge_length"), length),
            (("level", "splits"), 0),
            (("level", "levels.clamped"), clamped),
            (("level", "edges.near"), near),
            (("level", "overflows"), overflows),
        ]
    }

    fn shader(&self) -> Vec<(Name, u64)> {
        let costs = &self.costs;
        let [corners, boundary, coarse, interior, tested] =
            std::array::from_fn(|k| costs[KINDS + k]);
        named(&[
            ("nets", costs[0]),
            ("nets.object", costs[1]),
            ("tests", costs[2]),
            ("tests.inserted", costs[3]),
            ("evaluations", boundary + coarse + interior + tested),
            ("evaluations.boundary", boundary),
            ("evaluations.coarse_edges", coarse),
            ("evaluations.interior", interior),
            ("evaluations.tests", tested),
            ("evaluations.tests.boundary", costs[KINDS + 5]),
            ("corners", corners),
            ("points", self.walks[0]),
            ("strip_vertices", self.walks[LISTED]),
            ("slots", self.walks[SLOTS]),
            ("triangles", self.walks[1]),
            ("triangles.degenerate", self.degenerate),
            ("vertices.moved", costs[MOVED]),
            ("cracks", self.cracks),
            ("overflows", self.overflows),
        ])
    }
}

fn named(counts: &[(&'static str, u64)]) -> Vec<(Name, u64)> {
    counts.iter().map(|&(name, count)| (("surface", name), count)).collect()
}
