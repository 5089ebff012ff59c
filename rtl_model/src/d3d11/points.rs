//! Points: the lists of the factors in, the pattern's domain points in their order out.
//!
//! Runs of one list each: on an edge of a ring one parameter stands still and the other follows a
//! list, up or down. Rings of a quad take both from the inner factors' lists. Those of a tri stand
//! off the edges by two thirds of the inner list (so that the centre is at the centroid), and their
//! corners are pulled in by half of that; u + v + w = 1 makes the third edge.

use super::{Domain, Factors, List};

/// Points after the last one that may be written: their values mean nothing.
pub(super) const SLACK: usize = EDGE;

/// Why a handful of points can be written.
const ROOM: &str = "there are more places than points";

/// Points of an edge, and of a side of a ring, that are made at once.
const EDGE: usize = 12;
const SIDE: usize = 8;

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
                for &v in &across.parameters()[..factors.lines()] {
                    run.put::<EDGE>(along, 0, along.last() + 1, |u| [u, v]);
                }
            }
        }
    }

    fn quad(&self, run: &mut Run<'_>) {
        let [u0, v0, u1, v1, u, v] = &self.0;
        run.put::<EDGE>(u0, 0, u0.last(), |t| [0, less(ONE, t)]);
        run.put::<EDGE>(v0, 0, v0.last(), |t| [t, 0]);
        run.put::<EDGE>(u1, 0, u1.last(), |t| [ONE, t]);
        run.put::<EDGE>(v1, 0, v1.last(), |t| [less(ONE, t), ONE]);
        let [columns, rows] = [u.last(), v.last()]; // segments
        let rings = rows.min(columns).div_ceil(2);
        for ring in 1..rings {
            let [low_u, low_v] = [u.parameters()[ring], v.parameters()[ring]];
            let [along_u, along_v] = [columns - 2 * ring, rows - 2 * ring];
            run.put::<SIDE>(v, ring, along_v, |t| [low_u, less(ONE, t)]);
            run.put::<SIDE>(u, ring, along_u, |t| [t, low_v]);
            run.put::<SIDE>(v, ring, along_v, |t| [ONE - low_u, t]);
            run.put::<SIDE>(u, ring, along_u, |t| [less(ONE, t), ONE - low_v]);
        }
        // An even axis ends in a row or a column, which is the near and the far side of a ring.
        if rows <= columns && rows.is_multiple_of(2) {
            run.put::<SIDE>(u, rings, columns + 1 - 2 * rings, |t| [t, HALF]);
        } else if columns < rows && columns.is_multiple_of(2) {
            run.put::<SIDE>(v, rings, rows + 1 - 2 * rings, |t| [HALF, less(ONE, t)]);
        }
    }

    fn tri(&self, run: &mut Run<'_>, least: bool) {
        let [u0, v0, w0, inner, ..] = &self.0;
        run.put::<EDGE>(u0, 0, u0.last(), |t| [0, less(ONE, t)]);
        run.put::<EDGE>(v0, 0, v0.last(), |t| [t, 0]);
        run.put::<EDGE>(w0, 0, w0.last(), |t| [less(ONE, t), t]);
        if least {
            return;
        }
        let segments = inner.last();
        for ring in 1..segments.div_ceil(2) {
            let parameter = inner.parameters()[ring];
            let off = (parameter * TWO_THIRDS + (1 << 15)) >> 16; // 31 bits before the shift
            let back = off.div_ceil(2);
            let along = segments - 2 * ring;
            run.put::<SIDE>(inner, ring, along, |t| [off, less(ONE - back, t)]);
            run.put::<SIDE>(inner, ring, along, |t| [less(t, back), off]);
            run.put::<SIDE>(inner, ring, along, |t| [less(ONE - back, t), less(t, off - back)]);
        }
        if segments.is_multiple_of(2) {
            run.out[run.at] = [THIRD, THIRD];
        }
    }
}

/// A difference, which may wrap where it means nothing.
#[inline(always)]
fn less(a: u32, b: u32) -> u32 {
    a.wrapping_sub(b)
}

/// Where the next points go.
struct Run<'a> {
    out: &'a mut [[u32; 2]],
    at: usize,
}

impl Run<'_> {
    /// Puts `count` points, one for each parameter of `list` from number `first` on. They are made
    /// `N` at a time, at most [`SLACK`]: what is too many is overwritten by what follows.
    #[inline(always)]
    fn put<const N: usize>(
        &mut self,
        list: &List,
        first: usize,
        count: usize,
        point: impl Fn(u32) -> [u32; 2],
    ) {
        let mut done = 0;
        while done < count {
            let parameters: &[u32; N] = list.padded()[first + done..].first_chunk().expect(ROOM);
            let out: &mut [[u32; 2]; N] = self.out[self.at + done..].first_chunk_mut().expect(ROOM);
            for (out, &parameter) in out.iter_mut().zip(parameters) {
                *out = point(parameter);
            }
            done += N;
        }
        self.at += count;
    }
}
