//! How fast is time? Cycles a second of the engines on a plain pipeline of eight stages, dense (all
//! stages do something in every cycle) and sparse; the whole unit, end to end; and the engines
//! alone over what the host sent in that run, dense, and sparse behind a slow shader.

mod scene;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rtl_model::counter::Counter;
use rtl_model::time::stepped::Stepped;
use rtl_model::time::timed::Timed;
use rtl_model::time::{Block, Cost, Emit, Frames, LaneOrder, Shape, Times};
use scene::teacups;
use std::hint::black_box;
use tessim::config::{Config, Engine};
use tessim::sink::NoMesh;
use tessim::unit::{record, simulate};

/// Tokens of a run: as many cycles, but for the latency.
const TOKENS: u32 = 100_000;

#[derive(Clone, Copy)]
struct Stage {
    interval: u32,
    latency: u32,
}

impl Block for Stage {
    type Token = u32;

    fn accept(&mut self, &token: &u32, out: &mut impl Emit<u32>) -> Cost {
        out.emit(token, self.latency.into());
        Cost { interval: self.interval.into(), latency: self.latency.into() }
    }
}

/// Eight stages, of which the slowest takes a token every `interval` cycles.
fn chain(interval: u32) -> Vec<(Stage, Shape)> {
    let shape =
        Shape { depth: 8, in_flight: 4, lanes: 1, order: LaneOrder::FirstFree, shares_port: false };
    let stage =
        |k: u32| (Stage { interval: if k == 4 { interval } else { 1 }, latency: 1 + k % 3 }, shape);
    (0..8).map(stage).collect()
}

fn timed(interval: u32) -> Times {
    let mut engine = Timed::<_, _>::new(chain(interval), Frames::Drain, ());
    (0..TOKENS).for_each(|token| engine.feed(token));
    engine.end_frame();
    engine.finish().0
}

fn stepped(interval: u32) -> Times {
    let mut engine = Stepped::new(chain(interval), Frames::Drain, ());
    (0..TOKENS).for_each(|token| engine.feed(token));
    engine.end_frame();
    engine.finish().0
}

fn one_thread() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread")
}

/// The same run by each engine: triangles a second.
fn end_to_end(criterion: &mut Criterion) {
    let commands = teacups();
    let run = |engine: Engine| {
        let config = Config { engine, ..Config::default() };
        let commands = commands.iter().cloned().map(Ok);
        simulate(commands, &config, &mut NoMesh).expect("a scene runs")
    };
    let report = run(Engine::Timed);
    let triangles = report.total(Counter::EmitTriangles);
    let cycles = report.whole().times.expect("it was timed").elapsed;
    println!("end to end: {triangles} triangles, {cycles} cycles");
    let mut group = criterion.benchmark_group("end to end");
    group.sample_size(10).throughput(Throughput::Elements(triangles));
    let pool = one_thread();
    for engine in Engine::ALL {
        group.bench_function(engine.name(), |bencher| {
            pool.install(|| bencher.iter(|| run(black_box(engine))));
        });
    }
    group.finish();
}

/// The engines alone over recorded tokens: cycles a second.
fn overlay(criterion: &mut Criterion) {
    let commands = teacups();
    let mut group = criterion.benchmark_group("overlay");
    group.sample_size(10);
    for (load, slow) in [("dense", false), ("sparse", true)] {
        let mut config = Config::default();
        if slow {
            // A shader of forty cycles a vertex: all else waits.
            config.block.vertex_shader.interval = 40;
            config.block.vertex_shader.in_flight = Some(6);
        }
        let recording = record(commands.iter().cloned().map(Ok), &config).expect("a scene runs");
        let replay = |engine: Engine| {
            let times = recording.replay(&Config { engine, ..config.clone() });
            times.expect("an engine ran").frames
        };
        let frames = replay(Engine::Timed);
        assert_eq!(frames, replay(Engine::Stepped), "they agree on what they are timed on");
        let cycles = frames.iter().map(|frame| frame.elapsed).sum();
        group.throughput(Throughput::Elements(cycles));
        for engine in [Engine::Timed, Engine::Stepped] {
            let name = format!("{}, {load}", engine.name());
            group.bench_function(name, |b| b.iter(|| replay(black_box(engine))));
        }
    }
    group.finish();
}

fn pipeline(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("eight stages");
    group.sample_size(20);
    for (load, interval) in [("dense", 1), ("sparse", 20)] {
        let times = timed(interval);
        assert_eq!(times, stepped(interval), "they agree on what they are timed on");
        group.throughput(Throughput::Elements(times.frames[0].elapsed));
        group.bench_function(format!("timed, {load}"), |b| b.iter(|| timed(black_box(interval))));
        group.bench_function(format!("stepped, {load}"), |b| {
            b.iter(|| stepped(black_box(interval)));
        });
    }
    group.finish();
}

criterion_group!(benches, pipeline, end_to_end, overlay);
criterion_main!(benches);
