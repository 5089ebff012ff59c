//! The index stream of a patch: its triangles in, in the stitcher's order; the indices out that
//! name them, as a list or as strips.
//!
//! ```text
//!   strip        a b c d e     a b c, c b d, c d e, ..: every second one turned round
//!   turn         a b a c d     a vertex named again, where the next triangle lies on the other
//!                              side: a b a has no area, and what follows keeps its sense
//!   restart      .. e R f ..   the greatest index ends a strip
//!   join         .. e e f f .. triangles without area lead from a strip to the next, of which at
//!                              an odd place the first triangle is named the other way round
//! ```
//!
//! Which order serves the cache or makes strips long says meshoptimizer (its port to Rust); both
//! kinds of strips are of the same order, and turn. They differ in what stands between strips, and
//! so do patches: a restart, or a join of two indices. Lists need nothing between. No library is
//! trusted with the triangles: tests decode what it made.

use crate::config::{IndexWidth, MeshTopology};
use meshopt_rs::stripify::{stripify, stripify_bound};
use meshopt_rs::vertex::cache::{optimize_vertex_cache, optimize_vertex_cache_strip};
use rtl_model::patch::Triangle;

/// The index that ends a strip. A patch has at most 129 x 129 vertices.
pub const RESTART: u16 = u16::MAX;

/// The indices of a patch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IndexStream {
    /// Vertices of the patch, and [`RESTART`].
    pub indices: Vec<u16>,
    /// Strips; those that are joined are one.
    pub strips: u64,
    /// Indices that begin no triangle with an area: turns, joins, and a last index named twice.
    pub repeated: u64,
    /// Restart indices.
    pub restarts: u64,
}

impl IndexStream {
    /// Replaces what it holds by the indices of a patch of so many vertices.
    pub fn form(&mut self, triangles: &[Triangle], vertices: usize, topology: MeshTopology) {
        self.indices.clear();
        (self.strips, self.repeated, self.restarts) = (0, 0, 0);
        match topology {
            MeshTopology::List => self.indices.extend(triangles.as_flattened()),
            MeshTopology::Optimised => {
                let mut better = vec![0; 3 * triangles.len()];
                optimize_vertex_cache(&mut better, &wide(triangles), vertices);
                self.indices.extend(better.into_iter().map(narrow));
            }
            MeshTopology::StripRestart => self.form_strips(triangles, vertices, u32::MAX),
            MeshTopology::StripDegenerate => {
                self.form_strips(triangles, vertices, 0);
                self.end_even();
            }
        }
    }

    /// As strips with this restart index between them, or, where it is 0, joined.
    fn form_strips(&mut self, triangles: &[Triangle], vertices: usize, restart: u32) {
        if triangles.is_empty() {
            return;
        }
        let mut ordered = vec![0; 3 * triangles.len()];
        optimize_vertex_cache_strip(&mut ordered, &wide(triangles), vertices);
        let mut strips = vec![0; stripify_bound(ordered.len())];
        let count = stripify(&mut strips, &ordered, vertices, restart);
        self.indices.extend(strips[..count].iter().copied().map(narrow));
        self.restarts = self.indices.iter().filter(|&&index| index == RESTART).count() as u64;
        self.strips = self.restarts + 1;
        let named = triangles.len() as u64 + 2 * self.strips + self.restarts;
        self.repeated = count as u64 - named;
    }

    /// Names the last vertex again, where the next patch would begin at an odd place: its indices
    /// do not depend on where it stands.
    fn end_even(&mut self) {
        if self.indices.len() % 2 == 1 {
            self.indices.push(self.indices[self.indices.len() - 1]);
            self.repeated += 1;
        }
    }
}

/// Indices as the library has them.
fn wide(triangles: &[Triangle]) -> Vec<u32> {
    triangles.as_flattened().iter().map(|&index| index.into()).collect()
}

/// An index of a patch, or the restart index, of which the low half is all ones too.
fn narrow(index: u32) -> u16 {
    index as u16
}

/// What stands between the patches of a batch: indices, of which so many are restarts.
#[must_use]
pub fn between_patches(topology: MeshTopology) -> [u64; 2] {
    match topology {
        MeshTopology::List | MeshTopology::Optimised => [0, 0],
        MeshTopology::StripRestart => [1, 1],
        MeshTopology::StripDegenerate => [2, 0],
    }
}

/// Most vertices that 2-byte indices reach: one less where the greatest index ends a strip.
#[must_use]
pub fn short_reach(topology: MeshTopology) -> u64 {
    (1 << 16) - u64::from(topology == MeshTopology::StripRestart)
}

/// Bytes of an index of a mesh or draw of so many vertices.
#[must_use]
pub fn index_bytes(width: IndexWidth, topology: MeshTopology, vertices: u64) -> u64 {
    match width {
        IndexWidth::Uint16 => 2,
        IndexWidth::Uint32 => 4,
        IndexWidth::Auto if vertices <= short_reach(topology) => 2,
        IndexWidth::Auto => 4,
    }
}

/// Cuts patches, in their order, into batches that short indices reach. A patch is never cut, so
/// that no vertex is in two batches, and what a batch leaves unused is less than a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Batches {
    /// Batches so far.
    pub count: u64,
    /// Vertices of the last one.
    vertices: u64,
}

impl Batches {
    /// The next patch, of so many vertices. Returns whether it begins a batch.
    pub fn patch(&mut self, vertices: u64, width: IndexWidth, topology: MeshTopology) -> bool {
        let full = self.vertices + vertices > short_reach(topology);
        let begins = self.count == 0 || (width == IndexWidth::Uint16 && full);
        self.count += u64::from(begins);
        self.vertices = if begins { vertices } else { self.vertices + vertices };
        begins
    }
}

#[cfg(test)]
mod tests;
