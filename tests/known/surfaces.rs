//! Counts by hand in the unit `esc`: the uniform pattern, tests, objects, sections, cracks.

use super::units::compare;
use super::{Config, Unit, esc, fixed, run, run_text, shipped};
use glam::Vec3;
use rtl_model::counter::{Counter as C, Counters};
use rtl_model::patch::ONE;
use std::collections::BTreeSet;
use std::io::BufReader;
use std::sync::Arc;
use tessim::config::{BackfaceMethod, Boundary, LevelPolicy, LevelScope, Reuse, Space};
use tessim::sink::NoMesh;
use tessim::trace::command::{Command, Draw, Primitive};
use tessim::trace::indices::{IndexFormat, Indices};
use tessim::trace::read::Reader;
use tessim::unit::simulate;

/// A fixed level, and so many pixels.
fn unit(level: u32, mu: f64) -> Config {
    let mut config = Config { unit: Unit::Esc, ..Config::default() };
    (config.esc.level, config.esc.fixed_level, config.esc.mu) = (LevelPolicy::Fixed, level, mu);
    config
}

/// The teapot with all 32 patches, whose levels are the unit's.
fn teapot(config: &Config) -> Counters {
    run_text(&fixed("teapot", "1"), config).expect("a teapot").totals()
}

/// The same with its meshes.
fn meshes(config: &Config) -> (Vec<run::Mesh>, Counters) {
    let text = fixed("teapot", "1");
    let reader = Reader::new(BufReader::new(text.as_bytes()), "text", "traces");
    let mut keep = run::Keep::default();
    let report = simulate(reader.map(|l| Ok(l?.command)), config, &mut keep).expect("a teapot");
    (keep.meshes, report.totals())
}

#[test]
fn a_teapot_of_surface_shaders_is_what_arithmetic_says() {
    // Level 3: 12 segments an edge, 13 x 13 points, strips of 3 + 5 + 7 + 9 vertices.
    let wave = 4 * (64 + 16 * 169 + 4 * 288); // a net, points, slots, of 4 cycles an instruction
    let known = [
        (C::LinkControlPoints, 6144),
        (C::LinkIndices, 0),
        (C::LinkFactors, 0),
        (C::TransformInvocations, 512),
        (C::ClipIn, 32),
        (C::LevelPatches, 32),
        (C::GroupWaves, 1), // of 64 lanes
        (C::GroupIdle, 32),
        (C::SurfaceInvocations, 32),
        (C::SurfaceControlPoints, 512),
        (C::SurfaceBytesIn, 32 * 256),
        (C::SurfaceObjectNets, 0),
        (C::SurfaceCorners, 32 * 4),
        (C::SurfaceBoundary, 32 * 44),
        (C::SurfaceCoarse, 32 * (21 * 3 + 4)), // edges within the patch, and where they meet
        (C::SurfaceInterior, 32 * 18 * 3),
        (C::SurfaceEvaluations, 32 * 165),
        (C::SurfacePoints, 32 * 169),
        (C::SurfaceStripVertices, 32 * 18 * 24),
        (C::SurfaceSlots, 32 * 288),
        (C::SurfaceTriangles, 32 * 288),
        (C::SurfaceMoved, 0),
        (C::SurfaceBufferPeak, 169 * 4 * 32),
        (C::SurfaceRegistersPeak, 64 * (32 + 8 + 7) + 32 * 32),
        (C::SurfaceLaneCycles, 64 * wave),
        (C::SurfaceUsedCycles, 32 * wave),
        (C::SurfaceIdleCycles, 32 * wave),
        (C::SurfaceBytesOut, 5408 * 32),
        (C::SurfaceAttributes, 0),
        (C::EmitVertices, 5408),
        (C::EmitBytes, 5408 * 16 + 9216 * 6),
        (C::VertexShaderInvocations, 0),
    ];
    compare(&teapot(&unit(3, 0.0)), &known);
}

