//! The second implementation against the first: every kernel on random inputs of every width.
//!
//! `TESSIM_LONG=1` draws ten times as many samples; `TESSIM_KERNELS=src/gpu` takes the kernels from
//! that folder, so that a change needs no build; `TESSIM_BACKEND=gl` takes that interface.

#![cfg_attr(
    feature = "gpu",
    expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")
)]
#![cfg_attr(not(feature = "gpu"), allow(dead_code, unused_imports, reason = "nothing to compare"))]

#[cfg(feature = "gpu")]
mod backface;
#[cfg(feature = "gpu")]
mod batch;
#[cfg(feature = "gpu")]
mod clip;
#[cfg(feature = "gpu")]
mod d3d11;
#[cfg(feature = "gpu")]
mod d3d11_unit;
#[cfg(feature = "gpu")]
mod emit;
#[cfg(feature = "gpu")]
mod esc;
#[cfg(feature = "gpu")]
mod evaluate;
#[cfg(feature = "gpu")]
mod level;
#[cfg(feature = "gpu")]
mod mutants;
#[cfg(feature = "gpu")]
mod number;
#[cfg(feature = "gpu")]
mod place;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
#[cfg(feature = "gpu")]
mod records;
#[cfg(feature = "gpu")]
mod scan;
#[cfg(feature = "gpu")]
mod single;
#[cfg(feature = "gpu")]
mod stitch;
#[cfg(feature = "gpu")]
mod support;
#[cfg(feature = "gpu")]
mod surface;
#[cfg(feature = "gpu")]
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/walk.rs"]
mod walk;

#[cfg(not(feature = "gpu"))]
#[test]
fn the_second_implementation() {
    println!("SKIPPED the second implementation: built without the feature gpu");
}
