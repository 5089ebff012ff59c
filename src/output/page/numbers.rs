//! Numbers of units: rows of a CSV in, one a unit and number; out, one row a number with a column a
//! unit, and what a plot over the frames is drawn from.

use super::folder::{Csv, Folder, Kind};
use crate::error::{Error, Place, Result};
use indexmap::IndexSet;
use serde_json::{Value, json};
use std::collections::HashMap;

/// What a page holds of frames at most, in bytes of JSON.
const FRAMES: usize = 2 << 20;

/// A number of every unit.
pub(super) struct Number {
    /// `block.counter`.
    pub(super) name: String,
    pub(super) measure: String,
    /// By unit, as the file has it; empty where the unit does not count it.
    pub(super) values: Vec<String>,
}

/// Numbers of units over the whole run.
pub(super) struct Numbers {
    pub(super) units: Vec<String>,
    pub(super) numbers: Vec<Number>,
}

/// Numbers over the frames.
pub(super) struct Frames {
    /// How many frames there are.
    pub(super) count: usize,
    /// For the page's script.
    pub(super) data: Value,
    /// How many numbers the page has no room for.
    pub(super) left_out: usize,
}

/// The numbers of a comparison or of a run.
///
/// # Errors
/// [`Error::Input`] when a column is missing.
pub(super) fn of(folder: &Folder) -> Result<Option<Numbers>> {
    match folder.kind {
        Kind::Comparison => pivot(&folder.tables[0]).map(Some),
        Kind::Run => {
            let mut numbers = pivot(&folder.tables[0])?;
            // The file has frames; what they come to is in the summary.
            let totals = &folder.summaries[0]["totals"];
            for number in &mut numbers.numbers {
                number.values = vec![
                    totals[&number.name]
                        .as_u64()
                        .map_or_else(String::new, |value| value.to_string()),
                ];
            }
            Ok(Some(numbers))
        }
        Kind::Precision | Kind::Sweep => Ok(None),
    }
}

/// One row a number, blocks in the order in which they first come.
fn pivot(csv: &Csv) -> Result<Numbers> {
    let [unit, block, counter, value, measure] =
        columns(csv, ["unit", "block", "counter", "value", "measure"])?;
    let (mut units, mut blocks) = (IndexSet::new(), IndexSet::new());
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut numbers: Vec<(usize, Number)> = Vec::new();
    for row in &csv.rows {
        let unit = place_of(&mut units, &row[unit]);
        let of = place_of(&mut blocks, &row[block]);
        let name = format!("{}.{}", row[block], row[counter]);
        let place = *places.entry(name).or_insert_with_key(|name| {
            let (name, measure) = (name.clone(), row[measure].clone());
            numbers.push((of, Number { name, measure, values: Vec::new() }));
            numbers.len() - 1
        });
        let values = &mut numbers[place].1.values;
        values.resize(values.len().max(unit + 1), String::new());
        values[unit].clone_from(&row[value]);
    }
    numbers.sort_by_key(|(block, _)| *block); // keeps the order within a block
    let whole = |(_, mut number): (usize, Number)| {
        number.values.resize(units.len(), String::new());
        number
    };
    let numbers = numbers.into_iter().map(whole).collect();
    Ok(Numbers { units: units.into_iter().collect(), numbers })
}

/// Where `item` is in `list`, at whose end it is put when it is not there.
fn place_of(list: &mut IndexSet<String>, item: &str) -> usize {
    list.get_index_of(item).unwrap_or_else(|| list.insert_full(item.to_owned()).0)
}

/// The numbers over the frames, without those that are zero throughout.
///
/// # Errors
/// [`Error::Input`] when a column is missing.
pub(super) fn frames(folder: &Folder) -> Result<Option<Frames>> {
    let file = if folder.kind == Kind::Run { "counters.csv" } else { "frames.csv" };
    let Some(csv) = folder.table(file) else { return Ok(None) };
    let [unit, frame, block, counter, value] =
        columns(csv, ["unit", "frame", "block", "counter", "value"])?;
    let (mut units, mut frames) = (IndexSet::new(), IndexSet::new());
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut series: Vec<(String, Vec<Vec<Value>>)> = Vec::new();
    for row in &csv.rows {
        let unit = place_of(&mut units, &row[unit]);
        let frame = place_of(&mut frames, &row[frame]);
        let name = format!("{}.{}", row[block], row[counter]);
        let place = *places.entry(name).or_insert_with_key(|name| {
            series.push((name.clone(), Vec::new()));
            series.len() - 1
        });
        put(&mut series[place].1, unit, Vec::new(), |values| {
            put(values, frame, Value::Null, |cell| *cell = number(&row[value]));
        });
    }
    series
        .retain(|(_, units)| units.iter().flatten().any(|v| v.as_f64().is_some_and(|v| v != 0.0)));
    let (mut room, mut left_out) = (FRAMES, 0);
    let mut kept = Vec::new();
    for (name, values) in series {
        let one = json!({ "name": name, "values": values });
        let size = one.to_string().len() + 1;
        if size <= room {
            room -= size;
            kept.push(one);
        } else {
            left_out += 1;
        }
    }
    let count = frames.len();
    let [units, frames] = [units, frames].map(|names| names.into_iter().collect::<Value>());
    let data = json!({ "units": units, "frames": frames, "numbers": kept });
    Ok(Some(Frames { count, data, left_out }))
}

/// Changes the place `at` of `list`, which grows as far as that.
fn put<T: Clone>(list: &mut Vec<T>, at: usize, empty: T, change: impl FnOnce(&mut T)) {
    if list.len() <= at {
        list.resize(at + 1, empty);
    }
    change(&mut list[at]);
}

/// A number as JSON has it; null for what is none.
fn number(text: &str) -> Value {
    let whole = text.parse::<u64>().map(Value::from);
    whole.or_else(|_| text.parse::<f64>().map(Value::from)).unwrap_or(Value::Null)
}

fn columns<const N: usize>(csv: &Csv, names: [&str; N]) -> Result<[usize; N]> {
    csv.columns(names).ok_or_else(|| Error::Input {
        file: csv.path.display().to_string(),
        place: Place::Line { line: 1, column: 0 },
        message: format!("found {}; expected columns {}", csv.header.join(","), names.join(",")),
    })
}
