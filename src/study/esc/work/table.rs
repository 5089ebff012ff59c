//! The rows as text, as CSV and as a picture.

use super::plot::{Chart, Names, Series};
use super::{DomainKind, Options, PAPER, Reuse, Row, Way, plot};
use crate::error::Result;
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `work.csv`: a row for each number of processors. Energy in picojoules.
pub const CSV_HEADER: [&str; 26] = [
    "way",
    "level",
    "processors",
    "patches",
    "triangles",
    "invocations",
    "evaluating_invocations",
    "control_points_read",
    "evaluations",
    "vertices",
    "adds",
    "add_bits",
    "muls",
    "mul_bits2",
    "compares",
    "compare_bits",
    "chip_bytes",
    "memory_bytes",
    "operations_pj",
    "operations_in_singles_pj",
    "chip_pj",
    "memory_pj",
    "invocations_pj",
    "energy_pj",
    "shader_cycles",
    "elapsed_cycles",
];

const NAIVE: Way = Way::D3d11(DomainKind::Naive);
const BASIS: Way = Way::D3d11(DomainKind::Basis);
const ESC: [Way; 4] = [
    Way::Esc(Reuse::Patch),
    Way::Esc(Reuse::CoarseTriangle),
    Way::Esc(Reuse::None),
    Way::EscLimited,
];

/// `work.csv`: integers only, beside the names of ways.
#[must_use]
pub fn csv(rows: &[Row], options: &Options) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for row in rows {
        for (processors, elapsed) in options.processors.iter().zip(&row.elapsed) {
            let name = row.way.name().replace(", ", "_").replace(' ', "_");
            let e = &row.energy;
            let picojoules =
                [e.operations, e.in_singles, e.chip, e.memory, e.invocations, e.total()];
            let mut numbers = vec![
                row.level.into(),
                u64::from(*processors),
                row.patches,
                row.triangles,
                row.invocations,
                row.evaluating,
                row.control_points,
                row.evaluations,
                row.vertices,
                row.ops.add,
                row.ops.add_bits,
                row.ops.mul,
                row.ops.mul_bits,
                row.ops.compare,
                row.ops.compare_bits,
                row.chip_bytes,
                row.memory_bytes,
            ];
            numbers.extend(picojoules.map(|pj| pj.round() as u64));
            numbers.extend([row.shader_cycles, *elapsed]);
            let numbers: Vec<_> = numbers.iter().map(u64::to_string).collect();
            line(&mut text, &format!("{name},{}", numbers.join(",")));
        }
    }
    text
}

/// What a table is of.
type Quantity = fn(&Row) -> f64;

/// The tables for people, in Markdown: quantities a patch, then ratios of speed.
#[must_use]
pub fn text(rows: &[Row], options: &Options) -> String {
    let mut text = String::new();
    let of_patch = |of: Quantity| move |row: &Row| of(row) / row.patches as f64;
    let tables: [(&str, Quantity); 8] = [
        ("triangles", |row| row.triangles as f64),
        ("shader invocations", |row| row.invocations as f64),
        ("control points read to evaluate", |row| row.control_points as f64),
        ("points evaluated", |row| row.evaluations as f64),
        ("operations", |row| (row.ops.add + row.ops.mul + row.ops.compare) as f64),
        ("energy in nJ, device memory left out", |row| row.energy.on_chip() / 1e3),
        ("energy of the operations in nJ, all in singles", |row| row.energy.in_singles / 1e3),
        ("cycles of one processor, shaders alone", |row| row.shader_cycles as f64),
    ];
    for (name, of) in tables {
        by_level(&mut text, &format!("{name}, a patch, at L"), rows, &of_patch(of));
    }
    for (number, processors) in options.processors.iter().enumerate() {
        let plural = if *processors == 1 { "" } else { "s" };
        let name = format!("cycles elapsed a patch, {processors} processor{plural}, at L");
        by_level(&mut text, &name, rows, &|row: &Row| {
            row.elapsed[number] as f64 / row.patches as f64
        });
    }
    speeds(&mut text, rows, options);
    let memory = rows.first().map_or(0.0, |row| row.energy.memory / row.patches as f64 / 1e3);
    line(&mut text, &format!("device memory: {memory:.1} nJ a patch, the same in all of them"));
    text
}

/// A table with a line a way and a column a level.
fn by_level(text: &mut String, name: &str, rows: &[Row], value: &dyn Fn(&Row) -> f64) {
    let ways = Way::ALL.map(|way| {
        let of = rows.iter().filter(|row| row.way == way);
        (way.name().to_owned(), of.map(|row| digits(value(row))).collect())
    });
    lines(text, name, rows, &ways);
}

/// A table of cells by level, which only grows to the right.
fn lines(text: &mut String, name: &str, rows: &[Row], ways: &[(String, Vec<String>)]) {
    let mut levels: Vec<u32> = rows.iter().map(|row| row.level).collect();
    levels.dedup();
    let shown = |k: &usize| levels.len() <= 8 || levels[*k] % 2 == 1;
    let shown: Vec<usize> = (0..levels.len()).filter(shown).collect();
    let mut head = vec![name.to_owned()];
    head.extend(shown.iter().map(|&k| levels[k].to_string()));
    let body = ways.iter().map(|(way, cells)| {
        let cells = shown.iter().map(|&k| cells.get(k).cloned().unwrap_or_default());
        std::iter::once(way.clone()).chain(cells).collect()
    });
    *text += &markdown::wide(&head, &body.collect::<Vec<Vec<String>>>());
    text.push('\n');
}

