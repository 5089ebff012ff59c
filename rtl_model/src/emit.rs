//! Emit: vertices in, screen positions out.
//!
//! Perspective divide and viewport in one exact quotient, rounded once: x_screen = (x + w) width /
//! (2 w), and y from the upper edge down, y_screen = (w - y) height / (2 w), both
//! Q16.`subpixel_bits`. A vertex with w <= 0, or outside the band of +-32768 pixels that the format
//! holds, stays homogeneous: the clipper must see it first.

mod schedule;

use crate::number::{
    Divisor, Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch, divide,
};
use crate::patch::{Vertex, View};

pub use schedule::Schedule;

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Screen {
    /// Pixels from the left edge, Q16.`subpixel_bits`.
    pub x: i32,
    /// Pixels from the upper edge, Q16.`subpixel_bits`.
    pub y: i32,
    /// Whether the vertex was divided; if not, `x` and `y` are 0 and the clipper gets it
    /// homogeneous.
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

/// A vertex on the screen, or nothing of it where the clipper must see it first.
#[inline(always)]
fn project<R: RoundingMode>(vertex: &Vertex, view: &View, subpixel_bits: u32) -> Screen {
    let [x, y, _, w] = vertex.position;
    if w <= 0 {
        return Screen::default();
    }
    // (c + w) size 2^bits over 2 w, W + 14 + bits over W bits
    let band = 1_u64 << (15 + subpixel_bits);
    let [width, height] = view.viewport.map(|size| i64::from(size) << subpixel_bits);
    let [px, py] = if view.position.width + 16 + subpixel_bits <= 62 {
        let divisor = Divisor::new(2 * w as u64);
        let pixel = |c: i64, size: i64| divisor.divide::<R>(c * size, band);
        [pixel(x + w, width), pixel(w - y, height)]
    } else {
        let pixel = |c: i64, size: i64| {
            let quotient = divide::<R>(i128::from(c) * i128::from(size), i128::from(2 * w));
            i64::try_from(quotient).unwrap_or(i64::MAX)
        };
        [pixel(x + w, width), pixel(w - y, height)]
    };
    let inside = |p: i64| (p.wrapping_add(band as i64) as u64) < 2 * band;
    if inside(px) && inside(py) {
        Screen { x: px as i32, y: py as i32, divided: true }
    } else {
        Screen::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Format;
    use crate::patch::Depth;
    use proptest::prelude::*;

    /// The definition in 128 bits, for any vertex.
    fn direct(vertex: &Vertex, view: &View, bits: u32, rounding: Rounding) -> Screen {
        let [x, y, _, w] = vertex.position.map(i128::from);
        if w <= 0 {
            return Screen::default();
        }
        let pixel = |n: i128| {
            let (q, rest) = (n.div_euclid(2 * w), n.rem_euclid(2 * w));
            let nearer_above = match rounding {
                Rounding::Floor => false,
                Rounding::NearestUp => rest >= w,
                Rounding::NearestEven => rest > w || rest == w && q % 2 != 0,
                Rounding::NearestAway => rest > w || rest == w && n > 0,
            };
            q + i128::from(nearer_above)
        };
        let [width, height] = view.viewport.map(|s| i128::from(s) << bits);
        let (px, py) = (pixel((x + w) * width), pixel((w - y) * height));
        let band = 1 << (15 + bits);
        if [px, py].iter().all(|p| (-band..band).contains(p)) {
            Screen { x: px as i32, y: py as i32, divided: true }
        } else {
            Screen::default()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn every_width_divides_as_the_definition_says(
            width in 8u32..=48, bits in 0u32..=12, parts in prop::array::uniform3(-1f64..1.0),
            small_w in 0u32..48, viewport in prop::array::uniform2(1u32..=16384), mode in 0usize..4,
        ) {
            let position = Format::of_range(width, 0);
            let raw = parts.map(|p| (p * position.max() as f64) as i64);
            let w = raw[2].abs() >> small_w.min(width - 2);
            let vertex = Vertex { position: [raw[0], raw[1] >> 3, 0, w], u: 0, v: 0 };
            let view = View { position, viewport, depth: Depth::ZeroToOne, near: 0, facing: 1 };
            let rounding = Rounding::ALL[mode];
            let mut out = Vec::new();
            let settings = Settings { subpixel_bits: bits, rounding };
            let homogeneous = accept(&[vertex], &view, settings, &mut out);
            prop_assert_eq!(out[0], direct(&vertex, &view, bits, rounding));
            prop_assert_eq!(homogeneous, u64::from(!out[0].divided));
        }
    }
}
