//! Midpoint subdivision of one curve: four control points in, a dyadic list out.
//!
//! Sfarti et al. 2005, sections 4 and 5: the hull of a curve is divided until it is flat in pixels,
//! with a minimum level. Control points are divided in homogeneous coordinates and projected for
//! the test only.
//!
//! ```text
//!        b ──M── c          L1 = (a + b) / 2           12 guard bits, each form rounded down once
//!       ╱  ╲   ╱  ╲         L2 = (a + 2b + c) / 4      from the piece's own four points: a curve
//!     L1   L2 R2   R1       M = (a + 3b + 3c + d) / 8  walked backwards gives the mirrored list,
//!     ╱      M      ╲       R2, R1 mirrored            bit for bit
//!    a ─────────────── d    flat: b and c within `pixels` of the line through a and d
//! ```
//!
//! A piece of which a point has no projection is not flat. Widths: a coordinate W + 12 <= 60 bits,
//! the sum for M 3 more, a product over chords 81.

use super::{Pixel, quotients};
use crate::patch::{Dyadic, Point, View};

/// Fraction bits below the position's.
const GUARD: u32 = 12;

/// Pieces that wait for their turn: one for each depth but the first.
const STACK: usize = crate::patch::DEPTH_MAX as usize;

/// What became of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// Where it was divided.
    pub list: Dyadic,
    /// De Casteljau subdivisions: one for each entry of the list.
    pub splits: u32,
    /// Whether a piece of the greatest depth has projections, and is not flat.
    pub clamped: bool,
}

/// When a piece is divided.
#[derive(Clone, Copy, Debug)]
pub struct Subdivide<'a> {
    /// The frame.
    pub view: &'a View,
    /// Pixels in UQ16.16, at least 1 ulp.
    pub pixels: u32,
    /// Depth that every piece reaches, and depth that none exceeds: 0..=7.
    pub depths: [u32; 2],
}

/// A homogeneous point `[x, y, w]` with guard bits: z does not matter to flatness.
type Guarded = [i64; 3];

/// A part of the curve: from `first`/128, as long as its depth says.
#[derive(Clone, Copy, Debug, Default)]
struct Piece {
    points: [Guarded; 4],
    pixels: [Pixel; 4],
    first: u32,
    depth: u32,
}

impl Subdivide<'_> {
    /// Divides a curve as often as it needs.
    #[must_use]
    pub fn accept(&self, curve: &[Point; 4]) -> Subdivision {
        self.projected(curve, guarded(curve).map(|p| self.project(p)))
    }

    /// The same, where the points' projections are known.
    pub(super) fn projected(&self, curve: &[Point; 4], pixels: [Pixel; 4]) -> Subdivision {
        let whole = Piece { points: guarded(curve), pixels, first: 0, depth: 0 };
        let mut done = Subdivision { list: Dyadic::NONE, splits: 0, clamped: false };
        let (mut waiting, mut count) = ([Piece::default(); STACK], 0);
        let mut piece = whole;
        loop {
            if self.divides(&piece, &mut done) {
                let [near, far] = self.halves(&piece);
                done.list.insert(far.first);
                done.splits += 1;
                waiting[count] = far;
                count += 1;
                piece = near;
            } else if count > 0 {
                count -= 1;
                piece = waiting[count];
            } else {
                return done;
            }
        }
    }

    fn divides(&self, piece: &Piece, done: &mut Subdivision) -> bool {
        let [least, most] = self.depths;
        if piece.depth < least {
            return true;
        }
        let flat = flat(&piece.pixels, self.pixels);
        if piece.depth < most {
            return flat != Some(true);
        }
        done.clamped |= flat == Some(false);
        false
    }

    fn halves(&self, piece: &Piece) -> [Piece; 2] {
        let Piece { points: [a, b, c, d], pixels: [pa, _, _, pd], first, depth } = *piece;
        let form = |of: fn(i64, i64, i64, i64) -> i64| -> Guarded {
            std::array::from_fn(|i| of(a[i], b[i], c[i], d[i]))
        };
        let [l1, r1] = [form(|a, b, _, _| (a + b) >> 1), form(|_, _, c, d| (c + d) >> 1)];
        let l2 = form(|a, b, c, _| (a + 2 * b + c) >> 2);
        let r2 = form(|_, b, c, d| (b + 2 * c + d) >> 2);
        let middle = form(|a, b, c, d| ((a + d) + 3 * (b + c)) >> 3);
        let [p1, p2, pm, q2, q1] = [l1, l2, middle, r2, r1].map(|p| self.project(p));
        let depth = depth + 1;
        [
            Piece { points: [a, l1, l2, middle], pixels: [pa, p1, p2, pm], first, depth },
            Piece {
                points: [middle, r2, r1, d],
                pixels: [pm, q2, q1, pd],
                first: first + (128 >> depth),
                depth,
            },
        ]
    }

    fn project(&self, [x, y, w]: Guarded) -> Pixel {
        if w < self.view.near << GUARD { None } else { quotients([x, y], w, self.view) }
    }
}

fn guarded(curve: &[Point; 4]) -> [Guarded; 4] {
    curve.map(|[x, y, _, w]| [x << GUARD, y << GUARD, w << GUARD])
}

/// Whether the inner points are within `pixels` of the chord's line, or, where the chord is a
/// point, of it; `None` where a point has no projection.
fn flat(points: &[Pixel; 4], pixels: u32) -> Option<bool> {
    let [a, b, c, d] = *points;
    let (a, d) = (a?, d?);
    let from = |p: [i64; 2]| [p[0] - a[0], p[1] - a[1]]; // 41 bits
    let (chord, b, c) = (from(d), from(b?), from(c?));
    if chord == [0; 2] {
        let reach = u128::from(pixels) * u128::from(pixels);
        return Some(square(b).max(square(c)) <= reach);
    }
    // height <= pixels, that is area / pixels <= |AD|, where no more than |AD| rounded down is
    // allowed: so the quotient is rounded up, and compared squared.
    let quotient = ceil_div(area(b, chord).max(area(c, chord)), pixels);
    let too_long = quotient >> 42 != 0; // |AD| is not, and the square would not fit
    Some(!too_long && quotient * quotient <= square(chord))
}

/// |(x, y)|^2, 2^-32 square pixels.
fn square([x, y]: [i64; 2]) -> u128 {
    let square = |c: i64| u128::from(c.unsigned_abs()) * u128::from(c.unsigned_abs());
    square(x) + square(y)
}

/// Of the parallelogram over two vectors, 2^-32 square pixels.
fn area(p: [i64; 2], q: [i64; 2]) -> u128 {
    let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
    (product(p[0], q[1]) - product(p[1], q[0])).unsigned_abs()
}

fn ceil_div(value: u128, by: u32) -> u128 {
    u64::try_from(value)
        .map_or_else(|_| value.div_ceil(by.into()), |narrow| narrow.div_ceil(by.into()).into())
}
