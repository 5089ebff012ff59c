//! Elephant: a stand-in for the model of 811 patches that Concheiro et al. 2014 measure with and
//! that is not to be found; as many patches, of which some are large and smooth and others small
//! and bent.
//!
//! ```text
//!   part    pieces  patches each        part    pieces  patches each
//!   body       1      20 x 16           ears       2       4 x 6
//!   head       1      10 x 12           tusks      2       2 x 5
//!   trunk      1      12 x 8            tail       1       5 x 3
//!   legs       4       8 x 6                               sum 811
//! ```
//!
//! A part is a closed tube about a quadratic spine: a uniform bicubic B-spline over rings of
//! lattice points, as [`super::grid`] is over heights, turned into Bézier points. Both ends are
//! poles, at which a side of each patch is one point. Within a part patches share their edges to
//! the bit and join smoothly, but for the poles; parts run into each other, as handle and spout do
//! in Newell's pots. Radii have seeded folds. z is up, and patches face outward.

use super::grid::{knots, random};
use glam::DVec3;

/// Patches.
pub const PATCHES: usize = 811;

/// How much of a radius the folds are, to either side.
const FOLDS: f64 = 0.06;

/// A tube.
struct Part {
    /// Patches along the spine and around it.
    size: [usize; 2],
    /// Control points of the spine.
    spine: [[f64; 3]; 3],
    /// A direction across the spine, to which the first of the radii belongs.
    side: [f64; 3],
    /// Radii along `side` and across it, where the spine begins and where it ends.
    radii: [[f64; 2]; 2],
    /// The part of the spine in which each end is rounded, up to 1/2.
    cap: f64,
    /// Which side of the body has one: a part at y > 0 has its twin at y < 0.
    twins: bool,
}

const Y: [f64; 3] = [0.0, 1.0, 0.0];

/// Forward is x; the withers are at 2.8.
const PARTS: [Part; 8] = [
    Part {
        size: [20, 16],
        spine: [[-1.4, 0.0, 1.75], [0.0, 0.0, 2.05], [1.2, 0.0, 1.85]],
        side: Y,
        radii: [[0.75, 0.85], [0.6, 0.75]],
        cap: 0.5,
        twins: false,
    },
    Part {
        size: [10, 12],
        spine: [[0.9, 0.0, 2.2], [1.4, 0.0, 2.35], [1.95, 0.0, 2.1]],
        side: Y,
        radii: [[0.42, 0.5], [0.36, 0.45]],
        cap: 0.5,
        twins: false,
    },
    Part {
        size: [12, 8],
        spine: [[1.75, 0.0, 2.15], [2.55, 0.0, 1.7], [2.2, 0.0, 0.35]],
        side: Y,
        radii: [[0.24, 0.22], [0.09, 0.08]],
        cap: 0.1,
        twins: false,
    },
    Part {
        size: [8, 6],
        spine: [[0.75, 0.4, 1.6], [0.85, 0.45, 0.8], [0.8, 0.42, 0.0]],
        side: Y,
        radii: [[0.3, 0.32], [0.22, 0.22]],
        cap: 0.1,
        twins: true,
    },
    Part {
        size: [8, 6],
        spine: [[-0.85, 0.4, 1.6], [-0.65, 0.45, 0.8], [-0.9, 0.42, 0.0]],
        side: Y,
        radii: [[0.32, 0.38], [0.22, 0.22]],
        cap: 0.1,
        twins: true,
    },
    Part {
        size: [4, 6],
        spine: [[1.15, 0.4, 2.65], [1.0, 0.85, 2.3], [1.05, 0.6, 1.65]],
        side: [1.0, 0.0, 0.0],
        radii: [[0.5, 0.05], [0.3, 0.04]],
        cap: 0.5,
        twins: true,
    },
    Part {
        size: [2, 5],
        spine: [[1.8, 0.2, 1.95], [2.3, 0.28, 1.6], [2.65, 0.22, 1.85]],
        side: Y,
        radii: [[0.07, 0.07], [0.04, 0.04]],
        cap: 0.5,
        twins: true,
    },
    Part {
        size: [5, 3],
        spine: [[-1.35, 0.0, 2.1], [-1.75, 0.0, 1.8], [-1.6, 0.0, 1.0]],
        side: Y,
        radii: [[0.07, 0.07], [0.04, 0.04]],
        cap: 0.3,
        twins: false,
    },
];

