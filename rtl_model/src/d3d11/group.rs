//! Group: triangles by the handful. Steps of a walk in, the numbers of its points out.
//!
//! A triangle between two rows has numbers o + a and i + b, o and i the rows' next points. So the
//! triangles of every five steps, and of four pairs of a regular strip, are constants plus o or i:
//! sixteen or twenty-four sums that do not wait for each other, which a processor makes eight at a
//! time. It is a matter of speed alone; what the hardware makes is `Walk` and the strip's drawing.

/// Steps of a walk that are made at once.
pub(super) const STEPS: usize = 5;

/// Pairs of triangles of a strip that are made at once.
pub(super) const PAIRS: usize = 4;

/// Numbers relative to the rows' points.
#[derive(Clone, Copy)]
pub(super) struct Group<const N: usize> {
    /// The distance from the row's point.
    distance: [u16; N],
    /// All ones for the inner row, else 0.
    inner: [u16; N],
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
    const ZERO: Self = Self { distance: [0; N], inner: [0; N] };

    /// The numbers for rows whose next points are `outer` and `inner`.
    #[inline(always)]
    pub(super) fn numbers(&self, outer: u16, inner: u16, out: &mut [u16; N]) {
        let apart = inner.wrapping_sub(outer);
        for (k, out) in out.iter_mut().enumerate() {
            *out = outer.wrapping_add(self.distance[k]).wrapping_add(self.inner[k] & apart);
        }
    }

    /// Puts a triangle in its place; `down`: the inner row runs against the numbering.
    const fn put(&mut self, at: usize, triangle: [Corner; 3], clockwise: bool, down: bool) {
        let mut k = 0;
        while k < 3 {
            let place = at + if clockwise { (3 - k) % 3 } else { k };
            (self.distance[place], self.inner[place]) = match triangle[k] {
                O(distance) => (distance, 0),
                I(distance) if down => (0_u16.wrapping_sub(distance), u16::MAX),
                I(distance) => (distance, u16::MAX),
            };
            k += 1;
        }
    }
}

/// The groups of one winding and one direction of the inner row.
pub(super) struct Groups {
    /// Triangles of a walk, by its next [`STEPS`] steps; the last number is not used.
    pub(super) walk: [Group<16>; 1 << STEPS],
    /// [`PAIRS`] pairs of the first half of a strip, each (o, i, o+1), (o+1, i, i+1).
    pub(super) first: Group<24>,
    /// Of its second half, each (i, o+1, o), (i, i+1, o+1).
    pub(super) second: Group<24>,
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
            steps += 1;
        }
        let (mut first, mut second) = (Group::ZERO, Group::ZERO);
        let mut k = 0;
        while k < PAIRS as u16 {
            let at = 6 * k as usize;
            first.put(at, [O(k), I(k), O(k + 1)], clockwise, down);
            first.put(at + 3, [O(k + 1), I(k), I(k + 1)], clockwise, down);
            second.put(at, [I(k), O(k + 1), O(k)], clockwise, down);
            second.put(at + 3, [I(k), I(k + 1), O(k + 1)], clockwise, down);
            k += 1;
        }
        Self { walk, first, second }
    }
}

/// By winding (clockwise second), then by the inner row's direction (down second).
pub(super) static GROUPS: [[Groups; 2]; 2] = [
    [Groups::new(false, false), Groups::new(false, true)],
    [Groups::new(true, false), Groups::new(true, true)],
];

/// Steps on the inner row among the next [`STEPS`].
pub(super) static ON_INNER: [u16; 1 << STEPS] = {
    let mut table = [0; 1 << STEPS];
    let mut steps: usize = 0;
    while steps < table.len() {
        table[steps] = steps.count_ones() as u16;
        steps += 1;
    }
    table
};
