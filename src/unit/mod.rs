//! The units under study: which blocks, wired how, which defaults.
//!
//! Commands come in, triangles stream into a sink, counters come out. `run` carries out the
//! commands, `frame` derives what is constant over a frame, `draw` and `fetch` say where a draw's
//! patches get their points, `batch` collects patches and spreads them over the threads, `pipeline`
//! takes one patch through the blocks: through lists of parameters (`surface`), of which `hybrid`,
//! `sfarti` and `moreton` each have their own, or through the shaders of `d3d11` or `esc`. `union`
//! holds the lists that patches of a primitive share, `edges` what it keeps of their edges; `host`
//! says what a host that tessellates sends and a device reads, `resident` which meshes are there;
//! `wave` gathers patches that a surface shader makes side by side; `chain` and `clock` put it all
//! on the clock, of which `timeline` records what happened when; `tokens` and `arithmetic` say from
//! a frame's counters what flowed and what it took.

pub mod arithmetic;
mod attributes;
mod batch;
mod chain;
mod clock;
mod d3d11;
mod draw;
mod edges;
mod esc;
mod fetch;
mod frame;
mod host;
mod hybrid;
mod moreton;
pub mod pattern;
mod pipeline;
mod resident;
mod run;
mod sfarti;
pub mod state;
mod surface;
mod timeline;
mod tokens;
mod union;
mod wave;

use crate::config::{Config, Engine, Unit};
use crate::error::{Error, Result};
use crate::report::timeline::{Timeline, Wanted};
use crate::report::{Report, no_such_frame};
use crate::sink::{NoMesh, Sink};
use crate::trace::command::Command;
use rtl_model::counter::standard::{Stage, Work};
use rtl_model::counter::{Block, Counters};

pub use clock::Recording;
pub use frame::FrameState;

use clock::{Recorded, Tokens};
use d3d11::D3d11;
use esc::Esc;
use hybrid::Hybrid;
use moreton::Moreton;
use pipeline::Make;
use run::Run;
use sfarti::Sfarti;
use surface::Surface;
use timeline::Recorder;

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
    Ok(on_the_unit(commands, config, sink, None)?.0)
}

/// As [`simulate`], and what happened when in the wanted part of the run. The report is the same.
///
/// # Errors
/// As [`simulate`]; [`Error::Usage`] without an engine, when the trace has no such frame or the
/// frame no such part, and when the part is larger than can be kept.
///
/// # Panics
/// As [`simulate`].
pub fn simulate_watched(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    sink: &mut dyn Sink,
    wanted: &Wanted,
) -> Result<(Report, Timeline)> {
    config.check()?;
    if config.engine == Engine::None {
        let message = "a timeline needs an engine: found none, expected timed or stepped";
        return Err(Error::Usage(message.to_owned()));
    }
    let (report, recorder) = on_the_unit(commands, config, sink, Some(wanted))?;
    let recorder = recorder.ok_or_else(|| no_such_frame(wanted.frame, report.frames.len()))?;
    let timeline = recorder.into_timeline(&report)?;
    Ok((report, timeline))
}

fn on_the_unit(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    sink: &mut dyn Sink,
    wanted: Option<&Wanted>,
) -> Result<(Report, Option<Recorder>)> {
    match config.unit {
        Unit::Hybrid | Unit::Triangles => {
            carry_out::<Surface<Hybrid>>(commands, config, sink, wanted)
        }
        Unit::Sfarti => carry_out::<Surface<Sfarti>>(commands, config, sink, wanted),
        Unit::Moreton => carry_out::<Surface<Moreton>>(commands, config, sink, wanted),
        Unit::D3d11 => carry_out::<D3d11>(commands, config, sink, wanted),
        Unit::Esc => carry_out::<Esc>(commands, config, sink, wanted),
    }
}

fn carry_out<M: Make>(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    sink: &mut dyn Sink,
    wanted: Option<&Wanted>,
) -> Result<(Report, Option<Recorder>)> {
    let mut run = match wanted {
        None => Run::<M>::new(config, sink),
        Some(wanted) => Run::<M>::watched(config, sink, wanted),
    };
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
            Recorded::Fractional(recorded::<Surface<Hybrid>>(commands, config)?)
        }
        Unit::Sfarti => Recorded::Dyadic(recorded::<Surface<Sfarti>>(commands, config)?),
        Unit::Moreton => Recorded::Fractional(recorded::<Surface<Moreton>>(commands, config)?),
        Unit::D3d11 => Recorded::D3d11(recorded::<D3d11>(commands, config)?),
        Unit::Esc => Recorded::Esc(recorded::<Esc>(commands, config)?),
    }))
}

fn recorded<M: Make>(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
) -> Result<Tokens<M::Lists>> {
    let mut sink = NoMesh;
    let mut run = Run::<M>::recording(config, &mut sink);
    for command in commands {
        run.command(&command?)?;
    }
    run.finish_recording()
}

/// The blocks of the configured unit, in the order of the data.
#[must_use]
pub fn blocks(config: &Config) -> &'static [Block] {
    match config.unit {
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
        Unit::D3d11 => &[
            Block::Trace,
            Block::Link,
            Block::Memory,
            Block::Assemble,
            Block::Hull,
            Block::Clip,
            Block::Backface,
            Block::Level,
            Block::Factors,
            Block::Points,
            Block::Connect,
            Block::Domain,
            Block::Emit,
        ],
        Unit::Esc => &[
            Block::Trace,
            Block::Link,
            Block::Memory,
            Block::Transform,
            Block::Port,
            Block::Assemble,
            Block::Clip,
            Block::Backface,
            Block::Level,
            Block::Group,
            Block::Surface,
            Block::Emit,
        ],
        Unit::Triangles if config.triangles.uses_memory() => &[
            Block::Trace,
            Block::Link,
            Block::Memory,
            Block::Emit,
            Block::VertexCache,
            Block::VertexShader,
        ],
        Unit::Triangles => {
            &[Block::Trace, Block::Link, Block::Emit, Block::VertexCache, Block::VertexShader]
        }
    }
}

/// The blocks of the configured unit that time is laid over, in the order of the data.
#[must_use]
pub fn chain(config: &Config) -> Vec<Stage> {
    chain::shapes(config).map(|(block, shape)| Stage { block, shape }).collect()
}

/// What each block of the chain did in a frame with these counters, in which the host sent so many
/// tokens.
fn work(chain: &[Stage], counters: &Counters, sent: u64, config: &Config) -> Vec<Work> {
    let of = |stage: &Stage| {
        let [tokens_in, tokens_out] = tokens::of(config, stage.block, counters, sent);
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
        let mut configs = Unit::ALL.map(|unit| Config { unit, ..Config::default() }).to_vec();
        configs.push(Config { unit: Unit::Triangles, ..Config::default() });
        configs.last_mut().unwrap().triangles.residency = crate::config::Residency::Static;
        for config in configs {
            let chain: Vec<_> = chain(&config).iter().map(|stage| stage.block).collect();
            let blocks = blocks(&config).iter().copied().filter(|block| chain.contains(block));
            assert_eq!(blocks.collect::<Vec<_>>(), chain);
            assert!(chain.len() >= 2);
        }
    }
}
