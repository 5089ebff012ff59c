//! The engine that users run: visits each token once and computes its times by the (max,+)
//! recurrence of [`super`].
//!
//! ```text
//!   feed ─► inbox ─► accept ─► emit ─► inbox ─► accept ─► emit ─► inbox ─► ..
//!           depth tokens               depth tokens               depth tokens
//! ```
//!
//! An output needs to know when the token `depth` before it was taken downstream, and nothing later
//! than that. So tokens gather before a block until there are `depth` of them, and then it takes
//! them all: what is done for each stays in a loop, and what a FIFO must remember is when its last
//! `depth` tokens were taken.
//!
//! Memory is the FIFOs' depths and the tokens in flight, whatever the length of the run. Which
//! operand of a maximum won is the attribution: between `ready` and `turn` a block waits for its
//! other lanes, between `turn` and the time of emission for room.

use super::account::{Fifo, Lanes};
use super::{Block, Emit, FrameTimes, Frames, Probe, Shape, StageTimes, Times};
use std::marker::PhantomData;

/// The rules as constants, so that tests can plant a mistake in this engine alone.
#[doc(hidden)]
pub trait Rules {
    /// Cycles until a pop is seen as room.
    const CREDIT: u64 = 1;
    /// Whether a lane holds a limited number of tokens.
    const SLOTS: bool = true;
    /// Whether a token of several lanes takes the lane that the rules say.
    const LANES: bool = true;
    /// Whether stages that share a port get it in the order of evaluation, which is wrong.
    const PORT_BY_EVALUATION: bool = false;
}

/// The rules as they are.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Exact;

impl Rules for Exact {}

/// The engine.
pub struct Timed<B: Block, P = (), R = Exact> {
    stages: Vec<Stage<B>>,
    policy: Frames,
    frames: Vec<FrameTimes>,
    /// When the last token so far left, in the frame's time.
    elapsed: u64,
    run: Run<P>,
    rules: PhantomData<R>,
}

/// What all stages see.
struct Run<P> {
    probe: P,
    frame: usize,
    /// Until when the shared port is taken (by tests' mistaken rules only).
    port: u64,
}

struct Stage<B: Block> {
    index: usize,
    block: B,
    /// Tokens that have arrived and when, of which it is not yet known when they are accepted.
    inbox: Vec<(B::Token, u64)>,
    depth: usize,
    /// The FIFO before it; the host's tokens wait in none.
    fifo: Option<Fifo>,
    lanes: Lanes,
    shares_port: bool,
    /// The cycle after the last acceptance.
    next_accept: u64,
    /// The cycle after the last emission.
    next_emission: u64,
    /// When the last token left.
    left: u64,
    tokens_in: u64,
    tokens_out: u64,
}

impl<B: Block, P: Probe, R: Rules> Timed<B, P, R> {
    /// An engine over a chain of blocks, the first of which is fed by the host.
    ///
    /// # Panics
    /// When a shape has a zero, or a block shares the port: that takes [`super::ordered`].
    #[must_use]
    pub fn new(chain: Vec<(B, Shape)>, policy: Frames, probe: P) -> Self {
        let stage = |(index, (block, shape)): (usize, (B, Shape))| {
            shape.check();
            assert!(!shape.shares_port || R::PORT_BY_EVALUATION, "a shared port is not timed here");
            Stage {
                index,
                block,
                inbox: Vec::with_capacity(shape.depth as usize),
                depth: shape.depth as usize,
                fifo: (index > 0).then(|| Fifo::new(shape.depth)),
                lanes: Lanes::new(&shape),
                shares_port: shape.shares_port,
                next_accept: 0,
                next_emission: 0,
                left: 0,
                tokens_in: 0,
                tokens_out: 0,
            }
        };
        Self {
            stages: chain.into_iter().enumerate().map(stage).collect(),
            policy,
            frames: Vec::new(),
            elapsed: 0,
            run: Run { probe, frame: 0, port: 0 },
            rules: PhantomData,
        }
    }

