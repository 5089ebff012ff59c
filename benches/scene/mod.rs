//! What the benches draw.

use rtl_model::level;
use rtl_model::patch::Level;
use std::io::BufReader;
use tessim::trace::command::{Command, Tessellation};
use tessim::trace::read::Reader;
use tessim::trace::scene::teacups::Teacups;

/// Four frames of a hundred teacups at fixed level 16.
pub(crate) fn teacups() -> Vec<Command> {
    let fixed = level::Criterion::Fixed { level: Level::clamped(16 << 16) };
    let tessellation = Tessellation { criterion: fixed, min_level: 1 << 16, max_level: 64 << 16 };
    let scene = Teacups { count: 100, frames: 4, tessellation };
    let mut text = Vec::new();
    scene.write(&mut text).expect("a vector takes it all");
    let reader = Reader::new(BufReader::new(&text[..]), "teacups", ".");
    reader.map(|located| located.expect("a scene is well-formed").command).collect()
}
