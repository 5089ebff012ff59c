//! Evaluate: control points and parameter lists in, the positions of all vertices out.
//!
//! Every boundary vertex comes from a run along its own edge, from its own four control points
//! (Moreton 2001: guard curves; and the corners are the corner points). Interior rows come from
//! curves along u whose four control points are evaluated along v on the four columns of the net
//! and rounded to the position format.
//!
//! ```text
//!   v1 ●──●──●──●──●   ● boundary: one run from each corner of each edge
//!      │           │   ○ interior: a run from each end of each row
//!      ●  ○  ○  ○  ●   □ a row's control points: runs along the net's columns
//!      │□───□───□──│□
//!   v0 ●──●──●──●──●
//! ```
//!
//! `forward` evaluates at t = k R / 2^32, of which the reported parameter is the nearest U1.16;
//! `de_casteljau` at the reported parameter itself. An edge has one evaluator for its positions, in
//! every mode.

mod casteljau;
mod forward;
mod normal;
mod schedule;

use crate::number::{Format, Modal, OverflowMode, Rounding, RoundingMode, dispatch};
use crate::patch::{EDGES, ONE, Patch, Point, Vertex};
use crate::place::{Numbering, Parameters, Placement};
use serde::{Deserialize, Serialize};

pub use casteljau::curve_point;
pub use normal::{Plane, tangent_plane};
pub use schedule::Schedule;

/// How points are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Forward differencing in half-runs, boundary and interior.
    Forward,
    /// Forward differencing on the boundary, de Casteljau inside.
    Mixed,
    /// De Casteljau throughout.
    DeCasteljau,
}

/// What the vertex shader gets to light with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Normals {
    /// Nothing.
    Off,
    /// The tangent plane, four coefficients.
    TangentPlane,
}

/// The block's formats and policies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The position format.
    pub position: Format,
    /// Guard bits of the accumulators: position width + guard + 3 <= 63.
    pub guard: u32,
    /// How positions are computed.
    pub scheme: Scheme,
    /// How an output is rounded.
    pub rounding: Rounding,
    /// What an output does that does not fit.
    pub overflow: crate::number::Overflow,
}

/// What a patch cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Points evaluated: vertices, and control points of rows.
    pub invocations: u64,
    /// Half-runs set up.
    pub curves: u64,
    /// Forward-difference steps of a vec4, or de Casteljau curve points.
    pub steps: u64,
    /// Coordinates that did not fit.
    pub overflows: u64,
}

/// The block and its stores.
#[derive(Clone, Debug)]
pub struct Evaluate {
    settings: Settings,
    /// Inner points of the edge or column that runs.
    curve: Vec<Point>,
    /// Control points of the interior rows.
    rows: Vec<[Point; 4]>,
}

/// Where a point is written: a place of its own, or a vertex's position.
trait Slot {
    fn point(&mut self) -> &mut Point;

    #[inline(always)]
    fn put(&mut self, point: Point) {
        *self.point() = point;
    }
}

impl Slot for Point {
    fn point(&mut self) -> &mut Point {
        self
    }
}

impl Slot for Vertex {
    fn point(&mut self) -> &mut Point {
        &mut self.position
    }
}

impl Evaluate {
    /// A block of these settings.
    ///
    /// # Panics
    /// When width + guard + 3 exceeds 63 bits, or guard is 0.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let bits = settings.position.width + settings.guard + 3;
        assert!(bits <= 63, "an accumulator of {bits} bits does not fit 63");
        assert!(settings.guard >= 1, "an accumulator has guard bits");
        Self { settings, curve: Vec::new(), rows: Vec::new() }
    }

    /// Evaluates the vertices of a patch into `out`, in the order of the placement's numbering.
    ///
    /// A list that cannot be walked in equal steps, as a dyadic one cannot, is evaluated by de
    /// Casteljau under every scheme.
    pub fn accept<L: Parameters>(
        &mut self,
        patch: &Patch,
        placement: &Placement<L>,
        out: &mut Vec<Vertex>,
    ) -> Cost {
        let Settings { rounding, overflow, .. } = self.settings;
        // Vertices of the patch before are overwritten, not cleared.
        out.resize(placement.vertices(), Vertex::default());
        let runner = Runner::new(self.settings, &patch.points);
        let Self { curve, rows, .. } = self;
        let points = &patch.points;
        dispatch(rounding, overflow, Work { runner, curve, rows, points, placement, out })
    }
}

struct Work<'a, L> {
    runner: Runner,
    curve: &'a mut Vec<Point>,
    rows: &'a mut Vec<[Point; 4]>,
    points: &'a [Point; 16],
    placement: &'a Placement<L>,
    out: &'a mut [Vertex],
}

