//! A patch: its triangles and the true surface in; facets and values out.

use super::Style;
use crate::golden::{Real, emit, evaluate};
use crate::gpu::render::{Facet, Lens, Point};
use glam::{DMat4, DVec2, DVec3, DVec4};
use rtl_model::patch::Triangle;

/// Triangles of no more pixels along x and y are one facet: they have one colour.
const SMALL: f64 = 8.0;

/// Pixels of a triangle along x or y from which on each side of it is cut into twice as many
/// parts, and as many parts.
const PARTS: [(f64, u32); 3] = [(0.0, 4), (32.0, 8), (128.0, 16)];

/// How far towards the middle of its patch a normal is taken where the surface has none.
const ASIDE: [f64; 4] = [0.0, 1e-4, 1e-2, 1e-1];

/// Bits of a facet's edges: all three are lines.
const LINES: u32 = 1 | 2 | 4;

/// The bit of a facet that shows its back.
const BACK: u32 = 64;

/// Where a frame is seen from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// Clip to world space.
    pub(super) to_world: DMat4,
    /// The camera's axes in the world: right, up, towards the viewer.
    axes: [DVec3; 3],
    /// The eye, or, of a parallel projection, none.
    eye: Option<DVec3>,
    pub(super) viewport: [u32; 2],
    /// Whether clip space begins at z = -w.
    pub(super) symmetric: bool,
}

impl Camera {
    pub(super) fn new(to_world: DMat4, viewport: [u32; 2], symmetric: bool) -> Self {
        let at = |x: f64, y: f64, z: f64| {
            let p = to_world * DVec4::new(x, y, z, 1.0);
            p.truncate() / p.w
        };
        // Depths that are finite whichever end of the range is not.
        let (near, far) = (at(0.0, 0.0, 0.25), at(0.0, 0.0, 0.5));
        // Of points with x = y = w = 0 there is one.
        let eye = to_world * DVec4::new(0.0, 0.0, 1.0, 0.0);
        let distant = eye.w.abs() <= 1e-9 * eye.truncate().length();
        let eye = (!distant).then(|| eye.truncate() / eye.w);
        let back = match eye {
            // Depth may run either way.
            Some(eye) => (eye - far).normalize_or_zero(),
            None => (near - far).normalize_or_zero(),
        };
        let right = (at(0.1, 0.0, 0.25) - at(-0.1, 0.0, 0.25)).normalize_or_zero();
        let up = (at(0.0, 0.1, 0.25) - at(0.0, -0.1, 0.25)).normalize_or_zero();
        Self { to_world, axes: [right, up, back], eye, viewport, symmetric }
    }

    fn world(&self, clip: Real) -> DVec3 {
        let p = self.to_world * DVec4::from(clip);
        p.truncate() / p.w
    }

    /// From a point in the world towards the viewer.
    fn view(&self, point: DVec3) -> DVec3 {
        self.eye.map_or(self.axes[2], |eye| eye - point)
    }

    fn in_axes(&self, v: DVec3) -> [f64; 3] {
        self.axes.map(|axis| axis.dot(v))
    }

    /// Pixels; `None` behind the eye.
    fn screen(&self, clip: Real) -> Option<DVec2> {
        emit::screen(clip, self.viewport).map(DVec2::from)
    }

    /// With a depth from 0 to w.
    fn seen(&self, [x, y, z, w]: Real) -> Real {
        [x, y, if self.symmetric { 0.5 * (z + w) } else { z }, w]
    }
}

/// A vertex in clip space, and its parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) clip: Real,
    pub(super) at: [f64; 2],
}

/// What a unit made of a patch, and the surface that it stands for.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Control points in clip space.
    pub(super) truth: [Real; 16],
    pub(super) reversed: bool,
    pub(super) vertices: Vec<Corner>,
    pub(super) triangles: Vec<Triangle>,
}

