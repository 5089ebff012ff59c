//! How fast is function? Triangles a second through the whole unit, trace parsing excluded: teacups
//! at level 16, with and without culling and divide, on one thread and on two.

mod scene;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rtl_model::counter::Counter;
use scene::teacups;
use std::hint::black_box;
use tessim::config::{BackfaceMethod, Config, Engine};
use tessim::sink::NoMesh;
use tessim::trace::command::Command;
use tessim::unit::simulate;

fn run(commands: &[Command], config: &Config) -> u64 {
    let commands = commands.iter().cloned().map(Ok);
    let report = simulate(commands, config, &mut NoMesh).expect("a scene runs");
    report.total(Counter::EmitTriangles)
}

fn function(criterion: &mut Criterion) {
    let commands = teacups();
    let whole = Config { engine: Engine::None, ..Config::default() };
    let mut bare = whole.clone();
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
