//! The table of a comparison.

use super::Run;
use super::cell::Cell;
use super::column::Column;
use super::lines::{Line, lines};
use crate::output::page::CAVEATS;
use crate::output::table::printable;
use std::fmt::Write;

/// Where there is more.
const MORE: &str = "docs/compare.md defines every line.";

/// The table for people: a column a unit, beside each but the first its ratio to the first; `-`
/// where a unit has no such thing, or there is nothing to divide by.
#[must_use]
pub fn text(runs: &[Run], title: &str) -> String {
    let units: Vec<Column<'_>> = runs.iter().map(Column::of).collect();
    let mut table = vec![head(runs)];
    table.extend(lines(&units).iter().map(cells));
    let columns = table.iter().map(Vec::len).max().unwrap_or(0);
    let width = |k: usize| table.iter().filter_map(|row| row.get(k)).map(|cell| cell.len()).max();
    let widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
    let frames = runs.first().map_or(0, |run| run.seen.len());
    let plural = if frames == 1 { "" } else { "s" };
    let first = runs.first().map_or("", |run| run.report.config.unit.name());
    let mut text = String::new();
    let title = printable(title);
    line(&mut text, &format!("{title}: {frames} frame{plural}; ratios are to {first}\n"));
    for (number, row) in table.iter().enumerate() {
        if row.len() == 1 && number > 1 {
            text.push('\n');
        }
        let mut padded = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            write!(padded, "  {cell:>width$}").expect("a String takes everything");
        }
        line(&mut text, padded.trim_end());
    }
    line(&mut text, "");
    writeln!(text, "{CAVEATS} {MORE}").expect("a String takes everything");
    text
}

fn head(runs: &[Run]) -> Vec<String> {
    let names = runs.iter().map(|run| run.report.config.unit.name());
    let mut head = vec![String::new()];
    for (k, name) in names.enumerate() {
        head.push(name.to_owned());
        head.extend((k > 0).then(|| "ratio".to_owned()));
    }
    head
}

fn cells((label, values): &Line) -> Vec<String> {
    let mut cells = vec![label.clone()];
    let first = values.first().and_then(|cell| cell.as_ref()?.number());
    let none = || "-".to_owned();
    for (k, cell) in values.iter().enumerate() {
        cells.push(cell.as_ref().map_or_else(none, Cell::text));
        if k > 0 {
            let number = cell.as_ref().and_then(Cell::number);
            let quotient = number.zip(first.filter(|n| *n > 0.0)).map(|(n, first)| n / first);
            // What is a word has no ratio, not even a missing one.
            let word = matches!(cell, Some(Cell::Word(_)));
            let missing = || if word { String::new() } else { none() };
            cells.push(quotient.map_or_else(missing, times));
        }
    }
    cells
}

/// Three digits that count.
fn times(ratio: f64) -> String {
    match ratio {
        r if r >= 99.95 => format!("{r:.0}"),
        r if r >= 9.995 => format!("{r:.1}"),
        r if r >= 0.0995 || r == 0.0 => format!("{r:.2}"),
        r => format!("{r:.4}"),
    }
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("a String takes everything");
}

#[cfg(test)]
mod tests {
    use super::super::tests::pair;
    use super::*;

    #[test]
    fn numbers_stand_side_by_side_with_their_ratios() {
        let text = text(&pair(), "pair");
        let parts: Vec<&str> = text.split("\n\n").collect();
        let is = |part: &str, name: &str| part.lines().any(|line| line.starts_with(name));
        let part = |name: &str| *parts.iter().find(|p| is(p, name)).expect("a heading");
        // Columns are as wide as their widest cell, which names a block.
        let line = |label: &str, [first, second, ratio]: [&str; 3]| {
            format!("  {label:<39}  {first:>13}  {second:>13}  {ratio:>5}")
        };
        for (heading, label, cells) in [
            ("bytes over the link", "control points", ["1 000", "0", "0.00"]),
            ("bytes over the link", "total", ["1 000", "3 000", "3.00"]),
            ("bytes of device memory", "read", ["37", "-", "-"]),
            ("bytes of device memory", "footprint", ["0", "-", "-"]),
            ("invocations", "points evaluated", ["9", "-", "-"]),
            ("made", "vertices", ["0", "0", "-"]),
            ("made", "triangles", ["8", "8", "1.00"]),
            ("pixels", "2x2 quad efficiency", ["-", "-", "-"]),
            ("error", "largest", ["-", "-", "-"]),
            ("arithmetic", "additions", ["8", "8", "1.00"]),
            ("arithmetic", "  mean bits x bits", ["15.000", "15.000", "1.00"]),
            ("energy", "link (price assumed)", ["20.000", "60.000", "3.00"]),
            ("time", "elapsed cycles", ["200", "200", "1.00"]),
            ("a frame", "link bytes, least", ["0", "0", "-"]),
            ("a frame", "  most", ["1 000", "3 000", "3.00"]),
            ("time", "frames a second", ["20 000 000", "20 000 000", "1.00"]),
            ("verdict", "cycles per triangle", ["25.000", "25.000", "1.00"]),
            ("verdict", "what binds", ["stitch", "stitch", ""]),
            ("verdict", "  behind it, starved most", ["vertex_shader", "vertex_shader", ""]),
            ("verdict", "    for", ["40.0 %", "40.0 %", ""]),
        ] {
            let line = line(label, cells);
            let found = part(heading).lines().any(|found| found == line.trim_end());
            assert!(found, "no `{line}` in {text}");
        }
        assert!(text.starts_with("pair: 2 frames; ratios are to hybrid\n\n"), "{text}");
        assert!(text.ends_with(&format!("{CAVEATS} {MORE}\n")), "{text}");
    }

    #[test]
    fn ratios_have_three_digits_that_count() {
        let shown = [0.0, 0.0123, 0.5, 1.0, 12.34, 99.96, 1234.5].map(times);
        assert_eq!(shown, ["0.00", "0.0123", "0.50", "1.00", "12.3", "100", "1234"]);
    }
}
