//! The command line as users meet it: what is printed, what is written, what is refused, exit
//! codes.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[path = "cli/esc.rs"]
mod esc;

use assert_cmd::Command;
use predicates::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn tessim() -> Command {
    let mut command = Command::cargo_bin("tessim").expect("the command is built for its tests");
    command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
    command
}

fn trace(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(name)
}

/// What a failed command says, which is all that it says; it left nothing in `folder`.
#[track_caller]
fn fails(code: i32, arguments: &[&str]) -> String {
    let output = tessim().args(arguments).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    message
}

fn entries(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn run(arguments: &[&str], trace: &Path, out: &Path) {
    tessim().arg("run").arg(trace).args(arguments).arg("--out").arg(out).assert().success();
}

/// The block that binds a run of the teapot: used, busy, starved, blocked, its FIFO full.
const TIMES: &str = "(?m)^  emit( +[0-9]+\\.[0-9] %){4} +16 of 16   stitch$";

#[test]
fn a_run_prints_a_table_without_colours_into_a_pipe() {
    let table = tessim().arg("run").arg(trace("teapot.jsonl")).assert().success();
    table
        .stdout(predicate::str::starts_with("teapot: unit hybrid, 1 frame\n"))
        .stdout(predicate::str::contains("control points                   6 144"))
        .stdout(predicate::str::is_match(TIMES).unwrap())
        .stdout(predicate::str::contains("  what binds the run: emit, used 9"))
        .stdout(predicate::str::contains("\x1b").not())
        .stderr("");
}

#[test]
fn quiet_prints_nothing_but_errors() {
    tessim().args(["-q", "run"]).arg(trace("teapot.jsonl")).assert().success().stdout("");
    assert!(fails(3, &["run", "-q", "no/such.jsonl"]).starts_with("no/such.jsonl: "));
}

#[test]
fn a_trace_comes_through_standard_input_as_well() {
    let text = fs::read(trace("teapot.jsonl")).unwrap();
    let piped = tessim().args(["run", "-"]).write_stdin(text).output().unwrap();
    let named = tessim().arg("run").arg(trace("teapot.jsonl")).output().unwrap();
    assert!(piped.status.success());
    assert_eq!(piped.stdout, named.stdout);
    let broken = tessim().args(["run", "-"]).write_stdin("{}").assert().code(2);
    broken.stderr(predicate::str::starts_with("-:1:"));
}

#[test]
fn a_result_folder_is_complete_and_reproduces_itself() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    run(&["--set", "position.width=24", "--mesh", "ply"], &trace("teapot.jsonl"), &first);
    let config = first.join("config.toml");
    let config = ["--config", config.to_str().unwrap(), "--mesh", "ply"];
    run(&config, &trace("teapot.jsonl"), &second);
    for name in ["config.toml", "counters.csv", "occupancy.csv", "summary.json", "mesh.ply"] {
        let bytes = fs::read(first.join(name)).unwrap();
        assert!(!bytes.is_empty());
        assert_eq!(bytes, fs::read(second.join(name)).unwrap(), "{name}");
    }
    assert_eq!(entries(&folder), ["a", "b"]);
    let csv = fs::read_to_string(first.join("counters.csv")).unwrap();
    assert!(csv.starts_with("frame,unit,block,counter,value,measure\n0,hybrid,trace,frames,1,"));
    let summary = fs::read_to_string(first.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["trace"]["title"], "teapot");
    assert_eq!(summary["totals"]["link.bytes.control_points"], 6144);
    assert_eq!(summary["totals"]["port.tokens.in"], 512);
}

