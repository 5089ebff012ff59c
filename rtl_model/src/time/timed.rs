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
use super::{Block, Emit, FrameTimes, Frames, Hold, Probe, Shape, StageTimes, Times, Visitor};
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
    block: B,
    /// Tokens that have arrived and when, of which it is not yet known when they are accepted.
    inbox: Vec<(B::Token, u64)>,
    depth: usize,
    books: Books,
}

/// What is known of a stage's past.
struct Books {
    index: usize,
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
            let books = Books {
                index,
                fifo: (index > 0).then(|| Fifo::new(shape.depth)),
                lanes: Lanes::new(&shape),
                shares_port: shape.shares_port,
                next_accept: 0,
                next_emission: 0,
                left: 0,
                tokens_in: 0,
                tokens_out: 0,
            };
            let depth = shape.depth as usize;
            Stage { block, inbox: Vec::with_capacity(depth), depth, books }
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

    /// Who is told the times.
    pub fn probe(&mut self) -> &mut P {
        &mut self.run.probe
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
        let left = self.stages.iter().map(|stage| stage.books.left).max();
        let elapsed = left.unwrap_or(0).max(before);
        let stages = self.stages.iter_mut().map(|stage| &mut stage.books);
        let (added, stages) = match self.policy {
            Frames::Drain => {
                self.elapsed = 0;
                self.run.port = 0;
                self.run.probe.drained(elapsed);
                (elapsed, stages.map(|books| books.drain(elapsed)).collect())
            }
            Frames::Overlap => {
                self.elapsed = elapsed;
                (elapsed - before, stages.map(Books::overlap).collect())
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
        let ended = |stage: &Stage<B>| stage.inbox.is_empty() && stage.books.tokens_in == 0;
        assert!(self.stages.iter().all(ended), "the last frame has ended");
        for (k, stage) in self.stages.iter_mut().enumerate() {
            let mut times: Vec<_> =
                self.frames.iter_mut().map(|f| std::mem::take(&mut f.stages[k])).collect();
            if let Some(last) = times.len().checked_sub(1) {
                stage.books.lanes.finish(self.elapsed, last, &mut times);
            }
            for (frame, times) in self.frames.iter_mut().zip(times) {
                frame.stages[k] = times;
            }
            if let Some(fifo) = &mut stage.books.fifo {
                fifo.drain(self.elapsed);
            }
        }
        let cycles = |stage: Stage<B>| stage.books.fifo.map_or_else(Vec::new, Fifo::into_cycles);
        let occupancy = self.stages.into_iter().map(cycles).collect();
        (Times { frames: self.frames, occupancy }, self.run.probe)
    }
}

impl Books {
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
    let books = &mut stage.books;
    let rules = PhantomData::<R>;
    if books.lanes.len() == 1 {
        stage.block.visit(Taker::<_, _, _, true> { books, inbox: &inbox, rest, run, rules });
    } else {
        stage.block.visit(Taker::<_, _, _, false> { books, inbox: &inbox, rest, run, rules });
    }
    inbox.clear();
    stage.inbox = inbox;
}

/// Takes the tokens of an inbox, by a block of one lane or of several.
struct Taker<'a, B: Block, P, R, const ONE: bool> {
    books: &'a mut Books,
    inbox: &'a [(B::Token, u64)],
    rest: &'a mut [Stage<B>],
    run: &'a mut Run<P>,
    rules: PhantomData<R>,
}

impl<B: Block, P: Probe, R: Rules, const ONE: bool> Visitor<B::Token> for Taker<'_, B, P, R, ONE> {
    fn visit(mut self, block: &mut impl Block<Token = B::Token>) {
        for (token, arrived) in self.inbox {
            self.take(block, token, *arrived);
        }
    }
}

impl<B: Block, P: Probe, R: Rules, const ONE: bool> Taker<'_, B, P, R, ONE> {
    /// Takes a token, which is seen from the start of cycle `arrived`.
    #[inline(always)]
    fn take(&mut self, block: &mut impl Block<Token = B::Token>, token: &B::Token, arrived: u64) {
        let books = &mut *self.books;
        let mut from = arrived.max(books.next_accept);
        if R::PORT_BY_EVALUATION && books.shares_port {
            from = by_evaluation(books, block.port(token), from, &mut self.run.port);
        }
        let (lane, accept) = books.lanes.choose::<ONE>(from);
        let lane = if R::LANES { lane } else { books.lanes.len() - 1 - lane };
        self.run.probe.accepted(books.index, lane, accept);
        books.next_accept = accept + 1;
        books.tokens_in += 1;
        if let Some(fifo) = &mut books.fifo {
            fifo.pass(arrived, accept);
        }
        let mut outputs = Outputs::<B, P, R> {
            stage: books.index,
            lane,
            accept,
            turn: books.next_emission.max(books.left),
            head: books.lanes.lane::<ONE>(lane).head,
            count: 0,
            blocked: 0,
            by_order: 0,
            rest: self.rest,
            run: self.run,
            rules: PhantomData,
        };
        let cost = block.accept(token, &mut outputs);
        let Outputs { turn, count, blocked, by_order, .. } = outputs;
        assert!(cost.interval >= 1, "an initiation interval is at least a cycle");
        if count > 0 {
            books.next_emission = turn;
            books.left = turn - 1;
            books.tokens_out += count;
        } else {
            books.left = books.left.max(accept + cost.latency);
        }
        let next = accept + cost.interval;
        let lane = books.lanes.lane::<ONE>(lane);
        lane.blocked += blocked;
        lane.by_order += by_order;
        let ready = lane.done(accept, books.left, next, self.run.frame);
        lane.ready = if R::SLOTS { ready } else { next };
        if !ONE {
            books.lanes.took();
        }
        self.run.probe.left(books.index, books.left, next);
    }
}

/// When a token gets the port, if whoever is evaluated first gets it first.
fn by_evaluation(books: &Books, port: Option<u64>, from: u64, port_free: &mut u64) -> u64 {
    let Some(cycles) = port else { return from };
    let (_, accept) = books.lanes.choose::<false>(from.max(*port_free));
    *port_free = accept + cycles;
    accept
}

/// Where a token's outputs go: before the next block.
struct Outputs<'a, B: Block, P, R> {
    stage: usize,
    lane: usize,
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
            let fifo = next.books.fifo.as_mut().expect("blocks behind the first have a FIFO");
            at = turn.max(fifo.push().saturating_sub(1 - R::CREDIT));
            next.inbox.push((token, at + 1));
        }
        if at > first {
            let room = turn.max(first);
            self.by_order += room - first;
            self.blocked += at - room;
            let (stage, lane, probe) = (self.stage, self.lane, &mut self.run.probe);
            probe.held(stage, lane, Hold::Order, first, room);
            probe.held(stage, lane, Hold::Room, room, at);
        }
        self.turn = at + 1;
        self.head = at + 1;
        self.count += 1;
        self.run.probe.emitted(self.stage, at);
    }
}
