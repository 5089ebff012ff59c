//! Pictures: against those that are kept in `tests/render`, against numbers computed here, and
//! drawn in tiles against drawn at once.
//!
//! `UPDATE_EXPECT=1` keeps the pictures that are drawn now.

#![cfg_attr(not(feature = "gpu"), allow(dead_code, unused_imports, reason = "nothing is drawn"))]
#![cfg_attr(feature = "gpu", expect(clippy::unwrap_used, reason = "all of it is test code"))]

#[cfg(feature = "gpu")]
#[path = "render/command.rs"]
mod command;
#[cfg(feature = "gpu")]
#[path = "render/kept.rs"]
mod kept;
#[cfg(feature = "gpu")]
#[path = "render/support.rs"]
mod support;
#[cfg(feature = "gpu")]
#[path = "render/tiles.rs"]
mod tiles;
#[cfg(feature = "gpu")]
#[path = "render/values.rs"]
mod values;

#[cfg(not(feature = "gpu"))]
#[test]
fn pictures() {
    println!("SKIPPED pictures: built without the feature gpu");
}
