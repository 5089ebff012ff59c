//! How fast is function? Triangles a second through the whole unit, trace parsing excluded: teacups
//! at level 16, with and without culling and divide, on one thread and on two.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rtl_model::counter::Counter;
use rtl_model::level;
use rtl_model::patch::Level;
use std::hint::black_box;
use std::io::BufReader;
use tessim::config::{BackfaceMethod, Config};
use tessim::sink::NoMesh;
use tessim::trace::command::{Command, Tessellation};
use tessim::trace::read::Reader;
use tessim::trace::scene::teacups::Teacups;
use tessim::unit::simulate;

/// A frame of a hundred teacups at fixed level 16.
fn teacups() -> Vec<Command> {
    let fixed = level::Criterion::Fixed { level: Level::clamped(16 << 16) };
    let tessellation = Tessellation { criterion: fixed, min_level: 1 << 16, max_level: 64 << 16 };
    let scene = Teacups { count: 100, frames: 4, tessellation };
    let mut text = Vec::new();
    scene.write(&mut text).expect("a vector takes it all");
    let reader = Reader::new(BufReader::new(&text[..]), "teacups", ".");
    reader.map(|located| located.expect("a scene is well-formed").command).collect()
}

fn run(commands: &[Command], config: &Config) -> u64 {
    let commands = commands.iter().cloned().map(Ok);
    let report = simulate(commands, config, &mut NoMesh).expect("a scene runs");
    report.total(Counter::EmitTriangles)
}

fn function(criterion: &mut Criterion) {
    let commands = teacups();
    let whole = Config::default();
    let mut bare = Config::default();
    bare.clip.enabled = false;
    bare.backface.method = BackfaceMethod::Off;
    bare.emit.divide = false;
    let mut group = criterion.benchmark_group("function");
    group.sample_size(20);
    for (name, config) in [("with culling and divide", &whole), ("without", &bare)] {
        group.throughput(Throughput::Elements(run(&commands, config)));
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.expect("a pool of a thread or two");
            group.bench_function(format!("{name}, {threads} threads"), |bencher| {
                pool.install(|| bencher.iter(|| run(black_box(&commands), config)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, function);
criterion_main!(benches);
