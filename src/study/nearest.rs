//! Nearest: triangles and a point in, the point of any of the triangles that is nearest to it out.
//!
//! As if every triangle were looked at, up to the rounding of a distance: boxes round triangles,
//! and round groups of them, say which need not be.

use glam::DVec3;

/// Facets in one box of a group.
const CLUSTER: usize = 16;

/// Triangles, among which the nearest is to be found.
pub(super) struct Facets {
    /// In the mesh's order, in which those that follow one another lie side by side. To sort them
    /// so that groups are tighter costs more than it saves.
    all: Vec<Facet>,
    /// A box round each.
    boxes: Vec<Bounds>,
    /// A box round each [`CLUSTER`] of them.
    clusters: Vec<Bounds>,
}

impl Facets {
    pub(super) fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let all: Vec<Facet> = triangles.map(Facet::new).collect();
        let boxes: Vec<_> = all.iter().map(|facet| Bounds::of(&facet.corners)).collect();
        let round =
            |some: &[Bounds]| some.iter().copied().reduce(Bounds::with).expect("no chunk is empty");
        let clusters = boxes.chunks(CLUSTER).map(round).collect();
        Self { all, boxes, clusters }
    }

    /// The nearest point of all facets. `last` is the facet that it was on before, 0 at first: a
    /// good first guess.
    ///
    /// # Panics
    /// When there are no facets.
    pub(super) fn nearest(&self, p: DVec3, last: &mut usize) -> DVec3 {
        let candidate = self.all[*last].nearest(p);
        let mut best = Best { at: candidate, square: candidate.distance_squared(p), on: *last };
        // The cluster that is nearest first: the closer the guess, the fewer facets may hold
        // something nearer.
        let away = self.clusters.iter().map(|cluster| cluster.square_from(p));
        let least = |a: (usize, f64), b: (usize, f64)| if b.1 < a.1 { b } else { a };
        let first = away.enumerate().reduce(least).map_or(0, |(k, _)| k);
        self.visit(first, p, &mut best);
        for (k, cluster) in self.clusters.iter().enumerate() {
            if k != first && cluster.square_from(p) < best.square {
                self.visit(k, p, &mut best);
            }
        }
        *last = best.on;
        best.at
    }

    /// Looks at the facets of a cluster.
    fn visit(&self, cluster: usize, p: DVec3, best: &mut Best) {
        let from = CLUSTER * cluster;
        let to = self.all.len().min(from + CLUSTER);
        for k in from..to {
            if self.boxes[k].square_from(p) < best.square {
                let at = self.all[k].nearest(p);
                let square = at.distance_squared(p);
                if square < best.square {
                    *best = Best { at, square, on: k };
                }
            }
        }
    }
}

/// The nearest point so far.
struct Best {
    at: DVec3,
    /// The square of its distance.
    square: f64,
    /// The facet that it is on.
    on: usize,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: DVec3,
    most: DVec3,
}

impl Bounds {
    fn of(corners: &[DVec3; 3]) -> Self {
        let [a, b, c] = *corners;
        Self { least: a.min(b).min(c), most: a.max(b).max(c) }
    }

    /// Round both.
    fn with(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    /// The square of the distance of `p` from the nearest point in the box.
    fn square_from(&self, p: DVec3) -> f64 {
        (self.least - p).max(p - self.most).max(DVec3::ZERO).length_squared()
    }
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [DVec3; 3],
    /// Products of its sides from corner 0, and one over the square of twice its area: 0 without
    /// area.
    gram: [f64; 3],
    inverse: f64,
}

impl Facet {
    fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let [along, up] = [b - a, c - a];
        let gram = [along.dot(along), along.dot(up), up.dot(up)];
        let square = along.cross(up).length_squared();
        let inverse = if square > 0.0 { square.recip() } else { 0.0 };
        Self { corners, gram, inverse }
    }

    /// Its point that is nearest to `p`: the foot of the perpendicular, if that is inside, else on
    /// one of the sides. A triangle without area has sides only.
    fn nearest(&self, p: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let (along, up) = (b - a, c - a);
        let [d, e] = [(p - a).dot(along), (p - a).dot(up)];
        let [aa, ab, bb] = self.gram;
        let (s, t) = ((bb * d - ab * e) * self.inverse, (aa * e - ab * d) * self.inverse);
        if self.inverse > 0.0 && s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
            return a + along * s + up * t;
        }
        let sides = [on_side(a, b, p), on_side(b, c, p), on_side(c, a, p)];
        let [d, e, f] = sides.map(|q| q.distance_squared(p));
        if d <= e && d <= f {
            sides[0]
        } else if e <= f {
            sides[1]
        } else {
            sides[2]
        }
    }
}

fn on_side(a: DVec3, b: DVec3, p: DVec3) -> DVec3 {
    let along = b - a;
    let length = along.length_squared();
    if length == 0.0 { a } else { a + along * ((p - a).dot(along) / length).clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wavy sheet of n by n cells, each cut in two.
    fn sheet(n: u32) -> Vec<[DVec3; 3]> {
        let corner = |(i, j): (u32, u32)| {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(n));
            DVec3::new(u, v, (9.0 * u).sin() * (7.0 * v).cos())
        };
        let halves = |(i, j): (u32, u32)| {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        };
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        cells.flat_map(halves).map(|t| t.map(corner)).collect()
    }

    #[test]
    fn clusters_find_what_looking_at_every_facet_finds() {
        let triangles = sheet(9);
        let facets = Facets::new(triangles.iter().copied());
        assert!(facets.clusters.len() == 11 && !facets.all.len().is_multiple_of(CLUSTER));
        let mut last = 0;
        for k in 0..500_u32 {
            let at = |prime: u32| f64::from(k * prime % 101) / 80.0 - 0.1;
            let p = DVec3::new(at(7), at(31), at(59));
            let found = facets.nearest(p, &mut last).distance(p);
            let all = triangles.iter().map(|&t| Facet::new(t).nearest(p).distance(p));
            let least = all.fold(f64::INFINITY, f64::min);
            assert!((0.0..1e-15).contains(&(found - least)), "{p}: {found} {least}");
        }
    }

    #[test]
    fn triangles_without_area_are_segments_and_points() {
        let [a, b] = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0)];
        let p = DVec3::new(1.5, 1.0, 0.0);
        assert_eq!(Facet::new([a, b, a]).nearest(p), DVec3::new(1.5, 0.0, 0.0));
        assert_eq!(Facet::new([b, b, b]).nearest(p), b);
        assert_eq!(Facet::new([a, b, a]).nearest(DVec3::new(-3.0, 1.0, 0.0)), a);
    }
}
