//! The rows as text, as CSV and as a picture.

use super::plot::{Chart, Names, Series};
use super::{Row, TOLERANCE, Way, plot};
use crate::error::Result;
use crate::study::esc::nano;
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `error.csv`: distances in 1e-9 world units and 1e-9 pixels, `threshold_nano` in
/// 1e-9 of its unit, empty where a way has none.
pub const CSV_HEADER: [&str; 10] = [
    "way",
    "segments",
    "target",
    "triangles",
    "threshold_nano",
    "samples",
    "largest_nano",
    "mean_nano",
    "largest_nanopixels",
    "mean_nanopixels",
];

/// `error.csv`: integers only, beside the names of ways.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for row in rows {
        let name = row.way.name().replace(", ", "_").replace(' ', "_");
        let threshold = row.threshold.map_or(String::new(), |t| nano(t).to_string());
        let d = &row.deviation;
        let distances = [d.largest, d.mean(), d.largest_pixels, d.mean_pixels()].map(nano);
        let distances = distances.map(|n| n.to_string()).join(",");
        let Row { segments, target, triangles, .. } = row;
        let samples = d.samples;
        writeln!(text, "{name},{segments},{target},{triangles},{threshold},{samples},{distances}")
            .expect("a String takes everything");
    }
    text
}

/// The tables for people, in Markdown: one a target.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for rows in rows.chunk_by(|a, b| a.segments == b.segments) {
        let (n, target) = (rows[0].segments, rows[0].target);
        writeln!(text, "as many triangles as grids of {n} x {n}: {target}\n")
            .expect("a String takes everything");
        let columns = [
            "way",
            "threshold",
            "triangles",
            "largest, 1e-3 units",
            "mean",
            "largest, pixels",
            "mean, pixels",
        ];
        let cells: Vec<_> = rows.iter().map(cells).collect();
        text += &markdown::table(&columns, 1, &cells);
        text += "\n";
    }
    writeln!(
        text,
        "distance of dense samples of the true surface from the nearest point of their patch's \
         triangles\n*: the count steps over the target, and is off by more than {}.{} %",
        TOLERANCE / 10,
        TOLERANCE % 10
    )
    .expect("a String takes everything");
    text
}

fn cells(row: &Row) -> [String; 7] {
    let star = if row.is_near() { "" } else { "*" };
    let d = &row.deviation;
    [
        row.way.name(),
        row.threshold.map_or("-".to_owned(), |t| format!("{t:.5}")),
        format!("{star}{}", row.triangles),
        format!("{:.3}", 1e3 * d.largest),
        format!("{:.4}", 1e3 * d.mean()),
        format!("{:.3}", d.largest_pixels),
        format!("{:.4}", d.mean_pixels()),
    ]
}

/// `error.svg`: the largest distance in the world over the triangles made.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg(rows: &[Row]) -> Result<String> {
    draw(rows, "error.svg", "Largest distance from the true surface", |row| row.deviation.largest)
}

/// `mean.svg`: the mean distance in the world over the triangles made.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg_of_means(rows: &[Row]) -> Result<String> {
    draw(rows, "mean.svg", "Mean distance from the true surface", |row| row.deviation.mean())
}

fn draw(rows: &[Row], file: &str, title: &str, value: impl Fn(&Row) -> f64) -> Result<String> {
    let series = Way::ALL.iter().map(|&way| {
        let of = rows.iter().filter(|row| row.way == way);
        Series { name: way.name(), points: of.map(|r| (r.triangles as f64, value(r))).collect() }
    });
    plot::svg(&Chart {
        file,
        title,
        x: "triangles",
        y: "world units",
        ticks: Vec::new(),
        log: true,
        names: Names::LowerLeft,
        series: series.collect(),
        levels: Vec::new(),
        marks: Vec::new(),
    })
}
