//! The surface shader against counts by hand: the flat patch, uniform and tested, and its levels.

use super::{numbers, ops, patch};
use rtl_model::counter::{Block, Counter as C};
use tessim::config::{Boundary, Config, LevelPolicy, LevelScope, Normals, Reuse, Space, Unit};

/// Level 1: 7 x 7 places. Position 32 bits, coefficients 32 + 8 + 7, parameters 40 + 1.
fn surface(set: impl Fn(&mut Config)) -> [u64; 6] {
    numbers(ops(&shaded(set), Block::Surface))
}

fn shaded(set: impl Fn(&mut Config)) -> tessim::report::Report {
    patch(|c| {
        c.unit = Unit::Esc;
        (c.esc.level, c.esc.fixed_level, c.esc.mu) = (LevelPolicy::Fixed, 1, 0.0);
        set(c);
    })
}

/// Of each of four components 8 curves with 8 additions: of the net along u, and along v 4 bits
/// wider; of the boundary from either end. `[adds, bits]`.
const NET: [u64; 2] = [4 * 64, 4 * (32 * 36 + 32 * 40)];
const RUNS: [u64; 2] = [4 * 64, 4 * 64 * 36];

/// So many points inside, on the boundary, and slots: what the mesh takes besides.
fn points(inside: u64, boundary: u64, slots: u64) -> [u64; 6] {
    let steps = inside * 15 * 4 + boundary * 3 * 4;
    let rounded = (inside + boundary) * 4;
    [
        steps + rounded + slots,
        steps * 47 + rounded * 32 + slots * 5,
        steps,
        steps * 47 * 41,
        3 * slots,
        3 * slots * 9,
    ]
}

fn sum(parts: &[[u64; 6]]) -> [u64; 6] {
    std::array::from_fn(|k| parts.iter().map(|part| part[k]).sum())
}

fn adds([adds, bits]: [u64; 2]) -> [u64; 6] {
    [adds, bits, 0, 0, 0, 0]
}

#[test]
fn a_surface_takes_a_net_four_curves_and_horner_for_each_point() {
    // 21 coarse edges within the patch with a point each, and the 4 corners of the middle cell; 20
    // points of the boundary that are no corners; 18 triangles of 4 slots.
    let uniform = [adds(NET), adds(RUNS), points(25, 20, 72)];
    assert_eq!(surface(|_| {}), sum(&uniform));
    assert_eq!(sum(&uniform)[..3], [256 + 256 + 1500 + 240 + 180 + 72, 106_844, 1740]);
    // Plain boundaries are as dear as all others.
    let plain = surface(|c| c.esc.boundary = Boundary::Plain);
    assert_eq!(plain, sum(&[adds(NET), points(45, 0, 72)]));
    // Each vertex of a strip on its own: 3 + 5 of each of 18 coarse triangles. In sections of nine:
    // two nets, and the seven points between them twice.
    let none = shaded(|c| c.esc.reuse = Reuse::None);
    let split = shaded(|c| (c.esc.output_values, c.esc.level_max) = (Some(9 * 8 * 8), 1));
    for (report, nets, all) in [(none, 1, 144), (split, 2, 49 + 7)] {
        let [evaluated, boundary, corners] =
            [C::SurfaceEvaluations, C::SurfaceBoundary, C::SurfaceCorners].map(|c| report.total(c));
        assert_eq!(evaluated + corners, all);
        let shared = [NET[0] + RUNS[0], NET[1] + RUNS[1]].map(|n| nets * n);
        let want = sum(&[adds(shared), points(evaluated - boundary, boundary, 72)]);
        assert_eq!(numbers(ops(&report, Block::Surface)), want);
    }
    let normals = surface(|c| c.evaluate.normals = Normals::TangentPlane);
    assert_eq!(normals[2] - surface(|_| {})[2], 49 * (60 * 8 + 12 + 12));
}

#[test]
fn a_test_takes_its_point_and_a_distance() {
    // A plane: nothing is inserted. 33 candidates, 12 of them on the boundary; of the mesh 8 there
    // and 4 inside; 18 strips of 3 places.
    let shape = [adds(NET), adds(RUNS), points(4 + 21, 8 + 12, 54)];
    let pixels = surface(|c| c.esc.mu = 1.0);
    // A vec4 between two; two points projected as the level block does; two dimensions.
    let [add, mul, compare] = [4 + 2 * 4 + 3, 12 + 2 * 10 + 2, 2 * 2 + 1];
    let known = sum(&shape);
    assert_eq!(pixels[0], known[0] + 33 * add);
    assert_eq!(pixels[2], known[2] + 33 * mul);
    assert_eq!(pixels[4], known[4] + 33 * compare);
    // In object units: three components of a net, an interpolation of three, three dimensions.
    let object = |c: &mut Config| (c.esc.mu, c.esc.space) = (0.1, Space::Object);
    let tested = surface(object);
    assert_eq!(tested[0], known[0] + 3 * 64 + 33 * (3 + 5));
    assert_eq!(tested[2], known[2] + 33 * (9 + 3));
    assert_eq!(tested[4], known[4] + 33);
    // Differences of 33 bits, squares of 66, their sums of 67 and 68.
    let bits = 3 * (32 * 36 + 32 * 40) + 33 * (3 * 37 + 3 * 33 + 2 * 67);
    assert_eq!(tested[1], known[1] + bits);
    assert_eq!(tested[3], known[3] + 33 * (6 * 32 * 5 + 3 * 37 * 32 + 3 * 33 * 33));
    assert_eq!(tested[5], known[5] + 33 * 68);
    // The port has each point twice.
    assert_eq!(numbers(ops(&shaded(object), Block::Port)), [128, 128 * 32, 0, 0, 0, 0]);
    assert_eq!(numbers(ops(&shaded(|_| {}), Block::Port)), [64, 64 * 32, 0, 0, 0, 0]);
}

#[test]
fn levels_of_resolution_take_comparisons() {
    let level = |set: fn(&mut Config)| numbers(ops(&shaded(set), Block::Level));
    assert_eq!(level(|_| {}), [0; 6], "a fixed level is none's to choose");
    // 16 w against the near threshold, the least of four edges' and of all 16; of five levels 15
    // multiples, 7 of which are sums, and the greatest of five.
    let distance = level(|c| c.esc.level = LevelPolicy::Distance);
    let compare = 16 + 12 + 15;
    let bits = [5 * 7 * 36, compare * 32 + 75 * 36 + 4 * 5];
    assert_eq!(distance, [35, bits[0], 0, 0, compare + 75 + 4, bits[1]]);
    // The driver's are nobody's here.
    let object = level(|c| {
        (c.esc.level, c.esc.scope) = (LevelPolicy::Distance, LevelScope::Object);
    });
    assert_eq!(object, [0; 6]);
    // A criterion's own comparisons (a fixed level's 16), and the thirds.
    let criterion = level(|c| c.esc.level = LevelPolicy::Criterion);
    let thirds = [0, 0, 0, 0, 90 + 5, 90 * 24 + 5 * 5];
    assert_eq!(criterion, sum(&[[0, 0, 0, 0, 16, 12 * 64 + 4 * 24], thirds]));
}
