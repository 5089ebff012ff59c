//! Whether the comparisons would notice a wrong constant: each number in each kernel is made one
//! larger, one at a time, and the comparisons that go through the kernel are run again by another
//! process. Where they notice nothing, one smaller: a loop that makes one more turn may do nothing
//! in it, while one turn less shows that its bound matters. Both are reported by themselves.
//!
//! By default one in 300; `TESSIM_MUTANTS=1` takes them all, `TESSIM_MUTANTS=7` every seventh,
//! `TESSIM_MUTANTS=stem` those of one file, `TESSIM_MUTANTS=stem:9` of its line. Survivors are
//! printed with their lines; docs/kernels.md explains those that are known.

use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tessim::gpu::Sources;

/// A comparison that takes longer hangs: a loop has lost its end.
const PATIENCE: Duration = Duration::from_secs(60);

/// Of a hundred, how many must be caught: of many constants, and of a few, which prove less.
const CAUGHT: usize = 95;
const CAUGHT_OF_FEW: usize = 80;

/// A constant that is changed.
struct Mutant {
    file: &'static str,
    line: usize,
    at: Range<usize>,
}

impl Mutant {
    fn was(&self) -> &'static str {
        &self.whole()[self.at.clone()]
    }

    fn whole(&self) -> &'static str {
        Sources::shipped(self.file).expect("a file that is listed")
    }

    fn text(&self, becomes: &str) -> String {
        let whole = self.whole();
        [&whole[..self.at.start], becomes, &whole[self.at.end..]].concat()
    }
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

/// So many more, in the same notation; `None`: below 0, where it is not said how many bits wrap.
fn moved(literal: &str, by: i64) -> Option<String> {
    let (digits, suffix) = match literal.strip_suffix(['u', 'i']) {
        Some(digits) => (digits, &literal[digits.len()..]),
        None => (literal, ""),
    };
    let (digits, radix) = digits.strip_prefix("0x").map_or((digits, 10), |hex| (hex, 16));
    let value = i64::from_str_radix(digits, radix).expect("a number") + by;
    if value < 0 && suffix != "u" {
        return None;
    }
    let value = value as u32;
    Some(if radix == 16 { format!("{value:#x}{suffix}") } else { format!("{value}{suffix}") })
}

/// All constants, of a file and line where such is named.
fn mutants(chosen: Option<&str>) -> Vec<Mutant> {
    let chosen = chosen.unwrap_or("300");
    let every = chosen.parse().ok();
    let (stem, of_line) = chosen.split_once(':').unwrap_or((chosen, ""));
    let of_line: Option<usize> = of_line.parse().ok();
    let all = Sources::files().flat_map(|file| {
        let text = Sources::shipped(file).expect("a file that is listed");
        let wanted = every.is_some() || file.trim_end_matches(".wgsl") == stem;
        let found = if wanted { numbers(text) } else { Vec::new() };
        found.into_iter().map(move |at| {
            let line = text[..=at.start].lines().count();
            Mutant { file, line, at }
        })
    });
    let every = every.unwrap_or(1);
    let all = all.filter(|mutant| of_line.is_none_or(|line| line == mutant.line));
    all.skip(every / 2).step_by(every).collect()
}

/// The comparisons that go through a kernel: first those that are the likeliest to notice, then,
/// where they do not, the others of its block and of the units that are made of it.
fn own(file: &str) -> [&'static [&'static str]; 2] {
    let block = file.split(['_', '.']).next().expect("a name");
    match (block, file) {
        ("number" | "operations", _) => [&["number::"], &["clip::", "surface::"]],
        ("settings" | "scan", _) => [&["clip::", "scan::"], &[""]],
        ("clip", _) => [&["clip::"], &["surface::"]],
        ("backface", _) => [&["backface::"], &["surface::"]],
        ("level", _) => [&["level::"], &["surface::"]],
        ("place" | "plan", _) => [&["place::"], &["evaluate::", "stitch::", "surface::"]],
        ("evaluate" | "normal", _) => [&["evaluate::"], &["surface::"]],
        ("stitch", _) => [&["stitch::"], &["surface::"]],
        ("owner" | "vertex", _) => [&["stitch::", "evaluate::"], &["d3d11"]],
        ("emit", _) => [&["emit::"], &["surface::"]],
        ("single", _) => [&["single::"], &["d3d11_unit::"]],
        (_, "d3d11_hull.wgsl" | "d3d11_domain.wgsl") => {
            [&["d3d11_unit::random"], &["d3d11_unit::"]]
        }
        (_, "d3d11_count.wgsl") => [&["d3d11_count::"], &["d3d11_unit::"]],
        ("d3d11", _) => [&["d3d11::"], &["d3d11_unit::"]],
        (_, "esc_level.wgsl") => [&["esc::corners::"], &["esc::surfaces_"]],
        ("esc", _) => [&["esc::surfaces_are_tess"], &["esc::corners::", "esc::surfaces_of"]],
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
            println!("no end after {PATIENCE:?}: {filters:?}");
            let _ = child.kill();
        }
        hangs | reader.join().expect("the reader does not panic")
    });
    let _ = child.kill();
    let status = child.wait().expect("it was started");
    failed || !(status.success() || status.code().is_none())
}

