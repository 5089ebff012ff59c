//! `sfarti`: the tessellator unit of Sfarti et al. 2005, between transform and lighting. Eight
//! curves of a patch are divided at their midpoints until they are flat; points come from de
//! Casteljau, and a zipper joins each edge to the first interior row.
//!
//! ```text
//!   patch ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit ─► vertex shader
//!                                divides  lists    de Casteljau zipper
//! ```
//!
//! Each edge has its own list, a function of its four points: neighbours agree, whatever draws
//! them. Under `level.union = "primitive"` the patches of a strip, fan or mesh share one list a
//! row and one a column instead (`union`), and there is nothing to zip.

use super::chain;
use super::pipeline::{Placed, Placing};
use super::surface::Front;
use super::union::Pass;
use rtl_model::level::{self, Criterion, Events, Termination};
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
        let Some(share) = work.input.share else {
            let placed = choose(&work);
            placement.set_lists(&placed.lists);
            return placed;
        };
        match share.shared.pass {
            Pass::Measure => {
                let placed = choose(&work);
                share.measure(&placed.lists);
                placed
            }
            Pass::Draw => {
                let lists = share.lists();
                placement.set_lists(&lists);
                let (events, criterion) = (Events::default(), work.input.state.criterion);
                Placed { lists, events, criterion, levels: 0, reciprocals: 0 }
            }
        }
    }
}

/// The lists that the patch asks for by itself.
fn choose(work: &Placing<'_>) -> Placed<Lists> {
    let &Placing { config, input } = work;
    let view = input.view;
    let state = input.state;
    let termination = config.level.termination;
    let (lists, events) = level::subdivide(input.seen, view, state, termination);
    let levels = match (state.criterion, termination) {
        // Every piece is looked at once: those of the curves, and two of each division.
        (Criterion::Flatness { .. }, Termination::EightCurves) => {
            (CURVES + 2 * events.splits) as u16 // at most 8 x 255
        }
        (criterion, _) => chain::levels(criterion),
    };
    Placed { lists, events, criterion: state.criterion, levels, reciprocals: 0 }
}
