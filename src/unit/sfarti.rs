//! `sfarti`: the tessellator unit of Sfarti et al. 2005, between transform and lighting. Eight
//! curves of a patch are divided at their midpoints until they are flat; points come from de
//! Casteljau, and a zipper joins each edge to the first interior row.
//!
//! ```text
//!   patch ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit ─► vertex shader
//!                                divides  lists    de Casteljau zipper
//! ```

use super::chain;
use super::pipeline::{Front, Placed, Placing};
use rtl_model::level::{self, Criterion, Termination};
use rtl_model::patch::Lists;
use rtl_model::place::{DyadicList, DyadicPlacement};

/// What this unit has of its own.
pub(super) struct Sfarti;

/// Curves that are divided: four of the boundary, four of the net's inside.
const CURVES: u32 = 8;

impl Front for Sfarti {
    type Lists = Lists;
    type List = DyadicList;
    const CULLS: bool = true;

    fn place(work: Placing<'_>, placement: &mut DyadicPlacement) -> Placed<Lists> {
        let Placing { config, view, patch, state } = work;
        let termination = config.level.termination;
        let (lists, events) = level::subdivide(patch, view, state, termination);
        placement.set_lists(&lists);
        let levels = match (state.criterion, termination) {
            // Every piece is looked at once: those of the curves, and two of each division.
            (Criterion::Flatness { .. }, Termination::EightCurves) => {
                (CURVES + 2 * events.splits) as u16 // at most 8 x 255
            }
            (criterion, _) => chain::levels(criterion),
        };
        Placed { lists, events, levels, reciprocals: 0 }
    }
}
