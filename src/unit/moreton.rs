//! `moreton`: the place of GeForce3's tessellator, before transform. The driver chooses the levels
//! of a patch's edges and sends them over the link; the unit tessellates in object space and culls
//! nothing; a vertex program transforms every vertex.
//!
//! ```text
//!   patch, four levels ─► place ─► evaluate ─► stitch ─► emit ─► vertex shader
//! ```
//!
//! Moreton 2001; GL_NV_evaluators has four levels a patch, floats. The driver's levels are those
//! that the level block of the other units computes, from the same quantised points, so that the
//! units differ in what they do and not in how fine they are asked to be. The interior's level
//! along an axis is the greater of the two edges across it: nothing else crosses the link.

use super::pipeline::{Placed, Placing};
use super::surface::Front;
use crate::config::Config;
use rtl_model::level;
use rtl_model::patch::Levels;
use rtl_model::place::{List, Placement, Segments};

/// What this unit has of its own.
pub(super) struct Moreton;

impl Front for Moreton {
    type Lists = Segments;
    type List = List;
    const CULLS: bool = false;

    fn placement(config: &Config) -> Placement {
        Placement::of_reciprocal(config.place.reciprocal_bits)
    }

    fn place(work: Placing<'_>, placement: &mut Placement) -> Placed<Segments> {
        let (levels, events) = level::accept(work.input.seen, work.input.view, work.input.state);
        let [v0, u1, v1, u0] = levels.edges;
        placement.set(&Levels { interior: [v0.max(v1), u1.max(u0)], ..levels });
        let reciprocals = placement.reciprocals() as u8; // at most 6
        let (lists, criterion) = (placement.segments(), work.input.state.criterion);
        Placed { lists, events, criterion, levels: 0, reciprocals }
    }
}