/// Control points, 16 a patch, row-major; [`PATCHES`] patches.
#[must_use]
pub fn points() -> Vec<[f32; 3]> {
    let mut points = Vec::with_capacity(16 * PATCHES);
    for (number, part) in (0..).zip(&PARTS) {
        part.patches(2 * number, false, &mut points);
        if part.twins {
            part.patches(2 * number + 1, true, &mut points);
        }
    }
    points
}

impl Part {
    /// Adds its patches, or those of its twin. `seed` tells the folds of parts apart.
    fn patches(&self, seed: u32, twin: bool, points: &mut Vec<[f32; 3]>) {
        let [rows, columns] = self.size;
        let net = self.net(seed, twin);
        for row in 0..rows {
            for column in 0..columns {
                for k in 0..16 {
                    // The last column is the first again, to the bit.
                    let (i, j) = (3 * row + k / 4, (3 * column + k % 4) % (3 * columns));
                    points.push(net[i * 3 * columns + j]);
                }
            }
        }
    }

    /// Bézier points: 3 rows + 1 rings of 3 columns each.
    fn net(&self, seed: u32, twin: bool) -> Vec<[f32; 3]> {
        let [rows, columns] = self.size;
        // From the ring before the first to the one behind the last.
        let rings: Vec<Vec<DVec3>> = (0..rows + 3).map(|k| self.ring(seed, k)).collect();
        let mut net = Vec::with_capacity((3 * rows + 1) * 3 * columns);
        for i in 0..=3 * rows {
            for j in 0..3 * columns {
                // The pole's points are one: rounding would draw them apart.
                let j = if i % (3 * rows) == 0 { 0 } else { j };
                let ((ring, along), (column, around)) = (knots(i as u32), knots(j as u32));
                let mut sum = DVec3::ZERO;
                for (r, weight) in along.iter().enumerate() {
                    for (c, more) in around.iter().enumerate() {
                        // knots() counts from the lattice point before the first.
                        let c = (column + c + columns - 1) % columns;
                        sum += rings[ring + r][c] * *weight * *more;
                    }
                }
                let mirrored = if twin { DVec3::new(1.0, -1.0, 1.0) } else { DVec3::ONE };
                net.push(super::round::single((sum * mirrored).to_array()));
            }
        }
        if twin {
            // A mirror image has its inside out: the other way round it has not.
            net.chunks_mut(3 * columns).for_each(|ring| ring[1..].reverse());
        }
        net
    }

    /// Lattice points of ring `k - 1` of `0..=rows`: the rings beyond both ends are the mirror
    /// images of those before, so that the ends are poles.
    fn ring(&self, seed: u32, k: usize) -> Vec<DVec3> {
        let [rows, columns] = self.size;
        let (ring, sign) = match k {
            0 => (1, -1.0),
            k if k == rows + 2 => (rows - 1, -1.0),
            k => (k - 1, 1.0),
        };
        let (s, profile) = self.station(ring as f64 / rows as f64);
        let (centre, [right, up]) = self.frame(s);
        let [near, far] = self.radii;
        let radius = |axis: usize| profile * (near[axis] * (1.0 - s) + far[axis] * s);
        let point = |j: usize| {
            let fold = 2.0 * random(seed, (ring * columns + j) as u32) - 1.0;
            let [c, d] = direction(j as f64 / columns as f64);
            let offset = right * (c * radius(0)) + up * (d * radius(1));
            centre + offset * (sign * (1.0 + FOLDS * fold))
        };
        (0..columns).map(point).collect()
    }

