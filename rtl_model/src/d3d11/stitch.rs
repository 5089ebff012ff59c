//! Stitch: the counts of a pattern's factors in, its indices out.
//!
//! Ring by ring from the outside, side by side in the order of the points. The outermost strip is
//! a transition between each edge and the inner partition (`walk`(super::walk)); further in,
//! each side of a ring has two segments more than the one inside it, and diagonals that point at
//! the corners:
//!
//! ```text
//!   outer  0─────1─────2─────3─────4─────5     one triangle at either end,
//!           ╲   ╱│  ╱  │  ╱  │  ╲  │╲   ╱      a pair for each segment of the inner row:
//!            ╲ ╱ │╱    │╱    │    ╲│ ╲ ╱       the middle one belongs to the first half
//!   inner     0──┴──1──┴──2──┴──3──┘
//! ```
//!
//! A ring's points are numbered one after another, so a row is a first number and a direction, and
//! the last side's last point is the ring's first one. An even axis ends in a point or a line whose
//! far side is walked backwards; an odd one in a triangle (tri) or a strip (quad).
//!
//! Five triangles of a walk, or four pairs of a strip, are written at once: the numbers of a
//! triangle are those of the two rows' points plus constants. What is written too many is
//! overwritten by what follows.

use super::walk::{self, Half, Middle};
use super::{Domain, Factors, Output};

/// Indices after the last one that may be written: their values mean nothing.
pub(super) const SLACK: usize = 32;

/// Marks the numbers of the inner row while a ring is closed: 4225 points leave bit 15 free.
const INNER: u16 = 1 << 15;

/// Writes the indices of the pattern to `out`, which has [`SLACK`] places more than indices.
///
/// # Panics
/// Where triangles are asked of an isoline domain.
pub(super) fn write(factors: &Factors, output: Output, out: &mut [u16]) {
    let count = out.len() - SLACK;
    match output {
        Output::Point => (0..).zip(&mut out[..count]).for_each(|(k, out)| *out = k),
        Output::Line if factors.domain() == Domain::Isoline => lines(factors, &mut out[..count]),
        Output::Line => {
            let (pairs, _) = out[..count].as_chunks_mut();
            (0..).zip(pairs).for_each(|(k, pair)| *pair = [k, k + 1]);
        }
        Output::Cw => Stitch::<true> { out, at: 0 }.pattern(factors),
        Output::Ccw => Stitch::<false> { out, at: 0 }.pattern(factors),
    }
}

fn lines(factors: &Factors, out: &mut [u16]) {
    let points = factors.edge_points(1);
    let lines = out.chunks_exact_mut(2 * (points - 1));
    for (first, line) in (0..).step_by(points).zip(lines) {
        let (pairs, _) = line.as_chunks_mut();
        (first..).zip(pairs).for_each(|(k, pair)| *pair = [k, k + 1]);
    }
}

/// A row of points: the number of the first, and 1 or -1 (as a u16) from each to the next.
#[derive(Clone, Copy)]
struct Row {
    first: u16,
    step: u16,
}

impl Row {
    fn at(self, k: usize) -> u16 {
        self.first.wrapping_add((k as u16).wrapping_mul(self.step))
    }
}

/// Writes triangles, clockwise or counter-clockwise.
struct Stitch<'a, const CLOCKWISE: bool> {
    out: &'a mut [u16],
    at: usize,
}

/// A ring of points: the number of its first, and the segments of its sides.
#[derive(Clone, Copy)]
struct Ring<const SIDES: usize> {
    first: usize,
    segments: [usize; SIDES],
}

impl<const SIDES: usize> Ring<SIDES> {
    fn count(&self) -> usize {
        self.segments.iter().sum()
    }

    /// Whether the inner partition ends here, in a line or a point.
    fn is_line(&self) -> bool {
        self.segments.contains(&0)
    }

    /// The row of a side whose first point is `passed` points from the ring's first.
    fn row(&self, passed: usize) -> Row {
        let length = self.segments.iter().max().expect("a ring has sides");
        if self.is_line() && passed >= *length {
            // There and back again.
            Row { first: (self.first + 2 * length - passed) as u16, step: u16::MAX }
        } else {
            Row { first: (self.first + passed) as u16, step: 1 }
        }
    }
}