#[test]
fn no_tolerance_is_the_uniform_pattern_through_the_whole_unit() {
    let mut compared = 0;
    for level in 0..=15 {
        let r = u64::from(level) + 1; // segments of a coarse edge
        let grid: BTreeSet<_> = (0..=3 * r)
            .flat_map(|j| (0..=3 * r).map(move |i| [i, j]))
            .map(|at| at.map(|line| (line as f64 * f64::from(ONE) / (3 * r) as f64).round() as u32))
            .collect();
        for (reuse, leave) in [
            (Reuse::Patch, (3 * r + 1).pow(2)),
            (Reuse::CoarseTriangle, 18 * (r + 1) * (r + 2) / 2),
            (Reuse::None, 18 * r * (r + 2)),
        ] {
            let mut config = unit(level, 0.0);
            config.esc.reuse = reuse;
            let (meshes, totals) = meshes(&config);
            let known = [
                (C::SurfaceTriangles, 32 * 18 * r * r),
                (C::SurfaceSlots, 32 * 18 * r * r),
                (C::SurfaceTests, 0),
                (C::SurfaceTested, 0),
                (C::SurfacePoints, 32 * (3 * r + 1).pow(2)),
                (C::SurfaceStripVertices, 32 * 18 * r * (r + 2)),
                (C::EmitVertices, 32 * leave),
            ];
            compare(&totals, &known);
            assert_eq!(meshes.len(), 32);
            for mesh in meshes {
                let places: BTreeSet<_> = mesh.vertices.iter().map(|v| [v.u, v.v]).collect();
                assert!(places == grid && mesh.vertices.len() == grid.len(), "level {level}");
                compared += grid.len();
            }
        }
    }
    println!("compared {compared} vertices");
}

#[test]
fn tests_are_those_of_coarse_edges_and_what_they_evaluate_alone() {
    for (reuse, edges) in [(Reuse::Patch, 33), (Reuse::CoarseTriangle, 54), (Reuse::None, 54)] {
        let mut config = unit(3, 60_000.0);
        config.esc.reuse = reuse;
        let none = teapot(&config);
        let known = [
            (C::SurfaceTests, 32 * 3 * edges),
            (C::SurfaceInserted, 0), // a sixtieth of a million of pixels is nowhere
            (C::SurfaceTested, 32 * 3 * edges),
            (C::SurfaceTestedBoundary, 32 * 3 * 12), // those edges have one coarse triangle
            (C::SurfacePoints, 32 * 16),
            (C::SurfaceTriangles, 32 * 18),
            (C::SurfaceSlots, 32 * 18 * 7), // one strip of seven places
        ];
        compare(&none, &known);
        // In object space no point serves mesh and test, and there is a second net.
        config.esc.space = Space::Object;
        let known = [
            (C::SurfaceTested, 32 * 3 * edges),
            (C::SurfaceObjectNets, 32),
            (C::SurfaceBytesIn, 32 * (256 + 192)),
        ];
        compare(&teapot(&config), &known);
    }
    let mut before = u64::MAX;
    for mu in [0.001, 0.03, 0.3, 1.0, 4.0, 30.0] {
        let totals = teapot(&unit(7, mu));
        let triangles = totals.get(C::SurfaceTriangles);
        assert!(triangles < before && triangles > 32 * 18, "{triangles} at {mu} pixels");
        assert!(triangles < 32 * 18 * 64, "{triangles} at {mu} pixels");
        // A point that is inserted is not evaluated for its test alone.
        let alone = totals.get(C::SurfaceTests) - totals.get(C::SurfaceInserted);
        assert_eq!(totals.get(C::SurfaceTested), alone);
        before = triangles;
    }
}

/// Objects of 2 patches with w = 5 and further away: by a translation along the view.
fn objects(distances: &[f64], config: &Config) -> Counters {
    let points: Vec<String> =
        (0..32).map(|k| format!("[{},{},0]", k % 4 - 1, k % 16 / 4 - 1)).collect();
    let models: Vec<String> =
        distances.iter().map(|w| format!("[1,0,0,0,0,1,0,0,0,0,1,0,0,0,{},1]", 5.0 - w)).collect();
    let text = format!(
        "{{\"tessim\":1}}\n\
         {{\"frame\":{{\"viewport\":[64,64],\"view\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,-5,1],\
         \"projection\":[1,0,0,0,0,1,0,0,0,0,-1.007874,-1,0,0,-0.503937,0]}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{}]}}}}\n\
         {{\"draw\":{{\"primitive\":\"patches\",\"points\":0,\"count\":2,\"cull\":false,\
         \"instances\":[{}]}}}}\n\
         {{\"end\":{{}}}}\n",
        points.join(","),
        models.join(",")
    );
    run_text(&text, config).expect("objects").totals()
}

