//! Triangles: Table 1 of Concheiro et al. 2014, section 4.1, measured again.
//!
//! Two scenes come in, teacups and a stand-in for elephants, each at one level of resolution; out
//! come triangles of the uniform pattern, and of the adaptive one as a part of these, over the
//! threshold mu: for both readings of "control mesh" and for distances in pixels and in the units of
//! the control points. The paper's table has one high and one medium threshold for both scenes; so a
//! search follows for the one mu at which the worse of the two scenes is nearest to the table.
//!
//! In object units the count does not depend on the view, and one frame is as good as any.
//! Elephants have a size of their own there, and the paper's are not to be had: of that the ratio of
//! the two scenes' thresholds is free, which is why it is reported. It would have to be the same for
//! both rows of the table.

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
            Space::Pixels => [-8, 7],
            Space::Object => [-16, -1],
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

    /// The mu, between samples on a logarithmic scale, at which one scene alone has the paper's
    /// part; `None` where none of the samples lie beside it.
    #[must_use]
    pub fn alone(&self, scene: usize, row: usize) -> Option<f64> {
        let target = paper(row)[scene];
        self.samples.windows(2).find_map(|pair| {
            let [a, b] = [&pair[0], &pair[1]].map(|sample| self.fractions(sample)[scene]);
            let part = if a > b { (a - target) / (a - b) } else { 0.0 };
            let within = a >= target && target >= b;
            within.then(|| between(pair[0].mu, pair[1].mu, part))
        })
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
    let curve = |test: Test| match test.space {
        Space::Pixels => curve(test, &film, u64::from(options.frames), uniform, options, base),
        Space::Object => curve(test, &still, 1, uniform, options, base),
    };
    let curves = Test::ALL.into_iter().map(curve).collect::<Result<_>>()?;
    let patches = [patches(&still[0]), patches(&still[1])];
    Ok(Study { options, patches, uniform, curves })
}

fn curve(
    test: Test,
    scenes: &[Vec<Command>; SCENES],
    frames: u64,
    uniform: [u64; SCENES],
    options: Options,
    base: &Config,
) -> Result<Curve> {
    let sample = |mu: f64| -> Result<Sample> {
        let triangles = both(scenes, &test.config(base, options.level, mu))?;
        Ok(Sample { mu, triangles })
    };
    let [first, last] = test.octaves();
    let density = options.density as i32;
    let places = first * density..=last * density;
    let mus = places.map(|k| (f64::from(k) / f64::from(density)).exp2());
    let samples = mus.map(sample).collect::<Result<Vec<_>>>()?;
    let none = Sample { mu: 0.0, triangles: [0; SCENES] };
    let uniform = uniform.map(|n| n * frames);
    let mut curve = Curve { test, uniform, samples, best: [none; 2] };
    for row in 0..PAPER.len() {
        curve.best[row] = sample(common(&curve, row))?;
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

/// The mu at which the worse scene is nearest to the paper, by what lies between samples.
fn common(curve: &Curve, row: usize) -> f64 {
    const PARTS: u32 = 64;
    let mut best = (f64::INFINITY, curve.samples[0].mu);
    for pair in curve.samples.windows(2) {
        let [a, b] = [&pair[0], &pair[1]].map(|sample| curve.fractions(sample));
        for k in 0..=PARTS {
            let part = f64::from(k) / f64::from(PARTS);
            let here = [0, 1].map(|scene| a[scene] * (1.0 - part) + b[scene] * part);
            let off = worse(here, row);
            if off < best.0 {
                best = (off, between(pair[0].mu, pair[1].mu, part));
            }
        }
    }
    best.1
}

fn between(a: f64, b: f64, part: f64) -> f64 {
    (a.log2() * (1.0 - part) + b.log2() * part).exp2()
}

#[cfg(test)]
mod tests;