/// A folder of all kernels, one of them with another text.
fn folder(file: &str, text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in Sources::files() {
        let shipped = Sources::shipped(name).expect("it is listed");
        let text = if name == file { text } else { shipped };
        std::fs::write(folder.path().join(name), text).expect("room for kernels");
    }
    folder
}

/// Whether a constant's being something else is noticed.
fn caught(mutant: &Mutant, becomes: &str) -> bool {
    let folder = folder(mutant.file, &mutant.text(becomes));
    own(mutant.file).into_iter().any(|filters| fails(folder.path(), filters))
}

/// Whether it is noticed that a constant is one larger, and that it is larger or smaller.
fn tried(mutant: &Mutant) -> [bool; 2] {
    let noticed = |by: i64| {
        let becomes = moved(mutant.was(), by);
        let noticed = becomes.as_deref().is_some_and(|becomes| caught(mutant, becomes));
        if !noticed {
            let (Mutant { file, line, .. }, was) = (mutant, mutant.was());
            println!("survives: {file}:{line}: {was} as {}", becomes.as_deref().unwrap_or("-1"));
        }
        noticed
    };
    let larger = noticed(1);
    [larger, larger || noticed(-1)]
}

#[test]
fn a_changed_constant_is_noticed() {
    let running = std::env::var_os("TESSIM_KERNELS").is_some();
    if running || crate::support::device().is_none() {
        return;
    }
    let chosen = std::env::var("TESSIM_MUTANTS").ok();
    let mutants = mutants(chosen.as_deref());
    // Or every change would pass for noticed.
    assert!(!fails(folder("", "").path(), &[""]), "the kernels fail as they are");
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(mutant) = mutants.get(next.fetch_add(1, Ordering::Relaxed)) {
            let noticed = tried(mutant);
            results.lock().unwrap().push((mutant.file, noticed));
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let results = results.into_inner().unwrap();
    for file in Sources::files() {
        println!("{file}: {}", counts(results.iter().filter(|(name, _)| *name == file)).0);
    }
    let (line, [all, _, either]) = counts(results.iter());
    println!("in all: {line}");
    assert!(all > 0, "there is nothing to change");
    let least = if chosen.is_some() { CAUGHT } else { CAUGHT_OF_FEW };
    assert!(100 * either >= least * all, "{line}");
}

/// A line of how many constants were changed, how many of the larger ones were noticed, and how
/// many either way; and the three numbers.
fn counts<'a>(
    results: impl Iterator<Item = &'a (&'static str, [bool; 2])>,
) -> (String, [usize; 3]) {
    let [mut all, mut larger, mut either] = [0; 3];
    for (_, noticed) in results {
        all += 1;
        larger += usize::from(noticed[0]);
        either += usize::from(noticed[1]);
    }
    let line = format!("of {all} constants {larger} caught one larger, {either} larger or smaller");
    (line, [all, larger, either])
}

#[test]
fn numbers_are_found_where_they_are_constants() {
    let text = "@binding(1) var a: vec2<u32>; // 3\nlet b1 = 0x1fu + 7; c[63u] @workgroup_size(64)";
    let found: Vec<_> = numbers(text).into_iter().map(|range| &text[range]).collect();
    assert_eq!(found, ["0x1fu", "7", "63u"]);
    let larger = ["0x1fu", "7", "63u", "0xffffffffu"].map(|literal| moved(literal, 1).unwrap());
    assert_eq!(larger, ["0x20u", "8", "64u", "0x0u"]);
    assert_eq!(moved("0u", -1).unwrap(), "4294967295u");
    assert_eq!(moved("0", -1), None);
}
