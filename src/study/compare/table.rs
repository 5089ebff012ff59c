//! The table of a comparison, and its CSV.

use crate::output::summary::ratio;
use crate::output::table::{bound, grouped, printable};
use crate::report::{Frame, Report, Row};
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter, Counters, Declaration};
use std::fmt::Write;

/// The columns of `compare.csv`: integers over the whole run. `first` is the first unit's value of
/// the same counter, and empty where it has none.
pub const CSV_HEADER: [&str; 6] = ["unit", "block", "counter", "value", "measure", "first"];

/// `compare.csv`: every counter of every unit, in the order of the units and then of the data.
#[must_use]
pub fn csv(reports: &[Report]) -> String {
    let mut text = CSV_HEADER.join(",");
    text.push('\n');
    let rows: Vec<_> = reports.iter().map(|report| report.rows(&report.whole())).collect();
    for (report, own) in reports.iter().zip(&rows) {
        for row in own {
            let same = |other: &&Row| (other.block, &other.name) == (row.block, &row.name);
            let first = rows[0].iter().find(same);
            let first = first.map_or_else(String::new, |row| row.value.to_string());
            let (unit, block) = (report.config.unit.name(), row.block.name());
            let Row { name, value, measure, .. } = row;
            line(&mut text, &format!("{unit},{block},{name},{value},{measure},{first}"));
        }
    }
    text
}

/// A run, and the sum of its frames.
struct Seen<'a> {
    report: &'a Report,
    whole: Frame,
}

/// What a cell says.
enum Cell {
    Number(u64),
    Rate(f64),
    Word(String),
}

impl Cell {
    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(n) => Some(*n as f64),
            Self::Rate(rate) => Some(*rate),
            Self::Word(_) => None,
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Number(n) => grouped(*n),
            Self::Rate(rate) => format!("{rate:.3}"),
            Self::Word(word) => word.clone(),
        }
    }
}

impl Seen<'_> {
    fn has(&self, block: Block) -> bool {
        self.report.blocks.contains(&block)
    }

    fn total(&self, block: Block, counter: Counter) -> Option<Cell> {
        self.has(block).then(|| Cell::Number(self.whole.counters.get(counter)))
    }

    /// The sum of the block's counters whose names begin like this.
    fn sum(&self, block: Block, start: &str) -> Option<Cell> {
        let named = |d: &&Declaration| d.block == block && d.name.starts_with(start);
        let counters = self.report.declarations().filter(named).map(|d| d.counter);
        self.has(block).then(|| Cell::Number(counters.map(|c| self.whole.counters.get(c)).sum()))
    }

    /// Operations of all blocks; none where no block's are known.
    fn ops(&self, of: impl Fn(&Ops) -> u64) -> Option<Cell> {
        let known = || self.whole.work.iter().filter_map(|work| work.ops.as_ref());
        known().next()?;
        Some(Cell::Number(known().map(of).sum()))
    }

    /// Where nothing is removed, every patch that is drawn is tessellated.
    fn tessellated(&self) -> Option<Cell> {
        let all = || {
            self.has(Block::Evaluate)
                .then_some(())
                .and(self.total(Block::Trace, Counter::TracePatches))
        };
        self.total(Block::Level, Counter::LevelPatches).or_else(all)
    }

    fn elapsed(&self) -> Option<u64> {
        self.whole.times.as_ref().map(|times| times.elapsed)
    }

    fn per_triangle(&self, value: u64) -> Option<Cell> {
        ratio(value, self.whole.counters.get(Counter::EmitTriangles)).map(Cell::Rate)
    }

    fn binds(&self) -> [Option<Cell>; 2] {
        let Some(bound) = bound(self.report, &self.whole) else { return [None, None] };
        let what = if bound.binds { bound.block.name() } else { "latency" };
        let used = bound.binds.then(|| Cell::Word(format!("{:.1} %", 100.0 * bound.used)));
        [Some(Cell::Word(what.to_owned())), used]
    }
}

/// A line of the table; one without a cell for any unit is a heading.
type Line = (String, Vec<Option<Cell>>);

/// The lines of a table.
struct Lines<'a> {
    runs: &'a [Seen<'a>],
    lines: Vec<Line>,
}

