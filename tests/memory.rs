//! Memory does not grow with the trace: a grid of many patches runs in the memory of a small one,
//! with counters and with a mesh. One test, for it looks at the peak of the whole process.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;

use rtl_model::counter::Counter;
use rtl_model::patch::Level;
use std::io::BufReader;
use tessim::config::Config;
use tessim::output::mesh::{MeshFile, MeshForm};
use tessim::sink::{NoMesh, Sink};
use tessim::trace::command::Tessellation;
use tessim::trace::read::Reader;
use tessim::trace::scene::grid::Grid;
use tessim::unit::simulate;

/// The most that a run of any length may take.
const BYTES_MAX: u64 = 256 << 20;

/// Peak resident bytes of this process, where the system says.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib << 10)
}

/// Runs a grid of `side` by `side` patches, written by another thread as it is read.
fn run(side: u32, sink: &mut dyn Sink) {
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
    let mut config = Config::default();
    config.backface.method = tessim::config::BackfaceMethod::Off;
    let report = simulate(commands, &config, sink).expect("a grid runs");
    writer.join().expect("the writer ends").expect("the pipe holds");
    assert_eq!(report.total(Counter::AssemblePatches), u64::from(side) * u64::from(side));
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
        run(side, &mut mesh);
        mesh.finish(1).expect("a mesh");
        peak().expect("as before")
    };
    run(100, &mut NoMesh);
    let (short, short_mesh) = (peak().expect("as before"), run_with_mesh(100));
    let (long_mesh, patches) = (run_with_mesh(long), u64::from(long) * u64::from(long));
    run(long, &mut NoMesh);
    let end = peak().expect("as before");
    println!(
        "compared peaks: start {before}, 10000 patches {short}, with ply {short_mesh}; \
         {patches} patches with ply {long_mesh}, end {end}"
    );
    assert!(end <= BYTES_MAX, "{end} bytes");
    assert!(end as f64 <= 1.1 * short_mesh as f64, "{end} bytes after {short_mesh}");
}
