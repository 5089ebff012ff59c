//! One memory port for reads, uploads and what the vertex shader writes: who waits for it, and what
//! that costs.

use crate::runs::{self, elapsed, row, run, run_by, said, set};
use rtl_model::counter::Counter;
use tessim::config::Engine;

/// A port of a byte a cycle: 32 cycles a vertex, some 200 a patch.
const SLOW: [&str; 2] = ["memory.bandwidth_mb_s=2000", "vertex_shader.to_memory=true"];

#[test]
fn stages_that_share_a_port_wait_for_it_and_those_with_channels_do_not() {
    let (port, channels) = ("memory.channels=shared", "memory.channels=separate");
    for text in [runs::teacups(3, 3, 4), runs::resident_grid(18, 3)] {
        let shared = set(&[SLOW[0], SLOW[1], port]);
        let [timed, stepped] =
            [Engine::Timed, Engine::Stepped].map(|engine| run_by(engine, &text, &shared));
        assert!(said(&timed) == said(&stepped), "the engines agree");
        let waits = |block| row(&timed, block, "cycles.starved.by.memory_port");
        assert!(waits("memory") > 0 && waits("vertex_shader") > 0);
        let separate = run(&text, &set(&[SLOW[0], SLOW[1], channels]));
        assert!(elapsed(&timed) > elapsed(&separate));
        // A channel of its own is no shared port (assemble waits for the block of that name).
        let rows = said(&separate).0;
        for block in ["memory", "vertex_shader"] {
            assert!(!rows.contains(&format!(",{block},cycles.starved.by.memory_port,")));
        }
        // The port is never held by two at once: all that moves through it fits in the run.
        let vertices = timed.total(Counter::VertexShaderInvocations);
        let moved = 32 * vertices + timed.total(Counter::MemoryBursts) * 32;
        assert!(elapsed(&timed) >= moved, "{} cycles for {moved} bytes", elapsed(&timed));
        assert!(elapsed(&separate) < moved, "two channels overlap");
        println!(
            "compared {} with {} cycles; memory waits {}, the shader {}",
            elapsed(&timed),
            elapsed(&separate),
            waits("memory"),
            waits("vertex_shader")
        );
    }
}

#[test]
fn points_on_chip_do_not_ask_for_the_port() {
    // The same surface: its points in device memory, or sent with each draw.
    let config = set(&[SLOW[0], "memory.channels=shared"]);
    let [resident, immediate] =
        [runs::resident_grid(18, 3), runs::grid(18, 3)].map(|text| run(&text, &config));
    assert_eq!(immediate.total(Counter::MemoryBursts), 0);
    assert!(resident.total(Counter::MemoryBursts) > 0);
    assert!(elapsed(&resident) > elapsed(&immediate));
    assert_eq!(row(&immediate, "memory", "cycles.starved.by.memory_port"), 0);
    // A memory of any speed is the same to a run that does not use it.
    let fast = run(&runs::grid(18, 3), &set(&["memory.channels=shared"]));
    assert_eq!(said(&fast), said(&immediate));
}

#[test]
fn a_resident_mesh_is_read_once_an_instance_in_the_time_of_its_bursts() {
    // Reads bind: nothing else is slower than a byte a cycle.
    let text = runs::teacups(40, 1, 1);
    let config =
        set(&["memory.bandwidth_mb_s=1000", "memory.latency=7", "memory.outstanding=4096"]);
    let report = run(&text, &config);
    // Every instance reads 26 patches of 192 bytes: 6 bursts of 32 each, exactly. Half a byte a
    // cycle.
    assert_eq!(report.total(Counter::MemoryBursts), (40 + 1) * 26 * 6);
    let reads = 40 * 26 * 192 * 2;
    let upload = 26 * 192 * 2 - report.total(Counter::LinkControlPoints) * 2000 / 31_508;
    let used = row(&report, "memory", "cycles.used");
    // The upload's one command brings 8 bytes of header and its packets' framing over the link.
    assert!(used.abs_diff(reads + upload) < 100, "{used} cycles, {reads} + {upload} by hand");
    let rest = elapsed(&report) - used;
    assert!(rest < 1500, "{rest} cycles are not memory's");
}
