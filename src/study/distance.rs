//! Distance: a patch's control points and its mesh in, how far the true surface is from the mesh
//! out.
//!
//! The true surface is sampled densely in f64 from unquantised control points. Of each sample the
//! nearest point on any of the patch's triangles is found: the distance between the two, in the
//! world, is the deviation, and between their projections, in pixels, that on the screen. The mesh
//! is the one that the hardware made, its roundings included.

use crate::golden::{Real, emit, evaluate};
use glam::{DMat4, DVec2, DVec3, DVec4};
use rtl_model::patch::Triangle;

/// Where a patch is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Clip to world space.
    pub(super) to_world: DMat4,
    /// Pixels.
    pub(super) viewport: [u32; 2],
    /// Where its surface is sampled.
    pub(super) samples: Samples,
}

/// Samples of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Samples {
    /// Along each direction one more than so many segments, ends included; behind the eye none is a
    /// pixel off.
    Ends(u32),
    /// The middles of so many segments along each direction, where they lie in the viewport. Hardly
    /// one is a vertex of a mesh, where there would be no error to be seen.
    Middles(u32),
}

impl Samples {
    /// Parameters along a direction.
    fn parameters(self) -> Vec<f64> {
        let part = |k: u32, all: u32| f64::from(k) / f64::from(all);
        match self {
            Self::Ends(all) => (0..=all).map(|k| part(k, all)).collect(),
            Self::Middles(all) => (0..all).map(|k| part(2 * k + 1, 2 * all)).collect(),
        }
    }
}

/// A patch's mesh: vertices in clip space.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    pub(super) vertices: Vec<Real>,
    pub(super) triangles: Vec<Triangle>,
}

/// How far samples are from a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Samples.
    pub samples: u64,
    /// The largest distance in world units.
    pub largest: f64,
    /// All of them added up.
    pub sum: f64,
    /// The largest in pixels.
    pub largest_pixels: f64,
    /// All of them added up.
    pub sum_pixels: f64,
}

impl Deviation {
    /// The mean distance in world units.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.samples.max(1) as f64
    }

    /// The mean distance in pixels.
    #[must_use]
    pub fn mean_pixels(&self) -> f64 {
        self.sum_pixels / self.samples.max(1) as f64
    }

    /// With the samples of another patch.
    #[must_use]
    pub fn with(self, other: &Self) -> Self {
        Self {
            samples: self.samples + other.samples,
            largest: self.largest.max(other.largest),
            sum: self.sum + other.sum,
            largest_pixels: self.largest_pixels.max(other.largest_pixels),
            sum_pixels: self.sum_pixels + other.sum_pixels,
        }
    }

    fn take(&mut self, world: f64, pixels: f64) {
        self.samples += 1;
        self.largest = self.largest.max(world);
        self.sum += world;
        self.largest_pixels = self.largest_pixels.max(pixels);
        self.sum_pixels += pixels;
    }
}

/// Measures a patch, whose control points are in clip space.
///
/// # Panics
/// When the mesh has no triangles.
pub(super) fn patch(points: &[Real; 16], mesh: &Mesh, place: &Place) -> Deviation {
    assert!(!mesh.triangles.is_empty(), "a patch that is drawn has triangles");
    let to_world = |p: Real| {
        let p = place.to_world * DVec4::from(p);
        p.truncate() / p.w
    };
    let vertices: Vec<DVec3> = mesh.vertices.iter().map(|&v| to_world(v)).collect();
    let corners = |t: &Triangle| t.map(|v| vertices[usize::from(v)]);
    let facets = Facets::new(mesh.triangles.iter().map(corners));
    let to_clip = place.to_world.inverse();
    let screen = |p: DVec3| {
        let clip = to_clip * p.extend(1.0);
        emit::screen(clip.to_array(), place.viewport).map(DVec2::from)
    };
    let mut deviation = Deviation::default();
    let mut last = 0;
    let parameters = place.samples.parameters();
    let in_view = matches!(place.samples, Samples::Middles(_));
    for &v in &parameters {
        for &u in &parameters {
            let clip = evaluate::surface(points, u, v);
            let seen = emit::screen(clip, place.viewport).map(DVec2::from);
            if in_view && !seen.is_some_and(|at| inside(at, place)) {
                continue;
            }
            let sample = to_world(clip);
            let near = facets.nearest(sample, &mut last);
            let pixels = match (seen, screen(near)) {
                (Some(a), Some(b)) => a.distance(b),
                _ => 0.0,
            };
            deviation.take(sample.distance(near), pixels);
        }
    }
    deviation
}

