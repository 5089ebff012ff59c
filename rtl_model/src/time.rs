//! Time: what a block tells of itself, and the engines that lay cycles over it.
//!
//! A block turns a token into tokens and says what that costs in cycles; it never sees the clock.
//! Blocks stand in a chain, a FIFO before each but the first, which the host feeds.
//!
//! ```text
//!   host ─► block ─► FIFO ─► block ─► FIFO ─► block ─► out
//!           accept(m)  push  ready    room
//! ```
//!
//! The rules, for token m of a block and its outputs j (all times in cycles, from 0):
//!
//! ```text
//!   accept(m) = max( push(m) + 1,                 it has arrived: a push is seen a cycle later
//!                    accept(m-1) + 1,             one token a cycle leaves the FIFO
//!                    lane's last accept + its interval,
//!                    left(lane's token K back) + 1 )            a slot in flight is free
//!   emit(m,j) = max( accept(m) + offset(j),
//!                    previous emission + 1,       one output a cycle leaves the block
//!                    left(m-1),                   in the order of tokens
//!                    accept(token d back, downstream) + 1 )   credit: a pop is seen later
//!   left(m)   = last emission of m; max( accept(m) + latency, left(m-1) ) if it emits nothing
//! ```
//!
//! Two engines follow these rules and share nothing but this file's declarations: [`timed`] visits
//! each token once and computes the maxima, [`stepped`] goes cycle by cycle. They agree on the time
//! of every token and on every counter. Where stages of one chain share a memory port, who gets it
//! depends on the order of time across stages, which a token's own visit does not know: then
//! [`ordered`] computes the same maxima, event by event. Of stages that ask in the same cycle, the
//! one nearest to the output goes first, for that drains the chain.
//!
//! Attribution, for each lane and each cycle from 0 to the elapsed time:
//!
//! - in flight: from a token's acceptance until it has left, the cycle of leaving included, and
//!   until its initiation interval is over;
//! - blocked: the lane's oldest token, at the cycle's start, has an output that is ready and does
//!   not leave in the cycle. It is blocked by downstream while all that is missing is room, by
//!   order while tokens of other lanes go first;
//! - busy: in flight and not blocked; starved: not in flight.
//!
//! A lane is used while the initiation interval of its last token lasts: a block whose lanes are
//! used all the time can do no more, whereas one with a long latency is soon always busy.
//!
//! Elapsed is the time at which the last token left; the cycle of that number is not counted, so
//! that n tokens of interval i and latency l take (n - 1) i + l cycles.

mod account;
pub mod ordered;
pub mod stepped;
pub mod timed;

use serde::{Deserialize, Serialize};

/// One hardware block: what it makes of a token. It never sees the clock.
pub trait Block {
    /// What flows.
    type Token: Copy;

    /// Takes a token and emits what it makes of it, in order, each with its cycle counted from
    /// acceptance.
    fn accept(&mut self, token: &Self::Token, out: &mut impl Emit<Self::Token>) -> Cost;

    /// Whether the token needs the memory port that stages share, and for how many cycles it then
    /// holds it. Asked before acceptance, and only of stages that share the port.
    fn port(&self, token: &Self::Token) -> Option<u64> {
        let _ = token;
        None
    }

    /// Shows itself to `visitor`. A block that is one of several kinds shows which, so that it is
    /// asked once for many tokens.
    fn visit(&mut self, visitor: impl Visitor<Self::Token>)
    where
        Self: Sized,
    {
        visitor.visit(self);
    }
}

/// Does something with a block, of whatever kind.
pub trait Visitor<T> {
    /// Does it.
    fn visit(self, block: &mut impl Block<Token = T>);
}

/// Takes the outputs of a token.
pub trait Emit<T> {
    /// Emits `token` no earlier than `offset` cycles after acceptance.
    fn emit(&mut self, token: T, offset: u64);
}

/// What a token cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Cycles until the lane can accept its next token, at least 1.
    pub interval: u64,
    /// Cycles until the token is done, where it emits nothing.
    pub latency: u64,
}

