//! Lens: triangles in clip space in, facets in pixels out.
//!
//! Triangles are cut at the near plane and a wide border round the picture, in f64, before they
//! are divided by w: what the rasteriser then gets is small and has no w. Corners are rounded to
//! 1/256 of a sample, the grid of rasterisers themselves, so that the same triangle covers the same
//! samples wherever a tile begins.

use super::SAMPLES;

/// The part of a sample that corners are rounded to.
const GRID: f64 = 256.0;

/// How far from the middle of the picture triangles reach, in half pictures.
const BORDER: f64 = 2.0;

/// The least w in front of the eye, beside the greatest of the triangle.
const W_LEAST: f64 = 1e-9;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// In clip space, visible where `0 <= z <= w`.
    pub clip: [f64; 4],
    /// The surface's normal on the viewer's side, of any length, in the camera's axes: right, up,
    /// towards the viewer.
    pub normal: [f64; 3],
    /// To the viewer, in the same axes.
    pub view: [f64; 3],
    /// What a heat map shows.
    pub value: f64,
}

impl Point {
    fn between(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * t;
        Self {
            clip: std::array::from_fn(|k| mix(self.clip[k], other.clip[k])),
            normal: std::array::from_fn(|k| mix(self.normal[k], other.normal[k])),
            view: std::array::from_fn(|k| mix(self.view[k], other.view[k])),
            value: mix(self.value, other.value),
        }
    }
}

/// A corner of a facet as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Corner {
    /// Samples from the left and from the top, depth, 1 / w.
    pub place: [f32; 4],
    /// Normal.
    pub normal: [f32; 3],
    /// The value of a heat map.
    pub value: f32,
    /// To the viewer.
    pub view: [f32; 3],
    /// In the first corner, bits: 1, 2, 4 for edges that are lines, from corner 0 to 1, 1 to 2, 2
    /// to 0; 8, 16, 32 for those of them on a patch's boundary; 64 for the back.
    pub flags: u32,
}

/// A triangle in pixels.
pub type Facet = [Corner; 3];

/// What of a triangle is before the viewer: a convex polygon, and for each corner whether the edge
/// that begins there is a line, and a boundary.
#[derive(Clone, Debug, Default)]
pub struct Clipped(Vec<(Point, u32)>);

/// From clip space to a picture.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Pixels of the picture.
    size: [u32; 2],
    /// Pixels of what is seen, in the middle of it.
    seen: [f64; 2],
}

impl Lens {
    /// Shows a viewport of so many pixels as large as it goes, its sides in their proportion.
    #[must_use]
    pub fn new(viewport: [u32; 2], size: [u32; 2]) -> Self {
        let ratio = |k: usize| f64::from(size[k]) / f64::from(viewport[k]);
        let scale = ratio(0).min(ratio(1));
        Self { size, seen: viewport.map(|side| f64::from(side) * scale) }
    }

    /// Appends the facets of a triangle, whose edges are lines as `flags` says (as
    /// `Corner::flags`).
    pub fn facets(&self, corners: &[Point; 3], flags: u32, facets: &mut Vec<Facet>) {
        let Clipped(polygon) = Clipped::new(corners, flags);
        if polygon.len() < 3 {
            return;
        }
        let at: Vec<Corner> = polygon.iter().map(|(point, _)| self.corner(point)).collect();
        for k in 1..polygon.len() - 1 {
            let mut facet = [at[0], at[k], at[k + 1]];
            // An edge of the fan is one of the polygon's only at its ends.
            let first = if k == 1 { polygon[0].1 } else { 0 };
            let last = if k == polygon.len() - 2 { polygon[k + 1].1 } else { 0 };
            facet[0].flags = first | polygon[k].1 << 1 | last << 2 | flags & BACK;
            if area(&facet) != 0.0 {
                facets.push(facet);
            }
        }
    }

    fn corner(&self, point: &Point) -> Corner {
        let [x, y, z, w] = point.clip;
        let samples = f64::from(SAMPLES);
        let place = |k: usize, along: f64| {
            let pixels = 0.5 * (f64::from(self.size[k]) + self.seen[k] * along);
            ((pixels * samples * GRID).round() / GRID) as f32
        };
        let length = point.normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        let length = if length > 0.0 { length } else { 1.0 };
        Corner {
            place: [place(0, x / w), place(1, -y / w), (z / w) as f32, (1.0 / w) as f32],
            normal: point.normal.map(|c| (c / length) as f32),
            value: point.value as f32,
            view: point.view.map(|c| c as f32),
            flags: 0,
        }
    }
}

/// The bit of `Corner::flags` for the back.
const BACK: u32 = 64;

/// The bits of an edge that is a line, and of one that is a boundary too, in `Clipped`.
const EDGE: u32 = 1 | 8;

/// How far inside a plane a point in clip space is.
type Distance<'a> = &'a dyn Fn(&[f64; 4]) -> f64;

