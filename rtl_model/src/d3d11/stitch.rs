//! Stitch: the segments of a ring's sides in, the numbers of the triangles between it and the ring
//! inside it out, side by side in the order of the points.
//!
//! The outermost strip is a transition between each edge and the inner partition (`walk`); further
//! in, each side of a ring has two segments more than the one inside it, and diagonals that lean
//! towards the middle:
//!
//! ```text
//!   outer  0────1────2────3────4────5     one triangle at either end, and between them a pair
//!           ╲   │╲   │╲   │   ╱│   ╱      for each segment of the inner row, of which the middle
//!             ╲ │  ╲ │  ╲ │ ╱  │ ╱        one is of the first half's kind
//!   inner       0────1────2────3
//! ```
//!
//! A ring's points are numbered one after another, so a row is a first number and a direction, and
//! the last side's last point is the ring's first one. An even axis ends in a point or a line whose
//! far side is walked backwards; an odd one in a triangle (tri) or a strip (quad).
//!
//! Triangles are written by the handful (`group`): what is written too many is overwritten by what
//! follows.

use super::group::{GROUPS, Group, Next, PAIRS, STEPS};
use super::walk::{self, Walk};

/// Indices after the last one that may be written: their values mean nothing.
pub(super) const SLACK: usize = 128;

/// Groups of a walk that are made before it is asked whether it ends, and their numbers.
const BLOCK: usize = 4;
const BLOCK_NUMBERS: usize = 3 * STEPS * BLOCK;

/// Why a handful of numbers can be written.
const ROOM: &str = "there are more places than numbers";

/// Marks the numbers of the inner row while a ring is closed: 4225 points leave bit 15 free.
const INNER: u16 = 1 << 15;

/// From a row's point to its next one: 1, or -1.
const UP: u16 = 1;
const DOWN: u16 = u16::MAX;

/// A row of points: the number of the first, and from each to the next [`UP`] or [`DOWN`].
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
pub(super) struct Stitch<'a, const CLOCKWISE: bool> {
    /// Has [`SLACK`] places more than numbers.
    pub(super) out: &'a mut [u16],
    /// How many are written.
    pub(super) at: usize,
}

/// A ring of points: the number of its first, and the segments of its sides.
#[derive(Clone, Copy)]
pub(super) struct Ring<const SIDES: usize> {
    pub(super) first: usize,
    pub(super) segments: [usize; SIDES],
}

impl<const SIDES: usize> Ring<SIDES> {
    fn count(&self) -> usize {
        self.segments.iter().sum()
    }

    /// The number that the point after the last would have.
    fn end(&self) -> usize {
        self.first + self.count()
    }

    /// The ring inside, where there is one, of the inner partition.
    fn inside(&self) -> Self {
        Self { first: self.end(), segments: self.segments.map(|segments| segments - 2) }
    }

    /// Whether the inner partition ends here, in a line or a point.
    fn is_line(&self) -> bool {
        self.segments.contains(&0)
    }

    /// Whether there are triangles inside, but no ring.
    fn is_centre(&self) -> bool {
        self.segments.contains(&1)
    }

    /// The row of a side whose first point is `passed` points from the ring's first.
    fn row(&self, passed: usize) -> Row {
        let length = *self.segments.iter().max().expect("a ring has sides");
        if self.is_line() && passed >= length {
            // There and back again.
            Row { first: (self.first + 2 * length - passed) as u16, step: DOWN }
        } else {
            Row { first: (self.first + passed) as u16, step: UP }
        }
    }
}

