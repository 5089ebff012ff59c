//! How fast is time? Cycles a second of the engines: `stepped` on a plain pipeline of eight stages,
//! where every stage does something in every cycle, and `timed` on the same.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rtl_model::time::stepped::Stepped;
use rtl_model::time::timed::Timed;
use rtl_model::time::{Block, Cost, Emit, Frames, LaneOrder, Shape, Times};
use std::hint::black_box;

/// Tokens of a run: as many cycles, but for the latency.
const TOKENS: u32 = 100_000;

#[derive(Clone, Copy)]
struct Stage {
    interval: u32,
    latency: u32,
}

impl Block for Stage {
    type Token = u32;

    fn accept(&mut self, token: u32, out: &mut impl Emit<u32>) -> Cost {
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

criterion_group!(benches, pipeline);
criterion_main!(benches);
