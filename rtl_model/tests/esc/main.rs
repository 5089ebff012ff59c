//! The mesh of a coarse triangle: the paper's examples, vectors, and what every mesh promises.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[expect(dead_code, reason = "other tests use the rest")]
#[path = "../../../tests/support/random.rs"]
mod random;

mod examples;
mod mesh;
mod support;
mod vectors;
