//! Comparisons and studies as users meet them on the command line: tables, folders, refusals.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

use assert_cmd::Command;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use tessim::config::Unit;

fn tessim() -> Command {
    Command::cargo_bin("tessim").expect("the command is built for its tests")
}

fn trace(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(name)
}

/// What a command prints, which succeeds and has nothing to complain of.
#[track_caller]
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// What a command says that fails with this code and prints nothing.
#[track_caller]
fn fails(code: i32, command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(code), "{output:?}");
    assert!(output.stdout.is_empty(), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// The numbers of a table's line, digits put together again; `-` is none.
fn cells(table: &str, label: &str) -> Vec<Option<f64>> {
    let line = table.lines().find(|line| line.trim_start().starts_with(label));
    let line = line.unwrap_or_else(|| panic!("no {label} in {table}")).trim_start();
    let cells = line[label.len()..].split("  ").map(str::trim).filter(|cell| !cell.is_empty());
    cells.map(|cell| cell.replace(' ', "").parse().ok()).collect()
}

/// `counters.csv` of a run, summed over frames: peaks by their maximum.
fn counters_of_a_run(out: &Path) -> HashMap<(String, String), u64> {
    let mut sums = HashMap::new();
    for row in fs::read_to_string(out.join("counters.csv")).unwrap().lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let value: u64 = fields[4].parse().unwrap();
        let sum: &mut u64 = sums.entry((fields[2].to_owned(), fields[3].to_owned())).or_default();
        *sum = if fields[3].ends_with(".peak") { (*sum).max(value) } else { *sum + value };
    }
    sums
}

#[test]
fn a_comparison_has_for_each_unit_what_a_run_of_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("compared");
    let mesh = trace("mesh.jsonl"); // two frames
    let settings = ["--preset", "hd5870", "--set", "level.pixels=2"];
    let compare = || {
        let mut command = tessim();
        command.arg("compare").arg(&mesh).args(settings).args(["--units", "sfarti,triangles"]);
        printed(command.arg("--out").arg(&out))
    };
    let (first, second) = (compare(), compare()); // it replaces its like
    assert_eq!(first, second);
    assert!(first.contains(": 2 frames; ratios are to sfarti\n"), "{first}");
    let csv = fs::read_to_string(out.join("compare.csv")).unwrap();
    assert!(csv.starts_with(
        "unit,block,counter,value,measure,first,min,median,max\nsfarti,trace,frames,2,count,2,1,1,1"
    ));
    let mut firsts = HashMap::new();
    for unit in ["sfarti", "triangles"] {
        let run_out = folder.path().join(unit);
        let mut run = tessim();
        run.arg("run").arg(&mesh).args(settings).args(["--unit", unit, "--out"]).arg(&run_out);
        printed(&mut run);
        let wanted = counters_of_a_run(&run_out);
        let mut rows = 0;
        for row in csv.lines().filter(|row| row.starts_with(&format!("{unit},"))) {
            let fields: Vec<&str> = row.split(',').collect();
            let key = (fields[1].to_owned(), fields[2].to_owned());
            // What the run's triangles look like has no counter.
            let Some(wanted) = wanted.get(&key) else { continue };
            assert_eq!(fields[3].parse::<u64>().unwrap(), *wanted, "{row}");
            if unit == "sfarti" {
                firsts.insert(key.clone(), fields[3].to_owned());
            }
            assert_eq!(fields[5], firsts.get(&key).map_or("", String::as_str), "{row}");
            rows += 1;
        }
        assert_eq!(rows, wanted.len(), "{unit}");
        let link = wanted[&("link".to_owned(), "bytes.total".to_owned())] as f64;
        let shown = cells(&first, "total");
        assert_eq!(shown[if unit == "sfarti" { 0 } else { 1 }], Some(link), "{first}");
    }
    assert_eq!(cells(&first, "control-point shader")[1..], [None, None], "{first}");
    let link = cells(&first, "total");
    let ratio = link[1].unwrap() / link[0].unwrap();
    assert!((link[2].unwrap() / ratio - 1.0).abs() < 0.01, "{first}");
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["units"][1]["unit"], "triangles");
    assert_eq!(summary["frames"], 2);
}

