//! Tables: the results of all points in, in whatever order they came to be; two of them out, in the
//! order of the study.
//!
//! Both are read back from the points' own files: a table says what is in the folder, and a sweep
//! that was stopped and goes on writes what one that was not would have written.

use super::outcome::{Outcome, cells, columns, damaged};
use super::plan::Plan;
use super::store::Store;
use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// `points.csv`: a row a point, with its state, its hash and its rates.
///
/// # Errors
/// A table that cannot be written.
pub(super) fn points(
    plan: &Plan,
    store: &Store,
    outcomes: &[Outcome],
    out: impl Write,
) -> Result<()> {
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

/// A table that cannot be written.
fn not_written(store: &Store, name: &str, error: csv::Error) -> Error {
    Error::system(store.root().join(name), io::Error::other(error))
}

/// `sweep.csv`: a row a point and counter.
///
/// # Errors
/// A result that cannot be read, a table that cannot be written.
pub(super) fn counters(plan: &Plan, store: &Store, out: impl Write) -> Result<()> {
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
