//! Orientation: a patch and a boundary vertex in, whether a neighbour could get other bits out.
//!
//! A neighbour has the edge on any of its four sides, in either direction: the eight symmetries of
//! the square. A vertex is counted as a crack when the patch itself, turned in one of them, gives
//! another point there. Two of them put the edge where u = 0, and there every form uses the edge's
//! own control points only; so when a vertex of a shared edge differs between two patches, it is
//! counted in at least one of them. The reverse does not hold: a neighbour may happen to be turned
//! as the patch is.

use super::{Evaluator, Net};
use rtl_model::patch::ONE;

/// A symmetry of the unit square: first u and v are swapped, then either is reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// u and v are swapped.
    pub transposed: bool,
    /// u, after that, runs backwards.
    pub reversed_u: bool,
    /// v, after that, runs backwards.
    pub reversed_v: bool,
}

/// All eight, the identity first.
pub const ORIENTATIONS: [Orientation; 8] = {
    let mut all = [Orientation { transposed: false, reversed_u: false, reversed_v: false }; 8];
    let mut n = 0;
    while n < 8 {
        all[n] =
            Orientation { transposed: n & 4 != 0, reversed_u: n & 1 != 0, reversed_v: n & 2 != 0 };
        n += 1;
    }
    all
};

impl Orientation {
    /// The control points of the turned patch, which is the same surface.
    #[must_use]
    pub fn points<P: Copy>(self, points: &[P; 16]) -> [P; 16] {
        std::array::from_fn(|k| {
            let mut row = k / 4;
            let mut column = k % 4;
            if self.reversed_u {
                column = 3 - column;
            }
            if self.reversed_v {
                row = 3 - row;
            }
            points[if self.transposed { 4 * column + row } else { 4 * row + column }]
        })
    }

    /// Where the turned patch has the point that the patch has at `[u, v]`, U1.16.
    #[must_use]
    pub fn site(self, [u, v]: [u32; 2]) -> [u32; 2] {
        let [u, v] = if self.transposed { [v, u] } else { [u, v] };
        [if self.reversed_u { ONE - u } else { u }, if self.reversed_v { ONE - v } else { v }]
    }
}

/// A patch in all orientations, to count its cracks.
#[derive(Clone, Debug)]
pub struct Orientations<'a, E: Evaluator> {
    evaluator: &'a E,
    nets: [Net<E::Value>; 8],
}

impl<'a, E: Evaluator> Orientations<'a, E> {
    /// Turns the patch.
    #[must_use]
    pub fn new(evaluator: &'a E, points: &[[E::Coordinate; 4]; 16]) -> Self {
        Self { evaluator, nets: ORIENTATIONS.map(|turn| evaluator.net(&turn.points(points))) }
    }

    /// Whether the vertex at `site`, `[u, v]` in U1.16 on an edge, differs in some orientation.
    ///
    /// # Panics
    /// When the site is not on the boundary, or a parameter exceeds 1.
    #[must_use]
    pub fn crack(&self, site: [u32; 2]) -> bool {
        assert!(site.iter().any(|&t| t == 0 || t == ONE), "{site:?} is not on the boundary");
        let mut turned = ORIENTATIONS.iter().zip(&self.nets);
        let mut point = || turned.next().map(|(o, net)| self.evaluator.point(net, o.site(site)).0);
        let own = point();
        std::iter::from_fn(point).any(|other| Some(other) != own)
    }
}
