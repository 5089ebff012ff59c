//! Killed at any moment and started again: the same tables, byte for byte.
//!
//! Moments are drawn in terms of progress: so many results more than there were, and then a little
//! longer, so that some fall before the first, some into the middle of one, some among the tables.

use crate::place::{Place, tessim};
use crate::random::Random;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Twelve points, two of them equal, one that cannot be.
const STUDY: &str = "traces = [\"fan.jsonl\", \"mesh.jsonl\"]\n\
                     units = [\"sfarti\", \"hybrid\"]\n[set]\nlevel.level = 12\n\
                     [grid]\nposition.width = [16, 20]\n\
                     [[list]]\nposition.width = 20\nunit = \"sfarti\"\ntrace = \"fan.jsonl\"\n\
                     [[list]]\nposition.width = 99\n";

const KILLS: usize = 50;

const TABLES: [&str; 4] = ["points.csv", "sweep.svg", "sweep.csv", "study.toml"];

fn start(place: &Place, threads: u32) -> Child {
    let program = tessim().get_program().to_owned();
    let mut command = Command::new(program);
    command.current_dir(place.path(""));
    command.args(["sweep", "study.toml", "--out", "out", "--threads", &threads.to_string()]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

/// Whatever is there is whole: results, and tables.
fn check(place: &Place, whole: &Place) {
    for hash in place.points("out") {
        let point = format!("out/points/{hash}");
        assert!(place.tree(&point) == whole.tree(&point), "{hash} is not whole");
    }
    for name in TABLES {
        if let Ok(bytes) = fs::read(place.path("out").join(name)) {
            assert!(bytes == fs::read(whole.path("out").join(name)).unwrap(), "{name}");
        }
    }
}

/// Whether the table that is written last is there.
fn ended(place: &Place) -> bool {
    place.path("out/sweep.csv").exists()
}

#[test]
fn a_sweep_that_is_killed_fifty_times_gives_the_same_bytes() {
    let whole = Place::new(STUDY);
    let output = whole.sweep("out").output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let distinct = whole.points("out").len();
    assert_eq!(distinct, 8);

    let mut random = Random::new(8);
    let mut place = Place::new(STUDY);
    let (mut kills, mut interrupted, mut between) = (0, 0, 0);
    while kills < KILLS {
        let before = place.points("out").len();
        let target = distinct.min(before + random.integer(0, 3) as usize);
        let mut child = start(&place, random.integer(1, 2));
        while place.points("out").len() < target && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_micros(50));
        }
        std::thread::sleep(Duration::from_micros(random.integer(0, 3000).into()));
        child.kill().unwrap();
        if child.wait().unwrap().signal() == Some(9) {
            kills += 1;
            interrupted += usize::from(within_a_point(&place));
            between += usize::from(place.points("out").len() == distinct && !ended(&place));
        }
        check(&place, &whole);
        // Killed once more where nothing but the tables is missing, and then another from nothing.
        if before == distinct || ended(&place) {
            place.sweep("out").output().unwrap();
            assert!(place.tree("out") == whole.tree("out"), "after {kills} kills");
            place = Place::new(STUDY);
        }
    }
    println!("{kills} kills: {interrupted} within a point, {between} before the tables");
    // Else it was the moments that were harmless.
    assert!(interrupted >= 5, "only {interrupted} of {KILLS} kills fell into a point");
    place.sweep("out").output().unwrap();
    assert!(place.tree("out") == whole.tree("out"), "after {KILLS} kills");
}

/// Whether the killed one has left a point that it was at.
fn within_a_point(place: &Place) -> bool {
    let work = fs::read_dir(place.path("out/work"));
    let mut names = work.into_iter().flatten().map(|entry| entry.unwrap().file_name());
    names.any(|name| name.to_str().is_some_and(|name| name.len() >= 32))
}
