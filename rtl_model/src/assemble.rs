//! Assemble: a stream of control points in, patches of sixteen out, with the reuse that the
//! primitive allows.
//!
//! Sfarti et al. 2005, section 6 and figure 5: of a mesh the anchor patch brings 16 points, the
//! other patches of its row and column 12, all others 9. What they lack stands in on-chip state:
//! the upper boundary of the row of patches below, and the right boundary of the patch to the left.
//!
//! ```text
//!     9   9   9        held while patch (1, 1) is assembled:
//!    12   9   9          o───o───o───o   row store, 3 columns + 1 entries, replaced in place
//!    16  12  12          column store of 4: the right side of patch (1, 0)
//! ```

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
}

impl Primitive {
    /// Patches in one instance.
    #[must_use]
    pub fn patches(self) -> u64 {
        match self {
            Self::Patches { count } => count,
            Self::Mesh { rows, columns } => u64::from(rows) * u64::from(columns),
        }
    }

    /// Points that one instance uses, and receives.
    #[must_use]
    pub fn points(self) -> u64 {
        match self {
            Self::Patches { count } => 16 * count,
            Self::Mesh { rows, columns } => {
                (3 * u64::from(rows) + 1) * (3 * u64::from(columns) + 1)
            }
        }
    }

    /// Which of the instance's points are the sixteen of patch `n`, in patch order.
    #[must_use]
    pub fn indices(self, n: u64) -> [u64; 16] {
        let (anchor, stride) = match self {
            Self::Patches { .. } => (16 * n, 4),
            Self::Mesh { columns, .. } => {
                let columns = u64::from(columns);
                let stride = 3 * columns + 1;
                (3 * (n / columns) * stride + 3 * (n % columns), stride)
            }
        };
        std::array::from_fn(|k| anchor + (k as u64 / 4) * stride + k as u64 % 4)
    }

    /// How many points patch `n` brings; the rest of its sixteen is on chip already.
    #[must_use]
    pub fn received(self, n: u64) -> u64 {
        match self {
            Self::Patches { .. } => 16,
            Self::Mesh { columns, .. } => {
                let (row, column) = (n / u64::from(columns), n % u64::from(columns));
                match (row, column) {
                    (0, 0) => 16,
                    (0, _) | (_, 0) => 12,
                    _ => 9,
                }
            }
        }
    }

    /// Most control points of shared edges that are held at once: the row store, where another row
    /// follows, and the column store, where another patch of the row does.
    #[must_use]
    pub fn edge_entries_peak(self) -> u64 {
        match self {
            Self::Patches { .. } => 0,
            Self::Mesh { rows, columns } => {
                let row_store = if rows > 1 { 3 * u64::from(columns) + 1 } else { 0 };
                row_store + if columns > 1 { 4 } else { 0 }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn a_mesh_brings_each_point_once_and_its_patches_share_their_edges() {
        let mut patches = 0;
        for rows in 1..6 {
            for columns in 1..6 {
                let mesh = Primitive::Mesh { rows, columns };
                let mut seen = HashSet::new();
                for n in 0..mesh.patches() {
                    let new = mesh.indices(n).iter().filter(|&&i| seen.insert(i)).count() as u64;
                    assert_eq!(new, mesh.received(n), "patch {n} of {rows} x {columns}");
                    patches += 1;
                }
                assert_eq!(seen.len() as u64, mesh.points());
                assert_eq!(seen.iter().max(), Some(&(mesh.points() - 1)));
            }
        }
        println!("compared {patches} patches");
    }

    #[test]
    fn neighbours_of_a_mesh_hold_the_same_points() {
        let mesh = Primitive::Mesh { rows: 2, columns: 3 };
        let (a, right, above) = (mesh.indices(0), mesh.indices(1), mesh.indices(3));
        assert_eq!([a[3], a[7], a[11], a[15]], [right[0], right[4], right[8], right[12]]);
        assert_eq!(a[12..], above[..4]);
        assert_eq!(mesh.edge_entries_peak(), 10 + 4);
    }
}
