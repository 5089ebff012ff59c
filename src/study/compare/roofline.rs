//! Roofline: a trace's first frame at every level from 1 to 64; what binds each unit there.
//!
//! Each block alone would take the cycles that its tokens occupy it; the unit cannot be faster than
//! the slowest of them, its roof. The elapsed cycles are what it comes to with all of them in a
//! row. Unit `esc` has the level of resolution with the fewest segments, 3 (L + 1), that are not
//! fewer than the level, so nothing above 48.

use crate::config::{Config, Criterion, Engine, FactorPolicy, Residency, Unit};
use crate::error::Result;
use crate::output::table::{Bound, bound};
use crate::sink::NoMesh;
use crate::study::esc;
use crate::study::plot::{self, Chart, Names, Series};
use crate::trace::command::Command;
use crate::trace::replay::Replay;
use crate::unit::simulate;
use rayon::prelude::*;
use rtl_model::counter::{Block, Counter};
use std::fmt::Write;

/// The greatest level.
pub const LEVEL_MAX: u32 = 64;

/// The columns of `roofline.csv`: a line a block. `cycles` are those that its tokens occupy it,
/// `binds` is 1 where it is what binds the unit.
pub const CSV_HEADER: [&str; 7] =
    ["unit", "level", "triangles", "elapsed", "block", "cycles", "binds"];

/// A unit at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The unit.
    pub unit: Unit,
    /// Segments on every edge.
    pub level: u32,
    /// Triangles made.
    pub triangles: u64,
    /// Elapsed cycles.
    pub elapsed: u64,
    /// For each block of the chain how long its tokens alone occupy it, in cycles.
    pub demands: Vec<(Block, u64)>,
    /// What binds; `None` where nothing ran.
    pub bound: Option<Bound>,
}

impl Row {
    fn triangles_a_cycle(&self) -> f64 {
        self.triangles as f64 / self.elapsed.max(1) as f64
    }

    /// The block that binds, or that latency does.
    fn binds(&self) -> &'static str {
        match self.bound {
            None => "nothing",
            Some(bound) if bound.binds => bound.block.name(),
            Some(_) => "latency",
        }
    }
}

/// Carries it out in the current rayon pool, for each of `configs` in order and each level.
///
/// # Errors
/// Those of the trace and of [`simulate`].
pub fn run(trace: &mut Replay, configs: &[Config]) -> Result<Vec<Row>> {
    let commands = first_frame(trace)?;
    let levels = configs.iter().flat_map(|config| (1..=LEVEL_MAX).map(move |l| (config, l)));
    let points: Vec<(Config, u32)> =
        levels.filter_map(|(config, level)| Some((at(config, level)?, level))).collect();
    let rows = points.par_iter().map(|(config, level)| row(&commands, config, *level));
    rows.collect()
}

/// The commands of the trace until its second frame begins.
fn first_frame(trace: &mut Replay) -> Result<Vec<Command>> {
    let mut commands = Vec::new();
    let mut frames = 0;
    for located in trace.reader()? {
        let command = located?.command;
        frames += u32::from(matches!(command, Command::Frame(_)));
        if frames > 1 {
            break;
        }
        commands.push(command);
    }
    Ok(commands)
}

/// The configuration at a level; `None` where the unit does not reach it.
fn at(config: &Config, level: u32) -> Option<Config> {
    let mut config = config.clone();
    if config.engine == Engine::None {
        config.engine = Engine::Timed;
    }
    config.level.criterion = Some(Criterion::Fixed);
    (config.level.level, config.level.pixels) = (Some(level.into()), None);
    (config.level.min_level, config.level.max_level) = (Some(1.0), Some(128.0));
    config.hull.policy = FactorPolicy::Criterion;
    if config.unit == Unit::Triangles && config.triangles.resides() {
        // A mesh of every level is there, and takes no power of two.
        (config.triangles.residency, config.triangles.level) = (Residency::Static, level);
    }
    if config.unit == Unit::Esc {
        let resolution = level.div_ceil(3) - 1;
        esc::fix_level(&mut config, resolution);
        return (resolution <= esc::work::LEVEL_MAX).then_some(config);
    }
    Some(config)
}

fn row(commands: &[Command], config: &Config, level: u32) -> Result<Row> {
    let report = simulate(commands.iter().cloned().map(Ok), config, &mut NoMesh)?;
    let whole = report.whole();
    let times = whole.times.iter().flat_map(|times| &times.stages);
    let demands = report
        .chain
        .iter()
        .zip(times)
        .map(|(stage, times)| (stage.block, times.used.div_ceil(u64::from(stage.shape.lanes))));
    Ok(Row {
        unit: config.unit,
        level,
        triangles: whole.counters.get(Counter::EmitTriangles),
        elapsed: whole.times.as_ref().map_or(0, |times| times.elapsed),
        demands: demands.collect(),
        bound: bound(&report, &whole),
    })
}

/// `roofline.csv`.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for Row { unit, level, triangles, elapsed, demands, bound } in rows {
        for (block, cycles) in demands {
            let binds = u8::from(bound.is_some_and(|b| b.binds && b.block == *block));
            let (unit, block) = (unit.name(), block.name());
            writeln!(text, "{unit},{level},{triangles},{elapsed},{block},{cycles},{binds}")
                .expect("a String takes everything");
        }
    }
    text
}

/// The table for people: which levels what binds, and triangles a cycle at the first and the last.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "roofline: the first frame at fixed levels; what binds, and triangles a cycle there\n",
    );
    let same = |a: &Row, b: &Row| (a.unit, a.binds()) == (b.unit, b.binds());
    let mut before = None;
    for span in rows.chunk_by(same) {
        let (first, last) = (&span[0], &span[span.len() - 1]);
        let unit = if before == Some(first.unit) { "" } else { first.unit.name() };
        before = Some(first.unit);
        let levels = format!("{}..{}", first.level, last.level);
        let rates = [first, last].map(Row::triangles_a_cycle);
        let what = first.binds();
        writeln!(text, "  {unit:10}{levels:>8}  {what:14}{:7.3} ..{:7.3}", rates[0], rates[1])
            .expect("a String takes everything");
    }
    text
}

/// Triangles a cycle over the level, a line a unit.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg(rows: &[Row]) -> Result<String> {
    let series = rows.chunk_by(|a, b| a.unit == b.unit).map(|rows| Series {
        name: rows[0].unit.name().to_owned(),
        points: rows.iter().map(|row| (row.level.into(), row.triangles_a_cycle())).collect(),
    });
    plot::svg(&Chart {
        file: "roofline.svg",
        title: "Triangles a cycle at fixed levels, first frame",
        x: "segments on every edge",
        y: "triangles a cycle",
        ticks: Vec::new(),
        log: false,
        names: Names::Above,
        series: series.collect(),
        levels: Vec::new(),
        marks: Vec::new(),
    })
}
