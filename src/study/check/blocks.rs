//! Block by block: the first implementation's blocks on the patches that arrived, beside what the
//! kernels decided on the way.

use super::item::{Item, net};
use super::ledger::Ledger;
use crate::config::{Config, Unit};
use crate::gpu::{LEVELS, LISTS, Made};
use crate::sink::{Arrived, FrameInfo};
use rtl_model::backface::{self, Verdict};
use rtl_model::clip;
use rtl_model::level::{self, Events};
use rtl_model::patch::Dyadic;

/// What becomes of a patch, as the kernels number it.
const CLIPPED: u32 = 0;
const CULLED: u32 = 1;
const KEPT: u32 = 2;

/// Compares fates and levels.
pub(super) fn compare(
    ledger: &mut Ledger,
    config: &Config,
    frame: &FrameInfo,
    items: &[Item],
    made: &Made,
) {
    for (k, Item { arrived, .. }) in items.iter().enumerate() {
        let place = || format!("frame {}, patch {}", frame.number, arrived.patch.id);
        let inputs = || net(&arrived.patch);
        let mut kept = true;
        if let Some(fate) = made.fates.chunks_exact(4).nth(k) {
            let (clipped, planes) = clipped(arrived, config, frame);
            let got = [u32::from(fate[0] == CLIPPED), fate[3]];
            ledger.compare(
                ("clip", "verdicts, outcodes"),
                &[clipped.into(), planes],
                &got,
                place,
                inputs,
            );
            if !clipped {
                let want = culled(arrived, config, frame);
                let got = [fate[0], fate[1], fate[2]];
                ledger.compare(("backface", "verdicts, facets"), &want, &got, place, inputs);
                kept = want[0] == KEPT;
            } else {
                kept = false;
            }
        }
        if kept && let Some((want, width)) = levels(arrived, config, frame) {
            let got = &made.levels[width * k..][..want.len()];
            let what = if width == LISTS { "lists, events" } else { "levels, events" };
            ledger.compare(("level", what), &want, got, place, inputs);
        }
    }
}

fn clipped(arrived: &Arrived, config: &Config, frame: &FrameInfo) -> (bool, u32) {
    let (patch, depth) = (&arrived.patch, frame.eye.depth);
    let planes = patch.points.iter().fold(0x3f, |all, &p| all & clip::outcode(p, depth));
    (config.clip.enabled && clip::outside(patch, depth), planes.into())
}

fn culled(arrived: &Arrived, config: &Config, frame: &FrameInfo) -> [u32; 3] {
    let (verdict, facets) = backface::accept(&arrived.patch, &frame.eye, config.backface.method);
    let fate = if verdict == Verdict::Culled { CULLED } else { KEPT };
    [fate, u32::from(verdict != Verdict::Untested), facets]
}

/// The level block's words, and how many a patch has; `None` in units that have another.
fn levels(arrived: &Arrived, config: &Config, frame: &FrameInfo) -> Option<(Vec<u32>, usize)> {
    let seen = arrived.seen.as_ref().unwrap_or(&arrived.patch);
    let (view, state) = (&frame.eye, &arrived.state);
    let events = |e: Events| [e.clamped, e.near, e.overflows, e.splits];
    match config.unit {
        Unit::Hybrid | Unit::Triangles | Unit::Moreton => {
            let (levels, e) = level::accept(seen, view, state);
            let all = levels.edges.into_iter().chain(levels.interior);
            Some((all.map(|level| level.fx16()).chain(events(e)).collect(), LEVELS))
        }
        Unit::Sfarti => {
            let (lists, e) = level::subdivide(seen, view, state, config.level.termination);
            let all = lists.edges().iter().copied().chain([lists.u(), lists.v()]);
            Some((all.flat_map(mask).chain(events(e)).collect(), LISTS))
        }
        Unit::D3d11 | Unit::Esc => None,
    }
}

fn mask(list: Dyadic) -> [u32; 4] {
    std::array::from_fn(|k| (list.mask() >> (32 * k)) as u32)
}
