//! Group: triangles by the handful. Steps of a walk in, the numbers of its points out.
//!
//! A triangle between two rows has numbers o + a and i + b, o and i the rows' next points. So the
//! triangles of every five steps, and of four pairs of a regular strip, are constants plus o or i:
//! sums that do not wait for each other, which a processor makes eight at a time. It is a matter of
//! speed alone; what the hardware makes is the walk and the strip's drawing.

/// Steps of a walk that are made at once.
pub(super) const STEPS: usize = 5;

/// Pairs of triangles of a strip that are made at once.
pub(super) const PAIRS: usize = 4;

/// Eight numbers: what the narrowest of today's vector registers hold.
pub(super) type Lanes = [u16; 8];

/// The next points of the two rows, in every lane.
#[derive(Clone, Copy)]
pub(super) struct Next {
    outer: Lanes,
    /// Of the inner row, less that of the outer row.
    apart: Lanes,
}

impl Next {
    #[inline(always)]
    pub(super) fn new(outer: u16, inner: u16) -> Self {
        Self { outer: [outer; 8], apart: [inner.wrapping_sub(outer); 8] }
    }
}

/// Numbers relative to the rows' next points, and how far the rows go on after them.
#[derive(Clone, Copy)]
pub(super) struct Group<const N: usize> {
    /// The distance from the row's point.
    distance: [Lanes; N],
    /// All ones for the inner row, else 0.
    inner: [Lanes; N],
    /// How far to go on, as [`Next`] has it.
    outer_step: Lanes,
    apart_step: Lanes,
}

/// Points of the two rows: `O(k)` is k steps from the outer row's next point, `I(k)` from the inner
/// row's.
#[derive(Clone, Copy)]
enum Corner {
    O(u16),
    I(u16),
}
use Corner::{I, O};

impl<const N: usize> Group<N> {
    const ZERO: Self =
        Self { distance: [[0; 8]; N], inner: [[0; 8]; N], outer_step: [0; 8], apart_step: [0; 8] };

    /// Writes the numbers of the triangles from the rows' next points on, and goes on after them.
    #[inline(always)]
    pub(super) fn write(&self, next: &mut Next, out: &mut [Lanes; N]) {
        for (k, out) in out.iter_mut().enumerate() {
            for (lane, out) in out.iter_mut().enumerate() {
                let inner = self.inner[k][lane] & next.apart[lane];
                *out = self.distance[k][lane].wrapping_add(next.outer[lane]).wrapping_add(inner);
            }
        }
        for lane in 0..8 {
            next.outer[lane] = next.outer[lane].wrapping_add(self.outer_step[lane]);
            next.apart[lane] = next.apart[lane].wrapping_add(self.apart_step[lane]);
        }
    }

    /// Puts a triangle in its place; `down`: the inner row runs against the numbering.
    const fn put(&mut self, at: usize, triangle: [Corner; 3], clockwise: bool, down: bool) {
        let mut k = 0;
        while k < 3 {
            let place = at + if clockwise { (3 - k) % 3 } else { k };
            let (distance, inner) = match triangle[k] {
                O(distance) => (distance, 0),
                I(distance) => (along(distance, down), u16::MAX),
            };
            self.distance[place / 8][place % 8] = distance;
            self.inner[place / 8][place % 8] = inner;
            k += 1;
        }
    }

    /// Goes on by `outer` points of the outer row and `inner` points of the inner one.
    const fn step(&mut self, outer: u16, inner: u16, down: bool) {
        self.outer_step = [outer; 8];
        self.apart_step = [along(inner, down).wrapping_sub(outer); 8];
    }
}

/// A distance along the inner row.
const fn along(distance: u16, down: bool) -> u16 {
    if down { 0_u16.wrapping_sub(distance) } else { distance }
}

/// The groups of one winding and one direction of the inner row.
pub(super) struct Groups {
    /// Triangles of a walk, by its next [`STEPS`] steps; the last number is not used.
    pub(super) walk: [Group<2>; 1 << STEPS],
    /// [`PAIRS`] pairs of the first half of a strip, each (o, i, o+1), (o+1, i, i+1).
    pub(super) first: Group<3>,
    /// Of its second half, each (i, o+1, o), (i, i+1, o+1).
    pub(super) second: Group<3>,
}

impl Groups {
    const fn new(clockwise: bool, down: bool) -> Self {
        let mut walk = [Group::ZERO; 1 << STEPS];
        let mut steps = 0;
        while steps < walk.len() {
            let (mut o, mut i, mut k) = (0, 0, 0);
            while k < STEPS {
                let on_inner = steps >> k & 1 == 1;
                let triangle =
                    if on_inner { [I(i), I(i + 1), O(o)] } else { [O(o), I(i), O(o + 1)] };
                walk[steps].put(3 * k, triangle, clockwise, down);
                (o, i) = if on_inner { (o, i + 1) } else { (o + 1, i) };
                k += 1;
            }
            walk[steps].step(o, i, down);
            steps += 1;
        }
        let (mut first, mut second) = (Group::ZERO, Group::ZERO);
        let pairs = PAIRS as u16;
        let mut k = 0;
        while k < pairs {
            let at = 6 * k as usize;
            first.put(at, [O(k), I(k), O(k + 1)], clockwise, down);
            first.put(at + 3, [O(k + 1), I(k), I(k + 1)], clockwise, down);
            second.put(at, [I(k), O(k + 1), O(k)], clockwise, down);
            second.put(at + 3, [I(k), I(k + 1), O(k + 1)], clockwise, down);
            k += 1;
        }
        first.step(pairs, pairs, down);
        second.step(pairs, pairs, down);
        Self { walk, first, second }
    }
}

/// By winding (clockwise second), then by the inner row's direction (down second).
pub(super) static GROUPS: [[Groups; 2]; 2] = [
    [Groups::new(false, false), Groups::new(false, true)],
    [Groups::new(true, false), Groups::new(true, true)],
];
