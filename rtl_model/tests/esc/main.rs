//! The mesh of a coarse triangle: the paper's examples, vectors, and what every mesh promises.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[expect(dead_code, reason = "other tests use the rest")]
#[path = "../../../tests/support/random.rs"]
mod random;

mod counts;
mod disc;
mod examples;
mod mesh;
mod pattern;
mod seams;
mod shader;
mod support;
mod vectors;
