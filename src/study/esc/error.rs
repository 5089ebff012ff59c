//! Error: the claim of Concheiro et al. 2014, Figure 7, measured: at equal triangle counts, how far
//! the true surface is from the triangles of each way to tessellate it.
//!
//! A scene comes in, seen once by its camera. Targets are the counts of the uniform quad grid with
//! n = 3, 4, .. segments, which `d3d11` hits with one factor for all; ESC's own uniform pattern has
//! every third of them. The adaptive ways get there by their thresholds, searched for; where a
//! count steps over its target, the nearest is taken and told. Out come the largest and the mean
//! distance ([`Deviation`]), in the world and on the screen.

mod table;

use super::distance::{self, Mesh, Place, Samples};
use super::scene::{Scene, patches};
use super::triangles::Test;
use super::{all_patches, count, plot, search, some, uniform};
use crate::config::{Config, Criterion, DomainKind, FactorPolicy, Partitioning, Space, Unit};
use crate::error::Result;
use crate::golden::Real;
use crate::output::space;
use crate::sink::{FrameInfo, PatchMesh, Sink};
use crate::study::walk::Walk;
use crate::trace::command::Command;
use crate::unit::simulate;
use glam::DMat4;
use rayon::prelude::*;

pub use super::distance::Deviation;
pub use table::{CSV_HEADER, csv, svg, svg_of_means, text};

/// A count is equal to its target within this part in a thousand.
pub const TOLERANCE: u64 = 20;

/// Thresholds in pixels or object units between which is searched.
const PIXELS: [f64; 2] = [1.0 / 4096.0, 1024.0];
const UNITS: [f64; 2] = [1.0 / (1 << 20) as f64, 4.0];

/// How much is looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// What is seen, in one frame.
    pub scene: Scene,
    /// Segments of the uniform grids whose counts are the targets, at least 3.
    pub targets: Vec<u32>,
    /// The level of resolution of the adaptive ways, 0..=15; the paper's is 3.
    pub level: u32,
    /// Samples of a patch along each direction are one more.
    pub segments: u32,
}

/// A way to tessellate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// ESC by a distance test.
    Esc(Test),
    /// ESC's uniform pattern.
    EscUniform,
    /// `d3d11` with a factor for each edge by the same test: AdptTess.
    D3d11Adaptive,
    /// `d3d11` with one factor.
    D3d11Fixed,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 7] = {
        let [a, b, c, d] = Test::ALL;
        [
            Self::Esc(a),
            Self::Esc(b),
            Self::Esc(c),
            Self::Esc(d),
            Self::EscUniform,
            Self::D3d11Adaptive,
            Self::D3d11Fixed,
        ]
    };

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Esc(test) => format!("esc, {}", test.name()),
            Self::EscUniform => "esc, uniform".to_owned(),
            Self::D3d11Adaptive => "d3d11, adaptive".to_owned(),
            Self::D3d11Fixed => "d3d11, one factor".to_owned(),
        }
    }

    /// Thresholds that it may have; `None` where it has none.
    fn range(self) -> Option<[f64; 2]> {
        match self {
            Self::Esc(Test { space: Space::Object, .. }) => Some(UNITS),
            Self::Esc(_) | Self::D3d11Adaptive => Some(PIXELS),
            Self::EscUniform | Self::D3d11Fixed => None,
        }
    }

    /// The configuration that aims at the uniform grid of `segments`; `None` where that is none of
    /// its patterns.
    fn config(self, base: &Config, level: u32, threshold: f64, segments: u32) -> Option<Config> {
        Some(match self {
            Self::Esc(test) => test.config(base, level, threshold),
            Self::EscUniform if segments.is_multiple_of(3) => uniform(base, segments / 3 - 1),
            Self::EscUniform => return None,
            Self::D3d11Adaptive => {
                let mut config = d3d11(base);
                config.hull.policy = FactorPolicy::Adaptive;
                (config.hull.candidates, config.hull.pixels) = (level, threshold);
                config
            }
            Self::D3d11Fixed => {
                let mut config = d3d11(base);
                config.level.criterion = Some(Criterion::Fixed);
                config.level.level = Some(segments.into());
                config
            }
        })
    }
}

