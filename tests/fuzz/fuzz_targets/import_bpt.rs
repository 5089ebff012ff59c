//! `cargo +nightly fuzz run --fuzz-dir tests/fuzz import_bpt`, at the root of the repository.
#![no_main]

#[allow(dead_code)]
#[path = "../checks.rs"]
mod checks;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    checks::import_bpt(bytes);
});
