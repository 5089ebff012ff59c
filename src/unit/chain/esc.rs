//! The chain of unit `esc`: its blocks, each with what it makes of a token, and what that costs.
//! Patches go in; from where waves are formed on, a token is a wave of invocations.

use super::block::{
    Assemble, Backface, Clip, Level, Link, Memory, Of, Points, Steady, Step, misled, one,
};
use super::{Fate, Flow, Token, chain_of};
use crate::config::Config;
use rtl_model::counter::Block as Name;
use rtl_model::esc::{Levels, Phases};
use rtl_model::time::{Block, Cost, Emit, Visitor};

/// What a wave of invocations takes, and what comes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::unit) struct Invocations {
    /// Cycles of a processor.
    pub(in crate::unit) cycles: u64,
    /// Vertices that leave.
    pub(in crate::unit) vertices: u64,
    /// Triangles that leave.
    pub(in crate::unit) triangles: u64,
}

/// What a patch takes of a wave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::unit) struct Lane {
    pub(in crate::unit) phases: Phases,
    pub(in crate::unit) vertices: u32,
    pub(in crate::unit) triangles: u32,
}

/// What a patch takes of a wave, what comes of it, and its wave, if it completes one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::unit) struct Meshed {
    pub(in crate::unit) lane: Lane,
    pub(in crate::unit) levels: Levels,
    /// Only a patch that completes a wave has it.
    pub(in crate::unit) wave: Option<Invocations>,
}

chain_of! {
    /// A block of the chain.
    Stage [] [] Meshed;
    Link, Memory, Points, Assemble, Clip, Backface, Level, Group, Surface, EmitWaves
}

impl Flow for Meshed {
    type Stage = Stage;
    const SHARES_EDGES: bool = false;

    fn stage(block: Name, config: &Config) -> Stage {
        let Some(costs) = config.costs(block) else { return Stage::begin(block, config) };
        let steady = Steady::of(&costs);
        match block {
            Name::Transform | Name::Port => Stage::Points(Of::new(Points(steady))),
            Name::Assemble => Stage::Assemble(Of::new(Assemble(steady))),
            Name::Clip => Stage::Clip(Of::new(Clip(steady, config.clip.enabled))),
            Name::Backface => Stage::Backface(Of::new(Backface(steady))),
            Name::Level => Stage::Level(Of::new(Level(steady))),
            Name::Group => Stage::Group(Of::new(Group(steady))),
            Name::Surface => Stage::Surface(Of::new(Surface { latency: costs.latency.into() })),
            Name::Emit => Stage::EmitWaves(Of::new(EmitWaves(steady))),
            _ => unreachable!("{block:?} is not in this chain"),
        }
    }

    fn made(&self) -> [u64; 2] {
        [self.lane.vertices.into(), self.lane.triangles.into()]
    }

    fn edges(&self) -> [u64; 4] {
        [0; 4]
    }

    fn lane(&self) -> Option<Lane> {
        Some(self.lane)
    }

    fn close(&mut self, wave: Invocations) {
        self.wave = Some(wave);
    }
}

/// Patches to waves: the one that completes its wave sends it on.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Group(Steady);

impl Step<Meshed> for Group {
    fn accept(&mut self, token: &Token<Meshed>, out: &mut impl Emit<Token<Meshed>>) -> Cost {
        let Token::Patch(work) = token else { misled(token) };
        debug_assert_eq!(work.fate, Fate::Kept);
        let cost = self.0.cost(1);
        if let Some(wave) = work.lists.wave {
            out.emit(Token::Invocations(wave), cost.latency);
        }
        cost
    }
}

/// The surface shader.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Surface {
    /// Cycles from a wave's last instruction to its output.
    latency: u64,
}

impl Step<Meshed> for Surface {
    fn accept(&mut self, token: &Token<Meshed>, out: &mut impl Emit<Token<Meshed>>) -> Cost {
        let Token::Invocations(wave) = token else { misled(token) };
        let cycles = wave.cycles.max(1); // where nothing costs anything
        one(token, Cost { interval: cycles, latency: cycles + self.latency }, out)
    }
}

/// Perspective divide of a wave's vertices, and its triangles, side by side.
#[derive(Clone, Debug)]
pub(in crate::unit) struct EmitWaves(Steady);

impl Step<Meshed> for EmitWaves {
    fn accept(&mut self, token: &Token<Meshed>, out: &mut impl Emit<Token<Meshed>>) -> Cost {
        let Token::Invocations(wave) = token else { misled(token) };
        one(token, self.0.cost(wave.vertices.max(wave.triangles)), out)
    }
}
