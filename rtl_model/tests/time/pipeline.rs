//! Random pipelines: blocks that cost what a hash of their token says, and engines to run them on.

use rtl_model::time::ordered::Ordered;
use rtl_model::time::stepped::Stepped;
use rtl_model::time::timed::{Rules, Timed};
use rtl_model::time::{Block, Cost, Emit, Frames, Hold, LaneOrder, Probe, Shape, Times};

/// Pseudo-random numbers (splitmix64): a test's own, so that a seed means the same for ever.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// One of `low..=high`.
    pub(crate) fn within(&mut self, low: u32, high: u32) -> u32 {
        low + (self.next() % u64::from(high - low + 1)) as u32
    }

    pub(crate) fn chance(&mut self, percent: u32) -> bool {
        self.within(1, 100) <= percent
    }
}

/// A block whose costs are random, and depend on the token and on how many came before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dice {
    pub(crate) salt: u64,
    pub(crate) interval_max: u32,
    pub(crate) latency_max: u32,
    pub(crate) fan_out: (u32, u32),
    /// Percent of tokens that need the port.
    pub(crate) port: u32,
    pub(crate) seen: u64,
}

impl Block for Dice {
    type Token = u64;

    fn accept(&mut self, &token: &u64, out: &mut impl Emit<u64>) -> Cost {
        self.seen += 1;
        let mut random = Random(token ^ self.salt ^ self.seen << 32);
        let interval = random.within(1, self.interval_max);
        let latency = random.within(0, self.latency_max);
        let mut offset = random.within(0, self.latency_max);
        for _ in 0..random.within(self.fan_out.0, self.fan_out.1) {
            out.emit(random.next(), offset.into());
            offset += random.within(0, 3);
        }
        Cost { interval: interval.into(), latency: latency.into() }
    }

    fn port(&self, token: &u64) -> Option<u64> {
        let mut random = Random(token ^ self.salt ^ 0x5eed);
        random.chance(self.port).then(|| random.within(1, 6).into())
    }
}

/// A chain and what is fed to it.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    pub(crate) chain: Vec<(Dice, Shape)>,
    /// Tokens of each frame.
    pub(crate) frames: Vec<Vec<u64>>,
    pub(crate) policy: Frames,
}

impl Pipeline {
    /// 1 to 12 stages; depths 2 to 32, now and then 1; 1 to 4 lanes.
    pub(crate) fn random(seed: u64, ports: bool) -> Self {
        let random = &mut Random(seed);
        let stages = random.within(1, 12);
        // Fan-outs multiply: a wide one is had once, and narrow ones thin out what follows.
        let wide = random.within(0, 2 * stages);
        let mut growth = 0;
        let chain = (0..stages)
            .map(|k| {
                let fan_out = match random.within(0, 5) {
                    _ if k == wide => (0, 9),
                    0 => (0, 1),
                    1 if growth < 3 => {
                        growth += 1;
                        (0, 3)
                    }
                    2 => (0, 2),
                    _ => (1, 1),
                };
                (dice(random, fan_out, ports), shape(random, ports))
            })
            .collect();
        let frames = (0..random.within(1, 3))
            .map(|_| (0..random.within(0, 60)).map(|_| random.next()).collect())
            .collect();
        let policy = if random.chance(50) { Frames::Drain } else { Frames::Overlap };
        Self { chain, frames, policy }
    }
}

fn dice(random: &mut Random, fan_out: (u32, u32), ports: bool) -> Dice {
    let [interval_max, latency_max] = [[1, 0], [1, 3], [3, 8], [8, 3], [12, 30]]
        [random.within(0, 4) as usize]
        .map(|max| max + random.within(0, 1));
    let port = if ports { random.within(20, 100) } else { 0 };
    Dice { salt: random.next(), interval_max, latency_max, fan_out, port, seen: 0 }
}

