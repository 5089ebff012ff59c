//! Tokens and arithmetic against counts by hand: one flat patch at level 4, and what each scheme
//! and method adds to it.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

#[path = "arithmetic/esc.rs"]
mod esc;

use rtl_model::counter::Block;
use rtl_model::counter::standard::{Ops, Work};
use std::io::BufReader;
use tessim::config::{BackfaceMethod, Config, Criterion, Normals, Scheme, Unit};
use tessim::report::Report;
use tessim::sink::NoMesh;
use tessim::trace::read::Reader;

/// A plane patch that faces the viewer, under a parallel projection.
fn patch(set: impl Fn(&mut Config)) -> Report {
    let points: Vec<_> = (0..16).map(|k| format!("[{},{},0]", k % 4, k / 4)).collect();
    let identity = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
    let text = format!(
        "{{\"tessim\":1}}\n\
         {{\"frame\":{{\"viewport\":[64,64],\"view\":{identity},\
         \"projection\":[0.1,0,0,0,0,0.1,0,0,0,0,-0.01,0,0,0,0.5,1]}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{}]}}}}\n\
         {{\"draw\":{{\"primitive\":\"patches\",\"points\":0,\"count\":1}}}}\n\
         {{\"end\":{{}}}}\n",
        points.join(",")
    );
    let mut config = Config::default();
    config.level.level = Some(4.0);
    set(&mut config);
    let reader = Reader::new(BufReader::new(text.as_bytes()), "text", "traces");
    tessim::simulate(reader.map(|l| Ok(l?.command)), &config, &mut NoMesh).unwrap()
}

fn work(report: &Report, block: Block) -> Work {
    let k = report.chain.iter().position(|stage| stage.block == block).unwrap();
    report.whole().work[k]
}

fn ops(report: &Report, block: Block) -> Ops {
    work(report, block).ops.unwrap()
}

/// `[add, add.bits, mul, mul.bits, compare, compare.bits]`
fn numbers(ops: Ops) -> [u64; 6] {
    [ops.add, ops.add_bits, ops.mul, ops.mul_bits, ops.compare, ops.compare_bits]
}

#[test]
fn one_patch_at_level_4_takes_the_operations_that_a_hand_counts() {
    let report = patch(|_| {});
    // 16 points, a 4 x 4 matrix each
    let transform = [16 * 12, 16 * 12 * 24, 16 * 16, 16 * 16 * 576, 0, 0];
    assert_eq!(numbers(ops(&report, Block::Transform)), transform);
    // 4 coordinates of 32 bits
    assert_eq!(numbers(ops(&report, Block::Port)), [64, 64 * 32, 0, 0, 0, 0]);
    // 16 points, 6 planes
    assert_eq!(numbers(ops(&report, Block::Clip)), [0, 0, 0, 0, 96, 96 * 32]);
    // A fixed level: six levels of 64 bits against min and max, four comparisons of 24 bits.
    assert_eq!(numbers(ops(&report, Block::Level)), [0, 0, 0, 0, 16, 12 * 64 + 4 * 24]);
    // One distinct level: 3 Newton steps from 8 bits to 33, and the exact quotient's multiplication
    // and addition; level / 2 rounded up. 16 parameters on the boundary, 3 along each of u and v.
    let place = [
        3 + 1 + 1 + 22,
        3 * 33 + (33 + 24) + 24 + 22 * 33,
        3 * 2 + 1,
        6 * 33 * 33 + 33 * 24,
        23,
        23 * 24,
    ];
    assert_eq!(numbers(ops(&report, Block::Place)), place);
    // Eleven curves: 4 edges, 4 columns of the net, 3 rows. From either end of each one step, then
    // the middle. Registers of 32 + 20 + 3 bits.
    let steps = 11 * 2 * 12;
    // Per component a = b3 - b0 + 3 (b1 - b2), b and c of both ends: 4 + 2 * 5 of 36 bits; sums of
    // products 1 + 2 * 3 of 103.
    let set_up = [11 * 4 * 14, 11 * 4 * 7];
    let middle = 11 * 4 * 4;
    // R^2 and R^3; per component a h3 and both b h2 of 36 x 64, both c R of 36 x 32.
    let products = 11 * (2 + 4 * 5);
    let product_bits = 11 * (32 * 32 + 64 * 32 + 4 * (3 * 36 * 64 + 2 * 36 * 32));
    let evaluate = [
        steps + set_up[0] + set_up[1] + middle,
        steps * 55 + set_up[0] * 36 + set_up[1] * 103 + middle * 35,
        products,
        product_bits,
        0,
        0,
    ];
    assert_eq!(numbers(ops(&report, Block::Evaluate)), evaluate);
    // The same as figures: a formula on both sides could share a mistake.
    assert_eq!(evaluate, [1364, 74_580, 242, 439_296, 0, 0]);
    // 2 * 4 * 4 triangles
    assert_eq!(numbers(ops(&report, Block::Stitch)), [32, 32 * 8, 0, 0, 32, 32 * 8]);
    // 25 vertices: x + w, w - y; two products with the size; two Newton steps to 32 bits; two
    // quotients of 47 over 32 bits, of 24 bits, each made exact; w > 0.
    let emit = [
        25 * (2 + 2 + 2),
        25 * (2 * 33 + 2 * 32 + 2 * 56),
        25 * (2 + 4 + 2 * 2),
        25 * (2 * 33 * 15 + 4 * 32 * 32 + 2 * (47 * 32 + 24 * 32)),
        25,
        25 * 32,
    ];
    assert_eq!(numbers(ops(&report, Block::Emit)), emit);
    let homogeneous = patch(|c| c.emit.divide = false);
    assert_eq!(numbers(ops(&homogeneous, Block::Emit)), [0; 6], "nothing is divided");
    let unclipped = patch(|c| c.clip.enabled = false);
    assert_eq!(numbers(ops(&unclipped, Block::Clip)), [0; 6], "nothing is tested");
    for block in [Block::Link, Block::Memory, Block::Assemble, Block::VertexShader] {
        assert_eq!(work(&report, block).ops, None, "{} has no arithmetic", block.name());
    }
}

