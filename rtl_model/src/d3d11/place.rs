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

/// Most points: factor 64.
const POINTS_MAX: usize = 65;

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
    ascending: [u32; POINTS_MAX],
    /// The same from the other end, for what runs that way.
    descending: [u32; POINTS_MAX],
}

impl Default for List {
    /// One segment.
    fn default() -> Self {
        let mut list = Self {
            factor: Factor::default(),
            count: 2,
            ascending: [0; POINTS_MAX],
            descending: [0; POINTS_MAX],
        };
        list.fill();
        list
    }
}

impl List {
    /// Makes this the list of `factor`; nothing to do where it is already.
    pub(super) fn set(&mut self, factor: Factor) {
        if factor != self.factor {
            self.factor = factor;
            self.fill();
        }
    }

    /// The parameters, 0 to 65536.
    #[must_use]
    pub fn ascending(&self) -> &[u32] {
        &self.ascending[..self.count]
    }

    /// The parameters from the other end, 65536 to 0.
    #[must_use]
    pub fn descending(&self) -> &[u32] {
        &self.descending[..self.count]
    }

    fn fill(&mut self) {
        let (half, odd) = (self.factor.half(), usize::from(self.factor.odd));
        let (floor, points): (usize, usize) = (half.to_num(), half.ceil().to_num());
        let split = split(floor, half, self.factor.odd);
        let t = half.frac().to_bits(); // U0.16
        // Both partitions' steps, weighted: U1.32, at most 2^32 in sum, and a half-edge 2^31.
        let of_floor = RECIPROCALS[2 * floor - odd].wrapping_mul(ONE - t);
        let step = of_floor.wrapping_add(RECIPROCALS[2 * points - odd].wrapping_mul(t));
        self.count = 2 * points + 1 - odd;
        let last = self.count - 1;
        let mut at = HALF; // half an ulp
        for p in 0..points {
            let parameter = at >> 16;
            self.ascending[p] = parameter;
            self.ascending[last - p] = ONE - parameter;
            self.descending[last - p] = parameter;
            self.descending[p] = ONE - parameter;
            // The point after the split is the same one of the floor partition.
            at = at.wrapping_add(step).wrapping_sub(if p == split { of_floor } else { 0 });
        }
        if odd == 0 {
            self.ascending[points] = HALF;
            self.descending[points] = HALF;
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
