//! Dispatches for a third witness: whatever evaluate and stitch were given for shipped traces, and
//! what they made of it, once that has been found equal to the first implementation's.
//!
//! `TESSIM_RECORD=FOLDER` writes them, a file each, for tests/browser/witness.mjs.

use crate::support;
use std::path::{Path, PathBuf};
use tessim::config::layers::Layers;
use tessim::config::preset::Preset;
use tessim::config::{Config, Engine, Unit};
use tessim::gpu::{Device, Dispatch};
use tessim::study::check;
use tessim::trace::replay::Replay;

/// Traces, units and settings: fractional lists by forward differencing, dyadic ones by de
/// Casteljau, narrow and wide.
const RUNS: [(&str, Unit, &[&str]); 6] = [
    ("teapot", Unit::Hybrid, &["level.level=6.5"]),
    ("mesh", Unit::Hybrid, &["position.width=48", "evaluate.rounding=nearest_away"]),
    ("rational", Unit::Hybrid, &["position.width=13", "evaluate.rounding=floor"]),
    ("strip", Unit::Moreton, &["position.width=40", "evaluate.scheme=mixed"]),
    ("fan", Unit::Sfarti, &["position.width=24"]),
    ("teaspoon", Unit::Sfarti, &["position.width=44", "evaluate.rounding=nearest_up"]),
];

/// The kernels that a browser runs again.
const KERNELS: [&str; 2] = ["evaluate.wgsl", "stitch.wgsl"];

fn recorded(device: &Device, trace: &str, unit: Unit, settings: &[&str]) -> Vec<Dispatch> {
    let mut layers = Layers::new(Preset::default());
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    layers.set(&settings).unwrap();
    let config = Config { engine: Engine::None, ..layers.for_unit(unit).unwrap() };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{trace}.jsonl"));
    device.record();
    let checked = check::run(&mut Replay::open(&path).unwrap(), &config, device, |_| {}).unwrap();
    let [values, different] = checked.ledger.totals();
    assert!(values > 1000 && different == 0, "{trace}: {different} of {values} differ");
    let mut dispatches = device.recorded();
    dispatches.retain(|d| d.files.last().is_some_and(|file| KERNELS.contains(file)));
    dispatches
}

#[test]
fn what_is_recorded_is_what_was_compared() {
    // A device of its own: others dispatch on the common one meanwhile.
    if support::device().is_none() {
        return;
    }
    let device = support::another(support::backend()).expect("another of the same kind");
    let folder = std::env::var_os("TESSIM_RECORD").map(PathBuf::from);
    let runs = if folder.is_some() { &RUNS[..] } else { &RUNS[4..5] };
    let mut number = 0;
    for &(trace, unit, settings) in runs {
        let dispatches = recorded(&device, trace, unit, settings);
        for kernel in KERNELS {
            let of = |d: &&Dispatch| d.files.last() == Some(&kernel);
            let words: usize =
                dispatches.iter().filter(of).flat_map(|d| &d.after).map(Vec::len).sum();
            println!("{trace} {}: {words} words of {kernel}", unit.name());
            assert!(words > 1000, "{trace}: {kernel}");
        }
        for dispatch in &dispatches {
            // A count of degenerate triangles may well stay 0.
            let writes = dispatch.entry != "degenerate";
            assert!(!writes || dispatch.before != dispatch.after, "{}", dispatch.entry);
            if let Some(folder) = &folder {
                let text = serde_json::to_vec(dispatch).unwrap();
                std::fs::write(folder.join(format!("{number}.json")), text).unwrap();
            }
            number += 1;
        }
    }
    assert!(number > 1);
}
