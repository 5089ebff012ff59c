//! The curves as text, as CSV and as a picture.

use super::plot::{Chart, Mark, Names, Series};
use super::{Curve, NEAR, PAPER, SCENES, Sample, Study, plot, uniform_triangles};
use crate::error::Result;
use crate::study::esc::{nano, reading};
use crate::study::markdown;
use std::fmt::Write;

/// The columns of `triangles.csv`. `row`: `curve`, or the row of the paper's table that this mu
/// comes nearest to; `elephant_size_nano`: 1e-9 of the stand-in's own size; `mu_nano`: 1e-9 pixels
/// or object units.
pub const CSV_HEADER: [&str; 10] = [
    "control_mesh",
    "space",
    "row",
    "elephant_size_nano",
    "mu_nano",
    "level",
    "teacups_uniform",
    "teacups_triangles",
    "elephants_uniform",
    "elephants_triangles",
];

/// The paper calls 1024 a thousand: 2600 x 288 are 731.25 of them, and 731.32 are printed.
const THOUSAND: f64 = 1024.0;
const PAPER_UNIFORM: [&str; SCENES] = ["731.32", "2280.94"];
const NAMES: [&str; SCENES] = ["teacups", "elephants"];

/// `triangles.csv`: integers only, beside names.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    for curve in &study.curves {
        let space = curve.test.unit().split(' ').next().unwrap_or_default();
        let named = |best: &[Sample; 2]| PAPER.iter().map(|row| row.0).zip(*best);
        let own = curve.samples.iter().map(|sample| ("curve", *sample));
        let own = own.chain(named(&curve.best)).map(|(row, sample)| (row, 1.0, sample));
        let sized = named(&curve.sized.best).map(|(row, sample)| (row, curve.sized.size, sample));
        for (row, size, sample) in own.chain(sized) {
            let numbers = [
                nano(size),
                nano(sample.mu),
                study.options.level.into(),
                curve.uniform[0],
                sample.triangles[0],
                curve.uniform[1],
                sample.triangles[1],
            ];
            let numbers = numbers.map(|n| n.to_string()).join(",");
            let mesh = reading(curve.test.mesh);
            writeln!(text, "{mesh},{space},{row},{numbers}").expect("a String takes everything");
        }
    }
    text
}

/// The tables for people, in Markdown.
#[must_use]
pub fn text(study: &Study) -> String {
    let mut text = not_adaptive(study);
    for curve in &study.curves {
        text += "\n";
        text += &over_mu(curve);
    }
    text += "\none common mu for both scenes, where the worse of them is nearest to the paper\n\n";
    text += &best(study, |curve| (1.0, &curve.best));
    text += "\nthe same, with elephants of the one size that suits both rows best\n\n";
    text += &best(study, |curve| (curve.sized.size, &curve.sized.best));
    text += "\n";
    text += &verdict(study);
    text
}

fn not_adaptive(study: &Study) -> String {
    let each = uniform_triangles(study.options.level);
    let row = |k: usize| {
        let (patches, triangles) = (study.patches[k], study.uniform[k]);
        let equal = if triangles == patches * each { "equal" } else { "NOT EQUAL" };
        [
            NAMES[k].to_owned(),
            patches.to_string(),
            triangles.to_string(),
            format!("{patches} x {each}, {equal}"),
            format!("{:.2}", triangles as f64 / THOUSAND),
            PAPER_UNIFORM[k].to_owned(),
        ]
    };
    let columns = ["scene", "patches", "triangles", "by the pattern", "in 1024s", "paper"];
    let head = format!(
        "not adaptive, L = {}: every patch, nothing clipped or culled\n\n",
        study.options.level
    );
    head + &markdown::table(&columns, 1, &[row(0), row(1)])
}

