//! Crack: a patch and its boundary vertices in, how many of them a neighbour could compute
//! otherwise out, under [`super::Boundary::Plain`].
//!
//! A neighbour has the edge on any of its four sides, in either direction: the eight symmetries of
//! the square. A vertex is counted when the patch itself, turned in one of them, gives other bits
//! there. Two of them put the edge where u = 0 and hence every product of Horner's rule along u is
//! 0: what is left is a function of the edge's own points. So when two patches differ at a vertex
//! of their edge, it is counted in at least one of them; the reverse does not hold, for a neighbour
//! may happen to be turned as the patch is.

use super::path::Datapath;
use super::power::{Net, Parameter};
use crate::number::{OverflowMode, RoundingMode};
use crate::patch::Point;

/// A symmetry of the square: first u and v are swapped, then either is reversed.
#[derive(Clone, Copy, Debug)]
struct Turn {
    swapped: bool,
    reversed: [bool; 2],
}

impl Turn {
    fn all() -> [Self; 8] {
        std::array::from_fn(|n| Self { swapped: n & 4 != 0, reversed: [n & 1 != 0, n & 2 != 0] })
    }

    /// The control points of the turned patch, which is the same surface.
    fn points(self, points: &[Point; 16]) -> [Point; 16] {
        std::array::from_fn(|k| {
            let flip = |line: usize, reversed| if reversed { 3 - line } else { line };
            let (column, row) = (flip(k % 4, self.reversed[0]), flip(k / 4, self.reversed[1]));
            points[if self.swapped { 4 * column + row } else { 4 * row + column }]
        })
    }

    /// Where the turned patch has the point that the patch has at `[u, v]`.
    fn site(self, [u, v]: [u64; 2], bits: u32) -> [Parameter; 2] {
        let flip = |fx, reversed| if reversed { (1 << bits) - fx } else { fx };
        let [u, v] = if self.swapped { [v, u] } else { [u, v] };
        [flip(u, self.reversed[0]), flip(v, self.reversed[1])].map(|fx| Parameter { fx, bits })
    }
}

/// How many of the sites, U1.F each, differ in some orientation.
pub(super) fn count<R: RoundingMode, O: OverflowMode, const NARROW: bool>(
    path: &Datapath,
    points: &[Point; 16],
    sites: impl Iterator<Item = [u64; 2]>,
) -> u64 {
    let turned = Turn::all().map(|turn| (turn, Net::of(&turn.points(points), path.guard)));
    let differs = |site: &[u64; 2]| {
        let mut points = turned.iter().map(|(turn, net)| {
            let [u, v] = turn.site(*site, path.bits);
            path.output::<R, O>(net.row::<R, NARROW>(v).at::<R, NARROW>(u), path.guard).0
        });
        let own = points.next();
        points.any(|other| Some(other) != own)
    };
    sites.filter(differs).count() as u64
}
