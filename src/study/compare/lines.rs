//! The lines of the table: which numbers it shows, and under which headings.

use super::cell::Cell;
use super::column::{Column, Side, Which};
use super::series;
use crate::study::raster::CLASSES;
use rtl_model::counter::{Block, Counter, Counters, Declaration};

/// A line of the table; one without a cell for any unit is a heading.
pub(super) type Line = (String, Vec<Option<Cell>>);

/// The lines of a table.
struct Lines<'a> {
    runs: &'a [Column<'a>],
    lines: Vec<Line>,
}

impl Lines<'_> {
    fn heading(&mut self, name: &str) {
        self.lines.push((name.to_owned(), Vec::new()));
    }

    fn each(&mut self, label: &str, cell: impl Fn(&Column<'_>) -> Option<Cell>) {
        self.lines.push((format!("  {label}"), self.runs.iter().map(cell).collect()));
    }

    /// The first of the counters that a unit has.
    fn first(&mut self, label: &str, counters: &[(Block, Counter)]) {
        self.each(label, |run| counters.iter().find_map(|&(block, c)| run.total(block, c)));
    }

    fn total(&mut self, label: &str, block: Block, counter: Counter) {
        self.each(label, |run| run.total(block, counter));
    }

    fn number(&mut self, label: &str, block: &str, name: &str) {
        self.each(label, |run| run.number(block, name));
    }

    fn any_has(&self, block: Block) -> bool {
        self.runs.iter().any(|run| run.has(block))
    }
}

pub(super) fn lines(runs: &[Column<'_>]) -> Vec<Line> {
    let mut lines = Lines { runs, lines: Vec::new() };
    bytes(&mut lines);
    invocations(&mut lines);
    lines.heading("made");
    lines.each("patches tessellated", |run| run.tessellated());
    lines.total("vertices", Block::Emit, Counter::EmitVertices);
    lines.total("triangles", Block::Emit, Counter::EmitTriangles);
    if lines.any_has(Block::VertexCache) {
        vertex_cache(&mut lines);
    }
    screen(&mut lines);
    arithmetic(&mut lines);
    time(&mut lines);
    frames(&mut lines);
    verdict(&mut lines);
    lines.lines
}

fn vertex_cache(lines: &mut Lines<'_>) {
    use Counter as C;
    lines.heading("vertex cache of the host's triangles");
    for (label, counter) in [
        ("indices", C::VertexCacheIndices),
        ("strips", C::VertexCacheStrips),
        ("batches", C::VertexCacheBatches),
        ("hits", C::VertexCacheHits),
        ("misses", C::VertexCacheMisses),
    ] {
        lines.total(label, Block::VertexCache, counter);
    }
    lines.each("vertices shaded per triangle", |run| {
        let misses = run.whole.counters.get(C::VertexCacheMisses);
        run.per_triangle(misses).filter(|_| run.has(Block::VertexCache))
    });
}

fn screen(lines: &mut Lines<'_>) {
    lines.heading("triangles on the screen");
    for (label, name) in [
        ("front-facing", "triangles.front"),
        ("back-facing", "triangles.back"),
        ("outside the viewport", "triangles.outside"),
        ("without area", "triangles.zero_area"),
        ("left to the clipper", "triangles.to_clipper"),
        ("facing, below a pixel", "triangles.sub_pixel"),
        ("facing, without a sample", "triangles.no_sample"),
    ] {
        lines.number(label, "screen", name);
    }
    lines.heading("facing triangles by area in square pixels");
    for class in 0..CLASSES {
        let (label, name) = match class {
            0 => (format!("below {}", series::bound(1)), series::area(0)),
            _ => (format!("from {}", series::bound(class)), series::area(class)),
        };
        lines.number(&label, "screen", &name);
    }
    lines.heading("pixels");
    lines.number("covered", "screen", "pixels");
    lines.number("triangles per covered one", "screen", "triangles_per_pixel");
    lines.number("times covered", "screen", "samples_per_pixel");
    lines.number("2x2 quad efficiency", "screen", "quad_efficiency");
    lines.heading("error against the surface, pixels");
    lines.number("largest", "error", "largest");
    lines.number("mean", "error", "mean");
}

fn arithmetic(lines: &mut Lines<'_>) {
    lines.heading("arithmetic");
    lines.each("additions", |run| run.ops(|ops| ops.add));
    lines.each("  mean bits", |run| run.mean_bits(|ops| [ops.add_bits, ops.add]));
    lines.each("multiplications", |run| run.ops(|ops| ops.mul));
    lines.each("  mean bits x bits", |run| run.mean_bits(|ops| [ops.mul_bits, ops.mul]));
    lines.each("comparisons", |run| run.ops(|ops| ops.compare));
    lines.each("  mean bits", |run| run.mean_bits(|ops| [ops.compare_bits, ops.compare]));
    lines.heading("energy, estimated, nJ a frame");
    for (label, name) in [
        ("operations", "operations"),
        ("bytes on the chip", "chip"),
        ("device memory", "memory"),
        ("link (price assumed)", "link"),
        ("total", "total"),
    ] {
        lines.each(label, |run| {
            let Cell::Rate(energy) = run.number("energy", name)? else { return None };
            Some(Cell::Rate(energy / 1000.0 / run.run.seen.len().max(1) as f64))
        });
    }
}

fn time(lines: &mut Lines<'_>) {
    lines.heading("time");
    lines.each("elapsed cycles", |run| run.elapsed().map(Cell::Number));
    lines.number("milliseconds", "unit", "time");
    lines.number("frames a second", "unit", "frames");
}

/// What frames differ in: one alone in nothing.
fn frames(lines: &mut Lines<'_>) {
    if lines.runs.iter().all(|column| column.run.seen.len() < 2) {
        return;
    }
    lines.heading("a frame");
    for (label, block, name) in [
        ("triangles", "emit", "triangles"),
        ("link bytes", "link", "bytes.total"),
        ("elapsed cycles", "unit", "cycles.total"),
        ("largest error", "error", "largest"),
    ] {
        lines.each(&format!("{label}, least"), |run| run.spread(block, name, Which::Least));
        lines.each("  median", |run| run.spread(block, name, Which::Median));
        lines.each("  most", |run| run.spread(block, name, Which::Most));
    }
}

fn verdict(lines: &mut Lines<'_>) {
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
    lines.each("  starved", |run| run.share(|t| t.starved + t.starved_by_port));
    lines.each("  blocked", |run| run.share(|t| t.blocked + t.blocked_by_order));
    for (side, label) in
        [(Side::Before, "  before it, blocked most"), (Side::Behind, "  behind it, starved most")]
    {
        lines.each(label, |run| run.waits(side).map(|[block, _]| block));
        lines.each("    for", |run| run.waits(side).map(|[_, share]| share));
    }
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
    lines.total("wasted in bursts", Block::Memory, C::MemoryWasted);
    lines.number("footprint", "memory", "footprint");
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
fn used_kinds(runs: &[Column<'_>]) -> Vec<&'static Declaration> {
    let mut all = Counters::default();
    runs.iter().for_each(|run| all.merge(&run.whole.counters));
    let kinds = rtl_model::counter::DECLARATIONS.iter().filter(|d| d.block == Block::Link);
    kinds.filter(|d| d.counter == Counter::LinkTotal || all.get(d.counter) > 0).collect()
}
