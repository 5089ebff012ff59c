//! The bench: a source, the FIFO before, the Verilated stitcher, the FIFO behind and a sink.

use crate::reference::{DEPTH_BEFORE, Run, Times, times};
use crate::stimulus::Random;
use crate::verilated::{Inputs, Stitcher};
use rtl_model::strip::{Kind, Strip};
use std::time::Instant;

/// Cycles of a run: long enough for all phases.
const CYCLES: usize = 32_768;

/// The times of the hardware's run.
fn drive(run: &Run, stitcher: &mut Stitcher) -> Times {
    let mut times = Times::default();
    let (mut pushed, mut popped) = (0, 0);
    for (cycle, (&source, &sink)) in run.source.iter().zip(&run.sink).enumerate() {
        // All of these are what the cycle begins with: pushes and pops of it are seen in the next.
        let before = pushed - times.accepted.len();
        let behind = times.emitted.len() - popped;
        let head = (before > 0).then(|| &run.strips[times.accepted.len()]);
        let outputs = stitcher.cycle(&Inputs::of(head, behind < run.depth));
        if outputs.accepts() {
            assert!(head.is_some(), "cycle {cycle}: accepts from an empty FIFO");
            times.accepted.push(cycle);
        }
        times.emitted.extend(outputs.triangle().map(|triangle| (cycle, triangle)));
        pushed += usize::from(source && before < DEPTH_BEFORE && pushed < run.strips.len());
        popped += usize::from(sink && behind > 0);
    }
    times
}

/// What is compared must be all that there is: each kind of strip, and each reason to wait.
#[derive(Debug, Default)]
struct Seen {
    lower_cells: usize,
    upper_cells: usize,
    down_a_column: usize,
    single: usize,
    mirrored: usize,
    across_below_two: usize,
    to_vertex_zero: usize,
    waited_for_slot: usize,
    waited_for_room: usize,
}

impl Seen {
    fn add(&mut self, strip: &Strip) {
        let bresenham = strip.kind == Kind::Bresenham;
        let count = |sum: &mut usize, seen: bool| *sum += usize::from(seen);
        count(&mut self.lower_cells, strip.kind == Kind::Cells { lower: true });
        count(&mut self.upper_cells, strip.kind == Kind::Cells { lower: false });
        count(&mut self.single, strip.count() == 1);
        count(&mut self.mirrored, strip.mirrored);
        count(&mut self.down_a_column, strip.inner.step < -1);
        count(&mut self.across_below_two, bresenham && strip.inner_segments == 1);
        count(&mut self.to_vertex_zero, bresenham && strip.outer.first == strip.end);
    }

    fn least(&self) -> usize {
        let cells = self.lower_cells.min(self.upper_cells);
        let sides = self.mirrored.min(self.down_a_column).min(self.to_vertex_zero);
        let small = self.single.min(self.across_below_two);
        cells.min(sides).min(small).min(self.waited_for_slot).min(self.waited_for_room)
    }
}

#[test]
fn the_hardware_description_keeps_step_with_the_block() {
    let long = std::env::var_os("TESSIM_LONG").is_some();
    let (mut random, mut seen) = (Random(0x57_17c4), Seen::default());
    let (mut cycles, mut strips, mut triangles) = (0, 0, 0);
    let (mut hardware, runs) = (std::time::Duration::ZERO, if long { 2000 } else { 200 });
    for number in 0..runs {
        let run = random.run(CYCLES);
        let want = times(&run);
        let mut stitcher = Stitcher::new();
        let started = Instant::now();
        let got = drive(&run, &mut stitcher);
        hardware += started.elapsed();
        compare(number, &run, &got, &want);
        cycles += CYCLES;
        strips += got.accepted.len();
        triangles += got.emitted.len();
        run.strips[..got.accepted.len()].iter().for_each(|strip| seen.add(strip));
        seen.waited_for_slot += want.waited_for_slot;
        seen.waited_for_room += want.waited_for_room;
    }
    let speed = cycles as f64 / hardware.as_secs_f64() / 1e6;
    println!("compared {cycles} cycles, {strips} strips, {triangles} triangles");
    println!("of these {seen:?}; the hardware ran at {speed:.1} Mcycle/s");
    assert!(cycles >= 1_000_000 && strips > 50_000 && triangles > 500_000);
    assert!(seen.least() > 1000, "something was hardly seen");
}

/// The first difference is what one wants to see, with the strip that it is about.
fn compare(number: usize, run: &Run, got: &Times, want: &Times) {
    for (m, strip) in run.strips.iter().enumerate() {
        let (got, want) = (got.accepted.get(m), want.accepted.get(m));
        assert_eq!(got, want, "run {number}: strip {m} is accepted, {strip:?}");
    }
    for k in 0..got.emitted.len().max(want.emitted.len()) {
        let (got, want) = (got.emitted.get(k), want.emitted.get(k));
        assert_eq!(got, want, "run {number}: triangle {k} of depth {} leaves", run.depth);
    }
}
