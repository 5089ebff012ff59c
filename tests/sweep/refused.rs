//! Studies that are none, folders that are none, points that cannot be.

use crate::place::{Place, count, fails, shipped};
use std::fs;

#[test]
fn a_malformed_study_is_refused_with_its_line_and_leaves_nothing() {
    let place = Place::new("");
    let traces = "traces = [\"fan.jsonl\"]\n";
    for (study, says) in [
        ("", "study.toml:1:1: found no traces, expected traces = [\"FILE\", ..]"),
        ("traces = [\n", "study.toml:1:11: unclosed array"),
        ("traces = \"fan.jsonl\"", "study.toml:1:10: traces: found \"fan.jsonl\", expected a list"),
        ("traces = []", "study.toml:1:10: traces: found [], expected a list of strings"),
        ("traces = [3]", "study.toml:1:11: traces: found 3, expected a string"),
        ("trace = [\"fan.jsonl\"]", "study.toml:1:1: unknown `trace`; did you mean `traces`?"),
        ("[grdi]\n", "study.toml:2:2: unknown `grdi`; did you mean `grid`?"),
        ("units = [\"hybird\"]", "study.toml:2:10: unknown `hybird`; did you mean `hybrid`?"),
        ("presets = [\"gf3\"]", "study.toml:2:12: unknown `gf3`; did you mean `gf3-2001`?"),
        ("set = 3", "study.toml:2:7: set: found 3, expected a table of keys"),
        (
            "[set]\n\n  position.widht = 16",
            "study.toml:4:12: unknown key `position.widht`; did you mean `position.width`?",
        ),
        ("[set]\nunit = \"esc\"", "study.toml:3:1: found unit here, expected units = [..]"),
        (
            "[set]\nposition.width = \"wide\"",
            "study.toml:3:18: position.width: found \"wide\", expected 8..=48",
        ),
        (
            "[grid]\nposition.width = 16",
            "study.toml:3:18: position.width: found 16, expected a list, such as [1, 2]",
        ),
        ("[grid]\nposition.width = []", "study.toml:3:18: position.width: found 0 values"),
        (
            "[grid]\nposition.width = [8]\n\"position.width\" = [9]",
            "study.toml:4:1: grid: found position.width twice",
        ),
        ("[list]\nposition.width = 8", "study.toml:2:1: list: found "),
        ("[[list]]\nunit = 3", "study.toml:3:8: unit: found 3, expected a string"),
        ("[[list]]\nenginge = \"none\"", "study.toml:3:1: unknown key `enginge`; did you mean"),
        ("config = \"missing.toml\"", "missing.toml: No such file"),
        ("traces = [\"-\"]", "study.toml:1:11: traces: found standard input, expected the path"),
        ("[[list]]\ntrace = \"-\"", "study.toml:3:9: trace: found standard input"),
    ] {
        // In most of them the study begins in the second line.
        let bare = study.is_empty() || study.starts_with("trace");
        place.study(&format!("{}{study}", if bare { "" } else { traces }));
        let code = if says.contains("No such") { 3 } else { 2 };
        let (printed, said) = fails(code, place.sweep("out").arg("-q"));
        assert!(said.starts_with(says), "{study}\n{said}\n{says}");
        assert!(printed.is_empty() && !place.path("out").exists());
    }
}

#[test]
fn more_points_than_anybody_waits_for_are_refused_before_they_are_made() {
    let many: Vec<_> = (1..=1000).map(|n| n.to_string()).collect();
    let many = many.join(", ");
    let study = format!(
        "traces = [\"fan.jsonl\"]\n[grid]\nlink.latency = [{many}]\nclock_mhz = [{many}]\n\
         memory.latency = [{many}]\n"
    );
    let (_, said) = fails(2, &mut Place::new(&study).sweep("out"));
    assert!(said.starts_with("study.toml:4:13: clock_mhz: found 1000 values, which make 1000000"));
    let study = format!(
        "traces = [\"fan.jsonl\", \"mesh.jsonl\"]\n[grid]\nlink.latency = [{many}]\n\
         clock_mhz = [{}]\n",
        (1..=60).map(|n| n.to_string()).collect::<Vec<_>>().join(", ")
    );
    let (_, said) = fails(2, &mut Place::new(&study).sweep("out"));
    assert!(said.contains("found 120000 points, expected at most 100000"), "{said}");
}

#[test]
fn traces_that_cannot_be_read_are_refused_before_anything_runs() {
    let place = Place::new("traces = [\"fan.jsonl\", \"no.jsonl\"]\n");
    let (_, said) = fails(3, &mut place.sweep("out"));
    assert!(said.starts_with("no.jsonl: No such file"), "{said}");
    let text = fs::read_to_string(shipped("fan.jsonl")).unwrap();
    fs::write(place.path("no.jsonl"), text.replace("\"fan\"", "\"fun\"")).unwrap();
    let (_, said) = fails(2, &mut place.sweep("out"));
    assert!(said.starts_with("no.jsonl:") && said.contains("fun"), "{said}");
    assert!(!place.path("out").exists());
}

