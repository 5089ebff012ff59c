//! The surface shader of Concheiro, Amor, Boo, Padron 2014 (GRAPP): a patch and its levels in,
//! vertices and triangles out ([`surface`]); and the mesh of a coarse triangle, from the
//! candidates of its edges that are inserted ([`Insertion`]), which this page is about.
//!
//! Section 3. At level L an edge has R = L + 1 segments.
//! Row r of 0..=R holds r + 1 sites; site i of it has the number r (r + 1) / 2 + i + 1. Only the
//! sites of the edges are tested; a row's inner sites are inserted where one of its ends is.
//!
//! ```text
//!   row 0               1                 left and right count from the apex, bottom from the left
//!                     ╱   ╲
//!   row 1      left  2─────3  right       strip k lies between rows k - 1 and k and has the slots
//!                  ╱  ╲   ╱  ╲              low[0] low[1] top[0]
//!   row 2         4─────5─────6             top[0] low[1] top[1]   ..   2 k - 1 of them
//!               ╱  ╲  ╱  ╲  ╱  ╲
//!   row 3      7─────8─────9────10        counter-clockwise with row 0 at the top
//!                    bottom
//! ```
//!
//! A missing end of a row, or a missing vertex of the bottom, is replaced by a virtual vertex: the
//! nearest that is inserted on that edge, of two equally near the one in the lower row (to the
//! right, on the bottom: the paper has no rule there, and either serves). A row without both ends
//! is empty: the strip above it goes, and the next one takes the closest row above that is not
//! empty, spread over as many places as it needs. A virtual vertex is not spread: it takes one
//! place, or the mesh would have T-junctions.
//!
//! The paper then rewrites each strip's list until it alternates between rows ([`Strip::list`]).
//! The triangles need none of that: a slot two of whose vertices are equal is dropped, and that is
//! all. Their winding is the slot's. In a rewritten list it is not the place's parity, for a
//! vertex that is dropped at the head turns all that follow round.
//!
//! Hardware: two priority encoders of 17 bits an edge, two walks along rows with a counter instead
//! of a division ([`strip`]), one slot a cycle, three comparators of 9 bits.

mod crack;
mod list;
mod made;
mod mesh;
mod path;
mod pattern;
mod power;
pub mod resolution;
mod row;
mod sample;
mod section;
pub mod strip;
pub mod surface;
mod test;

pub use list::List;
pub use made::{Made, Phase, Phases};
pub use pattern::{
    COARSE_EDGES, COARSE_TRIANGLES, CoarseEdge, CoarseTriangle, Corner, Place, fraction, slot,
    uniform,
};
pub use power::{NET_BITS, PowerBasis};
pub use section::Output;
pub use strip::{Slots, Strip};
pub use surface::{Boundary, ControlMesh, Input, Reuse, Settings, Surface, Threshold};

use row::nearest;

/// The greatest level: 16 segments an edge, 153 sites, 256 triangles.
pub const LEVEL_MAX: u8 = 15;

/// The levels of a patch: candidates of a coarse edge, 0 to 15.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Levels {
    /// Of the thirds of each edge of the patch, v0, u1, v1, u0 as in [`crate::patch::EDGES`]; at
    /// most `interior`.
    pub edges: [u8; 4],
    /// Of all other coarse edges, and of the coarse triangles.
    pub interior: u8,
}

/// A place of the uniform pattern, whether a vertex is inserted there or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Site {
    /// The row, 0 to 16; 0 is the apex.
    pub row: u8,
    /// The place in the row, 0 to `row`, from the left.
    pub place: u8,
}

impl Site {
    /// The paper's number: 1 is the apex; 1 to 153.
    #[must_use]
    pub const fn number(self) -> u16 {
        let row = self.row as u16;
        row * (row + 1) / 2 + self.place as u16 + 1
    }
}

/// Three sites, counter-clockwise with row 0 at the top.
pub type Triangle = [Site; 3];

/// The edges of a coarse triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edge {
    /// From the apex down; position r is place 0 of row r.
    Left,
    /// From the apex down; position r is the last place of row r.
    Right,
    /// The last row, from the left; position i is place i.
    Bottom,
}

/// Which candidates of the three edges are inserted. The corners always are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Insertion {
    level: u8,
    /// Left, right, bottom: bit p for position p, 1 to level.
    edges: [u16; 3],
}

impl Insertion {
    /// The candidates whose bits are set, bit p for position p.
    ///
    /// # Panics
    /// Where the level is above [`LEVEL_MAX`], or a bit is no candidate's: bit 0, or above `level`.
    #[must_use]
    pub const fn new(level: u8, left: u16, right: u16, bottom: u16) -> Self {
        assert!(level <= LEVEL_MAX, "a level of at most 15");
        let others = !Self::candidates(level);
        assert!((left | right | bottom) & others == 0, "bits of positions 1 to the level");
        Self { level, edges: [left, right, bottom] }
    }

