//! The fixed-function tessellator of Direct3D 11: factors in, domain points and indices out.
//!
//! From the Direct3D 11.3 functional specification, chapter 11, and from what hardware and drivers
//! that follow it make, to the bit: OpenGL 4 and Vulkan share it. A pattern knows nothing of the
//! patch but its factors: one for each edge, and for the interior one (tri) or two (quad).
//!
//! ```text
//!   v = 1  0─────7─────6   the outer ring starts at (0, 1) and runs down U = 0, then along V = 0,
//!          │ ╲   │   ╱ │   up U = 1 and back along V = 1; each edge has the points of its own
//!          │   ╲ │ ╱   │   factor
//!          1─────8─────5
//!          │   ╱ │ ╲   │   inner rings go the same way, on the grid of the inner factors; an even
//!          │ ╱   │   ╲ │   axis ends in a middle row, column or point (all factors are 2 here)
//!   v = 0  2─────3─────4
//!        u = 0       u = 1
//! ```
//!
//! Only the outermost strip is a transition between two factors; the strips further in join rings
//! of which each side loses a segment at either end.
//!
//! Everything is in 16.16: `Factors::process` converts each f32 once, to nearest with ties to even,
//! and no float is seen again. A factor alone decides where the points of its edge are (`place`),
//! two counts alone decide how two rows are joined (`walk`); so neighbours that give an edge the
//! same factor agree about it, whatever else they have.

mod connect;
mod factor;
mod group;
mod inside;
mod place;
mod points;
mod stitch;
mod walk;
pub mod wave;

pub use factor::Factors;

use serde::{Deserialize, Serialize};

/// What is tessellated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// The unit square: factors of U = 0, V = 0, U = 1, V = 1, then inside along U and V.
    #[default]
    Quad,
    /// The triangle u + v + w = 1: factors of U = 0, V = 0, W = 0, then inside.
    Tri,
    /// Lines of constant v: how many there are, then the segments of each.
    Isoline,
}

impl Domain {
    /// Factors that an edge each belongs to: 4, 3 or 2. Any of them culls.
    #[must_use]
    pub const fn edges(self) -> usize {
        match self {
            Self::Quad => 4,
            Self::Tri => 3,
            Self::Isoline => 2,
        }
    }

    /// Factors in all: 6, 4 or 2.
    #[must_use]
    pub const fn factors(self) -> usize {
        match self {
            Self::Quad => 6,
            Self::Tri => 4,
            Self::Isoline => 2,
        }
    }
}

/// How a factor becomes segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Partitioning {
    /// The next integer, all segments alike: 1 to 64.
    Integer,
    /// As integer: it is the hull shader that rounds to powers of two, not this unit.
    Pow2,
    /// An odd number of segments, of which two grow from nothing: 1 to 63.
    #[default]
    Odd,
    /// An even number of segments, of which two grow from nothing: 2 to 64.
    Even,
}

/// What the indices make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Output {
    /// The points, one index each.
    Point,
    /// Two indices a line: the lines of an isoline domain; elsewhere the points one after another.
    Line,
    /// Three indices a triangle, clockwise as Direct3D has it, with v down.
    Cw,
    /// Three indices a triangle, counter-clockwise with v down: a negative area with v up.
    #[default]
    Ccw,
}

/// Makes patterns, one after another, in buffers that it keeps.
#[derive(Clone, Debug, Default)]
pub struct Tessellator {
    lists: points::Lists,
    points: Vec<[u32; 2]>,
    indices: Vec<u16>,
    point_count: usize,
    index_count: usize,
}

impl Tessellator {
    /// Makes the pattern of `factors`; it stays until the next one.
    ///
    /// # Panics
    /// Where triangles are asked of an isoline domain, which has none.
    pub fn accept(&mut self, factors: &Factors, output: Output) {
        self.point_count = factors.points();
        self.index_count = factors.indices(output);
        grow(&mut self.points, self.point_count + points::SLACK);
        grow(&mut self.indices, self.index_count + stitch::SLACK);
        // The lists are read as other vectors than they are written: some time in between lets the
        // processor finish writing.
        self.lists.set(factors);
        let indices = &mut self.indices[..self.index_count + stitch::SLACK];
        connect::write(factors, output, indices);
        self.lists.write(factors, &mut self.points[..self.point_count + points::SLACK]);
    }

    /// The domain points [u, v] in U1.16, in the unit's order: at most 4225.
    #[must_use]
    pub fn points(&self) -> &[[u32; 2]] {
        &self.points[..self.point_count]
    }

    /// Numbers of points, flat: one a point, two a line, three a triangle; at most 24576.
    #[must_use]
    pub fn indices(&self) -> &[u16] {
        &self.indices[..self.index_count]
    }
}

/// Makes a buffer at least `len` long; what it holds is of no interest.
fn grow<T: Clone + Default>(buffer: &mut Vec<T>, len: usize) {
    if buffer.len() < len {
        buffer.resize(len, T::default());
    }
}