#[test]
fn back_face_tests_cost_their_definitions() {
    let test = |method| patch(|c| c.backface.method = method);
    assert_eq!(numbers(ops(&test(BackfaceMethod::Off), Block::Backface)), [0; 6]);
    let tangent = numbers(ops(&test(BackfaceMethod::TangentPlane), Block::Backface));
    // Differences 24 x 3; binomials 24 x 3; cross products 144 x 3 and their sums (144 - 36) x 3;
    // dot products 576 x 2 and their sums 576 - 81. Widths 33, 36, 73, 110.
    let adds = [72, 72, 144 * 3 + 108 * 3, 576 * 2 + 495];
    assert_eq!(tangent[0], adds.iter().sum::<u64>());
    assert_eq!(tangent[1], adds[0] * 33 + adds[1] * 36 + adds[2] * 73 + adds[3] * 110);
    assert_eq!(tangent[2], 144 * 6 + 576 * 3);
    assert_eq!(tangent[3], 144 * 6 * 36 * 36 + 576 * 3 * 36 * 73);
    assert_eq!(tangent[4..], [81, 81 * 110]);
    let facets = numbers(ops(&test(BackfaceMethod::NetFacets), Block::Backface));
    assert_eq!([facets[0], facets[2], facets[4]], [3 * 39 + 36 * 5, 36 * 9, 36]);
    let cone = numbers(ops(&test(BackfaceMethod::NormalCone), Block::Backface));
    // 24 differences, 12 with a binomial; 144 cross products into 36 coefficients; sums of 16 and
    // of 36 directions; dot products of the axes, each with each and itself. 52 times: a dot
    // product of an axis and a direction less its error, the direction's length, a square and two
    // products to compare. At last two quotients (three Newton steps, a product, a correction, and
    // one for the divisor), five roots of two Newton steps, and seven products.
    let adds = [72, 36, 144 * 3, 108 * 3, 150, 3 * 2 + 4, 52 * (3 + 3 + 2), 2 * (3 + 1), 5 * 2, 3];
    let muls = [144 * 6, 3 * 3, 52 * (3 + 3 + 1 + 2), 2 * (3 * 2 + 2 + 1), 5 * (2 * 3 + 2), 6];
    assert_eq!([cone[0], cone[2]], [adds.iter().sum::<u64>(), muls.iter().sum::<u64>()]);
    assert_eq!(cone[4], 1 + 52 * 2 + 5 + 2);
    let hull = numbers(ops(&test(BackfaceMethod::HullLiteral), Block::Backface));
    // 119 differences, all but one of two points; 560 triples: a cross product, 14 dot products
    // and signs.
    let hull_by_hand = [3 * 119 + 560 * (3 + 14 * 2), 560 * (6 + 14 * 3), 560 * 14];
    assert_eq!([hull[0], hull[2], hull[4]], hull_by_hand);
    let untested = patch(|c| c.position.clip_range_log2 = Some(0)); // saturated points
    assert_eq!(ops(&untested, Block::Backface).mul, 0);
}

