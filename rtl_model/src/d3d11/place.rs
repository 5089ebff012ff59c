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

/// Points of a half-edge that are made at once, from the centre outwards, whether there are as many
/// or not.
const HANDFUL: usize = 12;

/// Where the centre of a list is kept, and where its far half begins if it is odd: 33 points of a
/// half-edge are three handfuls.
const CENTRE: usize = 3 * HANDFUL;

/// Room for both halves, the centre, and for runs that are copied by the handful.
const ROOM: usize = 2 * CENTRE + 24;

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

/// The two partitions that a factor is between.
#[derive(Clone, Copy)]
struct Partitions {
    /// Reciprocals of their segments; of the coarser one 0 if it has none.
    floor: u32,
    ceil: u32,
    /// The point of the finer half-edge that splits off: the next one of the ruler's order.
    split: i32,
}

/// By parity (odd second), then by points of the half-edge in the finer partition, 1 to 33.
static PARTITIONS: [[Partitions; 34]; 2] = {
    let mut table = [[Partitions { floor: 0, ceil: 0, split: 0 }; 34]; 2];
    let mut k = 0;
    while k < 66 {
        let (odd, points) = (k % 2, 1 + k / 2);
        if 2 * points - odd <= 64 {
            // Points before the one in the middle, or before the last of an odd half.
            let before = points - 1 - if points > 1 { odd } else { 0 };
            let floor = if points > 1 { RECIPROCALS[2 * (points - 1) - odd] } else { 0 };
            let ceil = RECIPROCALS[2 * points - odd];
            let split = if before == 0 { 0 } else { 2 * (before ^ (1 << before.ilog2())) + 1 };
            table[odd][points] = Partitions { floor, ceil, split: split as i32 };
        }
        k += 1;
    }
    table
};

/// All ones for the points of a half-edge after the split, from the centre outwards: from number
/// [`BEFORE`] less as many as there are. A table, and not a comparison, for the sake of speed.
static AFTER_SPLIT: [u32; 176] = {
    let mut table = [0; 176];
    let mut k = 0;
    while k < BEFORE as usize {
        table[k] = u32::MAX;
        k += 1;
    }
    table
};
const BEFORE: i32 = 64;

/// The points of one factor.
#[derive(Clone, Debug)]
pub(super) struct List {
    factor: Factor,
    /// Where the points begin.
    first: usize,
    count: usize,
    /// Of no meaning before the first point and after the last.
    parameters: [u32; ROOM],
}

impl Default for List {
    /// One segment.
    fn default() -> Self {
        let factor = Factor::default();
        let mut list = Self { factor, first: CENTRE, count: 0, parameters: [0; ROOM] };
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

    /// Parameter number k, 0 to 65536. Number k from the other end is 65536 less it.
    pub(super) fn at(&self, k: usize) -> u32 {
        self.parameters[self.first + k]
    }

    /// The number of the last parameter, which is the number of segments: 1 to 64.
    pub(super) fn last(&self) -> usize {
        self.count - 1
    }

    /// The parameters; then at least 15 that mean nothing.
    pub(super) fn padded(&self) -> &[u32] {
        &self.parameters[self.first..]
    }

    #[inline]
    fn fill(&mut self) {
        let (half, odd) = (self.factor.half(), usize::from(self.factor.odd));
        let points: usize = half.ceil().to_num();
        let Partitions { floor, ceil, split } = PARTITIONS[odd][points];
        // Where they are the same, it is all ceil partition: 1 to 65536.
        let t = half.to_bits() - ((points as u32 - 1) << 16);
        // Both partitions' steps, weighted: U1.32, 2^32 in sum where there is a single segment.
        let of_floor = floor.wrapping_mul(ONE - t);
        let step = of_floor.wrapping_add(ceil.wrapping_mul(t));
        self.first = CENTRE - points;
        self.count = 2 * points + 1 - odd;
        self.parameters[CENTRE] = HALF; // an odd list's far half has its first point here
        // From the centre outwards, so that what is too many lies outside: number q of a half is
        // point p = points - 1 - q, and after the split where q is below this.
        let split = points as i32 - 1 - split;
        // With half an ulp, for the rounding.
        let last = (1_u32 << 15).wrapping_add((points as u32 - 1).wrapping_mul(step));
        let mut at = [last, last.wrapping_sub(step), 0, 0];
        [at[2], at[3]] = [at[0].wrapping_sub(step << 1), at[1].wrapping_sub(step << 1)];
        // The point after the split is the same one of the floor partition as the one that splits.
        let window = &AFTER_SPLIT[(BEFORE - split) as usize..];
        let (mut near, mut far) = (CENTRE, CENTRE + 1 - odd);
        let mut done = 0;
        for after in window.as_chunks::<HANDFUL>().0 {
            for after in after.as_chunks::<4>().0 {
                let mut parameters = [0; 4];
                for k in 0..4 {
                    parameters[k] = at[k].wrapping_sub(of_floor & after[k]) >> 16;
                }
                for at in &mut at {
                    *at = at.wrapping_sub(step << 2);
                }
                near -= 4;
                self.mirrored(near, far, parameters);
                far += 4;
            }
            done += HANDFUL;
            if done >= points {
                break;
            }
        }
    }

    /// Puts four points of the near half, from the centre outwards, and their mirror images.
    #[inline(always)]
    fn mirrored(&mut self, near: usize, far: usize, parameters: [u32; 4]) {
        let [a, b, c, d] = parameters;
        let place = self.parameters[near..].first_chunk_mut().expect("room for both halves");
        *place = [d, c, b, a];
        let place = self.parameters[far..].first_chunk_mut().expect("room for both halves");
        *place = parameters.map(|parameter| ONE.wrapping_sub(parameter));
    }
}
