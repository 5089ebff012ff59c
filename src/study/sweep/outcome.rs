//! Outcomes: the points of a study in; out, what has become of each, read back from its own files.

use super::plan::{Plan, Point};
use super::store::{State, Store};
use crate::error::{Error, Result};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The columns that set a point apart.
pub(super) fn columns(plan: &Plan) -> Vec<&str> {
    ["point", "trace", "preset", "unit"].into_iter().chain(plan.keys.iter().copied()).collect()
}

/// A point's cells of [`columns`].
pub(super) fn cells(plan: &Plan, number: usize, point: &Point) -> Vec<String> {
    let trace = plan.traces[point.trace].name.clone();
    let (preset, unit) = (point.preset.name().to_owned(), point.unit.name().to_owned());
    let named = [number.to_string(), trace, preset, unit];
    named.into_iter().chain(point.values.iter().cloned()).collect()
}

/// What has become of a point.
pub(super) struct Outcome {
    /// Its cells of [`columns`].
    pub(super) cells: Vec<String>,
    /// Why it failed, if it did.
    pub(super) reason: Option<String>,
    /// Its hash; empty where there is no such configuration.
    pub(super) hash: String,
    /// Names and values of its rates, empty where there was nothing to divide by.
    pub(super) rates: Vec<(String, String)>,
}

/// What has become of each point, in the study's order.
///
/// # Errors
/// A result that cannot be read.
///
/// # Panics
/// When a point is not settled.
pub(super) fn outcomes(plan: &Plan, store: &Store) -> Result<Vec<Outcome>> {
    let outcome = |(number, point): (usize, &Point)| {
        let cells = cells(plan, number, point);
        let hash = point.hash.clone().unwrap_or_default();
        let state = match &point.hash {
            Ok(hash) => store.settled(hash)?.expect("tables are of settled points"),
            Err(reason) => State::Failed(reason.clone()),
        };
        let (reason, rates) = match state {
            State::Failed(reason) => (Some(reason), Vec::new()),
            _ => (None, rates(&store.point(&hash).join("summary.json"))?),
        };
        Ok(Outcome { cells, reason, hash, rates })
    };
    plan.points.iter().enumerate().map(outcome).collect()
}

impl Outcome {
    /// A point for tests of what is made of points.
    #[cfg(test)]
    pub(super) fn completed(cells: Vec<String>, rates: Vec<(String, String)>) -> Self {
        Self { cells, reason: None, hash: String::new(), rates }
    }

    /// A rate of the point, as its summary has it.
    pub(super) fn rate(&self, name: &str) -> Option<&str> {
        let found = self.rates.iter().find(|(rate, _)| rate == name);
        found.map(|(_, value)| value.as_str())
    }
}

/// The rates of a summary: empty where there was nothing to divide by.
fn rates(path: &Path) -> Result<Vec<(String, String)>> {
    let bytes = fs::read(path).map_err(|error| Error::system(path, error))?;
    let summary: Value =
        serde_json::from_slice(&bytes).map_err(|error| damaged(path, &error.to_string()))?;
    let rates = summary["rates"].as_object();
    let rates = rates.ok_or_else(|| damaged(path, "found no rates"))?;
    let text = |rate: &Value| match &rate["value"] {
        Value::Null => String::new(),
        value => value.to_string(),
    };
    Ok(rates.iter().map(|(name, rate)| (name.clone(), text(rate))).collect())
}

/// A result that is not as we wrote it.
pub(super) fn damaged(path: &Path, what: &str) -> Error {
    let place = path.parent().unwrap_or(path).display();
    let file = path.display();
    Error::Usage(format!(
        "{file}: {what}, expected what a run writes; remove {place} to compute it anew"
    ))
}
