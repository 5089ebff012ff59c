//! The cache of shaded vertices between index fetch and vertex shader. In go the indices of a draw,
//! one after another; out comes for each whether its vertex must be shaded.
//!
//! GeForce3 has such a cache and holds 24 vertices first in, first out (Hoppe 1999, section 3, has
//! 16). With v(k) the k-th vertex that is named, it is a miss
//!
//! ```text
//!   unlimited   where v(k) was never named before
//!   fifo        where `entries` other vertices were shaded since v(k) was
//!   lru         where `entries` other vertices were named since v(k) was
//! ```
//!
//! Each takes a few steps for an index, whatever the entries: a table says where a vertex is held,
//! and a ring (fifo) or a list in the order of use (lru) says which one leaves. What an earlier
//! mesh left in a cache leaves it before all that came later, so a mesh of other vertices finds it
//! as good as empty: a patch's misses are its own, wherever it stands in a draw.

use crate::config::{CachePolicy, VertexCache};

/// A vertex that is not held.
const NOWHERE: u8 = u8::MAX;

/// The cache, at first empty.
#[derive(Clone, Debug)]
pub struct Cache {
    policy: CachePolicy,
    entries: u8,
    /// By vertex: the entry that holds it. Unlimited: 0 where it was named.
    held_in: Vec<u8>,
    /// By entry: the vertex that it holds.
    vertices: [u32; ENTRIES],
    /// Entries in use.
    used: u8,
    /// The entry whose vertex leaves next (fifo).
    oldest: u8,
    /// The entries in the order of use (lru), a ring through `HEAD`, whose `older` is the newest
    /// and whose `newer` the one whose vertex leaves next.
    newer: [u8; ENTRIES + 1],
    older: [u8; ENTRIES + 1],
    /// Vertices named so far, where nothing leaves.
    named: Vec<u32>,
}

const ENTRIES: usize = crate::config::triangles::CACHE_ENTRIES_MAX as usize;
const HEAD: usize = ENTRIES;

impl Cache {
    /// An empty cache.
    ///
    /// # Panics
    /// When it has no entries, or more than the configuration allows.
    #[must_use]
    pub fn new(settings: VertexCache) -> Self {
        let entries = settings.entries as usize;
        assert!((1..=ENTRIES).contains(&entries), "a cache of {entries} entries");
        Self {
            policy: settings.policy,
            entries: entries as u8,
            held_in: Vec::new(),
            vertices: [0; ENTRIES],
            used: 0,
            oldest: 0,
            newer: [HEAD as u8; ENTRIES + 1],
            older: [HEAD as u8; ENTRIES + 1],
            named: Vec::new(),
        }
    }

    /// Forgets all vertices.
    pub fn clear(&mut self) {
        for k in 0..usize::from(self.used) {
            self.held_in[self.vertices[k] as usize] = NOWHERE;
        }
        for vertex in self.named.drain(..) {
            self.held_in[vertex as usize] = NOWHERE;
        }
        (self.used, self.oldest) = (0, 0);
        (self.newer[HEAD], self.older[HEAD]) = (HEAD as u8, HEAD as u8);
    }

    /// The next index. Returns whether its vertex must be shaded: it is held from now on. The table
    /// grows with the greatest vertex.
    #[inline]
    pub fn misses(&mut self, vertex: u32) -> bool {
        let at = vertex as usize;
        if at >= self.held_in.len() {
            self.held_in.resize(at + 1, NOWHERE);
        }
        let entry = self.held_in[at];
        match self.policy {
            CachePolicy::Unlimited if entry == NOWHERE => {
                self.held_in[at] = 0;
                self.named.push(vertex);
            }
            CachePolicy::Fifo if entry == NOWHERE => {
                let entry = self.oldest;
                self.oldest = if entry + 1 == self.entries { 0 } else { entry + 1 };
                self.hold(entry, vertex);
            }
            CachePolicy::Lru if entry == NOWHERE => {
                let full = self.used == self.entries;
                let entry = if full { self.newer[HEAD] } else { self.used };
                if full {
                    self.unlink(entry);
                }
                self.hold(entry, vertex);
                self.link(entry);
            }
            CachePolicy::Lru if self.older[HEAD] != entry => {
                self.unlink(entry);
                self.link(entry);
            }
            _ => {}
        }
        entry == NOWHERE
    }

    /// Puts a vertex into an entry, in place of the one that it holds.
    #[inline]
    fn hold(&mut self, entry: u8, vertex: u32) {
        let k = usize::from(entry);
        if entry < self.used {
            self.held_in[self.vertices[k] as usize] = NOWHERE;
        } else {
            self.used = entry + 1;
        }
        self.vertices[k] = vertex;
        self.held_in[vertex as usize] = entry;
    }

    /// Makes an entry the newest: the head's older neighbour.
    #[inline]
    fn link(&mut self, entry: u8) {
        let k = usize::from(entry);
        let before = self.older[HEAD];
        (self.older[k], self.newer[k]) = (before, HEAD as u8);
        self.newer[usize::from(before)] = entry;
        self.older[HEAD] = entry;
    }

