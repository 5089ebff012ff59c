//! Memory does not grow with the trace: a grid of many patches runs in the memory of a small one,
//! with counters and with a mesh, under every engine. One test, for it looks at the peak of the
//! whole process.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;

use rtl_model::counter::Counter;
use rtl_model::patch::Level;
use std::io::BufReader;
use tessim::config::{Channels, Config, Engine};
use tessim::output::mesh::{MeshFile, MeshForm};
use tessim::sink::{NoMesh, Sink};
use tessim::trace::command::Tessellation;
use tessim::trace::read::Reader;
use tessim::trace::scene::grid::Grid;
use tessim::unit::simulate;

/// The most that a run of any length may take.
const BYTES_MAX: u64 = 256 << 20;

/// By how much the peaks of like runs differ: what allocators keep, by how threads happen to share
/// the work. If each of 150 000 more patches left 14 bytes behind, it would be more.
const NOISE: u64 = 2 << 20;

/// Peak resident bytes of this process, where the system says.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib << 10)
}

/// Runs a grid of `side` by `side` patches, written by another thread as it is read. Returns its
/// cycles.
fn run(side: u32, engine: Engine, channels: Channels, sink: &mut dyn Sink) -> u64 {
    let level = Level::MIN;
    let criterion = rtl_model::level::Criterion::Fixed { level };
    let tessellation = Tessellation { criterion, ..Tessellation::default() };
    let (input, output) = std::io::pipe().expect("a pipe");
    let writer = std::thread::spawn(move || {
        let mut output = std::io::BufWriter::new(output);
        Grid { rows: side, columns: side, tessellation }.write(&mut output)
    });
    let reader = Reader::new(BufReader::new(input), "grid", ".");
    let commands = reader.map(|located| Ok(located?.command));
    let mut config = Config { engine, ..Config::default() };
    config.memory.channels = channels;
    config.backface.method = tessim::config::BackfaceMethod::Off;
    let report = simulate(commands, &config, sink).expect("a grid runs");
    writer.join().expect("the writer ends").expect("the pipe holds");
    assert_eq!(report.total(Counter::AssemblePatches), u64::from(side) * u64::from(side));
    report.whole().times.expect("it is timed").elapsed
}

/// A run that only counts.
fn count(side: u32, engine: Engine, channels: Channels) -> u64 {
    run(side, engine, channels, &mut NoMesh)
}

#[test]
fn a_long_trace_runs_in_the_memory_of_a_short_one() {
    let Some(before) = peak() else {
        println!("SKIPPED memory: no /proc/self/status here");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let config = Config::default();
    let long = run::scale(400, 1000) as u32;
    let run_with_mesh = |side| {
        let mut mesh =
            MeshFile::create(MeshForm::Ply, folder.path(), 0, "grid", &config).expect("a mesh");
        run(side, Engine::Timed, Channels::Separate, &mut mesh);
        mesh.finish(1).expect("a mesh");
        peak().expect("as before")
    };
    // The event-ordered engine times a shared port; the engines that others are held against have
    // queues of tokens, which must not become as long as the run either.
    let others = |side| {
        let stepped = count(side, Engine::Stepped, Channels::Separate);
        [stepped, count(side, Engine::Timed, Channels::Shared)]
    };
    count(100, Engine::Timed, Channels::Separate);
    others(100);
    let (short, short_mesh) = (peak().expect("as before"), run_with_mesh(100));
    let (long_mesh, patches) = (run_with_mesh(long), u64::from(long) * u64::from(long));
    let timed = count(long, Engine::Timed, Channels::Separate);
    let end_timed = peak().expect("as before");
    let [stepped, ordered] = others(long);
    assert_eq!(stepped, timed, "the engines agree");
    let end = peak().expect("as before");
    println!(
        "compared peaks: start {before}, 10000 patches {short}, with ply {short_mesh}; \
         {patches} patches with ply {long_mesh}, timed {end_timed}, stepped and ordered {end}; \
         {timed} cycles, {ordered} where the port is shared"
    );
    assert!(timed > 9 * patches, "{timed} cycles: nine points of a patch, one a cycle");
    assert!(end <= BYTES_MAX, "{end} bytes");
    assert!(end <= short_mesh + NOISE, "{end} bytes after {short_mesh}");
}
