//! Tables: the results of all points in, in whatever order they came to be; two of them and a
//! picture out, in the order of the study.
//!
//! Both are read back from the points' own files: a table says what is in the folder, and a sweep
//! that was stopped and goes on writes what one that was not would have written.

use super::picture;
use super::plan::{Plan, Point};
use super::store::{Claim, State, Store};
use crate::error::{Error, Result};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// The file of the study.
pub(super) const STUDY: &str = "study.toml";

/// Writes the study and its tables, and puts them in their places.
///
/// # Errors
/// A result that cannot be read, a table that cannot be written.
///
/// # Panics
/// When a point is not settled.
pub(super) fn publish(plan: &Plan, store: &Store) -> Result<()> {
    let claim = store.claim_tables()?;
    study(plan, &claim)?;
    let outcomes = outcomes(plan, store)?;
    claim.draft("points.csv", |file| points(plan, store, &outcomes, file))?;
    let picture = picture::svg(&columns(plan), &outcomes)?;
    claim.draft(picture::FILE, |file| {
        file.write_all(picture.as_bytes()).map_err(|error| Error::system(picture::FILE, error))
    })?;
    claim.draft("sweep.csv", |file| counters(plan, store, file))?;
    #[cfg(feature = "parquet")]
    claim.draft("sweep.parquet", |file| super::parquet::write(plan, store, file))?;
    let parquet: &[_] = if cfg!(feature = "parquet") { &["sweep.parquet"] } else { &[] };
    // The last says that all are there.
    claim.publish(&[&[STUDY, "points.csv", picture::FILE], parquet, &["sweep.csv"]].concat())
}

/// Writes the study as it was read.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn study(plan: &Plan, claim: &Claim) -> Result<()> {
    claim.draft(STUDY, |file| {
        let written = file.write_all(plan.study.text.as_bytes());
        written.map_err(|error| Error::system(STUDY, error))
    })
}

/// The columns that set a point apart.
pub(super) fn columns(plan: &Plan) -> Vec<&str> {
    ["point", "trace", "preset", "unit"].into_iter().chain(plan.keys.iter().copied()).collect()
}

fn cells(plan: &Plan, number: usize, point: &Point) -> Vec<String> {
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
    reason: Option<String>,
    hash: String,
    /// Names and values of its rates, empty where there was nothing to divide by.
    pub(super) rates: Vec<(String, String)>,
}

