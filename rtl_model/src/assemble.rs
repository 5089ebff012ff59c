//! Assemble: a stream of control points in, patches of sixteen out, with the reuse that the
//! primitive allows.
//!
//! Sfarti et al. 2005, section 6 and figures 4 to 6. Of a strip the first patch brings 16 points,
//! each successive one 12; of a mesh the anchor patch brings 16, the other patches of its row and
//! column 12, all others 9; of a fan the centre comes first, then 11 points and for each successive
//! patch 8. What they lack stands in on-chip state: the edge that the patch before left, and for
//! a mesh the upper boundary of the row of patches below.
//!
//! ```text
//!     9   9   9        held while patch (1, 1) of a mesh is assembled:
//!    12   9   9          o───o───o───o   row store, 3 columns + 1 entries, replaced in place
//!    16  12  12          column store of 4: the right side of patch (1, 0)
//!
//!   strip, column by column        fan: C, r1 r2 r3, then a [b] c d e f s1 s2 s3 for each patch
//!    3──7─11─15─19─23─27            r3──e──f──s3
//!    2  6 10 14 18 22 26            r2  c  d  s2     row 0 of the patch is C C C C;
//!    1  5  9 13 17 21 25            r1  a  b  s1     the next patch's r is this one's s
//!    0──4──8─12─16─20─24               C
//! ```
//!
//! A bicubic with a collapsed side has 12 points besides its centre and 9 in each successive
//! patch, one more than the paper counts. `compact` follows the paper: of the two interior points
//! next to the centre one is sent, and stands for both.
//!
//! The attributes of corners are reused likewise: 4 then 2 in a strip, 4, 2 and 1 in a mesh, 3 then
//! 1 in a fan.
//!
//! An indexed mesh names its points; a [`Cache`] of those that were transformed last says which are
//! fetched again.

mod cache;

pub use cache::Cache;

/// How the points of a draw form patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// `count` patches of 16 points each.
    Patches {
        /// Patches.
        count: u64,
    },
    /// `rows` by `columns` patches over `(3 rows + 1)` by `(3 columns + 1)` points, row-major.
    Mesh {
        /// Patches along v.
        rows: u32,
        /// Patches along u.
        columns: u32,
    },
    /// `count` patches along u over 4 by `(3 count + 1)` points, column by column.
    Strip {
        /// Patches.
        count: u64,
    },
    /// `count` patches around the first point, which is the collapsed edge v0 of each.
    Fan {
        /// Patches.
        count: u64,
        /// Points of a patch.
        encoding: FanEncoding,
    },
    /// `count` patches of 16 points each, wherever the draw's indices say.
    Indexed {
        /// Patches.
        count: u64,
    },
}

/// How many points a patch of a fan brings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FanEncoding {
    /// 11, then 8, as the paper counts: the two interior points next to the centre are one.
    #[default]
    Compact,
    /// 12, then 9.
    Full,
}

impl FanEncoding {
    /// Points of a patch besides those of its first radial curve.
    const fn stride(self) -> u64 {
        match self {
            Self::Compact => 8,
            Self::Full => 9,
        }
    }
}

/// The points of a fan before its patches' own: the centre and the first radial curve.
const FAN_HEAD: u64 = 4;

impl Primitive {
    /// Patches in one instance.
    #[must_use]
    pub fn patches(self) -> u64 {
        match self {
            Self::Patches { count }
            | Self::Strip { count }
            | Self::Fan { count, .. }
            | Self::Indexed { count } => count,
            Self::Mesh { rows, columns } => u64::from(rows) * u64::from(columns),
        }
    }

    /// Points that one instance uses, from its first on; `None` where its indices say.
    #[must_use]
    pub fn points(self) -> Option<u64> {
        Some(match self {
            Self::Patches { count } => 16 * count,
            Self::Mesh { rows, columns } => {
                (3 * u64::from(rows) + 1) * (3 * u64::from(columns) + 1)
            }
            Self::Strip { count } => 4 * (3 * count + 1),
            Self::Fan { count, encoding } => FAN_HEAD + encoding.stride() * count,
            Self::Indexed { .. } => return None,
        })
    }