#[test]
fn schemes_and_normals_cost_what_they_evaluate() {
    let evaluate = |scheme| ops(&patch(|c| c.evaluate.scheme = scheme), Block::Evaluate);
    // 6 interpolations of a vec4 a point: 12 of the boundary, 12 of the rows' ends, 9 inside.
    let points = 12 + 12 + 9;
    let casteljau = evaluate(Scheme::DeCasteljau);
    assert_eq!((casteljau.add, casteljau.mul), (points * 25, points * 48));
    assert_eq!(casteljau.mul_bits, points * 48 * 32 * 17);
    // Four curves of the boundary by differences, 21 points inside.
    let mixed = evaluate(Scheme::Mixed);
    assert_eq!(mixed.mul, 4 * 22 + 21 * 48);
    assert_eq!(mixed.add, 4 * (2 * 12 + 84 + 16) + 21 * 25);
    let normals = |normals| ops(&patch(|c| c.evaluate.normals = normals), Block::Evaluate);
    let [with, without] = [Normals::TangentPlane, Normals::Off].map(normals);
    // 60 interpolations, 6 minors of 2 products, 4 of 3
    assert_eq!(with.mul - without.mul, 25 * (60 * 8 + 12 + 12));
    // Level 2 runs nothing: eight boundary points of which four are middles, a middle for each of
    // four columns, one inside.
    let two = patch(|c| c.level.level = Some(2.0));
    assert_eq!(numbers(ops(&two, Block::Evaluate)), [9 * 16, 9 * 16 * 35, 0, 0, 0, 0]);
    let one = patch(|c| c.level.level = Some(1.0));
    assert_eq!(numbers(ops(&one, Block::Evaluate)), [0; 6]);
}

#[test]
fn criteria_cost_the_pixels_that_they_look_at() {
    let level = |criterion| {
        let set = |c: &mut Config| {
            (c.level.criterion, c.level.pixels, c.level.level) = (Some(criterion), Some(1.0), None);
        };
        ops(&patch(set), Block::Level)
    };
    let fixed = ops(&patch(|_| {}), Block::Level);
    // Sixteen points: two products with the size, two Newton steps, two exact quotients.
    let project = 16 * (2 + 4 + 2 * 2);
    // A root of 41 bits: three steps of three products, times x, squared again.
    let length = 24 * (2 + 3 * 3 + 2);
    assert_eq!(level(Criterion::EdgeLength).mul, project + length + 8);
    assert_eq!(level(Criterion::EdgeLength).compare, fixed.compare + 16 * 2 + 24 + 6);
    // 25 squares of two products; 7 roots of 42 bits and 6 of 24 (two steps); the bound.
    let bound = 6 + 2 * (1 + 6 + 2 + 8);
    let flat = 25 * 2 + 7 * 11 + 6 * (1 + 8) + bound;
    assert_eq!(level(Criterion::Flatness).mul, project + flat);
}

#[test]
fn tokens_are_those_of_one_patch() {
    let report = patch(|_| {});
    let tokens: Vec<_> = report
        .chain
        .iter()
        .map(|stage| {
            let work = work(&report, stage.block);
            (stage.block, work.tokens_in, work.tokens_out)
        })
        .collect();
    let expected = [
        (Block::Link, 4, 4), // three commands and a patch
        (Block::Memory, 4, 16),
        (Block::Transform, 16, 16),
        (Block::Port, 16, 16),
        (Block::Assemble, 16, 1),
        (Block::Clip, 1, 1),
        (Block::Backface, 1, 1),
        (Block::Level, 1, 1),
        (Block::Place, 1, 1),
        (Block::Evaluate, 1, 10), // two gaps between three rows, eight half-sides
        (Block::Stitch, 10, 32),
        (Block::Emit, 32, 25),
        (Block::VertexShader, 25, 25),
    ];
    assert_eq!(tokens, expected);
    let strips = |level| {
        let set = |c: &mut Config| (c.level.level, c.level.max_level) = (Some(level), Some(128.0));
        work(&patch(set), Block::Evaluate).tokens_out
    };
    assert_eq!(strips(1.0), 1, "two triangles");
    // A gap between two rows, two half-sides with a segment and a middle one on each side.
    assert_eq!(strips(1.5), 1 + 4 * 3);
    assert_eq!(strips(2.0), 8, "no row is above another");
    assert_eq!(strips(128.0), 126 + 8);
    let host = patch(|c| c.unit = Unit::Triangles);
    let [link, shader] = [Block::Link, Block::VertexShader].map(|block| work(&host, block));
    assert_eq!((link.tokens_in, link.tokens_out), (4, 25)); // a frame, a draw, vertices, indices
    assert_eq!((shader.tokens_in, shader.tokens_out), (25, 25));
}