#[test]
fn a_comparison_reproduces_itself_at_any_number_of_threads_and_from_a_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name));
    let teapot = trace("teapot.jsonl");
    let coarse = ["--set", "level.pixels=8", "--set", "position.width=24"];
    // The first always subdivides: the others must not inherit that from its configuration.
    let units = ["--units", "sfarti,hybrid,triangles,moreton"];
    let mut one = tessim();
    one.arg("compare").arg(&teapot).args(units).args(coarse).args(["--threads", "1", "--out"]);
    let table = printed(one.arg(&a));
    let mut two = tessim();
    two.arg("compare").arg(&teapot).args(units).args(["--threads", "3", "--config"]);
    assert_eq!(printed(two.arg(a.join("config.toml")).arg("--out").arg(&b)), table);
    let mut piped = tessim();
    piped.args(["compare", "-"]).args(units).args(coarse).arg("--out").arg(&c);
    assert_eq!(printed(piped.write_stdin(fs::read(&teapot).unwrap())), table);
    for name in ["compare.csv", "frames.csv", "config.toml", "summary.json"] {
        let read = |out: &Path| fs::read(out.join(name)).unwrap();
        assert!(read(&a) == read(&b) && read(&a) == read(&c), "{name}");
    }
    let mut untimed = tessim();
    let untimed = untimed.arg("compare").arg(&teapot).args(coarse).args(["--engine", "none"]);
    let untimed = printed(untimed);
    for unit in Unit::ALL {
        assert!(untimed.lines().nth(2).unwrap().contains(unit.name()), "all of them: {untimed}");
    }
    assert_eq!(cells(&untimed, "elapsed cycles"), vec![None; 2 * Unit::ALL.len() - 1]);
    assert_eq!(cells(&untimed, "total")[0], cells(&table, "total")[1]);
    let mut quiet = tessim();
    quiet.args(["-q", "compare"]).arg(&teapot).args(coarse);
    assert_eq!(printed(&mut quiet), "");
}

#[test]
fn a_comparison_that_cannot_be_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let teapot = trace("teapot.jsonl");
    let compare = |units: &str| {
        let mut command = tessim();
        command.arg("compare").arg(&teapot).args(["--engine", "none", "--units", units]);
        command
    };
    assert!(fails(2, &mut compare("hybrid,sfarty")).contains("did you mean `sfarti`?"));
    assert!(fails(2, &mut compare("hybrid,hybrid")).contains("found hybrid twice"));
    let out = folder.path().join("out");
    let cut = fs::read_to_string(&teapot).unwrap().replace("{\"end\":{}}", "");
    let mut broken = tessim();
    broken.args(["compare", "-", "--out"]).arg(&out).write_stdin(cut);
    assert!(fails(2, &mut broken).starts_with("-:"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(fails(3, tessim().args(["compare", "no/such.jsonl"])).starts_with("no/such.jsonl: "));
    // Neither a run's result nor a study's is replaced, nor the other way round.
    let mut run = tessim();
    printed(run.args(["run", "-q"]).arg(&teapot).args(["--engine", "none", "--out"]).arg(&out));
    assert!(fails(2, compare("all").arg("--out").arg(&out)).contains("only a tessim result"));
    fs::remove_dir_all(&out).unwrap();
    printed(compare("all").arg("--out").arg(&out));
    fails(2, tessim().arg("run").arg(&teapot).arg("--out").arg(&out));
}

#[test]
fn bandwidth_prints_its_tables_and_writes_integers_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let small = ["study", "bandwidth", "--levels", "1..9", "--patches", "12", "--instances", "2"];
    let study = || {
        let text = printed(tessim().args(small).arg("--out").arg(&out));
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        (text, read("bandwidth.csv"), read("bandwidth.svg"))
    };
    let first = study();
    assert!(first == study(), "it replaces its like, by the same bytes");
    let (text, csv, picture) = first;
    assert!(text.contains("a mesh of 3 x 4 patches, 2 instances"), "{text}");
    assert!(text.contains("are equal in 70 of 70 rows"), "{text}");
    assert!(picture.starts_with("<svg") && picture.contains("indexed triangles"));
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    // Nine forms, two kinds of corners, levels 1, 2, 4, 6 and 8.
    assert_eq!(rows.len(), 1 + 9 * 2 * 5);
    for row in &rows[1..] {
        let closed_only = ["triangle_strips", "vertices_once"].contains(&row[0]);
        assert_eq!(row.len(), rows[0].len());
        assert!(row[1..11].iter().all(|n| n.parse::<u64>().is_ok()), "{row:?}");
        assert!(row[11..].iter().all(|n| n.parse::<u64>().is_ok() != closed_only), "{row:?}");
        assert!(closed_only || row[6..11] == row[11..16], "closed form and measured: {row:?}");
    }
    let mesh = rows.iter().find(|row| row[0] == "mesh" && row[1] == "12").unwrap();
    // 16 + 12 x 5 + 9 x 6 points, 4 + 2 x 5 + 6 corners; frame, model and camera beside them.
    assert_eq!(mesh[2..13], ["1", "12", "2", "48", "1560", "240", "0", "0", "1800", "1560", "240"]);
    assert_eq!(mesh[16..18], ["40", "256"]);
    fails(2, tessim().args(["run"]).arg(trace("teapot.jsonl")).arg("--out").arg(&out));
    assert_eq!(printed(tessim().args(["-q"]).args(small)), "");
}

