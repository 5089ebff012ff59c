//! The fuzz targets' corpus, run once, without a fuzzer.

#[path = "fuzz/checks.rs"]
mod checks;

use std::path::Path;

/// Runs a target over its corpus: it must accept some of it and refuse some.
fn run(target: &str, check: fn(&[u8]) -> bool) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(target);
    let mut counts = [0; 2];
    for entry in std::fs::read_dir(folder).expect("the corpus is there") {
        let path = entry.expect("the corpus can be listed").path();
        println!("{}", path.display());
        let bytes = std::fs::read(&path).expect("the corpus can be read");
        counts[usize::from(check(&bytes))] += 1;
    }
    assert!(counts.iter().all(|n| *n >= 3), "refused and accepted: {counts:?}");
}

#[test]
fn read_text() {
    run("read_text", checks::read_text);
}

#[test]
fn read_binary() {
    run("read_binary", checks::read_binary);
}

#[test]
fn import_bpt() {
    run("import_bpt", checks::import_bpt);
}

/// The binary form of a text trace.
fn blocks(text: &[u8]) -> Vec<u8> {
    let mut writer = tessim::trace::binary::write::Writer::new(Vec::new()).expect("a compressor");
    for located in tessim::trace::read::Reader::new(text, "t", ".") {
        let command = located.expect("a shipped trace").command;
        writer.write(&command).expect("memory takes all");
    }
    writer.into_inner()
}

/// The shipped traces hold to the same.
#[test]
fn shipped_traces() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("traces");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("the traces are there") {
        let path = entry.expect("the traces can be listed").path();
        if path.extension().is_some_and(|e| e == "jsonl") {
            let bytes = std::fs::read(&path).expect("a trace can be read");
            assert!(checks::read_text(&bytes), "{}", path.display());
            assert!(checks::read_binary(&blocks(&bytes)), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 5, "{count}");
}
