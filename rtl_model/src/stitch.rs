//! Stitch: strips in, the triangles of each out, one at a time (Moreton 2001, section 5.1).
//!
//! The walk is the strip's own, [`Strip::triangles`]; here is what the block keeps and what it
//! costs. Its twin is `sv/stitch.sv`, which is compared with it cycle by cycle.
//!
//! [`Strip::triangles`]: crate::strip::Strip::triangles

mod degenerate;
mod schedule;

use crate::patch::Triangle;
use crate::strip::{Segments, Topology};

pub use degenerate::{Degenerate, degenerate};
pub use schedule::Schedule;

/// The block, which keeps the triangles of its last patch: the next one has the same where its
/// lists are alike (fractional ones: have as many segments), for topology depends on nothing else.
#[derive(Clone, Debug, Default)]
pub struct Stitch<T = Segments> {
    lists: Option<T>,
    triangles: Vec<Triangle>,
}

impl<T: Topology> Stitch<T> {
    /// Stitches a patch with these lists.
    pub fn accept(&mut self, lists: T) -> &[Triangle] {
        if self.lists != Some(lists) {
            self.lists = Some(lists);
            self.triangles.clear();
            accept(lists, &mut self.triangles);
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
pub fn accept(lists: impl Topology, out: &mut Vec<Triangle>) {
    let start = out.len();
    out.resize(start + lists.triangles(), [0; 3]);
    let mut out = &mut out[start..];
    for strip in lists.strips() {
        let (now, later) = std::mem::take(&mut out).split_at_mut(strip.count() as usize);
        strip.fill(now);
        out = later;
    }
}
