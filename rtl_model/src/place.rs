//! Place: levels in, parameter lists out. Fractional lists are made here; dyadic ones, which the
//! level block has decided already, are only written out.
//!
//! Moreton 2001 by way of Munkberg et al. 2008, section 2: an edge is two half-edges, each walked
//! from its corner in steps of 1/level, the last step shortened to meet the other half at the
//! centre. Levels between 1 and 2, where no vertex has reached the centre yet, have three segments:
//!
//! ```text
//!   level 1     o───────────────────────────o   0, 1
//!   1 < s < 2   o──o─────────────────────o──o   0, 1 - 1/s, 1/s, 1: one step passes the centre
//!   level 2     o─────────────o─────────────o
//!   5           o────o────o────┬────o────o────o  0 1/5 2/5 1/2 3/5 4/5 1: 2 ceil(level/2)
//! ```
//!
//! The one division of a level is R = floor(2^(16 + n) / level) in U0.n, n = 32 unless configured
//! otherwise; it serves the parameters, rounded half up to U1.16, and the step of the forward
//! differences, so that both agree and no half-run ever passes the centre. R is kept in 32 fraction
//! bits whatever n is, the lower ones 0.

mod dyadic;

use crate::patch::{HALF, Level, Levels, ONE};

pub use dyadic::{DyadicList, DyadicPlacement};

/// Most entries of a list: level 128.
const ENTRIES_MAX: usize = 129;

/// Fraction bits of a reciprocal unless configured otherwise, and at most.
pub const RECIPROCAL_BITS: u32 = 32;

/// Fraction bits of a reciprocal at least: 1/128 is more than nothing.
pub const RECIPROCAL_BITS_MIN: u32 = 8;

/// The parameters along one direction.
pub trait Parameters: Clone + Default {
    /// The parameters in U1.16, from 0 to 1, ascending: one more than segments.
    fn parameters(&self) -> &[u32];

    /// Segments, at most 128.
    fn segments(&self) -> usize;

    /// The list as a fractional one, which alone can be walked in equal steps.
    fn fractional(&self) -> Option<&List>;
}

/// The parameters along one direction at one level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    level: Level,
    reciprocal: u64,
    reciprocal_bits: u32,
    segments: usize,
    parameters: [u32; ENTRIES_MAX],
}

impl Default for List {
    fn default() -> Self {
        let mut list = Self {
            level: Level::MIN,
            reciprocal: 1 << 32,
            reciprocal_bits: RECIPROCAL_BITS,
            segments: 0,
            parameters: [0; ENTRIES_MAX],
        };
        list.fill();
        list
    }
}

impl List {
    /// The list of a level.
    #[must_use]
    pub fn of(level: Level) -> Self {
        let mut list = Self::default();
        list.set(level);
        list
    }

    /// Makes this the list of `level`; nothing to do where it is already.
    pub fn set(&mut self, level: Level) {
        if level != self.level {
            self.level = level;
            // A floor's floor: the same as a division to so many bits.
            let cut = RECIPROCAL_BITS - self.reciprocal_bits;
            self.reciprocal = ((1 << 48) / u64::from(level.fx16())) >> cut << cut;
            self.fill();
        }
    }

    /// The level.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// 1 / level with 32 fraction bits, truncated to those that it has; 2^32 for level 1.
    #[must_use]
    pub fn reciprocal(&self) -> u64 {
        self.reciprocal
    }

    /// Segments of a half-list, not counting one across the centre: 0, 1 or half the segments.
    #[must_use]
    pub fn half_segments(&self) -> usize {
        self.segments / 2
    }

    /// Whether a segment crosses the centre (1 < level < 2), or is all there is (level 1).
    #[must_use]
    pub fn crosses_centre(&self) -> bool {
        self.segments % 2 == 1
    }

    fn fill(&mut self) {
        let step = |k: usize| ((k as u64 * self.reciprocal + (1 << 15)) >> 16) as u32; // U1.16
        let level = self.level;
        if level == Level::MIN {
            self.segments = 1;
        } else if level < Level::TWO {
            self.segments = 3;
            self.parameters[1] = ONE - step(1);
            self.parameters[2] = step(1);
        } else {
            // ceil(level / 2); an integer needs no case, for k < half drops the duplicate of the
            // centre
            let half = ((u64::from(level.fx16()) + 0x1_ffff) >> 17) as usize;
            self.segments = 2 * half;
            for k in 1..half {
                self.parameters[k] = step(k);
                self.parameters[2 * half - k] = ONE - step(k);
            }
            self.parameters[half] = HALF;
        }
        self.parameters[0] = 0;
        self.parameters[self.segments] = ONE;
    }
}

impl Parameters for List {
    fn parameters(&self) -> &[u32] {
        &self.parameters[..=self.segments]
    }

    /// 1, 3 or an even number.
    fn segments(&self) -> usize {
        self.segments
    }

    fn fractional(&self) -> Option<&List> {
        Some(self)
    }
}

/// Where a patch gets its vertices.
#[derive(Clone, Debug, Default)]
pub struct Placement<L = List> {
    /// The lists of the edges v0, u1, v1, u0.
    pub edges: [L; 4],
    /// The list of the interior along u; its inner entries are the interior's columns.
    pub u: L,
    /// The list of the interior along v.
    pub v: L,
    reciprocals: u32,
}

