//! The arithmetic of the level block, criterion by criterion: the longest formulas of the unit.
//!
//! Widths, from `rtl_model/src/level.rs` and its `bound.rs`: a pixel Q24.16 is 40 bits, a second
//! difference of pixels 42, its square 84, a level UQ8.16 24, a level that is asked for UQ48.16.
//! From `level/subdivide.rs`: a divided coordinate W + 12, pixels from a piece's end 41.

use super::{Formats, Piece, quotient, reciprocal, root};
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C};

const PIXEL: u64 = 40;
const DIFFERENCE: u64 = 42;
const LEVEL: u64 = 24;
const ASKED: u64 = 64;
/// Pixels of a criterion, UQ16.16, or 1 / pixels, which is formed once for a tessellation state.
const TOLERANCE: u64 = 32;

/// Guard bits of a divided coordinate.
const GUARD: u64 = 12;

/// What every criterion needs that ends in levels.
pub(super) const GRANT: Piece = Piece {
    block: Block::Level,
    meaning: "a patch's six levels against min and max (12 comparisons of 64 bits), and the \
              interior's against its edges (4 of 24); not where eight curves are divided, nor \
              in unit esc by distance or at a fixed level",
    times: |f| {
        let no = f.adaptive() || f.without_criterion();
        if no { 0 } else { f.get(C::LevelPatches) - f.eight_curves() }
    },
    once: |_| Ops::default().compares(12, ASKED).compares(4, LEVEL),
};

/// What the two criteria that look at pixels need.
pub(super) const PROJECT: Piece = Piece {
    block: Block::Level,
    meaning: "flatness and edge_length: 16 points projected to pixels, each w against the near \
              threshold and 0, x and y times the viewport's size (15 bits), one reciprocal of w, \
              two quotients",
    times: |f| f.get(C::LevelFlatness) + f.get(C::LevelEdgeLength),
    once: project,
};

/// What flatness needs besides.
pub(super) const FLATNESS: Piece = Piece {
    block: Block::Level,
    meaning: "flatness: 16 second differences along the net and 9 across it, their squared \
              lengths, the greatest of each edge and direction and their roots, six levels from \
              them, and the interior's raised by the bound; not where eight curves are divided",
    times: |f| f.get(C::LevelFlatness) - f.eight_curves(),
    once: |_| flatness(),
};

/// What edge_length needs besides.
pub(super) const EDGE_LENGTH: Piece = Piece {
    block: Block::Level,
    meaning: "edge_length: the lengths of 24 segments of the net, their sums along its 8 lines, \
              those divided by pixels, and the greatest of each direction",
    times: |f| f.get(C::LevelEdgeLength),
    once: |_| edge_length(),
};

/// What levels need besides to be lists.
pub(super) const POWERS: Piece = Piece {
    block: Block::Level,
    meaning: "unit sfarti, other than where eight curves are divided: six levels rounded up to \
              powers of two, a decrement of 24 bits each",
    times: |f| if f.divides() { f.get(C::LevelPatches) - f.eight_curves() } else { 0 },
    once: |_| Ops::default().adds(6, LEVEL),
};

/// What eight curves need for each division.
pub(super) const SPLIT: Piece = Piece {
    block: Block::Level,
    meaning: "unit sfarti, a curve divided: for x y w the sums of neighbours, of those, and again \
              (6 additions, W + 13 to W + 15 bits), and the 5 new points projected as the 16 \
              of the patch were, 12 bits wider",
    times: |f| if f.divides() { f.get(C::LevelSplits) } else { 0 },
    once: |f| {
        let sums = Ops::default()
            .adds(3, f.w + GUARD + 1)
            .adds(2, f.w + GUARD + 2)
            .adds(1, f.w + GUARD + 3);
        Ops::default().with(3, sums).with(5, point(f.w + GUARD))
    },
};