    /// Where on the spine a ring is, and how much of the radius it has: quarters of an ellipse at
    /// both ends, `2 t / (1 + t t)` over `2 t t / (1 + t t)`.
    fn station(&self, along: f64) -> (f64, f64) {
        let from_end = along.min(1.0 - along) / self.cap;
        if from_end >= 1.0 {
            return (along, 1.0);
        }
        let t = from_end;
        let (inward, profile) = (2.0 * t * t / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let s = self.cap * inward;
        (if along < 0.5 { s } else { 1.0 - s }, profile)
    }

    /// The spine's point, and two directions across it: with its tangent right-handed.
    fn frame(&self, s: f64) -> (DVec3, [DVec3; 2]) {
        let [a, b, c] = self.spine.map(DVec3::from);
        let r = 1.0 - s;
        let centre = a * (r * r) + b * (2.0 * r * s) + c * (s * s);
        let tangent = ((b - a) * r + (c - b) * s).normalize();
        let side = DVec3::from(self.side);
        let right = (side - tangent * side.dot(tangent)).normalize();
        (centre, [right, tangent.cross(right)])
    }
}

/// A direction after the part `turn` of a turn, nearly: the point at that part of a square's
/// outline, out to the circle. A sine is not the same everywhere; a root is.
fn direction(turn: f64) -> [f64; 2] {
    let (quarter, t) = ((turn * 4.0).floor(), (turn * 4.0).fract());
    let length = ((1.0 - t) * (1.0 - t) + t * t).sqrt();
    let [x, y] = [(1.0 - t) / length, t / length];
    match quarter as u32 {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// An edge's four points, whichever end comes first.
    fn edge(patch: &[[f32; 3]], at: [usize; 4]) -> [[u32; 3]; 4] {
        let forward = at.map(|k| patch[k].map(f32::to_bits));
        let backward = [forward[3], forward[2], forward[1], forward[0]];
        forward.min(backward)
    }

    #[test]
    fn patches_are_as_many_as_the_papers_and_share_their_edges_to_the_bit() {
        let points = points();
        assert_eq!(points.len(), 16 * PATCHES);
        assert!(points.iter().flatten().all(|c| c.is_finite() && c.abs() < 4.0));
        let mut uses: HashMap<_, u32> = HashMap::new();
        let mut poles = 0;
        for patch in points.chunks(16) {
            for at in [[0, 1, 2, 3], [3, 7, 11, 15], [12, 13, 14, 15], [0, 4, 8, 12]] {
                let edge = edge(patch, at);
                if edge.iter().all(|point| *point == edge[0]) {
                    poles += 1;
                } else {
                    *uses.entry(edge).or_default() += 1;
                }
            }
        }
        assert!(uses.values().all(|&n| n == 2), "closed: each edge belongs to two patches");
        // Two poles of each tube, with a patch for each column.
        let columns: usize = PARTS.iter().map(|p| p.size[1] * if p.twins { 2 } else { 1 }).sum();
        assert_eq!(poles, 2 * columns);
        assert_eq!(2 * uses.len() + poles, 4 * PATCHES);
    }

    #[test]
    fn every_part_faces_outward() {
        // The volume under each facet of the nets, from the part's own middle.
        let points = points();
        let mut first = 0;
        for part in &PARTS {
            for _ in 0..if part.twins { 2 } else { 1 } {
                let count = part.size[0] * part.size[1];
                let own = &points[16 * first..16 * (first + count)];
                let at = |p: &[f32; 3]| DVec3::from(p.map(f64::from));
                let middle = own.iter().map(at).sum::<DVec3>() / own.len() as f64;
                let mut volume = 0.0;
                for patch in own.chunks(16) {
                    for k in [0, 1, 2, 4, 5, 6, 8, 9, 10] {
                        let [a, b, c, d] = [k, k + 1, k + 5, k + 4].map(|k| at(&patch[k]) - middle);
                        volume += a.dot(b.cross(c)) + a.dot(c.cross(d));
                    }
                }
                assert!(volume > 0.0, "part of {:?}: {volume}", part.size);
                first += count;
            }
        }
        assert_eq!(first, PATCHES);
    }

    #[test]
    fn neighbours_join_smoothly_but_at_poles() {
        let points = points();
        let [rows, columns] = PARTS[0].size;
        let at = |row: usize, column: usize, k: usize| {
            DVec3::from(points[16 * (row * columns + column % columns) + k].map(f64::from))
        };
        let mut compared = 0;
        for row in 0..rows {
            for column in 0..columns {
                for i in 0..4 {
                    if (row == 0 && i == 0) || (row == rows - 1 && i == 3) {
                        continue;
                    }
                    let before = at(row, column, 4 * i + 3) - at(row, column, 4 * i + 2);
                    let after = at(row, column + 1, 4 * i + 1) - at(row, column + 1, 4 * i);
                    assert!((before - after).length() < 1e-6, "{row} {column}: {before} {after}");
                    compared += 1;
                }
            }
        }
        assert_eq!(compared, columns * (4 * rows - 2));
    }

    #[test]
    fn directions_go_round_once() {
        for k in 0..64 {
            let [a, b] = [f64::from(k) / 64.0, f64::from(k + 1) / 64.0].map(|t| direction(t % 1.0));
            assert!((a[0] * a[0] + a[1] * a[1] - 1.0).abs() < 1e-12);
            assert!(a[0] * b[1] - a[1] * b[0] > 0.05, "{a:?} {b:?}");
        }
    }
}