impl Piece {
    /// A value a triangle.
    pub(super) fn values(&self, style: Style, camera: &Camera) -> Vec<f64> {
        let value = |triangle: &Triangle| {
            let corners = self.corners(triangle);
            match style {
                Style::Shaded | Style::Wireframe => 0.0,
                Style::Level => self.level(),
                Style::Area => area(&corners, camera),
                Style::Error => {
                    let parts = parts(extent(&corners, camera));
                    self.errors(&corners, parts, camera).into_iter().fold(0.0, f64::max)
                }
            }
        };
        self.triangles.iter().map(value).collect()
    }

    /// Appends the facets of all triangles.
    pub(super) fn facets(&self, style: Style, camera: &Camera, lens: &Lens, out: &mut Vec<Facet>) {
        let values = self.values(style, camera);
        let normals: Vec<DVec3> = self.vertices.iter().map(|v| self.normal(v.at, camera)).collect();
        for (triangle, value) in self.triangles.iter().zip(values) {
            let corners = self.corners(triangle);
            let (points, flags) = self.points(triangle, &corners, &normals, value, camera);
            let large = extent(&corners, camera);
            if style == Style::Error && large > SMALL {
                let errors = self.errors(&corners, parts(large), camera);
                cut(&points, flags, &errors, parts(large), lens, out);
            } else {
                lens.facets(&points, flags, out);
            }
        }
    }

    fn corners(&self, triangle: &Triangle) -> [Corner; 3] {
        triangle.map(|index| self.vertices[usize::from(index)])
    }

    /// Segments along each edge of the uniform grid of as many triangles.
    fn level(&self) -> f64 {
        (self.triangles.len() as f64 / 2.0).sqrt()
    }

    /// At the points of a lattice over a triangle, how far it is from the surface, in pixels: 0
    /// behind the eye.
    fn errors(&self, corners: &[Corner; 3], parts: u32, camera: &Camera) -> Vec<f64> {
        let error = |weights: [f64; 3]| {
            let mix =
                |of: &dyn Fn(&Corner) -> f64| (0..3).map(|k| weights[k] * of(&corners[k])).sum();
            let made: Real = std::array::from_fn(|axis| mix(&|corner| corner.clip[axis]));
            let (u, v) = (mix(&|corner| corner.at[0]), mix(&|corner| corner.at[1]));
            let truth = evaluate::surface(&self.truth, u, v);
            match (camera.screen(made), camera.screen(truth)) {
                (Some(made), Some(truth)) => made.distance(truth),
                _ => 0.0,
            }
        };
        lattice(parts).map(|at| error(weights(at, parts))).collect()
    }

    /// Su x Sv in the world, of length 1.
    fn normal(&self, [u, v]: [f64; 2], camera: &Camera) -> DVec3 {
        let to_world = |p: Real| camera.to_world * DVec4::from(p);
        for aside in ASIDE {
            let [u, v] = [u, v].map(|t| t + (0.5 - t) * aside);
            let point = to_world(evaluate::surface(&self.truth, u, v));
            let along = evaluate::derivatives(&self.truth, u, v).map(to_world);
            // Of x / w, times w squared.
            let [su, sv] = along.map(|d| d.truncate() * point.w - point.truncate() * d.w);
            let normal = su.cross(sv);
            if normal.length() > 1e-6 * su.length() * sv.length() && normal.length() > 0.0 {
                return normal.normalize_or_zero();
            }
        }
        DVec3::ZERO
    }

    /// A triangle's corners as they are drawn, and which of its edges are lines.
    fn points(
        &self,
        triangle: &Triangle,
        corners: &[Corner; 3],
        normals: &[DVec3],
        value: f64,
        camera: &Camera,
    ) -> ([Point; 3], u32) {
        let world = corners.map(|corner| camera.world(corner.clip));
        let flat = (world[1] - world[0]).cross(world[2] - world[0]);
        let centre = (world[0] + world[1] + world[2]) / 3.0;
        let away = flat.dot(camera.view(centre)) < 0.0;
        let point = |k: usize| {
            let normal = normals[usize::from(triangle[k])];
            let normal = if normal == DVec3::ZERO { flat } else { normal };
            // The side of the triangle that is seen; a surface's normal goes along.
            let turned = (normal.dot(flat) < 0.0) != away;
            let normal = if turned { -normal } else { normal };
            Point {
                clip: camera.seen(corners[k].clip),
                normal: camera.in_axes(normal),
                view: camera.in_axes(camera.view(world[k])),
                value,
            }
        };
        let back = if away != self.reversed { BACK } else { 0 };
        ([0, 1, 2].map(point), LINES | boundary(corners) | back)
    }
}

