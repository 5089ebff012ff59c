//! `summary.json`: what a run was made of and what came of it, for programs that do not want to add
//! up rows: totals, rates with their units, shares, and the hashes that reproduce it.

use crate::report::{Fates, Frame, Report};
use rtl_model::counter::{Block, Counter};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::path::Path;

/// What a run read: the trace and the files that it names.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// The trace's title.
    pub title: String,
    /// Where the trace's data come from.
    pub source: String,
    /// The licence of the trace's data.
    pub licence: String,
    /// SHA-256 of the trace, hexadecimal.
    pub sha256: String,
    /// The files that the trace names, in the order of their first use.
    pub files: Vec<DataFile>,
}

/// A file that a trace names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DataFile {
    /// As the trace names it: relative to the trace's folder.
    pub name: String,
    /// SHA-256, hexadecimal.
    pub sha256: String,
}

/// The text of `summary.json`.
#[must_use]
pub fn text(report: &Report, provenance: &Provenance) -> String {
    let whole = report.whole();
    let value = json!({
        "tessim": env!("CARGO_PKG_VERSION"),
        "trace": provenance,
        "unit": report.config.unit.name(),
        "engine": report.config.engine,
        "frames": report.frames.len(),
        "totals": totals_by_name(report, &whole),
        "rates": rates(report, &whole),
        "shares": shares(report, &whole),
    });
    let mut text = serde_json::to_string_pretty(&value).expect("names and numbers are JSON");
    text.push('\n');
    text
}

/// The text of the `summary.json` of runs of one trace under the same layers, one a unit.
#[must_use]
pub fn comparison(reports: &[&Report], provenance: &Provenance) -> String {
    let unit = |report: &&Report| {
        let whole = report.whole();
        json!({
            "unit": report.config.unit.name(),
            "totals": totals_by_name(report, &whole),
            "rates": rates(report, &whole),
            "shares": shares(report, &whole),
        })
    };
    let value = json!({
        "tessim": env!("CARGO_PKG_VERSION"),
        "trace": provenance,
        "engine": reports.first().map(|report| report.config.engine),
        "frames": reports.first().map_or(0, |report| report.frames.len()),
        "units": reports.iter().map(unit).collect::<Vec<_>>(),
    });
    let mut text = serde_json::to_string_pretty(&value).expect("names and numbers are JSON");
    text.push('\n');
    text
}

/// Whether the file at `path` is a summary that some version of `tessim` wrote.
#[must_use]
pub fn is_summary(path: &Path) -> bool {
    std::fs::read(path)
        .ok()
        .and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok())
        .is_some_and(|summary| summary.get("tessim").is_some_and(Value::is_string))
}

fn totals_by_name(report: &Report, whole: &Frame) -> Value {
    let named = report
        .rows(whole)
        .into_iter()
        .map(|row| (format!("{}.{}", row.block.name(), row.name), row.value.into()));
    Value::Object(named.collect())
}

/// A ratio, or `None` where there is nothing to divide by.
#[must_use]
pub fn ratio(of: u64, per: u64) -> Option<f64> {
    (per != 0).then(|| of as f64 / per as f64)
}

fn rates(report: &Report, whole: &Frame) -> Value {
    let totals = &whole.counters;
    let link = totals.get(Counter::LinkTotal);
    let triangles = totals.get(Counter::EmitTriangles);
    let patches = totals.get(Counter::TracePatches);
    let frames = report.frames.len() as u64;
    let rate = |of, per, unit: &str| json!({ "value": ratio(of, per), "unit": unit });
    let mut rates = json!({
        "link_bytes_per_triangle": rate(link, triangles, "bytes/triangle"),
        "link_bytes_per_triangle_if_the_host_tessellated":
            rate(report.host_link_bytes, triangles, "bytes/triangle"),
        "link_bytes_per_patch": rate(link, patches, "bytes/patch"),
        "link_bytes_per_frame": rate(link, frames, "bytes/frame"),
        "triangles_per_patch": rate(triangles, patches, "triangles/patch"),
        "triangles_per_frame": rate(triangles, frames, "triangles/frame"),
        "vertices_per_triangle":
            rate(totals.get(Counter::EmitVertices), triangles, "vertices/triangle"),
    });
    if let Some(times) = &whole.times {
        let (cycles, clock) = (times.elapsed, u64::from(report.config.clock_mhz));
        let per_second = ratio(triangles, cycles).map(|rate| rate * clock as f64 * 1e6);
        rates["cycles_per_triangle"] = rate(cycles, triangles, "cycles/triangle");
        rates["triangles_per_cycle"] = rate(triangles, cycles, "triangles/cycle");
        rates["triangles_per_second"] = json!({ "value": per_second, "unit": "triangles/s" });
        rates["time"] = rate(cycles, 1000 * clock, "ms");
        rates["clock"] = json!({ "value": clock, "unit": "MHz" });
    }
    rates
}

