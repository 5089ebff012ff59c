//! Place: one factor in, the parameters of the points on its edge out, in U1.16.
//!
//! Direct3D 11.3 functional specification, 11.7.6. A fractional factor lies between two partitions
//! into equal segments, of which the finer has one point more in each half: that point splits off
//! an old one, and all move in a straight line as the factor grows.
//!
//! ```text
//!  floor partition   o───────o───────o───┄ centre     points i / 2F
//!                    │       │ ╲      ╲
//!  ceil partition    o─────o───o─────o───┄            points p / 2C, i = p after the split
//!                    0     1   2     3
//! ```
//!
//! Which one splits goes round the half-edge in ruler order, so that no part of it is much finer
//! than another. The half beyond the centre is 1 - the first: an edge is the same from both ends.
//!
//! The products are those of the hardware: reciprocals rounded to 16 bits, one rounding at the end.
//! Rounded reciprocals make a list that is not monotone just above 6 and 30 in even partitioning,
//! by up to 7 / 65536; every implementation agrees on that, so it stays.

use super::factor::Factor;
use fixed::types::U16F16;

/// Most points, of factor 64, and some more: runs are copied by the handful.
const PADDED: usize = 72;

/// The middle and the end of an edge in U1.16.
const HALF: u32 = 1 << 15;
const ONE: u32 = 1 << 16;

/// 1 / n in U1.16, rounded to nearest; no segments have no length.
const RECIPROCALS: [u32; 65] = {
    let mut table = [0; 65];
    let mut n = 1;
    while n < 65 {
        table[n] = (ONE + n as u32 / 2) / n as u32;
        n += 1;
    }
    table
};

/// The points of one factor.
#[derive(Clone, Debug)]
pub struct List {
    factor: Factor,
    count: usize,
    /// Of no meaning after the first `count`.
    parameters: [u32; PADDED],
}

impl Default for List {
    /// One segment.
    fn default() -> Self {
        let mut list = Self { factor: Factor::default(), count: 2, parameters: [0; PADDED] };
        list.fill();
        list
    }
}

impl List {
    /// Makes this the list of `factor`; nothing to do where it is already.
    #[inline]
    pub(super) fn set(&mut self, factor: Factor) {
        if factor != self.factor {
            self.factor = factor;
            self.fill();
        }
    }

    /// The parameters, 0 to 65536. Number k from the other end is 65536 minus number k.
    #[must_use]
    pub fn parameters(&self) -> &[u32] {
        &self.parameters[..self.count]
    }

    /// The number of the last parameter, which is the number of segments: 1 to 64.
    pub(super) fn last(&self) -> usize {
        self.count - 1
    }

    /// The parameters, and numbers that mean nothing after them.
    pub(super) fn padded(&self) -> &[u32; PADDED] {
        &self.parameters
    }

    fn fill(&mut self) {
        let (half, odd) = (self.factor.half(), usize::from(self.factor.odd));
        let (floor, points): (usize, usize) = (half.to_num(), half.ceil().to_num());
        let split = split(floor, half, self.factor.odd);
        let t = half.frac().to_bits(); // U0.16
        // Both partitions' steps, weighted: U1.32, 2^32 in sum where there is a single segment.
        let of_floor = RECIPROCALS[2 * floor - odd].wrapping_mul(ONE - t);
        let step = of_floor.wrapping_add(RECIPROCALS[2 * points - odd].wrapping_mul(t));
        self.count = 2 * points + 1 - odd;
        self.parameters[points] = HALF; // of an even list; the first one of an odd list's far half
        let (near, far) = self.parameters[..self.count].split_at_mut(points);
        let mut at = 1 << 15; // half an ulp
        for (p, (near, far)) in near.iter_mut().zip(far.iter_mut().rev()).enumerate() {
            *near = at >> 16;
            *far = ONE - *near;
            // The point after the split is the same one of the floor partition.
            at = at.wrapping_add(step).wrapping_sub(if p == split { of_floor } else { 0 });
        }
    }
}

/// The point of the half-edge that splits: the next one of the ruler's order. Past all points where
/// there is nothing between the partitions.
fn split(floor: usize, half: U16F16, odd: bool) -> usize {
    if half.frac() == 0 {
        return usize::MAX;
    }
    let without_top_bit = |n: usize| n ^ (1 << n.ilog2());
    match (odd, floor) {
        (true, 1) => 0,
        (true, _) => (without_top_bit(floor - 1) << 1) + 1,
        (false, _) => (without_top_bit(floor) << 1) + 1,
    }
}
