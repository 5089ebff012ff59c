//! Resolution: what a policy asks of each coarse edge, as a real number of segments, and the
//! levels that follow: the quotient that the hardware never forms, in f64, and its ceiling.
//!
//! Raw coordinates have at most 47 bits and a sign, and N at most 5, so N full is exact, and a
//! quotient up to 16 that is no integer differs from the next by 2^-47 at least: more than its
//! rounding.

use super::super::level::{self, Criterion, Pixel};
use rtl_model::patch::{EDGES, Point, View};

/// Segments of a coarse edge; `None` where a point has no projection, which asks for the greatest
/// number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Of the edges v0, u1, v1, u0.
    pub edges: [Option<f64>; 4],
    /// Of the interior along u and along v.
    pub interior: [Option<f64>; 2],
}

/// By distance: `most` segments for as long as the nearest of the points is within `full`.
#[must_use]
pub fn distance(points: &[Point; 16], view: &View, full: f64, most: f64) -> Asked {
    let segments = |line: &[usize]| {
        let nearest = line.iter().map(|&k| points[k][3]).min()?;
        (nearest > 0 && nearest >= view.near).then(|| most * full / nearest as f64)
    };
    let all: Vec<usize> = (0..16).collect();
    Asked { edges: EDGES.map(|edge| segments(&edge)), interior: [segments(&all); 2] }
}

/// By the length of the projected control polygon: `most` segments at `full` pixels, each
/// polygon taken to be `longer` pixels longer.
#[must_use]
pub fn screen_size(pixels: &[Pixel; 16], full: f64, most: f64, longer: f64) -> Asked {
    let length = level::asked(pixels, Criterion::EdgeLength(1.0), [0.0, f64::MAX]);
    let segments = |length: Option<f64>| Some(most * (length? + longer) / full);
    Asked { edges: length.edges.map(segments), interior: length.interior.map(segments) }
}

/// By levels of whole edges.
#[must_use]
pub fn thirds(edges: [f64; 4], interior: [f64; 2]) -> Asked {
    let third = |level: f64| Some(level / 3.0);
    Asked { edges: edges.map(third), interior: interior.map(third) }
}

impl Asked {
    /// The levels of the edges and of the pattern, for at most `most` segments.
    #[must_use]
    pub fn levels(&self, most: f64) -> ([u8; 4], u8) {
        let granted = |asked: Option<f64>| asked.unwrap_or(most).ceil().clamp(1.0, most) as u8 - 1;
        let edges = self.edges.map(granted);
        let all = edges.into_iter().chain(self.interior.map(granted));
        (edges, all.max().expect("six levels"))
    }

    /// How many of the six ask for more than `most`.
    #[must_use]
    pub fn above(&self, most: f64) -> u32 {
        let all = self.edges.into_iter().chain(self.interior);
        all.flatten().filter(|&asked| asked > most).count() as u32
    }
}