/// What eight curves need for each of their pieces.
pub(super) const FLAT: Piece = Piece {
    block: Block::Level,
    meaning: "unit sfarti, a piece of eight curves looked at, 8 a patch and 2 a division: three \
              differences from its end; the greater of two areas over pixels, squared, against the \
              chord's squared length; and the greater squared distance against pixels squared, for \
              a chord that is a point",
    times: |f| 8 * f.eight_curves() + if f.divides() { 2 * f.get(C::LevelSplits) } else { 0 },
    once: |_| flat(),
};

fn project(f: Formats) -> Ops {
    Ops::default().with(16, point(f.w))
}

/// A point whose coordinates have `w` bits.
pub(super) fn point(w: u64) -> Ops {
    let pixel = Ops::default().muls(1, w, 15).with(1, quotient(w + 29, w, PIXEL));
    Ops::default().compares(2, w).with(1, reciprocal(w)).with(2, pixel)
}

/// `flat` of `level/subdivide.rs`; 1 / pixels and pixels squared are formed once for a state.
fn flat() -> Ops {
    let difference = PIXEL + 1;
    let product = 2 * difference; // of two differences; a sum of two has a bit more
    let square = Ops::default().muls(2, difference, difference).adds(1, product + 1);
    Ops::default()
        .adds(3 * 2, difference)
        .with(2, square) // areas: a cross product is as dear as a square
        .compares(1, product + 1)
        .with(1, quotient(product + 1, TOLERANCE, DIFFERENCE))
        .muls(1, DIFFERENCE, DIFFERENCE)
        .with(3, square) // of the chord, and of both distances
        .compares(3, product + 1) // flat; the greater distance; within pixels
}

fn flatness() -> Ops {
    let square = 2 * DIFFERENCE;
    let differences = Ops::default()
        .adds(16 * 2 * 2, DIFFERENCE) // p + r - 2 q
        .adds(9 * 2 * 3, DIFFERENCE) // a - b - c + d
        .muls(25 * 2, DIFFERENCE, DIFFERENCE)
        .adds(25, square)
        // Two of each line, four lines of each direction, nine of the twist.
        .compares(8 + 2 * 3 + 8, square);
    // Of four edges, along u and v, and of the twist, each with its slack.
    let lengths = Ops::default().with(7, root(DIFFERENCE)).adds(7, DIFFERENCE);
    // n = sqrt(3/4 M / d) of the edges and of both directions.
    let level = Ops::default().adds(1, DIFFERENCE + 2).muls(1, DIFFERENCE + 2, TOLERANCE);
    let levels = Ops::default().with(6, level.with(1, root(LEVEL)));
    // Where n and m start: the greatest of two edges and the direction's own, within min and max.
    let starts = Ops::default().compares(2 * (2 + 2), ASKED);
    differences.with(1, lengths).with(1, levels).with(1, starts).with(1, bound())
}

/// 6 Muu m m + 18 Muv n m + 6 Mvv n n, and both levels raised by it.
fn bound() -> Ops {
    let (squares, term) = (2 * LEVEL, 2 * LEVEL + DIFFERENCE + 5);
    let products = Ops::default().muls(3, LEVEL, LEVEL).muls(3, squares, DIFFERENCE);
    let sum = products.adds(3 + 2, term); // 3 x, 9 x, 3 x, and both sums
    let raised = Ops::default()
        .muls(1, squares, TOLERANCE)
        .with(1, reciprocal(squares))
        .with(1, quotient(term, squares, squares))
        .with(1, root(LEVEL))
        .compares(1, LEVEL);
    sum.with(2, raised)
}

fn edge_length() -> Ops {
    let difference = PIXEL + 1;
    let segment = Ops::default()
        .adds(2, difference)
        .muls(2, difference, difference)
        .adds(1, 2 * difference)
        .with(1, root(difference));
    let line =
        Ops::default().with(3, segment).adds(2, difference + 2).muls(1, difference + 2, TOLERANCE);
    Ops::default().with(8, line).compares(2 * 3, ASKED)
}