    /// Corners that one instance has attributes for; `None` where its indices say.
    #[must_use]
    pub fn corners(self) -> Option<u64> {
        Some(match self {
            Self::Patches { count } => 4 * count,
            Self::Mesh { rows, columns } => (u64::from(rows) + 1) * (u64::from(columns) + 1),
            Self::Strip { count } => 2 * (count + 1),
            Self::Fan { count, .. } => count + 2,
            Self::Indexed { .. } => return None,
        })
    }

    /// Which of the instance's points are the sixteen of patch `n`, in patch order.
    ///
    /// # Panics
    /// Where the draw's indices say.
    #[must_use]
    pub fn indices(self, n: u64) -> [u64; 16] {
        let grid = |anchor: u64, stride: u64| {
            std::array::from_fn(|k| anchor + (k as u64 / 4) * stride + k as u64 % 4)
        };
        match self {
            Self::Patches { .. } => grid(16 * n, 4),
            Self::Mesh { columns, .. } => {
                let columns = u64::from(columns);
                let stride = 3 * columns + 1;
                grid(3 * (n / columns) * stride + 3 * (n % columns), stride)
            }
            Self::Strip { .. } => {
                std::array::from_fn(|k| 12 * n + 4 * (k as u64 % 4) + k as u64 / 4)
            }
            Self::Fan { encoding, .. } => fan(encoding, n),
            Self::Indexed { .. } => unreachable!("an indexed mesh's points are its indices'"),
        }
    }

    /// Which of the instance's corners are those of patch `n`, in the order P0 P3 P12 P15.
    ///
    /// # Panics
    /// Where the draw's indices say.
    #[must_use]
    pub fn corner_indices(self, n: u64) -> [u64; 4] {
        match self {
            Self::Patches { .. } => [0, 1, 2, 3].map(|k| 4 * n + k),
            Self::Mesh { columns, .. } => {
                let columns = u64::from(columns);
                let anchor = (n / columns) * (columns + 1) + n % columns;
                [anchor, anchor + 1, anchor + columns + 1, anchor + columns + 2]
            }
            Self::Strip { .. } => [2 * n, 2 * n + 2, 2 * n + 1, 2 * n + 3],
            Self::Fan { .. } => [0, 0, n + 1, n + 2],
            Self::Indexed { .. } => unreachable!("an indexed mesh's corners are its indices'"),
        }
    }

    /// How many points patch `n` brings; the rest of its sixteen is on chip already.
    ///
    /// # Panics
    /// For an indexed mesh, where that is its cache's.
    #[must_use]
    pub fn received(self, n: u64) -> u64 {
        match (self, self.place(n)) {
            (Self::Patches { .. }, _) | (Self::Mesh { .. } | Self::Strip { .. }, (true, true)) => {
                16
            }
            (Self::Mesh { .. } | Self::Strip { .. }, (true, _) | (_, true)) => 12,
            (Self::Mesh { .. } | Self::Strip { .. }, _) => 9,
            (Self::Fan { encoding, .. }, (_, true)) => FAN_HEAD + encoding.stride(),
            (Self::Fan { encoding, .. }, _) => encoding.stride(),
            (Self::Indexed { .. }, _) => {
                unreachable!("what an indexed patch brings its cache says")
            }
        }
    }

    /// How many corners' attributes patch `n` brings; the rest of its four is on chip already.
    ///
    /// # Panics
    /// For an indexed mesh, where every corner is fetched.
    #[must_use]
    pub fn corners_received(self, n: u64) -> u64 {
        match (self, self.place(n)) {
            (Self::Patches { .. }, _) | (Self::Mesh { .. } | Self::Strip { .. }, (true, true)) => 4,
            (Self::Mesh { .. } | Self::Strip { .. }, (true, _) | (_, true)) => 2,
            (Self::Mesh { .. } | Self::Strip { .. }, _) => 1,
            (Self::Fan { .. }, (_, true)) => 3,
            (Self::Fan { .. }, _) => 1,
            (Self::Indexed { .. }, _) => unreachable!("an indexed patch brings all its corners"),
        }
    }

    /// Whether patch `n` is of the first row, and whether of the first column.
    fn place(self, n: u64) -> (bool, bool) {
        match self {
            Self::Mesh { columns, .. } => {
                let columns = u64::from(columns);
                (n < columns, n.is_multiple_of(columns))
            }
            _ => (true, n == 0),
        }
    }

