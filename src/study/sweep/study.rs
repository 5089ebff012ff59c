//! The study: a TOML file in, what is to be run out, in the order in which the file says it.
//!
//! What the file says wrongly is refused with its line before anything runs. Whether the values of
//! one point go together is that point's own affair.

use super::text::{Leaf, Text};
use crate::config::Unit;
use crate::config::layers::{Layers, Placed, text_of};
use crate::config::preset::Preset;
use crate::error::Result;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// Most points of a study.
pub const POINTS_MAX: usize = 100_000;

/// What a study may say at its top.
const SECTIONS: [&str; 7] = ["traces", "presets", "units", "config", "set", "grid", "list"];

/// A study as its file says it.
#[derive(Debug)]
pub struct Study {
    /// The file as the user named it.
    pub file: String,
    /// Its text.
    pub text: String,
    /// Paths of traces, for points that name none of their own; see [`Self::path`].
    pub(super) traces: Vec<String>,
    /// Presets, the bottom layer.
    pub(super) presets: Vec<Preset>,
    /// Units, the top layer.
    pub(super) units: Vec<Unit>,
    /// The layer over the presets: the path of a file and its text.
    base: Option<(PathBuf, String)>,
    /// The layer over that.
    set: Vec<Placed>,
    /// Combinations of the grid, the first key's values changing slowest.
    pub(super) grid: Vec<Case>,
    /// Entries of the list.
    pub(super) list: Vec<Case>,
}

/// What sets a point apart from the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Case {
    /// This trace alone.
    pub(super) trace: Option<String>,
    /// This preset alone.
    pub(super) preset: Option<Preset>,
    /// This unit alone.
    pub(super) unit: Option<Unit>,
    /// The layer below the unit.
    pub(super) values: Vec<Placed>,
}

impl Study {
    /// Reads the study at `path`.
    ///
    /// # Errors
    /// A file that cannot be read; with its place, anything in it that is no study.
    pub fn open(path: &Path) -> Result<Self> {
        let file = path.display().to_string();
        let text = text_of(path)?;
        let at = Text { file: &file, text: &text };
        let table = at.table()?;
        for (key, _) in &table {
            let found = key.get_ref().as_ref();
            if !SECTIONS.contains(&found) {
                return Err(at.unknown(key.span().start, found, &SECTIONS));
            }
        }
        let presets = at.names(&table, "presets", Preset::named, &Preset::ALL.map(Preset::name))?;
        let units = at.names(&table, "units", unit_named, &Unit::ALL.map(Unit::name))?;
        let base = at.string(&table, "config")?.map(|name| path.with_file_name(name));
        let base = base.map(|path| text_of(&path).map(|text| (path, text)));
        let mut study = Self {
            traces: at.traces(&table)?,
            presets: presets.unwrap_or_else(|| vec![Preset::default()]),
            units: units.unwrap_or_else(|| vec![Unit::default()]),
            base: base.transpose()?,
            set: at.values(&table, "set")?,
            grid: at.grid(&table)?,
            list: at.list(&table)?,
            file: String::new(),
            text: String::new(),
        };
        study.check(&at, &table)?;
        (study.file, study.text) = (file, text);
        for &preset in &study.presets {
            study.layers(preset)?;
        }
        Ok(study)
    }

    /// A path that the study names, which is relative to the study.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        Path::new(&self.file).with_file_name(name)
    }

    /// The paths of the keys that set points apart, in the order in which the file first names
    /// them.
    #[must_use]
    pub fn keys(&self) -> Vec<&'static str> {
        let mut keys = Vec::new();
        // All combinations of the grid have the same.
        for value in self.grid.iter().take(1).chain(&self.list).flat_map(|case| &case.values) {
            if !keys.contains(&value.key.path) {
                keys.push(value.key.path);
            }
        }
        keys
    }

    /// The layers that all points of a preset share.
    ///
    /// # Errors
    /// A value of the wrong kind in the base file or under `set`.
    pub(super) fn layers(&self, preset: Preset) -> Result<Layers> {
        let mut layers = Layers::new(preset);
        if let Some((path, text)) = &self.base {
            layers.file(&path.display().to_string(), text)?;
        }
        layers.values(&self.file, &self.set)?;
        Ok(layers)
    }

    /// What no part of the file is by itself responsible for.
    fn check(&self, at: &Text<'_>, table: &DeTable<'_>) -> Result<()> {
        let own = self.list.iter().all(|case| case.trace.is_some());
        if self.traces.is_empty() && !(self.grid.is_empty() && own) {
            let message = "found no traces, expected traces = [\"FILE\", ..]";
            return Err(at.error(at.start_of(table, "grid"), message.to_owned()));
        }
        let each = |own: bool, all: usize| if own { 1 } else { all };
        let of_case = |case: &Case| {
            each(case.trace.is_some(), self.traces.len())
                * each(case.preset.is_some(), self.presets.len())
                * each(case.unit.is_some(), self.units.len())
        };
        let points: usize = self.grid.iter().chain(&self.list).map(of_case).sum();
        if points > POINTS_MAX {
            let message = format!("found {points} points, expected at most {POINTS_MAX}");
            return Err(at.error(0, message));
        }
        Ok(())
    }
}

