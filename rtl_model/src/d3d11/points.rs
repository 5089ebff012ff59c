//! Points: the lists of the factors in, the pattern's domain points in their order out.
//!
//! Runs of one list each: on an edge of a ring one parameter stands still and the other follows a
//! list, up or down. Rings of a quad take both from the inner factors' lists. Those of a tri stand
//! off the edges by two thirds of the inner list (so that the centre is at the centroid), and their
//! corners are pulled in by half of that; u + v + w = 1 makes the third edge.

use super::{Domain, Factors, List};

/// The end of an edge in U1.16.
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

    /// Writes the points of the pattern to `out`, which has as many places.
    pub(super) fn write(&self, factors: &Factors, out: &mut [[u32; 2]]) {
        let mut run = Run { out };
        match factors.domain() {
            Domain::Quad if factors.least() => {
                out_corners(run.out);
            }
            Domain::Quad => self.quad(&mut run),
            Domain::Tri => self.tri(&mut run, factors.least()),
            Domain::Isoline => {
                let [across, along, ..] = &self.0;
                for &v in &across.ascending()[..factors.lines()] {
                    run.put(along.ascending(), |u| [u, v]);
                }
            }
        }
    }

    fn quad(&self, run: &mut Run<'_>) {
        let [u0, v0, u1, v1, u, v] = &self.0;
        run.put(but_last(u0.descending()), |v| [0, v]);
        run.put(but_last(v0.ascending()), |u| [u, 0]);
        run.put(but_last(u1.ascending()), |v| [ONE, v]);
        run.put(but_last(v1.descending()), |u| [u, ONE]);
        let (up, right) = (v.ascending(), u.ascending());
        let (down, left) = (v.descending(), u.descending());
        for ring in 1..up.len().min(right.len()) / 2 {
            let (vs, us) = (ring..up.len() - 1 - ring, ring..right.len() - 1 - ring);
            let (u_low, u_high) = (right[ring], left[ring]);
            let (v_low, v_high) = (up[ring], down[ring]);
            run.put(&down[vs.clone()], |v| [u_low, v]);
            run.put(&right[us.clone()], |u| [u, v_low]);
            run.put(&up[vs], |v| [u_high, v]);
            run.put(&left[us], |u| [u, v_high]);
        }
        // An even axis ends in a row or column of one ring's two sides at once.
        let (rows, columns) = (up.len(), right.len());
        let ring = rows.min(columns) / 2;
        if rows <= columns && rows % 2 == 1 {
            run.put(&right[ring..columns - ring], |u| [u, up[ring]]);
        } else if columns < rows && columns % 2 == 1 {
            run.put(&down[ring..rows - ring], |v| [right[ring], v]);
        }
    }

    fn tri(&self, run: &mut Run<'_>, least: bool) {
        let [u0, v0, w0, inner, ..] = &self.0;
        run.put(but_last(u0.descending()), |v| [0, v]);
        run.put(but_last(v0.ascending()), |u| [u, 0]);
        run.put(but_last(w0.descending()), |u| [u, ONE - u]);
        if least {
            return;
        }
        let (up, down) = (inner.ascending(), inner.descending());
        for ring in 1..up.len() / 2 {
            let off = (up[ring] * TWO_THIRDS + (1 << 15)) >> 16; // U0.16, 31 bits before the shift
            let back = off.div_ceil(2);
            let along = ring..up.len() - 1 - ring;
            run.put(&down[along.clone()], |v| [off, v - back]);
            run.put(&up[along.clone()], |u| [u - back, off]);
            run.put(&down[along], |u| [u - back, ONE - (u - back) - off]);
        }
        if up.len() % 2 == 1 {
            run.put(&[THIRD], |third| [third, third]);
        }
    }
}

/// The four points of a quad of ones, which has an order of its own.
fn out_corners(out: &mut [[u32; 2]]) {
    out.copy_from_slice(&[[0, 0], [ONE, 0], [ONE, ONE], [0, ONE]]);
}

/// A list without its last point, which is the next edge's first.
fn but_last(list: &[u32]) -> &[u32] {
    &list[..list.len() - 1]
}

/// Where the next points go.
struct Run<'a> {
    out: &'a mut [[u32; 2]],
}

impl Run<'_> {
    #[inline(always)]
    fn put(&mut self, list: &[u32], point: impl Fn(u32) -> [u32; 2]) {
        let (now, rest) = std::mem::take(&mut self.out).split_at_mut(list.len());
        for (out, &parameter) in now.iter_mut().zip(list) {
            *out = point(parameter);
        }
        self.out = rest;
    }
}
