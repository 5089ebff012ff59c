//! `--timeline` as users meet it: files by their extension, whole or not at all, and what is
//! refused.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn tessim(folder: &TempDir, trace: &str, arguments: &[&str]) -> (i32, String) {
    let trace = Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(trace);
    let mut command = Command::cargo_bin("tessim").expect("the command is built for its tests");
    let command = command.current_dir(folder).args(["-q", "run"]).arg(trace).args(arguments);
    let output = command.output().unwrap();
    assert!(output.stdout.is_empty());
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

fn files(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn files_are_written_by_their_extension_and_engine_and_threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let both = ["--timeline", "a.json", "--timeline", "a.vcd", "--out", "a", "--frame", "1"];
    let window = ["--timeline-window", "cycles:100..900", "--mesh", "ply"];
    let (code, said) = tessim(&folder, "mesh.jsonl", &[&both[..], &window].concat());
    assert_eq!((code, said.as_str()), (0, ""));
    assert_eq!(files(&folder), ["a", "a.json", "a.vcd"]);
    let other = ["--timeline", "b.json", "--frame", "1", "--timeline-window", "cycles:100..900"];
    let other = [&other[..], &["--engine", "stepped", "--threads", "3"]].concat();
    assert_eq!(tessim(&folder, "mesh.jsonl", &other).0, 0);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(read("a.json") == read("b.json"));
    let about = r#"{"otherData":{"tessim":""#;
    assert!(read("a.json").starts_with(about));
    assert!(read("a.json").contains(r#""frame":1,"elapsed":"#));
    assert!(read("a.json").contains(r#""window":[100,900]"#));
    assert!(read("a.vcd").contains("$timescale 1 ns $end"));
}

#[test]
fn what_cannot_be_is_refused_and_nothing_is_left_behind() {
    let folder = tempfile::tempdir().unwrap();
    let to = ["--timeline", "a.json"];
    let refused: [(&[&str], &str); 14] = [
        (&["--timeline", "a.txt"], "expected a name that ends in .json or .vcd"),
        (&["--timeline", "json"], "expected a name that ends in .json or .vcd"),
        (&["--timeline-window", "cycles:0..5"], "--timeline"),
        (&["--frame", "0"], "give --mesh or --timeline too"),
        (&[to[0], to[1], "--timeline-window", "0..5"], "expected cycles:A..B or patches:A..B"),
        (&[to[0], to[1], "--timeline-window", "cycles:5..5"], "A < B"),
        (&[to[0], to[1], "--timeline-window", "patches:-1..5"], "expected cycles:A..B"),
        (&[to[0], to[1], "--engine", "none"], "a timeline needs an engine"),
        (&[to[0], to[1], "--frame", "1"], "--frame 1: no such frame: the trace has frame 0 only"),
        (&[to[0], to[1], "--frame", "0", "--set", "frames=overlap"], "frames overlap"),
        (
            &[to[0], to[1], "--timeline-window", "cycles:99999999..100000000"],
            "--timeline-window cycles:99999999..100000000: frame 0 has ",
        ),
        (
            &[to[0], to[1], "--timeline-window", "patches:32..33"],
            "--timeline-window patches:32..33: frame 0 has 32 patches",
        ),
        (
            &[
                to[0],
                to[1],
                "--set",
                "frames=overlap",
                "--timeline-window",
                "cycles:99999999..100000000",
            ],
            "the run has ",
        ),
        (&["--timeline", "a.json", "--only-frame", "3"], "--only-frame 3"),
    ];
    for (arguments, expected) in refused {
        let (code, said) = tessim(&folder, "teapot.jsonl", arguments);
        assert_eq!(code, 2, "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
        assert_eq!(files(&folder), [""; 0], "{arguments:?}");
    }
    let (code, said) = tessim(&folder, "teapot.jsonl", &["--timeline", "no/such/a.json"]);
    assert_eq!(
        (code, said.as_str()),
        (3, "no/such/a.json: the folder to write in does not exist\n")
    );
}

#[test]
fn neither_the_trace_nor_a_result_gives_way_to_a_timeline() {
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("in.json");
    let fan = Path::new(env!("CARGO_MANIFEST_DIR")).join("traces/fan.jsonl");
    fs::copy(fan, &trace).unwrap();
    let before = fs::read(&trace).unwrap();
    let trace = trace.to_str().unwrap();
    let (code, said) = tessim(&folder, trace, &["--timeline", "in.json"]);
    assert_eq!((code, said.contains("found the trace")), (2, true), "{said}");
    assert_eq!(fs::read(trace).unwrap(), before);
    let out = ["--engine", "timed", "--out", "result"];
    assert_eq!(tessim(&folder, trace, &out).0, 0);
    let within = ["--timeline", "result/summary.json"];
    let (code, said) = tessim(&folder, trace, &[&out[..], &within].concat());
    assert_eq!((code, said.contains("expected a place beside it")), (2, true), "{said}");
    assert_eq!(tessim(&folder, trace, &out).0, 0, "the result is one still");
}

#[test]
fn a_run_too_long_for_a_timeline_asks_for_a_window_and_gets_one() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("cups.jsonl");
    let mut command = Command::cargo_bin("tessim").unwrap();
    command.args(["scene", "teacups", "--count", "30", "--frames", "1"]);
    fs::write(&scene, command.output().unwrap().stdout).unwrap();
    let scene = scene.to_str().unwrap();
    let to = ["--timeline", "a.json", "--set", "level.level=64"];
    let (code, said) = tessim(&folder, scene, &to);
    assert_eq!(code, 2, "{said}");
    let from = "--timeline: more than 4194304 changes, from cycle 0 to about ";
    assert!(said.starts_with(from) && said.contains("by --timeline-window cycles:A..B"), "{said}");
    assert_eq!(files(&folder), ["cups.jsonl"]);
    let window = ["--timeline-window", "cycles:300000..301000"];
    let (code, said) = tessim(&folder, scene, &[&to[..], &window].concat());
    assert_eq!((code, said.as_str()), (0, ""));
    let patches = ["--timeline-window", "patches:20..21"];
    let (code, said) = tessim(&folder, scene, &[&to[..], &patches].concat());
    assert_eq!((code, said.as_str()), (0, ""));
    assert_eq!(files(&folder), ["a.json", "cups.jsonl"]);
}
