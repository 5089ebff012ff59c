//! A tessellation pattern by itself: parameters and triangles, no surface.

use rtl_model::patch::{Level, Levels, ONE, Triangle};
use rtl_model::place::{Numbering, Parameters, Placement};
use rtl_model::stitch;

/// A pattern on the unit square.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// u and v in U1.16: the boundary counter-clockwise from (0, 0), then the interior row by row.
    pub points: Vec<[u32; 2]>,
    /// Triangles, counter-clockwise with u right and v up.
    pub triangles: Vec<Triangle>,
}

/// The fractional quad pattern of `hybrid` and `moreton`: levels per whole edge in the order v0,
/// u1, v1, u0; interior levels along u and v, by default the greater of the two edges across.
#[must_use]
pub fn fractional_quad(edges: [Level; 4], interior: [Option<Level>; 2]) -> Pattern {
    let [v0, u1, v1, u0] = edges;
    let interior = [interior[0].unwrap_or(v0.max(v1)), interior[1].unwrap_or(u1.max(u0))];
    let mut placement = Placement::default();
    placement.set(&Levels { edges, interior });
    let starts = placement.starts();
    let mut points = vec![[0; 2]; placement.vertices()];
    for (edge, list) in placement.edges.iter().enumerate() {
        for (k, &t) in list.parameters().iter().enumerate() {
            points[placement.boundary_vertex(&starts, edge, k)] =
                [[t, 0], [ONE, t], [t, ONE], [0, t]][edge];
        }
    }
    let inner = |list: &[u32]| list[1..list.len() - 1].to_vec();
    let us = inner(placement.u.parameters());
    let rows = inner(placement.v.parameters());
    let grid = rows.iter().flat_map(|&v| us.iter().map(move |&u| [u, v]));
    for (point, parameters) in points[starts[4]..].iter_mut().zip(grid) {
        *point = parameters;
    }
    let mut triangles = Vec::new();
    stitch::accept(placement.segments(), &mut triangles);
    Pattern { points, triangles }
}
