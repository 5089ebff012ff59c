//! Raster: triangles on the sub-pixel grid in, what a rasteriser would make of them out.
//!
//! Everything is an integer. A pixel is covered when its centre lies inside a triangle, or on an
//! edge that is a top or a left one (the top-left rule of Direct3D and Vulkan): two triangles with
//! a common edge never both cover a pixel on it. Shading is of aligned quads of 2 by 2 pixels.

mod cover;

use rtl_model::emit::Screen;

pub use cover::Cover;

/// Classes of areas: below 4^-3 square pixels, from 4^-3, 4^-2, .. and from 4^6 on.
pub const CLASSES: usize = 11;

/// log4 of the least area of class 1.
pub const LEAST: i64 = -3;

/// What triangles are on the screen. Each is in one of the first five.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangles {
    /// A vertex is left to the clipper: behind the eye, or beyond the guard band.
    pub homogeneous: u64,
    /// Without area on the sub-pixel grid.
    pub zero_area: u64,
    /// Wholly to one side of the viewport.
    pub outside: u64,
    /// Front-facing.
    pub front: u64,
    /// Back-facing.
    pub back: u64,
    /// Front- and back-facing ones by their area.
    pub areas: [u64; CLASSES],
    /// Front- and back-facing ones that cover no pixel's centre.
    pub no_sample: u64,
    /// Pixels of the viewport covered, once for each triangle.
    pub samples: u64,
    /// Quads with a pixel covered, once for each triangle.
    pub quads: u64,
}

impl Triangles {
    /// All that were emitted.
    #[must_use]
    pub const fn all(&self) -> u64 {
        self.homogeneous + self.zero_area + self.outside + self.front + self.back
    }

    /// Front- and back-facing ones of less than a square pixel.
    #[must_use]
    pub fn sub_pixel(&self) -> u64 {
        self.areas[..=-LEAST as usize].iter().sum()
    }

    /// With those of another part of a frame, or of another frame.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        self.homogeneous += other.homogeneous;
        self.zero_area += other.zero_area;
        self.outside += other.outside;
        self.front += other.front;
        self.back += other.back;
        for (sum, area) in self.areas.iter_mut().zip(other.areas) {
            *sum += area;
        }
        self.no_sample += other.no_sample;
        self.samples += other.samples;
        self.quads += other.quads;
        self
    }
}

/// Where triangles are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Width and height in pixels.
    pub viewport: [u32; 2],
    /// Fraction bits of a coordinate, 0..=12.
    pub subpixel_bits: u32,
    /// Whether a triangle that is counter-clockwise on the screen is a front-facing one.
    pub front_is_counter_clockwise: bool,
}

/// Takes a triangle in: counts it, and marks its pixels.
///
/// # Panics
/// When `cover` is of another viewport.
pub fn triangle(target: &Target, corners: [Screen; 3], cover: &Cover, out: &mut Triangles) {
    if corners.iter().any(|corner| !corner.divided) {
        out.homogeneous += 1;
        return;
    }
    // In halves of the sub-pixel grid, on which centres of pixels lie.
    let corners = corners.map(|corner| [2 * i64::from(corner.x), 2 * i64::from(corner.y)]);
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0 {
        out.zero_area += 1;
        return;
    }
    let pixel = 2_i64 << target.subpixel_bits;
    let end = target.viewport.map(|size| i64::from(size) * pixel);
    let bounds = [0, 1].map(|axis| {
        let [a, b, c] = corners.map(|corner| corner[axis]);
        [a.min(b).min(c), a.max(b).max(c)]
    });
    if (0..2).any(|axis| bounds[axis][1] <= 0 || bounds[axis][0] >= end[axis]) {
        out.outside += 1;
        return;
    }
    // y grows downwards: a positive area is clockwise on the screen.
    let counter_clockwise = area < 0;
    if counter_clockwise == target.front_is_counter_clockwise {
        out.front += 1;
    } else {
        out.back += 1;
    }
    out.areas[class(area.unsigned_abs(), target.subpixel_bits)] += 1;
    let turned = if counter_clockwise { [a, c, b] } else { [a, b, c] };
    let before = out.samples;
    fill(turned, bounds, pixel, cover, out);
    out.no_sample += u64::from(out.samples == before);
}

/// The class of twice an area in squares of half the sub-pixel grid.
fn class(doubled: u64, subpixel_bits: u32) -> usize {
    // A square pixel is 2^(2 bits + 3) of them.
    let log2 = i64::from(doubled.ilog2()) - i64::from(2 * subpixel_bits + 3);
    (log2.div_euclid(2) - LEAST + 1).clamp(0, CLASSES as i64 - 1) as usize
}

/// Covers the pixels of a triangle that is clockwise on the screen, row by row.
fn fill(
    corners: [[i64; 2]; 3],
    bounds: [[i64; 2]; 2],
    pixel: i64,
    cover: &Cover,
    out: &mut Triangles,
) {
    let [width, height] = cover.viewport().map(i64::from);
    let edges = [0, 1, 2].map(|k| Edge::new(corners[k], corners[(k + 1) % 3], pixel));
    let first = |least: i64| (least + pixel / 2 - 1).div_euclid(pixel).max(0);
    let last = |most: i64, size: i64| (most - pixel / 2).div_euclid(pixel).min(size - 1);
    // The interval of quads that the row above, if it is of the same quads, touches.
    let mut above: Option<(i64, [i64; 2])> = None;
    for y in first(bounds[1][0])..=last(bounds[1][1], height) {
        let whole = [first(bounds[0][0]), last(bounds[0][1], width)];
        let span = edges.iter().fold(whole, |span, edge| edge.clip(span, y, pixel));
        if span[0] > span[1] {
            continue;
        }
        out.samples += (span[1] - span[0] + 1) as u64;
        cover.mark(y as u64, span.map(|x| x as u64));
        let quads = span.map(|x| x / 2);
        let shared = match above {
            Some((row, of)) if row == y / 2 => {
                (quads[1].min(of[1]) - quads[0].max(of[0]) + 1).max(0)
            }
            _ => 0,
        };
        out.quads += (quads[1] - quads[0] + 1 - shared) as u64;
        above = Some((y / 2, quads));
    }
}

/// An edge of a clockwise triangle, whose inside is to its right.
struct Edge {
    /// Where it begins.
    from: [i64; 2],
    /// Where it leads.
    by: [i64; 2],
    /// 0 where pixels on the edge belong to the triangle, else 1.
    bias: i64,
    /// What a pixel to the right adds to how far inside a point is, negated.
    step: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2], pixel: i64) -> Self {
        let by = [to[0] - from[0], to[1] - from[1]];
        // Up along the left side, and to the right along the top.
        let is_top_left = by[1] < 0 || by[1] == 0 && by[0] > 0;
        Self { from, by, bias: i64::from(!is_top_left), step: by[1] * pixel }
    }

    /// What of a span of pixels in row `y` is inside. All is below 2^60: corners have 29 bits.
    fn clip(&self, [first, last]: [i64; 2], y: i64, pixel: i64) -> [i64; 2] {
        let centre = pixel / 2;
        let down = self.by[0] * (y * pixel + centre - self.from[1]);
        let inside = down + self.by[1] * (self.from[0] - centre) - self.bias;
        match self.step {
            0 if inside < 0 => [1, 0],
            0 => [first, last],
            step if step > 0 => [first, last.min(inside.div_euclid(step))],
            step => [first.max(-inside.div_euclid(-step)), last],
        }
    }
}

#[cfg(test)]
mod tests;
