//! `tessim sweep` as users meet it: tables, results that repeat themselves, sweeps that go on, that
//! are shared and that are killed, and studies that are none.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[path = "sweep/killed.rs"]
mod killed;
#[cfg(feature = "parquet")]
#[path = "sweep/parquet.rs"]
mod parquet;
#[path = "sweep/place.rs"]
mod place;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/random.rs"]
mod random;
#[path = "sweep/refused.rs"]
mod refused;
#[path = "sweep/shared.rs"]
mod shared;

use place::{Place, count, printed, shipped, tessim};
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

/// Of every kind of axis something; `mesh.jsonl` has two frames.
const STUDY: &str = "traces = [\"mesh.jsonl\", \"fan.jsonl\"]\nunits = [\"sfarti\", \"hybrid\"]\n\
                     presets = [\"gf3-2001\"]\nconfig = \"base.toml\"\n\
                     [set]\n\"level.level\" = 3\n\
                     [grid]\nposition.width = [24, 16]\n\
                     evaluate.scheme = [\"mixed\", \"forward\"]\n\
                     [[list]]\nposition.width = 40\nunit = \"esc\"\ntrace = \"fan.jsonl\"\n\
                     preset = \"modern\"\n[[list]]\nengine = \"none\"\n";

fn place() -> Place {
    let place = Place::new(STUDY);
    fs::write(place.path("base.toml"), "level.level = 5\nevaluate.guard = 15\n").unwrap();
    place
}

#[test]
fn rows_are_in_the_order_of_the_study_and_say_what_runs_say() {
    let place = place();
    let told = place.swept("out");
    // Of 2 x 2 x 4 in the grid sfarti's halves are equal: it has one scheme. 1 + 4 in the list.
    assert_eq!((count(&told, "different"), count(&told, "computed")), (4 + 8 + 5, 17));
    let points = place.rows("out/points.csv");
    let key = |row: &BTreeMap<String, String>| {
        ["trace", "preset", "unit", "position.width", "evaluate.scheme", "engine"]
            .map(|name| row[name].clone())
            .join(" ")
    };
    let keys: Vec<_> = points.iter().map(key).collect();
    assert_eq!(keys.len(), 16 + 5);
    assert_eq!(keys[0], "mesh.jsonl gf3-2001 sfarti 24 mixed timed");
    assert_eq!(keys[1], "mesh.jsonl gf3-2001 sfarti 24 forward timed");
    assert_eq!(keys[6], "mesh.jsonl gf3-2001 hybrid 16 mixed timed");
    assert_eq!(keys[8], "fan.jsonl gf3-2001 sfarti 24 mixed timed");
    assert_eq!(keys[16], "fan.jsonl modern esc 40 forward timed");
    assert_eq!(keys[20], "fan.jsonl gf3-2001 hybrid 32 forward none");
    assert_eq!(points[0]["hash"], points[1]["hash"]);
    assert_ne!(points[4]["hash"], points[5]["hash"]);
    assert!(points.iter().all(|row| row["state"] == "completed"));
    assert!(!points[0]["time"].is_empty() && points[20]["time"].is_empty());
    let counted = place.rows("out/sweep.csv");
    for number in [6, 16, 20] {
        let key = keys[number].split(' ').collect::<Vec<_>>();
        let [trace, preset, unit, width, scheme, engine] = key[..] else { panic!("six columns") };
        let mut run = tessim();
        run.current_dir(place.path("")).args(["run", trace, "--preset", preset, "--unit", unit]);
        run.args(["--set", &format!("position.width={width}"), "--engine", engine]);
        run.args(["--set", &format!("evaluate.scheme={scheme}"), "--set", "level.level=3"]);
        printed(run.args(["--set", "evaluate.guard=15", "--out", "run"]));
        let mut wanted: BTreeMap<_, u64> = BTreeMap::new();
        for row in place.rows("run/counters.csv") {
            let value: u64 = row["value"].parse().unwrap();
            let names = [&row["block"], &row["counter"], &row["measure"]].map(String::clone);
            let sum = wanted.entry(names).or_default();
            *sum = if row["counter"].ends_with(".peak") { (*sum).max(value) } else { *sum + value };
        }
        let rows = counted.iter().filter(|row| row["point"] == number.to_string());
        let found = rows.map(|row| {
            assert_eq!((row["unit"].as_str(), row["position.width"].as_str()), (unit, width));
            let names = [&row["block"], &row["counter"], &row["measure"]].map(String::clone);
            (names, row["value"].parse().unwrap())
        });
        assert_eq!(found.collect::<BTreeMap<_, u64>>(), wanted, "point {number}");
        let summary: serde_json::Value =
            serde_json::from_str(&place.read("run/summary.json")).unwrap();
        let rate = summary["rates"]["link_bytes_per_triangle"]["value"].to_string();
        assert_eq!(points[number]["link_bytes_per_triangle"], rate);
    }
}

