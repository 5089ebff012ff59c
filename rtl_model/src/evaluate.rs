//! Evaluate: control points and parameter lists in, the positions of all vertices out.
//!
//! Every boundary vertex comes from a run along its own edge, from its own four control points (Moreton 2001: guard
//! curves; and the corners are the corner points). Interior rows come from curves along u whose four control points
//! are evaluated along v on the four columns of the net and rounded to the position format.
//!
//! ```text
//!   v1 ●──●──●──●──●   ● boundary: one run from each corner of each edge
//!      │           │   ○ interior: a run from each end of each row
//!      ●  ○  ○  ○  ●   □ a row's control points: runs along the net's columns
//!      │□───□───□──│□
//!   v0 ●──●──●──●──●
//! ```
//!
//! `forward` evaluates at t = k R / 2^32, of which the reported parameter is the nearest U1.16; `de_casteljau` at the
//! reported parameter itself. An edge has one evaluator for its positions, in every mode.

mod casteljau;
mod forward;
mod normal;

use crate::number::{Format, Modal, OverflowMode, Rounding, RoundingMode, dispatch};
use crate::patch::{EDGES, ONE, Patch, Point, Vertex};
use crate::place::{List, Placement};
use serde::{Deserialize, Serialize};

pub use casteljau::curve_point;
pub use normal::{Plane, tangent_plane};

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

/// The block and its row store.
#[derive(Clone, Debug)]
pub struct Evaluate {
    settings: Settings,
    /// Control points of the interior rows.
    rows: Vec<[Point; 4]>,
}

impl Evaluate {
    /// A block of these settings.
    ///
    /// # Panics
    /// When width + guard + 3 exceeds 63 bits.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let bits = settings.position.width + settings.guard + 3;
        assert!(bits <= 63, "an accumulator of {bits} bits does not fit 63");
        Self { settings, rows: Vec::new() }
    }

    /// Evaluates the vertices of a patch into `out`, in the order of the placement's numbering.
    pub fn accept(&mut self, patch: &Patch, placement: &Placement, out: &mut Vec<Vertex>) -> Cost {
        let Settings { rounding, overflow, .. } = self.settings;
        // Vertices of the patch before are overwritten, not cleared.
        out.resize(placement.vertices(), Vertex::default());
        dispatch(rounding, overflow, Work { block: self, points: &patch.points, placement, out })
    }
}

struct Work<'a> {
    block: &'a mut Evaluate,
    points: &'a [Point; 16],
    placement: &'a Placement,
    out: &'a mut [Vertex],
}

impl Modal for Work<'_> {
    type Output = Cost;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> Cost {
        let Self { block, points, placement, out } = self;
        let settings = block.settings;
        let mut cost = Cost::default();
        boundary::<R, O>(&settings, points, placement, out, &mut cost);
        interior::<R, O>(block, points, placement, out, &mut cost);
        cost
    }
}

/// The four edges, each a function of its own points alone.
fn boundary<R: RoundingMode, O: OverflowMode>(
    settings: &Settings,
    points: &[Point; 16],
    placement: &Placement,
    out: &mut [Vertex],
    cost: &mut Cost,
) {
    let starts = placement.starts();
    let forward = settings.scheme != Scheme::DeCasteljau;
    for (edge, list) in placement.edges.iter().enumerate() {
        let curve = EDGES[edge].map(|k| points[k]);
        let place = |k| placement.boundary_vertex(&starts, edge, k);
        let runner = Runner::new::<O>(settings, forward, &curve);
        runner.run::<R, O>(&curve, list, cost, |k, point| out[place(k)].position = point);
        for (k, &t) in list.parameters().iter().enumerate() {
            let vertex = &mut out[place(k)];
            [vertex.u, vertex.v] = [[t, 0], [ONE, t], [t, ONE], [0, t]][edge];
        }
    }
    cost.invocations += placement.boundary() as u64;
}

/// The interior, row by row.
fn interior<R: RoundingMode, O: OverflowMode>(
    block: &mut Evaluate,
    points: &[Point; 16],
    placement: &Placement,
    out: &mut [Vertex],
    cost: &mut Cost,
) {
    let [columns, rows] = placement.interior();
    if columns == 0 || rows == 0 {
        return; // level 1: two triangles and no interior
    }
    let settings = block.settings;
    let forward = settings.scheme == Scheme::Forward;
    block.rows.resize(rows, [[0; 4]; 4]);
    for column in 0..4 {
        let curve = [0, 4, 8, 12].map(|row| points[row + column]);
        let runner = Runner::new::<O>(&settings, forward, &curve);
        runner.run::<R, O>(&curve, &placement.v, cost, |k, point| {
            if let Some(row) = block.rows.get_mut(k.wrapping_sub(1)) {
                row[column] = point;
            }
        });
    }
    let (us, vs) = (placement.u.parameters(), placement.v.parameters());
    let interior = &mut out[placement.boundary()..];
    for ((row, curve), &v) in interior.chunks_exact_mut(columns).zip(&block.rows).zip(&vs[1..]) {
        let runner = Runner::new::<O>(&settings, forward, curve);
        runner.run::<R, O>(curve, &placement.u, cost, |k, point| {
            if let Some(vertex) = row.get_mut(k.wrapping_sub(1)) {
                vertex.position = point;
            }
        });
        for (vertex, &u) in row.iter_mut().zip(&us[1..]) {
            [vertex.u, vertex.v] = [u, v];
        }
    }
    cost.invocations += (4 * rows + columns * rows) as u64;
}

/// How one curve is run.
#[derive(Clone, Copy)]
struct Runner<'a> {
    settings: &'a Settings,
    forward: bool,
    /// Whether an output might not fit.
    checked: bool,
}

impl<'a> Runner<'a> {
    fn new<O: OverflowMode>(settings: &'a Settings, forward: bool, curve: &[Point; 4]) -> Self {
        // The curve lies in the hull of its points; what rounding adds is bounded by `forward::error_max`.
        let largest = curve.iter().flatten().map(|c| c.abs()).max().unwrap_or(0);
        let room = settings.position.max() - forward::error_max(settings.guard);
        Self { settings, forward, checked: largest > room }
    }

    /// Hands out the points of the curve by their entry in the list, in any order.
    #[inline(always)]
    fn run<R: RoundingMode, O: OverflowMode>(
        &self,
        curve: &[Point; 4],
        list: &List,
        cost: &mut Cost,
        mut put: impl FnMut(usize, Point),
    ) {
        let (checked, format) = (self.checked, self.settings.position);
        let mut overflows = 0;
        let fitted = |k: usize, point: Point| {
            if !checked {
                return put(k, point);
            }
            put(
                k,
                point.map(|c| {
                    let (c, overflowed) = format.fit::<O>(c.into());
                    overflows += u64::from(overflowed);
                    c
                }),
            );
        };
        let (curves, steps) = if self.forward {
            forward::run::<R>(curve, list, self.settings.guard, fitted)
        } else {
            casteljau::run::<R>(curve, list, fitted)
        };
        cost.curves += curves;
        cost.steps += steps;
        cost.overflows += overflows;
    }
}
