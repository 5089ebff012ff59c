//! Picture: what has become of the points in; `sweep.svg` out, a chart for each thing that was
//! changed and each of three rates.

use super::outcome::Outcome;
use crate::error::Result;
use crate::study::plot::{self, Chart, Names, Series};
use indexmap::IndexSet;
use std::collections::BTreeMap;

/// The picture's name.
pub(super) const FILE: &str = "sweep.svg";

/// A rate, and what stands at its axis.
struct Rate {
    name: &'static str,
    axis: &'static str,
}

/// What is drawn, where points have it.
const RATES: [Rate; 3] = [
    Rate { name: "time", axis: "time, ms" },
    Rate { name: "link_bytes_per_frame", axis: "bytes over the link, a frame" },
    Rate { name: "triangles_per_frame", axis: "triangles, a frame" },
];

/// Things changed that a picture has room for: of more, the first.
const ROWS: usize = 6;

/// Names that a chart has room for.
const NAMES: usize = 8;

/// Characters that a title has room for.
const TITLE: usize = 64;

/// Characters that a name has room for.
const NAME: usize = 20;

/// An axis is logarithmic from this ratio of its ends on.
const WIDE: f64 = 8.0;

type Points = Vec<(f64, f64)>;

/// A column of the points.
struct Axis<'a> {
    name: &'a str,
    column: usize,
    /// Different values: numbers in their order, else in the study's.
    values: Vec<&'a str>,
}

/// The picture as SVG, of the points that have results. `columns` are those of the outcomes' cells.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub(super) fn svg(columns: &[&str], outcomes: &[Outcome]) -> Result<String> {
    let points: Vec<_> = outcomes.iter().filter(|outcome| !outcome.rates.is_empty()).collect();
    let axes = columns.iter().enumerate().map(|(column, name)| Axis::new(name, column, &points));
    let (numbers, mut differ): (Vec<_>, Vec<_>) = axes
        .filter(|axis| axis.name == "point" || axis.values.len() > 1)
        .partition(|axis| axis.name == "point");
    // Units tell lines apart. They are an axis where nothing else is; where they are alike, too,
    // the number of the point is.
    differ.sort_by_key(|axis| axis.name != "unit");
    let mut changed: Vec<_> = differ.iter().filter(|axis| axis.name != "unit").take(ROWS).collect();
    if changed.is_empty() {
        changed.extend(differ.iter().chain(&numbers).next());
    }
    let has = |rate: &&Rate| points.iter().any(|point| value(point, rate.name).is_some());
    let mut rates: Vec<_> = RATES.iter().filter(has).collect();
    if rates.is_empty() {
        rates.push(&RATES[0]);
    }
    let titles: Vec<_> = changed.iter().map(|axis| title(axis, &differ)).collect();
    let mut charts = Vec::new();
    for (axis, title) in changed.into_iter().zip(&titles) {
        for rate in &rates {
            charts.push(chart(axis, title, lines(axis, &differ, &points, rate), rate));
        }
    }
    plot::panels(FILE, &charts, rates.len())
}

fn chart<'c>(axis: &Axis<'c>, title: &'c str, series: Vec<Series>, rate: &Rate) -> Chart<'c> {
    let values = || series.iter().flat_map(|line| &line.points).map(|point| point.1);
    let [least, most] = [values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max)];
    Chart {
        file: FILE,
        title,
        x: axis.name,
        y: rate.axis,
        ticks: axis.values.iter().map(|value| short(value)).collect(),
        log: least > 0.0 && most / least >= WIDE,
        names: Names::Above,
        series,
        levels: Vec::new(),
        marks: Vec::new(),
    }
}

impl<'a> Axis<'a> {
    fn new(name: &'a str, column: usize, points: &[&'a Outcome]) -> Self {
        let values: IndexSet<_> = points.iter().map(|point| point.cells[column].as_str()).collect();
        let mut values: Vec<_> = values.into_iter().collect();
        if values.iter().all(|value| number(value).is_some()) {
            values.sort_by(|a, b| number(a).partial_cmp(&number(b)).expect("all are finite"));
        }
        Self { name, column, values }
    }

    fn of<'p>(&self, point: &'p Outcome) -> &'p str {
        &point.cells[self.column]
    }
}