impl<const CLOCKWISE: bool> Stitch<'_, CLOCKWISE> {
    fn pattern(&mut self, factors: &Factors) {
        let segments = |edge: usize| factors.edge_points(edge) - 1;
        match (factors.domain(), factors.least()) {
            (Domain::Isoline, _) => panic!("an isoline domain has no triangles"),
            (Domain::Tri, true) => self.put([0, 2, 1]),
            (Domain::Quad, true) => {
                self.put([0, 3, 1]);
                self.put([1, 3, 2]);
            }
            (Domain::Tri, false) => {
                let inner = factors.inner_points(0) - 1;
                let edges = Ring { first: 0, segments: [0, 1, 2].map(segments) };
                if let Some(centre) = self.rings(edges, [inner; 3]) {
                    let first = centre.first as u16;
                    self.put([first, first + 2, first + 1]);
                }
            }
            (Domain::Quad, false) => {
                let [u, v] = [0, 1].map(|axis| factors.inner_points(axis) - 1);
                let edges = Ring { first: 0, segments: [0, 1, 2, 3].map(segments) };
                if let Some(centre) = self.rings(edges, [v, u, v, u]) {
                    self.centre(centre);
                }
            }
        }
    }

    /// All rings from the edges inwards; `inner` are the segments of the inner partition along each
    /// side. The innermost ring, if there is something in it still.
    fn rings<const SIDES: usize>(
        &mut self,
        edges: Ring<SIDES>,
        inner: [usize; SIDES],
    ) -> Option<Ring<SIDES>> {
        let mut outer = edges;
        let mut left = inner;
        loop {
            left = left.map(|segments| segments - 2);
            let ring = Ring { first: outer.first + outer.count(), segments: left };
            let (mut outside, mut inside) = (0, 0);
            for (side, &inner) in inner.iter().enumerate() {
                let begin = self.at;
                let rows = [outer.row(outside), ring.row(inside)];
                let mut marked = rows;
                if side == SIDES - 1 {
                    marked[1].first |= INNER;
                }
                if outer.first == 0 {
                    self.transition(marked, outer.segments[side], inner);
                } else {
                    self.strip(marked, outer.segments[side]);
                }
                if side == SIDES - 1 {
                    self.close(begin, &outer, &ring);
                }
                outside += outer.segments[side];
                inside += ring.segments[side];
            }
            outer = ring;
            if ring.is_line() {
                return None;
            }
            if ring.segments.contains(&1) {
                return Some(ring);
            }
        }
    }

    /// Lets the ends of the rings' last sides, of which the indices from `begin` on are made, be
    /// their first points.
    fn close<const SIDES: usize>(
        &mut self,
        begin: usize,
        outer: &Ring<SIDES>,
        inner: &Ring<SIDES>,
    ) {
        let outer_end = (outer.first + outer.count()) as u16;
        // A line is not closed: its first point is where the way back ends.
        let inner_end = INNER | (inner.first + inner.count()) as u16;
        for index in &mut self.out[begin..self.at] {
            *index = match *index {
                end if end == outer_end => outer.first as u16,
                end if end == inner_end => inner.first as u16,
                other => other & !INNER,
            };
        }
    }

    /// The strip between an edge of `segments` and the outermost ring; `inner` are the segments of
    /// the inner partition, two more than the ring has.
    fn transition(&mut self, [outer, inner]: [Row; 2], segments: usize, inner_segments: usize) {
        let (half, middle) = walk::walk(inner_segments + 1, segments + 1);
        let [o, i] = [segments / 2, inner_segments / 2 - 1]; // segments of a half
        self.half(half, outer.first, inner);
        let [o, i] = [
            [outer.at(o), outer.at(segments - o)],
            [inner.at(i), inner.at(inner_segments - 2 - i)],
        ];
        match middle {
            Middle::Nothing => {}
            Middle::Inner => self.put([i[0], i[1], o[0]]),
            Middle::Outer => self.put([i[0], o[1], o[0]]),
            Middle::Both => {
                self.put([i[0], i[1], o[0]]);
                self.put([i[1], o[1], o[0]]);
            }
        }
        self.half(half.mirrored(), o[1], Row { first: i[1], ..inner });
    }

    fn half(&mut self, half: Half, mut outer: u16, mut inner: Row) {
        for k in 0..half.count {
            if half.steps >> k & 1 == 1 {
                let next = inner.at(1);
                self.put([inner.first, next, outer]);
                inner.first = next;
            } else {
                self.put([outer, inner.first, outer + 1]);
                outer += 1;
            }
        }
    }

    /// The strip between a side of `segments` and one of two less.
    fn strip(&mut self, [outer, inner]: [Row; 2], segments: usize) {
        self.put([outer.at(0), inner.at(0), outer.at(1)]);
        let pairs = segments - 2;
        for k in 0..pairs {
            let [a, b, c, d] = [outer.at(k + 1), outer.at(k + 2), inner.at(k), inner.at(k + 1)];
            if 2 * k < pairs {
                self.put([a, c, d]);
                self.put([a, d, b]);
            } else {
                self.put([c, b, a]);
                self.put([c, d, b]);
            }
        }
        self.put([outer.at(segments - 1), inner.at(pairs), outer.at(segments)]);
    }

    /// The strip that an odd axis of a quad ends in: a ring of which two sides have one segment.
    fn centre(&mut self, ring: Ring<4>) {
        let [tall, wide, ..] = ring.segments;
        let (first, last) = (ring.first as u16, (ring.first + ring.count() - 1) as u16);
        // The lower side and the upper one, or the left side and the right one.
        let (low, high, length) =
            if wide > tall { (first + 1, last + 1, wide) } else { (first, last, tall) };
        let even = wide > tall || length.is_multiple_of(2);
        for k in 0..length {
            let high = |k: usize| {
                let number = high - k as u16;
                if wide > tall && k == 0 { first } else { number }
            };
            let low = |k: usize| low + k as u16;
            if even {
                self.put([high(k), low(k + 1), low(k)]);
                self.put([high(k), high(k + 1), low(k + 1)]);
            } else if k == length / 2 {
                self.put([low(k), high(k), high(k + 1)]);
                self.put([low(k), high(k + 1), low(k + 1)]);
            } else {
                self.put([low(k), high(k), low(k + 1)]);
                self.put([high(k), high(k + 1), low(k + 1)]);
            }
        }
    }

    #[inline(always)]
    fn put(&mut self, [a, b, c]: [u16; 3]) {
        self.out[self.at..self.at + 3].copy_from_slice(&if CLOCKWISE {
            [a, c, b]
        } else {
            [a, b, c]
        });
        self.at += 3;
    }
}
