//! Plot: series of points in, a picture with a line for each out. Colours are those of Okabe and
//! Ito, which people with any kind of colour vision tell apart. Text stays text.

use crate::error::{Error, Result};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use std::cmp::Ordering;
use std::io;

/// Pixels.
const PICTURE: (u32, u32) = (760, 540);

/// Pixels of each of several charts in one picture.
const PANEL: (u32, u32) = (520, 380);

/// Names that an axis has room for.
const TICKS: usize = 12;

const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(130, 130, 130),
];

/// A line.
pub(super) struct Series {
    /// Nothing for one more line of the series before, in its colour.
    pub(super) name: String,
    pub(super) points: Vec<(f64, f64)>,
}

/// A point to compare with, and a square of so much room around it.
pub(super) struct Mark {
    pub(super) name: String,
    pub(super) at: (f64, f64),
    pub(super) room: f64,
}

/// Where there is nothing but the names of series.
#[derive(Clone, Copy)]
pub(super) enum Names {
    UpperLeft,
    LowerLeft,
    /// Above the data.
    Above,
}

impl Names {
    const fn position(self) -> SeriesLabelPosition {
        match self {
            Self::UpperLeft => SeriesLabelPosition::UpperLeft,
            Self::LowerLeft => SeriesLabelPosition::LowerLeft,
            Self::Above => SeriesLabelPosition::UpperRight,
        }
    }
}

/// A picture.
pub(super) struct Chart<'a> {
    /// What errors call it.
    pub(super) file: &'a str,
    pub(super) title: &'a str,
    pub(super) x: &'a str,
    pub(super) y: &'a str,
    /// What x = 0, 1, 2, ... are called; empty: numbers.
    pub(super) ticks: Vec<String>,
    /// Whether y is logarithmic.
    pub(super) log: bool,
    /// Where names stand.
    pub(super) names: Names,
    pub(super) series: Vec<Series>,
    /// Horizontal lines.
    pub(super) levels: Vec<(String, f64)>,
    pub(super) marks: Vec<Mark>,
}

/// The picture as SVG.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub(super) fn svg(chart: &Chart<'_>) -> Result<String> {
    drawn(chart.file, std::slice::from_ref(chart), 1, PICTURE)
}

/// Charts side by side as SVG, row by row.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub(super) fn panels(file: &str, charts: &[Chart<'_>], columns: usize) -> Result<String> {
    drawn(file, charts, columns, PANEL)
}

fn drawn(file: &str, charts: &[Chart<'_>], columns: usize, each: (u32, u32)) -> Result<String> {
    let mut text = String::new();
    let drawn = draw_all(&mut text, charts, columns, each);
    drawn.map_err(|error| Error::system(file, io::Error::other(error.to_string())))?;
    Ok(text)
}

fn draw_all(
    text: &mut String,
    charts: &[Chart<'_>],
    columns: usize,
    each: (u32, u32),
) -> Result<(), Box<dyn std::error::Error>> {
    let rows = charts.len().div_ceil(columns);
    let size = (each.0 * columns as u32, each.1 * rows as u32);
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, chart) in root.split_evenly((rows, columns)).iter().zip(charts) {
        let [_, (low, high)] = chart.bounds();
        let names_above = matches!(chart.names, Names::Above);
        if chart.log {
            let above = if names_above { (high / low).sqrt().max(2.0) } else { 1.5 };
            draw(area, chart, (low / 1.5..high * above).log_scale())?;
        } else {
            let room = 0.05 * (high - low).max(1e-9);
            let above = if names_above { 10.0 * room } else { room };
            draw(area, chart, low - room..high + above)?;
        }
    }
    root.present()?;
    Ok(())
}

impl Chart<'_> {
    /// Least and greatest x and y. A logarithmic axis has no zeros.
    fn bounds(&self) -> [(f64, f64); 2] {
        let lines = self.series.iter().flat_map(|series| series.points.iter().copied());
        let marks =
            self.marks.iter().flat_map(|m| [-m.room, m.room].map(|r| (m.at.0 + r, m.at.1 + r)));
        let points: Vec<(f64, f64)> = lines.chain(marks).collect();
        let of = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let x = match self.ticks.len() {
            0 => of(&mut points.iter().map(|p| p.0)),
            names => (0.0, (names - 1).max(1) as f64),
        };
        let levels = self.levels.iter().map(|level| level.1);
        let ys = points.iter().map(|p| p.1).chain(levels).filter(|y| !self.log || *y > 0.0);
        let y = of(&mut ys.collect::<Vec<_>>().into_iter());
        [x, y].map(|(a, b)| match a.partial_cmp(&b) {
            Some(Ordering::Less) => (a, b),
            // One value, in the middle of its own size; or none.
            Some(Ordering::Equal) if a != 0.0 => (a - a.abs() / 2.0, a + a.abs() / 2.0),
            _ => (0.0, 1.0),
        })
    }

    /// What stands at an x.
    fn tick(&self, at: f64) -> String {
        if self.ticks.is_empty() {
            return tick(at);
        }
        let whole = (at - at.round()).abs() < 1e-6 && at > -0.5;
        let name = whole.then(|| self.ticks.get(at.round() as usize)).flatten();
        name.cloned().unwrap_or_default()
    }
}

