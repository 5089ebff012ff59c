//! The table that a run prints: what crossed the link, what became of the patches, what came out,
//! and what it means, on one screen.

use super::counters::unit_name;
use super::summary::ratio;
use crate::config::Engine;
use crate::report::Report;
use rtl_model::counter::{Block, Counter, Counters};
use std::fmt::Write;

/// Renders the table, with ANSI styles; whoever prints it strips them where they do not belong.
#[must_use]
pub fn text(report: &Report, title: &str) -> String {
    let totals = report.totals();
    let mut table = Table { text: String::new(), value_width: value_width(&totals) };
    let unit = unit_name(report.config.unit);
    let frames = report.frames.len();
    let plural = if frames == 1 { "" } else { "s" };
    table.line(&format!("{BOLD}{}{PLAIN}: unit {unit}, {frames} frame{plural}", printable(title)));
    link(&mut table, report, &totals);
    patches(&mut table, report, &totals);
    made(&mut table, report, &totals);
    verdict(&mut table, report, &totals);
    table.text
}

const BOLD: &str = "\x1b[1m";
const DIM: &str = "\x1b[2m";
const PLAIN: &str = "\x1b[0m";

/// Columns of the label, wide enough for the longest.
const LABEL_WIDTH: usize = 28;

struct Table {
    text: String,
    value_width: usize,
}

impl Table {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn section(&mut self, name: &str) {
        self.line(&format!("\n{BOLD}{name}{PLAIN}"));
    }

    /// A number, and what share it is of `whole`.
    fn row(&mut self, label: &str, value: u64, whole: Option<u64>) {
        let share = whole.and_then(|whole| ratio(value, whole));
        let share = share.map_or_else(String::new, |share| format!("{:>8.1} %", 100.0 * share));
        let width = self.value_width;
        let value = grouped(value);
        self.line(&format!("  {label:LABEL_WIDTH$}{value:>width$}{DIM}{share}{PLAIN}"));
    }

    fn rate(&mut self, label: &str, rate: Option<f64>, note: &str) {
        let width = self.value_width;
        let rate = rate.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.3}"));
        self.line(&format!("  {label:LABEL_WIDTH$}{rate:>width$}{DIM}{note}{PLAIN}"));
    }
}

fn link(table: &mut Table, report: &Report, totals: &Counters) {
    table.section("bytes over the link");
    let total = totals.get(Counter::LinkTotal);
    let kinds = report.declarations().filter(|d| d.block == Block::Link);
    for kind in kinds.filter(|d| d.counter != Counter::LinkTotal) {
        let value = totals.get(kind.counter);
        if value > 0 {
            let label = kind.name.trim_start_matches("bytes.").replace('_', " ");
            table.row(&label, value, Some(total));
        }
    }
    table.row("total", total, None);
}

fn patches(table: &mut Table, report: &Report, totals: &Counters) {
    table.section("patches");
    let drawn = totals.get(Counter::TracePatches);
    table.row("drawn", drawn, None);
    let fates = [
        (Block::Clip, "clipped", Counter::ClipCulled),
        (Block::Backface, "back-facing", Counter::BackfaceCulled),
        (Block::Level, "tessellated", Counter::LevelPatches),
    ];
    for (block, label, counter) in fates {
        if report.blocks.contains(&block) {
            table.row(label, totals.get(counter), Some(drawn));
        }
    }
}

fn made(table: &mut Table, report: &Report, totals: &Counters) {
    table.section("made");
    let rows = [
        (Block::Emit, "vertices", Counter::EmitVertices),
        (Block::Emit, "triangles", Counter::EmitTriangles),
        (Block::VertexShader, "vertex shader invocations", Counter::VertexShaderInvocations),
    ];
    for (block, label, counter) in rows {
        if report.blocks.contains(&block) {
            table.row(label, totals.get(counter), None);
        }
    }
}

fn verdict(table: &mut Table, report: &Report, totals: &Counters) {
    table.section("verdict");
    let triangles = totals.get(Counter::EmitTriangles);
    let total = totals.get(Counter::LinkTotal);
    table.rate("link bytes per triangle", ratio(total, triangles), "");
    let times = ratio(report.host_link_bytes, total);
    let times = times.map_or_else(String::new, |times| format!("  {times:.1} times as many"));
    table.rate("  if the host tessellated", ratio(report.host_link_bytes, triangles), &times);
    match report.config.engine {
        Engine::Timed | Engine::Stepped | Engine::None => {
            table.line("  what binds the run: no engine, so no cycles");
        }
    }
}

/// Wide enough for the largest counter, and for a heading's worth of air.
fn value_width(totals: &Counters) -> usize {
    let largest = rtl_model::counter::DECLARATIONS.iter().map(|d| totals.get(d.counter)).max();
    grouped(largest.unwrap_or(0)).len().max(10)
}

/// Digits in groups of three.
fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        write!(text, "{digit}").expect("a String takes everything");
    }
    text
}

/// A title comes from a file: what it could do to a terminal is left out, and a missing one named.
#[must_use]
pub fn printable(title: &str) -> String {
    let title: String = title.chars().filter(|c| !c.is_control()).collect();
    if title.is_empty() { "untitled".to_owned() } else { title }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    #[test]
    fn a_table_is_aligned_and_short() {
        let mut counters = Counters::default();
        counters.add(Counter::LinkControlPoints, 6144);
        counters.add(Counter::LinkTotal, 8192);
        counters.add(Counter::TracePatches, 32);
        counters.add(Counter::LevelPatches, 16);
        counters.add(Counter::EmitTriangles, 1_234_567);
        let blocks = &[Block::Link, Block::Level, Block::Emit];
        let (config, frames) = (Config::default(), vec![counters]);
        let report = Report { config, blocks, frames, host_link_bytes: 81920 };
        let styled = text(&report, "tea\x1b[31mpot");
        let plain = [BOLD, DIM, PLAIN].iter().fold(styled, |text, s| text.replace(s, ""));
        let expected = "\
tea[31mpot: unit hybrid, 1 frame

bytes over the link
  control points                   6 144    75.0 %
  total                            8 192

patches
  drawn                               32
  tessellated                         16    50.0 %

made
  vertices                             0
  triangles                    1 234 567

verdict
  link bytes per triangle          0.007
    if the host tessellated        0.066  10.0 times as many
  what binds the run: no engine, so no cycles
";
        assert_eq!(plain, expected);
    }

    #[test]
    fn digits_stand_in_groups_of_three() {
        assert_eq!([0, 999, 1000, 12_345_678].map(grouped), ["0", "999", "1 000", "12 345 678"]);
    }
}
