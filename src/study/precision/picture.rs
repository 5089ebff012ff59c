//! Pictures: error against bits, of the unit's positions and of the evaluators by themselves.

use super::evaluators::{self, BIT_DB, Evaluator};
use super::{Row, Study};
use crate::error::Result;
use crate::study::plot::{self, Chart, Names, Series};

/// `precision.svg`: errors over the bits of a position, everything else as wide as the grid has it.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg_of_widths(study: &Study) -> Result<String> {
    let widest = study.rows.iter().rev().max_by_key(|row| row.widths.datapath());
    let alike = |row: &&Row| {
        widest.is_some_and(|w| {
            let (mut a, b) = (row.formats, w.formats);
            a.width = b.width;
            a == b
        })
    };
    let rows: Vec<&Row> = study.rows.iter().filter(alike).collect();
    let series = |name: &str, value: &dyn Fn(&Row) -> f64| Series {
        name: name.to_owned(),
        points: rows.iter().map(|row| (row.formats.width.into(), value(row))).collect(),
    };
    plot::svg(&Chart {
        file: "precision.svg",
        title: "Position error over bits of a position, other formats at their widest",
        x: "bits of a position",
        y: "pixels",
        ticks: Vec::new(),
        log: true,
        names: Names::LowerLeft,
        series: vec![
            series("largest, at the exact parameters", &|r| r.measured.exact.largest),
            series("largest, at the reported ones", &|r| r.measured.reported.largest),
            series("RMS, at the reported ones", &|r| r.measured.reported.rms()),
            series("largest, surface to triangles", &|r| r.measured.surface.largest_pixels),
        ],
        levels: vec![(format!("{} px", study.max_error), study.max_error)],
        marks: Vec::new(),
    })
}

/// `evaluators.svg`: the RMS error of each evaluator in decibels of a pixel, at its fewest guard
/// bits, and the slope of a bit that halves it.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg_of_evaluators(rows: &[evaluators::Row]) -> Result<String> {
    let mut segments: Vec<u32> = rows.iter().map(|row| row.segments).collect();
    segments.sort_unstable();
    segments.dedup();
    let most = segments.last().copied().unwrap_or_default();
    let of = |evaluator: Evaluator, n: u32, name: String| {
        let guard = evaluator.guard_min();
        let own = move |row: &&evaluators::Row| {
            (row.evaluator, row.segments, row.guard) == (evaluator, n, guard)
        };
        let at = |row: &evaluators::Row| Some((f64::from(row.width), row.decibels()?));
        Series { name, points: rows.iter().filter(own).filter_map(at).collect() }
    };
    let mut series =
        vec![of(Evaluator::DeCasteljau, most, format!("de Casteljau, {most} segments"))];
    for &n in &segments {
        let name = format!("forward, {n} segments ({} steps)", n / 2);
        series.push(of(Evaluator::Forward, n, name));
    }
    series.push(of(Evaluator::PowerBasis, most, format!("NBM, {most} segments")));
    if let Some(&(first, start)) = series[0].points.first() {
        let last = series[0].points.last().map_or(first, |point| point.0);
        let below = start - 6.0; // beside the lines, not on them
        let points = vec![(first, below), (last, below - (last - first) * BIT_DB)];
        series.push(Series { name: format!("{BIT_DB:.2} dB a bit"), points });
    }
    plot::svg(&Chart {
        file: "evaluators.svg",
        title: "RMS error of points over bits of a position, fewest guard bits",
        x: "bits of a position",
        y: "dB of a pixel",
        ticks: Vec::new(),
        log: false,
        names: Names::LowerLeft,
        series,
        levels: vec![("a quarter of a pixel".to_owned(), 20.0 * 0.25f64.log10())],
        marks: Vec::new(),
    })
}