/// Unit `d3d11`, whose factors are whole numbers: ESC's segments are too.
fn d3d11(base: &Config) -> Config {
    let mut config = all_patches(base, Unit::D3d11);
    config.tessellator.partitioning = Partitioning::Integer;
    config.domain.shader = DomainKind::Basis;
    config
}

/// A way at a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The way.
    pub way: Way,
    /// Segments of the grid whose count is the target.
    pub segments: u32,
    /// That count.
    pub target: u64,
    /// The threshold, in pixels or object units, where it has one.
    pub threshold: Option<f64>,
    /// Triangles made.
    pub triangles: u64,
    /// How far the surface is from them.
    pub deviation: Deviation,
}

impl Row {
    /// Whether the count is as good as equal to the target.
    #[must_use]
    pub fn is_near(&self) -> bool {
        1000 * self.triangles.abs_diff(self.target) <= TOLERANCE * self.target
    }
}

/// Carries out the study in the current rayon pool; `base` has the formats.
///
/// # Errors
/// Those of the configuration.
pub fn run(options: &Options, base: &Config) -> Result<Vec<Row>> {
    some("targets", &options.targets)?;
    let commands = options.scene.commands(1)?;
    let truth = Truth::of(&commands, base)?;
    let mut rows = Vec::new();
    for &segments in &options.targets {
        for way in Way::ALL {
            rows.extend(row(way, segments, options, base, &commands, &truth)?);
        }
    }
    Ok(rows)
}

fn row(
    way: Way,
    segments: u32,
    options: &Options,
    base: &Config,
    commands: &[Command],
    truth: &Truth,
) -> Result<Option<Row>> {
    let target = 2 * u64::from(segments) * u64::from(segments) * patches(commands);
    let of = |threshold: f64| way.config(base, options.level, threshold, segments);
    let threshold = match way.range() {
        None => None,
        Some(range) => {
            let mut counted = |threshold: f64| {
                count(commands, &of(threshold).expect("a way with thresholds has them all"))
            };
            Some(search::nearest(target, range, &mut counted)?.0)
        }
    };
    let Some(config) = of(threshold.unwrap_or_default()) else { return Ok(None) };
    let mut meshes = Meshes::default();
    let report = simulate(commands.iter().cloned().map(Ok), &config, &mut meshes)?;
    let triangles = report.total(rtl_model::counter::Counter::EmitTriangles);
    let deviation = truth.against(&meshes, options.segments);
    Ok(Some(Row { way, segments, target, threshold, triangles, deviation }))
}

/// The true surfaces: control points in clip space, in f64 from the trace's numbers on.
struct Truth(Vec<[Real; 16]>);

impl Truth {
    fn of(commands: &[Command], base: &Config) -> Result<Self> {
        let mut patches = Vec::new();
        let mut walk = Walk::new(base);
        for command in commands {
            walk.command(command, &mut |_, drawn| patches.push(drawn.exact))?;
        }
        Ok(Self(patches))
    }

    fn against(&self, meshes: &Meshes, segments: u32) -> Deviation {
        assert_eq!(meshes.patches.len(), self.0.len(), "nothing is culled");
        let view = meshes.frame.expect("patches belong to a frame").view;
        let place = |to_world: &DMat4| Place {
            to_world: *to_world,
            viewport: view.viewport,
            samples: Samples::Ends(segments),
        };
        let pairs = self.0.par_iter().zip(&meshes.patches);
        let each =
            pairs.map(|(points, (mesh, to_world))| distance::patch(points, mesh, &place(to_world)));
        // Sums in the order of the patches: the same at any number of threads.
        let each: Vec<Deviation> = each.collect();
        each.iter().fold(Deviation::default(), Deviation::with)
    }
}

/// Keeps the meshes of the one frame, in the order of their patches.
#[derive(Default)]
struct Meshes {
    frame: Option<FrameInfo>,
    patches: Vec<(Mesh, DMat4)>,
}

impl Sink for Meshes {
    fn wants(&self, frame: u64) -> bool {
        frame == 0
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.frame = Some(*frame);
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let view = self.frame.expect("a frame begins before its patches").view;
        let ulp = space::ulp(view.position);
        let vertices = mesh.vertices.iter().map(|v| space::real(v.position, ulp)).collect();
        let mesh = (
            Mesh { vertices, triangles: mesh.triangles.to_vec() },
            DMat4::from_cols_array(mesh.to_world),
        );
        self.patches.push(mesh);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