    #[inline]
    fn unlink(&mut self, entry: u8) {
        let k = usize::from(entry);
        let (older, newer) = (self.older[k], self.newer[k]);
        self.newer[usize::from(older)] = newer;
        self.older[usize::from(newer)] = older;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// By the definition: what is held, newest last.
    fn naive(policy: CachePolicy, entries: usize, indices: &[u32]) -> Vec<bool> {
        let mut held: Vec<u32> = Vec::new();
        let mut one = |&vertex: &u32| {
            let at = held.iter().position(|&v| v == vertex);
            match (policy, at) {
                (CachePolicy::Unlimited | CachePolicy::Fifo, Some(_)) => return false,
                (CachePolicy::Lru, Some(at)) => {
                    held.remove(at);
                }
                _ => {}
            }
            held.push(vertex);
            if policy != CachePolicy::Unlimited && held.len() > entries {
                held.remove(0);
            }
            at.is_none()
        };
        indices.iter().map(&mut one).collect()
    }

    fn run(cache: &mut Cache, indices: &[u32]) -> Vec<bool> {
        indices.iter().map(|&vertex| cache.misses(vertex)).collect()
    }

    const POLICIES: [CachePolicy; 3] =
        [CachePolicy::Unlimited, CachePolicy::Fifo, CachePolicy::Lru];

    #[test]
    fn a_vertex_that_is_named_again_outlives_its_age_under_lru_only() {
        let indices = [0, 1, 2, 0, 3, 0, 1];
        let missed = |policy| run(&mut Cache::new(VertexCache { policy, entries: 3 }), &indices);
        let expected = [
            [true, true, true, false, true, false, false],
            [true, true, true, false, true, true, true],
            [true, true, true, false, true, false, true],
        ];
        assert_eq!(POLICIES.map(missed), expected);
    }

    /// The rows of a grid of quadrilaterals, each as a strip: below, above, below, ..
    fn grid(columns: u32, rows: u32) -> Vec<u32> {
        let vertex = |column: u32, line: u32| line * (columns + 1) + column;
        let row = |row: u32| (0..=columns).flat_map(move |c| [vertex(c, row), vertex(c, row + 1)]);
        (0..rows).flat_map(row).collect()
    }

    /// Misses of a grid's rows, as strips and as lists of the same triangles.
    fn misses(policy: CachePolicy, entries: u32, [columns, rows]: [u32; 2]) -> [u32; 2] {
        let strips = grid(columns, rows);
        let each = 2 * (columns as usize + 1);
        let lists = strips.chunks(each).flat_map(|row| row.windows(3)).flatten().copied();
        let lists: Vec<u32> = lists.collect();
        [strips, lists].map(|indices| {
            let missed = run(&mut Cache::new(VertexCache { policy, entries }), &indices);
            missed.into_iter().filter(|&missed| missed).count() as u32
        })
    }

    /// With room for what lies between two uses of a vertex, each line of vertices is shaded once:
    /// misses (C + 1)(R + 1), towards half a vertex a triangle. Without, each row shades both of
    /// its lines: 2 (C + 1) R, towards one. Between the uses of a vertex of the line that two rows
    /// share, 2 C others are named (lru); C others are shaded, or up to 2 C where the first row
    /// shades both of its lines (fifo): what happens between those two is no formula.
    #[test]
    fn grids_miss_what_their_widths_say() {
        for [c, r] in [[4, 3], [7, 9], [15, 40], [20, 6], [31, 5]] {
            let (once, twice) = ([(c + 1) * (r + 1); 2], [2 * (c + 1) * r; 2]);
            for entries in 4..=64 {
                let fifo = misses(CachePolicy::Fifo, entries, [c, r]);
                let lru = misses(CachePolicy::Lru, entries, [c, r]);
                let expected = if entries > 2 * c { once } else { twice };
                assert_eq!(lru, expected, "{c} x {r}, {entries} entries");
                if entries > 2 * c || entries <= c {
                    assert_eq!(fifo, expected, "{c} x {r}, {entries} entries");
                }
            }
            assert_eq!(misses(CachePolicy::Unlimited, 3, [c, r]), once);
        }
    }

    #[test]
    fn a_triangle_costs_half_a_vertex_to_three() {
        let [columns, rows] = [30, 20_000];
        let [_, missed] = misses(CachePolicy::Lru, 64, [columns, rows]);
        let each = f64::from(missed) / f64::from(2 * columns * rows);
        assert!((0.5..0.52).contains(&each), "{each}");
        // Triangles that share nothing, and a fan whose corners have left when they come again.
        let apart: Vec<u32> = (0..3000).collect();
        let again: Vec<u32> = (0..3000).map(|k| k % 65).collect();
        for policy in [CachePolicy::Fifo, CachePolicy::Lru] {
            for indices in [&apart, &again] {
                let missed = run(&mut Cache::new(VertexCache { policy, entries: 64 }), indices);
                assert!(missed.into_iter().all(|missed| missed), "{policy:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn misses_are_those_of_the_definition(
            entries in 1usize..=64,
            // As many vertices as a cache may hold, and twice as many: hits and misses both.
            indices in prop::collection::vec(0u32..130, 0..600),
            cut in 0usize..600,
        ) {
            for policy in POLICIES {
                let settings = VertexCache { policy, entries: entries as u32 };
                let mut cache = Cache::new(settings);
                prop_assert_eq!(run(&mut cache, &indices), naive(policy, entries, &indices));
                cache.clear();
                let rest = &indices[cut.min(indices.len())..];
                prop_assert_eq!(run(&mut cache, rest), naive(policy, entries, rest));
            }
        }

        /// Of a mesh with vertices of its own: what another one left in the cache does not matter.
        #[test]
        fn an_earlier_mesh_leaves_nothing(
            entries in 1usize..=64,
            before in prop::collection::vec(0u32..70, 0..300),
            indices in prop::collection::vec(70u32..200, 0..300),
        ) {
            for policy in POLICIES {
                let settings = VertexCache { policy, entries: entries as u32 };
                let mut used = Cache::new(settings);
                run(&mut used, &before);
                let alone = run(&mut Cache::new(settings), &indices);
                prop_assert_eq!(run(&mut used, &indices), alone);
            }
        }
    }
}
