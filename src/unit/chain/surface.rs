//! The chain of a unit whose patches have lists of parameters: its blocks behind assemble, each
//! with what it makes of a token, and what that costs.

use super::block::{
    Assemble, Backface, Channel, Clip, Level, Link, Memory, Of, Points, Steady, Step, misled, one,
};
use super::{Fate, Flow, Token, chain_of};
use crate::config::Config;
use rtl_model::counter::Block as Name;
use rtl_model::patch::Triangle;
use rtl_model::strip::{Strip, Topology};
use rtl_model::time::{Block, Cost, Emit, Visitor};
use rtl_model::{emit, evaluate, stitch};
use std::marker::PhantomData;

chain_of! {
    /// A block of the chain.
    Stage [T] [T: Topology + 'static] T;
    Link, Memory, Points, Assemble, Clip, Backface, Level, Place, Evaluate, Stitch, EmitBlock,
    VertexShader
}

impl<T: Topology + 'static> Flow for T {
    type Stage = Stage<T>;
    const SHARES_EDGES: bool = true;

    fn stage(block: Name, config: &Config) -> Stage<T> {
        let Some(costs) = config.costs(block) else { return Stage::begin(block, config) };
        let steady = Steady::of(&costs);
        let (interval, latency) = (costs.interval, costs.latency);
        match block {
            Name::Transform | Name::Port => Stage::Points(Of::new(Points(steady))),
            Name::Assemble => Stage::Assemble(Of::new(Assemble(steady))),
            Name::Clip => Stage::Clip(Of::new(Clip(steady, config.clip.enabled))),
            Name::Backface => Stage::Backface(Of::new(Backface(steady))),
            Name::Level => Stage::Level(Of::new(Level(steady))),
            Name::Place => Stage::Place(Of::new(Place(steady))),
            Name::Evaluate => Stage::Evaluate(Of::new(Evaluate(evaluate::Schedule {
                interval,
                latency,
                setup: config.block.evaluate.setup,
                scheme: config.scheme(),
            }))),
            Name::Stitch => Stage::Stitch(Of::new(Stitch(stitch::Schedule { interval, latency }))),
            Name::Emit => {
                Stage::EmitBlock(Of::new(EmitBlock(emit::Schedule::new(interval, latency))))
            }
            Name::VertexShader => {
                let shader = &config.vertex_shader;
                let writes = || (Channel::new(config), shader.bytes_out.into());
                let store = shader.to_memory.then(writes);
                Stage::VertexShader(Of::new(VertexShader(steady, store)))
            }
            _ => unreachable!("{block:?} is not in this chain"),
        }
    }

    fn made(&self) -> [u64; 2] {
        [self.vertices() as u64, self.triangles() as u64]
    }

    fn join(self, out: &mut Vec<Triangle>) {
        stitch::accept(self, out);
    }

    fn edges(&self) -> [u64; 4] {
        [0, 1, 2, 3].map(|edge| self.edge(edge) as u64 + 1)
    }
}

/// Parameter lists.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Place(Steady);

impl<T: Topology + 'static> Step<T> for Place {
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
pub(in crate::unit) struct Evaluate(evaluate::Schedule);

impl<T: Topology + 'static> Step<T> for Evaluate {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        self.0.accept(work.lists, &mut Strips(out, PhantomData))
    }
}

/// Triangles.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Stitch(stitch::Schedule);

impl<T: Topology + 'static> Step<T> for Stitch {
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Strip(strip) = token else { misled(token) };
        self.0.accept(strip, &mut Triangles { out, first: strip.first, lists: PhantomData })
    }
}

/// Perspective divide and output.
#[derive(Clone, Debug)]
pub(in crate::unit) struct EmitBlock(emit::Schedule);

impl<T: Topology + 'static> Step<T> for EmitBlock {
    #[inline(always)]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let Token::Triangle(triangle, first) = *token else { misled(token) };
        self.0.accept(triangle, first, &mut Vertices(out, PhantomData))
    }
}

/// The vertex shader, and where its vertices are written, if they are: so many bytes each.
#[derive(Clone, Debug)]
pub(in crate::unit) struct VertexShader(Steady, Option<(Channel, u64)>);

impl<T: Topology + 'static> Step<T> for VertexShader {
    #[inline(always)]
    fn accept(&mut self, token: &Token<T>, out: &mut impl Emit<Token<T>>) -> Cost {
        let mut cost = self.0.cost(1);
        if let Some((channel, bytes)) = &mut self.1 {
            // Written behind the shader: it takes the next vertex when the last one's is through.
            cost.interval = cost.interval.max(channel.write(*bytes));
        }
        one(token, cost, out)
    }

    fn port(&self, _token: &Token<T>) -> Option<u64> {
        self.1.as_ref().and_then(|(channel, bytes)| channel.port(*bytes))
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
