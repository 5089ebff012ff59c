//! The second implementation against the first: every kernel on random inputs of every width.
//!
//! `TESSIM_LONG=1` draws ten times as many samples; `TESSIM_KERNELS=src/gpu` takes the kernels from
//! that folder, so that a change needs no build; `TESSIM_BACKEND=gl` takes that interface.
//!
//! Without the feature `gpu` nothing is here; tests/agreement says that it is skipped.

#![cfg(feature = "gpu")]
#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

mod backface;
mod batch;
mod clip;
mod d3d11;
mod d3d11_count;
mod d3d11_unit;
mod emit;
mod esc;
mod evaluate;
mod level;
mod mutants;
mod number;
mod place;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
mod records;
mod scan;
mod single;
mod stitch;
mod support;
mod surface;
#[allow(dead_code, reason = "tests/agreement uses the rest")]
#[path = "../agreement/table.rs"]
mod table;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/walk.rs"]
mod walk;