    /// Rows and columns of patches: one row, but for a mesh.
    #[must_use]
    pub fn size(self) -> (u64, u64) {
        match self {
            Self::Mesh { rows, columns } => (rows.into(), columns.into()),
            _ => (1, self.patches()),
        }
    }

    /// Whether successive patches share an edge on chip.
    #[must_use]
    pub fn shares_edges(self) -> bool {
        !matches!(self, Self::Patches { .. } | Self::Indexed { .. })
    }

    /// Most control points of shared edges that are held at once: the row store, where another row
    /// follows, and the column store, where another patch of the row does. A fan's centre is one of
    /// its column's.
    #[must_use]
    pub fn edge_entries_peak(self) -> u64 {
        self.held(4, |columns| 3 * columns + 1)
    }

    /// Most corners whose attributes are held at once.
    #[must_use]
    pub fn corner_entries_peak(self) -> u64 {
        self.held(2, |columns| columns + 1)
    }

    fn held(self, column_store: u64, row_store: impl Fn(u64) -> u64) -> u64 {
        let (rows, columns) = self.size();
        if !self.shares_edges() {
            return 0;
        }
        let row_store = if rows > 1 { row_store(columns) } else { 0 };
        row_store + if columns > 1 { column_store } else { 0 }
    }

    /// How many patches later, at most, a control point of a shared edge is used for the last time:
    /// a row later in a mesh, a patch in a strip; a fan's centre serves all of it.
    #[must_use]
    pub fn edge_lifetime_peak(self) -> u64 {
        match (self, self.size()) {
            (Self::Patches { .. } | Self::Indexed { .. }, _) => 0,
            (Self::Fan { count, .. }, _) => count - 1,
            // The last point of the column store is also the row store's: it waits for the patch
            // beyond, one more, except in the last column.
            (_, (rows, columns)) if rows > 1 => columns + u64::from(columns > 1),
            (_, (_, columns)) => u64::from(columns > 1),
        }
    }
}