#[test]
fn engines_write_the_same_bytes_and_none_writes_no_cycles() {
    let folder = tempfile::tempdir().unwrap();
    let [timed, stepped, none] = ["timed", "stepped", "none"].map(|engine| {
        let out = folder.path().join(engine);
        run(&["--engine", engine, "--mesh", "ply"], &trace("mesh.jsonl"), &out);
        out
    });
    let read = |out: &Path, name: &str| fs::read_to_string(out.join(name)).unwrap();
    for name in ["counters.csv", "occupancy.csv", "mesh.ply"] {
        assert!(fs::read(timed.join(name)).unwrap() == fs::read(stepped.join(name)).unwrap());
    }
    // What names the engine names another one, and nothing else changes.
    for (name, engine) in [("config.toml", "engine = \"_\""), ("summary.json", "\"engine\": \"_\"")]
    {
        let line = |engine_name| engine.replace('_', engine_name);
        let (a, b) = (read(&timed, name), read(&stepped, name));
        assert_eq!(a.replace(&line("timed"), &line("stepped")), b, "{name}");
        assert!(a.contains(&line("timed")) && b.contains(&line("stepped")));
    }
    let cycles = |row: &&str| row.contains(",cycles.") || row.contains(",fifo.peak,");
    let rows = read(&timed, "counters.csv");
    let (with, without): (Vec<_>, Vec<_>) = rows.lines().partition(cycles);
    assert_eq!(without, read(&none, "counters.csv").lines().collect::<Vec<_>>());
    // Two frames; thirteen blocks with 7 rows, all but the last blocked by one, all but the first
    // with a FIFO; and the unit.
    assert_eq!(with.len(), 2 * (13 * 7 - 1 + 12 + 1));
    assert!(!none.join("occupancy.csv").exists());
    let quiet = tessim().args(["run", "--engine", "none"]).arg(trace("teapot.jsonl")).output();
    let table = String::from_utf8(quiet.unwrap().stdout).unwrap();
    assert!(table.ends_with("what binds the run: no engine, so no cycles\n"), "{table}");
    assert!(!table.contains("\ntime\n"));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for (form, unit) in [("ply", "hybrid"), ("obj", "hybrid"), ("svg", "hybrid"), ("ply", "d3d11")]
    {
        let results = ["1", "2", "3"].map(|threads| {
            let out = folder.path().join(format!("{form}{unit}{threads}"));
            let arguments = ["--threads", threads, "--mesh", form, "--set", "level.level=5.5"];
            let arguments = [&arguments[..], &["--unit", unit]].concat();
            run(&arguments, &trace("mesh.jsonl"), &out);
            let read = |name: &str| fs::read(out.join(name)).unwrap();
            let mesh = read(&format!("mesh.{form}"));
            [read("counters.csv"), read("occupancy.csv"), read("summary.json"), mesh]
        });
        assert!(results[0] == results[1] && results[1] == results[2], "{form} of {unit}");
    }
}

#[test]
fn a_mesh_is_that_of_the_chosen_frame() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second, default] = ["0", "1", ""].map(|frame| {
        let out = folder.path().join(format!("f{frame}"));
        let mut arguments = vec!["--mesh", "ply"];
        if !frame.is_empty() {
            arguments.extend(["--frame", frame]);
        }
        run(&arguments, &trace("mesh.jsonl"), &out);
        fs::read(out.join("mesh.ply")).unwrap()
    });
    assert_eq!(first, default);
    assert_ne!(first, second);
}

#[test]
fn a_failed_run_leaves_nothing_and_replaces_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let (out_name, teapot) = (out.to_str().unwrap(), trace("teapot.jsonl"));
    let teapot = teapot.to_str().unwrap();

    let message = fails(2, &["run", teapot, "--mesh", "ply", "--frame", "1", "--out", out_name]);
    assert_eq!(message, "--frame 1: no such frame: the trace has frame 0 only\n");
    assert!(fails(2, &["run", teapot, "--mesh", "ply"]).contains("--out"));
    fails(2, &["run", teapot, "--frame", "0"]);
    let svg = ["run", teapot, "--mesh", "svg", "--out", out_name, "--set", "emit.divide=false"];
    assert!(fails(2, &svg).contains("emit.divide"));
    let truncated = folder.path().join("cut.jsonl");
    let text = fs::read_to_string(teapot).unwrap();
    fs::write(&truncated, text.replace("{\"end\":{}}", "")).unwrap();
    let truncated = truncated.to_str().unwrap();
    let message = fails(2, &["run", "-q", truncated, "--out", out_name, "--mesh", "ply"]);
    assert!(message.starts_with(&format!("{truncated}:")), "{message}");
    assert_eq!(entries(&folder), ["cut.jsonl"]);

    let missing = folder.path().join("no/such/out");
    let message = fails(3, &["run", teapot, "--out", missing.to_str().unwrap()]);
    assert!(message.contains("does not exist"), "{message}");

    fs::create_dir(&out).unwrap();
    fs::write(out.join("thesis.tex"), "years of work").unwrap();
    let message = fails(2, &["run", teapot, "--out", out_name]);
    assert!(message.contains("only a tessim result is replaced"), "{message}");
    assert_eq!(fs::read(out.join("thesis.tex")).unwrap(), b"years of work");
    fs::remove_dir_all(&out).unwrap();
    run(&["--mesh", "obj"], Path::new(teapot), &out);
    run(&[], Path::new(teapot), &out);
    assert!(!out.join("mesh.obj").exists(), "the old result is gone as a whole");
    assert_eq!(entries(&folder), ["cut.jsonl", "out"]);
}

