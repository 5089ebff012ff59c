//! `summary.json`: what the study was of, what serves and what the front is, for programs.

use super::{Row, Study};
use crate::output::summary::Provenance;
use serde_json::{Value, json};

/// The text of `summary.json`.
#[must_use]
pub fn summary(study: &Study, provenance: &Provenance) -> String {
    let value = json!({
        "tessim": env!("CARGO_PKG_VERSION"),
        "trace": provenance,
        "unit": study.base.unit.name(),
        "grid": study.grid,
        "measured": study.rows.len(),
        "corner_runs": study.corner_runs,
        "max_error_px": study.max_error,
        "narrowest": study.narrowest.map(|k| point(&study.rows[k])),
        "front": study.front.iter().map(|&k| point(&study.rows[k])).collect::<Vec<_>>(),
    });
    let mut text = serde_json::to_string_pretty(&value).expect("names and numbers are JSON");
    text.push('\n');
    text
}

fn point(row: &Row) -> Value {
    let (formats, measured) = (&row.formats, &row.measured);
    json!({
        "position.width": formats.width,
        "evaluate.guard": formats.guard,
        "place.reciprocal_bits": formats.reciprocal,
        "emit.subpixel_bits": formats.subpixel,
        "rounding": formats.rounding_name(),
        "position.overflow": formats.overflow_name(),
        "datapath_bits": row.widths.datapath(),
        "area_cells": row.area,
        "largest_px": measured.largest(),
        "rms_px": measured.exact.rms(),
        "cracks": measured.cracks,
    })
}