#[test]
fn the_driver_gives_each_object_its_level_in_four_bytes() {
    // 8 segments at 5 and nearer; 40 / w beyond. The last is nearer than the near plane's 0.5.
    let distances = [5.0, 10.0, 12.0, 20.0, 40.0, 0.25];
    let segments: [u64; 6] = [8, 4, 4, 2, 1, 8];
    let triangles = 2 * 18 * segments.map(|r| r * r).iter().sum::<u64>();
    let mut config = unit(0, 0.0);
    config.clip.enabled = false;
    (config.esc.level_max, config.esc.full_distance, config.esc.full_pixels) = (7, 5.0, 20.0);
    // Three units of width are 96 / w pixels: 8 x 96 / 20 = 38.4, and as many segments.
    for level in [LevelPolicy::Distance, LevelPolicy::ScreenSize] {
        config.esc.level = level;
        config.esc.scope = LevelScope::Object;
        let known = [
            (C::LinkFactors, 4 * 6),
            (C::TracePatches, 12),
            (C::LevelPatches, 12),
            (C::LevelNear, 0), // the driver saw it
            (C::LevelEdgeLength, 0),
            (C::SurfaceTriangles, triangles),
            (C::SurfaceSlots, triangles),
        ];
        let object = objects(&distances, &config);
        compare(&object, &known);
        for (&w, r) in distances.iter().zip(segments) {
            let one = objects(&[w], &config);
            let known = [(C::LinkFactors, 4), (C::SurfaceTriangles, 2 * 18 * r * r)];
            compare(&one, &known);
        }
        config.esc.scope = LevelScope::Patch;
        let patch = objects(&distances, &config);
        assert_eq!((patch.get(C::LinkFactors), patch.get(C::LevelNear)), (0, 2 * 4), "{level:?}");
        let beside = patch.get(C::LinkTotal) + 24;
        assert_eq!(object.get(C::LinkTotal), beside, "{level:?}: nothing else crosses");
        if level == LevelPolicy::Distance {
            assert_eq!(patch.get(C::SurfaceTriangles), triangles, "a plane that faces the eye");
        }
    }
}

#[test]
fn an_object_is_what_its_draw_draws() {
    // Under one id a patch 5 from the eye plane, and one 19 from it: 8 segments and 40 / 19.
    let at = |k: usize| [(k % 4) as f32, (k % 16 / 4) as f32, if k < 16 { 0.0 } else { -14.0 }];
    let one = |first: u64| run::draw(Primitive::Patches { count: 1 }, 0, 16 * first);
    let named = |from: u32| {
        let points = vec![std::array::from_fn(|k| from + k as u32)];
        let indices = Indices { format: IndexFormat::Uint16, points, corners: vec![] };
        let primitive = Primitive::Indexed { count: 1 };
        Draw { indices: Some(Arc::new(indices)), ..run::draw(primitive, 0, 8) }
    };
    let mut config = unit(0, 0.0);
    config.clip.enabled = false;
    (config.esc.level, config.esc.scope) = (LevelPolicy::Distance, LevelScope::Object);
    (config.esc.level_max, config.esc.full_distance) = (7, 5.0);
    let mut draws = vec![(one(0), 8), (one(1), 3), (named(8), 3)];
    draws.push((run::draw(Primitive::Patches { count: 2 }, 0, 0), 8));
    for (draw, segments) in draws {
        let patches = draw.primitive.patches();
        let commands = [
            Command::Frame(run::camera(Vec3::new(0.0, 0.0, 5.0), 0.5, 64.0)),
            run::points(0, (0..32).map(at).collect()),
            Command::Draw(draw),
        ];
        let report = simulate(commands.into_iter().map(Ok), &config, &mut NoMesh);
        let triangles = report.expect("an object").total(C::SurfaceTriangles);
        assert_eq!(triangles, patches * 18 * segments * segments);
    }
}

