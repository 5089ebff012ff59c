//! What the rows of a run say of each other: every cycle of every lane is in one row, what leaves a
//! block enters the next, and the run's cycles are each block's.

use crate::runs::{self, run, set};
use rtl_model::counter::standard::Stage;
use std::collections::HashMap;
use tessim::report::{Frame, Report};

/// The rows of a frame by their names.
fn named(report: &Report, frame: &Frame) -> HashMap<String, u64> {
    let rows = report.rows(frame);
    let count = rows.len();
    let named: HashMap<_, _> = rows
        .into_iter()
        .map(|row| (format!("{}.{}", row.block.name(), row.name), row.value))
        .collect();
    assert_eq!(named.len(), count, "names are distinct");
    named
}

/// Holds a block's rows against each other. `of_run`: they are those of a whole run, or of a frame
/// that drains.
fn block(rows: &HashMap<String, u64>, stage: &Stage, of_run: bool) {
    let name = stage.block.name();
    let get = |row: &str| rows[&format!("{name}.{row}")];
    let sum = |prefix: &str| -> u64 {
        let prefix = format!("{name}.{prefix}");
        rows.iter().filter(|(row, _)| row.starts_with(&prefix)).map(|(_, value)| value).sum()
    };
    let [busy, starved, blocked, total] =
        ["busy", "starved", "blocked", "total"].map(|row| get(&format!("cycles.{row}")));
    assert_eq!(starved, sum("cycles.starved.by."), "{name}");
    assert_eq!(blocked, sum("cycles.blocked.by."), "{name}");
    assert_eq!(busy + starved + blocked, total, "{name}");
    if of_run {
        let lanes = u64::from(stage.shape.lanes);
        assert_eq!(total, lanes * rows["unit.cycles.total"], "{name}: {lanes} lanes");
        assert!(get("cycles.used") <= busy + blocked, "{name}");
    }
    if let Some(peak) = rows.get(&format!("{name}.fifo.peak")) {
        assert!(*peak <= u64::from(stage.shape.depth), "{name}");
        assert!(*peak > 0 || get("tokens.in") == 0, "{name}: what passes a FIFO was in it");
    }
}

fn frame(report: &Report, frame: &Frame, of_run: bool) -> usize {
    let rows = named(report, frame);
    for stage in &report.chain {
        block(&rows, stage, of_run);
    }
    for pair in report.chain.windows(2) {
        let [from, to] = [0, 1].map(|k| pair[k].block.name());
        let moved = |block: &str, row: &str| rows[&format!("{block}.tokens.{row}")];
        assert_eq!(moved(from, "out"), moved(to, "in"), "from {from} to {to}");
    }
    rows.len()
}

#[test]
fn every_cycle_of_every_lane_is_in_one_row() {
    let port = ["memory.channels=shared", "vertex_shader.to_memory=true"];
    let lanes = ["block.evaluate.lanes=3", "block.stitch.lanes=2", "block.backface.lanes=4"];
    let configurations: [Vec<&str>; 9] = [
        vec![],
        vec!["unit=triangles", "link.bus=agp1x"],
        vec!["unit=triangles", "block.vertex_shader.lanes=7", "block.vertex_shader.interval=9"],
        vec!["block.stitch.lane_order=round_robin", lanes[0], lanes[1], lanes[2]],
        vec![port[0], port[1], "memory.bandwidth_mb_s=9000", lanes[0]],
        vec!["unit=d3d11", port[0], "hull.to_memory=true", "block.domain.lanes=3"],
        vec!["block.emit.interval=2", "block.level.interval=30", "link.transfer=pull"],
        vec!["unit=esc", "esc.width=5", "block.surface.lanes=3", port[0]],
        vec!["unit=esc", "esc.width=2", "esc.reuse=none", "block.emit.interval=40"],
    ];
    let (mut rows, mut kinds) = (0, HashMap::<String, u64>::new());
    for text in [runs::shipped("mesh"), runs::teacups(3, 3, 4), runs::resident_grid(18, 3)] {
        for settings in &configurations {
            for frames in ["frames=drain", "frames=overlap"] {
                let report = run(&text, &set(&[&settings[..], &[frames]].concat()));
                let drain = frames == "frames=drain";
                rows += report.frames.iter().map(|f| frame(&report, f, drain)).sum::<usize>();
                rows += frame(&report, &report.whole(), true);
                for row in report.rows(&report.whole()) {
                    let Some((kind, by)) = row.name.rsplit_once(".by.") else { continue };
                    let is_neighbour = by != "order" && by != "memory_port";
                    let by = if is_neighbour { "a neighbour" } else { by };
                    *kinds.entry(format!("{kind} by {by}")).or_default() += row.value;
                }
            }
        }
    }
    // Laws between rows that are always 0 would hold of anything.
    for kind in [
        "blocked by a neighbour",
        "blocked by order",
        "starved by a neighbour",
        "starved by memory_port",
    ] {
        assert!(kinds[&format!("cycles.{kind}")] > 0, "{kind} did not occur: {kinds:?}");
    }
    println!("compared {rows} rows");
}

#[test]
fn frames_that_overlap_take_no_longer_and_do_the_same() {
    let text = runs::teacups(3, 4, 4);
    let [drain, overlap] =
        ["drain", "overlap"].map(|frames| run(&text, &set(&[&format!("frames={frames}")])));
    let whole = [&drain, &overlap].map(Report::whole);
    assert_eq!(whole[0].work, whole[1].work);
    let [apart, together] = [&drain, &overlap].map(runs::elapsed);
    assert!(together < apart, "{together} cycles, apart {apart}");
    // Three times a frame need not wait for the last one's 200 cycles in the vertex shader.
    assert!(apart - together > 3 * 200, "{together} cycles, apart {apart}");
    println!("compared {apart} with {together} cycles");
}