#[test]
fn wrong_usage_is_exit_2_and_says_what_would_be_right() {
    let teapot = trace("teapot.jsonl");
    let teapot = teapot.to_str().unwrap();
    let set = |setting| fails(2, &["run", teapot, "--set", setting]);
    assert!(set("positon.width=24").contains("did you mean `position.width`?"));
    assert!(set("position.width=99").contains("found 99, expected 8..=48"));
    assert!(set("level.pixels=0").contains("level.pixels: found 0"));
    assert!(fails(2, &["run", teapot, "--engine", "fast"]).contains("[possible values: timed"));
    tessim().args(["run", teapot, "--engine", "none", "-q"]).assert().success();
    for wrong in [&["run"][..], &["rum"], &[], &["run", teapot, "--threads", "0"]] {
        fails(2, wrong);
    }
    assert!(fails(2, &["run", teapot, "--unit", "voodoo"]).contains("hybrid"));
    tessim().args(["--help"]).assert().success();
    tessim().args(["--version"]).assert().success();
}

#[test]
fn a_time_that_cannot_be_is_refused_by_its_key() {
    let cases: [(&str, &[&str]); 12] = [
        ("clock_mhz=0", &["clock_mhz: found 0, expected 1..=100000"]),
        ("engine=fast", &["engine: found \"fast\", expected timed, stepped or none"]),
        ("block.stitch.fifo=0", &["block.stitch.fifo: found 0", "nothing could ever move"]),
        ("block.evaluate.fifo=0", &["block.evaluate.fifo: found 0", "1 halves throughput"]),
        ("block.stich.interval=2", &["unknown key", "did you mean `block.stitch.interval`?"]),
        ("block.emit.lanes=0", &["block.emit.lanes: found 0, expected 1..=4096"]),
        ("block.level.latency=1000001", &["block.level.latency: found 1000001"]),
        ("block.clip.interval=99999999999", &["block.clip.interval: found 99999999999"]),
        ("block.backfcae.latency=1", &["unknown key", "did you mean `block.backface.latency`?"]),
        ("link.bus=pcie3x61", &["link.bus: found \"pcie3x61\"", "did you mean `pcie3x1`?"]),
        ("link.transfer=pulled", &["link.transfer: found \"pulled\", expected push or pull"]),
        ("memory.fifo=0", &["memory.fifo: found 0", "nothing could ever move"]),
    ];
    for (setting, wanted) in cases {
        let message = fails(2, &["config", "--set", setting]);
        assert!(message.starts_with(&format!("--set {setting}: ")), "{message}");
        for words in wanted {
            assert!(message.contains(words), "`{words}` is not in: {message}");
        }
    }
}

#[test]
fn a_configuration_file_is_named_where_it_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("c.toml");
    fs::write(&file, "[link]\npayload = 64\nhaeder = 8\n").unwrap();
    let file = file.to_str().unwrap();
    let message = fails(2, &["config", "--config", file]);
    assert!(message.starts_with(&format!("{file}:3:1: unknown key `link.haeder`")), "{message}");
    assert!(message.contains("`link.header`"));
    assert!(fails(3, &["config", "--config", "no/such.toml"]).starts_with("no/such.toml: "));
}