#[test]
fn a_limit_of_output_values_makes_sections_and_the_same_mesh() {
    // 128 vertices of 8 values: five coarse triangles of 24, so four invocations; of 4 values, ten.
    for (level_max, bytes_out, sections) in [(3, 32, 4), (3, 16, 2), (0, 32, 1), (15, 32, SPLIT)] {
        let mut config = unit(0, 0.05);
        (config.esc.level, config.esc.level_max) = (LevelPolicy::Criterion, level_max);
        (config.level.pixels, config.level.max_level) = (Some(0.05), Some(48.0));
        config.esc.bytes_out = bytes_out;
        let (whole, one) = meshes(&config);
        config.esc.output_values = Some(1024);
        assert_eq!(esc::sections(&config), sections, "{level_max}, {bytes_out}");
        let (split, some) = meshes(&config);
        assert!(whole == split, "the same vertices and triangles at level {level_max}");
        let known = [
            (C::SurfaceInvocations, 32 * sections),
            (C::SurfaceNets, 32 * sections),
            (C::SurfaceControlPoints, 32 * sections * 16),
            (C::SurfaceBytesIn, 32 * sections * 256),
            (C::GroupInvocations, 32 * sections),
        ];
        compare(&some, &known);
        for counter in [C::SurfaceTriangles, C::SurfaceSlots, C::SurfacePoints] {
            assert_eq!(some.get(counter), one.get(counter), "{counter:?} at level {level_max}");
        }
        for counter in [C::EmitVertices, C::SurfaceEvaluations, C::SurfaceTests] {
            let (more, less) = (some.get(counter), one.get(counter));
            assert_eq!(more > less, sections > 1 && more > 0, "{counter:?}: {more} and {less}");
        }
        esc::laws(&some, &config);
    }
}

/// Invocations of a patch at levels of up to 15: strips of up to 33 vertices, 128 at a time.
const SPLIT: u64 = 45;

#[test]
fn plain_boundaries_crack_where_bits_are_few_and_symmetric_ones_nowhere() {
    let cracks = |boundary, guard| {
        let mut config = unit(7, 0.0);
        (config.esc.boundary, config.esc.guard) = (boundary, guard);
        let totals = teapot(&config);
        assert_eq!(totals.get(C::SurfaceBoundary), 32 * 92);
        totals.get(C::SurfaceCracks)
    };
    let plain = [0, 7, 20].map(|guard| cracks(Boundary::Plain, guard));
    println!("of {} points of edges {plain:?} crack at 0, 7 and 20 guard bits", 32 * 92);
    assert!(plain[0] > plain[1] && plain[1] >= plain[2], "{plain:?}");
    for guard in [0, 7, 20] {
        assert_eq!(cracks(Boundary::Symmetric, guard), 0);
    }
}

#[test]
fn object_units_do_not_depend_on_the_view_and_pixels_do() {
    let mut config = unit(5, 0.01);
    config.clip.enabled = false;
    config.backface.method = BackfaceMethod::Off;
    for space in [Space::Object, Space::Pixels] {
        config.esc.space = space;
        let report = run_text(&shipped("zoom"), &config).expect("eight frames");
        let inserted = report.frames.iter().map(|f| f.counters.get(C::SurfaceInserted));
        let distinct: BTreeSet<_> = inserted.collect();
        assert_eq!(report.total(C::PortObjectSaturated), 0);
        assert!((distinct.len() == 1) == (space == Space::Object), "{space:?}: {distinct:?}");
        assert!(!distinct.contains(&0), "{space:?}: {distinct:?}");
    }
    config.esc.space = Space::Object;
    config.position.object_range_log2 = 1; // of coordinates up to 3
    let narrow = run_text(&shipped("zoom"), &config).expect("eight frames");
    assert!(narrow.total(C::PortObjectSaturated) > 0);
    config.esc.mu = 0.0;
    let untested = run_text(&shipped("zoom"), &config).expect("eight frames");
    assert_eq!(untested.total(C::PortObjectSaturated), 0, "they are not wanted");
}
