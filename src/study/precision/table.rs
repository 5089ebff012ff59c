//! The study as text and as CSV.

use super::{Formats, Row, Study};
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `precision.csv`: widths in bits, area in full-adder cells, distances in 1e-9
/// pixels; `on_front` and `serves` are 0 or 1. docs/precision.md defines them all.
pub const CSV_HEADER: [&str; 44] = [
    "unit",
    "width",
    "guard",
    "reciprocal",
    "subpixel",
    "rounding",
    "overflow",
    "position_bits",
    "product_bits",
    "accumulator_0_bits",
    "accumulator_1_bits",
    "accumulator_2_bits",
    "accumulator_3_bits",
    "parameter_bits",
    "reciprocal_bits",
    "screen_bits",
    "datapath_bits",
    "area_cells",
    "vertices",
    "unplaced",
    "to_clipper",
    "largest_nanopixels",
    "rms_nanopixels",
    "largest_exact_nanopixels",
    "rms_exact_nanopixels",
    "surface_samples",
    "surface_largest_nanopixels",
    "surface_mean_nanopixels",
    "boundary_vertices",
    "cracks",
    "triangles",
    "flipped",
    "flat",
    "equal_corners",
    "patches",
    "patches_lost",
    "patches_kept",
    "lists",
    "lists_differing",
    "points_saturated",
    "evaluate_overflows",
    "level_overflows",
    "on_front",
    "serves",
];

/// `precision.csv`: a row a point, integers only beside names.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for (k, row) in study.rows.iter().enumerate() {
        let on_front = u64::from(study.front.contains(&k));
        let serves = u64::from(row.measured.serves(study.max_error));
        let f = &row.formats;
        let names = [f.rounding_name(), f.overflow_name()].join(",");
        let formats = [f.width, f.guard, f.reciprocal, f.subpixel].map(|n| n.to_string());
        let numbers = numbers(row).into_iter().chain([on_front, serves]);
        let numbers: Vec<String> = numbers.map(|n| n.to_string()).collect();
        let (unit, formats) = (study.base.unit.name(), formats.join(","));
        writeln!(text, "{unit},{formats},{names},{}", numbers.join(","))
            .expect("a String takes everything");
    }
    text
}

/// What stands between the names and the verdicts.
fn numbers(row: &Row) -> Vec<u64> {
    let (w, m) = (&row.widths, &row.measured);
    let nano = |pixels: f64| (pixels * 1e9).round() as u64;
    let [d0, d1, d2, d3] = w.accumulators;
    let widths = [w.position, w.product, d0, d1, d2, d3, w.parameter, w.reciprocal, w.screen];
    let mut numbers: Vec<u64> = widths.map(u64::from).to_vec();
    numbers.extend([w.datapath().into(), row.area, m.reported.count(), m.unplaced, m.to_clipper]);
    let errors = [m.reported.largest, m.reported.rms(), m.exact.largest, m.exact.rms()];
    numbers.extend(errors.map(nano));
    numbers.push(m.surface.samples);
    numbers.extend([m.surface.largest_pixels, m.surface.mean_pixels()].map(nano));
    numbers.extend([m.boundary, m.cracks, m.triangles, m.flipped, m.flat, m.equal_corners]);
    numbers.extend([m.patches, m.lost, m.kept, m.lists, m.lists_differing]);
    numbers.extend([m.saturated, m.evaluate_overflows, m.level_overflows]);
    numbers
}

/// The study for people, in Markdown: each axis by itself, the front, the narrowest.
#[must_use]
pub fn text(study: &Study, title: &str) -> String {
    let mut text = String::new();
    let unit = study.base.unit.name();
    let (measured, grid, corners) = (study.rows.len(), study.grid, study.corner_runs);
    let mut say = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    say(&format!("{title}: unit {unit}, {measured} of {grid} points measured, pixels\n"));
    if corners > 0 {
        say(&format!(
            "(the rest is ruled out: {corners} runs of corners, and the order of area)\n"
        ));
    } else {
        say("each format by itself, the others at their widest\n");
        say(&markdown::table(&COLUMNS, 2, &by_itself(&study.rows)));
    }
    let among = if measured < grid { "no other of those measured" } else { "no other point" };
    say(&format!("the front: {among} is as good in bits, area and error\n"));
    let front: Vec<_> = study.front.iter().map(|&k| point(&study.rows[k])).collect();
    say(&markdown::table(&POINT, 0, &front));
    match study.narrowest {
        Some(k) => {
            say(&format!("the narrowest formats within {} px\n", study.max_error));
            say(&markdown::table(&POINT, 0, &[point(&study.rows[k])]));
        }
        None => say(&format!("no point of the grid stays within {} px\n", study.max_error)),
    }
    say(NOTE);
    text
}