    /// All candidates: the uniform pattern of (L + 1)^2 triangles.
    ///
    /// # Panics
    /// Where the level is above [`LEVEL_MAX`].
    #[must_use]
    pub const fn all(level: u8) -> Self {
        assert!(level <= LEVEL_MAX, "a level of at most 15");
        let all = Self::candidates(level);
        Self::new(level, all, all, all)
    }

    /// Bits 1 to `level`.
    const fn candidates(level: u8) -> u16 {
        ((1_u32 << (level + 1)) - 2) as u16 // 17 bits while it is formed
    }

    /// The level, 0 to 15: candidates of each edge.
    #[must_use]
    pub const fn level(self) -> u8 {
        self.level
    }

    /// Segments of each edge of the uniform pattern, 1 to 16; also the number of the last row.
    #[must_use]
    pub const fn segments(self) -> u8 {
        self.level + 1
    }

    /// The candidates of an edge that are inserted: bit p for position p, 1 to the level.
    #[must_use]
    pub const fn mask(self, edge: Edge) -> u16 {
        self.edges[edge as usize]
    }

    /// The same with both corners: 17 bits.
    const fn chain(self, edge: Edge) -> u32 {
        self.mask(edge) as u32 | 1 | 1 << self.segments()
    }

    /// Rows between the apex and the bottom that have an end, and with it all their inner sites.
    const fn rows(self) -> u16 {
        self.mask(Edge::Left) | self.mask(Edge::Right)
    }

    /// Whether a row has vertices of its own. The apex and the bottom always have.
    const fn has_row(self, row: u8) -> bool {
        (self.rows() as u32 | 1 | 1 << self.segments()) >> row & 1 == 1
    }

    /// Whether a vertex is inserted at `site`; a corner is.
    ///
    /// # Panics
    /// Where the pattern has no such site.
    #[must_use]
    pub fn has(self, site: Site) -> bool {
        let Site { row, place } = site;
        assert!(place <= row && row <= self.segments(), "a site of the pattern");
        if row == self.segments() {
            self.chain(Edge::Bottom) >> place & 1 == 1
        } else if place == 0 {
            self.chain(Edge::Left) >> row & 1 == 1
        } else if place == row {
            self.chain(Edge::Right) >> row & 1 == 1
        } else {
            self.has_row(row)
        }
    }

    /// The vertices, in the order of their numbers.
    pub fn vertices(self) -> impl Iterator<Item = Site> {
        let sites = |row| (0..=row).map(move |place| Site { row, place });
        (0..=self.segments()).flat_map(sites).filter(move |&site| self.has(site))
    }

    /// How many vertices there are on the edges, 3 to 48: the corners and the bits.
    #[must_use]
    pub const fn boundary(self) -> u32 {
        let [left, right, bottom] = self.edges;
        3 + left.count_ones() + right.count_ones() + bottom.count_ones()
    }

    /// How many vertices there are off the edges, 0 to 105: row r has r - 1 of them.
    #[must_use]
    pub const fn interior(self) -> u32 {
        let (mut sum, mut row) = (0, 1);
        while row <= self.level {
            if self.has_row(row) {
                sum += row as u32 - 1;
            }
            row += 1;
        }
        sum
    }

    /// How many triangles there are, 1 to 256, by Euler's formula for a disc.
    #[must_use]
    pub const fn triangle_count(self) -> u32 {
        2 * self.interior() + self.boundary() - 2
    }

    /// How many slots the strips have, 1 to 256: cycles, at a slot a cycle.
    #[must_use]
    pub fn slot_count(self) -> u32 {
        self.strips().map(Strip::slot_count).sum()
    }

    /// The strips from the apex down: one for each row that is not empty, but the apex.
    pub fn strips(self) -> impl Iterator<Item = Strip> {
        let mut upper = 0;
        (1..=self.segments()).filter(move |&lower| self.has_row(lower)).map(move |lower| {
            let strip = Strip::new(self, upper, lower);
            upper = lower;
            strip
        })
    }

    /// The triangles, strip by strip from the apex down, each strip from the left.
    pub fn triangles(self) -> impl Iterator<Item = Triangle> {
        self.strips().flat_map(Strip::slots).flatten()
    }

    /// The vertex that stands for position `position` of `edge`: itself, or the virtual one.
    fn stand_in(self, edge: Edge, position: u8) -> u8 {
        nearest(self.chain(edge), position)
    }
}
