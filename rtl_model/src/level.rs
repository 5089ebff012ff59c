//! Level: patches in, a tessellation level for each edge and for the interior out; or, for a unit
//! that divides at midpoints, a dyadic list for each.
//!
//! An edge's level is a function of that edge's own four points, the frame and the tessellation
//! state, and the same from either end: so neighbours agree. Points are projected to pixels
//! (Q24.16, rounded once); from there on every decision is exact in integers.
//!
//! - flatness, edges: n = sqrt(3/4 max(|P0-2P1+P2|, |P1-2P2+P3|) / d) (second-derivative bound,
//!   Wang 1984).
//! - flatness, interior: at least that of every row (column) of the net, and both raised by one
//!   factor until 1/8 (Muu/n^2 + 2 Muv/(n m) + Mvv/m^2) <= d (Filip, Magedson, Markot 1986), so
//!   that a twist is seen too.
//! - edge_length: length of the projected control polygon / pixels; interior: the longest of the
//!   four rows (columns).
//! - fixed: the level, edges and interior alike.
//!
//! A point with w below the near threshold, or so far outside that its projection does not fit, has
//! no useful projection: its edges, and the interior, take the greatest level. For perspective
//! patches the flatness bounds are estimates, since a projected cubic is rational.

mod bound;
mod dyadic;
mod subdivide;

use crate::patch::{EDGES, Level, Levels, ONE, Patch, Point, View};

pub use dyadic::{Termination, subdivide};
pub use subdivide::{Subdivide, Subdivision};

/// How levels are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The surface stays within `pixels` of its triangles: pixels in UQ16.16, at least 1 ulp.
    Flatness {
        /// UQ16.16.
        pixels: u32,
    },
    /// Length of the edge's projected control polygon / `pixels`.
    EdgeLength {
        /// UQ16.16.
        pixels: u32,
    },
    /// The same level everywhere.
    Fixed {
        /// The level.
        level: Level,
    },
}

/// The tessellation state of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct State {
    /// The criterion.
    pub criterion: Criterion,
    /// Least level.
    pub min: Level,
    /// Greatest level, at least `min`.
    pub max: Level,
}

/// What happened while the levels of a patch were chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Events {
    /// Levels, of six, of which the criterion asked more than the greatest.
    pub clamped: u32,
    /// Edges given the greatest level because a point of theirs is too near.
    pub near: u32,
    /// Control points whose projection did not fit.
    pub overflows: u32,
    /// De Casteljau subdivisions.
    pub splits: u32,
}

/// A projected point in pixels, Q24.16; `None` where there is none.
pub(crate) type Pixel = Option<[i64; 2]>;

/// Largest projected coordinate, 2^23 pixels in Q24.16.
const PIXEL_MAX: i64 = (1 << 39) - 1;

/// Chooses the levels of a patch.
#[must_use]
pub fn accept(patch: &Patch, view: &View, state: &State) -> (Levels, Events) {
    let (asked, mut events) = match state.criterion {
        Criterion::Fixed { level } => (Asked::same(u64::from(level.fx16())), Events::default()),
        Criterion::EdgeLength { pixels: d } => {
            let (lengths, events) = lengths(patch, view);
            (bound::edge_length(lengths, d), events)
        }
        Criterion::Flatness { pixels: d } => {
            let (points, events) = pixels(patch, view);
            (bound::flatness(&points, d, state), events)
        }
    };
    (asked.granted(state, &mut events), events)
}

/// Lengths of projected control polygons in 2^-16 pixels, at most 2^43, each segment's rounded up;
/// `None` where a point has no projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lengths {
    /// Of the edges v0, u1, v1, u0: the same from either end.
    pub edges: [Option<u64>; 4],
    /// The longest of the net's four rows, and of its four columns.
    pub interior: [Option<u64>; 2],
}

/// The lengths that [`Criterion::EdgeLength`] compares; edges without projection and points that
/// do not fit are counted.
#[must_use]
pub fn lengths(patch: &Patch, view: &View) -> (Lengths, Events) {
    let (points, events) = pixels(patch, view);
    (bound::lengths(&points), events)
}

/// Whether a point of this raw w, in the position format, has a projection as far as w decides.
#[must_use]
pub const fn in_front(w: i64, view: &View) -> bool {
    w >= view.near && w > 0
}

/// Projects the points of a patch, and counts the edges that have one without projection.
fn pixels(patch: &Patch, view: &View) -> ([Pixel; 16], Events) {
    let mut events = Events::default();
    let points = patch.points.map(|p| project(p, view, &mut events));
    let near = EDGES.iter().filter(|e| e.iter().any(|&k| points[k].is_none()));
    events.near = near.count() as u32;
    (points, events)
}

/// What the criterion asks for, UQ48.16; `None` where a point has no projection.
#[derive(Clone, Copy, Debug)]
struct Asked {
    edges: [Option<u64>; 4],
    interior: [Option<u64>; 2],
}

impl Asked {
    fn same(level: u64) -> Self {
        Self { edges: [Some(level); 4], interior: [Some(level); 2] }
    }

    /// The levels within the state's bounds. An interior is never coarser than the edges that run
    /// along it.
    fn granted(self, state: &State, events: &mut Events) -> Levels {
        let mut grant = |asked: Option<u64>| match asked {
            None => state.max,
            Some(level) => {
                events.clamped += u32::from(level > u64::from(state.max.fx16()));
                clamp(level, state)
            }
        };
        let edges = self.edges.map(&mut grant);
        let [u, v] = self.interior.map(&mut grant);
        Levels { edges, interior: [u.max(edges[0]).max(edges[2]), v.max(edges[1]).max(edges[3])] }
    }
}

fn clamp(level: u64, state: &State) -> Level {
    Level::clamped(level.clamp(state.min.fx16().into(), state.max.fx16().into()))
}

/// The pixel of a point, if it has one: not nearer than the view allows, and within the range.
pub(crate) fn project([x, y, _, w]: Point, view: &View, events: &mut Events) -> Pixel {
    if !in_front(w, view) {
        return None;
    }
    let pixel = quotients([x, y], w, view);
    events.overflows += u32::from(pixel.is_none());
    pixel
}

/// `x / w` and `y / w` in pixels; `None` where they do not fit, or w is not positive. The offset of
/// the viewport's centre does not matter to any criterion, nor does the direction of y, so both are
/// left out.
fn quotients([x, y]: [i64; 2], w: i64, view: &View) -> Pixel {
    if w <= 0 {
        return None;
    }
    let (w, [width, height]) = (w as u64, view.viewport);
    // To the nearest, of two the even one: the same for either sign.
    let pixel = |c: i64, size: u32| {
        // c / w * size / 2 * 2^16: W + 14 + 15 bits over W bits, with up to 12 guard bits each
        let numerator = u128::from(c.unsigned_abs()) * u128::from(size * (ONE / 2));
        if numerator >> 39 > u128::from(w) {
            return None; // beyond the greatest, and the quotient need not be known
        }
        let quotient = (numerator / u128::from(w)) as u64;
        let rest = (numerator as u64).wrapping_sub(quotient.wrapping_mul(w));
        let up = 2 * rest > w || (2 * rest == w && quotient & 1 != 0);
        let rounded = (quotient + u64::from(up)) as i64;
        (rounded <= PIXEL_MAX).then_some(if c < 0 { -rounded } else { rounded })
    };
    Some([pixel(x, width)?, pixel(y, height)?])
}