const NOTE: &str = "largest, rms: positions on the screen from the true surface in f64; exact: \
    where k / level would put them.\nbits: position, accumulators, parameter, reciprocal and \
    screen coordinate of one coordinate.\narea: an estimate in full-adder cells, an adder of w \
    bits w, a multiplier of v by w bits v w; without registers and control.";

const COLUMNS: [&str; 13] = [
    "format",
    "value",
    "largest",
    "rms",
    "largest, exact",
    "surface to triangles",
    "boundary",
    "cracks",
    "flipped",
    "flat",
    "lost / kept",
    "lists differing",
    "overflows",
];

/// The axes: name, value, and the formats without it.
type Axis = (&'static str, fn(&Formats) -> String, fn(&Formats, &Formats) -> bool);

const AXES: [Axis; 6] = [
    ("position.width", |f| f.width.to_string(), |a, b| Formats { width: b.width, ..*a } == *b),
    ("evaluate.guard", |f| f.guard.to_string(), |a, b| Formats { guard: b.guard, ..*a } == *b),
    (
        "place.reciprocal_bits",
        |f| f.reciprocal.to_string(),
        |a, b| Formats { reciprocal: b.reciprocal, ..*a } == *b,
    ),
    (
        "emit.subpixel_bits",
        |f| f.subpixel.to_string(),
        |a, b| Formats { subpixel: b.subpixel, ..*a } == *b,
    ),
    (
        "rounding",
        |f| f.rounding_name().to_owned(),
        |a, b| Formats { rounding: b.rounding, ..*a } == *b,
    ),
    (
        "position.overflow",
        |f| f.overflow_name().to_owned(),
        |a, b| Formats { overflow: b.overflow, ..*a } == *b,
    ),
];

fn by_itself(rows: &[Row]) -> Vec<[String; 13]> {
    // Of the widest, the first: modes as they were given.
    let widest = rows.iter().rev().max_by_key(|row| row.widths.datapath());
    let Some(widest) = widest.map(|row| row.formats) else { return Vec::new() };
    let mut cells = Vec::new();
    for (name, value, alike) in AXES {
        let of: Vec<&Row> = rows.iter().filter(|row| alike(&row.formats, &widest)).collect();
        if of.len() > 1 {
            cells.extend(of.into_iter().map(|row| line(name, value(&row.formats), row)));
        }
    }
    if cells.is_empty() {
        cells.extend(rows.iter().map(|row| line("-", "-".to_owned(), row)));
    }
    cells
}

fn line(name: &str, value: String, row: &Row) -> [String; 13] {
    let m = &row.measured;
    let pixels = |value: f64| format!("{value:.4}");
    let overflows = m.saturated + m.evaluate_overflows + m.level_overflows;
    [
        name.to_owned(),
        value,
        pixels(m.reported.largest),
        pixels(m.reported.rms()),
        pixels(m.exact.largest),
        pixels(m.surface.largest_pixels),
        m.boundary.to_string(),
        m.cracks.to_string(),
        m.flipped.to_string(),
        m.flat.to_string(),
        format!("{} / {}", m.lost, m.kept),
        format!("{} of {}", m.lists_differing, m.lists),
        overflows.to_string(),
    ]
}

const POINT: [&str; 11] = [
    "width",
    "guard",
    "reciprocal",
    "sub-pixel",
    "rounding",
    "overflow",
    "bits",
    "area",
    "largest",
    "largest, exact",
    "rms",
];

fn point(row: &Row) -> [String; 11] {
    let (f, m) = (&row.formats, &row.measured);
    let pixels = |value: f64| format!("{value:.4}");
    [
        f.width.to_string(),
        f.guard.to_string(),
        f.reciprocal.to_string(),
        f.subpixel.to_string(),
        f.rounding_name().to_owned(),
        f.overflow_name().to_owned(),
        row.widths.datapath().to_string(),
        row.area.to_string(),
        pixels(m.reported.largest),
        pixels(m.exact.largest),
        pixels(m.reported.rms()),
    ]
}
