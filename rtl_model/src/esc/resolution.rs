//! Resolution: a patch in, the level L of its pattern and of each of its edges out.
//!
//! Concheiro et al. 2014, section 2.2: "the level of resolution of each object depends on the
//! camera position"; section 3 gives one L to a patch. How it depends they do not say, nor what
//! becomes of neighbours of different L. Here the level is a property of the edge: a function of
//! the edge's own four points, the frame and the settings, the same from either end, so that both
//! neighbours know it. The pattern has the greatest of its edges' levels and of what the policy
//! asks for the interior; an edge of a lower level carries fewer candidates.
//!
//! N = `level_max` + 1 is the segments of a coarse edge at full detail. What a policy asks for is
//! a number of segments, L + 1 = ceil(asked), at least 1 and at most N:
//!
//! - criterion: the level of the tessellation state's criterion, in thirds, for a patch edge has
//!   three coarse edges: the smallest L with 3 (L + 1) >= level.
//! - distance: N full / w. A segment of fixed length is projected to a length that falls as 1 / w,
//!   so beyond `full` the segments on the screen keep the size that they have there. Of w the
//!   smallest of the edge's points counts, or of all sixteen: the curve is not nearer.
//! - screen size: N length / pixels, length being that of the projected control polygon; of the
//!   interior, the longest row or column.
//! - fixed, object: as given.
//!
//! Every decision is exact: ceil(a / b) is 1 + the number of k >= 1 with k b < a, so that fifteen
//! comparisons with constant multiples of b are all the hardware there is, and no quotient is
//! formed or rounded.

use super::{LEVEL_MAX, Levels};
use crate::level::{self, Events, State, in_front};
use crate::patch::{EDGES, Level, ONE, Patch, View};

/// How levels of resolution are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// By the tessellation state of the draw.
    Criterion,
    /// This level, edges and interior alike.
    Fixed(u8),
    /// Full detail up to a distance from the eye plane, and inversely proportional beyond.
    Distance {
        /// The greatest w at full detail: raw, in the position format; not negative.
        full: i64,
    },
    /// In proportion to the length on the screen.
    ScreenSize {
        /// The least length at full detail: pixels in UQ16.16, at least 1 ulp.
        pixels: u32,
    },
    /// This level, which the driver has chosen for the whole draw.
    Object(u8),
}

/// The settings of the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// How levels are chosen.
    pub policy: Policy,
    /// The greatest level, at most [`LEVEL_MAX`].
    pub level_max: u8,
}

/// Chooses the levels of a patch.
///
/// Of the six levels that are asked for, those of the four edges and of the interior along u and
/// v, the ones above what `level_max` (or the state) allows are counted as clamped; by distance,
/// none is. Edges of which a point has no projection have the greatest level and are counted as
/// near; by distance, where a w is below the near threshold or not positive.
///
/// # Panics
/// When `level_max` is above [`LEVEL_MAX`], or a policy's distance or length is out of its range.
#[must_use]
pub fn accept(
    patch: &Patch,
    view: &View,
    state: &State,
    resolution: &Resolution,
) -> (Levels, Events) {
    let level_max = resolution.level_max;
    assert!(level_max <= LEVEL_MAX, "a level of at most 15");
    match resolution.policy {
        Policy::Criterion => criterion(patch, view, state, level_max),
        Policy::Fixed(level) | Policy::Object(level) => {
            let clamped = if level > level_max { 6 } else { 0 };
            let level = level.min(level_max);
            (Levels { edges: [level; 4], interior: level }, Events { clamped, ..Events::default() })
        }
        Policy::Distance { full } => distance(patch, view, full, level_max),
        Policy::ScreenSize { pixels } => screen_size(patch, view, pixels, level_max),
    }
}

/// The smallest L with (L + 1) `unit` >= `all`, at most `level_max`.
fn least(all: u128, unit: u128, level_max: u8) -> u8 {
    (1..=level_max).filter(|&k| u128::from(k) * unit < all).count() as u8
}

/// A pattern is never coarser than its edges.
fn levels(edges: [u8; 4], interior: impl IntoIterator<Item = u8>) -> Levels {
    Levels { edges, interior: edges.into_iter().chain(interior).fold(0, u8::max) }
}

fn criterion(patch: &Patch, view: &View, state: &State, level_max: u8) -> (Levels, Events) {
    // The criterion is told what edges can get at most, for the interior's bound looks at what
    // they really get.
    let most = Level::clamped(3 * u64::from(level_max + 1) * u64::from(ONE));
    let within = State { min: state.min.min(most), max: state.max.min(most), ..*state };
    let (granted, mut events) = level::accept(patch, view, &within);
    if state.min > most {
        events.clamped = 6; // whatever is asked for
    }
    let thirds = |level: Level| least(level.fx16().into(), u128::from(3 * ONE), level_max);
    (levels(granted.edges.map(thirds), granted.interior.map(thirds)), events)
}

fn distance(patch: &Patch, view: &View, full: i64, level_max: u8) -> (Levels, Events) {
    assert!(full >= 0, "a distance is not negative");
    let all = u128::from(full.unsigned_abs()) * u128::from(level_max + 1); // W + 4 bits
    let mut events = Events::default();
    let nearest = |line: &[usize]| {
        let least = line.iter().map(|&k| patch.points[k][3]).min().expect("a line has points");
        in_front(least, view).then_some(least.unsigned_abs())
    };
    let level = |w: Option<u64>| w.map_or(level_max, |w| least(all, w.into(), level_max));
    let edges = EDGES.map(|edge| nearest(&edge));
    events.near = edges.iter().filter(|w| w.is_none()).count() as u32;
    let interior = nearest(&std::array::from_fn::<usize, 16, _>(|k| k));
    (levels(edges.map(level), [level(interior)]), events)
}

fn screen_size(patch: &Patch, view: &View, pixels: u32, level_max: u8) -> (Levels, Events) {
    assert!(pixels > 0, "a length of at least an ulp");
    let (lengths, mut events) = level::lengths(patch, view);
    let mut level = |length: Option<u64>| {
        let Some(length) = length else { return level_max };
        events.clamped += u32::from(length > u64::from(pixels));
        // 44 bits of length, 4 of N; 32 bits of pixels, 4 of k
        let all = u128::from(length) * u128::from(level_max + 1);
        least(all, pixels.into(), level_max)
    };
    let edges = lengths.edges.map(&mut level);
    let interior = lengths.interior.map(level);
    (levels(edges, interior), events)
}

#[cfg(test)]
mod tests;