impl<L: Parameters> Modal for Work<'_, L> {
    type Output = Cost;

    fn run<R: RoundingMode, O: OverflowMode>(mut self) -> Cost {
        let mut cost = Cost::default();
        self.boundary::<R, O>(&mut cost);
        let [columns, rows] = self.placement.interior();
        if columns > 0 && rows > 0 {
            // Otherwise all triangles stand on the boundary.
            self.row_points::<R, O>(rows, &mut cost);
            self.rows::<R, O>(columns, &mut cost);
        }
        cost
    }
}

impl<L: Parameters> Work<'_, L> {
    /// The four edges, each a function of its own points alone.
    fn boundary<R: RoundingMode, O: OverflowMode>(&mut self, cost: &mut Cost) {
        let Self { runner, curve: inner, points, placement, out, .. } = self;
        let starts = placement.starts();
        let forward = runner.settings.scheme != Scheme::DeCasteljau;
        for (edge, list) in placement.edges.iter().enumerate() {
            let curve = EDGES[edge].map(|k| points[k]);
            inner.resize(list.segments() - 1, [0; 4]);
            runner.run::<R, O, _>(&curve, list, forward, inner, cost);
            let positions = [&curve[..1], inner, &curve[3..]].into_iter().flatten();
            for (k, (&position, &t)) in positions.zip(list.parameters()).enumerate() {
                let [u, v] = [[t, 0], [ONE, t], [t, ONE], [0, t]][edge];
                out[placement.boundary_vertex(&starts, edge, k)] = Vertex { position, u, v };
            }
        }
        cost.invocations += placement.boundary() as u64;
    }

    /// The control points of the interior rows: points of the net's columns.
    fn row_points<R: RoundingMode, O: OverflowMode>(&mut self, rows: usize, cost: &mut Cost) {
        let Self { runner, curve: inner, points, placement, .. } = self;
        let forward = runner.settings.scheme == Scheme::Forward;
        inner.resize(rows, [0; 4]);
        self.rows.resize(rows, [[0; 4]; 4]);
        for column in 0..4 {
            let curve = [0, 4, 8, 12].map(|row| points[row + column]);
            runner.run::<R, O, _>(&curve, &placement.v, forward, inner, cost);
            for (row, &point) in self.rows.iter_mut().zip(inner.iter()) {
                row[column] = point;
            }
        }
        cost.invocations += 4 * rows as u64;
    }

    /// The interior, row by row.
    fn rows<R: RoundingMode, O: OverflowMode>(&mut self, columns: usize, cost: &mut Cost) {
        let Self { runner, rows, placement, out, .. } = self;
        let forward = runner.settings.scheme == Scheme::Forward;
        let (us, vs) = (&placement.u.parameters()[1..], &placement.v.parameters()[1..]);
        let interior = &mut out[placement.boundary()..];
        for ((vertices, curve), &v) in interior.chunks_exact_mut(columns).zip(rows.iter()).zip(vs) {
            runner.run::<R, O, _>(curve, &placement.u, forward, vertices, cost);
            for (vertex, &u) in vertices.iter_mut().zip(us) {
                [vertex.u, vertex.v] = [u, v];
            }
        }
        cost.invocations += (columns * rows.len()) as u64;
    }
}

/// Runs one curve after another.
struct Runner {
    settings: Settings,
    /// Whether an output of this patch might not fit.
    checked: bool,
}

impl Runner {
    fn new(settings: Settings, points: &[Point; 16]) -> Self {
        // All curves lie in the hull of the control points, rows within one rounding error more:
        // mostly all fits.
        let largest = points.iter().flatten().map(|c| c.abs()).max().unwrap_or(0);
        let error = 2 * forward::error_max(settings.guard);
        Self { settings, checked: largest > settings.position.max() - error }
    }

    /// Evaluates a curve at the inner entries of a list.
    #[inline(always)]
    fn run<R: RoundingMode, O: OverflowMode, S: Slot>(
        &self,
        curve: &[Point; 4],
        list: &impl Parameters,
        forward: bool,
        out: &mut [S],
        cost: &mut Cost,
    ) {
        let Settings { position, guard, .. } = self.settings;
        let (curves, steps) = match list.fractional() {
            Some(list) if forward => forward::run::<R, S>(curve, list, guard, out),
            _ => casteljau::run::<R, S>(curve, list.parameters(), out),
        };
        cost.curves += curves;
        cost.steps += steps;
        if self.checked {
            for c in out.iter_mut().flat_map(|slot| slot.point()) {
                let (fitted, overflowed) = position.fit::<O>(*c);
                *c = fitted;
                cost.overflows += u64::from(overflowed);
            }
        }
    }
}
