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
use rtl_model::strip::{Strip, Topology};
use rtl_model::time::{Block, Cost, Emit, Shape, Visitor};
use rtl_model::{emit, evaluate, stitch};

use block::{
    Assemble, Backface, Clip, EmitBlock, Evaluate, Level, Link, Memory, Of, Place, Points, Steady,
    Stitch, Store, VertexShader,
};

/// Levels of a patch: four edges and two interior directions.
const LEVELS: u16 = 6;

/// What became of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// Trivially clipped.
    Clipped,
    /// Removed as back-facing.
    Culled,
    /// Its lists were taken into its primitive's unions; it comes again to be tessellated.
    Measured,
    /// Tessellated.
    Kept,
}

/// What its blocks did for a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Work<T> {
    /// How far it came.
    pub(super) fate: Fate,
    /// Whether back-face removal tested it.
    pub(super) tested: bool,
    /// What the level block did one after another: six levels, or one where it is fixed; or the
    /// pieces of curves that it looked at; 0 where it did so when the patch was measured.
    pub(super) levels: u16,
    /// Reciprocals formed.
    pub(super) reciprocals: u8,
    /// The lists of the edges and of the interior, where it was tessellated.
    pub(super) lists: T,
}

impl<T: Topology> Work<T> {
    /// A patch that was clipped: no block behind has seen it.
    pub(super) fn clipped() -> Self {
        let lists = T::default();
        Self { fate: Fate::Clipped, tested: false, levels: 0, reciprocals: 0, lists }
    }

    /// Vertices and triangles that came of it.
    pub(super) fn made(&self) -> [u64; 2] {
        if self.fate != Fate::Kept {
            return [0; 2];
        }
        [self.lists.vertices() as u64, self.lists.triangles() as u64]
    }
}

/// Levels that a criterion computes for a patch.
pub(super) fn levels(criterion: level::Criterion) -> u16 {
    match criterion {
        level::Criterion::Fixed { .. } => 1,
        level::Criterion::Flatness { .. } | level::Criterion::EdgeLength { .. } => LEVELS,
    }
}

/// What flows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Token<T> {
    /// Host to memory: a part of a command, or, with work, the fetch of a patch.
    Parcel(Parcel, Option<Work<T>>),
    /// Host to vertex shader, where the host tessellates: so many vertices.
    Vertices(Parcel, u32),
    /// Memory to assemble: a control point; a patch's last one completes it.
    Point(Option<Work<T>>),
    /// Memory to assemble: a patch of which every control point is on chip already.
    Whole(Work<T>),
    /// Assemble to evaluate.
    Patch(Work<T>),
    /// Evaluate to stitch.
    Strip(Strip),
    /// Stitch to emit, and whether it is its patch's first.
    Triangle(Triangle, bool),
    /// Emit to the vertex shader.
    Vertex,
}

/// A block of a chain.
#[derive(Clone, Debug)]
pub(super) enum Stage<T> {
    Link(Of<Link, T>),
    Memory(Of<Memory, T>),
    Points(Of<Points, T>),
    Assemble(Of<Assemble, T>),
    Clip(Of<Clip, T>),
    Backface(Of<Backface, T>),
    Level(Of<Level, T>),
    Place(Of<Place, T>),
    Evaluate(Of<Evaluate, T>),
    Stitch(Of<Stitch, T>),
    Emit(Of<EmitBlock, T>),
    VertexShader(Of<VertexShader, T>),
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

impl<T: Topology> Block for Stage<T> {
    type Token = Token<T>;

    #[inline]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        of_kind!(self, block => block.accept(token, out))
    }

    fn port(&self, token: &Token<T>) -> Option<u64> {
        of_kind!(self, block => block.port(token))
    }

    fn visit(&mut self, visitor: impl Visitor<Token<T>>) {
        of_kind!(self, block => visitor.visit(block));
    }
}

/// The timed blocks of a unit, in the order of the data.
pub(super) fn blocks(unit: Unit) -> &'static [Name] {
    match unit {
        Unit::Hybrid | Unit::Sfarti | Unit::Moreton => &super::blocks(unit)[1..], // all but trace
        Unit::Triangles => &[Name::Link, Name::VertexShader],
    }
}

/// The chain of the configured unit.
pub(super) fn stages<T: Topology>(config: &Config) -> Vec<(Stage<T>, Shape)> {
    blocks(config.unit).iter().map(|&block| stage(block, config)).collect()
}

fn stage<T: Topology>(block: Name, config: &Config) -> (Stage<T>, Shape) {
    let Some(costs) = config.costs(block) else {
        return if block == Name::Link {
            let link = LinkSchedule::new(config);
            let shape = link.shape();
            (Stage::Link(Of::new(Link(link))), shape)
        } else {
            let memory = MemorySchedule::new(config);
            let shape = memory.shape();
            (Stage::Memory(Of::new(Memory(memory))), shape)
        };
    };
    let steady = Steady::of(&costs);
    let mut shape = costs.shape();
    let stage = match block {
        Name::Transform | Name::Port => Stage::Points(Of::new(Points(steady))),
        Name::Assemble => Stage::Assemble(Of::new(Assemble(steady))),
        Name::Clip => Stage::Clip(Of::new(Clip(steady, config.clip.enabled))),
        Name::Backface => Stage::Backface(Of::new(Backface(steady))),
        Name::Level => Stage::Level(Of::new(Level(steady))),
        Name::Place => Stage::Place(Of::new(Place(steady))),
        Name::Evaluate => Stage::Evaluate(Of::new(Evaluate(evaluate::Schedule {
            interval: costs.interval,
            latency: costs.latency,
            setup: config.block.evaluate.setup,
            scheme: config.scheme(),
        }))),
        Name::Stitch => {
            let (interval, latency) = (costs.interval, costs.latency);
            Stage::Stitch(Of::new(Stitch(stitch::Schedule { interval, latency })))
        }
        Name::Emit => {
            Stage::Emit(Of::new(EmitBlock(emit::Schedule::new(costs.interval, costs.latency))))
        }
        Name::VertexShader => {
            let store = store(config);
            shape.shares_port = store.as_ref().is_some_and(|store| store.shared);
            Stage::VertexShader(Of::new(VertexShader(steady, store)))
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