/// What has become of each point, in the study's order.
fn outcomes(plan: &Plan, store: &Store) -> Result<Vec<Outcome>> {
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

/// `points.csv`: a row a point, with its state, its hash and its rates.
fn points(plan: &Plan, store: &Store, outcomes: &[Outcome], out: impl Write) -> Result<()> {
    let rates = outcomes.iter().flat_map(|outcome| &outcome.rates);
    let names: BTreeSet<_> = rates.map(|(name, _)| name.as_str()).collect();
    let failed = |error| not_written(store, "points.csv", error);
    let mut csv = csv::Writer::from_writer(out);
    let head = columns(plan).into_iter().chain(["state", "reason", "hash"]);
    csv.write_record(head.chain(names.iter().copied())).map_err(failed)?;
    for outcome in outcomes {
        let state = if outcome.reason.is_some() { "failed" } else { "completed" };
        let said = [state, outcome.reason.as_deref().unwrap_or_default(), &outcome.hash];
        let rates = names.iter().map(|name| outcome.rate(name).unwrap_or_default());
        let cells = outcome.cells.iter().map(String::as_str).chain(said);
        csv.write_record(cells.chain(rates)).map_err(failed)?;
    }
    csv.flush().map_err(|error| failed(error.into()))
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

/// A table that cannot be written.
fn not_written(store: &Store, name: &str, error: csv::Error) -> Error {
    Error::system(store.root().join(name), io::Error::other(error))
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

/// `sweep.csv`: a row a point and counter.
fn counters(plan: &Plan, store: &Store, out: impl Write) -> Result<()> {
    let failed = |error| not_written(store, "sweep.csv", error);
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(columns(plan).into_iter().chain(OF_A_COUNTER)).map_err(failed)?;
    each_counter(plan, store, &mut |row| csv.write_record(row).map_err(failed))?;
    csv.flush().map_err(|error| failed(error.into()))
}

/// The columns of a counter, beside those of its point.
pub(super) const OF_A_COUNTER: [&str; 4] = ["block", "counter", "value", "measure"];

/// Every counter of every point that has a result, over all of its frames: the cells of a row, of
/// [`columns`] and [`OF_A_COUNTER`].
///
/// # Errors
/// A result that cannot be read; those of `row`.
pub(super) fn each_counter(
    plan: &Plan,
    store: &Store,
    row: &mut dyn FnMut(&[&str]) -> Result<()>,
) -> Result<()> {
    for (number, point) in plan.points.iter().enumerate() {
        let Ok(hash) = &point.hash else { continue };
        let folder = store.point(hash);
        if !folder.is_dir() {
            continue;
        }
        let cells = cells(plan, number, point);
        for total in totals(&folder.join("counters.csv"))? {
            let Total { block, counter, value, measure } = total;
            let value = value.to_string();
            let of_it = [&block, &counter, &value, &measure];
            row(&cells.iter().chain(of_it).map(String::as_str).collect::<Vec<_>>())?;
        }
    }
    Ok(())
}

/// A counter over all frames.
#[derive(Debug, PartialEq)]
struct Total {
    block: String,
    counter: String,
    value: u64,
    measure: String,
}

/// The counters of a run, frames added up, peaks by their maximum, in the file's order.
fn totals(path: &Path) -> Result<Vec<Total>> {
    let wrong = |error: csv::Error| damaged(path, &error.to_string());
    let bytes = fs::read(path).map_err(|error| Error::system(path, error))?;
    let mut csv = csv::Reader::from_reader(bytes.as_slice());
    let mut totals: Vec<Total> = Vec::new();
    let (mut frame, mut at) = (String::new(), 0);
    for record in csv.records() {
        let record = record.map_err(wrong)?;
        let fields: Vec<&str> = record.iter().collect();
        let [of, _, block, counter, value, measure] = fields[..] else {
            return Err(damaged(path, "found a row without its six fields"));
        };
        let value = value.parse::<u64>();
        let value = value.map_err(|_| damaged(path, "found a value that is no integer"))?;
        if frame != of {
            (frame, at) = (of.to_owned(), 0);
        }
        // Every frame has the same rows in the same order.
        if at == totals.len() {
            let [block, counter, measure] = [block, counter, measure].map(str::to_owned);
            totals.push(Total { block, counter, value, measure });
        } else {
            let total = &mut totals[at];
            if (total.block.as_str(), total.counter.as_str()) != (block, counter) {
                return Err(damaged(path, "found frames with different rows"));
            }
            let is_peak = counter.ends_with(".peak");
            total.value = if is_peak { total.value.max(value) } else { total.value + value };
        }
        at += 1;
    }
    Ok(totals)
}

/// A result that is not as we wrote it.
fn damaged(path: &Path, what: &str) -> Error {
    let place = path.parent().unwrap_or(path).display();
    let file = path.display();
    Error::Usage(format!(
        "{file}: {what}, expected what a run writes; remove {place} to compute it anew"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_added_up_and_peaks_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("counters.csv");
        let read = |rows: &str| {
            fs::write(&path, format!("frame,unit,block,counter,value,measure\n{rows}")).unwrap();
            totals(&path)
        };
        let rows = "0,hybrid,trace,draws,3,count\n0,hybrid,clip,fifo.peak,9,entries\n\
                    1,hybrid,trace,draws,4,count\n1,hybrid,clip,fifo.peak,2,entries\n";
        let found = read(rows).unwrap();
        let found: Vec<_> = found.iter().map(|t| (t.counter.as_str(), t.value)).collect();
        assert_eq!(found, [("draws", 7), ("fifo.peak", 9)]);
        assert_eq!(read("").unwrap(), []);
        for (rows, says) in [
            ("0,hybrid,trace,draws,-3,count\n", "no integer"),
            ("0,hybrid,trace,draws,3\n", "expected what a run writes"),
            ("0,u,trace,draws,3,count\n1,u,clip,draws,3,count\n", "different rows"),
        ] {
            let error = read(rows).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
            assert!(error.to_string().contains("to compute it anew"), "{error}");
        }
    }
}