/// A curve at every octave.
fn over_mu(curve: &Curve) -> String {
    let whole = |sample: &&Sample| sample.mu.log2().fract() == 0.0;
    let row = |sample: &Sample| {
        let [cups, elephants] = curve.fractions(sample).map(percent);
        [digits(sample.mu), cups, elephants]
    };
    let rows: Vec<_> = curve.samples.iter().filter(whole).map(row).collect();
    let mu = format!("mu, {}", curve.test.unit());
    let table = markdown::table(&[&mu, "teacups %", "elephants %"], 0, &rows);
    format!("control mesh: {}\n\n{table}", reading(curve.test.mesh))
}

/// A table of the samples nearest to the paper, with elephants of a size.
fn best(study: &Study, of: impl Fn(&Curve) -> (f64, &[Sample; 2])) -> String {
    let mut rows = Vec::new();
    for curve in &study.curves {
        let (size, best) = of(curve);
        for (number, (name, paper)) in PAPER.iter().enumerate() {
            let sample = &best[number];
            let both = |parts: [f64; SCENES]| parts.map(percent).join(" / ");
            let off = curve.deviation(sample, number);
            rows.push([
                curve.test.name(),
                (*name).to_owned(),
                digits(size),
                digits(sample.mu),
                both(paper.map(|hundredths| f64::from(hundredths) / 1e4)),
                both(curve.fractions(sample)),
                percent(off),
                if off <= f64::from(NEAR) / 1e4 { "yes" } else { "no" }.to_owned(),
            ]);
        }
    }
    let columns =
        ["test", "row", "size", "mu", "paper %", "measured %", "off by", "within five points"];
    markdown::table(&columns, 2, &rows)
}

fn verdict(study: &Study) -> String {
    let near = f64::from(NEAR) / 1e4;
    let rows = |curve: &Curve, best: &[Sample; 2]| {
        (0..PAPER.len()).filter(|&row| curve.deviation(&best[row], row) <= near).count()
    };
    let mut text = String::new();
    for curve in &study.curves {
        let (own, sized) = (rows(curve, &curve.best), rows(curve, &curve.sized.best));
        let (name, size) = (curve.test.name(), digits(curve.sized.size));
        let line = format!(
            "{name}: within five points: {own} of 2 rows; with elephants {size} times as large, \
             within five points: {sized} of 2"
        );
        writeln!(text, "{line}").expect("a String takes everything");
    }
    text + "elephants are a stand-in: their shape is ours, and so is their size\n"
}

/// `triangles.svg`: the elephants' part over the teacups' part, mu running along each curve, with
/// elephants of their own size and of that which suits the paper best; the paper's two rows as
/// points with five points' room around them.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg(study: &Study) -> Result<String> {
    let series = |curve: &Curve, size: f64| Series {
        name: format!("{}, size {}", curve.test.name(), digits(size)),
        points: curve
            .samples
            .iter()
            .map(|sample| [curve.part(0, sample.mu), curve.part(1, sample.mu / size)])
            .map(|parts| parts.map(|part| 100.0 * part).into())
            .collect(),
    };
    let own = study.curves.iter().map(|curve| series(curve, 1.0));
    let sized = study.curves.iter().map(|curve| series(curve, curve.sized.size));
    let mark = |(name, [x, y]): &(&str, [u32; SCENES])| Mark {
        name: format!("paper, {name}"),
        at: (f64::from(*x) / 100.0, f64::from(*y) / 100.0),
        room: f64::from(NEAR) / 100.0,
    };
    plot::svg(&Chart {
        file: "triangles.svg",
        title: "Adaptive triangles in % of the uniform ones, one mu for both scenes",
        x: "teacups",
        y: "elephants",
        ticks: Vec::new(),
        log: false,
        names: Names::UpperLeft,
        series: own.chain(sized).collect(),
        levels: Vec::new(),
        marks: PAPER.iter().map(mark).collect(),
    })
}

fn percent(part: f64) -> String {
    format!("{:.2}", 100.0 * part)
}

/// Three digits that count.
fn digits(value: f64) -> String {
    let places = (2 - value.log10().floor() as i32).clamp(0, 8) as usize;
    format!("{value:.places$}")
}