#[test]
fn levels_that_cannot_be_are_refused() {
    for levels in ["0..4", "4", "9..3", "1..129", "a..b", "3..3", "..", "1...4"] {
        let message = fails(2, tessim().args(["study", "bandwidth", "--levels", levels]));
        assert!(message.contains("expected A..B"), "{levels}: {message}");
    }
    for (flag, value) in [("--patches", "0"), ("--instances", "0"), ("--patches", "-1")] {
        fails(2, tessim().args(["study", "bandwidth", flag, value]));
    }
}

/// Rows of a CSV, cell by cell.
fn rows(csv: &str) -> Vec<Vec<&str>> {
    csv.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn esc_counts_triangles_of_the_papers_pattern_and_replaces_its_like() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let small = ["study", "esc", "triangles", "--cups", "2", "--elephants", "1", "--frames", "1"];
    let study = |threads: &str| {
        let mut command = tessim();
        let command = command.env("RAYON_NUM_THREADS", threads);
        let text = printed(command.args(small).args(["--density", "1", "--out"]).arg(&out));
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        (text, read("triangles.csv"), read("triangles.svg"))
    };
    let first = study("1");
    assert!(first == study("3"), "by the same bytes");
    let (text, csv, picture) = first;
    assert!(text.contains("52 x 288, equal") && text.contains("811 x 288, equal"), "{text}");
    assert_eq!(text.matches("within five points: ").count(), 2 * 4, "{text}");
    assert!(picture.starts_with("<svg") && picture.contains("chord, object units"));
    let rows = rows(&csv);
    assert_eq!(rows.len(), 1 + 2 * (12 + 11) + 4 * 4);
    for row in &rows[1..] {
        assert_eq!((row[6], row[8]), ("14976", "233568"), "{row:?}");
        assert!(row[3..].iter().all(|n| n.parse::<u64>().is_ok()), "{row:?}");
    }
    fails(2, tessim().args(["study", "esc", "work", "--levels", "1..1", "--out"]).arg(&out));
}

#[test]
fn esc_is_held_against_the_true_surface_at_equal_counts() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = tessim();
    let small = ["study", "esc", "error", "--targets", "6,9,6", "--samples", "8", "--out"];
    let text = printed(command.args(small).arg(&out));
    assert!(text.contains("6 x 6: 1872") && text.contains("9 x 9: 4212"), "{text}");
    let csv = fs::read_to_string(out.join("error.csv")).unwrap();
    let rows = rows(&csv);
    assert_eq!(rows.len(), 1 + 2 * 7, "a target named twice is one");
    let number = |row: &[&str], k: usize| row[k].parse::<u64>().unwrap();
    for way in ["esc_uniform", "d3d11_one_factor"] {
        let of: Vec<_> = rows.iter().filter(|row| row[0] == way).collect();
        assert!(of.iter().all(|row| row[2] == row[3] && row[4].is_empty()), "{of:?}");
        assert!(number(of[0], 7) > number(of[1], 7), "finer is nearer: {of:?}");
    }
    for name in ["error.svg", "mean.svg"] {
        assert!(fs::read_to_string(out.join(name)).unwrap().contains("d3d11, adaptive"), "{name}");
    }
    for targets in ["2", "49", "a", "6,,7"] {
        fails(2, tessim().args(["study", "esc", "error", "--targets", targets]));
    }
}

#[test]
fn esc_work_has_equal_triangles_and_takes_prices_of_energy() {
    let folder = tempfile::tempdir().unwrap();
    let [out, prices] = ["out", "prices.toml"].map(|name| folder.path().join(name));
    fs::write(&prices, "invocation = 70.0\n").unwrap();
    let mut command = tessim();
    let small = ["study", "esc", "work", "--cups", "1", "--levels", "1..2", "--processors", "1,3"];
    let command = command.args(small).arg("--energy").arg(&prices).arg("--out").arg(&out);
    let text = printed(command);
    assert!(text.contains("cycles elapsed a patch, 3 processors"), "{text}");
    let csv = fs::read_to_string(out.join("work.csv")).unwrap();
    let rows = rows(&csv);
    assert_eq!(rows.len(), 1 + 2 * 6 * 2);
    let column = |name: &str| rows[0].iter().position(|cell| *cell == name).unwrap();
    let number = |row: &[&str], name: &str| row[column(name)].parse::<u64>().unwrap();
    for row in &rows[1..] {
        let side = number(row, "level") + 1;
        assert_eq!(number(row, "triangles"), 26 * 18 * side * side, "{row:?}");
        assert_eq!(number(row, "invocations_pj"), 70 * number(row, "invocations"), "{row:?}");
    }
    fs::write(&prices, "invocation = -1\n").unwrap();
    let mut wrong = tessim();
    assert!(fails(2, wrong.args(small).arg("--energy").arg(&prices)).contains("prices.toml"));
    for levels in ["3..1", "1..16", "4", "a..b"] {
        fails(2, tessim().args(["study", "esc", "work", "--levels", levels]));
    }
}
