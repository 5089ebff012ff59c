//! Levels of resolution, worked by hand.

use super::*;
use crate::level::Criterion;
use crate::number::Format;
use crate::patch::{Depth, Point};

/// Points `at(j, i)`, j along u.
fn patch(at: impl Fn(i64, i64) -> Point) -> Patch {
    let points = std::array::from_fn(|k| at(k as i64 % 4, k as i64 / 4));
    Patch { id: 0, points, saturated: false, cull: true, reversed: false }
}

/// A pixel is a hundredth of x / w.
fn view() -> View {
    View {
        position: Format::of_range(32, 0),
        viewport: [200, 200],
        depth: Depth::ZeroToOne,
        near: 10,
        facing: 1,
    }
}

fn state(criterion: Criterion) -> State {
    State { criterion, min: Level::MIN, max: Level::clamped(64 << 16) }
}

fn fixed(level: u32) -> State {
    state(Criterion::Fixed { level: Level::clamped(level.into()) })
}

fn chosen(patch: &Patch, state: &State, policy: Policy, level_max: u8) -> (Levels, Events) {
    accept(patch, &view(), state, &Resolution { policy, level_max })
}

fn same(level: u8) -> Levels {
    Levels { edges: [level; 4], interior: level }
}

#[test]
fn distance_gives_full_detail_within_and_the_inverse_beyond() {
    // N = 4: ceil(400 / w) segments.
    let table = [
        (10, 3), // the near threshold itself
        (99, 3),
        (100, 3),
        (133, 3),
        (134, 2),
        (199, 2),
        (200, 1),
        (399, 1),
        (400, 0),
        (1 << 31, 0),
    ];
    for (w, level) in table {
        let patch = patch(|j, i| [j, i, 0, w]);
        let got = chosen(&patch, &fixed(ONE), Policy::Distance { full: 100 }, 3);
        assert_eq!(got, (same(level), Events::default()), "{w}");
    }
    let (got, _) =
        chosen(&patch(|_, _| [0, 0, 0, 99]), &fixed(ONE), Policy::Distance { full: 0 }, 15);
    assert_eq!(got, same(0));
}

#[test]
fn distance_takes_the_nearest_point_of_each_edge() {
    let policy = Policy::Distance { full: 100 };
    let rows = patch(|_, i| [0, 0, 0, 100 * (i + 1)]);
    let (got, events) = chosen(&rows, &fixed(ONE), policy, 3);
    assert_eq!(got, Levels { edges: [3, 3, 0, 3], interior: 3 });
    assert_eq!(events, Events::default());
    let inside = patch(|j, i| [0, 0, 0, if (j, i) == (2, 1) { 150 } else { 400 }]);
    let (got, _) = chosen(&inside, &fixed(ONE), policy, 3);
    assert_eq!(got, Levels { edges: [0; 4], interior: 2 });
    let near = patch(|j, i| [0, 0, 0, if (j, i) == (2, 0) { 9 } else { 400 }]);
    let (got, events) = chosen(&near, &fixed(ONE), policy, 3);
    assert_eq!(got, Levels { edges: [3, 0, 0, 0], interior: 3 });
    assert_eq!(events, Events { near: 1, ..Events::default() });
}

#[test]
fn screen_size_compares_control_polygons_with_a_length() {
    // Rows of 30 pixels, columns of 60.
    let patch = patch(|j, i| [100 * j, 200 * i, 0, 1000]);
    let table = [
        (15, [3, 3], 6),
        (30, [3, 3], 3),
        (40, [2, 3], 3), // ceil(4 30 / 40) = 3 segments; 60 above 40: two edges and the interior
        (41, [2, 3], 3),
        (60, [1, 3], 0),
        (61, [1, 3], 0), // 3.93 segments
        (80, [1, 2], 0),
        (119, [1, 2], 0),
        (120, [0, 1], 0),
        (240, [0, 0], 0),
    ];
    for (pixels, [row, column], clamped) in table {
        let policy = Policy::ScreenSize { pixels: pixels << 16 };
        let got = chosen(&patch, &fixed(ONE), policy, 3);
        let levels = Levels { edges: [row, column, row, column], interior: row.max(column) };
        assert_eq!(got, (levels, Events { clamped, ..Events::default() }), "{pixels}");
    }
    let policy = Policy::ScreenSize { pixels: (60 << 16) - 1 };
    let (got, events) = chosen(&patch, &fixed(ONE), policy, 14);
    assert_eq!((got.edges, events.clamped), ([7, 14, 7, 14], 3), "7.5 segments and 15");
}

