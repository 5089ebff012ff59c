//! `cargo +nightly fuzz run read_text`, at the root of the repository, with `--fuzz-dir tests/fuzz`.
#![no_main]

#[allow(dead_code)]
#[path = "../checks.rs"]
mod checks;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    checks::read_text(bytes);
});
