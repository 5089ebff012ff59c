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
    assert!(!place.path("page.html").exists());
}

#[test]
fn what_is_no_result_is_refused() {
    let place = Place::new();
    refused(&place, "nothing", &["nothing: not a folder; expected a result of tessim"]);
    fs::write(place.path("file"), "").unwrap();
    refused(&place, "file", &["file: not a folder"]);
    fs::create_dir(place.path("empty")).unwrap();
    refused(&place, "empty", &["empty: no result of tessim", "compare.csv", "points.csv"]);
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
    damage("frames.csv", b"unit\n", &["compared/frames.csv:1:", "found unit; expected columns"]);
    damage("summary.json", b"{\n \"tessim\": \n", &["compared/summary.json:3:", "expected JSON"]);
    damage("summary.json", b"[]", &["compared/summary.json:1:", "the version that wrote it"]);
    damage("config.toml", b"\n\xff", &["compared/config.toml:2:", "no UTF-8"]);
    place.compared(&teapot());
    fs::remove_file(place.path("compared/summary.json")).unwrap();
    refused(&place, "compared", &["compared/summary.json:1:", "not there"]);
}
