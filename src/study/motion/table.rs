//! The counts as text and as CSV.

use super::{Counts, Film};
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `motion.csv`.
pub const CSV_HEADER: [&str; 15] = [
    "trace",
    "frame",
    "patches",
    "clipped",
    "clipped_golden",
    "clipped_exact",
    "reached",
    "away",
    "culled",
    "culled_golden",
    "tessellated",
    "triangles",
    "disagreements",
    "false_removals_quantised",
    "false_removals_exact",
];

/// Rows that a terminal is given for frames, of all films together.
const ROWS_MAX: usize = 40;

/// `motion.csv`: a row for each frame, integers only. A comma or a line break in a name becomes an
/// underscore.
#[must_use]
pub fn csv(films: &[Film]) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for film in films {
        let name = film.name.replace([',', '"', '\n', '\r'], "_");
        for (number, frame) in film.frames.iter().enumerate() {
            let fields = frame.fields().map(|n| n.to_string()).join(",");
            writeln!(text, "{name},{number},{fields}").expect("a String takes everything");
        }
    }
    text
}

const COLUMNS: [&str; 14] = [
    "",
    "patches",
    "clipped",
    "golden",
    "f64",
    "to backface",
    "no front",
    "culled",
    "golden",
    "tessellated",
    "triangles",
    "disagree",
    "false",
    "f64",
];

/// A table for each film, frame by frame, or one in so many where there are many; and one of
/// the totals.
#[must_use]
pub fn text(films: &[Film]) -> String {
    let rows = (ROWS_MAX / films.len().max(1)).max(1);
    let mut text = String::new();
    for film in films {
        let step = film.frames.len().div_ceil(rows).max(1);
        let shown = film.frames.iter().enumerate().step_by(step);
        let mut cells: Vec<_> = shown.map(|(n, frame)| row(&n.to_string(), frame)).collect();
        cells.push(row("total", &film.totals()));
        let frames = film.frames.len();
        let every = if step > 1 { format!(", one in {step} of them here") } else { String::new() };
        writeln!(text, "{}: {frames} frames{every}\n", film.name)
            .expect("a String takes everything");
        text += &markdown::table(&COLUMNS, 1, &cells);
        text.push('\n');
    }
    if films.len() > 1 {
        let totals: Vec<_> = films.iter().map(|f| row(&f.name, &f.totals())).collect();
        text += &markdown::table(&COLUMNS, 1, &totals);
        text.push('\n');
    }
    let mut all = Counts::default();
    films.iter().for_each(|film| all.merge(&film.totals()));
    text + &verdict(&all)
}

fn row(name: &str, counts: &Counts) -> [String; 14] {
    let mut cells = counts.fields().map(|n| n.to_string()).into_iter();
    std::array::from_fn(
        |k| {
            if k == 0 { name.to_owned() } else { cells.next().expect("a column each") }
        },
    )
}

/// What there is to be read off.
fn verdict(all: &Counts) -> String {
    let Counts { patches, clipped, culled, disagreements, false_quantised, false_exact, .. } = all;
    format!(
        "of {patches} patches {clipped} were clipped and {culled} culled; unit and golden model \
         disagree about {disagreements}\nremoved though in sight: {false_quantised} of the \
         quantised surfaces, {false_exact} of those in f64\n"
    )
}
