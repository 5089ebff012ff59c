//! The rows of evaluators as text and as CSV.

use super::{Evaluator, Row, bits_needed, slope};
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `evaluators.csv`: distances in 1e-9 pixels, `rms_millidecibels` 20000 log10 of
/// the RMS in pixels, empty where it is 0.
pub const CSV_HEADER: [&str; 10] = [
    "evaluator",
    "segments",
    "guard",
    "width",
    "register_bits",
    "points",
    "behind",
    "largest_nanopixels",
    "rms_nanopixels",
    "rms_millidecibels",
];

/// `evaluators.csv`: integers only, beside the names of evaluators.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for row in rows {
        let (name, register) = (row.evaluator.name(), row.register());
        let [largest, rms] = [row.error.largest, row.error.rms()].map(|px| (px * 1e9).round());
        let decibels = row.decibels().map_or(String::new(), |db| format!("{:.0}", db * 1e3));
        let (points, Row { segments, guard, width, behind, .. }) = (row.error.count(), row);
        writeln!(
            text,
            "{name},{segments},{guard},{width},{register},{points},{behind},{largest:.0},{rms:.0},\
             {decibels}"
        )
        .expect("a String takes everything");
    }
    text
}

/// Bits that each evaluator needs to stay within `pixels`, and what a bit is worth, in Markdown.
#[must_use]
pub fn text(rows: &[Row], pixels: f64) -> String {
    let mut segments: Vec<u32> = rows.iter().map(|row| row.segments).collect();
    segments.sort_unstable();
    segments.dedup();
    let mut kinds: Vec<(Evaluator, u32)> = Vec::new();
    for row in rows {
        if !kinds.contains(&(row.evaluator, row.guard)) {
            kinds.push((row.evaluator, row.guard));
        }
    }
    let name = |&(evaluator, guard): &(Evaluator, u32)| match evaluator.has_guard() {
        true => format!("{}, guard {guard}", evaluator.name()),
        false => evaluator.name().to_owned(),
    };
    let columns: Vec<String> =
        ["segments (steps)".to_owned()].into_iter().chain(kinds.iter().map(name)).collect();
    let line = |cell: &dyn Fn(u32, Evaluator, u32) -> String| {
        let each = |&n: &u32| {
            let cells = kinds.iter().map(|&(evaluator, guard)| cell(n, evaluator, guard));
            [format!("{n} ({})", n / 2)].into_iter().chain(cells).collect()
        };
        segments.iter().map(each).collect::<Vec<Vec<String>>>()
    };
    let needed = line(&|n, evaluator, guard| {
        let width = bits_needed(rows, evaluator, n, guard, pixels);
        width.map_or("-".to_owned(), |w| format!("{w} / {}", evaluator.register(w, guard)))
    });
    let slopes = line(&|n, evaluator, guard| {
        slope(rows, evaluator, n, guard).map_or("-".to_owned(), |db| format!("{db:.2}"))
    });
    format!(
        "bits of a position / of the widest register, for points within {pixels} px of the true \
         surface\n\n{}\ndecibels that the RMS error falls by a bit, below a pixel (6.02: it \
         halves)\n\n{}",
        markdown::wide(&columns, &needed),
        markdown::wide(&columns, &slopes)
    )
}
