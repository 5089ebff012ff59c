//! Precision: how many bits the datapath of a unit needs. A trace and a grid of formats come in,
//! what each point of the grid does to the picture comes out, measured against f64.
//!
//! ```text
//!   commands ─► reference   once: true surfaces, f64's culls and lists, edges that patches share
//!        │          │
//!        └─► unit ─► meter ─► a row for each point of the grid ─► tables, CSV, plots
//!                                     search: the narrowest formats, without the whole grid
//! ```
//!
//! A position is compared with the true surface in two ways: at the parameters that the unit
//! reports for the vertex, which is what its evaluator and divide add, and at the exact parameter
//! k / level of the unit's own level, which is where the vertex was to be: reciprocal and parameter
//! count too. True surfaces are f64 from the trace's numbers on, so that the f32 of the
//! control-point shader is part of every error.
//!
//! `evaluators` compares the evaluators by themselves, without a unit around them.

pub mod evaluators;
mod formats;
mod meter;
mod pareto;
mod picture;
mod reference;
mod seam;
pub mod search;
mod summary;
mod table;

use crate::config::{Config, Engine, Union, Unit};
use crate::error::{Error, Result};
use crate::trace::command::Command;
use crate::unit::simulate;
use rayon::prelude::*;
use rtl_model::counter::Counter;

pub use formats::{Axes, Formats, Widths, overflow_name, rounding_name};
pub use meter::{Measured, PositionError};
pub use picture::{svg_of_evaluators, svg_of_widths};
pub use summary::summary;
pub use table::{CSV_HEADER, csv, text};

use meter::Meter;
use reference::Reference;

/// Most points of a grid.
pub const POINTS_MAX: usize = 65_536;

/// How much is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The grid.
    pub axes: Axes,
    /// The largest position error of formats that serve, in pixels.
    pub max_error: f64,
    /// Segments between the samples of a patch, along each direction, at which the distance of the
    /// true surface from the triangles is taken; 0: it is not.
    pub segments: u32,
    /// Only what it takes to find the narrowest formats, and not the whole grid.
    pub search: bool,
}

/// A point of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its formats.
    pub formats: Formats,
    /// The widths of its signals.
    pub widths: Widths,
    /// The area estimate in full-adder cells.
    pub area: u64,
    /// What came of it.
    pub measured: Measured,
}

/// What the study found.
#[derive(Clone, Debug)]
pub struct Study {
    /// The unit and everything that is not swept.
    pub base: Config,
    /// The largest position error of formats that serve, in pixels.
    pub max_error: f64,
    /// Points of the grid.
    pub grid: usize,
    /// What was measured, in the order of the grid.
    pub rows: Vec<Row>,
    /// Which of the rows has the narrowest formats, if any serves.
    pub narrowest: Option<usize>,
    /// Which rows no other is as good as in all of bits, area and error, by bits.
    pub front: Vec<usize>,
    /// Runs of the corners alone, by which a search rules out formats.
    pub corner_runs: usize,
}

impl Row {
    /// What formats are chosen by: area, then bits.
    #[must_use]
    pub fn cost(&self) -> (u64, u32) {
        (self.area, self.widths.datapath())
    }
}

/// Carries out the study in the current rayon pool: any number of threads gives the same result.
/// `each` is told of every point that is through.
///
/// # Errors
/// [`Error::Usage`] for a unit that it does not fit, for formats that hardware could not be built
/// with, and for more than [`POINTS_MAX`] points; those of the trace.
pub fn run(
    commands: &[Command],
    base: &Config,
    options: &Options,
    each: &(dyn Fn() + Sync),
) -> Result<Study> {
    let base = checked(base)?;
    let grid = options.axes.grid(&base)?;
    let reference = Reference::of(commands, &base)?;
    if reference.patches() == 0 {
        return Err(Error::Usage("the trace draws nothing: expected patches to measure".into()));
    }
    let bench = Bench { commands, base: &base, reference: &reference };
    let measure = |formats: &Formats| -> Result<Row> {
        let measured = bench.measure(&formats.config(&base), options.segments)?;
        each();
        Ok(bench.row(formats, measured))
    };
    let (rows, corner_runs) = if options.search {
        let found = search::narrowest(&grid, &bench, options.max_error, &measure)?;
        (found.rows, found.corner_runs)
    } else {
        (grid.par_iter().map(measure).collect::<Result<Vec<_>>>()?, 0)
    };
    let narrowest = search::exhaustive(&rows, options.max_error);
    let front = pareto::front(&rows);
    let (grid, max_error) = (grid.len(), options.max_error);
    Ok(Study { base, max_error, grid, rows, narrowest, front, corner_runs })
}

/// The configuration without what would measure something else.
fn checked(base: &Config) -> Result<Config> {
    let name = base.unit.name();
    if !matches!(base.unit, Unit::Hybrid | Unit::Sfarti) {
        return Err(Error::Usage(format!(
            "precision: found unit {name}, expected hybrid or sfarti, whose points are fixed-point \
             clip coordinates of a true surface"
        )));
    }
    if base.union() != Union::Off {
        return Err(Error::Usage(
            "level.union: found primitive, expected off: precision compares each patch's own lists"
                .into(),
        ));
    }
    if !base.emit.divide {
        return Err(Error::Usage(
            "emit.divide: found false, expected true: errors are measured on the screen".into(),
        ));
    }
    base.check()?;
    Ok(Config { engine: Engine::None, ..base.clone() })
}

/// What every point of a grid is measured against.
struct Bench<'a> {
    commands: &'a [Command],
    base: &'a Config,
    reference: &'a Reference,
}

impl Bench<'_> {
    fn measure(&self, config: &Config, segments: u32) -> Result<Measured> {
        let mut meter = Meter::new(config, self.reference, segments);
        let report = simulate(self.commands.iter().cloned().map(Ok), config, &mut meter)?;
        let mut measured = meter.finish();
        measured.saturated = report.total(Counter::PortSaturated);
        measured.evaluate_overflows = report.total(Counter::EvaluateOverflows);
        measured.level_overflows = report.total(Counter::LevelOverflows);
        measured.equal_corners = report.total(Counter::StitchDegenerate);
        measured.to_clipper = report.total(Counter::EmitToClipper);
        Ok(measured)
    }

    fn row(&self, formats: &Formats, measured: Measured) -> Row {
        let config = formats.config(self.base);
        let widths = Widths::of(&config);
        Row { formats: *formats, widths, area: formats::area(&config), measured }
    }
}
