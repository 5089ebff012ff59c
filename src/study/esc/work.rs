//! Work: what Concheiro et al. 2014 say of memory accesses, invocations, power and speed (sections
//! 2.2, 4.2 and 5), measured: ESC against a domain shader, triangle counts equal, L = 1 to 15.
//!
//! Teacups come in, every patch with the uniform pattern of 18 (L + 1)^2 triangles: ESC's own, and
//! from `d3d11` the grid of 3 (L + 1) segments. Out come invocations of shaders, control points
//! that evaluation reads, operations with their energy, and cycles: those that the shader
//! processors are occupied, by their programs' lengths ([`program`]) alone, and those of the whole
//! unit with one processor and with as many as the machine has. The two differ where something else
//! is the bottleneck: `emit` and the fixed-function tessellator give a triangle a cycle, however
//! many processors there are.

pub mod program;
mod table;

use super::scene::Scene;
use super::{all_patches, plot, some, uniform};
use crate::config::{Config, Criterion, DomainKind, Engine, Form, Partitioning, Reuse, Unit};
use crate::error::Result;
use crate::report::Report;
use crate::sink::NoMesh;
use crate::study::energy::{self, Prices};
use crate::trace::command::Command;
use crate::unit::simulate;
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C};

pub use table::{CSV_HEADER, csv, svg, text};

/// How much faster the paper's Figure 9 has ESC at the most: name of the machine, times.
pub const PAPER: [(&str, f64); 2] = [("HD 6970", 2.05), ("HD 5870", 2.25)];

/// Greatest level.
pub const LEVEL_MAX: u32 = 15;

/// How much is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Teacups, 26 patches each.
    pub cups: u32,
    /// Least and greatest level, 0..=[`LEVEL_MAX`].
    pub levels: [u32; 2],
    /// Numbers of shader processors, of 16 lanes each, on which the units are timed.
    pub processors: Vec<u32>,
    /// What energy costs.
    pub prices: Prices,
}

/// A way to evaluate a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// ESC, with points that serve so far.
    Esc(Reuse),
    /// ESC as a geometry shader of 2014: at most 1024 values of 32 bits an invocation.
    EscLimited,
    /// A domain shader.
    D3d11(DomainKind),
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Esc(Reuse::Patch),
        Self::Esc(Reuse::CoarseTriangle),
        Self::Esc(Reuse::None),
        Self::EscLimited,
        Self::D3d11(DomainKind::Naive),
        Self::D3d11(DomainKind::Basis),
    ];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Esc(Reuse::Patch) => "esc, reuse patch",
            Self::Esc(Reuse::CoarseTriangle) => "esc, reuse triangle",
            Self::Esc(Reuse::None) => "esc, no reuse",
            Self::EscLimited => "esc, 1024 values",
            Self::D3d11(DomainKind::Naive) => "d3d11, naive",
            Self::D3d11(DomainKind::Basis) => "d3d11, basis",
        }
    }

    /// Whether a surface shader does it.
    #[must_use]
    pub const fn is_esc(self) -> bool {
        !matches!(self, Self::D3d11(_))
    }

    fn config(self, base: &Config, level: u32) -> Config {
        let mut config = match self {
            Self::Esc(_) | Self::EscLimited => uniform(base, level),
            Self::D3d11(_) => all_patches(base, Unit::D3d11),
        };
        match self {
            Self::Esc(reuse) => (config.esc.reuse, config.esc.output_values) = (reuse, None),
            Self::EscLimited => {
                (config.esc.reuse, config.esc.output_values) = (Reuse::Patch, Some(1024));
            }
            Self::D3d11(shader) => {
                config.tessellator.partitioning = Partitioning::Integer;
                config.level.criterion = Some(Criterion::Fixed);
                config.level.level = Some(f64::from(3 * (level + 1)));
                config.domain.shader = shader;
                config.domain.form = Some(match shader {
                    DomainKind::Naive => Form::Power,
                    DomainKind::Basis => Form::Paired,
                });
                config.domain.cache_entries = None;
            }
        }
        config
    }
}

/// Energy in picojoules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of operations, by the widths that each block has.
    pub operations: f64,
    /// Of as many operations, were all of them on singles.
    pub in_singles: f64,
    /// Of what shaders read and write on the chip.
    pub chip: f64,
    /// Of device memory.
    pub memory: f64,
    /// Of invocations.
    pub invocations: f64,
}

