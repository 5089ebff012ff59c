//! Walk: how many points two rows have in, which row advances at each triangle out.
//!
//! A transition joins an edge to the ring inside it, which has another factor. The rows are walked
//! from a corner to the middle; each advances once for each of its segments, in the order in which
//! the points would appear as a factor grows (the ruler's order). A point has the same place in
//! that order whatever the counts, so this is a table of 33 places compared with two counts, and
//! the hardware needs no error term as Bresenham's walk does. The second half is the first one
//! mirrored, after what stands across the middle.
//!
//! ```text
//!   outer  o───o───o─────o───┄    0: the triangle stands on the outer row,
//!          │ ╱ │ ╱  ╲   ╱ ╲
//!   inner  i───┴──i──┴─i─────┄    1: it stands on the inner one
//! ```

/// In which order the points of half an edge appear, by their place from the corner to the middle:
/// a row of n has those below n.
const RULER: [u8; 33] = [
    0, 32, 16, 8, 17, 4, 18, 9, 19, 2, 20, 10, 21, 5, 22, 11, 23, 1, 24, 12, 25, 6, 26, 13, 27, 3,
    28, 14, 29, 7, 30, 15, 31,
];

/// Most segments of half a row, without one across the middle: 32.
const HALF_MAX: usize = 32;

/// Half a walk, and the same from the middle to the corner: bit k for triangle k.
type Half = [u64; 2];

/// The walks of a half by the segments of half a row: of the inner partition (the ring has one
/// less), and of the outer row.
static HALVES: [[Half; HALF_MAX + 1]; HALF_MAX + 1] = {
    let mut table = [[[0; 2]; HALF_MAX + 1]; HALF_MAX + 1];
    let mut inner = 1;
    while inner <= HALF_MAX {
        let mut outer = 0;
        while outer <= HALF_MAX {
            table[inner][outer] = half(inner, outer);
            outer += 1;
        }
        inner += 1;
    }
    table
};

const fn half(inner: usize, outer: usize) -> Half {
    let mut steps = 0_u64;
    let mut count = if outer > 0 { 1 } else { 0 }; // the corner's triangle stands on the outer row
    let mut place = 1;
    while place < RULER.len() {
        if (RULER[place] as usize) < inner {
            steps |= 1 << count;
            count += 1;
        }
        if (RULER[place] as usize) < outer {
            count += 1;
        }
        place += 1;
    }
    assert!(count == inner - 1 + outer);
    let mirrored = if count == 0 { 0 } else { steps.reverse_bits() >> (64 - count) };
    [steps, mirrored]
}

/// A walk from corner to corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Walk {
    /// Bit k says whether triangle k stands on the inner row.
    pub(super) steps: u128,
    /// Triangles: one a segment of either row, 1 to 126.
    pub(super) count: usize,
    /// The triangle on the outer row's segment across the middle, if there is one.
    pub(super) outer_middle: Option<usize>,
}

/// The walk between the ring inside a partition of `inner` segments, 2 to 64, and a row of `outer`,
/// 1 to 64. (The ring has two segments less.)
#[inline]
pub(super) fn walk(inner: usize, outer: usize) -> Walk {
    let [first, second] = HALVES[inner / 2][outer / 2];
    let half = inner / 2 - 1 + outer / 2; // 0 to 63
    // Across the middle: the inner row's segment, then the outer row's.
    let [inner_middle, outer_middle] = [inner % 2, outer % 2];
    let after = half + inner_middle + outer_middle;
    let steps = u128::from(first) | (inner_middle as u128) << half | u128::from(second) << after;
    let count = after + half;
    Walk { steps, count, outer_middle: (outer_middle == 1).then_some(half + inner_middle) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The order by its definition: the corner, 1/2, 1/4 and 3/4, the odd eighths, and so on; what
    /// is left over stands last, next to the corner.
    #[test]
    fn the_ruler_halves_what_is_longest_from_the_corner_on() {
        let mut order: Vec<usize> = (1..32).collect();
        // Place of point n in 64ths: the odd multiples of 32, 16, 8, 4 and 2.
        order.sort_by_key(|&n| {
            let row = 1 << n.ilog2();
            (2 * (n - row) + 1) * 32 / row
        });
        let want = [vec![0, 32], order].concat();
        assert_eq!(RULER.map(usize::from).to_vec(), want);
    }

    #[test]
    fn walks_have_a_step_for_each_segment_and_are_symmetric() {
        let mut compared = 0;
        for inner in 2..=64 {
            for outer in 1..=64 {
                let Walk { steps, count, outer_middle } = walk(inner, outer);
                assert_eq!(count, inner - 2 + outer);
                assert_eq!(steps.count_ones() as usize, inner - 2, "{inner} {outer}");
                let reversed = steps.reverse_bits() >> (128 - count);
                // But for the two triangles across the middle, where there are two.
                let middle =
                    if inner % 2 == 1 && outer % 2 == 1 { 0b11 << (count / 2 - 1) } else { 0 };
                assert_eq!(steps ^ reversed, middle, "{inner} {outer}");
                if let Some(k) = outer_middle {
                    assert!(outer % 2 == 1 && steps >> k & 1 == 0);
                }
                compared += 1;
            }
        }
        assert_eq!(compared, 63 * 64);
    }
}
