//! The chains of blocks that the engines time: what flows between the blocks of a unit, and what
//! each of them makes of it.
//!
//! What a patch becomes was computed before, on all threads; here it flows as [`Work`], and the
//! blocks say what that costs.

use crate::config::{BlockCosts, Channels, Config, Unit};
use crate::link::schedule::{LinkSchedule, MemorySchedule, Parcel};
use crate::link::wire::Wire;
use rtl_model::counter::Block as Name;
use rtl_model::level;
use rtl_model::patch::Triangle;
use rtl_model::strip::{Segments, Strip};
use rtl_model::time::{Block, Cost, Emit, Shape};
use rtl_model::{emit, evaluate, stitch};

/// Levels of a patch: four edges and two interior directions.
const LEVELS: u8 = 6;

/// What became of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// Trivially clipped.
    Clipped,
    /// Removed as back-facing.
    Culled,
    /// Tessellated.
    Kept,
}

/// What its blocks did for a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Work {
    /// How far it came.
    pub(super) fate: Fate,
    /// Whether back-face removal tested it.
    pub(super) tested: bool,
    /// Levels computed: six, or one where it is fixed.
    pub(super) levels: u8,
    /// Reciprocals formed.
    pub(super) reciprocals: u8,
    /// Segments of the edges and of the interior, where it was tessellated.
    pub(super) segments: Segments,
}

impl Work {
    /// A patch that was clipped: no block behind has seen it.
    pub(super) fn clipped() -> Self {
        let segments = Segments::default();
        Self { fate: Fate::Clipped, tested: false, levels: 0, reciprocals: 0, segments }
    }

    /// Vertices and triangles that came of it.
    pub(super) fn made(&self) -> [u64; 2] {
        if self.fate != Fate::Kept {
            return [0; 2];
        }
        let [vertices, boundary] = [self.segments.vertices(), self.segments.boundary()];
        [vertices as u64, (2 * vertices - boundary - 2) as u64] // Euler
    }
}

/// Levels that a criterion computes for a patch.
pub(super) fn levels(criterion: level::Criterion) -> u8 {
    match criterion {
        level::Criterion::Fixed { .. } => 1,
        level::Criterion::Flatness { .. } | level::Criterion::EdgeLength { .. } => LEVELS,
    }
}

/// What flows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Token {
    /// Host to memory: a part of a command, or, with work, the fetch of a patch.
    Parcel(Parcel, Option<Work>),
    /// Host to vertex shader, where the host tessellates: so many vertices.
    Vertices(Parcel, u32),
    /// Memory to assemble: a control point; a patch's last one completes it.
    Point(Option<Work>),
    /// Assemble to evaluate.
    Patch(Work),
    /// Evaluate to stitch.
    Strip(Strip),
    /// Stitch to emit, and whether it is its patch's first.
    Triangle(Triangle, bool),
    /// Emit to the vertex shader.
    Vertex,
}

/// Cycles for each work item, and until its result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steady {
    interval: u64,
    latency: u64,
}

impl Steady {
    fn of(costs: &BlockCosts) -> Self {
        Self { interval: costs.interval.into(), latency: costs.latency.into() }
    }

    /// So many items one after another.
    fn cost(&self, items: u8) -> Cost {
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

/// A block of a chain.
#[derive(Clone, Debug)]
pub(super) enum Stage {
    Link(LinkSchedule),
    Memory(MemorySchedule),
    /// Transform and port.
    Points(Steady),
    Assemble(Steady),
    Clip(Steady, bool),
    Backface(Steady),
    Level(Steady),
    Place(Steady),
    Evaluate(evaluate::Schedule),
    Stitch(stitch::Schedule),
    Emit(emit::Schedule),
    VertexShader(Steady, Option<Store>),
}

/// Where shaded vertices are written to memory.
#[derive(Clone, Debug)]
pub(super) struct Store {
    writes: Wire,
    bytes: u64,
    shared: bool,
}

impl Block for Stage {
    type Token = Token;

    #[inline]
    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        match (self, token) {
            (Self::Emit(emit), &Token::Triangle(triangle, first)) => {
                emit.accept(triangle, first, &mut Vertices(out))
            }
            (Self::VertexShader(shader, store), Token::Vertex) => {
                let cost = shade(*shader, store);
                out.emit(Token::Vertex, cost.latency);
                cost
            }
            (Self::Stitch(stitch), Token::Strip(strip)) => {
                stitch.accept(strip, &mut Triangles { out, first: strip.first })
            }
            (stage, token) => stage.accept_patch(*token, out),
        }
    }

    fn port(&self, token: &Token) -> Option<u64> {
        match (self, token) {
            (Self::Memory(memory), Token::Parcel(parcel, _)) => memory.port(parcel),
            (Self::VertexShader(_, Some(store)), _) if store.shared => {
                Some(store.writes.whole_cycles(store.bytes))
            }
            _ => None,
        }
    }
}

impl Stage {
    /// What flows before there are strips.
    fn accept_patch(&mut self, token: Token, out: &mut impl Emit<Token>) -> Cost {
        match (self, token) {
            (Self::Link(link), Token::Parcel(parcel, _)) => one(token, link.accept(&parcel), out),
            (Self::Link(link), Token::Vertices(parcel, count)) => {
                let cost = link.accept(&parcel);
                let arrived = |k: u64| (k * cost.latency).div_ceil(count.into());
                (1..=count.into()).for_each(|k| out.emit(Token::Vertex, arrived(k)));
                cost
            }
            (Self::Memory(memory), Token::Parcel(parcel, work)) => {
                let points = memory.accept(&parcel);
                let count = u64::from(parcel.points);
                for k in 0..count {
                    out.emit(Token::Point(work.filter(|_| k + 1 == count)), points.offset(k));
                }
                points.cost()
            }
            (Self::Points(steady), Token::Point(_)) => one(token, steady.cost(1), out),
            (Self::Assemble(steady), Token::Point(work)) => {
                let cost = steady.cost(1);
                if let Some(work) = work {
                    out.emit(Token::Patch(work), cost.latency);
                }
                cost
            }
            (stage, Token::Patch(work)) => stage.accept_work(work, out),
            (stage, token) => unreachable!("{token:?} does not come to {stage:?}"),
        }
    }