impl Clipped {
    /// Cuts a triangle plane by plane (Sutherland and Hodgman 1974).
    #[must_use]
    pub fn new(corners: &[Point; 3], flags: u32) -> Self {
        let edge = |k: usize| (corners[k], flags >> k & EDGE);
        let mut polygon = vec![edge(0), edge(1), edge(2)];
        let w_least = W_LEAST * corners.iter().map(|p| p.clip[3].abs()).fold(0.0, f64::max);
        let distances: [Distance<'_>; 7] = [
            &|p| p[3] - w_least,
            &|p| p[2],
            &|p| p[3] - p[2],
            &|p| BORDER * p[3] - p[0],
            &|p| BORDER * p[3] + p[0],
            &|p| BORDER * p[3] - p[1],
            &|p| BORDER * p[3] + p[1],
        ];
        for distance in distances {
            polygon = cut(&polygon, distance);
        }
        // A w of 0 that lies on its plane.
        polygon.retain(|(point, _)| point.clip[3] > 0.0);
        Self(polygon)
    }

    /// Its corners in clip space.
    pub fn corners(&self) -> impl Iterator<Item = [f64; 4]> {
        self.0.iter().map(|(point, _)| point.clip)
    }
}

fn cut(polygon: &[(Point, u32)], distance: &dyn Fn(&[f64; 4]) -> f64) -> Vec<(Point, u32)> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &(from, edge)) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()].0;
        let (a, b) = (distance(&from.clip), distance(&to.clip));
        if a >= 0.0 {
            kept.push((from, edge));
        }
        if (a >= 0.0) != (b >= 0.0) {
            // What leaves goes on along the plane, which is no line; what comes back is one.
            kept.push((from.between(&to, a / (a - b)), if a >= 0.0 { 0 } else { edge }));
        }
    }
    kept
}

/// Twice the area on the screen, in square samples.
fn area(facet: &Facet) -> f32 {
    let [a, b, c] = facet.map(|corner| corner.place);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(clip: [f64; 4]) -> Point {
        Point { clip, normal: [0.0, 0.0, 2.0], view: [0.0, 0.0, 1.0], value: clip[0] }
    }

    fn facets(corners: [[f64; 4]; 3], flags: u32) -> Vec<Facet> {
        let mut facets = Vec::new();
        Lens::new([100, 50], [200, 200]).facets(&corners.map(at), flags, &mut facets);
        facets
    }

    #[test]
    fn a_triangle_in_sight_is_one_facet_in_the_middle_of_the_picture() {
        let seen = facets([[-1.0, -1.0, 0.5, 1.0], [2.0, -2.0, 1.0, 2.0], [0.0, 1.0, 0.0, 1.0]], 9);
        assert_eq!(seen.len(), 1);
        // Twice as large, 200 by 100 pixels, 50 above and below; three samples a pixel.
        let places = seen[0].map(|corner| corner.place);
        assert_eq!(places[0], [0.0, 450.0, 0.5, 1.0]);
        assert_eq!(places[1], [600.0, 450.0, 0.5, 0.5]);
        assert_eq!(places[2], [300.0, 150.0, 0.0, 1.0]);
        assert_eq!(seen[0][0].flags, 9);
        assert_eq!((seen[0][1].normal, seen[0][1].value), ([0.0, 0.0, 1.0], 2.0));
    }

    #[test]
    fn what_is_behind_the_near_plane_is_cut_off_and_its_cut_is_no_line() {
        let near = |z: f64| [z, 0.0, z, 1.0];
        let cut = facets([near(1.0), near(-1.0), [0.0, 1.0, 1.0, 1.0]], 7 | BACK);
        assert_eq!(cut.len(), 2);
        let values = cut.iter().flatten().map(|corner| corner.value);
        // Half-way from -1 to 0 the cut is at -1/2.
        let ends = [values.clone().fold(0.0_f32, f32::min), values.fold(0.0, f32::max)];
        assert_eq!(ends, [-0.5, 1.0]);
        // Of a fan of four corners: edges 0-1 and the cut; the last edge, and the whole one.
        let flags = cut.iter().map(|facet| facet[0].flags).collect::<Vec<_>>();
        assert_eq!(flags, [1 | BACK, 2 | 4 | BACK]);
        assert!(facets([near(-1.0), near(-2.0), [0.0, 1.0, -1.0, 1.0]], 7).is_empty());
        // Behind the eye, and flat on the screen.
        assert!(facets([[0.0, 0.0, 0.0, -1.0], [1.0, 0.0, 0.0, -1.0], [0.0; 4]], 0).is_empty());
        assert!(facets([near(0.2), near(0.3), near(0.4)], 0).is_empty());
    }

    #[test]
    fn what_reaches_far_out_of_sight_is_cut_at_the_border() {
        let wide = facets([[-1e9, -1.0, 0.5, 1.0], [1e9, -1.0, 0.5, 1.0], [0.0, 1e9, 0.5, 1.0]], 7);
        let places = wide.iter().flatten().map(|corner| corner.place);
        for [x, y, ..] in places {
            assert!((-300.0..=900.0).contains(&x) && (-450.0..=1050.0).contains(&y), "{x} {y}");
        }
    }
}
