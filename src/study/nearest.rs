//! Nearest: triangles and a point in, the point of any of the triangles that is nearest to it out.
//!
//! Exact, as if every triangle were looked at: balls round triangles, and round groups of them that
//! lie together, say which need not be.

use glam::DVec3;

/// Facets under one ball.
const CLUSTER: usize = 16;

/// Triangles, among which the nearest is to be found.
pub(super) struct Facets {
    /// Those that follow one another lie side by side, whatever the mesh's order: a ring's facets
    /// reach round the patch, and a ball round them holds most of it.
    all: Vec<Facet>,
    /// A ball round each.
    balls: Vec<Ball>,
    /// A ball round each [`CLUSTER`] of them.
    clusters: Vec<Ball>,
}

impl Facets {
    pub(super) fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let mut all: Vec<Facet> = triangles.map(Facet::new).collect();
        let middles = || all.iter().map(|facet| centroid(&facet.corners));
        let least = middles().fold(DVec3::INFINITY, DVec3::min);
        let extent = (middles().fold(DVec3::NEG_INFINITY, DVec3::max) - least).max_element();
        all.sort_by_cached_key(|facet| morton((centroid(&facet.corners) - least) / extent));
        let balls: Vec<Ball> = all.iter().map(|facet| Ball::round(&facet.corners)).collect();
        let clusters = balls.chunks(CLUSTER).map(Ball::round_balls).collect();
        Self { all, balls, clusters }
    }

    /// The nearest point of all facets. `last` is the facet that it was on before, 0 at first: a
    /// good first guess.
    ///
    /// # Panics
    /// When there are no facets.
    pub(super) fn nearest(&self, p: DVec3, last: &mut usize) -> DVec3 {
        let mut best = self.all[*last].nearest(p);
        let mut least = best.distance(p);
        let mut offer = |k: usize, least: &mut f64| {
            let candidate = self.all[k].nearest(p);
            let distance = candidate.distance(p);
            if distance < *least {
                (best, *least, *last) = (candidate, distance, k);
            }
        };
        // A better one: the closer the guess, the fewer facets may hold something nearer.
        let first = CLUSTER * closest(&self.clusters, p);
        let members = &self.balls[first..self.balls.len().min(first + CLUSTER)];
        offer(first + closest(members, p), &mut least);
        for (k, (members, cluster)) in self.balls.chunks(CLUSTER).zip(&self.clusters).enumerate() {
            if cluster.may_be_within(least, p) {
                for (i, ball) in members.iter().enumerate() {
                    if ball.may_be_within(least, p) {
                        offer(CLUSTER * k + i, &mut least);
                    }
                }
            }
        }
        best
    }
}

fn centroid(corners: &[DVec3; 3]) -> DVec3 {
    (corners[0] + corners[1] + corners[2]) / 3.0
}

/// Where a point of the unit cube comes in Morton order: the bits of its cell's three numbers in
/// turn, ten of each. What is no number is 0.
fn morton(at: DVec3) -> u32 {
    let cells = at.to_array().map(|part| (part * 1023.0) as u32);
    let spread = |cell: u32| (0..10).map(|k| (cell >> k & 1) << (3 * k)).sum::<u32>();
    let [x, y, z] = cells.map(spread);
    x | y << 1 | z << 2
}

/// Which of the balls has its centre nearest to `p`, the first of equals.
fn closest(balls: &[Ball], p: DVec3) -> usize {
    let distances = balls.iter().map(|ball| ball.centre.distance_squared(p));
    let least = |best: (usize, f64), next: (usize, f64)| if next.1 < best.1 { next } else { best };
    distances.enumerate().reduce(least).map_or(0, |(k, _)| k)
}

/// All points that are as near to the centre as the radius.
#[derive(Clone, Copy, Debug)]
struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    /// Round a triangle, from its centroid.
    fn round(corners: &[DVec3; 3]) -> Self {
        let centre = centroid(corners);
        let radius = corners.iter().map(|c| c.distance(centre)).fold(0.0, f64::max);
        Self { centre, radius }
    }

    /// Round all of some balls, at least one.
    fn round_balls(balls: &[Self]) -> Self {
        let centre = balls.iter().map(|ball| ball.centre).sum::<DVec3>() / balls.len() as f64;
        let reach = |ball: &Self| ball.centre.distance(centre) + ball.radius;
        Self { centre, radius: balls.iter().map(reach).fold(0.0, f64::max) }
    }

    /// Whether some point of the ball may be nearer to `p` than `distance`.
    fn may_be_within(&self, distance: f64, p: DVec3) -> bool {
        let reach = distance + self.radius;
        self.centre.distance_squared(p) < reach * reach
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

    /// A sheet of n by n cells with waves of some height, each cell cut in two; the order of cells
    /// is the caller's.
    fn sheet(n: u32, height: f64, cell: impl Fn(u32) -> u32) -> Vec<[DVec3; 3]> {
        let corner = |i: u32, j: u32| {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(n));
            DVec3::new(u, v, height * (9.0 * u).sin() * (7.0 * v).cos())
        };
        let cells = (0..n * n).map(cell).map(|k| (k % n, k / n));
        let halves = |(i, j): (u32, u32)| {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        };
        cells.flat_map(halves).map(|t| t.map(|(i, j)| corner(i, j))).collect()
    }

    #[test]
    fn clusters_find_what_looking_at_every_facet_finds() {
        let triangles = sheet(9, 1.0, |k| k);
        let facets = Facets::new(triangles.iter().copied());
        assert!(facets.clusters.len() == 11 && !facets.all.len().is_multiple_of(CLUSTER));
        let mut last = 0;
        for k in 0..500_u32 {
            let at = |prime: u32| f64::from(k * prime % 101) / 80.0 - 0.1;
            let p = DVec3::new(at(7), at(31), at(59));
            let found = facets.nearest(p, &mut last).distance(p);
            let all = triangles.iter().map(|&t| Facet::new(t).nearest(p).distance(p));
            assert_eq!(found, all.fold(f64::INFINITY, f64::min), "{p}");
        }
    }

    #[test]
    fn clusters_are_tight_in_whatever_order_the_facets_come() {
        // 7 has no factor in common with 16 x 16.
        for step in [1, 7, 101] {
            let facets = Facets::new(sheet(16, 0.1, |k| k * step % 256).into_iter());
            assert_eq!(facets.clusters.len(), 32);
            // Four cells by two, half a diagonal and a facet's own radius; in a row they reach 0.3.
            let mean = facets.clusters.iter().map(|ball| ball.radius).sum::<f64>() / 32.0;
            assert!(mean < 0.22, "{step}: {mean}");
        }
    }

    #[test]
    fn morton_order_keeps_halves_together() {
        let at = |x: f64, y: f64| morton(DVec3::new(x, y, 0.0) / 8.0);
        let order = [at(0.0, 0.0), at(3.0, 0.0), at(0.0, 3.0), at(3.0, 3.0), at(5.0, 0.0)];
        assert!(order.is_sorted(), "{order:?}");
        assert!(at(3.9, 3.9) < at(0.0, 4.1) && at(7.9, 3.9) < at(0.0, 4.1));
        assert_eq!(morton(DVec3::ONE), (1 << 30) - 1);
        assert_eq!(morton(DVec3::NAN), 0);
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
