//! Tables as HTML: numbers to the right, columns explained, long ones cut with a line that says so.

use super::folder::{Csv, Folder, Kind};
use super::markup::Page;
use super::numbers::Numbers;
use super::{Definition, anchor, meaning, meaning_of};
use std::collections::{BTreeMap, BTreeSet};

/// Rows that a table shows at most.
const ROWS: usize = 2000;

/// Significant digits of what is no integer; the cell's title has them all.
const DIGITS: usize = 6;

/// Significant digits of a ratio below one; above, as many places.
const RATIO: usize = 3;

/// Every `block.counter` of the folder's tables that come onto the page, in the order in which they
/// first come.
pub(super) fn names(folder: &Folder) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut names = Vec::new();
    for csv in &folder.tables {
        let Some([block, counter]) = csv.columns(["block", "counter"]) else { continue };
        for row in &csv.rows {
            let name = format!("{}.{}", row[block], row[counter]);
            if !seen.contains(&name) {
                seen.insert(name.clone());
                names.push(name);
            }
        }
    }
    names
}

/// The numbers of units, side by side.
pub(super) fn numbers(
    page: &mut Page,
    numbers: &Numbers,
    known: &BTreeMap<&str, &Definition>,
    kind: Kind,
) {
    let Numbers { units, numbers } = numbers;
    page.element("section", &[("class", "numbers")], |page| {
        page.texts("h2", &[], "Numbers over the whole run");
        if kind == Kind::Comparison {
            page.texts(
                "p",
                &[("class", "note")],
                "compare.csv, a column a unit, and beside it what it is over the first unit. \
                 Empty where a unit does not have the number. The least, median and greatest \
                 frame are in the file.",
            );
            page.texts("p", &[("class", "note")], meaning::CAVEATS);
        }
        tools(page, true);
        boxed(page, |page| {
            page.element("thead", &[], |page| {
                page.element("tr", &[], |page| {
                    head(page, "number", false, None);
                    head(page, "measure", false, meaning::of_column("*", "measure"));
                    for (at, unit) in units.iter().enumerate() {
                        head(page, unit, true, None);
                        if at > 0 {
                            let first = &units[0];
                            let title = format!("{unit} over {first}");
                            head(page, &format!("/ {first}"), true, Some(&title));
                        }
                    }
                });
            });
            page.element("tbody", &[], |page| {
                for number in numbers {
                    // A unit that lacks the number has no more of it than one that counts none.
                    let none = |v: &String| v.is_empty() || v.parse().is_ok_and(|v: f64| v == 0.0);
                    let zero = number.values.iter().all(none);
                    let class: &[_] = if zero { &[("class", "zero")] } else { &[] };
                    page.element("tr", class, |page| {
                        page.element("td", &[], |page| link(page, &number.name, None, known));
                        page.texts("td", &[], &number.measure);
                        for (at, value) in number.values.iter().enumerate() {
                            cell(page, value, true);
                            if at > 0 {
                                let ratio = ratio(value, &number.values[0]);
                                page.texts("td", &[("class", "number ratio")], &ratio);
                            }
                        }
                    });
                }
            });
        });
    });
}

/// A table as it is in its file.
pub(super) fn csv(page: &mut Page, csv: &Csv, known: &BTreeMap<&str, &Definition>) {
    let numeric: Vec<_> = (0..csv.header.len()).map(|column| is_numeric(csv, column)).collect();
    let counters = csv.columns(["block", "counter"]);
    page.element("section", &[], |page| {
        page.texts("h2", &[], &csv.file);
        let left = csv.rows.len().saturating_sub(ROWS);
        if left > 0 {
            let note = format!("The first {ROWS} rows; {left} more are left out: {}.", csv.file);
            page.texts("p", &[("class", "note left-out")], &note);
        }
        tools(page, false);
        boxed(page, |page| {
            page.element("thead", &[], |page| {
                page.element("tr", &[], |page| {
                    for (name, numeric) in csv.header.iter().zip(&numeric) {
                        head(page, name, *numeric, meaning::of_column(&csv.file, name));
                    }
                });
            });
            page.element("tbody", &[], |page| {
                for row in csv.rows.iter().take(ROWS) {
                    page.element("tr", &[], |page| {
                        for (column, value) in row.iter().enumerate() {
                            match counters {
                                Some([block, counter]) if counter == column => {
                                    let name = format!("{}.{value}", row[block]);
                                    page.element("td", &[], |page| {
                                        link(page, &name, Some(value), known);
                                    });
                                }
                                _ => cell(page, value, numeric[column]),
                            }
                        }
                    });
                }
            });
        });
        columns(page, csv);
    });
}

