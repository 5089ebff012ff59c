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
use rtl_model::time::{Block, Cost, Emit, Shape, Visitor};
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
    Link(Link),
    Memory(Memory),
    Points(Points),
    Assemble(Assemble),
    Clip(Clip),
    Backface(Backface),
    Level(Level),
    Place(Place),
    Evaluate(Evaluate),
    Stitch(Stitch),
    Emit(EmitBlock),
    VertexShader(VertexShader),
}

/// `$body` of the block that `$stage` is.
macro_rules! of_kind {
    ($stage:expr, $block:ident => $body:expr) => {
        match $stage {
            Stage::Link($block) => $body,
            Stage::Memory($block) => $body,
            Stage::Points($block) => $body,
            Stage::Assemble($block) => $body,
            Stage::Clip($block) => $body,
            Stage::Backface($block) => $body,
            Stage::Level($block) => $body,
            Stage::Place($block) => $body,
            Stage::Evaluate($block) => $body,
            Stage::Stitch($block) => $body,
            Stage::Emit($block) => $body,
            Stage::VertexShader($block) => $body,
        }
    };
}

impl Block for Stage {
    type Token = Token;

    #[inline]
    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        of_kind!(self, block => block.accept(token, out))
    }

    fn port(&self, token: &Token) -> Option<u64> {
        of_kind!(self, block => block.port(token))
    }

    fn visit(&mut self, visitor: impl Visitor<Token>) {
        of_kind!(self, block => visitor.visit(block));
    }
}

/// A token that does not belong here: the chain is wired wrongly.
#[cold]
fn misled(token: &Token) -> ! {
    unreachable!("{token:?} came to a block that does not take it")
}

/// The link from the host.
#[derive(Clone, Debug)]
pub(super) struct Link(LinkSchedule);

impl Block for Link {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
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
pub(super) struct Memory(MemorySchedule);

impl Block for Memory {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Parcel(parcel, work) = *token else { misled(token) };
        let points = self.0.accept(&parcel);
        let count = u64::from(parcel.points);
        for k in 0..count {
            out.emit(Token::Point(work.filter(|_| k + 1 == count)), points.offset(k));
        }
        points.cost()
    }

    fn port(&self, token: &Token) -> Option<u64> {
        let Token::Parcel(parcel, _) = token else { misled(token) };
        self.0.port(parcel)
    }
}

/// The control-point shader, and the port.
#[derive(Clone, Debug)]
pub(super) struct Points(Steady);

impl Block for Points {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        one(token, self.0.cost(1), out)
    }
}

/// Points to patches.
#[derive(Clone, Debug)]
pub(super) struct Assemble(Steady);

impl Block for Assemble {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Point(work) = *token else { misled(token) };
        let cost = self.0.cost(1);
        if let Some(work) = work {
            out.emit(Token::Patch(work), cost.latency);
        }
        cost
    }
}

/// Trivial clipping, and whether it is enabled.
#[derive(Clone, Debug)]
pub(super) struct Clip(Steady, bool);

impl Block for Clip {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if self.1 { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Clipped { cost } else { one(token, cost, out) }
    }
}

/// Back-face removal.
#[derive(Clone, Debug)]
pub(super) struct Backface(Steady);

impl Block for Backface {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = if work.tested { self.0.cost(1) } else { self.0.idle() };
        if work.fate == Fate::Culled { cost } else { one(token, cost, out) }
    }
}

/// Levels.
#[derive(Clone, Debug)]
pub(super) struct Level(Steady);

impl Block for Level {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        one(token, self.0.cost(work.levels), out)
    }
}

/// Parameter lists.
#[derive(Clone, Debug)]
pub(super) struct Place(Steady);

impl Block for Place {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let divides = work.reciprocals > 0;
        let cost = if divides { self.0.cost(work.reciprocals) } else { self.0.idle() };
        one(token, cost, out)
    }
}

/// Points of the surface, in strips.
#[derive(Clone, Debug)]
pub(super) struct Evaluate(evaluate::Schedule);

impl Block for Evaluate {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        self.0.accept(work.segments, &mut Strips(out))
    }
}

/// Triangles.
#[derive(Clone, Debug)]
pub(super) struct Stitch(stitch::Schedule);

impl Block for Stitch {
    type Token = Token;

    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Strip(strip) = token else { misled(token) };
        self.0.accept(strip, &mut Triangles { out, first: strip.first })
    }
}

/// Perspective divide and output.
#[derive(Clone, Debug)]
pub(super) struct EmitBlock(emit::Schedule);

impl Block for EmitBlock {
    type Token = Token;

    #[inline(always)]
    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let Token::Triangle(triangle, first) = *token else { misled(token) };
        self.0.accept(triangle, first, &mut Vertices(out))
    }
}

/// The vertex shader, and where its vertices are written, if they are.
#[derive(Clone, Debug)]
pub(super) struct VertexShader(Steady, Option<Store>);

impl Block for VertexShader {
    type Token = Token;

    #[inline(always)]
    fn accept(&mut self, token: &Token, out: &mut impl Emit<Token>) -> Cost {
        let cost = shade(self.0, &mut self.1);
        one(token, cost, out)
    }

    fn port(&self, _token: &Token) -> Option<u64> {
        let store = self.1.as_ref().filter(|store| store.shared)?;
        Some(store.writes.whole_cycles(store.bytes))
    }
}

/// Where shaded vertices are written to memory.
#[derive(Clone, Debug)]
pub(super) struct Store {
    writes: Wire,
    bytes: u64,
    shared: bool,
}

/// Emits the one output of a token when it is done.
#[inline(always)]
fn one(token: &Token, cost: Cost, out: &mut impl Emit<Token>) -> Cost {
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
            (Stage::Link(Link(link)), shape)
        } else {
            let memory = MemorySchedule::new(config);
            let shape = memory.shape();
            (Stage::Memory(Memory(memory)), shape)
        };
    };
    let steady = Steady::of(&costs);
    let mut shape = costs.shape();
    let stage = match block {
        Name::Transform | Name::Port => Stage::Points(Points(steady)),
        Name::Assemble => Stage::Assemble(Assemble(steady)),
        Name::Clip => Stage::Clip(Clip(steady, config.clip.enabled)),
        Name::Backface => Stage::Backface(Backface(steady)),
        Name::Level => Stage::Level(Level(steady)),
        Name::Place => Stage::Place(Place(steady)),
        Name::Evaluate => Stage::Evaluate(Evaluate(evaluate::Schedule {
            interval: costs.interval,
            latency: costs.latency,
            setup: config.block.evaluate.setup,
            scheme: config.evaluate.scheme,
        })),
        Name::Stitch => {
            let (interval, latency) = (costs.interval, costs.latency);
            Stage::Stitch(Stitch(stitch::Schedule { interval, latency }))
        }
        Name::Emit => Stage::Emit(EmitBlock(emit::Schedule::new(costs.interval, costs.latency))),
        Name::VertexShader => {
            let store = store(config);
            shape.shares_port = store.as_ref().is_some_and(|store| store.shared);
            Stage::VertexShader(VertexShader(steady, store))
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
