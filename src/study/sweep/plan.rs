//! The plan: a study in, its points out, each with the configuration that it stands for and the
//! hash under which its result is kept.
//!
//! The hash is over everything that a result is made of: the trace and the files that it names, the
//! effective configuration, and the version of the tool. So two points that say the same in
//! different words are one, and a point is known again whichever study it stands in.

use super::store::HASH_DIGITS;
use super::study::{Case, Study};
use crate::config::layers::Layers;
use crate::config::preset::Preset;
use crate::config::{Config, Unit};
use crate::error::{Error, Result};
use crate::output::summary::Provenance;
use crate::study::provenance::provenance;
use crate::trace::command::{Command, Header};
use crate::trace::open::Trace;
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// The points of a study.
#[derive(Debug)]
pub struct Plan {
    /// The study.
    pub study: Study,
    /// The traces that its points name, each once.
    pub traces: Vec<TraceFile>,
    /// The paths of the keys that set points apart: columns of tables.
    pub keys: Vec<&'static str>,
    /// The points, in the study's order.
    pub points: Vec<Point>,
    /// For each preset of the points the layers that they share.
    layers: Vec<(Preset, Layers)>,
}

/// A trace of a study.
#[derive(Debug)]
pub struct TraceFile {
    /// As the study names it.
    pub name: String,
    /// The path to open.
    pub path: PathBuf,
    /// What it is made of.
    pub provenance: Provenance,
}

/// A point of a study.
#[derive(Debug)]
pub struct Point {
    /// Which of [`Plan::traces`].
    pub trace: usize,
    /// The bottom layer.
    pub preset: Preset,
    /// The unit.
    pub unit: Unit,
    /// The values of [`Plan::keys`]: as the study gives them, else as they are in effect; empty for
    /// those that are absent.
    pub values: Vec<String>,
    /// The hash, in hexadecimal; or why there can be no such configuration.
    pub hash: Result<String, String>,
    case: usize,
}

impl Plan {
    /// Reads every trace once, and makes every configuration.
    ///
    /// # Errors
    /// A trace that cannot be read to its end.
    pub fn new(study: Study) -> Result<Self> {
        let mut plan = Self {
            keys: study.keys(),
            study,
            traces: Vec::new(),
            points: Vec::new(),
            layers: Vec::new(),
        };
        plan.enumerate()?;
        for trace in &mut plan.traces {
            trace.provenance = read(&trace.path)?;
        }
        let known = plan.points.par_iter().map(|point| plan.identify(point));
        let known: Vec<_> = known.collect();
        for (point, (values, hash)) in plan.points.iter_mut().zip(known) {
            (point.values, point.hash) = (values, hash);
        }
        Ok(plan)
    }

    /// The effective configuration of a point.
    ///
    /// # Errors
    /// Values of the wrong kind, out of range or in contradiction, with their place in the study.
    pub fn configuration(&self, point: &Point) -> Result<Config> {
        let layers = self.layers.iter().find(|(preset, _)| *preset == point.preset);
        let (_, layers) = layers.expect("every preset of a point has its layers");
        let mut layers = layers.clone();
        layers.values(&self.study.file, &self.case(point).values)?;
        Ok(layers.for_unit(point.unit)?.effective())
    }

    /// A point in a few words.
    #[must_use]
    pub fn describe(&self, number: usize) -> String {
        let point = &self.points[number];
        let (trace, unit) = (&self.traces[point.trace].name, point.unit.name());
        let mut text = format!("point {number} ({trace}, {}, {unit}", point.preset.name());
        for (key, value) in self.keys.iter().zip(&point.values) {
            text += &format!(", {key}={value}");
        }
        text + ")"
    }

    fn case(&self, point: &Point) -> &Case {
        let Study { grid, list, .. } = &self.study;
        grid.get(point.case).unwrap_or_else(|| &list[point.case - grid.len()])
    }

