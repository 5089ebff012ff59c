//! Runs under the engines: traces by name, configurations by settings, and what a run says, whole.

use std::io::BufReader;
use tessim::config::layers::Layers;
use tessim::config::preset::Preset;
use tessim::config::{Config, Engine};
use tessim::output;
use tessim::report::Report;
use tessim::sink::{NoMesh, Sink};
use tessim::trace::command::Tessellation;
use tessim::trace::read::Reader;
use tessim::trace::scene::grid::Grid;
use tessim::trace::scene::teacups::Teacups;
use tessim::unit::simulate;

/// The traces that are shipped.
pub(crate) const SHIPPED: [&str; 8] =
    ["fan", "indexed", "mesh", "rational", "strip", "teacup", "teapot", "teaspoon"];

/// A shipped trace.
pub(crate) fn shipped(name: &str) -> String {
    std::fs::read_to_string(format!("traces/{name}.jsonl")).expect("a shipped trace")
}

/// Levels up to `max_level`.
fn up_to(max_level: u32) -> Tessellation {
    Tessellation { max_level: max_level << 16, ..Tessellation::default() }
}

/// Cups whose points are resident, frame after frame: instances, some of them clipped.
pub(crate) fn teacups(count: u32, frames: u32, max_level: u32) -> String {
    let mut text = Vec::new();
    let scene = Teacups { count, frames, tessellation: up_to(max_level) };
    scene.write(&mut text).expect("a vector takes it all");
    String::from_utf8(text).expect("text")
}

/// A bumpy surface, each of its meshes sent when it is drawn.
pub(crate) fn grid(side: u32, max_level: u32) -> String {
    let mut text = Vec::new();
    let scene = Grid { rows: side, columns: side, tessellation: up_to(max_level) };
    scene.write(&mut text).expect("a vector takes it all");
    String::from_utf8(text).expect("text")
}

/// The same surface with points in device memory: uploads between the draws that read them.
pub(crate) fn resident_grid(side: u32, max_level: u32) -> String {
    let immediate = grid(side, max_level);
    let resident = immediate.replace(r#"{"points":{"#, r#"{"points":{"resident":true,"#);
    assert_ne!(immediate, resident);
    resident
}

/// A preset under settings, as `--preset` and `--set` give them.
pub(crate) fn configuration(preset: &str, settings: &[&str]) -> Config {
    let mut layers = Layers::new(Preset::named(preset).expect("a preset"));
    let settings: Vec<_> = settings.iter().map(|&setting| setting.to_owned()).collect();
    layers.set(&settings).expect("keys and values");
    layers.finish().expect("a configuration")
}

/// The default configuration under settings.
pub(crate) fn set(settings: &[&str]) -> Config {
    configuration("modern", settings)
}

/// A run, its meshes sent to `sink`.
pub(crate) fn run_into(text: &str, config: &Config, sink: &mut dyn Sink) -> Report {
    let reader = Reader::new(BufReader::new(text.as_bytes()), "text", "traces");
    simulate(reader.map(|located| Ok(located?.command)), config, sink).expect("a run")
}

/// A run that only counts.
pub(crate) fn run(text: &str, config: &Config) -> Report {
    run_into(text, config, &mut NoMesh)
}

/// A run under `engine`, whatever `config` says.
pub(crate) fn run_by(engine: Engine, text: &str, config: &Config) -> Report {
    run(text, &Config { engine, ..config.clone() })
}

/// Everything that a report says of a run: `counters.csv`, and the cycles of each FIFO at each
/// number of entries.
pub(crate) type Said = (String, Vec<Vec<u64>>);

pub(crate) fn said(report: &Report) -> Said {
    let mut csv = Vec::new();
    output::counters::write(report, &mut csv).expect("a vector takes it all");
    (String::from_utf8(csv).expect("text"), report.occupancy.clone())
}

/// Cycles of the whole run.
pub(crate) fn elapsed(report: &Report) -> u64 {
    report.frames.iter().map(|frame| frame.times.as_ref().expect("it is timed").elapsed).sum()
}

/// Tokens that the blocks of the chain accepted.
pub(crate) fn tokens(report: &Report) -> u64 {
    report.whole().work.iter().map(|work| work.tokens_in).sum()
}

/// The row `block.name` of the whole run.
pub(crate) fn row(report: &Report, block: &str, name: &str) -> u64 {
    let rows = report.rows(&report.whole());
    let row = rows.iter().find(|row| row.block.name() == block && row.name == name);
    row.unwrap_or_else(|| panic!("no row {block}.{name}")).value
}