/// The bits of edges on the patch's boundary.
fn boundary(corners: &[Corner; 3]) -> u32 {
    let on = |k: usize| {
        let (a, b) = (corners[k].at, corners[(k + 1) % 3].at);
        let along = |axis: usize, end: f64| a[axis] == end && b[axis] == end;
        [0.0, 1.0].iter().any(|&end| along(0, end) || along(1, end))
    };
    (0..3).filter(|&k| on(k)).map(|k| 8 << k).sum()
}

/// Pixels along x or y, whichever are more; 0 where a corner is behind the eye.
fn extent(corners: &[Corner; 3], camera: &Camera) -> f64 {
    let places = corners.map(|corner| camera.screen(corner.clip));
    let [Some(a), Some(b), Some(c)] = places else { return 0.0 };
    (a.max(b).max(c) - a.min(b).min(c)).max_element()
}

/// Square pixels; 0 where a corner is behind the eye.
fn area(corners: &[Corner; 3], camera: &Camera) -> f64 {
    let places = corners.map(|corner| camera.screen(corner.clip));
    let [Some(a), Some(b), Some(c)] = places else { return 0.0 };
    0.5 * (b - a).perp_dot(c - a).abs()
}

fn parts(extent: f64) -> u32 {
    PARTS.iter().rev().find(|(from, _)| extent >= *from).map_or(PARTS[0].1, |(_, parts)| *parts)
}

/// The points of a lattice that cuts each side into `parts`: parts from corner 0 towards 1, and
/// towards 2.
fn lattice(parts: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..=parts).flat_map(move |i| (0..=parts - i).map(move |j| [i, j]))
}

fn weights([i, j]: [u32; 2], parts: u32) -> [f64; 3] {
    [parts - i - j, i, j].map(|k| f64::from(k) / f64::from(parts))
}

/// Appends the facets of a lattice, with a value a point.
fn cut(
    points: &[Point; 3],
    flags: u32,
    values: &[f64],
    parts: u32,
    lens: &Lens,
    out: &mut Vec<Facet>,
) {
    // Rows before i have parts + 1, parts, .. points.
    let number = |[i, j]: [u32; 2]| i * (parts + 1) - i * i.saturating_sub(1) / 2 + j;
    let at = |place: [u32; 2]| {
        let value = values[number(place) as usize];
        Point { value, ..mixed(points, weights(place, parts)) }
    };
    let side = |k: u32, lies: bool| if lies { flags & (9 << k) } else { 0 };
    for [i, j] in lattice(parts).filter(|[i, j]| i + j < parts) {
        let [a, b, c] = [[i, j], [i + 1, j], [i, j + 1]].map(at);
        let lines = side(0, j == 0) | side(1, i + j + 1 == parts) | side(2, i == 0);
        lens.facets(&[a, b, c], lines | flags & BACK, out);
        if i + j + 1 < parts {
            lens.facets(&[b, at([i + 1, j + 1]), c], flags & BACK, out);
        }
    }
}

fn mixed(points: &[Point; 3], weights: [f64; 3]) -> Point {
    let mix = |of: &dyn Fn(&Point) -> f64| (0..3).map(|k| weights[k] * of(&points[k])).sum();
    Point {
        clip: std::array::from_fn(|axis| mix(&|p| p.clip[axis])),
        normal: std::array::from_fn(|axis| mix(&|p| p.normal[axis])),
        view: std::array::from_fn(|axis| mix(&|p| p.view[axis])),
        value: mix(&|p| p.value),
    }
}