impl Lines<'_> {
    fn heading(&mut self, name: &str) {
        self.lines.push((name.to_owned(), Vec::new()));
    }

    fn each(&mut self, label: &str, cell: impl Fn(&Seen<'_>) -> Option<Cell>) {
        self.lines.push((format!("  {label}"), self.runs.iter().map(cell).collect()));
    }

    /// The first of the counters that a unit has.
    fn first(&mut self, label: &str, counters: &[(Block, Counter)]) {
        self.each(label, |run| counters.iter().find_map(|&(block, c)| run.total(block, c)));
    }

    fn total(&mut self, label: &str, block: Block, counter: Counter) {
        self.each(label, |run| run.total(block, counter));
    }

    fn any_has(&self, block: Block) -> bool {
        self.runs.iter().any(|run| run.has(block))
    }
}

fn lines(runs: &[Seen<'_>]) -> Vec<Line> {
    let mut lines = Lines { runs, lines: Vec::new() };
    bytes(&mut lines);
    invocations(&mut lines);
    lines.heading("made");
    lines.each("patches tessellated", |run| run.tessellated());
    lines.total("vertices", Block::Emit, Counter::EmitVertices);
    lines.total("triangles", Block::Emit, Counter::EmitTriangles);
    lines.heading("arithmetic");
    lines.each("additions", |run| run.ops(|ops| ops.add));
    lines.each("multiplications", |run| run.ops(|ops| ops.mul));
    lines.each("comparisons", |run| run.ops(|ops| ops.compare));
    lines.heading("time");
    lines.each("elapsed cycles", |run| run.elapsed().map(Cell::Number));
    lines.heading("verdict");
    lines.each("cycles per triangle", |run| run.per_triangle(run.elapsed()?));
    lines.each("link bytes per triangle", |run| {
        run.per_triangle(run.whole.counters.get(Counter::LinkTotal))
    });
    lines.each("what binds", |run| {
        let [what, _] = run.binds();
        what
    });
    lines.each("  used", |run| {
        let [_, used] = run.binds();
        used
    });
    lines.lines
}

fn bytes(lines: &mut Lines<'_>) {
    use Counter as C;
    lines.heading("bytes over the link");
    for kind in used_kinds(lines.runs) {
        let label = kind.name.trim_start_matches("bytes.").replace('_', " ");
        lines.total(&label, Block::Link, kind.counter);
    }
    lines.heading("bytes of device memory");
    lines.each("read", |run| run.sum(Block::Memory, "bytes.read."));
    lines.each("written", |run| run.sum(Block::Memory, "bytes.written."));
    if lines.any_has(Block::Hull) {
        lines.heading("bytes of hull and domain shader");
        lines.total("hull shader, in", Block::Hull, C::HullBytesIn);
        lines.total("  out", Block::Hull, C::HullBytesOut);
        lines.each("domain shader, in", |run| run.sum(Block::Domain, "bytes.in."));
        lines.total("  out", Block::Domain, C::DomainBytesOut);
    }
    if lines.any_has(Block::Surface) {
        lines.heading("bytes of the surface shader");
        lines.total("in", Block::Surface, C::SurfaceBytesIn);
        lines.total("out", Block::Surface, C::SurfaceBytesOut);
    }
}

fn invocations(lines: &mut Lines<'_>) {
    use Counter as C;
    lines.heading("invocations");
    let transform = (Block::Transform, C::TransformInvocations);
    lines.first("control-point shader", &[transform, (Block::Hull, C::HullThreads)]);
    if lines.any_has(Block::Hull) {
        lines.total("patch-constant function", Block::Hull, C::HullInvocations);
    }
    if lines.any_has(Block::Surface) {
        lines.total("surface shader", Block::Surface, C::SurfaceInvocations);
        lines.total("  tests", Block::Surface, C::SurfaceTests);
    }
    let points = [
        (Block::Evaluate, C::EvaluateInvocations),
        (Block::Domain, C::DomainInvocations),
        (Block::Surface, C::SurfaceEvaluations),
    ];
    lines.first("points evaluated", &points);
    lines.total("vertex shader", Block::VertexShader, C::VertexShaderInvocations);
}

/// Kinds of link bytes, the total last, that any of the units moved.
fn used_kinds(runs: &[Seen<'_>]) -> Vec<&'static Declaration> {
    let mut all = Counters::default();
    runs.iter().for_each(|run| all.merge(&run.whole.counters));
    let kinds = rtl_model::counter::DECLARATIONS.iter().filter(|d| d.block == Block::Link);
    kinds.filter(|d| d.counter == Counter::LinkTotal || all.get(d.counter) > 0).collect()
}

/// The table for people: a column a unit, beside each but the first its ratio to the first; `-`
/// where a unit has no such thing, or there is nothing to divide by.
#[must_use]
pub fn text(reports: &[Report], title: &str) -> String {
    let runs: Vec<Seen<'_>> =
        reports.iter().map(|report| Seen { report, whole: report.whole() }).collect();
    let mut table = vec![head(&runs)];
    table.extend(lines(&runs).iter().map(cells));
    let columns = table.iter().map(Vec::len).max().unwrap_or(0);
    let width = |k: usize| table.iter().filter_map(|row| row.get(k)).map(|cell| cell.len()).max();
    let widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
    let frames = reports.first().map_or(0, |report| report.frames.len());
    let plural = if frames == 1 { "" } else { "s" };
    let first = reports.first().map_or("", |report| report.config.unit.name());
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
    text
}

fn head(runs: &[Seen<'_>]) -> Vec<String> {
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
    use super::*;
    use crate::config::{Config, Unit};
    use crate::output::timed_report;

    /// A made-up pair: the second has no blocks but link and emit.
    fn pair() -> [Report; 2] {
        let mut first = timed_report();
        first.blocks = &[Block::Trace, Block::Link, Block::Memory, Block::Evaluate, Block::Emit];
        let mut second = first.clone();
        second.config = Config { unit: Unit::Triangles, ..second.config };
        second.blocks = &[Block::Trace, Block::Link, Block::Emit];
        for (report, factor) in [(&mut first, 1), (&mut second, 3)] {
            let counters = &mut report.frames[0].counters;
            counters.add(Counter::TracePatches, 2);
            counters.add(Counter::LinkControlPoints, 500 * (3 - factor));
            counters.add(Counter::LinkTotal, 1000 * factor);
            counters.add(Counter::EvaluateInvocations, 9);
            counters.add(Counter::MemoryReadControlPoints, 30);
            counters.add(Counter::MemoryReadAttributes, 7);
        }
        [first, second]
    }

    #[test]
    fn numbers_stand_side_by_side_with_their_ratios() {
        let text = text(&pair(), "pair");
        let expected = "\
pair: 2 frames; ratios are to hybrid

                            hybrid  triangles  ratio
bytes over the link
  control points             1 000          0   0.00
  total                      1 000      3 000   3.00

bytes of device memory
  read                          37          -      -
  written                        0          -      -

invocations
  control-point shader           -          -      -
  points evaluated               9          -      -
  vertex shader                  -          -      -

made
  patches tessellated            2          -      -
  vertices                       0          0      -
  triangles                      8          8   1.00

arithmetic
  additions                      8          8   1.00
  multiplications                4          4   1.00
  comparisons                    2          2   1.00

time
  elapsed cycles               200        200   1.00

verdict
  cycles per triangle       25.000     25.000   1.00
  link bytes per triangle  125.000    375.000   3.00
  what binds                stitch     stitch
    used                    94.0 %     94.0 %
";
        assert_eq!(text, expected);
    }

    #[test]
    fn every_row_of_every_unit_is_in_the_csv_beside_the_first_units() {
        let reports = pair();
        let text = csv(&reports);
        let rows: Vec<&str> = text.lines().skip(1).collect();
        let count = |report: &Report| report.rows(&report.whole()).len();
        assert_eq!(rows.len(), count(&reports[0]) + count(&reports[1]));
        for row in [
            "hybrid,link,bytes.total,1000,bytes,1000",
            "triangles,link,bytes.total,3000,bytes,1000",
            "hybrid,evaluate,invocations,9,count,9",
            "triangles,unit,cycles.total,200,cycles,200",
        ] {
            assert!(rows.contains(&row), "{row}: {text}");
        }
        let backwards = csv(&[reports[1].clone(), reports[0].clone()]);
        assert!(backwards.contains("\nhybrid,evaluate,invocations,9,count,\n"), "{backwards}");
    }

    #[test]
    fn ratios_have_three_digits_that_count() {
        let shown = [0.0, 0.0123, 0.5, 1.0, 12.34, 99.96, 1234.5].map(times);
        assert_eq!(shown, ["0.00", "0.0123", "0.50", "1.00", "12.3", "100", "1234"]);
    }
}