/// What is over what, and what else tells lines apart.
fn title(axis: &Axis<'_>, differ: &[Axis<'_>]) -> String {
    let (color, rest) = others(axis, differ);
    let mut title = format!("over {}", axis.name);
    if let Some(color) = color {
        title += &format!(", a colour each {}", color.name);
    }
    let rest: Vec<_> = rest.iter().map(|axis| axis.name).collect();
    if !rest.is_empty() {
        title += &format!(", a line each {}", rest.join(", "));
    }
    if title.chars().count() > TITLE {
        title = title.chars().take(TITLE - 1).chain(['\u{2026}']).collect();
    }
    title
}

/// The first other thing that has not too many values to be told apart by colour, and the rest.
fn others<'d, 'a>(
    axis: &Axis<'_>,
    differ: &'d [Axis<'a>],
) -> (Option<&'d Axis<'a>>, Vec<&'d Axis<'a>>) {
    let mut others: Vec<_> = differ.iter().filter(|o| o.column != axis.column).collect();
    let few = others.iter().position(|other| other.values.len() <= NAMES);
    (few.map(|at| others.remove(at)), others)
}

/// A line for the points that differ in nothing but the axis; those of one colour come together,
/// under one name, and every colour comes, so that it is the same in all charts.
fn lines(axis: &Axis<'_>, differ: &[Axis<'_>], points: &[&Outcome], rate: &Rate) -> Vec<Series> {
    let (color, rest) = others(axis, differ);
    let names = color.map_or_else(|| vec![rate.axis], |color| color.values.clone());
    // For each colour, by what else tells lines apart.
    let mut colors = vec![BTreeMap::<Vec<usize>, Points>::new(); names.len()];
    for point in points {
        let place = |axis: &Axis<'_>| axis.values.iter().position(|value| *value == axis.of(point));
        let place = |axis| place(axis).expect("the values are those of the points");
        let Some(value) = value(point, rate.name) else { continue };
        let line = rest.iter().map(|axis| place(axis)).collect();
        let at = (place(axis) as f64, value);
        colors[color.map_or(0, place)].entry(line).or_default().push(at);
    }
    let mut series = Vec::new();
    for (name, lines) in names.into_iter().zip(colors) {
        let mut lines = lines.into_values().map(|mut points| {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points
        });
        series.push(Series { name: short(name), points: lines.next().unwrap_or_default() });
        series.extend(lines.map(|points| Series { name: String::new(), points }));
    }
    series
}

/// A rate of a point.
fn value(point: &Outcome, rate: &str) -> Option<f64> {
    point.rate(rate).and_then(number)
}

