//! A result folder as a page: its tables, plots, pictures and what they are of, in one HTML file
//! that asks nobody for anything.
//!
//! In come a [`Folder`] and what counters mean, which whoever knows the units says; out comes the
//! text of the page. The same folder gives the same bytes. Without its script the page shows
//! everything but the plot over the frames; the script sorts, filters and draws.

mod folder;
mod markup;
mod meaning;
mod numbers;
mod table;

pub use folder::{Csv, Folder, Image, Kind};
pub use meaning::CAVEATS;

use crate::error::Result;
use markup::Page;
use serde_json::Value;
use std::collections::BTreeMap;

/// What there is to say of a counter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// `block.counter`.
    pub name: String,
    /// What it is a number of.
    pub measure: String,
    /// In a sentence.
    pub meaning: String,
    /// Its conservation law, or nothing.
    pub law: String,
}

/// The page of a folder, with the definitions of the counters that occur in it.
///
/// # Errors
/// [`Error::Input`](crate::error::Error::Input) when a table lacks a column that its kind has.
pub fn html(folder: &Folder, definitions: &[Definition]) -> Result<String> {
    let numbers = numbers::of(folder)?;
    let frames = numbers::frames(folder)?;
    let known: BTreeMap<_, _> = definitions.iter().map(|d| (d.name.as_str(), d)).collect();
    let mut page = Page::default();
    page.element("html", &[("lang", "en")], |page| {
        page.element("head", &[], |page| {
            page.open("meta", &[("charset", "utf-8")]);
            page.open(
                "meta",
                &[("name", "viewport"), ("content", "width=device-width, initial-scale=1")],
            );
            // Nothing comes from anywhere, whatever is on the page.
            let policy = "default-src 'none'; img-src data:; \
                          style-src 'unsafe-inline'; script-src 'unsafe-inline'";
            page.open("meta", &[("http-equiv", "Content-Security-Policy"), ("content", policy)]);
            page.texts("title", &[], &format!("{}: {}", folder.name, title(folder.kind)));
            page.code("style", include_str!("page/page.css"));
        });
        page.element("body", &[], |page| {
            heading(page, folder);
            if let Some(numbers) = &numbers {
                table::numbers(page, numbers, &known, folder.kind);
            }
            images(page, folder);
            if let Some(frames) = &frames {
                over_frames(page, frames);
            }
            for csv in &folder.tables {
                // The pivoted one says it all; frames are drawn.
                if !matches!(csv.file.as_str(), "compare.csv" | "frames.csv") {
                    table::csv(page, csv, &known);
                }
            }
            define(page, &table::names(folder), &known);
            texts(page, folder);
            page.code("script", include_str!("page/page.js"));
        });
    });
    Ok(page.finish())
}

/// What a kind of result is called.
fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Comparison => "comparison of units",
        Kind::Precision => "precision of formats",
        Kind::Sweep => "sweep",
        Kind::Run => "run",
    }
}

/// What the result is of, and where on the page things are.
fn heading(page: &mut Page, folder: &Folder) {
    page.element("header", &[], |page| {
        page.texts("h1", &[], &folder.name);
        page.texts("p", &[("class", "kind")], title(folder.kind));
        page.element("dl", &[("class", "facts")], |page| {
            let said = folder.summaries.iter().flat_map(|summary| facts(summary, folder.kind));
            for (name, value) in said.chain(of_sweep(folder)).filter(|(_, value)| !value.is_empty())
            {
                page.texts("dt", &[], &name);
                page.texts("dd", &[], &value);
            }
        });
    });
}

/// What a summary says of its origin. That of a sweep's point stands for all of the same trace, and
/// so says nothing of its own unit and frames.
fn facts(summary: &Value, kind: Kind) -> Vec<(String, String)> {
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        other => other.to_string(),
    };
    let mut facts: Vec<_> = ["title", "source", "licence", "sha256"]
        .map(|key| (if key == "title" { "trace" } else { key }, text(&summary["trace"][key])))
        .map(|(key, value)| (key.to_owned(), value))
        .into();
    for file in summary["trace"]["files"].as_array().into_iter().flatten() {
        facts.push((format!("file {}", text(&file["name"])), text(&file["sha256"])));
    }
    facts.push(("tessim".to_owned(), text(&summary["tessim"])));
    if kind == Kind::Sweep {
        return facts;
    }
    let units = summary["units"].as_array().into_iter().flatten();
    let units: Vec<_> = units.map(|unit| text(&unit["unit"])).collect();
    facts.push(("units".to_owned(), units.join(", ")));
    for key in ["unit", "engine", "frames", "grid", "measured", "max_error_px"] {
        facts.push((key.to_owned(), text(&summary[key])));
    }
    facts
}