fn shape(random: &mut Random, ports: bool) -> Shape {
    let depth = if random.chance(5) { 1 } else { random.within(2, 32) };
    let depth = if random.chance(50) { depth.min(4) } else { depth };
    let lanes = if random.chance(70) { 1 } else { random.within(2, 4) };
    let order = if random.chance(50) { LaneOrder::FirstFree } else { LaneOrder::RoundRobin };
    let in_flight = random.within(1, 6);
    Shape { depth, in_flight, lanes, order, shares_port: ports && random.chance(40) }
}

/// What held up a lane, and the cycles from and to.
type Held = (Hold, u64, u64);

/// The times of every token: lane and acceptance, emissions, leaving and the end of its interval,
/// by block; what held up each lane.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Log {
    pub(crate) accepted: Vec<Vec<(usize, u64)>>,
    pub(crate) emitted: Vec<Vec<u64>>,
    pub(crate) left: Vec<Vec<(u64, u64)>>,
    pub(crate) held: Vec<Vec<Vec<Held>>>,
    pub(crate) drained: Vec<u64>,
}

impl Log {
    pub(crate) fn of<B>(chain: &[(B, Shape)]) -> Self {
        let stages = chain.len();
        Self {
            accepted: vec![Vec::new(); stages],
            emitted: vec![Vec::new(); stages],
            left: vec![Vec::new(); stages],
            held: chain.iter().map(|(_, shape)| vec![Vec::new(); shape.lanes as usize]).collect(),
            drained: Vec::new(),
        }
    }

    /// Cycles in which a lane of a block was held up.
    pub(crate) fn held_up(&self, stage: usize, by: Hold) -> u64 {
        let held = self.held[stage].iter().flatten().filter(|held| held.0 == by);
        held.map(|(_, from, to)| to - from).sum()
    }

    /// Tokens accepted anywhere.
    pub(crate) fn tokens(&self) -> usize {
        self.accepted.iter().map(Vec::len).sum()
    }
}

impl Probe for Log {
    fn accepted(&mut self, stage: usize, lane: usize, at: u64) {
        self.accepted[stage].push((lane, at));
    }

    fn emitted(&mut self, stage: usize, at: u64) {
        self.emitted[stage].push(at);
    }

    fn left(&mut self, stage: usize, at: u64, next: u64) {
        self.left[stage].push((at, next));
    }

    fn held(&mut self, stage: usize, lane: usize, by: Hold, from: u64, to: u64) {
        if by == Hold::Port {
            return; // only of a lane that has nothing in flight, which this log does not know
        }
        let held = &mut self.held[stage][lane];
        match held.last_mut() {
            // A piece of the same: one engine goes cycle by cycle.
            Some(last) if last.0 == by && last.2 == from => last.2 = to,
            _ if from < to => held.push((by, from, to)),
            _ => {}
        }
    }

    fn drained(&mut self, elapsed: u64) {
        self.drained.push(elapsed);
    }
}

/// What an engine says of a pipeline.
pub(crate) type Outcome = (Times, Log);

/// Feeds an engine whatever its type: they share no trait, for nothing but tests would need it.
macro_rules! run {
    ($engine:expr, $pipeline:expr) => {{
        let mut engine = $engine;
        for frame in &$pipeline.frames {
            frame.iter().for_each(|&token| engine.feed(token));
            engine.end_frame();
        }
        engine.finish()
    }};
}

pub(crate) fn timed<R: Rules>(pipeline: &Pipeline) -> Outcome {
    let log = Log::of(&pipeline.chain);
    run!(Timed::<_, _, R>::new(pipeline.chain.clone(), pipeline.policy, log), pipeline)
}

pub(crate) fn stepped(pipeline: &Pipeline) -> Outcome {
    let log = Log::of(&pipeline.chain);
    run!(Stepped::new(pipeline.chain.clone(), pipeline.policy, log), pipeline)
}

pub(crate) fn ordered(pipeline: &Pipeline) -> Outcome {
    let log = Log::of(&pipeline.chain);
    run!(Ordered::new(pipeline.chain.clone(), pipeline.policy, log), pipeline)
}
