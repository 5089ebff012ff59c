//! The second implementation against the first: every kernel on random inputs of every width.
//!
//! `TESSIM_LONG=1` draws ten times as many samples; `TESSIM_KERNELS=src/gpu` takes the kernels from
//! that folder, so that a change needs no build.

#![cfg_attr(not(feature = "gpu"), allow(dead_code, unused_imports, reason = "nothing to compare"))]

#[cfg(feature = "gpu")]
mod clip;
#[cfg(feature = "gpu")]
mod esc;
#[cfg(feature = "gpu")]
mod number;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
#[cfg(feature = "gpu")]
mod support;

#[cfg(not(feature = "gpu"))]
#[test]
fn the_second_implementation() {
    println!("SKIPPED the second implementation: built without the feature gpu");
}
