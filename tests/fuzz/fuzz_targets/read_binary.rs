//! `cargo +nightly fuzz run --fuzz-dir tests/fuzz read_binary`, at the root of the repository.
#![no_main]

#[allow(dead_code)]
#[path = "../checks.rs"]
mod checks;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    checks::read_binary(bytes);
});
