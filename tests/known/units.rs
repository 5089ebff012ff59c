//! Counts by hand in the units `sfarti` and `moreton`, and what either does whatever is set.

use super::{Config, Unit, fixed, mesh_text, run_text, shipped};
use rtl_model::counter::Block;
use rtl_model::counter::Counter as C;
use rtl_model::counter::Counters;
use rtl_model::level::Termination;
use tessim::config::{Scheme, Union};
use tessim::report::Report;

fn unit(unit: Unit) -> Config {
    Config { unit, ..Config::default() }
}

pub(super) fn compare(totals: &Counters, known: &[(C, u64)]) {
    for (counter, value) in known {
        assert_eq!(totals.get(*counter), *value, "{counter:?}");
    }
}

#[test]
fn a_teapot_by_midpoints_is_what_arithmetic_says() {
    // 5 segments are not to be had by midpoints: 8 are.
    for level in ["8", "5"] {
        let report = run_text(&fixed("teapot", level), &unit(Unit::Sfarti)).expect("a teapot");
        let known = [
            (C::LinkControlPoints, 6144),
            (C::LinkFactors, 0),
            (C::TransformInvocations, 512),
            (C::ClipIn, 32),
            (C::LevelPatches, 32),
            (C::LevelSplits, 0), // a fixed level is looked at, not subdivided
            (C::PlaceReciprocals, 0),
            (C::PlaceParameters, 32 * (4 * 8 + 7 + 7)),
            (C::PlaceMeasured, 0),
            (C::EvaluateVertices, 32 * 81),
            (C::EvaluateInvocations, 32 * (81 + 4 * 7)), // and control points of seven rows
            (C::EvaluateCurves, 0),
            // Seven inner points of four edges and of four columns of the net, seven by seven.
            (C::EvaluateSteps, 32 * (28 + 28 + 49)),
            (C::EvaluateStrips, 32 * (6 + 4)), // gaps between seven rows, sides
            (C::StitchTriangles, 32 * 2 * 8 * 8),
            (C::EmitBytes, 2592 * 16 + 4096 * 6),
        ];
        compare(&report.totals(), &known);
    }
}

/// A plane square seen from above, whose eight curves are straight.
fn square(set: impl Fn(&mut Config)) -> Report {
    let mut config = unit(Unit::Sfarti);
    set(&mut config);
    run_text(&mesh_text(1, 1, false, 1), &config).expect("a square")
}

#[test]
fn depths_are_those_of_the_least_and_the_greatest_level() {
    let flat = square(|_| {}).totals();
    compare(&flat, &[(C::LevelSplits, 0), (C::StitchTriangles, 2), (C::EvaluateInvocations, 4)]);
    // Level 3 is depth 2: three divisions of each curve, four segments by four.
    let least = square(|c| c.level.min_level = Some(3.0)).totals();
    compare(&least, &[(C::LevelSplits, 8 * 3), (C::StitchTriangles, 32), (C::EmitVertices, 25)]);
    // Nothing can be projected: every curve is divided to the greatest depth, that of level 5.
    let near = square(|c| (c.level.near, c.level.max_level) = (Some(2.0), Some(5.0))).totals();
    let known =
        [(C::LevelSplits, 8 * 7), (C::LevelNear, 4), (C::LevelClamped, 0), (C::EmitVertices, 81)];
    compare(&near, &known);
}

/// A hundredth of a pixel is more than two segments, or sixteen, can keep, but where curves are
/// straight.
#[test]
fn no_list_exceeds_the_greatest_depth() {
    for (termination, max) in [
        (Termination::EightCurves, 2.0),
        (Termination::EightCurves, 9.0),
        (Termination::Bounded, 2.0),
        (Termination::Bounded, 9.0),
    ] {
        let mut config = unit(Unit::Sfarti);
        (config.level.pixels, config.level.max_level) = (Some(0.01), Some(max));
        config.level.termination = termination;
        let totals = run_text(&shipped("teaspoon"), &config).expect("a teaspoon").totals();
        let n = if max > 2.0 { 16 } else { 2 };
        let (patches, triangles) = (totals.get(C::LevelPatches), totals.get(C::StitchTriangles));
        let most = patches * 2 * n * n;
        let what = format!("{termination:?}, {max}: {triangles} triangles of {most}");
        assert!(triangles <= most && 10 * triangles > 9 * most && patches > 0, "{what}");
        assert!(totals.get(C::LevelClamped) > patches, "{what}");
        let splits = if termination == Termination::Bounded { 0 } else { 8 * (n - 1) * patches };
        let found = totals.get(C::LevelSplits);
        assert!(found <= splits && 10 * found >= 9 * splits, "{what}: {found} of {splits}");
    }
}

