//! Sweeps that several processes or machines share, and what is said of them meanwhile.

use crate::place::{Place, count, fails, printed, tessim};
use std::fs::{self, File};
use std::process::{Command, Stdio};
use std::time::Duration;

const STUDY: &str = "traces = [\"fan.jsonl\", \"mesh.jsonl\"]\nunits = [\"sfarti\", \"moreton\"]\n\
                     [set]\nlevel.level = 4\n[grid]\nposition.width = [16, 20, 24]\n";

/// The numbers of `--status`: completed, failed, running, never run.
fn status(place: &Place, out: &str) -> [usize; 4] {
    let text = printed(place.sweep(out).arg("--status"));
    ["completed", "failed", "running", "never run"].map(|name| {
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        line[name.len()..].trim().parse().unwrap()
    })
}

#[test]
fn shards_put_together_are_the_whole() {
    let place = Place::new(STUDY);
    place.swept("whole");
    let mut computed = 0;
    fs::create_dir_all(place.path("together/points")).unwrap();
    for part in 1..=3 {
        let out = format!("part{part}");
        let told = printed(place.sweep(&out).args(["--shard", &format!("{part}/3")]));
        let points = place.points(&out);
        assert_eq!(count(&told, "computed"), points.len());
        assert!(told.contains("no tables yet"), "{told}");
        assert!(!place.path(&out).join("sweep.csv").exists());
        computed += points.len();
        for hash in points {
            let from = place.path(&out).join("points").join(&hash);
            fs::rename(from, place.path("together/points").join(hash)).unwrap();
        }
    }
    assert_eq!(computed, 12, "no point is of two shards");
    assert_eq!(count(&place.swept("together"), "computed"), 0);
    assert!(place.tree("together") == place.tree("whole"));
    // In one folder the last of them writes the tables.
    for part in ["2/2", "1/2"] {
        printed(place.sweep("shared").args(["--shard", part]));
    }
    assert!(place.tree("shared") == place.tree("whole"));
}

#[test]
fn processes_in_one_folder_compute_each_point_once() {
    let place = Place::new(STUDY);
    place.swept("alone");
    let program = tessim().get_program().to_owned();
    let children: Vec<_> = (0..4)
        .map(|_| {
            let mut command = Command::new(&program);
            command.current_dir(place.path("")).args(["sweep", "study.toml", "--out", "out"]);
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
        })
        .collect();
    let mut computed = 0;
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        computed += count(&String::from_utf8(output.stdout).unwrap(), "computed");
    }
    assert_eq!(computed, 12);
    assert!(place.tree("out") == place.tree("alone"));
}

#[test]
fn status_tells_what_runs_from_what_was_killed() {
    let place = Place::new(STUDY);
    assert_eq!(status(&place, "out"), [0, 0, 0, 12]);
    assert!(!place.path("out").exists(), "status changes nothing");
    place.swept("out");
    assert_eq!(status(&place, "out"), [12, 0, 0, 0]);
    let hashes = place.points("out");
    let [gone, held] = [&hashes[0], &hashes[1]];
    for hash in [gone, held] {
        fs::remove_dir_all(place.path("out/points").join(hash)).unwrap();
    }
    // A lock file that nobody holds is what a killed process leaves, and half a result.
    let lock = |hash: &str| place.path("out/work").join(format!("{hash}.lock"));
    File::create(lock(gone)).unwrap();
    fs::create_dir(place.path("out/work").join(gone)).unwrap();
    fs::write(place.path("out/work").join(gone).join("counters.csv"), "half").unwrap();
    let running = File::create(lock(held)).unwrap();
    running.lock().unwrap();
    assert_eq!(status(&place, "out"), [10, 0, 1, 1]);
    assert!(place.path("out/sweep.csv").exists(), "status changes nothing");

    // A process that finds a point taken does the others, and takes it when it is free.
    let mut command = Command::new(tessim().get_program());
    command.current_dir(place.path("")).args(["sweep", "study.toml", "--out", "out"]);
    let child = command.stdout(Stdio::piped()).spawn().unwrap();
    while !place.path("out/points").join(gone).exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(!place.path("out/sweep.csv").exists(), "it is not of these points any more");
    assert!(!place.path("out/points").join(held).exists());
    drop(running);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(count(&String::from_utf8(output.stdout).unwrap(), "computed"), 2);
    assert_eq!(status(&place, "out"), [12, 0, 0, 0]);
    place.swept("alone");
    assert!(place.tree("out") == place.tree("alone"));
}

#[test]
fn status_counts_what_failed_and_says_why() {
    let place = Place::new(
        "traces = [\"fan.jsonl\"]\n[set]\nengine = \"none\"\n\
         [grid]\nposition.width = [16, 7]\n",
    );
    assert_eq!(status(&place, "out"), [0, 1, 0, 1]);
    let (_, said) = fails(1, &mut place.sweep("out"));
    let text = printed(place.sweep("out").arg("--status"));
    let reason = "point 1 (fan.jsonl, modern, hybrid, position.width=7): study.toml:5:23: \
                  position.width: found 7, expected 8..=48\n";
    assert!(text.ends_with(reason) && said.starts_with(reason), "{text}{said}");
    assert_eq!(status(&place, "out"), [1, 1, 0, 0]);
}
