//! The stitcher of `sv/stitch.sv` against the Rust block, cycle by cycle: every triangle's value
//! and cycle, and the cycle in which every strip is accepted.
//!
//! The Rust side is the block's schedule under the rules of `time.rs`; the SystemVerilog is run by
//! Verilator (feature `verilator`) between two FIFOs that the bench models. Neither sees the other.

#[cfg(verilated)]
mod bench;
mod reference;
#[cfg(verilated)]
mod stimulus;
#[cfg(verilated)]
mod verilated;

use reference::{Run, times};
use rtl_model::patch::{Level, Levels};
use rtl_model::place::Placement;
use rtl_model::strip::Topology;

#[cfg(not(verilated))]
#[test]
fn the_hardware_description_keeps_step_with_the_block() {
    let reason = option_env!("NOT_VERILATED").unwrap_or("built without the feature `verilator`");
    println!("SKIPPED the_hardware_description_keeps_step_with_the_block: {reason}");
}

/// The reference itself, against tables by hand: four strips of one triangle each.
#[test]
fn the_reference_keeps_the_rules_by_hand() {
    let mut placement = Placement::default();
    placement.set(&Levels { edges: [Level::MIN; 4], interior: [Level::TWO; 2] });
    let run = |source: &[u8], sink: &[u8], depth| {
        let cycles = |willing: &[u8]| willing.iter().map(|&w| w == b'+').collect();
        let strips = placement.segments().strips().collect();
        let times = times(&Run { strips, source: cycles(source), sink: cycles(sink), depth });
        let emitted: Vec<usize> = times.emitted.iter().map(|&(cycle, _)| cycle).collect();
        (times.accepted, emitted)
    };
    // Pushed in 0 1 2 3; a push is seen a cycle later, and so is a strip in its triangle.
    assert_eq!(run(b"++++++++", b"++++++++", 2), (vec![1, 2, 3, 4], vec![2, 3, 4, 5]));
    assert_eq!(run(b"+--+++++", b"++++++++", 2), (vec![1, 4, 5, 6], vec![2, 5, 6, 7]));
    // Two places in the FIFO and two slots: the fifth triangle would wait in the source.
    assert_eq!(run(b"++++++++++", b"----------", 2), (vec![1, 2, 3, 4], vec![2, 3]));
    // Popped in 6: room in 7, and a slot in 8.
    assert_eq!(run(b"++++++++++", b"------++++", 2), (vec![1, 2, 3, 4], vec![2, 3, 7, 8]));
    // Depth 1, popped in the cycle after: every other cycle, and a slot for the last in 5.
    assert_eq!(run(b"++++++++++", b"++++++++++", 1), (vec![1, 2, 3, 5], vec![2, 4, 6, 8]));
}
