//! Counters of both implementations beside each other, and those that one of them does not have.

use super::ledger::Ledger;
use crate::gpu::Name;
use rtl_model::counter::{Counters, DECLARATIONS};
use std::collections::BTreeMap;

/// Counters of blocks behind the port that the second implementation does not have: block, name,
/// why.
pub const NOT_COMPARED: &[(&str, &str, &str)] = &[];

/// Whether a counter is one that both have.
#[must_use]
pub fn compared(block: &str, name: &str) -> bool {
    !NOT_COMPARED.iter().any(|&(b, n, _)| b == block && n == name)
}

/// Compares what was counted in a frame, under the names of the second.
pub(super) fn compare(
    ledger: &mut Ledger,
    frame: usize,
    cpu: &Counters,
    gpu: &BTreeMap<Name, u64>,
) {
    for (&(block, name), &value) in gpu {
        let found = DECLARATIONS.iter().find(|d| d.block.name() == block && d.name == name);
        let declaration = found.expect("a count is of a counter that is declared");
        let split = |value: u64| [value as u32, (value >> 32) as u32];
        ledger.compare(
            ("unit", "counters"),
            &split(cpu.get(declaration.counter)),
            &split(value),
            || format!("frame {frame}, {block} {name}"),
            || "all patches of the frame".to_owned(),
        );
    }
}
