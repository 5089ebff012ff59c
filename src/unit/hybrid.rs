//! `hybrid`: Sfarti's place in the pipeline and his culling, Moreton's fractional levels, forward
//! differencing and stitcher.
//!
//! ```text
//!   patch ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit ─► vertex shader
//! ```

use super::chain;
use super::pipeline::{Placed, Placing};
use super::surface::Front;
use crate::config::Config;
use rtl_model::level;
use rtl_model::place::{List, Placement, Segments};

/// What the hybrid has of its own.
pub(super) struct Hybrid;

impl Front for Hybrid {
    type Lists = Segments;
    type List = List;
    const CULLS: bool = true;

    fn placement(config: &Config) -> Placement {
        Placement::of_reciprocal(config.place.reciprocal_bits)
    }

    fn place(work: Placing<'_>, placement: &mut Placement) -> Placed<Segments> {
        let (levels, events) = level::accept(work.input.seen, work.input.view, work.input.state);
        placement.set(&levels);
        Placed {
            lists: placement.segments(),
            events,
            criterion: work.input.state.criterion,
            levels: chain::levels(work.input.state.criterion),
            reciprocals: placement.reciprocals() as u8, // at most 6
        }
    }
}