fn shares(report: &Report, whole: &Frame) -> Value {
    let totals = &whole.counters;
    let mut shares = Map::new();
    let mut share = |name: String, of, per| {
        shares.insert(name, ratio(of, per).into());
    };
    let link = totals.get(Counter::LinkTotal);
    let kinds = report
        .declarations()
        .filter(|declared| declared.block == Block::Link && declared.counter != Counter::LinkTotal);
    for kind in kinds {
        share(format!("link.{} of link bytes", kind.name), totals.get(kind.counter), link);
    }
    let patches = totals.get(Counter::TracePatches);
    let Fates { clipped, culled, tessellated } = Fates::of(totals);
    let share_of_patches = [
        (Block::Clip, "patches clipped", clipped),
        (Block::Backface, "patches back-facing", culled),
        (Block::Level, "patches tessellated", tessellated),
    ];
    for (block, name, count) in share_of_patches {
        if report.blocks.contains(&block) {
            share(format!("{name} of patches"), count, patches);
        }
    }
    let times = whole.times.iter().flat_map(|times| &times.stages);
    for (stage, t) in report.chain.iter().zip(times) {
        let block = stage.block.name();
        share(format!("{block} used (utilisation) of its cycles"), t.used, t.total);
        share(format!("{block} busy of its cycles"), t.busy, t.total);
        share(format!("{block} starved of its cycles"), t.starved + t.starved_by_port, t.total);
        share(format!("{block} blocked of its cycles"), t.blocked + t.blocked_by_order, t.total);
    }
    Value::Object(shares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::output::timed_report;
    use rtl_model::counter::Counters;

    #[test]
    fn a_summary_knows_itself_and_divides_by_nothing() {
        let mut counters = Counters::default();
        counters.add(Counter::LinkTotal, 300);
        counters.add(Counter::EmitTriangles, 8);
        let blocks = &[Block::Link, Block::Clip, Block::Emit];
        let report = Report {
            config: Config::default(),
            blocks,
            chain: Vec::new(),
            frames: vec![Frame { counters, ..Frame::default() }],
            occupancy: Vec::new(),
            host_link_bytes: 100,
        };
        let text = text(&report, &Provenance::default());
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["totals"]["link.bytes.total"], 300);
        assert_eq!(value["rates"]["link_bytes_per_triangle"]["value"], 37.5);
        assert_eq!(value["rates"]["link_bytes_per_patch"]["value"], Value::Null);
        assert_eq!(value["shares"]["patches clipped of patches"], Value::Null);
        assert_eq!(value["shares"]["link.bytes.commands of link bytes"], 0.0);
        assert!(value["totals"].get("stitch.triangles").is_none());
        assert_eq!(value["engine"], "timed");
        assert!(value["rates"].get("time").is_none());

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        std::fs::write(&path, text).unwrap();
        assert!(is_summary(&path));
        std::fs::write(&path, "{\"name\":\"tessim\"}").unwrap();
        assert!(!is_summary(&path));
    }

    #[test]
    fn a_timed_run_has_rates_at_its_clock_and_shares_of_its_cycles() {
        let text = text(&timed_report(), &Provenance::default());
        let value: Value = serde_json::from_str(&text).unwrap();
        let rate = |name: &str| value["rates"][name]["value"].as_f64().unwrap();
        // Two frames of 100 cycles and 4 triangles at 2 GHz.
        assert_eq!(rate("cycles_per_triangle"), 25.0);
        assert_eq!(rate("triangles_per_cycle"), 0.04);
        assert_eq!(rate("triangles_per_second"), 8e7);
        assert_eq!(rate("time"), 1e-4);
        let totals = &value["totals"];
        assert_eq!(totals["unit.cycles.total"], 200);
        assert_eq!(totals["stitch.fifo.peak"], 2, "the greatest of 2 and 1");
        assert_eq!(totals["stitch.ops.mul.bits"], 60);
        assert_eq!(totals["vertex_shader.cycles.starved"], 240);
        assert_eq!(totals["vertex_shader.cycles.starved.by.stitch"], 210);
        let shares = &value["shares"];
        assert_eq!(shares["stitch used (utilisation) of its cycles"], 0.94);
        assert_eq!(shares["stitch busy of its cycles"], 0.95);
        assert_eq!(shares["vertex_shader starved of its cycles"], 0.4);
        assert_eq!(shares["vertex_shader blocked of its cycles"], 0.2);
    }
}
