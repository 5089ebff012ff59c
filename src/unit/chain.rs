//! The chains of blocks that the engines time: what flows between the blocks of a unit, and what
//! each of them makes of it.
//!
//! What a patch becomes was computed before, on all threads; here it flows as [`Work`], and the
//! blocks say what that costs.

mod block;
mod d3d11;
mod esc;
mod surface;

use crate::config::{Channels, Config, Unit};
use crate::link::schedule::{LinkSchedule, MemorySchedule, Parcel};
use rtl_model::counter::Block as Name;
use rtl_model::level;
use rtl_model::patch::Triangle;
use rtl_model::strip::Strip;
use rtl_model::time::{Block, Shape};
use std::fmt;

/// An enum of the blocks that stand in one chain, each by the name of what it makes of a token.
macro_rules! chain_of {
    (
        $(#[$doc:meta])* $name:ident [$($arguments:tt)*] [$($bounds:tt)*] $lists:ty;
        $($kind:ident),* $(,)?
    ) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub(in crate::unit) enum $name<$($arguments)*> {
            $($kind(Of<$kind, $lists>),)*
        }

        impl<$($bounds)*> $name<$($arguments)*> {
            /// What every chain begins with: link and memory.
            fn begin(block: Name, config: &Config) -> Self {
                match block {
                    Name::Link => Self::Link(Of::new(Link::new(config))),
                    Name::Memory => Self::Memory(Of::new(Memory::new(config))),
                    _ => unreachable!("{block:?} has no costs"),
                }
            }
        }

        impl<$($bounds)*> Block for $name<$($arguments)*> {
            type Token = Token<$lists>;

            #[inline]
            fn accept(
                &mut self,
                token: &Token<$lists>,
                out: &mut impl Emit<Token<$lists>>,
            ) -> Cost {
                match self {
                    $(Self::$kind(block) => block.accept(token, out),)*
                }
            }

            fn port(&self, token: &Token<$lists>) -> Option<u64> {
                match self {
                    $(Self::$kind(block) => block.port(token),)*
                }
            }

            fn visit(&mut self, visitor: impl Visitor<Token<$lists>>) {
                match self {
                    $(Self::$kind(block) => visitor.visit(block),)*
                }
            }
        }
    };
}

use chain_of;
use d3d11::Wave;

pub(super) use d3d11::Pattern;
pub(super) use esc::{Invocations, Lane, Meshed};

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

impl<T: Flow> Work<T> {
    /// A patch that was clipped: no block behind has seen it.
    pub(super) fn clipped(lists: T) -> Self {
        Self { fate: Fate::Clipped, tested: false, levels: 0, reciprocals: 0, lists }
    }

    /// Vertices and triangles that came of it.
    pub(super) fn made(&self) -> [u64; 2] {
        if self.fate == Fate::Kept { self.lists.made() } else { [0; 2] }
    }

    /// What it takes of a wave of the surface shader, where it is tessellated by one.
    pub(super) fn lane(&self) -> Option<Lane> {
        if self.fate == Fate::Kept { self.lists.lane() } else { None }
    }
}

/// What the triangles of a patch depend on, and through it the chain of units whose patches have
/// such lists.
pub(super) trait Flow: Copy + Default + Eq + Send + Sync + fmt::Debug + 'static {
    /// A block of the chain.
    type Stage: Block<Token = Token<Self>>;
    /// Whether its vertices on shared edges are counted.
    const SHARES_EDGES: bool;

    /// The block of that name.
    ///
    /// # Panics
    /// When it is not in this chain.
    fn stage(block: Name, config: &Config) -> Self::Stage;

    /// Vertices and triangles of a patch.
    fn made(&self) -> [u64; 2];

    /// Vertices of the edges v0, u1, v1, u0, each with both its ends.
    fn edges(&self) -> [u64; 4];

    /// What it takes of a wave of the surface shader, where there is one.
    fn lane(&self) -> Option<Lane> {
        None
    }

    /// Appends its triangles, where a host may have made them.
    fn join(self, _out: &mut Vec<Triangle>) {}

    /// It completes a wave.
    fn close(&mut self, _wave: Invocations) {}
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
    /// Host to memory, where that has the vertices that the host made: read these.
    Fetch(Parcel),
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
    /// Emit, or memory, to the vertex shader.
    Vertex,
    /// Connectivity to the domain shader and on to emit (unit `d3d11`).
    Wave(Wave),
    /// Group to the surface shader and on to emit (unit `esc`).
    Invocations(Invocations),
}

/// The timed blocks of a unit, in the order of the data.
pub(super) fn blocks(config: &Config) -> &'static [Name] {
    match config.unit {
        Unit::Hybrid | Unit::Sfarti | Unit::Moreton | Unit::Esc => {
            &super::blocks(config)[1..] // all but trace
        }
        Unit::D3d11 => &[
            Name::Link,
            Name::Memory,
            Name::Assemble,
            Name::Hull,
            Name::Factors,
            Name::Points,
            Name::Connect,
            Name::Domain,
            Name::Emit,
        ],
        Unit::Triangles if config.triangles.uses_memory() => {
            &[Name::Link, Name::Memory, Name::VertexShader]
        }
        Unit::Triangles => &[Name::Link, Name::VertexShader],
    }
}

/// How a block of the configured unit stands in its chain.
fn shape(block: Name, config: &Config) -> Shape {
    let shared = config.memory.channels == Channels::Shared;
    match (block, config.costs(block)) {
        (Name::Link, _) => LinkSchedule::new(config).shape(),
        (Name::Memory, _) => MemorySchedule::new(config).shape(),
        (_, None) => unreachable!("{block:?} is in no chain"),
        (_, Some(costs)) => {
            let to_memory = match block {
                Name::VertexShader => config.vertex_shader.to_memory,
                Name::Hull | Name::Domain => config.hull.to_memory,
                _ => false,
            };
            Shape { shares_port: shared && to_memory, ..costs.shape() }
        }
    }
}

/// The shapes of the configured unit's chain.
pub(super) fn shapes(config: &Config) -> impl Iterator<Item = (Name, Shape)> {
    blocks(config).iter().map(|&block| (block, shape(block, config)))
}

/// The chain of the configured unit, which must be one of those whose patches have such lists.
pub(super) fn stages<T: Flow>(config: &Config) -> Vec<(T::Stage, Shape)> {
    shapes(config).map(|(block, shape)| (T::stage(block, config), shape)).collect()
}
