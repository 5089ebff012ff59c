//! Compare: one trace through several units, everything else the same, and their numbers side by
//! side.
//!
//! In come a trace and a configuration a unit; out come their reports, in order, with what their
//! triangles look like on the screen (`gauge`); from them every number over the run and in each
//! frame (`series`), a table for people, with ratios to the first unit, and CSVs. `roofline`
//! asks what binds each unit at each level. The units run one after another: a run's engine is
//! sequential anyway, and memory stays that of one run.
//!
//! Nothing is said of textures and of the frame buffer: their traffic is that of the pixels, which
//! all units share.

mod cell;
mod column;
mod csv;
mod gauge;
mod lines;
pub mod roofline;
mod series;
mod table;

use crate::config::{Config, Unit};
use crate::error::{Error, Result, nearest};
use crate::report::Report;
use crate::trace::command::{Command, Header};
use crate::trace::open::Trace;
use crate::trace::replay::Replay;
use crate::unit::simulate;
use gauge::{Gauge, Scenes};
use std::cell::RefCell;
use std::io;

pub use csv::{CSV_HEADER, FRAMES_HEADER, csv, frames};
pub use gauge::Seen;
pub use series::{Number, Series, Value, series};
pub use table::text;

/// What stands for every unit.
pub const ALL: &str = "all";

/// The same trace through several units.
pub struct Comparison {
    /// What the trace says of itself.
    pub header: Header,
    /// A run a unit.
    pub runs: Vec<Run>,
    /// A reader that is through with the trace: its hash and its files.
    pub reader: Trace,
}

/// A run of a unit.
#[derive(Clone, Debug)]
pub struct Run {
    /// What it reports.
    pub report: Report,
    /// What its triangles look like, frame by frame.
    pub seen: Vec<Seen>,
}

/// The units of a list of names with commas between them, or of [`ALL`].
///
/// # Errors
/// [`Error::Usage`] for a name that no unit has, with the nearest one, and for a unit named twice.
pub fn units(names: &str) -> Result<Vec<Unit>> {
    if names == ALL {
        return Ok(Unit::ALL.to_vec());
    }
    let mut units = Vec::new();
    for name in names.split(',') {
        let Some(unit) = Unit::ALL.into_iter().find(|unit| unit.name() == name) else {
            return Err(Error::Usage(unknown(name)));
        };
        if units.contains(&unit) {
            return Err(Error::Usage(format!("--units {names}: found {name} twice")));
        }
        units.push(unit);
    }
    Ok(units)
}

fn unknown(name: &str) -> String {
    let known = Unit::ALL.map(Unit::name);
    let nearest = nearest(name, known.into_iter().chain([ALL])).unwrap_or(ALL);
    let name: String = name.chars().take(200).collect();
    let known = known.join(", ");
    format!("--units: unknown unit `{name}`; did you mean `{nearest}`? (units: {known}, or {ALL})")
}

/// Runs the trace once for each of `configs`, at least one, in the current rayon pool. The surface
/// of each tessellated patch is sampled at `samples` by `samples` points for its error. `watch`
/// sees each command before its unit does.
///
/// # Errors
/// Those of the trace and of [`simulate`]; [`Error::System`] for a trace that has changed between
/// two units.
///
/// # Panics
/// When there is no configuration.
pub fn run(
    trace: &mut Replay,
    configs: &[Config],
    samples: u32,
    mut watch: impl FnMut(Unit, &Command),
) -> Result<Comparison> {
    let mut header = Header::default();
    let mut runs = Vec::with_capacity(configs.len());
    let mut last: Option<Trace> = None;
    for config in configs {
        let mut reader = trace.reader()?;
        let commands = reader.by_ref().map(|located| {
            let command = located?.command;
            watch(config.unit, &command);
            if let Command::Header(found) = &command {
                header = found.clone();
            }
            Ok(command)
        });
        runs.push(one(commands, config, samples)?);
        if last.is_some_and(|before| before.hash() != reader.hash()) {
            let changed = io::Error::other("it changed while its units were compared");
            return Err(Error::system(trace.path(), changed));
        }
        last = Some(reader);
    }
    let reader = last.expect("there is something to compare");
    Ok(Comparison { header, runs, reader })
}

/// One unit's.
fn one(
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
    samples: u32,
) -> Result<Run> {
    let scenes = RefCell::new(Scenes::new(config, samples > 0));
    let commands = commands.map(|command| {
        let command = command?;
        scenes.borrow_mut().command(&command)?;
        Ok(command)
    });
    let mut gauge = Gauge::new(config, &scenes, samples);
    let report = simulate(commands, config, &mut gauge)?;
    Ok(Run { report, seen: gauge.finish() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::timed_report;
    use rtl_model::counter::{Block, Counter};

    /// A made-up pair: the second has no blocks but link and emit.
    pub(super) fn pair() -> [Run; 2] {
        let mut first = timed_report();
        first.blocks = &[Block::Trace, Block::Link, Block::Memory, Block::Evaluate, Block::Emit];
        let mut second = first.clone();
        second.config = Config { unit: Unit::Triangles, ..second.config };
        second.blocks = &[Block::Trace, Block::Link, Block::Emit];
        for (report, factor) in [(&mut first, 1), (&mut second, 3)] {
            let counters = &mut report.frames[0].counters;
            counters.add(Counter::TracePatches, 2);
            counters.add(Counter::LinkControlPoints, 500 * (3 - factor));
            counters.add(Counter::LinkTotal, 1000 * factor);
            counters.add(Counter::EvaluateInvocations, 9);
            counters.add(Counter::MemoryReadControlPoints, 30);
            counters.add(Counter::MemoryReadAttributes, 7);
        }
        [first, second].map(|report| {
            let seen = vec![Seen::default(); report.frames.len()];
            Run { report, seen }
        })
    }

    #[test]
    fn lists_of_units_are_in_order_and_unknown_ones_are_told_the_nearest() {
        assert_eq!(units("sfarti,hybrid").unwrap(), [Unit::Sfarti, Unit::Hybrid]);
        assert_eq!(units("all").unwrap(), Unit::ALL);
        for (names, says) in [
            ("hybrid,triangle", "`triangle`; did you mean `triangles`?"),
            ("sfratis", "did you mean `sfarti`?"),
            ("al", "did you mean `all`?"),
            ("", "unknown unit ``"),
            ("hybrid,", "unknown unit ``"),
            ("hybrid,sfarti,hybrid", "found hybrid twice"),
        ] {
            let error = units(names).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}
