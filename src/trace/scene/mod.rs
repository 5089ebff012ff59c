//! Scenes: options in, the text of a trace out. Every scene is deterministic, to the byte and on
//! every machine: its numbers come from arithmetic and square roots, which IEEE 754 rounds exactly,
//! never from a sine.

pub mod camera;
mod crowd;
pub mod elephant;
pub mod elephants;
pub mod grid;
pub mod mesh;
pub mod model;
pub mod motion;
pub mod newell;
pub mod primitives;
pub mod rational;
mod round;
pub mod teacups;