    /// The host sends a token, as soon as the first block takes it.
    pub fn feed(&mut self, token: B::Token) {
        let first = self.stages.first_mut().expect("a chain has blocks");
        first.inbox.push((token, 0));
        if first.inbox.len() == first.depth {
            take_all::<B, P, R>(&mut self.stages, &mut self.run);
        }
    }

    /// The frame's last token has been fed.
    pub fn end_frame(&mut self) {
        for k in 0..self.stages.len() {
            take_all::<B, P, R>(&mut self.stages[k..], &mut self.run);
        }
        let before = self.elapsed;
        let left = self.stages.iter().map(|stage| stage.left).max();
        let elapsed = left.unwrap_or(0).max(before);
        let stages = self.stages.iter_mut();
        let (added, stages) = match self.policy {
            Frames::Drain => {
                self.elapsed = 0;
                self.run.port = 0;
                (elapsed, stages.map(|stage| stage.drain(elapsed)).collect())
            }
            Frames::Overlap => {
                self.elapsed = elapsed;
                (elapsed - before, stages.map(Stage::overlap).collect())
            }
        };
        self.frames.push(FrameTimes { elapsed: added, stages });
        self.run.frame += 1;
    }

    /// The times of the run.
    ///
    /// # Panics
    /// When tokens were fed after the last end of a frame.
    #[must_use]
    pub fn finish(mut self) -> (Times, P) {
        let ended = |stage: &Stage<B>| stage.inbox.is_empty() && stage.tokens_in == 0;
        assert!(self.stages.iter().all(ended), "the last frame has ended");
        for (k, stage) in self.stages.iter_mut().enumerate() {
            let mut times: Vec<_> =
                self.frames.iter_mut().map(|f| std::mem::take(&mut f.stages[k])).collect();
            if let Some(last) = times.len().checked_sub(1) {
                stage.lanes.finish(self.elapsed, last, &mut times);
            }
            for (frame, times) in self.frames.iter_mut().zip(times) {
                frame.stages[k] = times;
            }
            if let Some(fifo) = &mut stage.fifo {
                fifo.drain(self.elapsed);
            }
        }
        let cycles = |stage: Stage<B>| stage.fifo.map_or_else(Vec::new, Fifo::into_cycles);
        let occupancy = self.stages.into_iter().map(cycles).collect();
        (Times { frames: self.frames, occupancy }, self.run.probe)
    }
}

impl<B: Block> Stage<B> {
    fn counts(&mut self) -> StageTimes {
        StageTimes {
            tokens_in: std::mem::take(&mut self.tokens_in),
            tokens_out: std::mem::take(&mut self.tokens_out),
            fifo_peak: self.fifo.as_mut().map_or(0, Fifo::take_peak),
            ..StageTimes::default()
        }
    }

    fn drain(&mut self, elapsed: u64) -> StageTimes {
        let mut times = self.counts();
        self.lanes.drain(elapsed, &mut times);
        if let Some(fifo) = &mut self.fifo {
            fifo.drain(elapsed);
        }
        (self.next_accept, self.next_emission, self.left) = (0, 0, 0);
        times
    }

    fn overlap(&mut self) -> StageTimes {
        let mut times = self.counts();
        self.lanes.overlap(&mut times);
        times
    }
}

/// The first of `stages` takes all that has arrived.
fn take_all<B: Block, P: Probe, R: Rules>(stages: &mut [Stage<B>], run: &mut Run<P>) {
    let (stage, rest) = stages.split_first_mut().expect("a chain has blocks");
    let mut inbox = std::mem::take(&mut stage.inbox);
    for (token, arrived) in &inbox {
        take::<B, P, R>(stage, token, *arrived, rest, run);
    }
    inbox.clear();
    stage.inbox = inbox;
}

