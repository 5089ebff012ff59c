//! Walk: how many points two rows have in, which row advances at each triangle out.
//!
//! A transition joins an edge to the ring inside it, which has another factor. The rows are walked
//! from a corner to the middle; each advances once for each of its segments, in the order in which
//! the points would appear as a factor grows (the ruler's order). A row's point has the same place
//! in that order whatever the counts, so this is a table of 33 places compared with two counts, and
//! the hardware needs no error term as Bresenham's walk does. The second half is the first one
//! mirrored.
//!
//! ```text
//!   outer  o───o─────o───o───┄  mid      bit 0: the triangle stands on the outer row
//!          │ ╲ │ ╲ ╱ │  ╱
//!   inner  i───┴──i──┴─i─────┄           bit 1: on the inner row
//! ```

/// In which order the half-edge's points appear, by their place from the corner to the middle: a
/// row of n half-edge points has those below n.
const RULER: [u8; 33] = [
    0, 32, 16, 8, 17, 4, 18, 9, 19, 2, 20, 10, 21, 5, 22, 11, 23, 1, 24, 12, 25, 6, 26, 13, 27, 3,
    28, 14, 29, 7, 30, 15, 31,
];

/// Most half-edge points without an odd row's last: 32.
const HALF_MAX: usize = 32;

/// The walks from a corner to the middle, by half-edge points of the inner and the outer row.
static HALVES: [[u64; HALF_MAX + 1]; HALF_MAX + 1] = {
    let mut table = [[0; HALF_MAX + 1]; HALF_MAX + 1];
    let mut inner = 0;
    while inner <= HALF_MAX {
        let mut outer = 0;
        while outer <= HALF_MAX {
            table[inner][outer] = half(inner as u8, outer as u8);
            outer += 1;
        }
        inner += 1;
    }
    table
};

const fn half(inner: u8, outer: u8) -> u64 {
    let mut steps = 0;
    let mut at = if outer > 0 { 1 } else { 0 }; // the corner's own triangle stands outside
    let mut place = 1;
    while place < RULER.len() {
        if RULER[place] < inner {
            steps |= 1 << at;
            at += 1;
        }
        if RULER[place] < outer {
            at += 1;
        }
        place += 1;
    }
    steps
}

/// Half of a walk: bit k says whether triangle k stands on the inner row. At most 63.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Half {
    pub(super) steps: u64,
    pub(super) count: u32,
}

impl Half {
    /// The same from the middle to the corner.
    pub(super) fn mirrored(self) -> Self {
        let steps = self.steps.reverse_bits().checked_shr(64 - self.count).unwrap_or(0);
        Self { steps, count: self.count }
    }
}

/// What stands across the middle of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Middle {
    /// A point of each row.
    Nothing,
    /// A segment of the inner row, and a point of the outer one.
    Inner,
    /// A segment of the outer row, and a point of the inner one.
    Outer,
    /// A segment of each: two triangles.
    Both,
}

/// The walk from the corner to the middle and what is there, by the rows' points: the inner one's
/// count includes the two that are on the edges.
pub(super) fn walk(inner: usize, outer: usize) -> (Half, Middle) {
    let (inner_half, outer_half) = ((inner - 1) / 2, (outer - 1) / 2);
    let steps = HALVES[inner_half][outer_half];
    let count = (inner_half - 1 + outer_half) as u32;
    let middle = match (inner % 2, outer % 2) {
        (1, 1) => Middle::Nothing,
        (1, _) => Middle::Outer,
        (_, 1) => Middle::Inner,
        _ => Middle::Both,
    };
    (Half { steps, count }, middle)
}