/// A finite number.
fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The end of a long name: of a path, that is the file. A key without a value has a name as well.
fn short(name: &str) -> String {
    if name.is_empty() {
        return "not set".to_owned();
    }
    let length = name.chars().count();
    if length <= NAME {
        return name.to_owned();
    }
    let end: String = name.chars().skip(length - NAME + 1).collect();
    format!("\u{2026}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [&str; 6] = ["point", "trace", "preset", "unit", "link.bus", "level.pixels"];

    /// Points with a time that is their number.
    fn points(cells: &[[&str; 3]]) -> Vec<Outcome> {
        let point = |(number, [unit, bus, pixels]): (usize, &[&str; 3])| {
            let number = number.to_string();
            let cells = [&number, "../teapot.jsonl", "modern", unit, bus, pixels];
            let rates =
                vec![("time".to_owned(), number.clone()), ("clock".to_owned(), "2".to_owned())];
            Outcome::completed(cells.map(str::to_owned).into(), rates)
        };
        cells.iter().enumerate().map(point).collect()
    }

    /// The texts of a picture, in its order.
    fn texts(svg: &str) -> Vec<&str> {
        let texts = svg.split("</text>").filter_map(|part| part.rsplit_once('>'));
        texts.map(|(_, text)| text.trim()).filter(|text| !text.is_empty()).collect()
    }

    #[test]
    fn lines_are_of_points_that_differ_in_the_axis_alone() {
        let cells: Vec<_> = ["sfarti", "hybrid"]
            .into_iter()
            .flat_map(|unit| ["agp4x", "pcie2x16"].map(|bus| (unit, bus)))
            .flat_map(|(unit, bus)| ["4", "1", "0.25"].map(|pixels| [unit, bus, pixels]))
            .collect();
        let points = points(&cells);
        let points: Vec<_> = points.iter().collect();
        let axes: Vec<_> = [3, 4, 5].map(|c| Axis::new(COLUMNS[c], c, &points)).into();
        assert_eq!(axes[2].values, ["0.25", "1", "4"], "numbers are sorted");
        assert_eq!(axes[0].values, ["sfarti", "hybrid"], "names are in the study's order");
        let lines = lines(&axes[2], &axes, &points, &RATES[0]);
        let found: Vec<_> =
            lines.iter().map(|line| (line.name.as_str(), &line.points[..])).collect();
        let line =
            |name, first: f64| (name, [(0.0, first), (1.0, first - 1.0), (2.0, first - 2.0)]);
        let wanted = [line("sfarti", 2.0), line("", 5.0), line("hybrid", 8.0), line("", 11.0)];
        assert!(found.iter().copied().eq(wanted.iter().map(|(name, points)| (*name, &points[..]))));
        assert_eq!(
            title(&axes[2], &axes),
            "over level.pixels, a colour each unit, a line each link.bus"
        );
    }

    #[test]
    fn there_is_a_chart_for_each_thing_that_was_changed() {
        let two = points(&[
            ["hybrid", "agp4x", "4"],
            ["hybrid", "pcie2x16", "4"],
            ["hybrid", "agp4x", "1"],
        ]);
        let drawn = svg(&COLUMNS, &two).unwrap();
        let texts = texts(&drawn);
        for text in ["link.bus", "agp4x", "pcie2x16", "level.pixels", "time, ms"] {
            assert!(texts.contains(&text), "{text}: {texts:?}");
        }
        assert!(!texts.contains(&"unit") && !texts.contains(&"bytes over the link, a frame"));
    }

    #[test]
    fn units_alone_are_an_axis_and_so_is_a_single_point_and_nothing_fails() {
        let units = points(&[["hybrid", "agp4x", "4"], ["sfarti", "agp4x", "4"]]);
        let drawn = svg(&COLUMNS, &units).unwrap();
        assert!(
            ["unit", "hybrid", "sfarti"].iter().all(|text| texts(&drawn).contains(text)),
            "{drawn}"
        );
        let drawn = svg(&COLUMNS, &units[..1]).unwrap();
        assert!(texts(&drawn).contains(&"point") && drawn.matches("<circle").count() == 1);
        let drawn = svg(&COLUMNS, &[]).unwrap();
        assert!(texts(&drawn).contains(&"point") && !drawn.contains("<circle"));
    }

    #[test]
    fn of_long_names_the_end_is_kept() {
        assert_eq!(short("../traces/models/teapot.jsonl"), "\u{2026}models/teapot.jsonl");
        assert_eq!(short("teapot.jsonl"), "teapot.jsonl");
        assert_eq!(short(""), "not set");
    }

    #[test]
    fn many_values_are_no_colours_and_a_colour_is_the_same_in_all_charts() {
        let pixels: Vec<_> = (0..12).map(|n| n.to_string()).collect();
        let cells: Vec<_> = pixels
            .iter()
            .flat_map(|pixels| ["agp4x", "pcie2x16"].map(|bus| ["hybrid", bus, pixels]))
            .collect();
        let mut points = points(&cells);
        let drawn = svg(&COLUMNS, &points).unwrap();
        assert!(texts(&drawn).contains(&"over link.bus, a line each level.pixels"));
        assert!(texts(&drawn).contains(&"over level.pixels, a colour each link.bus"));
        for point in points.iter_mut().filter(|point| point.cells[4] == "agp4x") {
            point.rates.retain(|(name, _)| name != "time");
        }
        let points: Vec<_> = points.iter().collect();
        let axes: Vec<_> = [4, 5].map(|c| Axis::new(COLUMNS[c], c, &points)).into();
        let lines = lines(&axes[1], &axes, &points, &RATES[0]);
        let found: Vec<_> = lines.iter().map(|l| (l.name.as_str(), l.points.len())).collect();
        assert_eq!(found, [("agp4x", 0), ("pcie2x16", 12)]);
    }
}
