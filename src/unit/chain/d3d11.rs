//! The chain of unit `d3d11`: its blocks behind assemble, each with what it makes of a token, and
//! what that costs.
//!
//! ```text
//!   patch ─► hull ─► factors ─► points ─► connect ─ waves ─► domain ─► emit
//! ```

use super::block::{Assemble, Channel, Link, Memory, Of, Steady, Step, misled, one};
use super::{Fate, Flow, Token, chain_of};
use crate::config::Config;
use rtl_model::counter::Block as Name;
use rtl_model::d3d11::wave::Waves;
use rtl_model::d3d11::{Factors as Processed, Output, Tessellator};
use rtl_model::time::{Block, Cost, Emit, Visitor};

/// Threads of the hull shader for a patch: one for each control point, and one for its factors.
const THREADS: u16 = 16 + 1;
/// Tessellation factors of a quad.
const FACTORS: u16 = 6;

/// What the triangles of a patch depend on, and what moves for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::unit) struct Pattern {
    pub(in crate::unit) factors: Processed,
    /// Bytes that the hull shader hands on.
    pub(in crate::unit) hull_bytes: u32,
}

impl Pattern {
    /// Bytes of the bursts that they take in memory.
    pub(in crate::unit) fn moved(&self, burst: u32) -> u64 {
        u64::from(self.hull_bytes).next_multiple_of(burst.into())
    }
}

/// Points that are shaded side by side, and what comes of them.
#[derive(Clone, Copy, Debug)]
pub(in crate::unit) struct Wave {
    points: u16,
    triangles: u16,
    /// Bytes of the bursts that bring the patch, before its first wave.
    read: u32,
}

chain_of! {
    /// A block of the chain.
    Stage [] [] Pattern;
    Link, Memory, Assemble, Hull, Factors, Points, Connect, Domain, EmitWaves
}

impl Flow for Pattern {
    type Stage = Stage;
    const SHARES_EDGES: bool = false;

    fn stage(block: Name, config: &Config) -> Stage {
        let Some(costs) = config.costs(block) else { return Stage::begin(block, config) };
        let steady = Steady::of(&costs);
        let channel = config.hull.to_memory.then(|| Channel::new(config));
        let burst = config.memory.burst;
        match block {
            Name::Assemble => Stage::Assemble(Of::new(Assemble(steady))),
            Name::Hull => Stage::Hull(Of::new(Hull { steady, channel, burst })),
            Name::Factors => Stage::Factors(Of::new(Factors(steady))),
            Name::Points => Stage::Points(Of::new(Points(steady))),
            Name::Connect => Stage::Connect(Of::new(Connect {
                steady,
                tessellator: Box::default(),
                walked: None,
                waves: Waves::new(config.domain.cache_entries, config.domain.width as u16),
                read: channel.map(|_| burst),
            })),
            Name::Domain => {
                let latency = config.memory.latency.into();
                Stage::Domain(Of::new(Domain { steady, channel, latency }))
            }
            Name::Emit => Stage::EmitWaves(Of::new(EmitWaves(steady))),
            _ => unreachable!("{block:?} is not in this chain"),
        }
    }

    fn made(&self) -> [u64; 2] {
        [self.factors.points(), self.factors.indices(Output::Cw) / 3].map(|count| count as u64)
    }

    fn edges(&self) -> [u64; 4] {
        [1, 2, 3, 0].map(|edge| self.factors.edge_points(edge) as u64)
    }
}

/// The hull shader, and where what it hands on is written, if it is.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Hull {
    steady: Steady,
    channel: Option<Channel>,
    burst: u32,
}

impl Step<Pattern> for Hull {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let mut cost = self.steady.cost(THREADS.into());
        if let Some(channel) = &mut self.channel {
            // Written behind the shader: it takes the next patch when the last one's is through.
            let written = channel.write(work.lists.moved(self.burst));
            cost.interval = cost.interval.max(written);
        }
        one(token, cost, out)
    }

    fn port(&self, token: &Token<Pattern>) -> Option<u64> {
        let Token::Patch(work) = token else { misled(token) };
        self.channel.as_ref()?.port(work.lists.moved(self.burst))
    }
}

/// Tessellation factors, of which a zero ends a patch.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Factors(Steady);

impl Step<Pattern> for Factors {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = self.0.cost(FACTORS.into());
        if work.fate == Fate::Kept { one(token, cost, out) } else { cost }
    }
}

/// Domain points, into the point store.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Points(Steady);

impl Step<Pattern> for Points {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let cost = self.0.cost(work.lists.factors.points() as u64);
        one(token, cost, out)
    }
}

/// Triangles, and the waves of points to be shaded for them.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Connect {
    steady: Steady,
    tessellator: Box<Tessellator>,
    /// What the tessellator made last.
    walked: Option<Processed>,
    waves: Waves,
    /// Bytes of a burst, where a patch comes from memory.
    read: Option<u32>,
}

impl Step<Pattern> for Connect {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        let Pattern { factors, .. } = work.lists;
        if self.walked != Some(factors) {
            self.tessellator.accept(&factors, Output::Cw);
            self.walked = Some(factors);
        }
        let (triangles, _) = self.tessellator.indices().as_chunks();
        let mut read = self.read.map_or(0, |burst| work.lists.moved(burst) as u32);
        let steady = self.steady;
        self.waves.walk(triangles, |wave| {
            let offset = steady.cost(wave.walked.into()).latency;
            let read = std::mem::take(&mut read);
            let wave = Wave { points: wave.points, triangles: wave.triangles, read };
            out.emit(Token::Wave(wave), offset);
        });
        self.steady.cost(triangles.len() as u64)
    }
}

/// The domain shader, and what brings a patch to it, where it comes from memory.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Domain {
    steady: Steady,
    channel: Option<Channel>,
    /// Cycles from a read to its data.
    latency: u64,
}

impl Step<Pattern> for Domain {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Wave(wave) = token else { misled(token) };
        let mut cost = self.steady.cost(1);
        if let (Some(channel), 1..) = (&mut self.channel, wave.read) {
            let [come, held] = channel.read(wave.read.into());
            cost.interval = cost.interval.max(held);
            cost.latency += self.latency + come;
        }
        one(token, cost, out)
    }

    fn port(&self, token: &Token<Pattern>) -> Option<u64> {
        let Token::Wave(wave) = token else { misled(token) };
        let channel = self.channel.as_ref().filter(|_| wave.read > 0)?;
        channel.port(wave.read.into())
    }
}

/// Perspective divide of a wave's points, and its triangles, side by side.
#[derive(Clone, Debug)]
pub(in crate::unit) struct EmitWaves(Steady);

impl Step<Pattern> for EmitWaves {
    fn accept(&mut self, token: &Token<Pattern>, out: &mut impl Emit<Token<Pattern>>) -> Cost {
        let Token::Wave(wave) = token else { misled(token) };
        one(token, self.0.cost(wave.points.max(wave.triangles).into()), out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_hull_shader_hands_on_moves_in_whole_bursts() {
        let pattern = Pattern { hull_bytes: 280, ..Pattern::default() };
        assert_eq!([8, 32, 4096].map(|burst| pattern.moved(burst)), [280, 288, 4096]);
    }
}
