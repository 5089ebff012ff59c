//! Stitch: strips in, the triangles of each out, one at a time (Moreton 2001, section 5.1).
//!
//! The walk is the strip's own, [`Strip::triangles`]; here is what the block keeps and what it
//! costs. Its twin is `sv/stitch.sv`, which is compared with it cycle by cycle.
//!
//! [`Strip::triangles`]: crate::strip::Strip::triangles

mod degenerate;
mod schedule;

use crate::patch::Triangle;
use crate::place::Placement;
use crate::strip::{Segments, strips};

pub use degenerate::Degenerate;
pub use schedule::Schedule;

/// The block, which keeps the triangles of its last patch: the next one has the same where its
/// lists have as many segments, for topology depends on nothing else.
#[derive(Clone, Debug, Default)]
pub struct Stitch {
    segments: Option<Segments>,
    triangles: Vec<Triangle>,
}

impl Stitch {
    /// Stitches a patch.
    pub fn accept(&mut self, placement: &Placement) -> &[Triangle] {
        let segments = placement.segments();
        if self.segments != Some(segments) {
            self.segments = Some(segments);
            self.triangles.clear();
            accept(placement, &mut self.triangles);
        }
        &self.triangles
    }

    /// The triangles of the last patch.
    #[must_use]
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }
}

/// Appends the triangles of a patch to `out`: the interior grid's, then side by side.
pub fn accept(placement: &Placement, out: &mut Vec<Triangle>) {
    let segments = placement.segments();
    let start = out.len();
    out.resize(start + segments.triangles(), [0; 3]);
    let mut out = &mut out[start..];
    for strip in strips(segments) {
        let (now, later) = std::mem::take(&mut out).split_at_mut(strip.count() as usize);
        strip.fill(now);
        out = later;
    }
}
