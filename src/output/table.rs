//! The table that a run prints: what crossed the link, what became of the patches, what came out,
//! where the cycles went, and what it means, on one screen.

mod time;

pub use time::{Bound, bound};

use super::summary::ratio;
use crate::report::{Fates, Frame, Report};
use rtl_model::counter::{Block, Counter, Counters, DECLARATIONS};
use std::fmt::Write;

/// Renders the table, with ANSI styles; whoever prints it strips them where they do not belong.
#[must_use]
pub fn text(report: &Report, title: &str) -> String {
    let whole = report.whole();
    let totals = &whole.counters;
    let mut table = Table { text: String::new(), value_width: value_width(&whole) };
    let unit = report.config.unit.name();
    let frames = report.frames.len();
    let plural = if frames == 1 { "" } else { "s" };
    table.line(&format!("{BOLD}{}{PLAIN}: unit {unit}, {frames} frame{plural}", printable(title)));
    link(&mut table, report, totals);
    patches(&mut table, report, totals);
    made(&mut table, report, totals);
    time::section(&mut table, report, &whole);
    verdict(&mut table, report, &whole);
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
    let Fates { clipped, culled, tessellated } = Fates::of(totals);
    let fates = [
        (Block::Clip, "clipped", clipped),
        (Block::Backface, "back-facing", culled),
        (Block::Level, "tessellated", tessellated),
    ];
    for (block, label, count) in fates {
        if report.blocks.contains(&block) {
            table.row(label, count, Some(drawn));
        }
    }
}

fn made(table: &mut Table, report: &Report, totals: &Counters) {
    table.section("made");
    let rows = [
        (Block::Hull, "hull shader patches", Counter::HullInvocations),
        (Block::Hull, "hull shader threads", Counter::HullThreads),
        (Block::Domain, "domain shader invocations", Counter::DomainInvocations),
        (Block::Domain, "  in waves", Counter::DomainWaves),
        (Block::Surface, "surface shader invocations", Counter::SurfaceInvocations),
        (Block::Group, "  in waves", Counter::GroupWaves),
        (Block::Surface, "candidates tested", Counter::SurfaceTests),
        (Block::Surface, "points evaluated", Counter::SurfaceEvaluations),
        (Block::Surface, "distinct points", Counter::SurfacePoints),
        (Block::Surface, "vertices of strips", Counter::SurfaceStripVertices),
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

fn verdict(table: &mut Table, report: &Report, whole: &Frame) {
    table.section("verdict");
    let totals = &whole.counters;
    let triangles = totals.get(Counter::EmitTriangles);
    let total = totals.get(Counter::LinkTotal);
    table.rate("link bytes per triangle", ratio(total, triangles), "");
    let times = ratio(report.host_link_bytes, total);
    let times = times.map_or_else(String::new, |times| format!("  {times:.1} times as many"));
    table.rate("  if the host tessellated", ratio(report.host_link_bytes, triangles), &times);
    time::verdict(table, report, whole);
}

/// Wide enough for the largest counter and the cycles, and for a heading's worth of air.
fn value_width(whole: &Frame) -> usize {
    let counters = DECLARATIONS.iter().map(|d| whole.counters.get(d.counter));
    let elapsed = whole.times.as_ref().map(|times| times.elapsed);
    let largest = counters.chain(elapsed).max();
    grouped(largest.unwrap_or(0)).len().max(10)
}

/// Digits in groups of three.
#[must_use]
pub fn grouped(value: u64) -> String {
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
    use crate::config::{Config, Engine};
    use crate::output::timed_report;
    use rtl_model::time::FrameTimes;

    #[test]
    fn a_table_is_aligned_and_short() {
        let mut counters = Counters::default();
        counters.add(Counter::LinkControlPoints, 6144);
        counters.add(Counter::LinkTotal, 8192);
        counters.add(Counter::TracePatches, 32);
        counters.add(Counter::LevelPatches, 16);
        counters.add(Counter::EmitTriangles, 1_234_567);
        let blocks = &[Block::Link, Block::Level, Block::Emit];
        let report = Report {
            config: Config { engine: Engine::None, ..Config::default() },
            blocks,
            chain: Vec::new(),
            frames: vec![Frame { counters, ..Frame::default() }],
            occupancy: Vec::new(),
            host_link_bytes: 81920,
        };
        let styled = text(&report, "tea\x1b[31mpot");
        let plain = plain(&styled);
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

    fn plain(styled: &str) -> String {
        [BOLD, DIM, PLAIN].iter().fold(styled.to_owned(), |text, s| text.replace(s, ""))
    }

    /// From a heading on.
    fn from(text: &str, heading: &str) -> String {
        text[text.find(heading).expect("the heading")..].to_owned()
    }

    #[test]
    fn a_timed_run_says_where_the_cycles_went_and_what_binds_it() {
        let text = plain(&text(&timed_report(), "x"));
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        let expected = "\
time
  elapsed cycles                     200
  cycles per triangle             25.000
  milliseconds at 2000 MHz         0.000
  block             used     busy  starved  blocked    fifo peak   waits for
  link             8.0 %   10.0 %    0.0 %   90.0 %            -   stitch
  stitch          94.0 %   95.0 %    4.0 %    1.0 %       2 of 4   link, vertex_shader
  vertex_shader   20.0 %   40.0 %   40.0 %   20.0 %       1 of 4   stitch, order, memory_port

verdict
  link bytes per triangle          0.000
    if the host tessellated        0.000
  what binds the run: stitch, used 94.0 % of the time
    upstream waits for it: link blocked 90.0 % by stitch
    downstream starves: vertex_shader starved 35.0 % by stitch
    next would be vertex_shader, used 20.0 %
";
        assert_eq!(from(&text, "time\n"), expected);
    }

    #[test]
    fn the_verdict_follows_from_the_numbers() {
        let says = |change: fn(&mut FrameTimes), expected: &[&str]| {
            let mut report = timed_report();
            for frame in &mut report.frames {
                change(frame.times.as_mut().expect("it is timed"));
            }
            let text = from(&plain(&text(&report, "x")), "  what binds the run: ");
            let said: Vec<_> = text.lines().collect();
            assert_eq!(said.len(), expected.len(), "{text}");
            for (said, expected) in said.iter().zip(expected) {
                assert!(said.contains(expected), "{said}: {expected}");
            }
        };
        let drain = ["latency", "even stitch, the most used, is used only 49.0 %", "draining"];
        says(|t| t.stages[1].used = 49, &drain);
        let first = ["link, used 94.0 %", "vertex_shader starved 35.0 %", "next would be stitch"];
        says(|t| t.stages[0].used = 94, &first); // the first of equals, with nobody before it
        let last = ["vertex_shader, used 96.0 %", "waits for it: stitch blocked 1.0 %", "stitch"];
        says(|t| t.stages[2].used = 288, &last);
        let alone = ["stitch", "upstream hardly waits for it", "hardly starves", "next would be"];
        says(|t| (t.stages[0].blocked, t.stages[2].starved) = (0, 0), &alone);
        says(|t| t.stages.iter_mut().for_each(|s| s.total = 0), &["nothing ran"]);
    }

    #[test]
    fn digits_stand_in_groups_of_three() {
        assert_eq!([0, 999, 1000, 12_345_678].map(grouped), ["0", "999", "1 000", "12 345 678"]);
    }
}
