//! The rules of the house, as tests: what DESIGN and STYLE ask of every file, checked in every
//! file.
//!
//! Each rule is a function from a file's path and text to what is wrong with it. `planted.rs` shows
//! each rule a violation, so that a rule that has gone blind fails too.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[path = "tidy/arrows.rs"]
mod arrows;
#[path = "tidy/lexer.rs"]
mod lexer;
#[path = "tidy/planted.rs"]
mod planted;
#[path = "tidy/rules.rs"]
mod rules;

use std::path::{Path, PathBuf};
use std::process::Command;

/// Files, and folders whose Rust files keep the rules.
const WALKED: [&str; 6] =
    ["src", "rtl_model/src", "rtl_model/tests", "rtl_model/build.rs", "tests", "benches"];

/// Blocks without a golden file, each with its reason.
const NO_GOLDEN: &[(&str, &str)] =
    &[("strip", "an order of golden::stitch's triangles, which that definition leaves open")];

/// Modules of `rtl_model` that are no blocks: they compute nothing that could be compared.
const NO_BLOCKS: [&str; 4] = ["number", "counter", "patch", "time"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file under the walked folders: its path from the root, with `/`, and its text.
fn rust_files() -> Vec<(String, String)> {
    files_of("rs")
}

fn files_of(kind: &str) -> Vec<(String, String)> {
    let mut files = Vec::new();
    for path in WALKED.map(|path| root().join(path)) {
        if path.exists() {
            collect(&path, kind, &mut files);
        }
    }
    files.sort();
    files
}

fn collect(path: &Path, kind: &str, files: &mut Vec<(String, String)>) {
    if path.is_dir() {
        for entry in std::fs::read_dir(path).unwrap() {
            let path: PathBuf = entry.unwrap().path();
            if path.join("Cargo.toml").exists() || path.ends_with("target") {
                continue; // a workspace of its own, such as tests/fuzz
            }
            collect(&path, kind, files);
        }
    } else if path.extension().is_some_and(|e| e == kind) {
        let name = path.strip_prefix(root()).unwrap().to_str().unwrap().replace('\\', "/");
        files.push((name, std::fs::read_to_string(path).unwrap()));
    }
}

fn report(problems: &[String]) {
    assert!(problems.is_empty(), "{} problems:\n{}", problems.len(), problems.join("\n"));
}

#[test]
fn every_file_keeps_the_rules() {
    let files = rust_files();
    assert!(files.len() > 20, "only {} files found", files.len());
    let problems: Vec<String> =
        files.iter().flat_map(|(path, text)| rules::problems(path, text)).collect();
    report(&problems);
}

#[test]
fn imports_follow_the_arrows() {
    let order = arrows::module_order(&text_of("rtl_model/src/lib.rs"));
    assert!(order.len() > 5, "{order:?}");
    let mut imports = 0;
    let mut problems = Vec::new();
    for (path, text) in rust_files() {
        let (seen, wrong) = arrows::problems(&path, &text, &order);
        imports += seen;
        problems.extend(wrong);
    }
    assert!(imports > 50, "only {imports} imports were looked at");
    report(&problems);
}

#[test]
fn engines_share_their_declarations_and_nothing_else() {
    let (mut engines, mut problems) = (Vec::new(), Vec::new());
    for (path, text) in rust_files() {
        let Some((engine, wrong)) = arrows::engine(&path, &text) else { continue };
        engines.push(engine);
        problems.extend(wrong);
    }
    engines.dedup(); // an engine may have a folder
    assert_eq!(engines, ["ordered", "stepped", "timed"], "every engine was looked at");
    report(&problems);
}

#[test]
fn every_block_has_its_golden_definition_or_a_reason() {
    let order = arrows::module_order(&text_of("rtl_model/src/lib.rs"));
    let blocks: Vec<_> = order.iter().filter(|m| !NO_BLOCKS.contains(&m.as_str())).collect();
    let mut problems = Vec::new();
    for block in &blocks {
        let golden = root().join(format!("src/golden/{block}.rs")).is_file();
        let excused = NO_GOLDEN.iter().any(|(stem, _)| stem == block);
        if golden == excused {
            problems.push(format!("{block}: golden file {golden}, exemption {excused}"));
        }
    }
    for (stem, reason) in NO_GOLDEN {
        if !blocks.iter().any(|block| block == stem) || reason.is_empty() {
            problems.push(format!("{stem}: an exemption for no block, or without a reason"));
        }
    }
    report(&problems);
}

#[test]
fn kernels_have_integers_only_and_keep_the_rules() {
    let files = files_of("wgsl");
    assert!(files.len() > 10, "only {} kernels found", files.len());
    let problems: Vec<String> =
        files.iter().flat_map(|(path, text)| rules::kernel_problems(path, text)).collect();
    report(&problems);
}

#[test]
fn no_tracked_file_names_a_path_of_a_machine() {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let Some(listed) = listed.ok().filter(|output| output.status.success()) else {
        println!("SKIPPED no_tracked_file_names_a_path_of_a_machine: no git checkout");
        return;
    };
    let names = String::from_utf8(listed.stdout).unwrap();
    let mut problems = Vec::new();
    for name in names.split('\0').filter(|name| !name.is_empty()) {
        // Binary files hold no paths that a person wrote.
        if let Ok(text) = std::fs::read_to_string(root().join(name)) {
            problems.extend(rules::machine_paths(name, &text));
        }
    }
    report(&problems);
}

fn text_of(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}