impl Placement {
    /// A placement whose reciprocals have so many fraction bits.
    ///
    /// # Panics
    /// When these are not [`RECIPROCAL_BITS_MIN`] to [`RECIPROCAL_BITS`].
    #[must_use]
    pub fn of_reciprocal(bits: u32) -> Self {
        let fits = (RECIPROCAL_BITS_MIN..=RECIPROCAL_BITS).contains(&bits);
        assert!(fits, "a reciprocal of {bits} fraction bits is outside 8..=32");
        let list = List { reciprocal_bits: bits, ..List::default() };
        Self { edges: [0; 4].map(|_| list.clone()), u: list.clone(), v: list, reciprocals: 0 }
    }

    /// Places the vertices of a patch with these levels.
    ///
    /// The interior's levels are raised to min(m, 2), m the greatest level of all: otherwise a
    /// direction that leaves level 1 would make a whole column of points appear on an edge that
    /// has no vertices there.
    pub fn set(&mut self, levels: &Levels) {
        let [u, v] = levels.interior;
        let most = levels.edges.into_iter().fold(u.max(v), Level::max);
        let least = most.min(Level::TWO);
        for (list, level) in self.edges.iter_mut().zip(levels.edges) {
            list.set(level);
        }
        self.u.set(u.max(least));
        self.v.set(v.max(least));
        self.reciprocals = self.distinct_levels();
    }

    /// Levels above 1 that differ from each other: the divisions that this patch costs.
    fn distinct_levels(&self) -> u32 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.edges[k].level());
        let levels = [a, b, c, d, self.u.level(), self.v.level()];
        let first = |k: usize| levels[k] > Level::MIN && !levels[..k].contains(&levels[k]);
        (0..6).filter(|&k| first(k)).count() as u32
    }

    /// Divisions: one for each distinct level above 1.
    #[must_use]
    pub fn reciprocals(&self) -> u32 {
        self.reciprocals
    }

    /// The segment counts, on which alone the topology depends.
    #[must_use]
    pub fn segments(&self) -> Segments {
        let [a, b, c, d] = [0, 1, 2, 3].map(|edge| self.edges[edge].segments() as u8);
        Segments([a, b, c, d, self.u.segments() as u8, self.v.segments() as u8])
    }
}

impl<L: Parameters> Numbering for Placement<L> {
    fn edge(&self, edge: usize) -> usize {
        self.edges[edge].segments()
    }

    fn interior(&self) -> [usize; 2] {
        grid(self.u.segments() - 1, self.v.segments() - 1)
    }
}

/// Columns and rows of a grid; without the ones there are not the others.
fn grid(columns: usize, rows: usize) -> [usize; 2] {
    if columns > 0 && rows > 0 { [columns, rows] } else { [0; 2] }
}

/// The numbers of a patch's vertices: the boundary counter-clockwise from (0, 0), then the interior
/// row by row.
pub trait Numbering {
    /// Segments of an edge, by its place in the order v0, u1, v1, u0: at most 128.
    fn edge(&self, edge: usize) -> usize;

    /// Columns and rows of interior vertices: both 0, or both 1 to 127.
    fn interior(&self) -> [usize; 2];

    /// Vertices on the boundary, which is also its segments: at most 512.
    fn boundary(&self) -> usize {
        (0..4).map(|edge| self.edge(edge)).sum()
    }

    /// Vertices in all, at most 16641.
    fn vertices(&self) -> usize {
        let [columns, rows] = self.interior();
        self.boundary() + columns * rows
    }

    /// Triangles: by Euler's formula two an interior vertex and one a boundary vertex, less two.
    fn triangles(&self) -> usize {
        2 * self.vertices() - self.boundary() - 2
    }

    /// Numbers of the first boundary vertex of each edge, counter-clockwise, and then of the first
    /// interior vertex.
    fn starts(&self) -> [usize; 5] {
        let mut starts = [0; 5];
        for edge in 0..4 {
            starts[edge + 1] = starts[edge] + self.edge(edge);
        }
        starts
    }

    /// The vertex at entry `k` of the list of `edge`.
    #[inline]
    fn boundary_vertex(&self, starts: &[usize; 5], edge: usize, k: usize) -> usize {
        let vertex = if edge < 2 { starts[edge] + k } else { starts[edge + 1] - k };
        if vertex == starts[4] { 0 } else { vertex } // v1 and u0 run against the numbering
    }
}

/// Segments of a patch's lists: of the edges v0, u1, v1, u0, and of the interior along u and v.
/// Each is 1, 3 or an even number to 128. The interior's are 1 where every level is 1, 3 where the
/// greatest is below 2, else even.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Segments([u8; 6]);

impl Default for Segments {
    /// Those of a patch of which every level is 1.
    fn default() -> Self {
        Self([1; 6])
    }
}

impl Numbering for Segments {
    #[inline]
    fn edge(&self, edge: usize) -> usize {
        self.0[..4][edge].into()
    }

    /// Both 0 where every level is 1.
    #[inline]
    fn interior(&self) -> [usize; 2] {
        [usize::from(self.0[4]) - 1, usize::from(self.0[5]) - 1]
    }
}

impl Segments {
    /// Whether the greatest level is above 1 and below 2: no vertex stands at a centre.
    #[must_use]
    pub fn below_two(&self) -> bool {
        self.0[4] == 3
    }
}