#[test]
fn config_prints_the_layers_that_were_laid() {
    let printed = |arguments: &[&str]| {
        let output = tessim().arg("config").args(arguments).output().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(printed(&[]).contains("\npayload = 256\n"));
    let old = printed(&["--preset", "gf3-2001", "--unit", "triangles", "--set", "level.level=8"]);
    assert!(old.contains("\nbus = \"agp4x\"\n") && old.contains("\nclock_mhz = 200\n"));
    assert!(old.contains("\npayload = 0\n") && old.contains("unit = \"triangles\""));
    let other = printed(&["--set", "link.payload=64"]);
    assert!(other.contains("\n# bus = ") && other.contains("\n[block.vertex_shader]\n"));
    assert!(old.contains("criterion = \"fixed\"") && old.contains("\nlevel = 8.0\n"));
}

#[test]
fn counters_explains_blocks_and_single_counters() {
    let all = tessim().arg("counters").output().unwrap();
    let all = String::from_utf8(all.stdout).unwrap();
    for declared in rtl_model::counter::DECLARATIONS {
        assert!(all.contains(&format!("{}.{} ", declared.block.name(), declared.name)));
        assert!(all.contains(declared.meaning) && all.contains(declared.law));
    }
    for row in [
        "stitch.cycles.starved.by.evaluate ",
        "vertex_shader.cycles.starved.by.link ",
        "link.cycles.starved.by.host ",
        "stitch.cycles.blocked.by.emit ",
        "stitch.fifo.peak ",
        "stitch.cycles.blocked.by.order ",
        "unit.cycles.total ",
        "memory.tokens.in ",
    ] {
        assert_eq!(all.lines().filter(|line| line.starts_with(row)).count(), 1, "{row}");
    }
    assert!(!all.contains("\nlink.fifo.peak") && !all.contains("\nassemble.ops"));
    let stitch = tessim().args(["counters", "stitch"]).output().unwrap();
    let stitch = String::from_utf8(stitch.stdout).unwrap();
    assert!(stitch.contains("law: busy + starved + blocked = total"));
    assert!(stitch.contains("of a triangle: the walk's error tested and moved, 8 bits each"));
    let bits = tessim().args(["counters", "stitch.ops.add.bits"]).output().unwrap();
    assert_eq!(bits.stdout.iter().filter(|byte| **byte == b'\n').count(), 2, "itself and its law");
    let one = tessim().args(["counters", "emit.triangles"]).output().unwrap();
    assert_eq!(String::from_utf8(one.stdout).unwrap().lines().count(), 2);
    assert!(fails(2, &["counters", "stich"]).contains("did you mean `stitch`?"));
}

#[test]
fn info_describes_a_trace_and_checks_it_to_its_end() {
    let output = tessim().arg("info").arg(trace("mesh.jsonl")).assert().success();
    output
        .stdout(predicate::str::is_match("(?m)^frames +2$").unwrap())
        .stdout(predicate::str::is_match("(?m)^patches +96$").unwrap())
        .stdout(predicate::str::is_match("(?m)^sha256 +[0-9a-f]{64}$").unwrap());
    let text = fs::read_to_string(trace("mesh.jsonl")).unwrap();
    let cut = text.replace("{\"end\":{}}", "{\"ned\":{}}");
    let failed = tessim().args(["info", "-"]).write_stdin(cut).assert().code(2);
    failed.stdout("").stderr(predicate::str::starts_with("-:"));
}

#[test]
fn scenes_and_imports_are_traces_and_appear_when_complete() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("grid.jsonl");
    let file = file.to_str().unwrap();
    let grid = ["scene", "grid", "--rows", "3", "--columns", "5", "--out", file];
    tessim().args(grid).assert().success().stdout("");
    let info = tessim().args(["info", file]).assert().success();
    info.stdout(predicate::str::is_match("(?m)^patches +15$").unwrap());
    let teapot = tessim().args(["scene", "teapot"]).output().unwrap();
    assert_eq!(teapot.stdout, fs::read(trace("teapot.jsonl")).unwrap());
    let fixed = tessim().args(["scene", "teapot", "--level", "2.5"]).output().unwrap();
    assert!(String::from_utf8(fixed.stdout).unwrap().contains("\"fixed\""));
    assert!(fails(2, &["scene", "teapot", "--level", "0"]).contains("level.level"));
    fails(2, &["scene", "utah"]);

    let bpt = "1\n3 3\n".to_owned() + &"0 0 0\n1 0 0\n0 1 0\n0 0 1\n".repeat(4);
    let imported = tessim().args(["import", "-", "-"]).write_stdin(bpt).output().unwrap();
    let checked = tessim().args(["info", "-"]).write_stdin(imported.stdout).assert().success();
    checked.stdout(predicate::str::is_match("(?m)^patches +1$").unwrap());
    let out = folder.path().join("bad.jsonl");
    let bad = tessim().args(["import", "-"]).arg(&out).write_stdin("1\n3 4\n").assert().code(2);
    bad.stderr(predicate::str::starts_with("-:2:3:"));
    assert_eq!(entries(&folder), ["grid.jsonl"]);
}