fn inside(at: DVec2, place: &Place) -> bool {
    let [width, height] = place.viewport.map(f64::from);
    (0.0..width).contains(&at.x) && (0.0..height).contains(&at.y)
}

/// Facets that follow one another in a mesh, and so lie side by side, under one ball.
const CLUSTER: usize = 16;

/// Triangles, among which the nearest is to be found.
struct Facets {
    all: Vec<Facet>,
    /// A ball round each.
    balls: Vec<Ball>,
    /// A ball round each [`CLUSTER`] of them.
    clusters: Vec<Ball>,
}

impl Facets {
    fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let all: Vec<Facet> = triangles.map(Facet::new).collect();
        let balls: Vec<Ball> = all.iter().map(|facet| Ball::round(&facet.corners)).collect();
        let clusters = balls.chunks(CLUSTER).map(Ball::round_balls).collect();
        Self { all, balls, clusters }
    }

    /// The nearest point of all facets. `last` is the facet that it was on before: a good first
    /// guess.
    fn nearest(&self, p: DVec3, last: &mut usize) -> DVec3 {
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
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
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
    use std::f64::consts::PI;

    /// World and clip space the same; x and y from -1 to 1 over 200 pixels.
    fn place(segments: u32) -> Place {
        let samples = Samples::Ends(segments);
        Place { to_world: DMat4::IDENTITY, viewport: [200, 200], samples }
    }

    /// A grid of n by n cells over a surface, each cut in two.
    fn grid(n: u16, at: impl Fn(f64, f64) -> Real) -> Mesh {
        let part = |k: u16| f64::from(k) / f64::from(n);
        let corners = (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j)));
        let vertices = corners.map(|(i, j)| at(part(j), part(i))).collect();
        let cells = (0..n).flat_map(|i| (0..n).map(move |j| i * (n + 1) + j));
        let triangles = cells.flat_map(|k| [[k, k + 1, k + n + 1], [k + 1, k + n + 2, k + n + 1]]);
        Mesh { vertices, triangles: triangles.collect() }
    }

    fn points(at: impl Fn(f64, f64) -> Real) -> [Real; 16] {
        std::array::from_fn(|k| at((k % 4) as f64 / 3.0, (k / 4) as f64 / 3.0))
    }

    #[test]
    fn a_flat_patch_is_nowhere_off_its_mesh_and_shifted_it_is_off_by_the_shift() {
        let flat = |u: f64, v: f64| [u - 0.5, v - 0.5, 0.0, 1.0];
        let points = points(flat);
        for n in [1, 3] {
            let deviation = patch(&points, &grid(n, flat), &place(10));
            assert_eq!(deviation.samples, 121);
            assert!(deviation.largest < 1e-15 && deviation.largest_pixels < 1e-12);
        }
        let lifted = grid(2, |u, v| [u - 0.5, v - 0.5, 0.25, 1.0]);
        let deviation = patch(&points, &lifted, &place(10));
        assert!(
            (deviation.largest - 0.25).abs() < 1e-12 && (deviation.mean() - 0.25).abs() < 1e-12
        );
        // The viewer looks along z: nothing of it is seen.
        assert!(deviation.largest_pixels < 1e-9);
        // Out of the plane's own outline: a sample at u = 0 is 1/4 from the mesh, one at 1/4 on it.
        let beside = grid(2, |u, v| [u - 0.25, v - 0.5, 0.0, 1.0]);
        let deviation = patch(&points, &beside, &place(4));
        assert!((deviation.largest - 0.25).abs() < 1e-12, "{deviation:?}");
        assert!((deviation.largest_pixels - 25.0).abs() < 1e-9, "{deviation:?}");
        assert!((deviation.mean() - 0.25 / 5.0).abs() < 1e-12, "{deviation:?}");
    }

    /// A quarter of a cylinder of radius 1 as a rational patch, and n chords along it: a sagitta of
    /// 1 - cos of half the angle.
    #[test]
    fn a_cylinder_is_off_its_chords_by_their_sagitta() {
        let w = 0.5_f64.sqrt();
        // A quadratic's three points, raised to a cubic.
        let arc = [[1.0, 0.0, 1.0], [w, w, w], [0.0, 1.0, 1.0]];
        let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| (a[k] + 2.0 * b[k]) / 3.0);
        let cubic = [arc[0], mix(arc[0], arc[1]), mix(arc[2], arc[1]), arc[2]];
        let points: [Real; 16] = std::array::from_fn(|k| {
            let [x, y, w] = cubic[k % 4];
            [x, y, (k / 4) as f64 / 3.0 * w, w]
        });
        for n in [1_u16, 2, 4, 6] {
            let mesh = grid(n, |u, v| [(u * PI / 2.0).cos(), (u * PI / 2.0).sin(), v, 1.0]);
            let deviation = patch(&points, &mesh, &place(192));
            let sagitta = 1.0 - (PI / 4.0 / f64::from(n)).cos();
            let off = deviation.largest / sagitta;
            assert!((0.999..1.0 + 1e-9).contains(&off), "{n}: {off}");
            // Of a parabola's height over its chord the mean is two thirds.
            let mean = deviation.mean() / sagitta;
            assert!((0.63..0.68).contains(&mean), "{n}: {mean}");
            assert!((deviation.largest_pixels / (100.0 * sagitta) - 1.0).abs() < 2e-3);
        }
    }

    #[test]
    fn samples_out_of_view_do_not_count_where_only_those_in_view_do() {
        // x from -2 to 2: of the eight middles of its segments four are seen.
        let wide = |u: f64, v: f64| [4.0 * u - 2.0, v - 0.5, 0.0, 1.0];
        let lower = grid(2, |u, v| [4.0 * u - 2.0, v - 0.75, 0.0, 1.0]);
        let (points, all) = (points(wide), place(8));
        let seen = Place { samples: Samples::Middles(8), ..all };
        let [all, seen] = [all, seen].map(|place| patch(&points, &lower, &place));
        assert_eq!((all.samples, seen.samples), (81, 4 * 8));
        assert!((seen.largest_pixels - 18.75).abs() < 1e-9, "{seen:?}");
    }

    #[test]
    fn clusters_find_what_looking_at_every_facet_finds() {
        let wave = |u: f64, v: f64| [u, v, (9.0 * u).sin() * (7.0 * v).cos(), 1.0];
        let mesh = grid(9, wave);
        let corner = |v: u16| DVec4::from(mesh.vertices[usize::from(v)]).truncate();
        let facets = Facets::new(mesh.triangles.iter().map(|t| t.map(corner)));
        assert!(facets.clusters.len() == 11 && !facets.all.len().is_multiple_of(CLUSTER));
        let mut last = 0;
        for k in 0..500_u32 {
            let at = |prime: u32| f64::from(k * prime % 101) / 80.0 - 0.1;
            let p = DVec3::new(at(7), at(31), at(59));
            let found = facets.nearest(p, &mut last).distance(p);
            let all = facets.all.iter().map(|facet| facet.nearest(p).distance(p));
            assert_eq!(found, all.fold(f64::INFINITY, f64::min), "{p}");
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
