//! Unions: one list for every column of a primitive and one for every row, for patches that share
//! edges to be divided alike. The lists of patches come in one by one, in any order; their unions
//! go out.
//!
//! US 7,245,299, step 2: surfaces that share an edge use the union of their subdivisions. Patches
//! of a column share edges along u, those of a row edges along v, and each patch has one list a
//! direction: so what edges share, columns and rows share (a strip or a fan is a row). Nothing is
//! left to zip, but no patch can be placed before all of its primitive have been measured: each
//! instance passes through the unit twice.
//!
//! ```text
//!   pass 1   clip ─► backface ─► level ─► place: patch (row, column) into v[row], u[column]
//!   pass 2   clip ─► backface ─────────► place: v[row], u[column] ─► evaluate ─► ...
//! ```
//!
//! Another draw does not know of these lists: along an edge that two draws share they may differ,
//! and then there are cracks. Where edges must be watertight across draws, `level.union` is `off`.

use rtl_model::patch::{Dyadic, Lists};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Which time the patches of an instance pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// To have their lists taken into the unions.
    Measure,
    /// To be tessellated with the unions.
    Draw,
}

/// What the patches of one instance share in one of its passes.
#[derive(Clone, Debug)]
pub(super) struct Shared {
    pub(super) pass: Pass,
    pub(super) unions: Arc<Unions>,
}

/// A patch's place in its primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Site {
    pub(super) row: u32,
    pub(super) column: u32,
}

/// A patch's part in the unions.
#[derive(Clone, Copy)]
pub(super) struct Share<'a> {
    pub(super) shared: &'a Shared,
    pub(super) site: Site,
}

/// The unions of one instance: 127 bits for each row and column, which any thread adds to. What is
/// in them does not depend on the order.
#[derive(Debug)]
pub(super) struct Unions {
    u: Vec<Union>,
    v: Vec<Union>,
}

impl Unions {
    /// For so many rows and columns of patches.
    pub(super) fn new((rows, columns): (u64, u64)) -> Self {
        let lists = |count: u64| (0..count).map(|_| Union::default()).collect();
        Self { u: lists(columns), v: lists(rows) }
    }
}

impl Share<'_> {
    /// Takes in what a patch asks for.
    pub(super) fn measure(&self, lists: &Lists) {
        let Unions { u, v } = &*self.shared.unions;
        u[self.site.column as usize].take_in(lists.u());
        v[self.site.row as usize].take_in(lists.v());
    }

    /// What the patch gets, once all of its primitive have been measured.
    pub(super) fn lists(&self) -> Lists {
        let Unions { u, v } = &*self.shared.unions;
        Lists::unified(u[self.site.column as usize].list(), v[self.site.row as usize].list())
    }
}

/// Both halves of a list's mask. An order between threads comes from where they are joined, after
/// the patches of a pass.
#[derive(Debug, Default)]
struct Union([AtomicU64; 2]);

impl Union {
    fn take_in(&self, list: Dyadic) {
        let mask = list.mask();
        for (half, bits) in self.0.iter().zip([mask as u64, (mask >> 64) as u64]) {
            half.fetch_or(bits, Ordering::Relaxed);
        }
    }

    fn list(&self) -> Dyadic {
        let [low, high] = self.0.each_ref().map(|half| u128::from(half.load(Ordering::Relaxed)));
        Dyadic::of(low | high << 64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_and_a_column_have_all_that_their_patches_ask_for() {
        let list = |ks: &[u32]| Dyadic::of(ks.iter().fold(0, |mask, k| mask | 1 << k));
        let unions = Arc::new(Unions::new((2, 3)));
        let shared = Shared { pass: Pass::Measure, unions };
        let share = |row, column| Share { shared: &shared, site: Site { row, column } };
        let edges = [Dyadic::NONE; 4];
        share(0, 0).measure(&Lists::new(edges, list(&[1, 127]), list(&[64])));
        share(1, 0).measure(&Lists::new(edges, list(&[63]), list(&[2])));
        share(0, 2).measure(&Lists::new(
            [list(&[3]), list(&[65]), edges[2], edges[3]],
            edges[0],
            edges[0],
        ));
        let (first, second) = (list(&[1, 63, 127]), Dyadic::NONE);
        let (below, above) = (list(&[64, 65]), list(&[2]));
        assert_eq!(share(0, 0).lists(), Lists::unified(first, below));
        assert_eq!(share(1, 0).lists(), Lists::unified(first, above));
        assert_eq!(share(0, 1).lists(), Lists::unified(second, below));
        assert_eq!(share(1, 2).lists(), Lists::unified(list(&[3]), above));
    }
}
