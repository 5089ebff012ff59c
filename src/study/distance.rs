//! Distance: a patch's control points and its mesh in, how far the true surface is from the mesh
//! out.
//!
//! The true surface is sampled densely in f64 from unquantised control points. Of each sample the
//! nearest point on any of the patch's triangles is found: the distance between the two, in the
//! world, is the deviation, and between their projections, in pixels, that on the screen. The mesh
//! is the one that the hardware made, its roundings included.

use super::nearest::Facets;
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
}