/// A stage takes a token, seen there from the start of cycle `arrived`.
#[inline(always)]
fn take<B: Block, P: Probe, R: Rules>(
    stage: &mut Stage<B>,
    token: &B::Token,
    arrived: u64,
    rest: &mut [Stage<B>],
    run: &mut Run<P>,
) {
    let mut from = arrived.max(stage.next_accept);
    if R::PORT_BY_EVALUATION && stage.shares_port {
        from = by_evaluation(stage, token, from, &mut run.port);
    }
    let (lane, accept) = stage.lanes.choose(from);
    let lane = if R::LANES { lane } else { stage.lanes.len() - 1 - lane };
    run.probe.accepted(stage.index, lane, accept);
    stage.next_accept = accept + 1;
    stage.tokens_in += 1;
    if let Some(fifo) = &mut stage.fifo {
        fifo.pass(arrived, accept);
    }
    let mut outputs = Outputs::<B, P, R> {
        stage: stage.index,
        accept,
        turn: stage.next_emission.max(stage.left),
        head: stage.lanes.lane(lane).head,
        count: 0,
        blocked: 0,
        by_order: 0,
        rest,
        run,
        rules: PhantomData,
    };
    let cost = stage.block.accept(token, &mut outputs);
    let Outputs { turn, count, blocked, by_order, run, .. } = outputs;
    assert!(cost.interval >= 1, "an initiation interval is at least a cycle");
    if count > 0 {
        stage.next_emission = turn;
        stage.left = turn - 1;
        stage.tokens_out += count;
    } else {
        stage.left = stage.left.max(accept + cost.latency);
    }
    let next = accept + cost.interval;
    let books = stage.lanes.lane(lane);
    books.blocked += blocked;
    books.by_order += by_order;
    let ready = books.done(accept, stage.left, next, run.frame);
    books.ready = if R::SLOTS { ready } else { next };
    stage.lanes.took();
    run.probe.left(stage.index, stage.left);
}

/// When a token gets the port, if whoever is evaluated first gets it first.
fn by_evaluation<B: Block>(
    stage: &Stage<B>,
    token: &B::Token,
    from: u64,
    port_free: &mut u64,
) -> u64 {
    let Some(cycles) = stage.block.port(token) else { return from };
    let (_, accept) = stage.lanes.choose(from.max(*port_free));
    *port_free = accept + cycles;
    accept
}

/// Where a token's outputs go: before the next block.
struct Outputs<'a, B: Block, P, R> {
    stage: usize,
    accept: u64,
    /// The first cycle in which order lets the next output leave.
    turn: u64,
    /// The first cycle in which the lane has no older token and no earlier output.
    head: u64,
    count: u64,
    blocked: u64,
    by_order: u64,
    rest: &'a mut [Stage<B>],
    run: &'a mut Run<P>,
    rules: PhantomData<R>,
}

impl<B: Block, P: Probe, R: Rules> Emit<B::Token> for Outputs<'_, B, P, R> {
    #[inline(always)]
    fn emit(&mut self, token: B::Token, offset: u64) {
        let ready = self.accept + offset;
        let turn = ready.max(self.turn);
        let first = ready.max(self.head);
        let mut at = turn;
        if let [next, ..] = &*self.rest {
            if next.inbox.len() == next.depth {
                take_all::<B, P, R>(self.rest, self.run);
            }
            let next = &mut self.rest[0];
            let fifo = next.fifo.as_mut().expect("blocks behind the first have a FIFO");
            at = turn.max(fifo.push().saturating_sub(1 - R::CREDIT));
            next.inbox.push((token, at + 1));
        }
        if at > first {
            self.by_order += turn.saturating_sub(first);
            self.blocked += at - turn.max(first);
        }
        self.turn = at + 1;
        self.head = at + 1;
        self.count += 1;
        self.run.probe.emitted(self.stage, at);
    }
}
