//! Closed forms, and tables worked by hand: each line of a comment is a line of the working.

use crate::pipeline::Log;
use rtl_model::time::ordered::Ordered;
use rtl_model::time::stepped::Stepped;
use rtl_model::time::timed::Timed;
use rtl_model::time::{Block, Cost, Emit, Frames, LaneOrder, Shape, StageTimes, Times};

/// A block with one cost for all tokens, or one for each.
#[derive(Clone, Debug)]
struct Script {
    costs: Vec<(u32, Vec<u32>)>,
    next: usize,
    port: Option<u64>,
}

impl Script {
    /// Interval, and the offsets of the outputs.
    fn of(costs: &[(u32, &[u32])]) -> Self {
        let costs = costs.iter().map(|(interval, offsets)| (*interval, offsets.to_vec())).collect();
        Self { costs, next: 0, port: None }
    }
}

impl Block for Script {
    type Token = ();

    fn accept(&mut self, (): &(), out: &mut impl Emit<()>) -> Cost {
        let (interval, offsets) = &self.costs[self.next % self.costs.len()];
        self.next += 1;
        offsets.iter().for_each(|&offset| out.emit((), offset.into()));
        Cost { interval: (*interval).into(), latency: 0 }
    }

    fn port(&self, (): &()) -> Option<u64> {
        self.port
    }
}

fn shape(depth: u32, in_flight: u32, lanes: u32) -> Shape {
    Shape { depth, in_flight, lanes, order: LaneOrder::FirstFree, shares_port: false }
}

/// Runs `tokens` through the chain on every engine that can; they agree.
fn run(chain: &[(Script, Shape)], tokens: usize) -> (Times, Log) {
    let log = || Log::of(chain);
    let mut stepped = Stepped::new(chain.to_vec(), Frames::Drain, log());
    let mut ordered = Ordered::new(chain.to_vec(), Frames::Drain, log());
    for _ in 0..tokens {
        stepped.feed(());
        ordered.feed(());
    }
    stepped.end_frame();
    ordered.end_frame();
    let outcome = stepped.finish();
    assert_eq!(ordered.finish(), outcome);
    if chain.iter().all(|(_, shape)| !shape.shares_port) {
        let mut timed = Timed::<_, _>::new(chain.to_vec(), Frames::Drain, log());
        (0..tokens).for_each(|_| timed.feed(()));
        timed.end_frame();
        assert_eq!(timed.finish(), outcome);
    }
    outcome
}

fn accepted(log: &Log, stage: usize) -> Vec<u64> {
    log.accepted[stage].iter().map(|&(_, at)| at).collect()
}

#[test]
fn a_stage_of_interval_i_and_latency_l_takes_n_minus_1_times_i_plus_l() {
    let mut compared = 0;
    for interval in 1..=7 {
        for latency in 0..=15 {
            // Enough slots that the latency is hidden, and one fewer.
            let slots = latency / interval + 1;
            for n in [1, 2, 3, 100] {
                let block = Script::of(&[(interval, &[latency])]);
                let (times, log) = run(&[(block.clone(), shape(1, slots, 1))], n);
                let expected = (n as u64 - 1) * u64::from(interval) + u64::from(latency);
                assert_eq!(times.frames[0].elapsed, expected, "{interval} {latency} {n}");
                assert_eq!(log.left[0].last().map(|left| left.0), Some(expected));
                if slots > 1 && n as u32 > slots {
                    let (short, _) = run(&[(block, shape(1, slots - 1, 1))], n);
                    assert!(short.frames[0].elapsed > expected, "{slots} slots are needed");
                }
                compared += 1;
            }
        }
    }
    println!("compared {compared} stages");
}

