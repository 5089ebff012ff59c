//! The blocks of the chains: what each makes of a token, and what that costs.
//!
//! A block takes the one kind of token that its neighbour upstream gives; another one means that
//! the chain is wired wrongly, and ends the program.

use super::{Fate, Token};
use crate::config::BlockCosts;
use crate::link::schedule::{LinkSchedule, MemorySchedule};
use crate::link::wire::Wire;
use rtl_model::patch::Triangle;
use rtl_model::strip::{Strip, Topology};
use rtl_model::time::{Block, Cost, Emit};
use rtl_model::{emit, evaluate, stitch};
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
    fn cost(&self, items: u16) -> Cost {
        let items = u64::from(items.max(1));
        Cost {
            interval: items * self.interval,
            latency: (items - 1) * self.interval + self.latency,
        }
    }

    /// What passes by, with nothing to be done for it.
    fn idle(&self) -> Cost {
        Cost { interval: 1, latency: self.latency.min(1) }
    }
}

/// What a block makes of the tokens of a chain.
pub(in crate::unit) trait Step<T: Topology> {
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

impl<B: Step<T>, T: Topology> Block for Of<B, T> {
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
fn misled<T: Topology>(token: &Token<T>) -> ! {
    unreachable!("{token:?} came to a block that does not take it")
}

/// The link from the host.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Link(pub(super) LinkSchedule);

impl<T: Topology> Step<T> for Link {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        match *token {
            Token::Parcel(parcel, _) => one(token, self.0.accept(&parcel), out),
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

/// Device memory, which hands on control points.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Memory(pub(super) MemorySchedule);

impl<T: Topology> Step<T> for Memory {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Parcel(parcel, work) = *token else { misled(token) };
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
        let Token::Parcel(parcel, _) = token else { misled(token) };
        self.0.port(parcel)
    }
}

/// The control-point shader, and the port.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Points(pub(super) Steady);

impl<T: Topology> Step<T> for Points {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let cost = if let Token::Whole(_) = token { self.0.idle() } else { self.0.cost(1) };
        one(token, cost, out)
    }
}

/// Points to patches.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Assemble(pub(super) Steady);

impl<T: Topology> Step<T> for Assemble {
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

impl<T: Topology> Step<T> for Clip {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if self.1 { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Clipped { cost } else { one(token, cost, out) }
    }
}

/// Back-face removal.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Backface(pub(super) Steady);

impl<T: Topology> Step<T> for Backface {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if work.tested { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Culled { cost } else { one(token, cost, out) }
    }
}

/// Levels.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Level(pub(super) Steady);

impl<T: Topology> Step<T> for Level {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if work.levels > 0 { self.0.cost(work.levels) } else { self.0.idle() };
        one(token, cost, out)
    }
}

/// Parameter lists.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Place(pub(super) Steady);

impl<T: Topology> Step<T> for Place {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let divides = work.reciprocals > 0;
        let cost = if divides { self.0.cost(work.reciprocals.into()) } else { self.0.idle() };
        // Lists of a patch that is measured are kept here, for its second pass.
        if work.fate == Fate::Measured { cost } else { one(token, cost, out) }
    }
}

/// Points of the surface, in strips.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Evaluate(pub(super) evaluate::Schedule);

impl<T: Topology> Step<T> for Evaluate {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        self.0.accept(work.lists, &mut Strips(out, PhantomData))
    }
}

/// Triangles.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Stitch(pub(super) stitch::Schedule);

impl<T: Topology> Step<T> for Stitch {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Strip(strip) = token else { misled(token) };
        self.0.accept(strip, &mut Triangles { out, first: strip.first, lists: PhantomData })
    }
}

/// Perspective divide and output.
#[derive(Clone, Debug)]
pub(in crate::unit) struct EmitBlock(pub(super) emit::Schedule);

impl<T: Topology> Step<T> for EmitBlock {
    #[inline(always)]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Triangle(triangle, first) = *token else { misled(token) };
        self.0.accept(triangle, first, &mut Vertices(out, PhantomData))
    }
}

/// The vertex shader, and where its vertices are written, if they are.
#[derive(Clone, Debug)]
pub(in crate::unit) struct VertexShader(pub(super) Steady, pub(super) Option<Store>);

impl<T: Topology> Step<T> for VertexShader {
    #[inline(always)]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let cost = shade(self.0, &mut self.1);
        one(token, cost, out)
    }

    fn port(&self, _token: &Token<T>) -> Option<u64> {
        let store = self.1.as_ref().filter(|store| store.shared)?;
        Some(store.writes.whole_cycles(store.bytes))
    }
}

/// Where shaded vertices are written to memory.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Store {
    pub(super) writes: Wire,
    pub(super) bytes: u64,
    pub(super) shared: bool,
}

/// Emits the one output of a token when it is done.
#[inline(always)]
fn one<T: Topology>(token: &Token<T>, cost: Cost, out: &mut impl Emit<Token<T>>) -> Cost {
    out.emit(*token, cost.latency);
    cost
}

#[inline]
fn shade(shader: Steady, store: &mut Option<Store>) -> Cost {
    let cost = shader.cost(1);
    match store {
        Some(store) if !store.shared => {
            // Written behind the shader: it takes the next vertex when the last one's is through.
            let written = store.writes.occupy(store.bytes);
            Cost { interval: cost.interval.max(written), ..cost }
        }
        _ => cost,
    }
}

/// Vertices as tokens.
struct Vertices<'a, E, T>(&'a mut E, PhantomData<T>);

impl<T, E: Emit<Token<T>>> Emit<u16> for Vertices<'_, E, T> {
    #[inline(always)]
    fn emit(&mut self, _vertex: u16, offset: u64) {
        self.0.emit(Token::Vertex, offset);
    }
}

/// Triangles as tokens.
struct Triangles<'a, E, T> {
    out: &'a mut E,
    first: bool,
    lists: PhantomData<T>,
}

impl<T, E: Emit<Token<T>>> Emit<Triangle> for Triangles<'_, E, T> {
    #[inline(always)]
    fn emit(&mut self, triangle: Triangle, offset: u64) {
        let first = std::mem::take(&mut self.first);
        self.out.emit(Token::Triangle(triangle, first), offset);
    }
}

/// Strips as tokens.
struct Strips<'a, E, T>(&'a mut E, PhantomData<T>);

impl<T, E: Emit<Token<T>>> Emit<Strip> for Strips<'_, E, T> {
    #[inline(always)]
    fn emit(&mut self, strip: Strip, offset: u64) {
        self.0.emit(Token::Strip(strip), offset);
    }
}