impl Energy {
    /// Of the chip, with operations as they are built.
    #[must_use]
    pub fn on_chip(&self) -> f64 {
        self.operations + self.chip + self.invocations
    }

    /// All of it.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.on_chip() + self.memory
    }
}

/// A way at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The way.
    pub way: Way,
    /// The level.
    pub level: u32,
    /// Patches.
    pub patches: u64,
    /// Triangles.
    pub triangles: u64,
    /// Invocations of all shaders, control-point threads included.
    pub invocations: u64,
    /// Of these, those that evaluate: of a surface or of a point.
    pub evaluating: u64,
    /// Control points that these read.
    pub control_points: u64,
    /// Points of the surface evaluated.
    pub evaluations: u64,
    /// Vertices that leave.
    pub vertices: u64,
    /// Operations of all blocks.
    pub ops: Ops,
    /// Bytes that shaders read and write on the chip.
    pub chip_bytes: u64,
    /// Bytes of device memory's bursts.
    pub memory_bytes: u64,
    /// What that costs.
    pub energy: Energy,
    /// Cycles that one processor would be occupied by evaluation, by the programs' lengths.
    pub shader_cycles: u64,
    /// Elapsed cycles with each number of processors that was asked for.
    pub elapsed: Vec<u64>,
}

/// Carries out the study in the current rayon pool; `base` has the formats and the machine.
///
/// # Errors
/// Those of the configuration.
pub fn run(options: &Options, base: &Config) -> Result<Vec<Row>> {
    some("processors", &options.processors)?;
    let commands = Scene::Teacups(options.cups).commands(1)?;
    let mut rows = Vec::new();
    for level in options.levels[0]..=options.levels[1] {
        for way in Way::ALL {
            rows.push(row(way, level, &commands, options, base)?);
        }
    }
    Ok(rows)
}

fn row(
    way: Way,
    level: u32,
    commands: &[Command],
    options: &Options,
    base: &Config,
) -> Result<Row> {
    let mut elapsed = Vec::new();
    let mut last = None;
    for &processors in &options.processors {
        let mut config = way.config(base, level);
        program::equal_cores(&mut config, processors);
        config.engine = Engine::Timed;
        let report = simulate(commands.iter().cloned().map(Ok), &config, &mut NoMesh)?;
        let times = report.whole().times.expect("it was timed");
        elapsed.push(times.elapsed);
        last = Some((config, report));
    }
    let (config, report) = last.expect("there is at least one number of processors");
    Ok(of_report(way, level, &config, &report, &options.prices, elapsed))
}

fn of_report(
    way: Way,
    level: u32,
    config: &Config,
    report: &Report,
    prices: &Prices,
    elapsed: Vec<u64>,
) -> Row {
    let totals = report.totals();
    let get = |counter| totals.get(counter);
    let memory_bytes = get(C::MemoryBursts) * u64::from(config.memory.burst);
    let (evaluating, control_points, evaluations, shader_cycles) = if way.is_esc() {
        let cycles = get(C::SurfaceLaneCycles) / u64::from(config.esc.width);
        (
            get(C::SurfaceInvocations),
            get(C::SurfaceControlPoints),
            get(C::SurfaceEvaluations),
            cycles,
        )
    } else {
        let interval = config.costs(Block::Domain).map_or(0, |costs| costs.interval);
        let points = get(C::DomainInvocations);
        let cycles = get(C::DomainWaves) * u64::from(interval);
        (points, get(C::DomainBytesControlPoints) / 16, points, cycles)
    };
    let before = [C::TransformInvocations, C::HullThreads, C::HullInvocations];
    let invocations = before.into_iter().map(get).sum::<u64>() + evaluating;
    let chip_bytes = energy::chip_bytes(&totals);
    let (ops, operations, in_singles) = energy::operations(report, &report.whole(), prices);
    Row {
        way,
        level,
        patches: get(C::TracePatches),
        triangles: get(C::EmitTriangles),
        invocations,
        evaluating,
        control_points,
        evaluations,
        vertices: get(C::EmitVertices),
        ops,
        chip_bytes,
        memory_bytes,
        energy: Energy {
            operations,
            in_singles,
            chip: chip_bytes as f64 * prices.chip_byte,
            memory: memory_bytes as f64 * prices.memory_byte,
            invocations: invocations as f64 * prices.invocation,
        },
        shader_cycles,
        elapsed,
    }
}

#[cfg(test)]
mod tests;
