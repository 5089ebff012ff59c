//! `tessim render` and `compare --pictures` as users meet them.

use super::support::{device, trace};
use assert_cmd::Command;
use std::fs;

const MARK: &[u8] = b"\x89PNG\r\n\x1a\n";

fn tessim() -> Command {
    Command::cargo_bin("tessim").expect("the command is built for its tests")
}

#[track_caller]
fn fails(code: i32, arguments: &[&str], says: &str) {
    let place = tempfile::tempdir().unwrap();
    let output = tessim().current_dir(place.path()).args(arguments).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    assert!(message.contains(says), "{arguments:?}: {message}");
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0, "nothing is left behind");
}

#[test]
fn what_cannot_be_drawn_is_told() {
    let trace = trace("teacup");
    let trace = trace.to_str().unwrap();
    fails(2, &["render", trace, "--style", "pretty"], "possible values: shaded");
    fails(2, &["render", trace, "--frame", "1"], "--frame 1: no such frame: the trace has frame 0");
    fails(2, &["render", trace, "--size", "640"], "expected WIDTHxHEIGHT");
    fails(2, &["render", trace, "--size", "640x16385"], "from 1 to 16384");
    fails(3, &["render", "no-such.jsonl"], "no-such.jsonl");
    fails(3, &["render", trace, "--size", "32x32", "--out", "no/such/p.png"], "no/such");
    fails(2, &["compare", trace, "--pictures"], "--out");
}

#[test]
fn pictures_sheets_and_comparisons_are_written() {
    if device().is_none() {
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let trace = trace("teacup");
    let run = |arguments: &[&str]| {
        tessim().current_dir(place.path()).args(arguments).assert().success().stdout("");
    };
    let trace = trace.to_str().unwrap();
    let size = |name: &str| {
        let bytes = fs::read(place.path().join(name)).unwrap();
        assert!(bytes.starts_with(MARK));
        let side = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        [side(16), side(20)]
    };
    run(&["render", trace, "--size", "200x160"]);
    let one = size("picture.png");
    assert!(one[0] == 200 && (161..220).contains(&one[1]), "{one:?}");
    run(&[
        "render", trace, "--size", "200x160", "--style", "all", "--tile", "50", "--out", "s.png",
    ]);
    let sheet = size("s.png");
    assert!(sheet[0] == 600 && sheet[1] > 2 * one[1], "{sheet:?}");
    let compare = ["-q", "compare", trace, "--units", "hybrid,esc", "--out", "both"];
    run(&compare);
    assert!(!place.path().join("both/pictures.png").exists());
    run(&[&compare[..], &["--pictures=error"]].concat());
    assert_eq!(size("both/pictures.png")[0], 1280);
    // One with pictures is replaced like one without.
    run(&compare);
    assert!(!place.path().join("both/pictures.png").exists());
}

#[test]
fn a_picture_goes_to_standard_output_and_is_the_same_each_time() {
    if device().is_none() {
        return;
    }
    let picture = || {
        let trace = trace("fan");
        let mut command = tessim();
        command.arg("render").arg(trace).args(["--size", "64x64", "--out", "-"]);
        command.output().unwrap().stdout
    };
    let first = picture();
    assert!(first.starts_with(MARK) && first == picture());
}
