//! Unit `triangles`: what a host that tessellates sends, keeps and has drawn, under every kind of
//! residency, index, topology and cache: laws that hold of all of them, counts by hand, levels of
//! detail beside what the other units ask for, and both engines.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[allow(dead_code, reason = "the engines' tests use the rest")]
#[path = "../engines/runs.rs"]
mod runs;

mod hand;
mod laws;
mod levels;

use runs::{run, set};
use tessim::config::Config;
use tessim::report::Report;

/// A configuration of the unit.
fn host(settings: &[&str]) -> Config {
    set(&[&["unit=triangles"], settings].concat())
}

/// A run of the unit, without time.
fn counted(text: &str, settings: &[&str]) -> Report {
    run(text, &host(&[&["engine=none"], settings].concat()))
}
