//! Waves: the triangles of a patch in, the points that must be shaded for them out, gathered into
//! SIMD waves.
//!
//! Triangles name points by their indices. A shaded point is kept in the post-tessellation cache,
//! first in first out; what the cache lacks is shaded, again if need be. Direct3D 11 leaves the
//! cache open: the statistics that it asks for may lie anywhere between one invocation for each
//! point and three for each triangle (functional specification, section 20.4.7).
//!
//! ```text
//!   indices ─► cache ── lacks ──► wave of `width` points ─► domain shader
//!                └── has: nothing to do
//! ```
//!
//! A wave is of one patch. It leaves when a point comes that it has no lane for, or when the patch
//! ends, and takes with it the triangles that were complete by then.

use crate::patch::Triangle;

/// Points that are shaded side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wave {
    /// Points to be shaded, at least 1.
    pub points: u16,
    /// Triangles whose last point it shades, or that were complete before.
    pub triangles: u16,
    /// Triangles of the patch that had been walked when it left, its own included: at most 8192.
    pub walked: u16,
}

/// The cache and what gathers its misses.
#[derive(Clone, Debug)]
pub struct Waves {
    /// Points that the cache holds.
    entries: u64,
    width: u16,
    /// For each point of the patch, the number of the miss that brought it last.
    brought: Vec<u64>,
    misses: u64,
}

impl Waves {
    /// A cache of so many entries, all of a patch's if `None`, and waves of so many points.
    ///
    /// # Panics
    /// When the width is 0.
    #[must_use]
    pub fn new(entries: Option<u32>, width: u16) -> Self {
        assert!(width > 0, "a wave has lanes");
        let entries = entries.map_or(u64::MAX, u64::from);
        Self { entries, width, brought: Vec::new(), misses: 0 }
    }

    /// Walks the triangles of a patch and gives `each` the waves, in order. Returns the points that
    /// are shaded.
    pub fn walk(&mut self, triangles: &[Triangle], mut each: impl FnMut(Wave)) -> u64 {
        let before = self.misses;
        let (mut points, mut complete) = (0, 0);
        for (walked, triangle) in (0..).zip(triangles) {
            for &point in triangle {
                if self.holds(point, before) {
                    continue;
                }
                if points == self.width {
                    each(Wave { points, triangles: walked - complete, walked });
                    (points, complete) = (0, walked);
                }
                points += 1;
                self.misses += 1;
                self.brought[usize::from(point)] = self.misses;
            }
        }
        let walked = triangles.len() as u16; // at most 64 x 64 x 2
        if points > 0 {
            each(Wave { points, triangles: walked - complete, walked });
        }
        self.misses - before
    }

    /// Whether the cache has a point of the patch that began after so many misses.
    #[inline]
    fn holds(&mut self, point: u16, before: u64) -> bool {
        let point = usize::from(point);
        if point >= self.brought.len() {
            self.brought.resize(point + 1, 0);
        }
        let brought = self.brought[point];
        // First in, first out: it is there until as many others as there are entries have come.
        brought > before && self.misses - brought < self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of quads: points 2k and 2k + 1 stand above each other.
    fn row(quads: u16) -> Vec<Triangle> {
        (0..quads)
            .flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 1], [2 * k + 1, 2 * k + 2, 2 * k + 3]])
            .collect()
    }

    fn walked(entries: Option<u32>, width: u16, triangles: &[Triangle]) -> (u64, Vec<Wave>) {
        let mut waves = Waves::new(entries, width);
        waves.walk(&row(2), |_| {}); // another patch before: nothing of it is left
        let mut out = Vec::new();
        let shaded = waves.walk(triangles, |wave| out.push(wave));
        (shaded, out)
    }

    #[test]
    fn every_point_is_shaded_once_where_all_are_kept() {
        let (shaded, waves) = walked(None, 4, &row(4));
        let wave = |points, triangles, walked| Wave { points, triangles, walked };
        // 0 2 1 3 | 4 5 6 7 | 8 9: the third triangle needs point 4.
        assert_eq!(shaded, 10);
        assert_eq!(waves, [wave(4, 2, 2), wave(4, 4, 6), wave(2, 2, 8)]);
        assert_eq!(walked(None, 64, &row(4)).1, [wave(10, 8, 8)]);
    }

    #[test]
    fn a_small_cache_shades_again_and_none_shades_every_corner() {
        let triangles = row(8);
        assert_eq!(walked(Some(0), 64, &triangles).0, 3 * 16);
        // One entry: of two triangles the second begins where the first ended.
        assert_eq!(walked(Some(1), 64, &triangles).0, 5 * 8);
        // Two, by hand for two quads: 0! 2! 1! | 1 2 3! | 2! 4! 3! | 3 4 5!
        assert_eq!(walked(Some(2), 64, &row(2)).0, 8);
        assert_eq!(walked(Some(4), 64, &triangles).0, 18);
        for entries in [0, 1, 2, 3, 4, 9] {
            let (shaded, waves) = walked(Some(entries), 3, &triangles);
            assert_eq!(waves.iter().map(|w| u64::from(w.points)).sum::<u64>(), shaded);
            assert_eq!(waves.iter().map(|w| w.triangles).sum::<u16>(), 16);
            assert!(waves[..waves.len() - 1].iter().all(|wave| wave.points == 3));
            assert!(waves.is_sorted_by_key(|wave| wave.walked));
            assert!((18..=48).contains(&shaded));
        }
    }
}
