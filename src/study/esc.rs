//! Esc: the tables and claims of Concheiro et al. 2014, section 4, measured again.
//!
//! ```text
//!   triangles   Table 1: triangles of two scenes, uniform and adaptive, as a function of mu
//!   error       Figure 7: the distance from the true surface at equal triangle counts
//!   work        sections 2.2, 4.2 and 5: invocations, reads, operations, energy, cycles
//! ```
//!
//! Scenes, models and configurations come in; out come rows of integers, a table for people and a
//! picture. All runs are of the units themselves, of which nothing is clipped or culled: the
//! paper's counts are of all patches.

pub mod error;
mod scene;
mod search;
pub mod triangles;
pub mod work;

use super::{distance, plot};
use crate::config::{BackfaceMethod, Config, Engine, LevelPolicy, LevelScope, Unit};
use crate::error::{Error, Result};
use crate::sink::NoMesh;
use crate::trace::command::Command;
use crate::unit::simulate;
use rtl_model::counter::Counter;
use rtl_model::esc::ControlMesh;

pub use scene::Scene;

/// Triangles of a patch in the uniform pattern of level `level`: 18 coarse ones of (L + 1)^2.
#[must_use]
pub fn uniform_triangles(level: u32) -> u64 {
    18 * u64::from(level + 1) * u64::from(level + 1)
}

/// Every patch, on unit `esc` at one level of resolution: every candidate inserted.
fn uniform(base: &Config, level: u32) -> Config {
    let mut config = all_patches(base, Unit::Esc);
    fix_level(&mut config, level);
    config
}

/// Gives every patch of unit `esc` one level of resolution, with every candidate inserted.
pub(super) fn fix_level(config: &mut Config, level: u32) {
    let esc = &mut config.esc;
    (esc.level, esc.scope) = (LevelPolicy::Fixed, LevelScope::Patch);
    (esc.fixed_level, esc.level_max) = (level, level);
    esc.mu = 0.0;
}

/// On `unit`, without an engine, and nothing clipped or culled.
fn all_patches(base: &Config, unit: Unit) -> Config {
    let mut config = Config { unit, engine: Engine::None, ..base.clone() };
    config.clip.enabled = false;
    config.backface.method = BackfaceMethod::Off;
    config
}

/// Triangles that a run makes.
fn count(commands: &[Command], config: &Config) -> Result<u64> {
    let commands = commands.iter().cloned().map(Ok);
    Ok(simulate(commands, config, &mut NoMesh)?.total(Counter::EmitTriangles))
}

/// The name of what a surface is compared with.
const fn reading(mesh: ControlMesh) -> &'static str {
    match mesh {
        ControlMesh::Net => "net",
        ControlMesh::Chord => "chord",
    }
}

/// A threshold for a table of integers: 1e-9 of its unit.
fn nano(value: f64) -> u64 {
    (value * 1e9).round() as u64
}

/// That a study has something to measure.
fn some<T>(what: &str, all: &[T]) -> Result<()> {
    if all.is_empty() {
        return Err(Error::Usage(format!("{what}: expected at least one")));
    }
    Ok(())
}