/// What the columns mean, for those who read without pointing.
fn columns(page: &mut Page, csv: &Csv) {
    page.element("details", &[], |page| {
        page.texts("summary", &[], "columns");
        page.element("dl", &[("class", "columns")], |page| {
            for name in &csv.header {
                let meaning = meaning::of_column(&csv.file, name);
                page.texts("dt", &[], name);
                page.texts("dd", &[], meaning.unwrap_or("not defined in this version of tessim"));
            }
        });
    });
}

/// What filters the table that follows; the script shows it.
fn tools(page: &mut Page, zeros: bool) {
    page.element("div", &[("class", "tools")], |page| {
        page.element("label", &[], |page| {
            page.text("filter ");
            page.open("input", &[("type", "search"), ("class", "filter")]);
        });
        if zeros {
            page.element("label", &[], |page| {
                page.open("input", &[("type", "checkbox"), ("class", "hide"), ("checked", "")]);
                page.text(" hide what is zero in every unit");
            });
        }
        page.texts("span", &[("class", "count")], "");
    });
}

/// A table in a box that scrolls.
fn boxed(page: &mut Page, inside: impl FnOnce(&mut Page)) {
    page.element("div", &[("class", "box")], |page| page.element("table", &[], inside));
}

fn head(page: &mut Page, name: &str, numeric: bool, meaning: Option<&str>) {
    let mut attributes = vec![("scope", "col")];
    attributes.extend(numeric.then_some(("class", "number")));
    attributes.extend(meaning.map(|meaning| ("title", meaning)));
    page.texts("th", &attributes, name);
}

/// A cell; what is no integer is rounded for the eye.
fn cell(page: &mut Page, value: &str, numeric: bool) {
    if !numeric {
        return page.texts("td", &[], value);
    }
    match rounded(value) {
        Some(rounded) => page.element("td", &[("class", "number"), ("title", value)], |page| {
            grouped(page, &rounded);
        }),
        None => page.element("td", &[("class", "number")], |page| grouped(page, value)),
    }
}

/// A number, its digits before the point in threes where they are more than four: the gaps are
/// style, so that what is copied is the number.
fn grouped(page: &mut Page, number: &str) {
    let whole = number.bytes().take_while(u8::is_ascii_digit).count();
    if whole <= 4 {
        return page.text(number);
    }
    let first = (whole - 1) % 3 + 1;
    page.text(&number[..first]);
    for at in (first..whole).step_by(3) {
        page.texts("i", &[], &number[at..at + 3]);
    }
    page.text(&number[whole..]);
}

/// A number's name, which leads to what it means.
fn link(page: &mut Page, name: &str, shown: Option<&str>, known: &BTreeMap<&str, &Definition>) {
    let to = format!("#{}", anchor(name));
    let title = meaning_of(name, known).0.unwrap_or_default();
    page.texts("a", &[("href", &to), ("title", title)], shown.unwrap_or(name));
}

/// Fewer digits, if there are too many.
fn rounded(value: &str) -> Option<String> {
    let digits = value.bytes().filter(u8::is_ascii_digit).count();
    let number: f64 = value.parse().ok()?;
    if !value.contains('.') || digits <= DIGITS || !number.is_finite() {
        return None;
    }
    let magnitude = number.abs().log10().floor();
    let places = (DIGITS as f64 - 1.0 - magnitude).clamp(0.0, 12.0) as usize;
    Some(format!("{number:.places$}"))
}

/// `of` over `per`, or nothing where there is no such ratio.
fn ratio(of: &str, per: &str) -> String {
    match (of.parse::<f64>(), per.parse::<f64>()) {
        (Ok(of), Ok(per)) if per != 0.0 => {
            let ratio = of / per;
            let below =
                if ratio == 0.0 { 0.0 } else { (-1.0 - ratio.abs().log10().floor()).max(0.0) };
            format!("{ratio:.0$}", RATIO + below as usize)
        }
        _ => String::new(),
    }
}

/// Whether a column has numbers and nothing else.
fn is_numeric(csv: &Csv, column: usize) -> bool {
    let mut cells = csv.rows.iter().map(|row| row[column].as_str()).filter(|cell| !cell.is_empty());
    let Some(first) = cells.next() else { return false };
    [first].into_iter().chain(cells).all(|cell| cell.parse::<f64>().is_ok_and(f64::is_finite))
}
