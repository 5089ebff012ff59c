//! Points: the lists of the factors in, the pattern's domain points in their order out.
//!
//! Runs of one list each: on an edge of a ring one parameter stands still and the other follows a
//! list, up or down. Rings of a quad take both from the inner factors' lists. Those of a tri stand
//! off the edges by two thirds of the inner list (so that the centre is at the centroid), and their
//! corners are pulled in by half of that; u + v + w = 1 makes the third edge.

use super::place::List;
use super::{Domain, Factors};

/// Points that are made at once, of an edge; so many after the last one may be written, which mean
/// nothing. Where many factors are alike, so is the number of handfuls, and no branch is missed.
pub(super) const SLACK: usize = 12;

/// Points of a ring's side that are made at once.
const SIDE: usize = 8;

/// Why a handful of points can be written.
const ROOM: &str = "there are more places than points";

/// The middle and the end of an edge in U1.16.
const HALF: u32 = 1 << 15;
const ONE: u32 = 1 << 16;
/// Two thirds and one third in U1.16, truncated as the hardware has them.
const TWO_THIRDS: u32 = 0xaaaa;
const THIRD: u32 = 0x5555;

/// The lists of a pattern's factors.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists([List; 6]);

impl Lists {
    /// Makes the lists of all factors.
    pub(super) fn set(&mut self, factors: &Factors) {
        for place in 0..factors.domain().factors() {
            self.0[place].set(factors.factor(place));
        }
    }

    /// Writes the points of the pattern to `out`, which has [`SLACK`] places more than points.
    pub(super) fn write(&self, factors: &Factors, out: &mut [[u32; 2]]) {
        let mut run = Run { out, at: 0 };
        match factors.domain() {
            Domain::Quad if factors.least() => {
                // This one has an order of its own.
                run.out[..4].copy_from_slice(&[[0, 0], [ONE, 0], [ONE, ONE], [0, ONE]]);
            }
            Domain::Quad => self.quad(&mut run),
            Domain::Tri => self.tri(&mut run, factors.least()),
            Domain::Isoline => {
                let [across, along, ..] = &self.0;
                for &v in &across.padded()[..factors.lines()] {
                    run.put::<SLACK>(&U_UP, along, 0, along.last() + 1, [0, v]);
                }
            }
        }
    }

    fn quad(&self, run: &mut Run<'_>) {
        let [u0, v0, u1, v1, u, v] = &self.0;
        run.put::<SLACK>(&V_DOWN, u0, 0, u0.last(), [0, ONE]);
        run.put::<SLACK>(&U_UP, v0, 0, v0.last(), [0, 0]);
        run.put::<SLACK>(&V_UP, u1, 0, u1.last(), [ONE, 0]);
        run.put::<SLACK>(&U_DOWN, v1, 0, v1.last(), [ONE, ONE]);
        let [columns, rows] = [u.last(), v.last()]; // segments
        let rings = rows.min(columns).div_ceil(2);
        for ring in 1..rings {
            let [low_u, low_v] = [u.at(ring), v.at(ring)];
            let [along_u, along_v] = [columns - 2 * ring, rows - 2 * ring];
            run.put::<SIDE>(&V_DOWN, v, ring, along_v, [low_u, ONE]);
            run.put::<SIDE>(&U_UP, u, ring, along_u, [0, low_v]);
            run.put::<SIDE>(&V_UP, v, ring, along_v, [ONE - low_u, 0]);
            run.put::<SIDE>(&U_DOWN, u, ring, along_u, [ONE, ONE - low_v]);
        }
        // An even axis ends in a row or a column, which is the near and the far side of a ring.
        if rows <= columns && rows.is_multiple_of(2) {
            run.put::<SIDE>(&U_UP, u, rings, columns + 1 - 2 * rings, [0, HALF]);
        } else if columns < rows && columns.is_multiple_of(2) {
            run.put::<SIDE>(&V_DOWN, v, rings, rows + 1 - 2 * rings, [HALF, ONE]);
        }
    }