fn draw<Y>(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    chart: &Chart<'_>,
    up: Y,
) -> Result<(), Box<dyn std::error::Error>>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let [(left, right), _] = chart.bounds();
    let room = 0.03 * (right - left);
    let mut context = ChartBuilder::on(area)
        .caption(chart.title, ("sans-serif", 17))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d(left - room..right + room, up)?;
    context
        .configure_mesh()
        .x_desc(chart.x)
        .y_desc(chart.y)
        .x_labels(if chart.ticks.is_empty() { TICKS } else { TICKS.min(chart.ticks.len() + 1) })
        .x_label_formatter(&|at| chart.tick(*at))
        .y_label_formatter(&|at| tick(*at))
        .label_style(("sans-serif", 13))
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    let mut colors = COLORS.iter().cycle();
    let mut color = &BLACK;
    for series in &chart.series {
        if !series.name.is_empty() {
            color = colors.next().expect("a cycle has no end");
        }
        let shown = series.points.iter().copied().filter(|p| !chart.log || p.1 > 0.0);
        let style = color.stroke_width(2);
        let legend = move |(x, y)| PathElement::new(vec![(x, y), (x + 24, y)], style);
        let line = LineSeries::new(shown.clone(), style);
        let drawn = context.draw_series(line)?;
        if !series.name.is_empty() {
            drawn.label(series.name.as_str()).legend(legend);
        }
        context.draw_series(shown.map(|at| Circle::new(at, 3, style.filled())))?;
    }
    for (name, y) in &chart.levels {
        let line = vec![(left - room, *y), (right + room, *y)];
        context.draw_series(std::iter::once(PathElement::new(line, BLACK.mix(0.5))))?;
        let words = Text::new(name.clone(), (left, *y), ("sans-serif", 13));
        context.draw_series(std::iter::once(words))?;
    }
    for mark in &chart.marks {
        let ((x, y), r) = (mark.at, mark.room);
        let square = Rectangle::new([(x - r, y - r), (x + r, y + r)], BLACK.mix(0.5));
        context.draw_series(std::iter::once(square))?;
        context.draw_series(std::iter::once(Cross::new((x, y), 5, BLACK.stroke_width(2))))?;
        let words = Text::new(mark.name.clone(), (x - r, y + r), ("sans-serif", 13));
        context.draw_series(std::iter::once(words))?;
    }
    context
        .configure_series_labels()
        .position(chart.names.position())
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 13))
        .draw()?;
    Ok(())
}

/// A number at an axis, without zeros that say nothing.
fn tick(value: f64) -> String {
    if (1e-12..1e-3).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