/// How a block stands in the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Entries of the FIFO before it, at least 1; unused for the first block.
    pub depth: u32,
    /// Tokens that a lane holds at once, at least 1.
    pub in_flight: u32,
    /// Lanes, at least 1.
    pub lanes: u32,
    /// Which lane takes the next token.
    pub order: LaneOrder,
    /// Whether its tokens take turns at the memory port that stages share.
    pub shares_port: bool,
}

impl Shape {
    /// # Panics
    /// When something of it is zero.
    fn check(&self) {
        let Self { depth, in_flight, lanes, .. } = *self;
        assert!(depth > 0 && in_flight > 0 && lanes > 0, "a shape has no zeros: {self:?}");
    }
}

/// Which lane takes the next token. Both are functions of the order of tokens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LaneOrder {
    /// The first by number of those that are free; if none is, the one that is free first.
    #[default]
    FirstFree,
    /// Token m goes to lane m modulo lanes.
    RoundRobin,
}

/// What becomes of the pipeline between frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Frames {
    /// A frame starts when the one before has left: at time 0 again.
    #[default]
    Drain,
    /// A frame's tokens follow those of the frame before. A lane's share of a frame ends when the
    /// frame's last token is through it.
    Overlap,
}

/// What the time of one block was in one frame: lane-cycles, lanes summed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageTimes {
    /// Something in flight, nothing blocked.
    pub busy: u64,
    /// Nothing in flight: nothing had arrived.
    pub starved: u64,
    /// Nothing in flight: a token had arrived, and waited for the shared memory port.
    pub starved_by_port: u64,
    /// A finished output had no room downstream.
    pub blocked: u64,
    /// A finished output waited for tokens of other lanes.
    pub blocked_by_order: u64,
    /// All of these: elapsed cycles x lanes.
    pub total: u64,
    /// Within the initiation interval of a token: what a lane was used of what it could have been.
    pub used: u64,
    /// Tokens accepted.
    pub tokens_in: u64,
    /// Tokens emitted.
    pub tokens_out: u64,
    /// Most entries of the FIFO before it; 0 for the first block.
    pub fifo_peak: u64,
}

/// What holds up a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Its output has no room downstream.
    Room,
    /// Tokens of other lanes go first.
    Order,
    /// At the door, the memory port that stages share is taken.
    Port,
}

/// Is told the time of every token: of each block's tokens in their order, whatever other blocks
/// did before. Times are those of the frame where frames drain.
///
/// Between two tokens' leaving a block is told of the emissions of the second.
pub trait Probe {
    /// The oldest token of a lane was held up from cycle `from` until before cycle `to`; by the
    /// port, the one that the lane accepts next. Told before that token is accepted or leaves, in
    /// the order of time, and possibly in pieces.
    fn held(&mut self, stage: usize, lane: usize, by: Hold, from: u64, to: u64) {
        let _ = (stage, lane, by, from, to);
    }

    /// The next token of a block was accepted.
    fn accepted(&mut self, stage: usize, lane: usize, at: u64) {
        let _ = (stage, lane, at);
    }

    /// The next output of a block left.
    fn emitted(&mut self, stage: usize, at: u64) {
        let _ = (stage, at);
    }

    /// The next token of a block left; its initiation interval is over at `next`.
    fn left(&mut self, stage: usize, at: u64, next: u64) {
        let _ = (stage, at, next);
    }

    /// A frame has drained in so many cycles: time starts again at 0.
    fn drained(&mut self, elapsed: u64) {
        let _ = elapsed;
    }
}

/// Tells nobody.
impl Probe for () {}

/// What the times of one frame were.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameTimes {
    /// Cycles that the frame added to the run.
    pub elapsed: u64,
    /// The blocks of the chain, in its order.
    pub stages: Vec<StageTimes>,
}

/// What the times of a run were.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Frame by frame.
    pub frames: Vec<FrameTimes>,
    /// For each block, the cycles of the run at the start of which the FIFO before it held 0, 1, ..
    /// entries; empty for the first block.
    pub occupancy: Vec<Vec<u64>>,
}
