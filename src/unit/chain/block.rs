//! What blocks of any chain have in common, and those that every chain begins with: what each makes
//! of a token, and what that costs.
//!
//! A block takes the one kind of token that its neighbour upstream gives; another one means that
//! the chain is wired wrongly, and ends the program.

use super::{Fate, Flow, Token};
use crate::config::{BlockCosts, Channels, Config};
use crate::link::schedule::{LinkSchedule, MemorySchedule};
use crate::link::wire::Wire;
use rtl_model::time::{Block, Cost, Emit};
use std::marker::PhantomData;

/// Cycles for each work item, and until its result.
#[derive(Clone, Copy, Debug)]
pub(in crate::unit) struct Steady {
    interval: u64,
    latency: u64,
}

impl Steady {
    pub(super) fn of(costs: &BlockCosts) -> Self {
        Self { interval: costs.interval.into(), latency: costs.latency.into() }
    }

    /// So many items one after another.
    pub(super) fn cost(&self, items: u64) -> Cost {
        let items = items.max(1);
        Cost {
            interval: items * self.interval,
            latency: (items - 1) * self.interval + self.latency,
        }
    }

    /// What passes by, with nothing to be done for it.
    pub(super) fn idle(&self) -> Cost {
        Cost { interval: 1, latency: self.latency.min(1) }
    }
}

/// What a block makes of the tokens of a chain.
pub(in crate::unit) trait Step<T: Flow> {
    /// As [`Block::accept`].
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost;

    /// As [`Block::port`].
    fn port(&self, _token: &Token<T>) -> Option<u64> {
        None
    }
}

/// A block of a chain of units whose patches have the lists `T`.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Of<B, T>(B, PhantomData<T>);

impl<B, T> Of<B, T> {
    pub(super) fn new(block: B) -> Self {
        Self(block, PhantomData)
    }
}

impl<B: Step<T>, T: Flow> Block for Of<B, T> {
    type Token = Token<T>;

    #[inline(always)]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        self.0.accept(token, out)
    }

    #[inline(always)]
    fn port(&self, token: &Token<T>) -> Option<u64> {
        self.0.port(token)
    }
}

/// A token that does not belong here: the chain is wired wrongly.
#[cold]
pub(super) fn misled<T: Flow>(token: &Token<T>) -> ! {
    unreachable!("{token:?} came to a block that does not take it")
}

/// The link from the host.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Link(LinkSchedule);

impl Link {
    pub(super) fn new(config: &Config) -> Self {
        Self(LinkSchedule::new(config))
    }
}

impl<T: Flow> Step<T> for Link {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        match *token {
            Token::Parcel(parcel, _) | Token::Fetch(parcel) => {
                one(token, self.0.accept(&parcel), out)
            }
            Token::Vertices(parcel, count) => {
                let cost = self.0.accept(&parcel);
                let arrived = |k: u64| (k * cost.latency).div_ceil(count.into());
                (1..=count.into()).for_each(|k| out.emit(Token::Vertex, arrived(k)));
                cost
            }
            _ => misled(token),
        }
    }
}

/// Device memory, which hands on control points, or vertices that the host made.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Memory(MemorySchedule);

impl Memory {
    pub(super) fn new(config: &Config) -> Self {
        Self(MemorySchedule::new(config))
    }
}

impl<T: Flow> Step<T> for Memory {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let (parcel, work) = match *token {
            Token::Parcel(parcel, work) => (parcel, work),
            Token::Fetch(parcel) => {
                let vertices = self.0.accept(&parcel);
                let count = u64::from(parcel.points);
                (0..count).for_each(|k| out.emit(Token::Vertex, vertices.offset(k)));
                return vertices.cost();
            }
            _ => misled(token),
        };
        let points = self.0.accept(&parcel);
        let count = u64::from(parcel.points);
        for k in 0..count {
            out.emit(Token::Point(work.filter(|_| k + 1 == count)), points.offset(k));
        }
        if let (0, Some(work)) = (count, work) {
            out.emit(Token::Whole(work), points.offset(0));
        }
        points.cost()
    }

    fn port(&self, token: &Token<T>) -> Option<u64> {
        let (Token::Parcel(parcel, _) | Token::Fetch(parcel)) = token else { misled(token) };
        self.0.port(parcel)
    }
}

/// The control-point shader, and the port.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Points(pub(super) Steady);

impl<T: Flow> Step<T> for Points {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let cost = if let Token::Whole(_) = token { self.0.idle() } else { self.0.cost(1) };
        one(token, cost, out)
    }
}

/// Points to patches.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Assemble(pub(super) Steady);

impl<T: Flow> Step<T> for Assemble {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let (work, cost) = match *token {
            Token::Point(work) => (work, self.0.cost(1)),
            Token::Whole(work) => (Some(work), self.0.idle()),
            _ => misled(token),
        };
        if let Some(work) = work {
            out.emit(Token::Patch(work), cost.latency);
        }
        cost
    }
}

/// Trivial clipping, and whether it is enabled.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Clip(pub(super) Steady, pub(super) bool);

impl<T: Flow> Step<T> for Clip {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if self.1 { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Clipped { cost } else { one(token, cost, out) }
    }
}

/// Back-face removal.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Backface(pub(super) Steady);

impl<T: Flow> Step<T> for Backface {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if work.tested { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Culled { cost } else { one(token, cost, out) }
    }
}

/// Levels.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Level(pub(super) Steady);

impl<T: Flow> Step<T> for Level {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if work.levels > 0 { self.0.cost(work.levels.into()) } else { self.0.idle() };
        one(token, cost, out)
    }
}

/// A stage's own way to device memory: what it writes behind itself, or reads ahead of itself.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Channel {
    wire: Wire,
    /// Whether it is the port that other stages use too: then that says when the stage gets it.
    shared: bool,
}

impl Channel {
    pub(super) fn new(config: &Config) -> Self {
        let wire = Wire::new(config.memory.bandwidth_mb_s, config.clock_mhz);
        Self { wire, shared: config.memory.channels == Channels::Shared }
    }

    /// Cycles for which so many bytes that are written hold the stage up.
    pub(super) fn write(&mut self, bytes: u64) -> u64 {
        if self.shared { 0 } else { self.wire.occupy(bytes) }
    }

    /// Cycles until so many bytes have come, and for which they hold the stage up.
    pub(super) fn read(&mut self, bytes: u64) -> [u64; 2] {
        if self.shared { [self.wire.whole_cycles(bytes), 0] } else { [self.wire.occupy(bytes); 2] }
    }

    /// Cycles for which so many bytes hold the shared port, if it is one.
    pub(super) fn port(&self, bytes: u64) -> Option<u64> {
        self.shared.then(|| self.wire.whole_cycles(bytes))
    }
}

/// Emits the one output of a token when it is done.
#[inline(always)]
pub(super) fn one<T: Flow>(token: &Token<T>, cost: Cost, out: &mut impl Emit<Token<T>>) -> Cost {
    out.emit(*token, cost.latency);
    cost
}
