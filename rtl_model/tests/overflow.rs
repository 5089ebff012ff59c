//! Sticky counts: values that do not fit are fitted and counted by evaluate and by level.

use rtl_model::evaluate::{Evaluate, Scheme, Settings};
use rtl_model::level::{self, Criterion, State};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Level, Levels, Patch, View};
use rtl_model::place::Placement;

fn patch(points: [[i64; 4]; 16]) -> Patch {
    Patch { id: 0, points, saturated: false, cull: true, reversed: false }
}

/// A patch just inside the format, run with one guard bit for 63 steps.
#[test]
fn evaluate_counts_and_fits_what_its_error_carries_out_of_the_format() {
    let position = Format::of_range(16, 0);
    let max = position.max();
    // Within 2^10 of the end, where the error of 63 steps from rounded coefficients exceeds what
    // is left.
    let below = |k: i64| max - k * 619 % 1024;
    let high = patch(std::array::from_fn(|k| [1, 5, 11, 29].map(|n| below(n * (k as i64 + 3)))));
    let low = patch(high.points.map(|p| p.map(|c| c / 64)));
    let mut placement = Placement::default();
    let fine = Level::clamped(127 << 16 | 54_321);
    placement.set(&Levels { edges: [fine; 4], interior: [fine; 2] });
    for overflow in Overflow::ALL {
        let rounding = Rounding::NearestEven;
        let settings = Settings { position, guard: 1, scheme: Scheme::Forward, rounding, overflow };
        let run = |patch| {
            let mut vertices = Vec::new();
            let cost = Evaluate::new(settings).accept(patch, &placement, &mut vertices);
            let fits = |c: &i64| (-max - 1..=max).contains(c);
            assert!(vertices.iter().flat_map(|v| &v.position).all(fits), "{overflow:?}");
            cost.overflows
        };
        assert!(run(&high) > 0, "{overflow:?}: an overflow went uncounted");
        assert_eq!(run(&low), 0, "{overflow:?}");
    }
}

#[test]
fn level_counts_points_whose_projection_does_not_fit_and_takes_them_for_near() {
    let view = View {
        position: Format::of_range(32, 0),
        viewport: [1280, 1024],
        depth: Depth::ZeroToOne,
        near: 1,
        facing: 1,
    };
    let max = Level::clamped(16 << 16);
    let criterion = Criterion::Flatness { pixels: 1 << 16 };
    let state = State { criterion, min: Level::MIN, max };
    let w = 1 << 20;
    let mut points = [[0, 0, 0, w]; 16];
    assert_eq!(level::accept(&patch(points), &view, &state).1, level::Events::default());
    // 2^30 / 1 * 640 pixels for one corner: two edges have no projection.
    points[0] = [1 << 30, 0, 0, 1];
    let (levels, events) = level::accept(&patch(points), &view, &state);
    assert_eq!((events.overflows, events.near), (1, 2));
    assert_eq!(levels.edges, [max, Level::MIN, Level::MIN, max]);
    assert_eq!(levels.interior, [max; 2]);
}
