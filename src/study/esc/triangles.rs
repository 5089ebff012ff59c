//! Triangles: Table 1 of Concheiro et al. 2014, section 4.1, measured again.
//!
//! Two scenes come in, teacups and a stand-in for elephants, each at one level of resolution; out
//! come triangles of the uniform pattern, and of the adaptive one as a part of these, over the
//! threshold mu: for both readings of "control mesh" and for distances in pixels and in the units
//! of the control points. The paper's table has one high and one medium threshold for both scenes;
//! so a search follows for the one mu at which the worse of the two scenes is nearest to the table.
//!
//! In object units the count does not depend on the view, and one frame is as good as any.
//!
//! Elephants have a size of their own, and the paper's are not to be had. Elephants s times as
//! large have the same triangles at s times the threshold: in object units exactly; in pixels those
//! that are seen s times as large, in a picture of s times the pixels along each side. So a second
//! search is for the one size at which both rows of the table come nearest, each at a common
//! threshold of its own ([`Sized`]).

mod fit;
mod table;

use super::scene::{Scene, patches};
use super::{count, plot, reading, uniform, uniform_triangles};
use crate::config::{Config, Space};
use crate::error::Result;
use crate::trace::command::Command;
use rtl_model::esc::ControlMesh;

pub use table::{CSV_HEADER, csv, svg, text};

/// The scenes, in the order of the paper's columns.
pub const SCENES: usize = 2;

/// A row of the paper's table: what it calls its threshold, and the adaptive triangles of each
/// scene in hundredths of a percent of the uniform ones.
pub const PAPER: [(&str, [u32; SCENES]); 2] = [("high", [9362, 8510]), ("medium", [5196, 5068])];

/// Deviation in hundredths of a percent up to which a row counts as reproduced.
pub const NEAR: u32 = 500;

/// How much is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Teacups, 26 patches each.
    pub cups: u32,
    /// Elephants, 811 patches each.
    pub elephants: u32,
    /// Frames of the walks; in object units there is one.
    pub frames: u32,
    /// The level of resolution, 0..=15; the paper's is 3.
    pub level: u32,
    /// Thresholds for each octave.
    pub density: u32,
}

/// What decides how many candidates are inserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Test {
    /// What the surface is compared with.
    pub mesh: ControlMesh,
    /// In which space.
    pub space: Space,
}

impl Test {
    /// All of them.
    pub const ALL: [Self; 4] = {
        const fn test(mesh: ControlMesh, space: Space) -> Test {
            Test { mesh, space }
        }
        [
            test(ControlMesh::Net, Space::Pixels),
            test(ControlMesh::Chord, Space::Pixels),
            test(ControlMesh::Net, Space::Object),
            test(ControlMesh::Chord, Space::Object),
        ]
    };

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> String {
        format!("{}, {}", reading(self.mesh), self.unit())
    }

    /// The unit of its threshold.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self.space {
            Space::Pixels => "pixels",
            Space::Object => "object units",
        }
    }

    /// The octaves of mu that are looked at, as powers of two: from where nearly all candidates are
    /// inserted to where hardly any is.
    const fn octaves(self) -> [i32; 2] {
        match self.space {
            Space::Pixels => [-6, 5],
            Space::Object => [-13, -3],
        }
    }

    /// On `unit` esc, with this threshold.
    pub(super) fn config(self, base: &Config, level: u32, mu: f64) -> Config {
        let mut config = uniform(base, level);
        let esc = &mut config.esc;
        (esc.control_mesh, esc.space, esc.mu) = (self.mesh, self.space, mu);
        config
    }
}

/// Triangles of both scenes at a threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The threshold, in the test's unit.
    pub mu: f64,
    /// Triangles of each scene, over all frames.
    pub triangles: [u64; SCENES],
}

/// A test's triangles over mu.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The test.
    pub test: Test,
    /// Triangles of the uniform pattern, over as many frames.
    pub uniform: [u64; SCENES],
    /// Over rising mu.
    pub samples: Vec<Sample>,
    /// For each row of [`PAPER`] the common mu that comes nearest to it.
    pub best: [Sample; 2],
    /// The same for elephants of the size that suits both rows best.
    pub sized: Sized,
}

/// Elephants of another size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sized {
    /// How many times as large they are, in pixels: are seen.
    pub size: f64,
    /// For each row of [`PAPER`] the common mu, and the triangles of both scenes.
    pub best: [Sample; 2],
}