    fn tri(&self, run: &mut Run<'_>, least: bool) {
        let [u0, v0, w0, inner, ..] = &self.0;
        run.put::<SLACK>(&V_DOWN, u0, 0, u0.last(), [0, ONE]);
        run.put::<SLACK>(&U_UP, v0, 0, v0.last(), [0, 0]);
        run.put::<SLACK>(&W_DOWN, w0, 0, w0.last(), [ONE, 0]);
        if least {
            return;
        }
        let segments = inner.last();
        for ring in 1..segments.div_ceil(2) {
            let parameter = inner.at(ring);
            let off = (parameter * TWO_THIRDS + (1 << 15)) >> 16; // 31 bits before the shift
            let back = off.div_ceil(2);
            let along = segments - 2 * ring;
            run.put::<SIDE>(&V_DOWN, inner, ring, along, [off, ONE - back]);
            run.put::<SIDE>(&U_UP, inner, ring, along, [0_u32.wrapping_sub(back), off]);
            run.put::<SIDE>(&W_DOWN, inner, ring, along, [ONE - back, back.wrapping_sub(off)]);
        }
        run.out[run.at] = [THIRD, THIRD]; // means nothing where the segments are odd
    }
}

/// With which sign t goes into u and v, of two points: not kept, flipped (all bits: the 1 that
/// makes it -t is in the base) or as it is.
struct Sign {
    keep: [u32; 4],
    flip: [u32; 4],
}

impl Sign {
    const fn new(u: i32, v: i32) -> Self {
        let [keep_u, keep_v] =
            [if u == 0 { 0 } else { u32::MAX }, if v == 0 { 0 } else { u32::MAX }];
        let [flip_u, flip_v] = [if u < 0 { u32::MAX } else { 0 }, if v < 0 { u32::MAX } else { 0 }];
        Self { keep: [keep_u, keep_v, keep_u, keep_v], flip: [flip_u, flip_v, flip_u, flip_v] }
    }
}

static U_UP: Sign = Sign::new(1, 0);
static U_DOWN: Sign = Sign::new(-1, 0);
static V_UP: Sign = Sign::new(0, 1);
static V_DOWN: Sign = Sign::new(0, -1);
/// Along w = 0 and what is parallel to it.
static W_DOWN: Sign = Sign::new(-1, 1);

/// Where the next points go.
struct Run<'a> {
    out: &'a mut [[u32; 2]],
    at: usize,
}

impl Run<'_> {
    /// Puts `count` points, one for each parameter t of `list` from number `first` on: `base`, and
    /// t with its sign. They are made `N` at a time: what is too many is overwritten by what
    /// follows.
    #[inline(never)]
    fn put<const N: usize>(
        &mut self,
        sign: &Sign,
        list: &List,
        first: usize,
        count: usize,
        [u, v]: [u32; 2],
    ) {
        // -t is !t + 1.
        let [u, v] = [u.wrapping_sub(sign.flip[0]), v.wrapping_sub(sign.flip[1])];
        let base = [u, v, u, v];
        let (list, out) = (&list.padded()[first..], &mut self.out[self.at..]);
        let mut done = 0;
        loop {
            points::<N>(list, out, done, &base, sign);
            done += N;
            if done >= count {
                break;
            }
        }
        self.at += count;
    }
}

/// `N` points from number `at` on.
#[inline(always)]
fn points<const N: usize>(
    list: &[u32],
    out: &mut [[u32; 2]],
    at: usize,
    base: &[u32; 4],
    sign: &Sign,
) {
    let list: &[u32; N] = list[at..].first_chunk().expect(ROOM);
    let out: &mut [[u32; 2]; N] = out[at..].first_chunk_mut().expect(ROOM);
    let pairs = list.as_chunks::<2>().0;
    for (out, &[a, b]) in out.as_flattened_mut().as_chunks_mut::<4>().0.iter_mut().zip(pairs) {
        let (mut two, pair) = (*base, [a, a, b, b]);
        for k in 0..4 {
            two[k] = two[k].wrapping_add((pair[k] ^ sign.flip[k]) & sign.keep[k]);
        }
        *out = two;
    }
}
