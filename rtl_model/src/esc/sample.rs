//! Sample: a place of the grid in, the point of the surface there out.
//!
//! Three datapaths, by where the place lies:
//!
//! - a corner of the patch is its control point, copied;
//! - the patch's boundary, [`Boundary::Symmetric`]: a function of that edge's four control points,
//!   by Horner's rule from the nearer corner, so at t <= 1/2; at 1/2 ((P0 + P3) + 3 (P1 + P2)) / 8.
//!   The edge read from its other end gives the same bits, whichever patch reads it;
//! - inside, and under [`Boundary::Plain`] on the boundary too: `[U] [NBM] [V]`, Horner's rule
//!   along v for each power of u, then along u. Coarse edges inside need no symmetric form: a
//!   sample there is a function of the patch and its place, the same for both coarse triangles.
//!
//! A coordinate is rounded to its format once, at the end. What a row of samples shares, the curve
//! of constant v, is kept here for speed; the hardware's count is fifteen multiply-adds a
//! coordinate.

use super::path::Datapath;
use super::pattern::{LINES_MAX, Parameters, Place};
use super::power::{Cubic, Net, Parameter};
use super::{Boundary, Corner, Levels, crack, slot};
use crate::number::{Divisor, OverflowMode, RoundingMode};
use crate::patch::{EDGES, Point};

/// What of a patch's levels a sample depends on.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) levels: Levels,
    /// For each edge of the patch: the line of its own level that each of the interior's carries;
    /// 0 for those between, which are never inserted.
    along: [[u8; LINES_MAX]; 4],
}

impl Grid {
    pub(super) fn new(levels: Levels) -> Self {
        let mut along = [[0; LINES_MAX]; 4];
        let inner = levels.interior + 1;
        for (lines, &level) in along.iter_mut().zip(&levels.edges) {
            for third in 0..3 {
                for k in 0..=level {
                    let carrier = if k == 0 { 0 } else { slot(k, level, levels.interior) };
                    lines[usize::from(third * inner + carrier)] = third * (level + 1) + k;
                }
            }
            lines[usize::from(3 * inner)] = 3 * (level + 1);
        }
        Self { levels, along }
    }

    /// The number of the last line: lines are 0 to 3 R.
    pub(super) fn last(&self) -> u8 {
        3 * (self.levels.interior + 1)
    }

    /// Whether a place is on the boundary and no corner.
    pub(super) fn is_inside_an_edge(&self, place: Place) -> bool {
        let outer = |line| line == 0 || line == self.last();
        outer(place[0]) != outer(place[1])
    }

    /// The lines' level and number, along u and along v, at a place.
    pub(super) fn lines(&self, [i, j]: Place) -> [(u8, u8); 2] {
        let inner = self.levels.interior;
        match self.edge([i, j]) {
            Some((edge, level, line)) if edge % 2 == 0 => [(level, line), (inner, j)],
            Some((_, level, line)) => [(inner, i), (level, line)],
            None => [(inner, i), (inner, j)],
        }
    }

    /// The edge of the patch on which a place lies, its level, and the line of that level.
    fn edge(&self, [i, j]: Place) -> Option<(usize, u8, u8)> {
        let last = self.last();
        let (edge, carrier) = match (i, j) {
            (_, 0) => (0, i),
            (_, j) if j == last => (2, i),
            (0, _) => (3, j),
            (i, _) if i == last => (1, j),
            _ => return None,
        };
        Some((edge, self.levels.edges[edge], self.along[edge][usize::from(carrier)]))
    }
}

/// One net in its registers.
#[derive(Clone, Debug)]
pub(super) struct Sampler {
    path: Datapath,
    points: [Point; 16],
    net: Net,
    /// Each edge from either end.
    halves: [[Cubic; 2]; 4],
    /// Curves of constant v, by line of the grid, and which of them are there.
    rows: Vec<Cubic>,
    known: u64,
    /// Points by place, of the patch whose count is beside them.
    kept: Vec<(u32, Point)>,
    /// Patches taken.
    count: u32,
    /// Coordinates that did not fit.
    pub(super) overflows: u64,
}

impl Sampler {
    pub(super) fn new(path: Datapath) -> Self {
        Self {
            path,
            points: [[0; 4]; 16],
            net: Net::ZERO,
            halves: [[Cubic::ZERO; 2]; 4],
            rows: vec![Cubic::ZERO; LINES_MAX],
            known: 0,
            kept: vec![(0, [0; 4]); LINES_MAX * LINES_MAX],
            count: 0,
            overflows: 0,
        }
    }

    /// Takes the control points of a patch.
    pub(super) fn load(&mut self, points: &[Point; 16]) {
        let guard = self.path.guard;
        self.points = *points;
        self.net = Net::of(points, guard);
        self.halves = EDGES.map(|edge| {
            let [a, b, c, d] = edge.map(|k| points[k]);
            [[a, b, c, d], [d, c, b, a]].map(|curve| Cubic::of(curve).guarded(guard))
        });
        self.known = 0;
        self.overflows = 0;
        if self.count == u32::MAX {
            self.kept.fill((0, [0; 4]));
            self.count = 0;
        }
        self.count += 1;
    }

