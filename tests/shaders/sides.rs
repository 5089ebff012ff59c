//! Sides: the ways in which a patch may have an edge.

use rtl_model::patch::{EDGES, ONE};

/// An edge of a patch: 0..4 for v0, u1, v1, u0; and whether it is walked from its far end.
pub(crate) type Side = (usize, bool);

pub(crate) const SIDES: [Side; 8] = [
    (0, false),
    (0, true),
    (1, false),
    (1, true),
    (2, false),
    (2, true),
    (3, false),
    (3, true), //
];

/// The patch with `curve` on one of its sides.
pub(crate) fn with_edge<P: Copy>(patch: &[P; 16], curve: &[P; 4], (edge, back): Side) -> [P; 16] {
    let mut points = *patch;
    for (k, &p) in curve.iter().enumerate() {
        points[EDGES[edge][if back { 3 - k } else { k }]] = p;
    }
    points
}

/// Where on the patch the curve on that side is at t.
pub(crate) fn site((edge, back): Side, t: u32) -> [u32; 2] {
    let t = if back { ONE - t } else { t };
    [[t, 0], [ONE, t], [t, ONE], [0, t]][edge]
}

/// All symmetries of a patch by turns of a quarter and a flip, each with where it has `[u, v]`.
pub(crate) fn turns<P: Copy>(points: &[P; 16], at: [u32; 2]) -> Vec<([P; 16], [u32; 2])> {
    let quarter = |p: &[P; 16], [u, v]: [u32; 2]| {
        // The row i from below is the column i from the right.
        let turned = std::array::from_fn(|k| p[4 * (k % 4) + (3 - k / 4)]);
        (turned, [v, ONE - u])
    };
    let flipped = std::array::from_fn(|k| points[4 * (k / 4) + (3 - k % 4)]);
    let mut all = vec![(*points, at), (flipped, [ONE - at[0], at[1]])];
    for k in 0..6 {
        let (p, at) = all[k];
        all.push(quarter(&p, at));
    }
    all
}
