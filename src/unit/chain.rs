//! The chains of blocks that the engines time: what flows between the blocks of a unit, and what
//! each of them makes of it.
//!
//! What a patch becomes was computed before, on all threads; here it flows as [`Work`], and the
//! blocks say what that costs.

mod block;

use crate::config::{Channels, Config, Unit};
use crate::link::schedule::{LinkSchedule, MemorySchedule, Parcel};
use crate::link::wire::Wire;
use rtl_model::counter::Block as Name;
use rtl_model::level;
use rtl_model::patch::Triangle;
use rtl_model::place::Numbering;
use rtl_model::strip::{Segments, Strip};
use rtl_model::time::{Block, Cost, Emit, Shape, Visitor};
use rtl_model::{emit, evaluate, stitch};

use block::{
    Assemble, Backface, Clip, EmitBlock, Evaluate, Level, Link, Memory, Place, Points, Steady,
    Stitch, Store, VertexShader,
};

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
    /// Memory to assemble: a patch of which every control point is on chip already.
    Whole(Work),
    /// Assemble to evaluate.
    Patch(Work),
    /// Evaluate to stitch.
    Strip(Strip),
    /// Stitch to emit, and whether it is its patch's first.
    Triangle(Triangle, bool),
    /// Emit to the vertex shader.
    Vertex,
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

/// The timed blocks of a unit, in the order of the data.
pub(super) fn blocks(unit: Unit) -> &'static [Name] {
    match unit {
        Unit::Hybrid => &super::blocks(unit)[1..], // all but the trace
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