#[test]
fn a_folder_that_holds_anything_else_is_left_alone() {
    let place = Place::new("traces = [\"fan.jsonl\"]\n[set]\nengine = \"none\"\n");
    fs::create_dir(place.path("mine")).unwrap();
    fs::write(place.path("mine/notes.txt"), "mine").unwrap();
    let (_, said) = fails(2, &mut place.sweep("mine"));
    assert!(said.starts_with("mine: holds notes.txt, which no sweep wrote; expected"), "{said}");
    assert_eq!(place.tree("mine").len(), 1);
    let (_, said) = fails(2, &mut place.sweep("fan.jsonl"));
    assert!(said.starts_with("fan.jsonl: exists and is not a folder"), "{said}");
    let (_, said) = fails(3, &mut place.sweep("no/such/out"));
    assert!(said.starts_with("no/such/out: "), "{said}");
    let (_, said) = fails(2, place.sweep("out").args(["--shard", "3/2"]));
    assert!(said.contains("expected i/n with 1 <= i <= n"), "{said}");
}

const FAILING: &str = "traces = [\"fan.jsonl\"]\n[set]\nengine = \"none\"\nlevel.level = 2\n\
                       [grid]\nposition.width = [16, 99, 24]\nevaluate.guard = [20, 50]\n";

#[test]
fn a_point_that_cannot_be_is_reported_and_stops_nothing() {
    let place = Place::new(FAILING);
    let failing = |said: &str| {
        let width = "position.width: found 99, expected 8..=48";
        for guard in [20, 50] {
            let point = format!("position.width=99, evaluate.guard={guard}): study.toml:6:23: ");
            assert!(said.contains(&format!("{point}{width}")), "{said}");
        }
        for width in [16, 24] {
            let point = format!("position.width={width}, evaluate.guard=50): study.toml:7:23: ");
            assert!(said.contains(&format!("{point}evaluate.guard: found 50 with")), "{said}");
        }
        assert!(said.ends_with("4 of 6 points failed\n"), "{said}");
    };
    let (printed, said) = fails(1, &mut place.sweep("out"));
    failing(&said);
    assert_eq!((count(&printed, "computed"), place.points("out").len()), (2, 2));
    // It is reported again, and even where nothing else is.
    let (printed, said) = fails(1, place.sweep("out").arg("-q"));
    failing(&said);
    assert!(printed.is_empty());
    let rows = place.rows("out/points.csv");
    let column = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!(column("state").iter().filter(|state| **state == "completed").count(), 2);
    assert_eq!(column("position.width"), ["16", "16", "99", "99", "24", "24"]);
    assert!(column("reason")[1].contains("evaluate.guard: found 50"));
    assert_eq!((column("hash")[1], column("link_bytes_per_patch")[1]), ("", ""));
    let counted = place.rows("out/sweep.csv");
    assert!(counted.iter().all(|row| row["point"] == "0" || row["point"] == "4"));
}

#[test]
fn a_point_that_breaks_off_is_remembered_with_its_reason() {
    let place = Place::new(
        "traces = [\"endless.jsonl\"]\n[set]\nengine = \"none\"\nlevel.level = 2\n\
         [grid]\nevaluate.guard = [10, 12]\n[[list]]\nposition.clip_range_log2 = 4\n",
    );
    // A far plane at infinity, and no range: the port does not know what to scale by.
    let text = fs::read_to_string(shipped("fan.jsonl")).unwrap();
    let endless = text.replace("-1.1574914,-1,0,0,-1.6386297", "-1,-1,0,0,-1.4");
    assert_ne!(text, endless);
    fs::write(place.path("endless.jsonl"), endless).unwrap();
    let (printed, first) = fails(1, &mut place.sweep("out"));
    assert!(first.contains("point 0 (endless.jsonl, modern, hybrid, evaluate.guard=10"), "{first}");
    assert!(first.contains("far plane") && first.ends_with("2 of 3 points failed\n"), "{first}");
    assert_eq!(count(&printed, "computed"), 3);
    let (printed, again) = fails(1, &mut place.sweep("out"));
    assert_eq!((count(&printed, "computed"), count(&printed, "found")), (0, 3));
    assert_eq!(again, first);
    assert_eq!(place.tree("out/failed").len(), 2);
    assert_eq!(place.tree("out/work").len(), 0);
    let rows = place.rows("out/points.csv");
    assert_eq!(rows[2]["state"], "completed");
    // What a point does not set is as it is in effect.
    let cells = ["evaluate.guard", "position.clip_range_log2"].map(|key| rows[2][key].as_str());
    assert_eq!(cells, ["20", "4"]);
    assert_eq!(rows[0]["position.clip_range_log2"], "");
}
