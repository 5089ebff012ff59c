//! What the hull and domain shaders promise of edges: the same vertices and the same factors in
//! every patch that has them, whichever side they are on and from whichever end they are walked;
//! and where a form does not promise it, cracks, every one of which is counted. And the level that
//! the driver gives a whole object.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

mod domain;
mod hull;
mod object_level;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
mod sides;
