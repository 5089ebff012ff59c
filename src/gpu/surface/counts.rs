//! What was counted, by the names of `counters.csv`.

use super::blocks::{COUNTED, EVENTS};
use crate::config::{Config, Normals};
use crate::gpu::made::Name;

/// Sums over a batch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// Of plans, in the order of their words.
    plans: [u64; COUNTED],
    events: [u64; EVENTS],
}

/// Words of a plan, as plan.wgsl numbers them.
const KEPT: usize = 0;
const CLIPPED: usize = 1;
const CULLED: usize = 2;
const VERTICES: usize = 14;
const ATTRIBUTES: usize = 18;
const TRIANGLES: usize = 19;

/// The words that are counters as they are, from the first one after those of culling on.
const NAMES: [(usize, Name); 18] = [
    (KEPT, ("level", "patches")),
    (5, ("level", "patches.flatness")),
    (6, ("level", "patches.edge_length")),
    (7, ("level", "levels.clamped")),
    (8, ("level", "edges.near")),
    (9, ("level", "overflows")),
    (10, ("level", "splits")),
    (11, ("place", "reciprocals")),
    (12, ("place", "parameters")),
    (13, ("evaluate", "invocations")),
    (VERTICES, ("evaluate", "vertices")),
    (15, ("evaluate", "strips")),
    (16, ("evaluate", "curves")),
    (17, ("evaluate", "steps")),
    (ATTRIBUTES, ("evaluate", "attributes")),
    (TRIANGLES, ("stitch", "triangles")),
    (VERTICES, ("emit", "vertices")),
    (TRIANGLES, ("emit", "triangles")),
];

/// Whether the unit has clip and backface.
pub(super) fn culls(config: &Config) -> bool {
    !config.unit.in_object_space()
}

impl Counts {
    /// Adds the sums over the plans of some patches.
    pub(super) fn add_plans(&mut self, sums: &[u64]) {
        self.plans.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum);
    }

    /// Adds what kernels counted by event.
    pub(super) fn add_events(&mut self, words: &[u32]) {
        self.events.iter_mut().zip(words).for_each(|(all, &word)| *all += u64::from(word));
    }

    /// All counters of a unit that took so many patches.
    pub(super) fn named(&self, config: &Config, patches: usize) -> Vec<(Name, u64)> {
        let [overflows, homogeneous, degenerate, planes] = self.events;
        let mut counts: Vec<_> =
            NAMES.iter().map(|&(word, name)| (name, self.plans[word])).collect();
        counts.push((("evaluate", "overflows"), overflows));
        counts.push((("stitch", "triangles.degenerate"), degenerate));
        if culls(config) {
            self.culled(patches as u64, &mut counts);
        }
        counts.push((("emit", "vertices.to_clipper"), homogeneous));
        let lit = config.evaluate.normals == Normals::TangentPlane;
        counts.push((("evaluate", "normals"), if lit { self.plans[VERTICES] } else { 0 }));
        counts.push((("evaluate", "normals.degenerate"), planes));
        self.bytes(config, &mut counts);
        counts
    }

    fn culled(&self, patches: u64, counts: &mut Vec<(Name, u64)>) {
        counts.push((("clip", "patches.in"), patches));
        counts.push((("clip", "patches.culled"), self.plans[CLIPPED]));
        counts.push((("backface", "patches.in"), patches - self.plans[CLIPPED]));
        counts.push((("backface", "patches.tested"), self.plans[3]));
        counts.push((("backface", "facets.tested"), self.plans[4]));
        counts.push((("backface", "patches.culled"), self.plans[CULLED]));
    }

    /// What left the unit and what the vertex shader takes and gives, in bytes.
    fn bytes(&self, config: &Config, counts: &mut Vec<(Name, u64)>) {
        let (vertices, triangles) = (self.plans[VERTICES], self.plans[TRIANGLES]);
        let (emit, shader) = (&config.emit, &config.vertex_shader);
        let attributes = self.plans[ATTRIBUTES] * config.attributes.component_bytes();
        let indices = 3 * triangles * u64::from(emit.index_bytes);
        let left = vertices * u64::from(emit.vertex_bytes) + attributes + indices;
        let normal = match config.evaluate.normals {
            Normals::Off => 0,
            Normals::TangentPlane => shader.bytes_in_normal,
        };
        let taken = vertices * u64::from(shader.bytes_in + normal) + attributes;
        counts.extend([
            (("emit", "bytes.attributes"), attributes),
            (("emit", "bytes"), left),
            (("vertex_shader", "invocations"), vertices),
            (("vertex_shader", "bytes.in"), taken),
            (("vertex_shader", "bytes.out"), vertices * u64::from(shader.bytes_out)),
        ]);
    }
}