/// What the points of a sweep have come to, and the units that they are of.
fn of_sweep(folder: &Folder) -> Vec<(String, String)> {
    let points = &folder.tables[0];
    let Some([state, unit]) =
        points.columns(["state", "unit"]).filter(|_| folder.kind == Kind::Sweep)
    else {
        return Vec::new();
    };
    let mut units: Vec<_> = points.rows.iter().map(|row| row[unit].as_str()).collect();
    units.sort_unstable();
    units.dedup();
    let failed = points.rows.iter().filter(|row| row[state] == "failed").count();
    let points = format!("{} ({failed} failed)", points.rows.len());
    [("units", units.join(", ")), ("points", points)].map(|(k, v)| (k.to_owned(), v)).into()
}

fn images(page: &mut Page, folder: &Folder) {
    page.element("div", &[("class", "pictures")], |page| {
        for image in &folder.images {
            page.element("section", &[("class", "picture")], |page| {
                page.texts("h2", &[], &image.file);
                page.element("div", &[("class", "box")], |page| {
                    page.open("img", &[("src", &image.address), ("alt", &image.file)]);
                });
            });
        }
    });
}

/// The plot that the script draws.
fn over_frames(page: &mut Page, frames: &numbers::Frames) {
    if frames.count < 2 {
        return;
    }
    page.element("section", &[("class", "frames")], |page| {
        page.texts("h2", &[], "Over the frames");
        page.element("div", &[("class", "tools")], |page| {
            page.element("label", &[], |page| {
                page.text("number ");
                page.element("select", &[], |_| ());
            });
        });
        page.texts("div", &[("class", "box plot")], "The page's script draws here.");
        page.texts(
            "p",
            &[("class", "note")],
            "Numbers that are zero in every frame of every unit are not in the list.",
        );
        if frames.left_out > 0 {
            let note = format!("{} numbers are left out for size.", frames.left_out);
            page.texts("p", &[("class", "note")], &note);
        }
        page.data("data", &frames.data);
    });
}

/// What the counters of the page mean.
fn define(page: &mut Page, names: &[String], known: &BTreeMap<&str, &Definition>) {
    if names.is_empty() {
        return;
    }
    page.element("section", &[("id", "definitions")], |page| {
        page.texts("h2", &[], "What the numbers are");
        page.element("dl", &[("class", "definitions")], |page| {
            for name in names {
                let (meaning, law) = meaning_of(name, known);
                page.element("dt", &[("id", &anchor(name))], |page| page.texts("code", &[], name));
                page.element("dd", &[], |page| {
                    page.text(meaning.unwrap_or("not defined in this version of tessim"));
                    if !law.is_empty() {
                        page.texts("p", &[("class", "law")], &format!("law: {law}"));
                    }
                });
            }
        });
    });
}

/// What a number means, if that is known, and its law.
fn meaning_of<'a>(
    name: &str,
    known: &BTreeMap<&str, &'a Definition>,
) -> (Option<&'a str>, &'a str) {
    match known.get(name) {
        Some(definition) => (Some(&definition.meaning), &definition.law),
        None => (meaning::of(name), ""),
    }
}

/// Where on the page a number is defined.
fn anchor(name: &str) -> String {
    format!("number-{name}")
}

fn texts(page: &mut Page, folder: &Folder) {
    for (file, text) in &folder.texts {
        page.element("section", &[], |page| {
            page.element("details", &[], |page| {
                page.element("summary", &[], |page| page.texts("b", &[], file));
                page.element("pre", &[("class", "box")], |page| page.text(text));
            });
        });
    }
}
