//! Emit: vertices in, screen positions out.
//!
//! Perspective divide and viewport in one exact quotient, rounded once: x_screen = (x + w) width / (2 w), and y from
//! the upper edge down, y_screen = (w - y) height / (2 w), both Q16.`subpixel_bits`. A vertex with w <= 0, or outside
//! the band of +-32768 pixels that the format holds, stays homogeneous: the clipper must see it first.

use crate::number::{
    Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch, divide, divide_narrow,
};
use crate::patch::{Point, Triangle, Vertex, View};

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Screen {
    /// Pixels from the left edge, Q16.`subpixel_bits`.
    pub x: i32,
    /// Pixels from the upper edge, Q16.`subpixel_bits`.
    pub y: i32,
    /// Whether the vertex was divided; if not, `x` and `y` are 0 and the clipper gets it homogeneous.
    pub divided: bool,
}

/// The block's format and policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Fraction bits of a screen coordinate, 0..=12.
    pub subpixel_bits: u32,
    /// How a screen coordinate is rounded.
    pub rounding: Rounding,
}

/// Appends the screen positions of a patch's vertices to `out`. Returns how many stay homogeneous.
pub fn accept(vertices: &[Vertex], view: &View, settings: Settings, out: &mut Vec<Screen>) -> u64 {
    let work = Work { vertices, view, subpixel_bits: settings.subpixel_bits, out };
    dispatch(settings.rounding, Overflow::Saturate, work)
}

/// Triangles with two equal clip positions.
#[must_use]
pub fn degenerate(vertices: &[Vertex], triangles: &[Triangle]) -> u64 {
    let at = |k: u16| &vertices[usize::from(k)].position;
    let equal = |a: &Point, b: &Point| a[0] == b[0] && a == b;
    let is_degenerate = |t: &&Triangle| {
        let (a, b, c) = (at(t[0]), at(t[1]), at(t[2]));
        equal(a, b) || equal(b, c) || equal(c, a)
    };
    triangles.iter().filter(is_degenerate).count() as u64
}

struct Work<'a> {
    vertices: &'a [Vertex],
    view: &'a View,
    subpixel_bits: u32,
    out: &'a mut Vec<Screen>,
}

impl Modal for Work<'_> {
    type Output = u64;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> u64 {
        let Self { vertices, view, subpixel_bits, out } = self;
        let mut homogeneous = 0;
        out.extend(vertices.iter().map(|vertex| {
            let screen = project::<R>(vertex, view, subpixel_bits);
            homogeneous += u64::from(!screen.divided);
            screen
        }));
        homogeneous
    }
}

#[inline(always)]
fn project<R: RoundingMode>(vertex: &Vertex, view: &View, subpixel_bits: u32) -> Screen {
    let [x, y, _, w] = vertex.position;
    if w <= 0 {
        return Screen::default();
    }
    // (c + w) size 2^bits over 2 w: W + 1 + 14 + 12 bits over W + 1
    let pixel = |c: i64, size: u32| {
        let scale = i64::from(size) << subpixel_bits;
        match c.checked_mul(scale) {
            Some(scaled) => divide_narrow::<R>(scaled, 2 * w),
            None => {
                let wide = i128::from(c) * i128::from(scale);
                divide::<R>(wide, i128::from(2 * w)).try_into().unwrap_or(i64::MAX)
            }
        }
    };
    let (px, py) = (pixel(x + w, view.viewport[0]), pixel(w - y, view.viewport[1]));
    let band = 1_i64 << (15 + subpixel_bits);
    let inside = |p: i64| (-band..band).contains(&p);
    if inside(px) && inside(py) {
        Screen { x: px as i32, y: py as i32, divided: true }
    } else {
        Screen::default()
    }
}