    /// The point at a place of the grid, evaluated once a patch.
    #[inline]
    pub(super) fn fetch<R: RoundingMode, O: OverflowMode, const NARROW: bool>(
        &mut self,
        grid: &Grid,
        parameters: &Parameters,
        place: Place,
    ) -> Point {
        let index = usize::from(place[1]) * LINES_MAX + usize::from(place[0]);
        if self.kept[index].0 != self.count {
            self.kept[index] = (self.count, self.at::<R, O, NARROW>(grid, parameters, place));
        }
        self.kept[index].1
    }

    /// The point at a place of the grid.
    #[inline]
    pub(super) fn at<R: RoundingMode, O: OverflowMode, const NARROW: bool>(
        &mut self,
        grid: &Grid,
        parameters: &Parameters,
        place: Place,
    ) -> Point {
        let last = grid.last();
        let [u, v] = place;
        if (u == 0 || u == last) && (v == 0 || v == last) {
            return self.points[usize::from(u / last * 3 + v / last * 12)];
        }
        if self.path.boundary == Boundary::Symmetric
            && let Some((edge, level, line)) = grid.edge(place)
        {
            return self.half::<R, O, NARROW>(parameters, edge, level, line);
        }
        let lines = grid.lines(place);
        let [u, v] = lines.map(|(level, line)| self.parameter(parameters, level, line));
        let [_, (level, line)] = lines;
        let row = if level == grid.levels.interior {
            if self.known >> line & 1 == 0 {
                self.known |= 1 << line;
                self.rows[usize::from(line)] = self.net.row::<R, NARROW>(v);
            }
            &self.rows[usize::from(line)]
        } else {
            &self.net.row::<R, NARROW>(v) // a vertex of an edge with a level of its own
        };
        let point = row.at::<R, NARROW>(u);
        self.output::<R, O>(point, self.path.guard)
    }

    fn parameter(&self, parameters: &Parameters, level: u8, line: u8) -> Parameter {
        Parameter { fx: parameters.fx(level, line), bits: self.path.bits }
    }

    /// A boundary point, from the corner that is nearer to it.
    fn half<R: RoundingMode, O: OverflowMode, const NARROW: bool>(
        &mut self,
        parameters: &Parameters,
        edge: usize,
        level: u8,
        line: u8,
    ) -> Point {
        let last = 3 * (level + 1);
        if 2 * line == last {
            let [a, b, c, d] = EDGES[edge].map(|k| self.points[k]);
            let sum: Point = std::array::from_fn(|k| (a[k] + d[k]) + 3 * (b[k] + c[k]));
            return self.output::<R, O>(sum, 3);
        }
        let far = 2 * line > last;
        let line = if far { last - line } else { line };
        let t = self.parameter(parameters, level, line);
        let point = self.halves[edge][usize::from(far)].at::<R, NARROW>(t);
        self.output::<R, O>(point, self.path.guard)
    }

    #[inline(always)]
    fn output<R: RoundingMode, O: OverflowMode>(&mut self, register: Point, bits: u32) -> Point {
        let (point, overflows) = self.path.output::<R, O>(register, bits);
        self.overflows += overflows;
        point
    }

    /// How many of the places, all on the boundary and no corner, a neighbour could evaluate
    /// otherwise.
    pub(super) fn cracks<R: RoundingMode, O: OverflowMode, const NARROW: bool>(
        &self,
        grid: &Grid,
        parameters: &Parameters,
        places: impl Iterator<Item = Place>,
    ) -> u64 {
        let fx = |(level, line)| parameters.fx(level, line);
        let sites = places.map(|place| grid.lines(place).map(fx));
        crack::count::<R, O, NARROW>(&self.path, &self.points, sites)
    }

    /// The control point of the net at a corner of cells.
    pub(super) fn control(&self, [u, v]: Corner) -> Point {
        self.points[usize::from(4 * v + u)]
    }
}

/// Points on a line between two others, at equal steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    from: Point,
    to: Point,
    segments: i64,
    divisor: Divisor,
}

impl Line {
    pub(super) fn new(from: Point, to: Point, segments: u8) -> Self {
        Self { from, to, segments: segments.into(), divisor: Divisor::new(segments.into()) }
    }

    /// Point `k`, rounded once: the same if the ends are swapped.
    #[inline]
    pub(super) fn at<R: RoundingMode>(&self, k: u8) -> Point {
        let (near, far) = (i64::from(k), self.segments - i64::from(k));
        let mut point = [0; 4];
        for (c, (from, to)) in point.iter_mut().zip(self.from.iter().zip(&self.to)) {
            // W + 4 bits over 5; the quotient is a coordinate, 48 bits at most
            *c = self.divisor.divide::<R>(from * far + to * near, 1 << 48);
        }
        point
    }
}