    /// Points in the order of the study: by trace, preset and unit the combinations of the grid;
    /// then entry by entry of the list its traces, presets and units.
    fn enumerate(&mut self) -> Result<()> {
        let combinations = self.study.grid.len();
        let (traces, presets, units) =
            (self.study.traces.clone(), self.study.presets.clone(), self.study.units.clone());
        for trace in &traces {
            for &preset in &presets {
                for &unit in &units {
                    for case in 0..combinations {
                        self.add(trace, preset, unit, case)?;
                    }
                }
            }
        }
        for entry in 0..self.study.list.len() {
            let Case { trace, preset, unit, .. } = self.study.list[entry].clone();
            for trace in trace.as_slice_or(&traces) {
                for &preset in preset.as_slice_or(&presets) {
                    for &unit in unit.as_slice_or(&units) {
                        self.add(trace, preset, unit, combinations + entry)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn add(&mut self, trace: &str, preset: Preset, unit: Unit, case: usize) -> Result<()> {
        let known = self.traces.iter().position(|known| known.name == trace);
        let trace = known.unwrap_or_else(|| {
            let path = self.study.path(trace);
            let (name, provenance) = (trace.to_owned(), Provenance::default());
            self.traces.push(TraceFile { name, path, provenance });
            self.traces.len() - 1
        });
        if !self.layers.iter().any(|(known, _)| *known == preset) {
            self.layers.push((preset, self.study.layers(preset)?));
        }
        let (values, hash) = (Vec::new(), Err(String::new()));
        self.points.push(Point { trace, preset, unit, values, hash, case });
        Ok(())
    }

    /// The values and the hash of a point.
    fn identify(&self, point: &Point) -> (Vec<String>, Result<String, String>) {
        let config = self.configuration(point);
        let given = &self.case(point).values;
        let value = |key: &&'static str| {
            let given = given.iter().find(|value| value.key.path == *key);
            let value = match (given, &config) {
                (Some(given), _) => Some(given.value.clone()),
                (None, Ok(config)) => config.value(key),
                (None, Err(_)) => None,
            };
            value.map(plain).unwrap_or_default()
        };
        let values = self.keys.iter().map(value).collect();
        let provenance = &self.traces[point.trace].provenance;
        let hash = config.map(|config| {
            // Without the comments, whose wording changes no result.
            let table = Table::try_from(&config).expect("a configuration is plain data");
            hash(env!("CARGO_PKG_VERSION"), provenance, &table)
        });
        (values, hash.map_err(|error: Error| error.to_string()))
    }
}

/// One of its own, or those of all.
trait OwnOr<T> {
    fn as_slice_or<'a>(&'a self, all: &'a [T]) -> &'a [T];
}

impl<T> OwnOr<T> for Option<T> {
    fn as_slice_or<'a>(&'a self, all: &'a [T]) -> &'a [T] {
        if self.is_some() { self.as_slice() } else { all }
    }
}

/// A value without the marks of TOML.
fn plain(value: Value) -> String {
    match value {
        Value::String(text) => text,
        value => value.to_string(),
    }
}

/// What a run of this trace will be made of.
fn read(path: &Path) -> Result<Provenance> {
    let mut reader = Trace::open(path)?;
    let mut header = Header::default();
    for located in reader.by_ref() {
        if let Command::Header(found) = located?.command {
            header = found;
        }
    }
    provenance(header, &reader)
}

/// 128 bits are enough: a collision is less likely than a fault of the machine.
fn hash(version: &str, provenance: &Provenance, config: &Table) -> String {
    let mut hash = Sha256::new();
    hash.update(format!("tessim {version}\n"));
    hash.update(format!("trace {}\n", provenance.sha256));
    for file in &provenance.files {
        hash.update(format!("file {} {:?}\n", file.sha256, file.name));
    }
    hash.update(config.to_string());
    hex::encode(&hash.finalize()[..HASH_DIGITS / 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::summary::DataFile;

    fn provenance(sha256: &str, file: &str) -> Provenance {
        let files = vec![DataFile { name: "p".to_owned(), sha256: file.to_owned() }];
        Provenance { sha256: sha256.to_owned(), files, ..Provenance::default() }
    }

    /// Every table that differs in one value.
    fn changed(table: &Table) -> Vec<Table> {
        let each = table.iter().flat_map(|(key, value)| {
            let values = match value {
                Value::Table(inner) => changed(inner).into_iter().map(Value::Table).collect(),
                Value::Integer(value) => vec![Value::Integer(value + 1)],
                Value::Float(value) => vec![Value::Float(value + 1.0)],
                Value::Boolean(value) => vec![Value::Boolean(!value)],
                value => vec![Value::String(format!("{value}?"))],
            };
            values.into_iter().map(move |value| (key.clone(), value))
        });
        let with = |(key, value)| {
            let mut table = table.clone();
            table.insert(key, value);
            table
        };
        each.map(with).collect()
    }

    #[test]
    fn whatever_a_result_is_made_of_changes_its_hash() {
        let config = Table::try_from(Config::default()).unwrap();
        let (version, trace) = ("1.0.0", provenance("a", "b"));
        let first = hash(version, &trace, &config);
        assert_eq!(first, hash(version, &trace, &config.clone()));
        assert_eq!(first.len(), HASH_DIGITS);
        for other in [provenance("c", "b"), provenance("a", "c"), provenance("a", "")] {
            assert_ne!(first, hash(version, &other, &config));
        }
        let bare = Provenance { files: Vec::new(), ..provenance("a", "") };
        assert_ne!(hash(version, &provenance("a", ""), &config), hash(version, &bare, &config));
        assert_ne!(first, hash("1.0.1", &trace, &config));
        let others = changed(&config);
        assert!(others.len() > 60, "{} values of a configuration", others.len());
        for other in others {
            assert_ne!(first, hash(version, &trace, &other), "{other}");
        }
    }
}