#[test]
fn inner_rows_and_points_without_projection_count() {
    let bent = patch(|j, i| [100 * j, if i == 1 { 300 * (j % 2) } else { 0 }, 0, 1000]);
    let policy = Policy::ScreenSize { pixels: 200 << 16 };
    let (got, _) = chosen(&bent, &fixed(ONE), policy, 15);
    // 16 30 / 200; columns 0, or 60 where they go out and back; row 1 is 3 sqrt(10^2 + 30^2) long.
    assert_eq!(got, Levels { edges: [2, 4, 2, 0], interior: 7 });
    let near = patch(|j, i| [0, 0, 0, if (j, i) == (3, 3) { 0 } else { 1000 }]);
    let (got, events) = chosen(&near, &fixed(ONE), policy, 15);
    assert_eq!(got, Levels { edges: [0, 15, 15, 0], interior: 15 });
    assert_eq!(events, Events { near: 2, ..Events::default() });
}

#[test]
fn a_level_of_the_criterion_is_in_thirds() {
    let any = patch(|j, i| [100 * j, 100 * i, 0, 1000]);
    let table = [
        (ONE, 0, 0),
        (3 * ONE, 0, 0),
        (3 * ONE + 1, 1, 0),
        (6 * ONE, 1, 0),
        (7 * ONE, 2, 0),
        (12 * ONE, 3, 0),
        (12 * ONE + 1, 3, 6), // the greatest level is 3
    ];
    for (level, want, clamped) in table {
        let got = chosen(&any, &fixed(level), Policy::Criterion, 3);
        assert_eq!(got, (same(want), Events { clamped, ..Events::default() }), "{level}");
    }
    let bounded = |min: u64, max: u64, level: u32| {
        let state = State {
            min: Level::clamped(min << 16),
            max: Level::clamped(max << 16),
            ..fixed(level * ONE)
        };
        let (levels, events) = chosen(&any, &state, Policy::Criterion, 3);
        assert_eq!(levels, same(levels.interior));
        (levels.interior, events.clamped)
    };
    assert_eq!(bounded(1, 5, 9), (1, 6), "the state's greatest level counts");
    assert_eq!(bounded(1, 20, 30), (3, 6), "once, where both cut");
    assert_eq!(bounded(8, 20, 1), (2, 0));
    assert_eq!(bounded(13, 20, 1), (3, 6), "a least level that is not reached");
    assert_eq!(bounded(12, 20, 1), (3, 0));
}

#[test]
fn levels_of_edges_and_of_the_interior_are_clamped_each() {
    // Rows of 30 pixels, columns of 60: levels 10 and 20 of which 12 are to be had.
    let lengths = patch(|j, i| [100 * j, 200 * i, 0, 1000]);
    let state = state(Criterion::EdgeLength { pixels: 3 << 16 });
    let (got, events) = chosen(&lengths, &state, Policy::Criterion, 3);
    assert_eq!(got, same(3)); // 10 needs four thirds too
    assert_eq!(events, Events { clamped: 3, ..Events::default() });
    let (got, events) = chosen(&lengths, &state, Policy::Criterion, 15);
    assert_eq!(got, Levels { edges: [3, 6, 3, 6], interior: 6 });
    assert_eq!(events, Events::default());
}

#[test]
fn given_levels_are_taken_up_to_the_greatest() {
    let any = patch(|_, _| [0; 4]);
    for policy in [Policy::Fixed, Policy::Object] {
        assert_eq!(chosen(&any, &fixed(ONE), policy(7), 7), (same(7), Events::default()));
        let clamped = Events { clamped: 6, ..Events::default() };
        assert_eq!(chosen(&any, &fixed(ONE), policy(8), 7), (same(7), clamped));
        assert_eq!(chosen(&any, &fixed(ONE), policy(0), 0), (same(0), Events::default()));
    }
}
