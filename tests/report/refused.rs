//! Folders of which no page can be made: the file, the line and what was expected are named, and
//! no page appears.

use super::{Place, teapot, tessim};
use std::fs;

fn refused(place: &Place, folder: &str, wanted: &[&str]) {
    let mut command = tessim();
    command.current_dir(place.path("")).args(["report", folder, "--out", "page.html"]);
    let assert = command.assert().code(2);
    let said = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    for word in wanted {
        assert!(said.contains(word), "{word}: {said}");
    }
    assert!(!said.contains(" at line "), "the place twice: {said}");
    assert!(!place.path("page.html").exists());
}

#[test]
fn what_is_no_result_is_refused() {
    let place = Place::new();
    refused(&place, "nothing", &["nothing: not a folder; expected a result of tessim"]);
    fs::write(place.path("file"), "").unwrap();
    refused(&place, "file", &["file: not a folder"]);
    fs::create_dir(place.path("empty")).unwrap();
    refused(&place, "empty", &["empty: no result of tessim: found nothing", "points.csv"]);
    for name in ["a", "b", "c", "d", "e", "f", "g"] {
        fs::write(place.path(&format!("empty/{name}")), "").unwrap();
    }
    refused(&place, "empty", &["found a, b, c, d, e and 2 more; expected", "compare.csv"]);
}

#[test]
fn a_page_within_its_own_folder_is_refused_and_replaces_nothing() {
    let place = Place::new();
    place.compared(&teapot());
    let summary = fs::read(place.path("compared/summary.json")).unwrap();
    let files = || fs::read_dir(place.path("compared")).unwrap().count();
    let before = files();
    let try_out = |at: &str, folder: &str, out: &str| {
        let mut command = tessim();
        command.current_dir(place.path(at)).args(["report", folder, "--out", out]);
        let assert = command.assert().code(2);
        let said = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        assert!(said.contains("expected a place outside it") && said.contains(out), "{said}");
    };
    try_out("", "compared", "compared/summary.json");
    try_out("", "compared/", "./compared/../compared/page.html");
    try_out("compared", ".", "page.html");
    try_out("compared", "../compared", "page.html");
    std::os::unix::fs::symlink("compared/summary.json", place.path("link.html")).unwrap();
    try_out("", "compared", "link.html");
    assert_eq!(fs::read(place.path("compared/summary.json")).unwrap(), summary);
    assert_eq!(files(), before);
    // Nowhere is no place inside.
    let mut command = tessim();
    command.current_dir(place.path("")).args(["report", "compared", "--out", "nowhere/page.html"]);
    command.assert().code(3);
}

#[test]
fn damaged_files_are_named_with_their_line() {
    let place = Place::new();
    let damage = |file: &str, bytes: &[u8], wanted: &[&str]| {
        place.compared(&teapot());
        fs::write(place.path(&format!("compared/{file}")), bytes).unwrap();
        refused(&place, "compared", wanted);
        fs::remove_dir_all(place.path("compared")).unwrap();
    };
    let header = "unit,block,counter,value,measure,first,min,median,max";
    let short = format!("{header}\nhybrid,trace,frames,1,count,1,1,1,1\nhybrid,trace\n");
    damage(
        "compare.csv",
        short.as_bytes(),
        &["compared/compare.csv:3:", "found 2 cells, expected 9"],
    );
    let bytes = [header.as_bytes(), b"\na,b,\xff,1,c,1,1,1,1\n"].concat();
    damage("compare.csv", &bytes, &["compared/compare.csv:2:", "no UTF-8"]);
    damage("compare.csv", b"", &["compared/compare.csv:1:", "expected the names of columns"]);
    damage("compare.csv", b"unit,value\n", &["compare.csv:1:", "expected columns unit,block"]);
    let words = format!("{header}\na,b,c,1,d,1,1,1,1\na,b,c,abc,d,1,1,1,1\n");
    let wanted = ["compared/compare.csv:3:", "value: found \"abc\", expected a number"];
    damage("compare.csv", words.as_bytes(), &wanted);
    let words = format!("{header}\na,b,c,1,d,1,1,inf,1\n");
    damage("compare.csv", words.as_bytes(), &["compare.csv:2:", "median: found \"inf\""]);
    damage("plot.png", b"", &["compared/plot.png: byte 0:", "found 0 bytes", "a whole PNG"]);
    damage("plot.png", b"\x89PNG\r\n\x1a\n cut", &["plot.png: byte 0:", "IEND"]);
    damage("plot.svg", b"no picture", &["compared/plot.svg: byte 0:", "a whole SVG"]);
    damage("plot.svg", b"<svg xmlns=\"x\"><g>", &["plot.svg: byte 0:", "</svg>"]);
    damage("frames.csv", b"unit\n", &["compared/frames.csv:1:", "found unit; expected columns"]);
    damage("summary.json", b"{\n \"tessim\": \n", &["compared/summary.json:3:", "expected JSON"]);
    damage("summary.json", b"[]", &["compared/summary.json:1:", "the version that wrote it"]);
    damage("config.toml", b"\n\xff", &["compared/config.toml:2:", "no UTF-8"]);
    place.compared(&teapot());
    fs::remove_file(place.path("compared/summary.json")).unwrap();
    refused(&place, "compared", &["compared/summary.json:1:", "not there"]);
}

#[test]
fn a_completed_point_without_its_result_is_named() {
    let place = Place::new();
    fs::copy(teapot(), place.path("teapot.jsonl")).unwrap();
    let study = "traces = [\"teapot.jsonl\"]\n[set]\nengine = \"none\"\nlevel.level = 2\n";
    fs::write(place.path("study.toml"), study).unwrap();
    place.run(&["sweep", "study.toml", "--out", "swept"]);
    fs::remove_dir_all(place.path("swept/points")).unwrap();
    refused(&place, "swept", &["swept/points/", "summary.json:1:", "not there"]);
}