fn unit_named(name: &str) -> Option<Unit> {
    Unit::ALL.into_iter().find(|unit| unit.name() == name)
}

impl Text<'_> {
    /// Every combination of the grid's values; without grid and list, one that says nothing.
    fn grid(&self, table: &DeTable<'_>) -> Result<Vec<Case>> {
        let Some(value) = table.get("grid") else {
            let alone = !table.contains_key("list");
            return Ok(if alone { vec![Case::default()] } else { Vec::new() });
        };
        let mut axes = Vec::new();
        for leaf in self.leaves("grid", value)? {
            let key = self.known(&leaf)?;
            let DeValue::Array(values) = leaf.value.get_ref() else {
                let found = self.found(leaf.value);
                let message =
                    format!("{}: found {found}, expected a list, such as [1, 2]", key.path);
                return Err(self.error(leaf.value.span().start, message));
            };
            let values = values.iter().map(|value| self.placed(key, value));
            axes.push((leaf, values.collect::<Result<Vec<_>>>()?));
        }
        let mut combinations = vec![Vec::new()];
        for (leaf, axis) in axes {
            let count = combinations.len().saturating_mul(axis.len());
            if axis.is_empty() || count > POINTS_MAX {
                let message = format!(
                    "{}: found {} values, which make {count} points, expected 1 to {POINTS_MAX}",
                    leaf.path,
                    axis.len()
                );
                return Err(self.error(leaf.value.span().start, message));
            }
            let longer = combinations.iter().flat_map(|before: &Vec<Placed>| {
                axis.iter().map(move |value| [before, std::slice::from_ref(value)].concat())
            });
            combinations = longer.collect();
        }
        let case = |values| Case { values, ..Case::default() };
        Ok(combinations.into_iter().map(case).collect())
    }

    /// The entries of the list: tables of keys, and of `trace`, `preset` and `unit`.
    fn list(&self, table: &DeTable<'_>) -> Result<Vec<Case>> {
        let Some(value) = table.get("list") else { return Ok(Vec::new()) };
        let tables = value.get_ref().as_array().filter(|list| !list.is_empty());
        let Some(entries) = tables else {
            let message = format!("list: found {}, expected [[list]] entries", self.found(value));
            return Err(self.error(value.span().start, message));
        };
        let case = |entry| {
            let mut case = Case::default();
            for leaf in self.leaves("list", entry)? {
                match leaf.path.as_str() {
                    "trace" => case.trace = Some(self.trace(leaf.value, "trace")?),
                    "preset" => {
                        let names = Preset::ALL.map(Preset::name);
                        let named = self.named(leaf.value, "preset", Preset::named, &names)?;
                        case.preset = Some(named);
                    }
                    "unit" => {
                        let names = Unit::ALL.map(Unit::name);
                        case.unit = Some(self.named(leaf.value, "unit", unit_named, &names)?);
                    }
                    _ => case.values.push(self.placed(self.known(&leaf)?, leaf.value)?),
                }
            }
            Ok(case)
        };
        entries.iter().map(case).collect()
    }

    /// The values of a table of keys.
    fn values(&self, table: &DeTable<'_>, section: &str) -> Result<Vec<Placed>> {
        let Some(value) = table.get(section) else { return Ok(Vec::new()) };
        let leaves = self.leaves(section, value)?;
        leaves.iter().map(|leaf| self.placed(self.known(leaf)?, leaf.value)).collect()
    }

    /// The key that a leaf sets.
    fn known(&self, leaf: &Leaf<'_, '_>) -> Result<&'static crate::config::keys::Key> {
        let refuse = |message| self.error(leaf.start, message);
        match leaf.path.as_str() {
            "unit" => Err(refuse("found unit here, expected units = [..] at the top".to_owned())),
            path => crate::config::layers::known(path).map_err(refuse),
        }
    }
}
