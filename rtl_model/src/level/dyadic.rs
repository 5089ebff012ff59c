//! Dyadic lists for a patch: those of its edges and of its interior.
//!
//! Sfarti et al. 2005: eight curves, four of the boundary and four of the net's inside, say where
//! the patch is divided. A row of the net is no curve of the surface: it is there for the test
//! alone. What the eight cannot see is a twist, whose eight curves are straight; so there is
//! another termination, by the bounds that the levels come from.

use super::bound::{COLUMNS, ROWS};
use super::subdivide::{Subdivide, Subdivision};
use super::{Criterion, Events, State, accept, pixels};
use crate::patch::{Dyadic, EDGES, Level, Levels, Lists, Patch, View};
use serde::{Deserialize, Serialize};

/// When midpoint subdivision ends, where the criterion is flatness. By edge length, and at fixed
/// levels, a list has as many equal segments as its level, rounded up to a power of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// Each of the eight curves when it is flat, piece by piece.
    EightCurves,
    /// As many equal segments as the bound of the surface's second derivatives asks for, rounded
    /// up to a power of two.
    Bounded,
}

/// Chooses the lists of a patch. The state's bounds, rounded up to powers of two, hold for every
/// list: they are the least and the greatest depth.
#[must_use]
pub fn subdivide(
    patch: &Patch,
    view: &View,
    state: &State,
    termination: Termination,
) -> (Lists, Events) {
    match (state.criterion, termination) {
        (Criterion::Flatness { pixels }, Termination::EightCurves) => {
            let depths = [state.min, state.max].map(depth);
            eight_curves(patch, &Subdivide { view, pixels, depths })
        }
        _ => {
            let (levels, events) = accept(patch, view, state);
            (uniform(&levels), events)
        }
    }
}

fn eight_curves(patch: &Patch, subdivide: &Subdivide<'_>) -> (Lists, Events) {
    let (pixels, mut events) = pixels(patch, subdivide.view);
    let mut curve = |line: [usize; 4]| -> Subdivision {
        let done = subdivide.projected(&line.map(|k| patch.points[k]), line.map(|k| pixels[k]));
        events.splits += done.splits;
        done
    };
    let edges = EDGES.map(&mut curve);
    let [rows, columns] = [ROWS, COLUMNS].map(|lines| [lines[1], lines[2]].map(&mut curve));
    let union = |inner: [Subdivision; 2]| inner[0].list.union(inner[1].list);
    let clamped = |inner: [Subdivision; 2]| u32::from(inner[0].clamped || inner[1].clamped);
    events.clamped = edges.iter().map(|edge| u32::from(edge.clamped)).sum::<u32>()
        + clamped(rows)
        + clamped(columns);
    (Lists::new(edges.map(|edge| edge.list), union(rows), union(columns)), events)
}

/// The depth of a level: its logarithm to base 2, rounded up.
fn depth(level: Level) -> u32 {
    u32::BITS - (level.fx16() - 1).leading_zeros() - 16
}

/// As many equal segments as the levels, rounded up to powers of two.
fn uniform(levels: &Levels) -> Lists {
    let list = |level| Dyadic::uniform(depth(level));
    let edges = levels.edges.map(list);
    let [mut u, mut v] = levels.interior.map(list);
    // What the interior has beyond its edges stands on inner rows (columns): without one of them
    // it would be lost, and the bound with it.
    let beyond = |list: Dyadic, a: usize, b: usize| edges[a].union(edges[b]) != list;
    let row = Dyadic::uniform(1);
    if v == Dyadic::NONE && beyond(u, 0, 2) {
        v = row;
    } else if u == Dyadic::NONE && beyond(v, 1, 3) {
        u = row;
    }
    Lists::new(edges, u, v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_rounded_up_to_a_power_of_two() {
        let mut compared = 0;
        for fx16 in 1 << 16..=1 << 23 {
            let level = Level::clamped(fx16);
            let depth = depth(level);
            let segments = 1_u64 << (16 + depth);
            assert!(segments >= fx16 && (depth == 0 || segments / 2 < fx16), "{fx16}");
            compared += 1;
        }
        assert_eq!(compared, (1 << 23) - (1 << 16) + 1);
    }

    #[test]
    fn an_interior_beyond_its_edges_has_a_row_to_stand_on() {
        let level = |n: u64| Level::clamped(n << 16);
        let lists = |edges: [u64; 4], u, v| {
            let lists =
                uniform(&Levels { edges: edges.map(level), interior: [level(u), level(v)] });
            [lists.u().segments(), lists.v().segments()]
        };
        assert_eq!(lists([1; 4], 1, 1), [1, 1]);
        assert_eq!(lists([4, 1, 1, 1], 4, 1), [4, 1], "v0 has all of it");
        assert_eq!(lists([4, 1, 1, 1], 5, 1), [8, 2]);
        assert_eq!(lists([1; 4], 3, 1), [4, 2]);
        assert_eq!(lists([1; 4], 1, 3), [2, 4]);
        assert_eq!(lists([1, 3, 1, 1], 1, 3), [1, 4]);
    }
}
