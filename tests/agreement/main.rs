//! The hardware's blocks against their golden models: one comparison, over all blocks, under one
//! table of error budgets (`table.rs`), on random inputs and on the shipped traces.
//!
//! `TESSIM_LONG=1 cargo test --test agreement` draws twenty times as many samples.

mod blocks;
mod dyadic;
mod insertions;
#[cfg_attr(not(feature = "gpu"), path = "no_kernels.rs")]
mod kernels;
mod ledger;
mod levels;
mod patterns;
mod planes;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
mod resolutions;
mod samples;
mod shaders;
mod surfaces;
mod table;
#[allow(dead_code, reason = "tests/accuracy.rs reads what is left over here")]
#[path = "../support/walk.rs"]
mod walk;

use ledger::Ledger;
use std::collections::BTreeSet;
use std::path::Path;
use table::{KERNELS, RANDOM, TABLE};

/// Files of `rtl_model/src` that are no blocks, each with its reason.
const NO_BLOCKS: [(&str, &str); 5] = [
    ("lib", "the list of modules"),
    ("counter", "declarations; nothing is computed"),
    ("patch", "tokens; nothing is computed"),
    ("strip", "tokens; their triangles are stitch's"),
    ("time", "declarations; nothing is computed"),
];

/// Blocks without kernels, each with its reason.
const NO_KERNELS: [(&str, &str); 3] = [
    ("port", "the second implementation begins with what it gives"),
    ("assemble", "stands before the port's results are taken"),
    ("attribute", "what it interpolates arrives with the corners, not through the port"),
];

#[test]
fn every_block_agrees_with_its_definition() {
    let long = std::env::var_os("TESSIM_LONG").is_some();
    let mut ledger = Ledger::new();
    samples::random(&mut ledger, if long { 20 } else { 1 });
    for name in walk::SHIPPED {
        samples::trace(&mut ledger, name);
    }
    let kernels = kernels::traces(&mut ledger);
    let wrong = ledger.settle(kernels);
    assert!(wrong.is_empty(), "{} rows fail:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_block_has_a_golden_file_and_a_row() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let stems = |folder: &str| -> BTreeSet<String> {
        let files = std::fs::read_dir(root.join(folder)).unwrap().map(|e| e.unwrap().path());
        let rust = files.filter(|path| path.extension().is_some_and(|e| e == "rs"));
        rust.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
    };
    let hardware = stems("rtl_model/src");
    for (stem, reason) in NO_BLOCKS {
        assert!(hardware.contains(stem) && !reason.is_empty(), "{stem}: an idle exemption");
    }
    let exempt = |stem: &str| NO_BLOCKS.iter().any(|(name, _)| *name == stem);
    let golden = stems("src/golden");
    let blocks: Vec<&String> = hardware.iter().filter(|stem| !exempt(stem)).collect();
    for block in &blocks {
        assert!(golden.contains(*block), "{block}: no src/golden/{block}.rs");
        assert!(TABLE.iter().any(|row| row.block == *block), "{block}: no row in the table");
        let has = |what| TABLE.iter().any(|row| row.block == *block && row.what == what);
        let kernels = has(KERNELS) && has(RANDOM);
        let excused = NO_KERNELS.iter().any(|(stem, _)| stem == block);
        let file = root.join(format!("src/gpu/{block}.wgsl")).is_file();
        assert!(kernels != excused, "{block}: row {kernels}, exemption {excused}");
        assert!(file != excused, "{block}: kernels {file}, exemption {excused}");
    }
    println!("compared {} blocks", blocks.len());
    assert!(blocks.len() >= 9);
}

#[test]
fn every_row_of_random_inputs_is_settled_in_its_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gpu");
    let folders = [root.clone(), root.join("esc")];
    let files = folders.iter().flat_map(|f| f.read_dir().unwrap()).map(|e| e.unwrap().path());
    let rust = files.filter(|path| path.extension().is_some_and(|e| e == "rs"));
    let text: String = rust.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    for row in TABLE.iter().filter(|row| row.what == RANDOM) {
        let settled = text.contains(&format!("settle(&ledger, Quantity::{:?})", row.quantity));
        assert!(settled, "{:?}: no test settles it", row.quantity);
    }
}

#[test]
fn the_table_is_in_order_and_every_row_has_its_reason() {
    for (index, row) in TABLE.iter().enumerate() {
        assert_eq!(row.quantity as usize, index, "{}: {}", row.block, row.what);
        assert!(!row.reason.is_empty() && row.floor > 0, "{}: {}", row.block, row.what);
    }
}
