//! The rows as a picture: bytes a triangle over the level, both logarithmic, a line a form.
//!
//! Colours are those of Okabe and Ito, which people with any kind of colour vision tell apart;
//! lines of triangles are thicker and marked by triangles. Text stays text.

use super::{CORNERS, Form, Row};
use crate::error::{Error, Result};
use plotters::prelude::*;
use std::io;

/// Pixels.
const PICTURE: (u32, u32) = (760, 540);

const fn color(form: Form) -> RGBColor {
    match form {
        Form::Patches => RGBColor(0, 0, 0),
        Form::Strip => RGBColor(0, 114, 178),
        Form::FanCompact => RGBColor(204, 121, 167),
        Form::FanFull => RGBColor(230, 159, 0),
        Form::Mesh => RGBColor(0, 158, 115),
        Form::IndexedMesh => RGBColor(86, 180, 233),
        Form::IndexedTriangles => RGBColor(213, 94, 0),
        Form::TriangleStrips => RGBColor(120, 50, 0),
        Form::VerticesOnce => RGBColor(130, 130, 130),
    }
}

/// `bandwidth.svg`, of the rows whose corners have attributes.
///
/// # Errors
/// None that can be expected: it is drawn into memory.
pub fn svg(rows: &[Row]) -> Result<String> {
    let mut text = String::new();
    let drawn = draw(&mut text, rows);
    drawn.map_err(|error| Error::system("bandwidth.svg", io::Error::other(error.to_string())))?;
    Ok(text)
}

fn draw(text: &mut String, rows: &[Row]) -> Result<(), Box<dyn std::error::Error>> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.size.corner_bytes == CORNERS[0]).collect();
    let at = |row: &Row| (row.size.level as f64, row.bytes() as f64 / row.size.triangles() as f64);
    let bounds = |values: &dyn Fn(&Row) -> f64| {
        let values = rows.iter().map(|row| values(row));
        values.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)))
    };
    let (left, right) = bounds(&|row| at(row).0);
    let (low, high) = bounds(&|row| at(row).1);
    let root = SVGBackend::with_string(text, PICTURE).into_drawing_area();
    root.fill(&WHITE)?;
    // A single level has a width too.
    let across = (left..right.max(2.0 * left)).log_scale().base(2.0);
    let up = (low / 1.6..high * 1.6).log_scale();
    let mut chart = ChartBuilder::on(&root)
        .caption("Bytes over the link for each triangle", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(across, up)?;
    chart
        .configure_mesh()
        .x_desc("level: segments of an edge")
        .y_desc("bytes a triangle")
        .x_label_formatter(&|level| format!("{level:.0}"))
        .y_label_formatter(&|bytes| format!("{bytes}"))
        .label_style(("sans-serif", 13))
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    for form in Form::ALL {
        let points = rows.iter().filter(|row| row.form == form).map(|row| at(row));
        let style = color(form).stroke_width(if form.is_triangles() { 3 } else { 2 });
        let series = LineSeries::new(points.clone(), style);
        let legend = move |(x, y)| PathElement::new(vec![(x, y), (x + 24, y)], style);
        chart.draw_series(series)?.label(form.name()).legend(legend);
        let marked = points.filter(|(level, _)| (*level as u64).is_power_of_two());
        let marks = marked.map(|at| match form.is_triangles() {
            true => TriangleMarker::new(at, 5, style.filled()).into_dyn(),
            false => Circle::new(at, 3, style.filled()).into_dyn(),
        });
        chart.draw_series(marks)?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE)
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 13))
        .draw()?;
    root.present()?;
    Ok(())
}