/// The points of patch `n` of a fan.
fn fan(encoding: FanEncoding, n: u64) -> [u64; 16] {
    let own = FAN_HEAD + encoding.stride() * n;
    let radial = |own: u64| own + encoding.stride() - 3;
    let r = if n == 0 { 1 } else { radial(own - encoding.stride()) };
    let s = radial(own);
    // a b, c d, e f: where one is sent for a and b, it is both.
    let inner = match encoding {
        FanEncoding::Compact => [[own, own], [own + 1, own + 2], [own + 3, own + 4]],
        FanEncoding::Full => [[own, own + 1], [own + 2, own + 3], [own + 4, own + 5]],
    };
    let mut points = [0; 16];
    for (k, [left, right]) in inner.into_iter().enumerate() {
        let row = [r + k as u64, left, right, s + k as u64];
        points[4 * (k + 1)..4 * (k + 2)].copy_from_slice(&row);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{HashMap, HashSet};

    fn all() -> Vec<Primitive> {
        let mut all = Vec::new();
        for rows in 1..6 {
            all.extend((1..6).map(|columns| Primitive::Mesh { rows, columns }));
        }
        for count in 1..9 {
            all.push(Primitive::Patches { count });
            all.push(Primitive::Strip { count });
            let encodings = [FanEncoding::Compact, FanEncoding::Full];
            all.extend(encodings.map(|encoding| Primitive::Fan { count, encoding }));
        }
        all
    }

    #[test]
    fn each_point_and_corner_comes_once_where_the_paper_counts_it() {
        let mut patches = 0;
        for primitive in all() {
            let (mut points, mut corners) = (HashSet::new(), HashSet::new());
            for n in 0..primitive.patches() {
                let mut new = |i: &u64| points.insert(*i);
                let received = primitive.indices(n).iter().filter(|i| new(i)).count() as u64;
                assert_eq!(received, primitive.received(n), "patch {n} of {primitive:?}");
                let mut new = |i: &u64| corners.insert(*i);
                let received = primitive.corner_indices(n).iter().filter(|i| new(i)).count() as u64;
                assert_eq!(received, primitive.corners_received(n), "{n} of {primitive:?}");
                patches += 1;
            }
            for (seen, count) in [(points, primitive.points()), (corners, primitive.corners())] {
                assert_eq!(Some(seen.len() as u64), count);
                assert_eq!(seen.iter().max().map(|most| most + 1), count, "{primitive:?}");
            }
        }
        println!("compared {patches} patches");
        assert!(patches > 300);
    }

    /// The paper's own numbers, section 6.
    #[test]
    fn sections_6_counts() {
        let received = |p: Primitive| (0..p.patches()).map(|n| p.received(n)).collect::<Vec<_>>();
        assert_eq!(received(Primitive::Strip { count: 3 }), [16, 12, 12]);
        assert_eq!(received(Primitive::Mesh { rows: 2, columns: 3 }), [16, 12, 12, 12, 9, 9]);
        // "Eleven vertices; each successive patch eight", besides the centre.
        let compact = Primitive::Fan { count: 3, encoding: FanEncoding::Compact };
        assert_eq!(received(compact), [1 + 11, 8, 8]);
        let full = Primitive::Fan { count: 3, encoding: FanEncoding::Full };
        assert_eq!(received(full), [1 + 12, 9, 9]);
        let corners =
            |p: Primitive| (0..p.patches()).map(|n| p.corners_received(n)).collect::<Vec<_>>();
        assert_eq!(corners(Primitive::Strip { count: 3 }), [4, 2, 2]);
        assert_eq!(corners(Primitive::Mesh { rows: 2, columns: 2 }), [4, 2, 2, 1]);
        assert_eq!(corners(compact), [1 + 2, 1, 1]);
    }

    #[test]
    fn what_is_held_is_what_is_used_again_later() {
        for primitive in all() {
            let patches = primitive.patches();
            let held = |indices: &dyn Fn(u64) -> Vec<u64>| {
                let mut uses: HashMap<u64, Vec<u64>> = HashMap::new();
                for n in 0..patches {
                    indices(n).into_iter().for_each(|i| uses.entry(i).or_default().push(n));
                }
                let at = |n| move |u: &&Vec<u64>| u[0] <= n && *u.last().expect("used") > n;
                let peak = (0..patches).map(|n| uses.values().filter(at(n)).count()).max();
                let life = uses.values().map(|u| u.last().expect("used") - u[0]).max();
                (peak.expect("a patch") as u64, life.expect("a point"))
            };
            let points = held(&|n| primitive.indices(n).to_vec());
            assert!(primitive.edge_entries_peak() >= points.0, "{primitive:?}: {points:?}");
            assert_eq!(primitive.edge_lifetime_peak(), points.1, "{primitive:?}");
            let corners = held(&|n| primitive.corner_indices(n).to_vec()).0;
            assert!(primitive.corner_entries_peak() >= corners, "{primitive:?}: {corners}");
            // A strip and a fan hold one edge, and nothing more.
            if let Primitive::Strip { count: 2.. } | Primitive::Fan { count: 2.., .. } = primitive {
                assert_eq!((points.0, corners), (4, 2));
                assert_eq!(
                    (primitive.edge_entries_peak(), primitive.corner_entries_peak()),
                    (4, 2)
                );
            }
        }
    }

    #[test]
    fn neighbours_hold_the_same_points() {
        let mesh = Primitive::Mesh { rows: 2, columns: 3 };
        let (a, right, above) = (mesh.indices(0), mesh.indices(1), mesh.indices(3));
        assert_eq!([a[3], a[7], a[11], a[15]], [right[0], right[4], right[8], right[12]]);
        assert_eq!(a[12..], above[..4]);
        assert_eq!(mesh.edge_entries_peak(), 10 + 4);
        for primitive in all().into_iter().filter(|p| !matches!(p, Primitive::Patches { .. })) {
            let columns = primitive.size().1;
            for n in (1..primitive.patches()).filter(|n| n % columns > 0) {
                let (left, right) = (primitive.indices(n - 1), primitive.indices(n));
                assert_eq!([3, 7, 11, 15].map(|k| left[k]), [0, 4, 8, 12].map(|k| right[k]));
                let (left, right) = (primitive.corner_indices(n - 1), primitive.corner_indices(n));
                assert_eq!([left[1], left[3]], [right[0], right[2]]);
            }
        }
    }
}