impl Curve {
    /// Triangles as a part of the uniform ones, 0 to 1.
    #[must_use]
    pub fn fractions(&self, sample: &Sample) -> [f64; SCENES] {
        [0, 1].map(|k| sample.triangles[k] as f64 / self.uniform[k] as f64)
    }

    /// The larger of both scenes' deviations from a row of the paper, in parts of the uniform ones.
    #[must_use]
    pub fn deviation(&self, sample: &Sample, row: usize) -> f64 {
        worse(self.fractions(sample), row)
    }

    /// A scene's part at any mu, straight between samples on a logarithmic scale; beyond the ends
    /// as there.
    fn part(&self, scene: usize, mu: f64) -> f64 {
        let samples = &self.samples;
        let k = samples.partition_point(|sample| sample.mu < mu).clamp(1, samples.len() - 1);
        let [a, b] = [&samples[k - 1], &samples[k]];
        let along = ((mu / a.mu).log2() / (b.mu / a.mu).log2()).clamp(0.0, 1.0);
        let [before, behind] = [a, b].map(|sample| self.fractions(sample)[scene]);
        before * (1.0 - along) + behind * along
    }
}

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// What was asked for.
    pub options: Options,
    /// Patches of each scene, in a frame.
    pub patches: [u64; SCENES],
    /// Triangles of the uniform pattern, in a frame.
    pub uniform: [u64; SCENES],
    /// A curve for each of [`Test::ALL`].
    pub curves: Vec<Curve>,
}

/// Carries out the study in the current rayon pool; `base` has the formats.
///
/// # Errors
/// Those of the configuration.
pub fn run(options: Options, base: &Config) -> Result<Study> {
    let scenes = [Scene::Teacups(options.cups), Scene::Elephants(options.elephants)];
    let [cups, elephants] = scenes;
    let of = |frames| -> Result<[Vec<Command>; SCENES]> {
        Ok([cups.commands(frames)?, elephants.commands(frames)?])
    };
    let (still, film) = (of(1)?, of(options.frames)?);
    let uniform = both(&still, &uniform(base, options.level))?;
    let curve = |test: Test| {
        let (scenes, frames) = match test.space {
            Space::Pixels => (&film, u64::from(options.frames)),
            Space::Object => (&still, 1),
        };
        curve(test, uniform.map(|n| n * frames), options, &mut |scene, mu| {
            count(&scenes[scene], &test.config(base, options.level, mu))
        })
    };
    let curves = Test::ALL.into_iter().map(curve).collect::<Result<_>>()?;
    let patches = [patches(&still[0]), patches(&still[1])];
    Ok(Study { options, patches, uniform, curves })
}

/// The curve of a test, of which `count` gives a scene's triangles at a threshold.
fn curve(
    test: Test,
    uniform: [u64; SCENES],
    options: Options,
    count: &mut dyn FnMut(usize, f64) -> Result<u64>,
) -> Result<Curve> {
    let mut sample = |mu: f64, size: f64| -> Result<Sample> {
        Ok(Sample { mu, triangles: [count(0, mu)?, count(1, mu / size)?] })
    };
    let [first, last] = test.octaves();
    let density = options.density as i32;
    let places = first * density..=last * density;
    let mus = places.map(|k| (f64::from(k) / f64::from(density)).exp2());
    let samples = mus.map(|mu| sample(mu, 1.0)).collect::<Result<Vec<_>>>()?;
    let none = [Sample { mu: 0.0, triangles: [0; SCENES] }; 2];
    let sized = Sized { size: 1.0, best: none };
    let mut curve = Curve { test, uniform, samples, best: none, sized };
    let [own, other] = [1.0, fit::size(&curve)];
    curve.sized.size = other;
    for row in 0..PAPER.len() {
        curve.best[row] = sample(fit::common(&curve, row, own).1, own)?;
        curve.sized.best[row] = sample(fit::common(&curve, row, other).1, other)?;
    }
    Ok(curve)
}

fn both(scenes: &[Vec<Command>; SCENES], config: &Config) -> Result<[u64; SCENES]> {
    Ok([count(&scenes[0], config)?, count(&scenes[1], config)?])
}

/// A row of the paper as parts of the uniform triangles.
fn paper(row: usize) -> [f64; SCENES] {
    PAPER[row].1.map(|hundredths| f64::from(hundredths) / 1e4)
}

fn worse(fractions: [f64; SCENES], row: usize) -> f64 {
    let off = |k: usize| (fractions[k] - paper(row)[k]).abs();
    off(0).max(off(1))
}

#[cfg(test)]
mod tests;