impl<const CLOCKWISE: bool> Stitch<'_, CLOCKWISE> {
    /// Everything inside a ring, with no table.
    pub(super) fn inside_by_strips<const SIDES: usize>(&mut self, ring: Ring<SIDES>) {
        let mut left = Some(ring);
        while let Some(ring) = left {
            left = self.ring(ring);
        }
    }

    /// The strips of a ring; the ring inside it. Where there is none, what there is instead.
    #[inline(always)]
    pub(super) fn ring<const SIDES: usize>(&mut self, ring: Ring<SIDES>) -> Option<Ring<SIDES>> {
        if ring.is_line() {
            return None;
        }
        if ring.is_centre() {
            self.centre(&ring);
            return None;
        }
        let inside = ring.inside();
        if inside.is_line() {
            self.strips_on_line(&ring, &inside);
        } else {
            self.strips(&ring, &inside);
        }
        Some(inside)
    }

    /// The strips between the edges and the ring inside, which it returns; `inner` are the segments
    /// of the inner partition along each side.
    #[inline(always)]
    pub(super) fn transitions<const SIDES: usize>(
        &mut self,
        edges: &Ring<SIDES>,
        inner: [usize; SIDES],
    ) -> Ring<SIDES> {
        let ring = Ring { first: edges.count(), segments: inner.map(|segments| segments - 2) };
        let (mut outside, mut inside, mut begin) = (0, 0, 0);
        for (side, &inner) in inner.iter().enumerate() {
            let mut row = ring.row(inside);
            if side == SIDES - 1 {
                row.first |= INNER;
                begin = self.at;
            }
            let walk = walk::walk(inner, edges.segments[side]);
            self.transition(outside as u16, row, walk);
            outside += edges.segments[side];
            inside += ring.segments[side];
        }
        self.close(begin, &ring);
        ring
    }

    /// Lets the last transition, from index `begin` on, end at the first points of the edges and of
    /// the ring.
    #[inline(always)]
    fn close<const SIDES: usize>(&mut self, begin: usize, ring: &Ring<SIDES>) {
        let outer_end = ring.first as u16;
        // A line is not closed, and never comes to its end: the way back ends at its first point.
        let (inner_first, inner_end) = (ring.first as u16, INNER | ring.end() as u16);
        let mut at = begin;
        while at < self.at {
            let block: &mut [u16; 64] = self.out[at..].first_chunk_mut().expect(ROOM);
            for number in block {
                let inner = if *number == inner_end { inner_first } else { *number & !INNER };
                *number = if *number == outer_end { 0 } else { inner };
            }
            at += 64;
        }
    }

    /// The strip between an edge and the outermost ring.
    #[inline(always)]
    fn transition(&mut self, outer: u16, inner: Row, walk: Walk) {
        let groups = &GROUPS[usize::from(CLOCKWISE)][usize::from(inner.step == DOWN)].walk;
        let (begin, end) = (self.at, self.at + 3 * walk.count);
        let (mut steps, mut next) = (walk.steps, Next::new(outer, inner.first));
        loop {
            let mut now = steps as u32; // BLOCK * STEPS of them
            let out: &mut [u16; BLOCK_NUMBERS + 1] =
                self.out[self.at..].first_chunk_mut().expect(ROOM);
            for k in 0..BLOCK {
                let group = &groups[now as usize % (1 << STEPS)];
                let (out, _) = out[3 * STEPS * k..].as_chunks_mut();
                group.write(&mut next, out.first_chunk_mut().expect(ROOM));
                now >>= STEPS;
            }
            self.at += BLOCK_NUMBERS;
            if self.at >= end {
                break;
            }
            steps >>= BLOCK * STEPS;
        }
        self.at = end;
        // The one across the middle begins at the inner row; where there is none, what is turned
        // means nothing.
        let middle = walk.outer_middle.map_or(end, |k| begin + 3 * k);
        let [a, b, c] = *self.triangle(middle);
        *self.triangle(middle) = if CLOCKWISE { [c, a, b] } else { [b, c, a] };
    }

    /// The strips of a ring around another one.
    #[inline(always)]
    fn strips<const SIDES: usize>(&mut self, outer: &Ring<SIDES>, inner: &Ring<SIDES>) {
        let (mut o, mut i) = (outer.first as u16, inner.first as u16);
        for &segments in &outer.segments {
            self.strip(o, Row { first: i, step: UP }, segments);
            o += segments as u16;
            i += segments as u16 - 2;
        }
        // The last side ends at the first points.
        let segments = outer.segments[SIDES - 1];
        let [outer, inner] = [outer.first as u16, inner.first as u16];
        let (at, o, i) = (self.at, o - 1, i - 1); // the points before those
        *self.triangle(at - 3) = turned::<CLOCKWISE>([o, inner, outer]);
        *self.triangle(at - 6) =
            turned::<CLOCKWISE>(if segments == 3 { [o - 1, inner, o] } else { [i, inner, o] });
        if segments == 3 {
            *self.triangle(at - 9) = turned::<CLOCKWISE>([o - 1, i, inner]);
        }
    }

    /// The strips of a ring around a line or a point.
    fn strips_on_line<const SIDES: usize>(&mut self, outer: &Ring<SIDES>, inner: &Ring<SIDES>) {
        let (mut o, mut inside) = (outer.first as u16, 0);
        for &segments in &outer.segments {
            self.strip(o, inner.row(inside), segments);
            o += segments as u16;
            inside += segments - 2;
        }
        let at = self.at;
        *self.triangle(at - 3) =
            turned::<CLOCKWISE>([o - 1, inner.first as u16, outer.first as u16]);
    }

    /// The strip between a side of `segments`, 2 to 62, and one of two less.
    #[inline(always)]
    fn strip(&mut self, outer: u16, inner: Row, segments: usize) {
        let groups = &GROUPS[usize::from(CLOCKWISE)][usize::from(inner.step == DOWN)];
        let pairs = segments - 2;
        let first = pairs.div_ceil(2);
        let begin = self.at;
        // The first triangle makes the pairs of one half those of a group, three numbers on.
        self.pairs(&groups.first, Next::new(outer, inner.first), begin + 6 * first + 3);
        let next = Next::new(outer + 1 + first as u16, inner.at(first));
        self.pairs(&groups.second, next, begin + 6 * pairs + 3);
        let o = outer + segments as u16;
        self.put([o - 1, inner.at(pairs), o]);
    }

    /// Pairs up to index `end`.
    #[inline(always)]
    fn pairs(&mut self, group: &Group<3>, mut next: Next, end: usize) {
        while self.at < end {
            let (out, _) = self.out[self.at..].as_chunks_mut();
            group.write(&mut next, out.first_chunk_mut().expect(ROOM));
            self.at += 6 * PAIRS;
        }
        self.at = end;
    }

    /// The ring that odd partitions end in: a triangle, or, of a quad, a strip.
    fn centre<const SIDES: usize>(&mut self, ring: &Ring<SIDES>) {
        let (first, last) = (ring.first as u16, ring.end() as u16 - 1);
        if SIDES == 3 {
            return self.put([first, first + 2, first + 1]);
        }
        let [tall, wide] = [ring.segments[0], ring.segments[1]];
        if wide > tall {
            // From the left: the upper side begins at the first point, the lower at the second.
            let upper = |k: u16| if k == 0 { first } else { last + 1 - k };
            for k in 0..wide as u16 {
                self.put([upper(k), first + k + 2, first + k + 1]);
                self.put([upper(k), upper(k + 1), first + k + 2]);
            }
            return;
        }
        for k in 0..tall as u16 {
            let [[a, b], [c, d]] = [[first + k, first + k + 1], [last - k, last - k - 1]];
            if tall.is_multiple_of(2) {
                self.put([c, b, a]);
                self.put([c, d, b]);
            } else if usize::from(k) == tall / 2 {
                self.put([a, c, d]);
                self.put([a, d, b]);
            } else {
                self.put([a, c, b]);
                self.put([c, d, b]);
            }
        }
    }

    /// The next `N` places.
    #[inline(always)]
    fn next<const N: usize>(&mut self) -> &mut [u16; N] {
        self.out[self.at..].first_chunk_mut().expect(ROOM)
    }

    #[inline(always)]
    fn triangle(&mut self, at: usize) -> &mut [u16; 3] {
        self.out[at..].first_chunk_mut().expect("a triangle that was made")
    }

    #[inline(always)]
    pub(super) fn put(&mut self, triangle: [u16; 3]) {
        *self.next() = turned::<CLOCKWISE>(triangle);
        self.at += 3;
    }
}

/// A triangle that is given counter-clockwise.
fn turned<const CLOCKWISE: bool>([a, b, c]: [u16; 3]) -> [u16; 3] {
    if CLOCKWISE { [a, c, b] } else { [a, b, c] }
}