/// How many times as fast as each domain shader ESC is; where it is slower, and where the paper's
/// figures lie.
fn speeds(text: &mut String, rows: &[Row], options: &Options) {
    let mut said = Vec::new();
    let mut each = |name: &str, of: &dyn Fn(&Row) -> u64| {
        for against in [NAIVE, BASIS] {
            let ways = ESC.map(|way| {
                let ratios = ratios(rows, way, against, of);
                said.push(place(way, against, name, &ratios));
                (way.name().to_owned(), ratios.iter().map(|(_, r)| format!("{r:.2}")).collect())
            });
            let head = format!("times as fast as {}, {name}, at L", against.name());
            lines(text, &head, rows, &ways);
        }
    };
    each("shaders alone", &|row| row.shader_cycles);
    for (number, processors) in options.processors.iter().enumerate() {
        let plural = if *processors == 1 { "" } else { "s" };
        each(&format!("{processors} processor{plural}"), &|row| row.elapsed[number]);
    }
    let [a, b] = PAPER.map(|(machine, times)| format!("nearest to {times} ({machine})"));
    let columns = ["way", "against", "by", "slower at L", "times as fast", &a, &b];
    text.push_str(&markdown::table(&columns, 3, &said));
}

/// Where a curve of ratios loses, between which it lies, and where it is nearest to the paper's.
fn place(way: Way, against: Way, by: &str, ratios: &[(u32, f64)]) -> [String; 7] {
    let loses: Vec<String> =
        ratios.iter().filter(|(_, r)| *r < 1.0).map(|(level, _)| level.to_string()).collect();
    let nearest = PAPER.map(|(_, times)| {
        let off = |ratio: f64| (ratio - times).abs();
        let least = ratios.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        least.map_or(String::new(), |(level, ratio)| format!("{ratio:.2}, L = {level}"))
    });
    let [low, high] = [f64::min, f64::max].map(|f| ratios.iter().map(|r| r.1).reduce(f));
    let [a, b] = nearest;
    [
        way.name().to_owned(),
        against.name().to_owned(),
        by.to_owned(),
        if loses.is_empty() { "-".to_owned() } else { loses.join(" ") },
        format!("{:.2} .. {:.2}", low.unwrap_or(f64::NAN), high.unwrap_or(f64::NAN)),
        a,
        b,
    ]
}

/// Another way's number over this one's, by level.
fn ratios(rows: &[Row], way: Way, against: Way, of: &dyn Fn(&Row) -> u64) -> Vec<(u32, f64)> {
    let of_way = |way| rows.iter().filter(move |row: &&Row| row.way == way);
    let pairs = of_way(way).zip(of_way(against));
    pairs.map(|(esc, other)| (esc.level, of(other) as f64 / of(esc) as f64)).collect()
}

/// `work.svg`: how many times as fast as a naive domain shader, by the shaders alone and with the
/// last number of processors, over the level; and the paper's figures.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg(rows: &[Row], options: &Options) -> Result<String> {
    let points = |way, against, of: &dyn Fn(&Row) -> u64| {
        let ratios = ratios(rows, way, against, of).into_iter();
        ratios.map(|(level, ratio)| (f64::from(level), ratio)).collect::<Vec<_>>()
    };
    let shaders = |row: &Row| row.shader_cycles;
    let mut series: Vec<Series> = ESC
        .into_iter()
        .map(|way| Series {
            name: format!("{} / naive, shaders", way.name()),
            points: points(way, NAIVE, &shaders),
        })
        .collect();
    let esc = ESC[0];
    series.push(Series {
        name: format!("{} / basis, shaders", esc.name()),
        points: points(esc, BASIS, &shaders),
    });
    for (number, processors) in options.processors.iter().enumerate() {
        let plural = if *processors == 1 { "" } else { "s" };
        series.push(Series {
            name: format!("{} / naive, {processors} processor{plural}", esc.name()),
            points: points(esc, NAIVE, &|row| row.elapsed[number]),
        });
    }
    let mut levels = PAPER.map(|(machine, times)| (machine.to_owned(), times)).to_vec();
    levels.push(("equal".to_owned(), 1.0));
    plot::svg(&Chart {
        file: "work.svg",
        title: "How many times as fast as a domain shader ESC is, at equal triangles and cores",
        x: "level L",
        y: "times",
        ticks: Vec::new(),
        log: false,
        names: Names::Above,
        series,
        levels,
        marks: Vec::new(),
    })
}

/// Three digits that count, at least.
fn digits(value: f64) -> String {
    let places = (2 - value.max(1e-9).log10().floor() as i32).clamp(0, 3) as usize;
    format!("{value:.places$}")
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("a String takes everything");
}
