//! Timelines: their slices add up to `counters.csv`, their FIFO levels to `occupancy.csv`, their
//! bytes to the link's; both engines record the same; a window is the whole one cut; and what was
//! written reads back by other means.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

mod chrome;
mod command;
mod laws;
mod patches;
#[allow(dead_code, reason = "the tests of engines use the rest")]
#[path = "../engines/runs.rs"]
mod runs;
mod waveform;

use chrome::Seen;
use std::io::BufReader;
use tessim::config::Config;
use tessim::output::timeline::Labels;
use tessim::report::Report;
use tessim::report::timeline::{Timeline, Wanted, Window};
use tessim::sink::NoMesh;
use tessim::trace::read::Reader;
use tessim::unit::simulate_watched;

/// The units.
const UNITS: [&str; 6] = ["hybrid", "sfarti", "moreton", "d3d11", "esc", "triangles"];

/// Settings under which lanes wait for each other, and blocks for the port.
const CROWDED: [&[&str]; 5] = [
    &["block.evaluate.lanes=3", "block.stitch.lanes=2", "block.backface.lanes=4"],
    &["block.stitch.lane_order=round_robin", "block.stitch.lanes=3", "block.emit.interval=2"],
    &["memory.channels=shared", "vertex_shader.to_memory=true", "memory.bandwidth_mb_s=9000"],
    &[
        "memory.channels=shared",
        "vertex_shader.to_memory=true",
        "memory.bandwidth_mb_s=9000",
        "block.vertex_shader.lanes=3",
        "block.evaluate.lanes=2",
    ],
    &["link.transfer=pull", "block.level.interval=30"],
];

/// The timeline of a part of a run.
fn watch(text: &str, config: &Config, wanted: &Wanted) -> (Report, Timeline) {
    let reader = Reader::new(BufReader::new(text.as_bytes()), "text", "traces");
    let commands = reader.map(|located| Ok(located?.command));
    simulate_watched(commands, config, &mut NoMesh, wanted).expect("a run")
}

/// All of a frame.
fn whole(frame: u64) -> Wanted {
    Wanted { frame, window: Window::Whole }
}

/// Written as a Chrome trace and read back.
fn seen(timeline: &Timeline, config: &Config) -> Seen {
    let labels = Labels { title: "a \"trace\"", config };
    let mut bytes = Vec::new();
    tessim::output::timeline::chrome::write(timeline, &labels, &mut bytes).unwrap();
    Seen::read(&bytes)
}
