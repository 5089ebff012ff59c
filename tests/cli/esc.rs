//! Unit `esc` as users meet it: what `pattern` prints, what `run` writes, what is refused.

use super::{fails, run, tessim, trace};
use predicates::prelude::*;
use std::fs;

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

#[test]
fn every_trace_runs_and_any_number_of_threads_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let traces = fs::read_dir(trace("")).unwrap().map(|entry| entry.unwrap().path());
    let traces = traces.filter(|path| path.extension().is_some_and(|e| e == "jsonl"));
    let settings: [&[&str]; 3] = [
        &[],
        &["--set", "esc.output_values=1024", "--set", "esc.space=object", "--set", "esc.width=3"],
        &["--set", "esc.scope=object", "--set", "esc.level=screen_size", "--mesh", "ply"],
    ];
    let mut compared = 0;
    for (k, path) in traces.enumerate() {
        for (s, settings) in settings.iter().enumerate() {
            let results = ["1", "3"].map(|threads| {
                let out = folder.path().join(format!("{k}.{s}.{threads}"));
                let arguments = ["-q", "--unit", "esc", "--threads", threads];
                run(&[&arguments[..], settings].concat(), &path, &out);
                let read = |name: &str| fs::read(out.join(name)).unwrap();
                let mesh = if settings.contains(&"ply") { read("mesh.ply") } else { Vec::new() };
                [read("counters.csv"), read("occupancy.csv"), read("summary.json"), mesh]
            });
            assert!(results[0] == results[1], "{} {settings:?}", path.display());
            let csv = String::from_utf8(results[0][0].clone()).unwrap();
            let made = csv.lines().filter(|row| row.contains(",esc,surface,triangles,"));
            assert!(made.clone().count() > 0 && made.clone().all(|row| !row.contains(",0,count")));
            compared += csv.lines().count();
        }
    }
    println!("compared {compared} rows");
    assert!(compared > 9 * 3 * 200);
}

#[test]
fn a_surface_shader_that_cannot_be_is_refused_by_its_key() {
    let cases: [(&[&str], &str); 14] = [
        (&["esc.levle=fixed"], "did you mean `esc.level`?"),
        (&["esc.level=distnace"], "esc.level: found \"distnace\", expected criterion, fixed"),
        (&["esc.level_max=16"], "esc.level_max: found 16, expected 0..=15"),
        (&["esc.level=fixed", "esc.level_max=2"], "esc.fixed_level: found 3"),
        (&["esc.scope=object"], "esc.scope: found object with esc.level criterion"),
        (&["esc.full_distance=0"], "esc.full_distance: found 0"),
        (&["esc.full_pixels=70000"], "esc.full_pixels: found 70000"),
        (&["esc.mu=-1"], "esc.mu: found -1"),
        (&["esc.control_mesh=surface"], "expected net or chord"),
        (&["position.width=48", "esc.guard=8"], "esc.guard: found 8"),
        (&["esc.parameter_bits=47"], "esc.parameter_bits: found 47, expected 16..=46"),
        (&["esc.output_values=263"], "esc.output_values: found 263, below the 264"),
        (&["esc.width=0"], "esc.width: found 0, expected 1..=1024"),
        (&["block.surface.point=2000000"], "block.surface.point: found 2000000"),
    ];
    for (settings, wanted) in cases {
        let mut arguments = vec!["config", "--unit", "esc"];
        arguments.extend(settings.iter().flat_map(|setting| ["--set", setting]));
        let message = fails(2, &arguments);
        assert!(message.contains(wanted), "`{wanted}` is not in: {message}");
    }
    // Object space is the frame's: w = 1 has no place in the format, or no bit.
    let teapot = trace("teapot.jsonl");
    let teapot = teapot.to_str().unwrap();
    for range in ["-1", "32", "100"] {
        let range = format!("position.object_range_log2={range}");
        let object = ["run", teapot, "--unit=esc", "--set=esc.space=object", "--set", &range];
        assert!(fails(2, &object).contains("in object space"), "{range}");
        tessim().args(object).args(["--set", "esc.mu=0"]).assert().success();
    }
}
