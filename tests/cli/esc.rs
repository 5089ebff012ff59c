//! `pattern --unit esc` as users meet it: what is printed and what is refused.

use super::{fails, tessim};
use predicates::prelude::*;

#[test]
fn meshes_of_coarse_triangles_come_one_line_each() {
    let lines = |arguments: &[&str], input: &str| -> String {
        let mut command = tessim();
        let command = command.args(["pattern", "--unit", "esc"]).args(arguments).write_stdin(input);
        String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
    };
    // The paper's figure 5b, in its vertex numbers.
    let want = "{\"L\":2,\"left\":[1,0],\"right\":[1,0],\"bottom\":[1,1],\
                \"triangles\":[[2,3,1],[7,8,2],[8,9,2],[2,9,3],[9,10,3]]}\n";
    assert_eq!(lines(&["--level=2", "--left=10", "--right", "10"], ""), want);
    assert_eq!(lines(&["--batch", "-"], "esc 2 10 10 11\n"), want);
    let vectors = include_str!("../vectors/esc.txt").lines().filter(|line| !line.starts_with('#'));
    let requests: String = vectors
        .clone()
        .map(|line| format!("esc {}\n", line.split_once(" | ").unwrap().0))
        .collect();
    let mut compared = 0;
    for (got, want) in lines(&["--batch", "-"], &requests).lines().zip(vectors) {
        let got: serde_json::Value = serde_json::from_str(got).unwrap();
        let triangles = got["triangles"].to_string().replace("],[", " ");
        assert_eq!(triangles, format!("[[{}]]", want.split_once(" | ").unwrap().1));
        compared += 1;
    }
    assert_eq!(compared, 584);
    let wrong = "esc 1 1 1 1\nesc 1 1 11 1\n";
    let failed = ["pattern", "--unit", "esc", "--batch", "-"];
    let failed = tessim().args(failed).write_stdin(wrong).assert().code(2);
    failed.stderr(predicate::str::starts_with("-:2:9: found \"11\", expected a bit"));
    let with = |arguments: &[&str]| fails(2, &[&["pattern", "--unit=esc"], arguments].concat());
    assert!(with(&[]).contains("--level: found nothing"));
    assert!(with(&["--level=16"]).contains("--level: found \"16\", expected a level"));
    assert!(with(&["--level=2", "--bottom=012"]).contains("--bottom: found \"012\""));
    assert!(with(&["--factors=1,1,1,1"]).contains("found --factors"));
    assert!(with(&["--level=1", "--batch=-"]).contains("cannot be used with"));
    let other = fails(2, &["pattern", "--factors=1,1,1,1", "--right=1"]);
    assert!(other.contains("found --right, expected what the unit takes: --factors"));
    let other = fails(2, &["pattern", "--unit=esc", "--level=1", "--domain=tri"]);
    assert!(other.contains("found --domain"));
}