#[test]
fn patterns_come_one_line_each() {
    let one = tessim().args(["pattern", "--factors", "1,1,1,1"]).assert().success();
    one.stdout(
        "{\"domain\":\"quad\",\"partitioning\":\"fractional\",\"topology\":\"ccw\",\
         \"factors\":[1.0,1.0,1.0,1.0],\
         \"points_fx16\":[[0,0],[65536,0],[65536,65536],[0,65536]],\"indices\":[0,1,2,0,2,3]}\n",
    );
    let mut patterns = tessim();
    let lines = "quad fractional point nan inf -inf -2\nquad fractional line 3.3 2.7 5.1 4.2 3 2\n";
    let both = patterns.args(["pattern", "--batch", "-"]).write_stdin(lines).output().unwrap();
    let both = String::from_utf8(both.stdout).unwrap();
    assert_eq!(both.lines().count(), 2);
    assert!(both.contains("\"factors\":[\"nan\",\"inf\",\"-inf\",-2.0]"));
    let wrong = "quad fractional cw 1 1 1 1\nquad fractional cw 1 1 1\n";
    let failed = tessim().args(["pattern", "--batch", "-"]).write_stdin(wrong).assert().code(2);
    failed.stderr(predicate::str::starts_with("-:2:25: found 3 factors"));
    assert!(fails(2, &["pattern", "--factors=1,x,1,1"]).contains("found \"x\""));
    let tri = ["pattern", "--domain", "tri", "--factors", "1,1,1,1"];
    assert!(fails(2, &tri).contains("what unit hybrid takes"));
    fails(2, &["pattern"]);
}

/// Whole lines: what they say is compared with vectors elsewhere.
#[test]
fn tessellator_patterns_come_in_every_domain() {
    let pattern = |args: &[&str]| {
        let mut command = tessim();
        let made = command.args(["pattern", "--unit", "d3d11"]).args(args).output().unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        String::from_utf8(made.stdout).unwrap()
    };
    assert_eq!(
        pattern(&["--domain", "tri", "--factors", "1,1,1,1"]),
        "{\"domain\":\"tri\",\"partitioning\":\"odd\",\"topology\":\"ccw\",\
         \"factors\":[1.0,1.0,1.0,1.0],\
         \"points_fx16\":[[0,65536],[0,0],[65536,0]],\"indices\":[0,2,1]}\n"
    );
    // Infinity is the greatest factor, and 1.5 is two lines.
    let [inf, most] = ["inf", "64"].map(|detail| {
        let factors = format!("--factors=1.5,{detail}");
        pattern(&["--domain=isoline", "--partitioning=even", &factors])
    });
    assert!(inf.contains("\"topology\":\"line\",\"factors\":[1.5,\"inf\"]"));
    assert_eq!(inf.split_once("points").unwrap().1, most.split_once("points").unwrap().1);
    let culled = pattern(&["--partitioning", "integer", "--factors=1,1,-2,1,1,1"]);
    assert!(culled.ends_with("[1.0,1.0,-2.0,1.0,1.0,1.0],\"points_fx16\":[],\"indices\":[]}\n"));
    let inside = pattern(&["--factors=1,1,2,1,nan,-inf", "--topology=line"]);
    assert!(inside.contains("[1.0,1.0,2.0,1.0,\"nan\",\"-inf\"],\"points_fx16\":[[0,65536],"));
    let lines = "quad pow2 cw 2 2 2 2 2 2\ntri odd point nan 1 1 1\nisoline even line 1 2\n";
    let mut batch = tessim();
    let batch = batch.args(["pattern", "--unit", "d3d11", "--batch", "-"]).write_stdin(lines);
    let batch = String::from_utf8(batch.output().unwrap().stdout).unwrap();
    let lines: Vec<serde_json::Value> =
        batch.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let count = |line: usize, list: &str| lines[line][list].as_array().unwrap().len();
    let counts = |line| (count(line, "points_fx16"), count(line, "indices"));
    assert_eq!([counts(0), counts(1), counts(2)], [(9, 24), (0, 0), (3, 4)]);
    let with = |args: &[&str]| fails(2, &[&["pattern", "--unit=d3d11"], args].concat());
    assert!(with(&["--factors=1,1,1,1"]).contains("found 4 factors, expected 6"));
    assert!(with(&["--domain=tri", "--factors=1,1,1,1,1,1"]).contains("expected 4: Ueq0"));
    assert!(
        with(&["--domain=isoline", "--topology=cw", "--factors=1,1"]).contains("point or line")
    );
    let fractional = ["--partitioning=fractional", "--factors=1,1,1,1,1,1"];
    assert!(with(&fractional).contains("integer, pow2, odd or even"));
}