#[test]
fn two_passes_fetch_and_test_twice_and_look_once() {
    for resident in [false, true] {
        let text = mesh_text(4, 5, resident, 3);
        let mut config = unit(Unit::Sfarti);
        config.level.min_level = Some(2.0);
        let own = run_text(&text, &config).expect("a mesh");
        config.level.union = Union::Primitive;
        config.block.level.interval = 7;
        let both = run_text(&text, &config).expect("a mesh");
        let points = 13 * 16;
        let bursts = if resident { (12_u64 * points).div_ceil(32) } else { 0 };
        let read = if resident { 12 * points } else { 0 };
        let known = [
            (C::TracePatches, 60),
            (C::AssembleMeasured, 60),
            (C::AssemblePatches, 120),
            (C::AssembleReceived, 2 * 3 * points),
            (C::AssembleReused, 2 * 3 * (320 - points)),
            (C::TransformInvocations, 2 * 3 * points),
            (C::PortPoints, 2 * 3 * points),
            (C::MemoryReadControlPoints, 2 * 3 * read),
            (C::MemoryBursts, (1 + 2 * 3) * bursts),
            (C::ClipIn, 120),
            (C::BackfaceTested, 120),
            (C::LevelPatches, 60),
            (C::LevelSplits, 60 * 8),
            (C::PlaceMeasured, 60),
            (C::PlaceListsPeak, 4 + 5),
            (C::PlaceParameters, 60 * (8 + 1 + 1)),
            (C::StitchTriangles, 60 * 8),
            (C::EmitVertices, 60 * 9),
        ];
        compare(&both.totals(), &known);
        let tokens = |block| {
            let k = both.chain.iter().position(|stage| stage.block == block).expect("it is timed");
            let work = both.whole().work[k];
            (work.tokens_in, work.tokens_out)
        };
        assert_eq!(tokens(Block::Level), (120, 120));
        assert_eq!(tokens(Block::Place), (120, 60));
        // Eight pieces and two of each division are looked at; the second time it passes by.
        let rows = both.rows(&both.whole());
        let used = rows.iter().find(|r| r.block == Block::Level && r.name == "cycles.used");
        assert_eq!(used.map(|row| row.value), Some(60 * ((8 + 2 * 8) * 7 + 1)));
        assert_eq!(own.host_link_bytes, both.host_link_bytes);
        assert_eq!(own.total(C::LinkTotal), both.total(C::LinkTotal), "sent once");
    }
}

#[test]
fn a_teapot_before_transform_is_what_arithmetic_says() {
    let report = run_text(&fixed("teapot", "8"), &unit(Unit::Moreton)).expect("a teapot");
    let known = [
        (C::LinkControlPoints, 6144),
        (C::LinkFactors, 16 * 32), // four floats a patch
        (C::TransformInvocations, 0),
        (C::PortPoints, 512),
        (C::ClipIn, 0),
        (C::BackfaceIn, 0),
        (C::LevelPatches, 32),
        (C::PlaceReciprocals, 32),
        (C::PlaceParameters, 32 * (4 * 8 + 7 + 7)),
        (C::EvaluateCurves, 32 * 2 * 15),
        (C::EvaluateSteps, 32 * 15 * 6),
        (C::StitchTriangles, 4096),
        (C::EmitVertices, 2592),
        (C::EmitToClipper, 0), // nothing is divided yet
        (C::VertexShaderInvocations, 2592),
    ];
    compare(&report.totals(), &known);
    // Culled is nothing, whatever the draw says.
    let culls = run_text(&shipped("teapot"), &unit(Unit::Moreton)).expect("a teapot");
    assert_eq!(culls.total(C::LevelPatches), culls.total(C::TracePatches));
}

#[test]
fn what_a_unit_does_whatever_is_set_is_in_its_configuration() {
    let effective = |unit| {
        let mut config = Config { unit, ..Config::default() };
        config.level.union = Union::Primitive;
        let effective = config.effective();
        assert_eq!(effective.effective(), effective);
        (effective.evaluate.scheme, effective.emit.divide, effective.level.union)
    };
    assert_eq!(effective(Unit::Hybrid), (Scheme::Forward, true, Union::Off));
    assert_eq!(effective(Unit::Triangles), (Scheme::Forward, true, Union::Off));
    assert_eq!(effective(Unit::Sfarti), (Scheme::DeCasteljau, true, Union::Primitive));
    assert_eq!(effective(Unit::Moreton), (Scheme::Forward, false, Union::Off));
}