#[test]
fn a_unit_costs_what_it_does() {
    let of = |unit, set: fn(&mut Config)| {
        patch(|c| {
            c.unit = unit;
            set(c);
        })
    };
    // Fixed, by midpoints: the hybrid's comparisons, and six levels rounded up.
    let fixed = of(Unit::Sfarti, |_| {});
    let level = [6, 6 * 24, 0, 0, 16, 12 * 64 + 4 * 24];
    assert_eq!(numbers(ops(&fixed, Block::Level)), level);
    assert_eq!(numbers(ops(&fixed, Block::Place)), [0; 6], "parameters are wires");
    assert_eq!(numbers(ops(&fixed, Block::Stitch)), [0, 0, 0, 0, 32, 32 * 8]);
    let points = 12 + 12 + 9; // as under de Casteljau above
    assert_eq!(ops(&fixed, Block::Evaluate).mul, points * 48);
    assert_eq!(ops(&fixed, Block::Evaluate).add, points * 25);
    // Eight straight curves, each divided once for the least level: a piece of each, and two of
    // each division.
    let curves = of(Unit::Sfarti, |c| {
        (c.level.level, c.level.pixels, c.level.min_level) = (None, Some(1.0), Some(2.0));
    });
    let (splits, pieces) = (8, 8 + 2 * 8);
    // A point: two products with the size, Newton's four (32 bits) or four (44), two quotients.
    let (project, projected) = (16 * (2 + 4 + 4), splits * 5 * (2 + 6 + 4));
    // Two areas, a quotient of two and its square, three squared lengths.
    let flat = pieces * (2 * 2 + 2 + 1 + 3 * 2);
    assert_eq!(ops(&curves, Block::Level).mul, project + projected + flat);
    // Newton's additions and a correction for each quotient; 18 sums; six differences, two areas,
    // a correction, three sums of squares.
    let adds = 16 * (2 + 2) + splits * (18 + 5 * (3 + 2)) + pieces * (6 + 2 + 1 + 3);
    assert_eq!(ops(&curves, Block::Level).add, adds);
    assert_eq!(ops(&curves, Block::Level).compare, 16 * 2 + splits * 5 * 2 + pieces * 4);
    let sums = 3 * (3 * 45 + 2 * 46 + 47);
    let newton = [2 * 32 + 2 * (40 + 32), 3 * 44 + 2 * (40 + 44)];
    let flat = 6 * 41 + 2 * 83 + (42 + 32) + 3 * 83;
    let bits = 16 * newton[0] + splits * (sums + 5 * newton[1]) + pieces * flat;
    assert_eq!(ops(&curves, Block::Level).add_bits, bits);
    // By the bound: what the hybrid does, and the rounding up.
    let by_bound: fn(&mut Config) = |c| {
        (c.level.level, c.level.pixels) = (None, Some(1.0));
        c.level.termination = tessim::config::Termination::Bounded;
    };
    let (bounded, hybrid) = (of(Unit::Sfarti, by_bound), of(Unit::Hybrid, by_bound));
    let rounding = Ops::default().adds(6, 24);
    assert_eq!(ops(&bounded, Block::Level), ops(&hybrid, Block::Level).with(1, rounding));
    // Levels are the driver's; a vertex program transforms 25 vertices.
    let moreton = of(Unit::Moreton, |_| {});
    assert!(moreton.chain.iter().all(|stage| stage.block != Block::Level));
    let program = [25 * 12, 25 * 12 * 24, 25 * 16, 25 * 16 * 576, 0, 0];
    assert_eq!(numbers(ops(&moreton, Block::VertexShader)), program);
    assert_eq!(numbers(ops(&moreton, Block::Emit)), [0; 6], "nothing is divided");
    let place = ops(&patch(|_| {}), Block::Place);
    assert_eq!(ops(&moreton, Block::Place).compare, 2 + 6);
    assert_eq!(ops(&moreton, Block::Place).add, place.add);
    assert_eq!(ops(&moreton, Block::Evaluate), ops(&patch(|_| {}), Block::Evaluate));
}