#[test]
fn a_point_is_repeated_by_the_command_that_lies_beside_it() {
    let study = "traces = [\"my fan's.jsonl\", \"mesh.jsonl\"]\n\
                 units = [\"d3d11\", \"triangles\"]\n[set]\nlevel.pixels = 8\n\
                 [grid]\nengine = [\"timed\", \"none\"]\n";
    let place = Place::new(study);
    fs::copy(shipped("fan.jsonl"), place.path("my fan's.jsonl")).unwrap();
    place.swept("out");
    let program = tessim().get_program().to_owned();
    let bin = std::path::Path::new(&program).parent().unwrap().to_owned();
    let path = std::env::join_paths([bin, "/usr/bin".into(), "/bin".into()]).unwrap();
    let hashes = place.points("out");
    assert_eq!(hashes.len(), 8);
    for hash in hashes {
        let point = format!("out/points/{hash}");
        let line = place.read(&format!("{point}/command.txt"));
        let mut shell = Command::new("sh");
        shell.args(["-c", &line]).current_dir(place.path(&point)).env("PATH", &path);
        assert!(shell.output().unwrap().status.success(), "{line}");
        let again = place.tree(&format!("{point}/again"));
        assert!(again.len() >= 3);
        let mut first = place.tree(&point);
        first.retain(|name, _| !name.starts_with("again/") && name != "command.txt");
        assert!(first == again, "{line}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let place = place();
    for (out, threads) in [("one", "1"), ("five", "5")] {
        printed(place.sweep(out).args(["--threads", threads]));
    }
    let one = place.tree("one");
    assert!(one == place.tree("five"));
    assert!(one.keys().all(|name| !name.starts_with("work/") && !name.contains(".tessim")));
    // And its own name serves where no folder is given.
    let mut named = tessim();
    printed(named.current_dir(place.path("")).args(["-q", "sweep", "study.toml"]));
    assert!(one == place.tree("study.sweep"));
}

#[test]
fn a_longer_study_goes_on_where_the_shorter_was() {
    let study = |widths: &str| {
        format!(
            "traces = [\"fan.jsonl\"]\n[set]\nengine = \"none\"\nlevel.level = 2\n\
             [grid]\nposition.width = {widths}\n"
        )
    };
    let place = Place::new(&study("[16, 18, 16]"));
    let told = place.swept("out");
    assert_eq!((count(&told, "different"), count(&told, "computed")), (2, 2));
    let before = place.tree("out");
    assert_eq!(place.rows("out/points.csv").len(), 3, "a row for each, equal or not");
    let told = place.swept("out");
    assert_eq!((count(&told, "computed"), count(&told, "found")), (0, 2));
    assert!(before == place.tree("out"));
    place.study(&study("[20, 18, 16]"));
    let told = place.swept("out");
    assert_eq!((count(&told, "computed"), count(&told, "found")), (1, 2));
    let after = place.tree("out");
    let kept = |name: &&String| name.starts_with("points/");
    assert!(before.keys().filter(kept).all(|name| before[name] == after[name]));
    let widths: Vec<_> =
        place.rows("out/points.csv").iter().map(|row| row["position.width"].clone()).collect();
    assert_eq!(widths, ["20", "18", "16"]);
    // Another trace under the same name makes other points.
    fs::copy(shipped("strip.jsonl"), place.path("fan.jsonl")).unwrap();
    assert_eq!(count(&place.swept("out"), "computed"), 3);
    // A result that somebody has changed is not taken for one.
    let point = place
        .points("out")
        .into_iter()
        .find(|hash| place.rows("out/points.csv").iter().any(|row| row["hash"] == *hash));
    let damaged = format!("out/points/{}/counters.csv", point.unwrap());
    fs::write(place.path(&damaged), "frame,unit,block,counter,value,measure\nx\n").unwrap();
    let (_, said) = place::fails(2, &mut place.sweep("out"));
    assert!(said.starts_with(&damaged) && said.contains("to compute it anew"), "{said}");
}

#[test]
fn the_shipped_study_runs() {
    let place = Place::new("");
    let mut sweep = tessim();
    sweep.arg("sweep").arg(shipped("sweeps/buses.toml")).args(["--shard", "1/6", "--out"]);
    let told = printed(sweep.arg(place.path("out")));
    let computed = count(&told, "computed");
    assert!(0 < computed && computed < 36, "{told}");
    assert!(told.contains(&format!("no tables yet: {} of 36 points are open", 36 - computed)));
}
