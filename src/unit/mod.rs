//! The units under study: which blocks, wired how, which defaults.
//!
//! Commands come in, triangles stream into a sink, counters come out. `run` carries out the
//! commands, `frame` derives what is constant over a frame, `draw` and `fetch` say where a draw's
//! patches get their points, `batch` collects patches and spreads them over the threads, `pipeline`
//! takes one patch through the blocks, of which `hybrid`, `sfarti` and `moreton` each have some of
//! their own. `union` holds the lists that patches of a primitive share, `edges` what it keeps of
//! their edges; `chain` and `clock` put it all on the clock; `tokens` and `arithmetic` say from a
//! frame's counters what flowed and what it took.

pub mod arithmetic;
mod attributes;
mod batch;
mod chain;
mod clock;
mod draw;
mod edges;
mod fetch;
mod frame;
mod hybrid;
mod moreton;
pub mod pattern;
mod pipeline;
mod run;
mod sfarti;
mod state;
mod tokens;
mod union;

use crate::config::{Config, Unit};
use crate::error::Result;
use crate::report::Report;
use crate::sink::{NoMesh, Sink};
use crate::trace::command::Command;
use rtl_model::counter::standard::{Stage, Work};
use rtl_model::counter::{Block, Counters};

pub use clock::Recording;
pub use frame::FrameState;

use clock::{Recorded, Tokens};
use hybrid::Hybrid;
use moreton::Moreton;
use pipeline::Front;
use run::Run;
use sfarti::Sfarti;

/// Carries out the commands of a trace on the configured unit, in the current rayon pool; any
/// number of threads gives the same bytes.
///
/// # Errors
/// The first error of the commands, the sink or the configuration; a frame whose far plane is
/// infinite needs a range.
///
/// # Panics
/// When commands break what a reader of traces guarantees: a draw before any frame, of an unknown
/// id, or of more points than there are.
pub fn simulate(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    sink: &mut dyn Sink,
) -> Result<Report> {
    config.check()?;
    match config.unit {
        Unit::Hybrid | Unit::Triangles => carry_out(Run::<Hybrid>::new(config, sink), commands),
        Unit::Sfarti => carry_out(Run::<Sfarti>::new(config, sink), commands),
        Unit::Moreton => carry_out(Run::<Moreton>::new(config, sink), commands),
    }
}

fn carry_out<F: Front>(
    mut run: Run<'_, F>,
    commands: impl Iterator<Item = Result<Command>>,
) -> Result<Report> {
    for command in commands {
        run.command(&command?)?;
    }
    run.finish()
}

/// Carries out the commands without an engine, and keeps what an engine would be given.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// As [`simulate`].
pub fn record(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
) -> Result<Recording> {
    config.check()?;
    Ok(Recording(match config.unit {
        Unit::Hybrid | Unit::Triangles => {
            Recorded::Fractional(recorded::<Hybrid>(commands, config)?)
        }
        Unit::Sfarti => Recorded::Dyadic(recorded::<Sfarti>(commands, config)?),
        Unit::Moreton => Recorded::Fractional(recorded::<Moreton>(commands, config)?),
    }))
}

fn recorded<F: Front>(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
) -> Result<Tokens<F::Lists>> {
    let mut sink = NoMesh;
    let mut run = Run::<F>::recording(config, &mut sink);
    for command in commands {
        run.command(&command?)?;
    }
    run.finish_recording()
}

/// The blocks of a unit, in the order of the data.
#[must_use]
pub fn blocks(unit: Unit) -> &'static [Block] {
    match unit {
        Unit::Hybrid | Unit::Sfarti => &[
            Block::Trace,
            Block::Link,
            Block::Memory,
            Block::Transform,
            Block::Port,
            Block::Assemble,
            Block::Clip,
            Block::Backface,
            Block::Level,
            Block::Place,
            Block::Evaluate,
            Block::Stitch,
            Block::Emit,
            Block::VertexShader,
        ],
        Unit::Moreton => &[
            Block::Trace,
            Block::Link,
            Block::Memory,
            Block::Port,
            Block::Assemble,
            Block::Place,
            Block::Evaluate,
            Block::Stitch,
            Block::Emit,
            Block::VertexShader,
        ],
        Unit::Triangles => &[Block::Trace, Block::Link, Block::Emit, Block::VertexShader],
    }
}

/// The blocks of the configured unit that time is laid over, in the order of the data.
#[must_use]
pub fn chain(config: &Config) -> Vec<Stage> {
    let blocks = chain::blocks(config.unit).iter();
    // Shapes do not depend on what flows.
    let stages = chain::stages::<rtl_model::place::Segments>(config).into_iter();
    blocks.zip(stages).map(|(&block, (_, shape))| Stage { block, shape }).collect()
}

/// What each block of the chain did in a frame with these counters, in which the host sent so many
/// tokens.
fn work(chain: &[Stage], counters: &Counters, sent: u64, config: &Config) -> Vec<Work> {
    let of = |stage: &Stage| {
        let [tokens_in, tokens_out] = tokens::of(config.unit, stage.block, counters, sent);
        let ops = arithmetic::of(stage.block, counters, config);
        Work { tokens_in, tokens_out, ops }
    };
    chain.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_timed_chain_is_of_the_units_blocks_in_their_order() {
        for unit in Unit::ALL {
            let config = Config { unit, ..Config::default() };
            let chain: Vec<_> = chain(&config).iter().map(|stage| stage.block).collect();
            let blocks = blocks(unit).iter().copied().filter(|block| chain.contains(block));
            assert_eq!(blocks.collect::<Vec<_>>(), chain);
            assert!(chain.len() >= 2);
        }
    }
}
