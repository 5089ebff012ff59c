//! `tessim convert` as users meet it, and the binary form with the other commands.

use assert_cmd::Command;
use predicates::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

fn tessim() -> Command {
    let mut command = Command::cargo_bin("tessim").expect("the command is built for its tests");
    command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
    command
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(name)
}

fn convert(from: &Path, to: &Path) {
    tessim().arg("convert").args([from, to]).assert().success().stdout("").stderr("");
}

#[test]
fn every_shipped_trace_comes_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let [binary, again, text] = ["a.tsb", "b.tsb", "c.jsonl"].map(|n| folder.path().join(n));
    for name in ["teapot", "teacup", "teaspoon", "mesh", "rational"] {
        let trace = shipped(&format!("{name}.jsonl"));
        convert(&trace, &binary);
        convert(&trace, &again);
        convert(&binary, &text);
        assert_eq!(fs::read(&text).unwrap(), fs::read(&trace).unwrap(), "{name}");
        let bytes = fs::read(&binary).unwrap();
        assert_eq!(bytes, fs::read(&again).unwrap(), "{name}: the same bytes every time");
        assert!(bytes.starts_with(b"tessim\0\x01"));
        convert(&binary, &again);
        assert_eq!(bytes, fs::read(&again).unwrap(), "{name}: from its own form");
    }
}

#[test]
fn it_streams_between_pipes_and_every_byte_gets_through() {
    let text = fs::read(shipped("teapot.jsonl")).unwrap();
    let binary = tessim()
        .args(["convert", "-", "-", "--to", "binary"])
        .write_stdin(text.clone())
        .output()
        .unwrap();
    assert!(binary.status.success());
    assert!(binary.stdout.contains(&0x1b) || binary.stdout.contains(&0), "bytes as they are");
    let back = tessim()
        .args(["convert", "-", "-", "--to", "text"])
        .write_stdin(binary.stdout.clone())
        .output()
        .unwrap();
    assert_eq!(back.stdout, text);
    for command in ["info", "run"] {
        let piped = tessim().args([command, "-"]).write_stdin(binary.stdout.clone()).assert();
        piped.success().stdout(predicate::str::contains("teapot"));
    }
}

#[test]
fn a_run_of_either_form_counts_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let binary = folder.path().join("mesh.tsb");
    convert(&shipped("mesh.jsonl"), &binary);
    let run = |trace: &Path, out: &str, more: &[&str]| {
        let out = folder.path().join(out);
        let mut command = tessim();
        command.arg("run").arg(trace).args(["--mesh", "ply", "--out"]).arg(&out).args(more);
        command.assert().success();
        ["counters.csv", "mesh.ply"].map(|name| fs::read(out.join(name)).unwrap())
    };
    let text = shipped("mesh.jsonl");
    assert_eq!(run(&text, "a", &[]), run(&binary, "b", &[]));
    let alone = ["--only-frame", "1"];
    let [counters, mesh] = run(&text, "c", &alone);
    assert_eq!(run(&binary, "d", &alone), [counters.clone(), mesh.clone()]);
    let counters = String::from_utf8(counters).unwrap();
    assert!(counters.contains("\n0,hybrid,trace,frames,1,") && !counters.contains("\n1,"));
    let [_, second] = run(&text, "e", &["--frame", "1"]);
    assert_eq!(mesh, second, "the frame alone is the frame of the whole");
    for trace in [&text, &binary] {
        let none = tessim().arg("run").arg(trace).args(["--only-frame", "2"]).assert().code(2);
        none.stdout("").stderr("--only-frame 2: no such frame: the trace has frames 0 to 1\n");
    }
}