#[test]
fn a_study_prints_its_table_and_writes_integers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let small = ["study", "backface", "--views", "3", "--random", "40", "--out"];
    let study = || {
        let output = tessim().args(small).arg(&out).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        (output.stdout, fs::read_to_string(out.join("backface.csv")).unwrap())
    };
    let (first, second) = (study(), study()); // it replaces its like
    assert!(first == second);
    let (table, csv) = (String::from_utf8(first.0).unwrap(), first.1);
    assert!(table.starts_with("viewers outside the hull of every patch\n\n| patches "), "{table}");
    for line in ["| teapot   | tangent_plane |", "| random   | hull_literal  |     40 |"] {
        assert_eq!(table.matches(line).count(), 2, "{line} outside and within: {table}");
    }
    assert!(table.contains(" patches 0 culled, 0 of them wrongly: the hull is closed"), "{table}");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 4 * 4 * 2);
    assert_eq!(rows[0][..4], ["patches", "viewer", "method", "tested"]);
    assert_eq!(rows[1][..4], ["teapot", "outside", "hull_literal", "96"]);
    for row in &rows[1..] {
        assert!(row[3..].iter().all(|n| n.parse::<u64>().is_ok()), "{row:?}");
    }
    assert_eq!(entries(&folder), ["out"]);
    fails(2, &["run", trace("teapot.jsonl").to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(fails(2, &["study", "backface", "--views", "0"]).contains("--views"));
    let mut quiet = tessim();
    let quiet = quiet.args(["-q", "study", "backface", "--views", "1", "--random", "1"]);
    assert!(quiet.output().unwrap().stdout.is_empty());
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("tessim"))
        .args(["scene", "grid", "--rows", "64", "--columns", "64"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
}

#[test]
fn a_study_of_motion_takes_scenes_and_traces_and_says_what_disagrees() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let study = |arguments: &[&str]| {
        let mut command = tessim();
        command.args(["study", "motion", "--set", "level.max_level=2"]).args(arguments);
        command.assert().success()
    };
    let table = study(&["--scene", "zoom", "--scene", "inside", "--frames", "3"]);
    table
        .stdout(predicate::str::starts_with("zoom: 3 frames\n"))
        .stdout(predicate::str::contains("| total |      96 |"))
        .stdout(predicate::str::contains("unit and golden model disagree about 0\n"));
    for _ in 0..2 {
        let name = trace("indexed.jsonl");
        study(&[name.to_str().unwrap(), "--out", out.to_str().unwrap()]); // it replaces its like
        let csv = fs::read_to_string(out.join("motion.csv")).unwrap();
        assert!(csv.starts_with("trace,frame,patches,clipped,") && csv.lines().count() == 2);
        assert!(csv.contains("indexed.jsonl,0,96,"));
    }
    let moved = fs::read(trace("zoom.jsonl")).unwrap();
    let scene = tessim().args(["scene", "zoom", "--frames", "8"]).assert().success();
    scene.stdout(predicate::eq(moved));
    let refused = |arguments: &[&str]| fails(2, &[&["study", "motion"], arguments].concat());
    assert!(refused(&["--scene", "moon"]).contains("flythrough"));
    assert!(refused(&["a.jsonl", "--scene", "zoom"]).contains("cannot be used with"));
    assert!(refused(&["--unit", "moreton"]).contains("unit moreton culls nothing"));
}