#[test]
fn a_fan_out_of_three_into_a_fifo_of_two() {
    // a: outputs ready 1, 2, 3 after acceptance, interval 3, two in flight.
    // b: takes one every 2 cycles, and emits at once.
    let a = (Script::of(&[(3, &[1, 2, 3])]), shape(1, 2, 1));
    let b = (Script::of(&[(2, &[0])]), shape(2, 1, 1));
    let (times, log) = run(&[a, b], 2);
    // a accepts at 0 and, its interval over, at 3.
    assert_eq!(accepted(&log, 0), [0, 3]);
    // ready 1 2 3: room at once for two, for the third when b's first is taken at 2, seen at 3;
    // ready 4: b's second is taken at 4: room at 5, not at 4; then at 7 and at 9.
    assert_eq!(log.emitted[0], [1, 2, 3, 5, 7, 9]);
    // A push at 1 is seen at 2, not at 1; then every 2 cycles.
    assert_eq!(accepted(&log, 1), [2, 4, 6, 8, 10, 12]);
    assert_eq!(times.frames[0].elapsed, 12);
    // a is in flight until 9: ten cycles; blocked in 4, 6 and 8.
    let expected = StageTimes {
        busy: 7,
        starved: 2,
        blocked: 3,
        total: 12,
        used: 6, // two intervals of 3
        tokens_in: 2,
        tokens_out: 6,
        ..StageTimes::default()
    };
    assert_eq!(times.frames[0].stages[0], expected);
    let expected = StageTimes {
        busy: 10,
        starved: 2,
        total: 12,
        used: 10, // intervals of 2 from cycle 2 on; the last begins at 12
        tokens_in: 6,
        tokens_out: 6,
        fifo_peak: 2,
        ..StageTimes::default()
    };
    assert_eq!(times.frames[0].stages[1], expected);
    // At the start of cycles 0 1: none; 2 3 5 7 9 11: one; 4 6 8 10: two.
    assert_eq!(times.occupancy, [vec![], vec![2, 6, 4]]);
}

#[test]
fn two_lanes_retire_in_order() {
    // Latencies 5, 1, 1; intervals 4, 2, 1; a slot a lane.
    let lanes = Script::of(&[(4, &[5]), (2, &[1]), (1, &[1])]);
    let (times, log) = run(&[(lanes, shape(1, 1, 2))], 3);
    // The second token finds lane 0 taken. The third: lane 0 is free at 6, for its token leaves at
    // 5; lane 1 at 7, for its token, ready at 2, leaves after the first one, at 6.
    assert_eq!(log.accepted[0], [(0, 0), (1, 1), (0, 6)]);
    assert_eq!(log.emitted[0], [5, 6, 7]);
    let expected = StageTimes {
        busy: 9,             // lane 0 in 0..7, lane 1 in 1 and 6
        starved: 1,          // lane 1 in 0
        blocked_by_order: 4, // lane 1 in 2..6
        total: 14,
        used: 7, // 0..4, 1..3, 6
        tokens_in: 3,
        tokens_out: 3,
        ..StageTimes::default()
    };
    assert_eq!(times.frames[0].stages[0], expected);
}

#[test]
fn the_first_and_the_last_stage_share_the_port() {
    let mut first = (Script::of(&[(1, &[1])]), shape(1, 2, 1));
    let mut last = (Script::of(&[(1, &[0])]), shape(2, 1, 1));
    (first.0.port, last.0.port) = (Some(3), Some(2));
    (first.1.shares_port, last.1.shares_port) = (true, true);
    let (times, log) = run(&[first, last], 3);
    // The first takes the port in 0..3. At 3 both ask: the last goes first, until 5. So on.
    assert_eq!(accepted(&log, 0), [0, 5, 10]);
    assert_eq!(accepted(&log, 1), [3, 8, 13]);
    assert_eq!(times.frames[0].elapsed, 13);
    let expected = StageTimes {
        busy: 6,            // 0 1, 5 6, 10 11
        starved_by_port: 6, // 2 3 4, 7 8 9
        starved: 1,         // 12: the host has no more
        total: 13,
        used: 3, // 0, 5, 10
        tokens_in: 3,
        tokens_out: 3,
        ..StageTimes::default()
    };
    assert_eq!(times.frames[0].stages[0], expected);
    let expected = StageTimes {
        busy: 2,            // 3, 8
        starved_by_port: 3, // 2, 7, 12
        starved: 8,
        total: 13,
        used: 2, // 3, 8
        tokens_in: 3,
        tokens_out: 3,
        fifo_peak: 1,
        ..StageTimes::default()
    };
    assert_eq!(times.frames[0].stages[1], expected);
}

#[test]
fn a_fifo_of_one_halves_the_throughput() {
    let stage = |depth| (Script::of(&[(1, &[0])]), shape(depth, 1, 1));
    let elapsed = |depth| run(&[stage(1), stage(depth)], 100).0.frames[0].elapsed;
    assert_eq!((elapsed(1), elapsed(2)), (199, 100));
}