#[test]
fn damage_is_refused_at_its_byte_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let [binary, out] = ["a.tsb", "b.jsonl"].map(|name| folder.path().join(name));
    convert(&shipped("teapot.jsonl"), &binary);
    let mut bytes = fs::read(&binary).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(&binary, &bytes).unwrap();
    let place = format!("^{}: byte [0-9]+: the block is damaged: found", binary.display());
    for command in ["convert", "info", "run"] {
        let mut failing = tessim();
        failing.arg(command).arg(&binary);
        if command == "convert" {
            failing.arg(&out);
        }
        let failed = failing.assert().code(2).stdout("");
        failed.stderr(predicate::str::is_match(&place).unwrap());
    }
    assert!(!out.exists());
    let cut = tessim().args(["info", "-"]).write_stdin(&bytes[..20]).assert().code(2);
    cut.stderr(predicate::str::starts_with("-: byte 20: the trace is truncated"));
    let text = tessim().args(["convert", "-"]).arg(&out).write_stdin("{}").assert().code(2);
    text.stderr(predicate::str::starts_with("-:1:"));
    assert!(!out.exists());
}

#[test]
fn wrong_usage_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let fails = |output: &str, wanted: &str| {
        let mut failing = tessim();
        failing.arg("convert").arg(shipped("teapot.jsonl")).arg(folder.path().join(output));
        failing.assert().code(2).stdout("").stderr(predicate::str::contains(wanted.to_owned()));
    };
    fails("a.bin", "give --to text or --to binary");
    fails("a", "found neither .jsonl (text) nor .tsb (binary)");
    let missing = tessim().args(["convert", "no/such.tsb", "a.jsonl"]).assert().code(3);
    missing.stderr(predicate::str::starts_with("no/such.tsb: "));
    let mut nowhere = tessim();
    nowhere.arg("convert").arg(shipped("teapot.jsonl")).arg("/no/such/a.tsb");
    let nowhere = nowhere.assert().code(3);
    nowhere.stderr(predicate::str::starts_with("/no/such/a.tsb: the folder to write in"));
}

#[test]
fn files_of_points_stay_in_their_folder_or_go_inline() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).unwrap();
    let points: Vec<u8> = (0..16 * 4).flat_map(|i| (1.0 + i as f32).to_le_bytes()).collect();
    fs::write(inside.join("p.f32"), points).unwrap();
    let frame = fs::read_to_string(shipped("teapot.jsonl")).unwrap();
    let frame = frame.lines().find(|line| line.starts_with("{\"frame\"")).unwrap().to_owned();
    let text = format!(
        "{{\"tessim\":1}}\n{frame}\n\
         {{\"points\":{{\"id\":0,\"file\":\"p.f32\",\"layout\":\"xyzw\",\"count\":16}}}}\n\
         {{\"draw\":{{\"primitive\":\"patches\",\"points\":0,\"count\":1}}}}\n{{\"end\":{{}}}}\n"
    );
    let trace = inside.join("t.jsonl");
    fs::write(&trace, &text).unwrap();
    let [beside, back] = ["t.tsb", "back.jsonl"].map(|name| inside.join(name));
    convert(&trace, &beside);
    convert(&beside, &back);
    assert_eq!(fs::read_to_string(&back).unwrap(), text);
    let away = folder.path().join("t.tsb");
    let refused = tessim().arg("convert").args([&trace, &away]).assert().code(2);
    refused.stderr(
        predicate::str::contains("the file \"p.f32\"")
            .and(predicate::str::contains("give --inline to put them into the trace")),
    );
    assert!(!away.exists());
    tessim().arg("convert").args([&trace, &away]).arg("--inline").assert().success();
    let info = |path: &Path| tessim().arg("info").arg(path).output().unwrap().stdout;
    let (named, inlined) = (info(&beside), info(&away));
    assert!(String::from_utf8(named).unwrap().contains("points xyzw in files     16"));
    assert!(!String::from_utf8(inlined).unwrap().contains("p.f32"));
    let run = |path: &Path| tessim().arg("run").arg(path).output().unwrap();
    assert!(run(&away).status.success());
    assert_eq!(run(&away).stdout, run(&trace).stdout);
}
