//! Tokens: how many each block of the timed chain accepts and emits, from the counters of a frame.
//!
//! No engine is needed to know them, and an engine that ran is held against them. What one block
//! emits the next accepts:
//!
//! ```text
//!   link ─ parcels, patches ─► memory ─ points ─► transform ─ points ─► port ─ points ─►
//!   assemble ─ patches ─► clip, backface, level, place ─ patches ─► evaluate ─ strips ─►
//!   stitch ─ triangles ─► emit ─ vertices ─► vertex shader
//! ```

use crate::config::{Config, Unit};
use rtl_model::counter::{Block, Counter as C, Counters};

/// Tokens that `block` accepts and emits in a frame with these counters, in which the host sent so
/// many.
pub(super) fn of(config: &Config, block: Block, counters: &Counters, sent: u64) -> [u64; 2] {
    let get = |counter| counters.get(counter);
    match config.unit {
        Unit::Hybrid | Unit::Sfarti | Unit::Moreton => patches(block, get, sent),
        Unit::Triangles => triangles(config, block, get, sent),
        Unit::D3d11 => shaders(block, get, sent),
        Unit::Esc => surfaces(block, get, sent),
    }
}

fn patches(block: Block, get: impl Fn(C) -> u64, sent: u64) -> [u64; 2] {
    // Patches without a control point of their own are tokens on their way to assemble.
    let whole = get(C::AssembleWhole);
    let clipped = get(C::ClipIn) - get(C::ClipCulled);
    // Patches that are measured pass place's door again before they leave it.
    let placed = get(C::LevelPatches) + get(C::PlaceMeasured);
    match block {
        Block::Link => [sent; 2],
        Block::Memory => [sent, get(C::PortPoints) + whole],
        Block::Transform => [get(C::TransformInvocations) + whole; 2],
        Block::Port => [get(C::PortPoints) + whole; 2],
        Block::Assemble => [get(C::AssembleReceived) + whole, get(C::AssemblePatches)],
        Block::Clip => [get(C::ClipIn), clipped],
        Block::Backface => [get(C::BackfaceIn), get(C::BackfaceIn) - get(C::BackfaceCulled)],
        Block::Level => [placed; 2],
        Block::Place => [placed, get(C::LevelPatches)],
        Block::Evaluate => [get(C::LevelPatches), get(C::EvaluateStrips)],
        Block::Stitch => [get(C::EvaluateStrips), get(C::StitchTriangles)],
        Block::Emit => [get(C::StitchTriangles), get(C::EmitVertices)],
        Block::VertexShader => [get(C::VertexShaderInvocations); 2],
        _ => [0; 2], // not of the chain
    }
}

/// Unit `d3d11`: patches to connect, waves of points from there on.
fn shaders(block: Block, get: impl Fn(C) -> u64, sent: u64) -> [u64; 2] {
    let points = get(C::AssembleReceived) + get(C::AssembleWhole);
    let (all, kept, waves) = (get(C::HullInvocations), get(C::LevelPatches), get(C::DomainWaves));
    match block {
        Block::Link => [sent; 2],
        Block::Memory => [sent, points],
        Block::Assemble => [points, all],
        Block::Hull => [all; 2],
        Block::Factors => [all, kept],
        Block::Points => [kept; 2],
        Block::Connect => [kept, waves],
        Block::Domain | Block::Emit => [waves; 2],
        _ => [0; 2], // not of the chain
    }
}

/// Unit `esc`: patches until waves are formed, waves from there on.
fn surfaces(block: Block, get: impl Fn(C) -> u64, sent: u64) -> [u64; 2] {
    let waves = get(C::GroupWaves);
    match block {
        Block::Group => [get(C::LevelPatches), waves],
        Block::Surface | Block::Emit => [waves; 2],
        _ => patches(block, get, sent),
    }
}

/// Where the host tessellates: a token a vertex from the link on, or from memory on.
fn triangles(config: &Config, block: Block, get: impl Fn(C) -> u64, sent: u64) -> [u64; 2] {
    let vertices = get(C::VertexShaderInvocations);
    match block {
        Block::Link if config.triangles.uses_memory() => [sent; 2],
        Block::Link => [sent, vertices],
        Block::Memory => [sent, vertices],
        Block::VertexShader => [vertices; 2],
        _ => [0; 2], // not of the chain
    }
}