    /// Patches, each with what is known of it.
    fn accept_work(&mut self, work: Work, out: &mut impl Emit<Token>) -> Cost {
        let patch = Token::Patch(work);
        match self {
            Self::Clip(steady, enabled) => {
                let cost = if *enabled { steady.cost(1) } else { steady.idle() };
                if work.fate == Fate::Clipped { cost } else { one(patch, cost, out) }
            }
            Self::Backface(steady) => {
                let cost = if work.tested { steady.cost(1) } else { steady.idle() };
                if work.fate == Fate::Culled { cost } else { one(patch, cost, out) }
            }
            Self::Level(steady) => one(patch, steady.cost(work.levels), out),
            Self::Place(steady) => {
                let divides = work.reciprocals > 0;
                let cost = if divides { steady.cost(work.reciprocals) } else { steady.idle() };
                one(patch, cost, out)
            }
            Self::Evaluate(evaluate) => evaluate.accept(work.segments, &mut Strips(out)),
            stage => unreachable!("a patch does not come to {stage:?}"),
        }
    }
}

/// Emits the one output of a token when it is done.
fn one(token: Token, cost: Cost, out: &mut impl Emit<Token>) -> Cost {
    out.emit(token, cost.latency);
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
struct Vertices<'a, E>(&'a mut E);

impl<E: Emit<Token>> Emit<u16> for Vertices<'_, E> {
    #[inline(always)]
    fn emit(&mut self, _vertex: u16, offset: u64) {
        self.0.emit(Token::Vertex, offset);
    }
}

/// Triangles as tokens.
struct Triangles<'a, E> {
    out: &'a mut E,
    first: bool,
}

impl<E: Emit<Token>> Emit<Triangle> for Triangles<'_, E> {
    #[inline(always)]
    fn emit(&mut self, triangle: Triangle, offset: u64) {
        let first = std::mem::take(&mut self.first);
        self.out.emit(Token::Triangle(triangle, first), offset);
    }
}

/// Strips as tokens.
struct Strips<'a, E>(&'a mut E);

impl<E: Emit<Token>> Emit<Strip> for Strips<'_, E> {
    #[inline(always)]
    fn emit(&mut self, strip: Strip, offset: u64) {
        self.0.emit(Token::Strip(strip), offset);
    }
}

/// The timed blocks of a unit, in the order of the data.
pub(super) fn blocks(unit: Unit) -> &'static [Name] {
    match unit {
        Unit::Hybrid => &[
            Name::Link,
            Name::Memory,
            Name::Transform,
            Name::Port,
            Name::Assemble,
            Name::Clip,
            Name::Backface,
            Name::Level,
            Name::Place,
            Name::Evaluate,
            Name::Stitch,
            Name::Emit,
            Name::VertexShader,
        ],
        Unit::Triangles => &[Name::Link, Name::VertexShader],
    }
}

/// The chain of the configured unit.
pub(super) fn stages(config: &Config) -> Vec<(Stage, Shape)> {
    blocks(config.unit).iter().map(|&block| stage(block, config)).collect()
}

fn stage(block: Name, config: &Config) -> (Stage, Shape) {
    let Some(costs) = config.costs(block) else {
        return if block == Name::Link {
            let link = LinkSchedule::new(config);
            let shape = link.shape();
            (Stage::Link(link), shape)
        } else {
            let memory = MemorySchedule::new(config);
            let shape = memory.shape();
            (Stage::Memory(memory), shape)
        };
    };
    let steady = Steady::of(&costs);
    let mut shape = costs.shape();
    let stage = match block {
        Name::Transform | Name::Port => Stage::Points(steady),
        Name::Assemble => Stage::Assemble(steady),
        Name::Clip => Stage::Clip(steady, config.clip.enabled),
        Name::Backface => Stage::Backface(steady),
        Name::Level => Stage::Level(steady),
        Name::Place => Stage::Place(steady),
        Name::Evaluate => Stage::Evaluate(evaluate::Schedule {
            interval: costs.interval,
            latency: costs.latency,
            setup: config.block.evaluate.setup,
            scheme: config.evaluate.scheme,
        }),
        Name::Stitch => {
            Stage::Stitch(stitch::Schedule { interval: costs.interval, latency: costs.latency })
        }
        Name::Emit => Stage::Emit(emit::Schedule::new(costs.interval, costs.latency)),
        Name::VertexShader => {
            let store = store(config);
            shape.shares_port = store.as_ref().is_some_and(|store| store.shared);
            Stage::VertexShader(steady, store)
        }
        Name::Trace | Name::Link | Name::Memory | Name::Unit => {
            unreachable!("{block:?} has no costs")
        }
    };
    (stage, shape)
}

fn store(config: &Config) -> Option<Store> {
    config.vertex_shader.to_memory.then(|| Store {
        writes: Wire::new(config.memory.bandwidth_mb_s, config.clock_mhz),
        bytes: config.vertex_shader.bytes_out.into(),
        shared: config.memory.channels == Channels::Shared,
    })
}
