//! Dyadic lists: which of the parameters k/128 a midpoint subdivision has reached.
//!
//! Sfarti et al. 2005, section 6: abutting patches agree because equal edges get equal lists. A
//! list is a set, so the union of several (US 7,245,299, step 2) is one OR.

use super::ONE;

/// Depth of the deepest subdivision: 128 segments.
pub const DEPTH_MAX: u32 = 7;

/// A parameter k/128 in U1.16 is k shifted by so much.
const SHIFT: u32 = 16 - DEPTH_MAX;

/// A set of parameters k/128, k = 1..=127. The ends 0 and 1 belong to every list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dyadic(u128);

impl Dyadic {
    /// The list of one segment.
    pub const NONE: Self = Self(0);

    /// The list whose bit k says whether k/128 is in it; bit 0 says nothing.
    #[must_use]
    pub const fn of(mask: u128) -> Self {
        Self(mask & !1)
    }

    /// 2^`depth` equal segments.
    ///
    /// # Panics
    /// When the depth exceeds [`DEPTH_MAX`].
    #[must_use]
    pub const fn uniform(depth: u32) -> Self {
        assert!(depth <= DEPTH_MAX, "a list has at most 128 segments");
        let (step, mut mask, mut k) = (128 >> depth, 0, 0);
        while k < 128 {
            mask |= 1 << k;
            k += step;
        }
        Self::of(mask)
    }

    /// Bit k: whether k/128 is in the list, k = 1..=127.
    #[must_use]
    pub const fn mask(self) -> u128 {
        self.0
    }

    /// Parameters between the ends: 0..=127.
    #[must_use]
    pub const fn inner(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Segments: 1..=128.
    #[must_use]
    pub const fn segments(self) -> usize {
        self.inner() + 1
    }

    /// Adds k/128.
    ///
    /// # Panics
    /// When `k` is not 1..=127.
    pub fn insert(&mut self, k: u32) {
        assert!((1..=127).contains(&k), "{k}/128 is not inside");
        self.0 |= 1 << k;
    }

    /// Whether k/128 is in the list; the ends are.
    #[must_use]
    pub const fn contains(self, k: u32) -> bool {
        k == 0 || k == 128 || (k < 128 && self.0 >> k & 1 != 0)
    }

    /// What is in either.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The list of the curve walked from its other end.
    #[must_use]
    pub const fn reversed(self) -> Self {
        Self(self.0.reverse_bits() << 1) // k to 127 - k, then to 128 - k
    }

    /// The parameters in U1.16, from 0 to 1, ascending: one more than segments.
    pub fn parameters(self) -> impl Iterator<Item = u32> {
        let mut rest = self.0;
        let inner = std::iter::from_fn(move || {
            let k = (rest != 0).then(|| rest.trailing_zeros())?;
            rest &= rest - 1;
            Some(k << SHIFT)
        });
        std::iter::once(0).chain(inner).chain([ONE])
    }
}

/// What the level block decides for a patch that is subdivided at midpoints: the lists of its edges
/// and of its interior. The interior has every parameter that an edge along it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Lists {
    edges: [Dyadic; 4],
    u: Dyadic,
    v: Dyadic,
}

impl Lists {
    /// The edges v0, u1, v1, u0, each with its own list, and the interior, whose lists take in
    /// those of the edges that run along it.
    #[must_use]
    pub const fn new(edges: [Dyadic; 4], u: Dyadic, v: Dyadic) -> Self {
        let [v0, u1, v1, u0] = edges;
        Self { edges, u: u.union(v0).union(v1), v: v.union(u0).union(u1) }
    }

    /// One list for whatever runs along u and one for whatever runs along v, as surfaces that share
    /// edges have when all of them use the union of their lists (US 7,245,299, step 2).
    #[must_use]
    pub const fn unified(u: Dyadic, v: Dyadic) -> Self {
        Self { edges: [u, v, u, v], u, v }
    }

    /// The lists of the edges v0, u1, v1, u0. Each is a function of that edge's own four points
    /// only, unless the lists are unified.
    #[must_use]
    pub const fn edges(&self) -> &[Dyadic; 4] {
        &self.edges
    }

    /// The union of everything that runs along u.
    #[must_use]
    pub const fn u(&self) -> Dyadic {
        self.u
    }

    /// The union of everything that runs along v.
    #[must_use]
    pub const fn v(&self) -> Dyadic {
        self.v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_what_they_say() {
        let mut compared = 0;
        for depth in 0..=DEPTH_MAX {
            let list = Dyadic::uniform(depth);
            let segments = 1 << depth;
            assert_eq!(list.segments(), segments as usize);
            let parameters: Vec<u32> = list.parameters().collect();
            let want: Vec<u32> = (0..=segments).map(|k| k * (ONE / segments)).collect();
            assert_eq!(parameters, want);
            assert_eq!(list.reversed(), list);
            compared += want.len();
        }
        for k in 1..128 {
            let mut list = Dyadic::NONE;
            list.insert(k);
            assert_eq!(list.parameters().collect::<Vec<_>>(), [0, k * 512, ONE]);
            assert!(list.reversed().contains(128 - k) && list.reversed().inner() == 1);
            assert_eq!(Dyadic::of(list.mask() | 1), list, "bit 0 says nothing");
            compared += 1;
        }
        assert_eq!(compared, 255 + 8 + 127);
    }
}
