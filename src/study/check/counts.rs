//! Counters of both implementations beside each other, and those that one of them does not have.

use super::ledger::Ledger;
use crate::gpu::Name;
use rtl_model::counter::{Block, Counters, DECLARATIONS};
use std::collections::BTreeMap;

/// Counters of blocks behind the port that the second implementation does not have: block, name,
/// why.
pub const NOT_COMPARED: &[(&str, &str, &str)] = &[
    ("hull", "bytes.in", COMMAND),
    ("clip", "patches.culled.measured", UNION),
    ("backface", "patches.culled.measured", UNION),
    ("place", "patches.measured", UNION),
    ("place", "lists.peak", UNION),
    ("evaluate", "vertices.shared", PRIMITIVE),
    ("evaluate", "edge_vertices.peak", PRIMITIVE),
    ("group", "waves", WAVE),
    ("group", "invocations", WAVE),
    ("group", "lanes.idle", WAVE),
    ("group", "rounds", WAVE),
    ("surface", "lane_cycles", WAVE),
    ("surface", "lane_cycles.used", WAVE),
    ("surface", "lane_cycles.idle", WAVE),
    ("vertex_cache", "indices", HOST),
    ("vertex_cache", "indices.restarts", HOST),
    ("vertex_cache", "indices.repeated", HOST),
    ("vertex_cache", "strips", HOST),
    ("vertex_cache", "batches", HOST),
    ("vertex_cache", "hits", HOST),
    ("vertex_cache", "misses", HOST),
];

const COMMAND: &str = "says how its points were sent, of which nothing is left behind the port";
const UNION: &str = "of patches that share lists (level.union), for which there are no kernels";
const PRIMITIVE: &str = "of a primitive's edges: a patch behind the port is a patch by itself";
const HOST: &str = "says how the host indexes what it made, and what a device fetches of that";
const WAVE: &str = "of waves and of time, which come of the order of patches";

/// Whether a counter is one that both have.
#[must_use]
pub fn compared(block: &str, name: &str) -> bool {
    !NOT_COMPARED.iter().any(|&(b, n, _)| b == block && n == name)
}

/// Compares what was counted in a frame: every counter of the unit's blocks behind the port. One
/// that the second implementation should have and has not is a difference.
pub(super) fn compare(
    ledger: &mut Ledger,
    frame: usize,
    blocks: &[Block],
    cpu: &Counters,
    gpu: &BTreeMap<Name, u64>,
) {
    let behind = DECLARATIONS.iter().filter(|d| {
        let name = (d.block.name(), d.name);
        let theirs = d.block >= Block::Hull && d.block < Block::Unit && blocks.contains(&d.block);
        gpu.contains_key(&name) || (theirs && compared(name.0, name.1))
    });
    let split = |value: u64| [value as u32, (value >> 32) as u32];
    let mut found = 0;
    for declaration in behind {
        let (block, name) = (declaration.block.name(), declaration.name);
        let counted = gpu.get(&(block, name)).map(|&value| split(value));
        found += usize::from(counted.is_some());
        ledger.compare(
            ("unit", "counters"),
            &split(cpu.get(declaration.counter)),
            counted.as_ref().map_or(&[], |words| &words[..]),
            || format!("frame {frame}, {block} {name}"),
            || "all patches of the frame".to_owned(),
        );
    }
    assert_eq!(found, gpu.len(), "a count is of a counter that is declared");
}
