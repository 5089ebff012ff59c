//! Whether the comparisons would notice a wrong constant: each number in each kernel is made one
//! larger, one at a time, and the comparisons that go through the kernel are run again by another
//! process.
//!
//! By default one of each file; `TESSIM_MUTANTS=1` takes them all, `TESSIM_MUTANTS=7` every
//! seventh, and `TESSIM_MUTANTS=stem` those of one file. Survivors are printed with their lines;
//! docs/kernels.md explains those that are known.

use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tessim::gpu::Sources;

/// A comparison that takes longer hangs: a loop has lost its end.
const PATIENCE: Duration = Duration::from_secs(90);

/// Of a hundred, how many must be caught: of many constants, and of a few, which prove less.
const CAUGHT: usize = 95;
const CAUGHT_OF_FEW: usize = 80;

struct Mutant {
    file: &'static str,
    line: usize,
    was: String,
    becomes: String,
    text: String,
}

/// The numbers of a kernel's text: not in comments, nor in attributes such as `@binding(1)`.
fn numbers(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        if text[at..].starts_with("//") {
            at += text[at..].find('\n').unwrap_or(text.len() - at);
        } else if bytes[at] == b'@' {
            let end = text[at..].find([')', '\n']).unwrap_or(1);
            at += end.max(1);
        } else if bytes[at].is_ascii_digit() {
            let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
            let end = at + bytes[at..].iter().take_while(|b| word(b)).count();
            found.push(at..end);
            at = end;
        } else if bytes[at].is_ascii_alphabetic() || bytes[at] == b'_' {
            let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
            at += bytes[at..].iter().take_while(|b| word(b)).count();
        } else {
            at += 1;
        }
    }
    found
}

/// One more, in the same notation.
fn one_more(literal: &str) -> String {
    let (digits, suffix) = match literal.strip_suffix(['u', 'i']) {
        Some(digits) => (digits, &literal[digits.len()..]),
        None => (literal, ""),
    };
    match digits.strip_prefix("0x") {
        Some(hex) => {
            let value = u32::from_str_radix(hex, 16).expect("a hexadecimal number");
            format!("{:#x}{suffix}", value.wrapping_add(1))
        }
        None => {
            let value: u64 = digits.parse().expect("a decimal number");
            format!("{}{suffix}", (value + 1) & 0xffff_ffff)
        }
    }
}

fn mutants(chosen: Option<&str>) -> Vec<Mutant> {
    let mut all = Vec::new();
    for file in Sources::files() {
        let text = Sources::shipped(file).expect("a file that is listed");
        let numbers = numbers(text);
        let stem = file.trim_end_matches(".wgsl");
        let every = match chosen {
            None => numbers.len().max(1),
            Some(name) if name == stem => 1,
            Some(name) => match name.parse() {
                Ok(every) => every,
                Err(_) => continue,
            },
        };
        for range in numbers.into_iter().skip(every / 2).step_by(every) {
            let was = text[range.clone()].to_owned();
            let becomes = one_more(&was);
            let line = text[..range.start].lines().count().max(1);
            let text = [&text[..range.start], &becomes, &text[range.end..]].concat();
            all.push(Mutant { file, line, was, becomes, text });
        }
    }
    all
}

/// The comparisons that go through a kernel: of its block, and of the units that are made of it.
fn own(file: &str) -> &'static [&'static str] {
    match file.split(['_', '.']).next().expect("a name") {
        "number" | "operations" => &["number::", "clip::", "surface::"],
        "settings" | "scan" => &[""],
        "clip" => &["clip::"],
        "backface" => &["backface::"],
        "level" => &["level::", "surface::"],
        "place" | "plan" => &["place::", "evaluate::", "stitch::", "surface::"],
        "evaluate" | "normal" => &["evaluate::", "surface::"],
        "stitch" => &["stitch::", "surface::"],
        "emit" => &["emit::", "surface::"],
        "single" => &["single::", "d3d11"],
        "d3d11" => &["d3d11"],
        "esc" => &["esc::"],
        _ => panic!("{file}: say which comparisons go through it"),
    }
}

/// Whether a process that runs these comparisons fails.
fn fails(folder: &std::path::Path, filters: &[&str]) -> bool {
    let exe = std::env::current_exe().expect("this test has a file");
    let mut child = Command::new(exe)
        .args(filters)
        .args(["--skip", "mutants::", "--nocapture"])
        .env("TESSIM_KERNELS", folder)
        .env_remove("TESSIM_MUTANTS")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the comparisons start");
    let (out, started) = (child.stdout.take().expect("it is piped"), Instant::now());
    let failed = std::thread::scope(|scope| {
        let reader = scope.spawn(move || {
            let mut lines = BufReader::new(out).lines().map_while(Result::ok);
            lines.any(|line| line.contains("FAILED"))
        });
        while !reader.is_finished() && started.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(20));
        }
        let hangs = !reader.is_finished();
        if hangs {
            let _ = child.kill();
        }
        hangs | reader.join().expect("the reader does not panic")
    });
    let _ = child.kill();
    let status = child.wait().expect("it was started");
    failed || !(status.success() || status.code().is_none())
}

fn caught(mutant: &Mutant) -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in Sources::files() {
        let text = if file == mutant.file { &mutant.text } else { Sources::shipped(file).unwrap() };
        std::fs::write(folder.path().join(file), text).expect("room for kernels");
    }
    fails(folder.path(), own(mutant.file))
}

#[test]
fn a_changed_constant_is_noticed() {
    let running = std::env::var_os("TESSIM_KERNELS").is_some();
    if running || crate::support::device().is_none() {
        return;
    }
    let chosen = std::env::var("TESSIM_MUTANTS").ok();
    let mutants = mutants(chosen.as_deref());
    let (next, survivors) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some((number, mutant)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|n| Some((n, mutants.get(n)?)))
        {
            if !caught(mutant) {
                let Mutant { file, line, was, becomes, .. } = mutant;
                println!("survives: {file}:{line}: {was} as {becomes}");
                survivors.lock().unwrap().push((number, *file));
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let survivors = survivors.into_inner().unwrap();
    for file in Sources::files() {
        let all = mutants.iter().filter(|mutant| mutant.file == file).count();
        let left = survivors.iter().filter(|(_, name)| *name == file).count();
        println!("{file}: {} of {all} constants caught", all - left);
    }
    let (all, left) = (mutants.len(), survivors.len());
    println!("in all: {} of {all} constants caught", all - left);
    assert!(all > 0, "there is nothing to change");
    let least = if chosen.is_some() { CAUGHT } else { CAUGHT_OF_FEW };
    assert!(100 * (all - left) >= least * all, "{left} of {all} changes go unnoticed");
}

#[test]
fn numbers_are_found_where_they_are_constants() {
    let text = "@binding(1) var a: vec2<u32>; // 3\nlet b1 = 0x1fu + 7; c[63u] @workgroup_size(64)";
    let found: Vec<_> = numbers(text).into_iter().map(|range| &text[range]).collect();
    assert_eq!(found, ["0x1fu", "7", "63u"]);
    assert_eq!(["0x1fu", "7", "63u", "0xffffffffu"].map(one_more), ["0x20u", "8", "64u", "0x0u"]);
}
