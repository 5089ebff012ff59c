//! Numbers that do not come from the tool: counts worked out by hand, conservation laws between
//! counters, and the expected counters of every shipped trace (`UPDATE_EXPECT=1` rewrites those,
//! for a person to read the difference).

#[path = "known/d3d11.rs"]
mod d3d11;
#[path = "known/esc.rs"]
mod esc;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/random.rs"]
mod random;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;
#[path = "known/surfaces.rs"]
mod surfaces;
#[path = "known/units.rs"]
mod units;
#[path = "known/waves.rs"]
mod waves;

use rtl_model::counter::Counter as C;
use rtl_model::counter::Counters;
use rtl_model::counter::standard::{Stage, Work};
use rtl_model::level::Termination;
use std::io::BufReader;
use std::path::Path;
use tessim::config::{BackfaceMethod, Config, Normals, Scheme, TransferMode, Union, Unit};
use tessim::error::Result;
use tessim::output;
use tessim::report::{Fates, Report};
use tessim::sink::NoMesh;
use tessim::trace::read::Reader;
use tessim::unit::simulate;

const SHIPPED: [&str; 9] =
    ["fan", "indexed", "mesh", "rational", "strip", "teacup", "teapot", "teaspoon", "zoom"];

fn run_text(text: &str, config: &Config) -> Result<Report> {
    let reader = Reader::new(BufReader::new(text.as_bytes()), "text", "traces");
    simulate(reader.map(|l| Ok(l?.command)), config, &mut NoMesh)
}

fn shipped(name: &str) -> String {
    std::fs::read_to_string(format!("traces/{name}.jsonl")).expect("a shipped trace")
}

/// A shipped trace at a fixed level, with `"cull":false` in its draws.
fn fixed(name: &str, level: &str) -> String {
    let tessellation =
        format!(r#"{{"tessellation":{{"criterion":"fixed","level":{level},"max_level":128}}}}"#);
    let mut lines: Vec<String> = shipped(name)
        .lines()
        .filter(|l| !l.starts_with(r#"{"tessellation""#))
        .map(|l| l.replace(r#"{"draw":{"#, r#"{"draw":{"cull":false,"#))
        .collect();
    lines.insert(1, tessellation);
    lines.join("\n") + "\n"
}

#[test]
fn a_teapot_at_level_8_is_what_arithmetic_says() {
    let report = run_text(&fixed("teapot", "8"), &Config::default()).expect("a teapot");
    let totals = report.totals();
    let known = [
        (C::TracePatches, 32),
        (C::AssembleReceived, 512),           // 32 patches of 16
        (C::LinkControlPoints, 6144),         // 512 of 12 bytes
        (C::LinkCommands, 4 * 8),             // tessellation, frame, points, draw
        (C::LinkMatrices, 2 * 64),            // view and projection
        (C::TransformBytesOut, 8192),         // a vec4 each
        (C::BackfaceTested, 0),               // "cull":false
        (C::StitchTriangles, 4096),           // 32 of 2 * 8 * 8
        (C::EmitVertices, 2592),              // 32 of 9 * 9
        (C::EvaluateInvocations, 2592 + 896), // and 4 control points for each of 7 rows
        (C::EvaluateCurves, 32 * 2 * 15),     // two half-runs for 4 edges, 4 columns, 7 rows
        (C::EvaluateSteps, 32 * 15 * 6),      // 3 steps each
        (C::PlaceReciprocals, 32),            // one level
        (C::EvaluateStrips, 32 * (6 + 8)),    // gaps between 7 rows, half-sides
        (C::EmitBytes, 2592 * 16 + 4096 * 6), // 16 a vertex, three 2-byte indices a triangle
        (C::VertexShaderInvocations, 2592),
        (C::VertexShaderBytesIn, 2592 * 24),
    ];
    for (counter, value) in known {
        assert_eq!(totals.get(counter), value, "{counter:?}");
    }
    // 6144 + 8 bytes of points take 25 packets of 256; the three other commands one each.
    assert_eq!(totals.get(C::LinkOverhead), (25 + 3) * 24);
    // The host would send a frame, and a draw of 2592 vertices of 32 bytes and 12288 short indices.
    let draw: u64 = 8 + 2592 * 32 + 12288 * 2;
    assert_eq!(report.host_link_bytes, (8 + 128 + 24) + draw + draw.div_ceil(256) * 24);
}

#[test]
fn a_pulled_teapot_is_asked_for_and_completed() {
    let mut config = Config::default();
    config.link.transfer = TransferMode::Pull;
    let totals = run_text(&fixed("teapot", "8"), &config).expect("a teapot").totals();
    // 6152 bytes of points: 13 reads of up to 512, 49 completions of up to 128. The frame's 136
    // bytes: one read, two completions. Tessellation and draw: one of each.
    assert_eq!(totals.get(C::LinkRequests), (13 + 1 + 2) * 24);
    assert_eq!(totals.get(C::LinkOverhead), (49 + 2 + 2) * 20);
    let pushed = run_text(&fixed("teapot", "8"), &Config::default()).expect("a teapot").totals();
    assert_eq!(pushed.get(C::LinkRequests), 0);
    assert_eq!(totals.get(C::LinkControlPoints), pushed.get(C::LinkControlPoints));
}

#[test]
fn levels_have_their_counts_and_the_host_sends_the_same_triangles() {
    // segments 1, 3 and 2h: triangles 2, 10 + 8 = 18 over 2 x 2 interior points, 8 h^2
    for (level, triangles, vertices) in
        [("1", 2, 4), ("1.5", 18, 16), ("2", 8, 9), ("128", 32768, 16641)]
    {
        let text = fixed("teaspoon", level);
        let report = run_text(&text, &Config::default()).expect("a teaspoon");
        assert_eq!(report.total(C::StitchTriangles), 16 * triangles, "level {level}");
        assert_eq!(report.total(C::EmitVertices), 16 * vertices, "level {level}");
        let host = Config { unit: Unit::Triangles, ..Config::default() };
        let host = run_text(&text, &host).expect("a teaspoon");
        assert_eq!(host.total(C::EmitTriangles), 16 * triangles);
        assert_eq!(host.total(C::LinkTotal), report.host_link_bytes, "level {level}");
        assert_eq!(host.total(C::LinkVertices), 16 * vertices * 32);
        let index = if 16 * vertices > 65536 { 4 } else { 2 };
        assert_eq!(host.total(C::LinkIndices), 16 * triangles * 3 * index);
    }
}

/// A grid of points for meshes of `rows` by `columns` patches.
fn mesh_text(rows: u32, columns: u32, resident: bool, instances: u32) -> String {
    let points: Vec<String> = (0..=3 * rows)
        .flat_map(|y| (0..=3 * columns).map(move |x| format!("[{x},{y},0]")))
        .collect();
    let identity = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
    let instances = vec![identity; instances as usize].join(",");
    format!(
        "{{\"tessim\":1}}\n\
         {{\"frame\":{{\"viewport\":[64,64],\"view\":{identity},\
         \"projection\":[0.0003,0,0,0,0,0.0003,0,0,0,0,-0.01,0,0,0,0.5,1]}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{}],\"resident\":{resident}}}}}\n\
         {{\"draw\":{{\"primitive\":\"mesh\",\"points\":0,\"rows\":{rows},\
         \"columns\":{columns},\"instances\":[{instances}]}}}}\n\
         {{\"end\":{{}}}}\n",
        points.join(",")
    )
}

/// Vertices of two-vertex edges that a mesh holds at most: a row's upper ones and the one beside.
/// Of two rows the second leaves none above, so the one beside it is never held with a full row.
fn held(rows: u64, columns: u64) -> u64 {
    match (rows, columns) {
        (1, 1) => 0,
        (1, _) => 2,
        (2, _) | (_, 1) => 2 * columns,
        _ => 2 * columns + 2,
    }
}

#[test]
fn a_mesh_brings_its_points_once_an_instance() {
    let mut compared = 0;
    for (rows, columns, instances) in
        [(1, 1, 1), (4, 5, 3), (1, 40, 2), (40, 1, 2), (33, 40, 1), (2, 1100, 1)]
    {
        let text = mesh_text(rows, columns, true, instances);
        let totals = run_text(&text, &Config::default()).expect("a mesh").totals();
        let (m, n, k) = (u64::from(rows), u64::from(columns), u64::from(instances));
        let points = (3 * m + 1) * (3 * n + 1);
        let known = [
            (C::LinkControlPoints, 12 * points),
            (C::LinkMatrices, 128 + 64 * k),
            (C::MemoryWrittenControlPoints, 12 * points),
            (C::MemoryReadControlPoints, 12 * points * k),
            (C::MemoryBursts, (12 * points).div_ceil(32) * (k + 1)),
            (C::AssembleReceived, points * k),
            // Blocks of large meshes overlap; counted once all the same.
            (C::PortPoints, points * k),
            (C::AssembleReused, (16 * m * n - points) * k),
            (C::AssembleEdgePeak, if m > 1 { 3 * n + 1 } else { 0 } + if n > 1 { 4 } else { 0 }),
            // Level 1: an edge has two vertices.
            (C::EvaluateShared, (2 * m * (n - 1) + 2 * (m - 1) * n - (m - 1) * (n - 1)) * k),
            (C::EvaluateHeldPeak, held(m, n)),
            (C::LevelPatches, m * n * k), // a plane that faces the viewer: nothing is culled
            (C::StitchTriangles, 2 * m * n * k),
        ];
        for (counter, value) in known {
            assert_eq!(totals.get(counter), value, "{counter:?} of {rows} x {columns}");
            compared += 1;
        }
    }
    println!("compared {compared} counters");
}

/// Every law that the declarations state.
fn laws(c: &Counters, config: &Config) {
    equal(c, config);
    at_most(c, config);
    d3d11::laws(c, config);
    esc::laws(c, config);
}

fn equal(c: &Counters, config: &Config) {
    let get = |counter| c.get(counter);
    let link = [
        C::LinkCommands,
        C::LinkMatrices,
        C::LinkControlPoints,
        C::LinkAttributes,
        C::LinkFactors,
        C::LinkVertices,
        C::LinkIndices,
    ];
    let payload: u64 = link.map(get).iter().sum();
    let burst = u64::from(config.memory.burst);
    let moved = get(C::MemoryReadControlPoints)
        + get(C::MemoryReadAttributes)
        + get(C::MemoryWrittenControlPoints)
        + get(C::MemoryWrittenAttributes)
        + get(C::MemoryReadPatches)
        + get(C::MemoryWrittenPatches);
    let indexed = if esc::is_indexed(config) { get(C::EmitTriangles) } else { 0 };
    let emit = u64::from(config.emit.vertex_bytes) * get(C::EmitVertices)
        + get(C::EmitAttributeBytes)
        + 3 * u64::from(config.emit.index_bytes) * indexed;
    // Before transform the points are as they came, and all patches are kept.
    let object = config.unit.in_object_space();
    let or_0 = |counter| if object { 0 } else { get(counter) };
    let Fates { clipped, culled, tessellated } = Fates::of(c);
    let kept = get(C::AssemblePatches) - get(C::ClipCulled) - get(C::BackfaceCulled);
    let equal = [
        (get(C::LinkTotal), payload + get(C::LinkOverhead) + get(C::LinkRequests)),
        (get(C::MemoryBursts) * burst, moved + get(C::MemoryWasted)),
        (get(C::TransformInvocations), or_0(C::PortPoints)),
        (get(C::PortPoints), get(C::AssembleReceived)),
        (get(C::TransformBytesOut), 16 * get(C::TransformInvocations)),
        (get(C::AssembleReceived) + get(C::AssembleReused), 16 * get(C::AssemblePatches)),
        (get(C::TracePatches) + get(C::AssembleMeasured), get(C::AssemblePatches)),
        (
            get(C::ClipMeasured) + get(C::BackfaceMeasured) + get(C::PlaceMeasured),
            get(C::AssembleMeasured),
        ),
        (clipped + culled + tessellated, get(C::TracePatches)),
        (
            get(C::LinkFactors),
            if object { 16 * get(C::TracePatches) } else { esc::link_factors(c, config) },
        ),
        (get(C::ClipIn), or_0(C::AssemblePatches)),
        (get(C::ClipIn) - get(C::ClipCulled), get(C::BackfaceIn)),
        (kept, get(C::LevelPatches) + get(C::PlaceMeasured)),
        (
            get(C::EvaluateVertices) + get(C::DomainInvocations) + esc::vertices(c, config),
            get(C::EmitVertices),
        ),
        (
            get(C::StitchTriangles) + get(C::ConnectTriangles) + get(C::SurfaceTriangles),
            get(C::EmitTriangles),
        ),
        (get(C::EvaluateVertices), get(C::VertexShaderInvocations)),
        (get(C::EmitBytes), emit),
        (
            get(C::EmitAttributeBytes),
            [C::EvaluateAttributes, C::DomainAttributes, C::SurfaceAttributes]
                .map(get)
                .iter()
                .sum::<u64>()
                * config.attributes.component_bytes(),
        ),
        ((get(C::AssembleCorners) + get(C::AssembleCornersReused)) % 4, 0),
    ];
    for (k, (a, b)) in equal.iter().enumerate() {
        assert_eq!(a, b, "law {k} under {config:?}");
    }
}

fn at_most(c: &Counters, config: &Config) {
    let get = |counter| c.get(counter);
    let at_most = [
        (get(C::MemoryWrittenControlPoints), get(C::LinkControlPoints)),
        (get(C::MemoryWrittenAttributes), get(C::LinkAttributes)),
        (get(C::MemoryReadControlPoints), get(C::MemoryUncachedControlPoints)),
        (get(C::AssembleWhole), get(C::AssemblePatches)),
        (get(C::AssembleCorners) + get(C::AssembleCornersReused), 4 * get(C::TracePatches)),
        (get(C::PortSaturated), get(C::PortPoints)),
        (get(C::PortSaturated), get(C::PortOverflows)),
        (get(C::PortOverflows), 4 * get(C::PortSaturated)),
        (get(C::BackfaceCulled), get(C::BackfaceTested)),
        (get(C::BackfaceTested), get(C::BackfaceIn)),
        (get(C::BackfaceTested), get(C::BackfaceFacets)),
        (
            get(C::BackfaceFacets),
            u64::from(config.backface.method.facets()) * get(C::BackfaceTested),
        ),
        (get(C::PlaceMeasured), get(C::AssembleMeasured)),
        (get(C::PlaceMeasured), get(C::LevelPatches)),
        (get(C::LevelSplits), 8 * 127 * get(C::LevelPatches)),
        (get(C::LevelClamped), 6 * get(C::LevelPatches)),
        (get(C::LevelNear), 4 * get(C::LevelPatches)),
        (get(C::PlaceReciprocals), 6 * get(C::LevelPatches)),
        (get(C::EvaluateNormalsDegenerate), get(C::EvaluateNormals)),
        (get(C::EvaluateNormals), get(C::EvaluateVertices)),
        (get(C::EvaluateShared), get(C::EvaluateVertices)),
        (get(C::StitchDegenerate), get(C::StitchTriangles)),
        (get(C::EmitToClipper), get(C::EmitVertices)),
        // 2V - B - 2 with at least 4 boundary vertices a patch
        (get(C::EmitTriangles), 2 * get(C::EmitVertices) - 6 * get(C::LevelPatches)),
        (get(C::LevelFlatness) + get(C::LevelEdgeLength), get(C::LevelPatches)),
        (
            get(C::LevelPatches),
            get(C::EvaluateStrips) + get(C::DomainWaves) + get(C::SurfaceInvocations),
        ),
        (get(C::EvaluateStrips), get(C::StitchTriangles)),
    ];
    for (k, (a, b)) in at_most.iter().enumerate() {
        assert!(a <= b, "bound {k}: {a} > {b} under {config:?}");
    }
}

/// What the blocks of the chain hand on arrives, and wide operations are no fewer than operations.
fn flow(chain: &[Stage], work: &[Work]) {
    assert_eq!(chain.len(), work.len());
    for (stages, work) in chain.windows(2).zip(work.windows(2)) {
        let [from, to] = [0, 1].map(|k| stages[k].block.name());
        assert_eq!(work[0].tokens_out, work[1].tokens_in, "tokens from {from} to {to}");
    }
    for ops in work.iter().filter_map(|work| work.ops) {
        assert!(ops.add <= ops.add_bits && ops.mul <= ops.mul_bits, "{ops:?}");
        assert!(ops.compare <= ops.compare_bits, "{ops:?}");
    }
}

#[test]
fn counters_conserve_what_flows_under_every_configuration() {
    let mut random = random::Random::new(6);
    let mut frames = 0;
    for _ in 0..run::scale(60, 1000) {
        let mut config = Config { unit: random.of(Unit::ALL), ..Config::default() };
        config.level.termination = random.of([Termination::EightCurves, Termination::Bounded]);
        config.level.union = random.of([Union::Off, Union::Primitive]);
        config.position.width = 8 + random.integer(0, 40);
        config.position.clip_range_log2 = random.of([None, Some(0), Some(4)]);
        config.backface.method = random.of([
            BackfaceMethod::Off,
            BackfaceMethod::NetFacets,
            BackfaceMethod::TangentPlane,
            BackfaceMethod::NormalCone,
            BackfaceMethod::HullLiteral,
        ]);
        config.clip.enabled = random.integer(0, 2) > 0;
        config.emit.divide = random.integer(0, 2) > 0;
        config.evaluate.scheme = random.of([Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau]);
        config.evaluate.normals = random.of([Normals::Off, Normals::TangentPlane]);
        config.link.payload = random.of([128, 256]);
        config.link.transfer = random.of([TransferMode::Push, TransferMode::Pull]);
        config.memory.burst = random.of([16, 32, 64]);
        config.level.max_level = random.of([None, Some(4.0)]);
        config.assemble.cache_entries = random.of([0, 1, 16, 32, 200]);
        config.attributes.width = random.of([17, 32, 46]);
        d3d11::vary(&mut random, &mut config);
        esc::vary(&mut random, &mut config);
        for name in SHIPPED {
            let report = run_text(&shipped(name), &config).expect("a shipped trace");
            for frame in &report.frames {
                laws(&frame.counters, &config);
                flow(&report.chain, &frame.work);
                frames += 1;
            }
        }
    }
    println!("compared {frames} frames");
    assert!(frames >= 300);
}

#[test]
fn shipped_traces_have_their_expected_counters() {
    for name in SHIPPED {
        let report = run_text(&shipped(name), &Config::default()).expect("a shipped trace");
        let mut csv = Vec::new();
        output::counters::write(&report, &mut csv).expect("a vector takes it all");
        let csv = String::from_utf8(csv).expect("text");
        let path = format!("traces/{name}.counters.csv");
        let path = Path::new(&path);
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            std::fs::write(path, &csv).expect("the traces' folder is writable");
        }
        let expected = std::fs::read_to_string(path).unwrap_or_default();
        for (line, (got, want)) in csv.lines().zip(expected.lines()).enumerate() {
            assert_eq!(got, want, "{}:{}: UPDATE_EXPECT=1 accepts", path.display(), line + 1);
        }
        assert_eq!(csv, expected, "{}", path.display());
        println!("compared {} rows of {name}", csv.lines().count());
    }
}

/// A square patch in the plane z = 0 whose Su x Sv points to +z, seen from +z or through something
/// that mirrors.
fn square(model: &str, projection_x: &str, extra: &str) -> u64 {
    let points: Vec<String> = (0..16).map(|k| format!("[{},{},0]", k % 4 - 1, k / 4 - 1)).collect();
    let text = format!(
        "{{\"tessim\":1}}\n\
         {{\"frame\":{{\"viewport\":[64,64],\"view\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,-5,1],\
         \"projection\":[{projection_x},0,0,0,0,1,0,0,0,0,-1.01,-1,0,0,-0.1,0]}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{}]}}}}\n\
         {{\"draw\":{{\"primitive\":\"patches\",\"points\":0,\"count\":1,\
         \"model\":{model}{extra}}}}}\n\
         {{\"end\":{{}}}}\n",
        points.join(",")
    );
    run_text(&text, &Config::default()).expect("a square").total(C::BackfaceCulled)
}

#[test]
fn the_front_is_where_the_normal_points_in_world_space() {
    let (plain, mirror) =
        ("[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]", "[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]");
    let reversed = ",\"front\":\"reversed\"";
    assert_eq!(square(plain, "1", ""), 0, "it faces the viewer");
    assert_eq!(square(mirror, "1", ""), 1, "a mirroring model turns it round");
    assert_eq!(square(plain, "-1", ""), 0, "a mirroring projection does not");
    assert_eq!(square(plain, "1", reversed), 1, "the draw may turn it round");
    assert_eq!(square(mirror, "-1", reversed), 0);
    assert_eq!(square(mirror, "1", ",\"cull\":false"), 0, "or keep both sides");
}

/// The square as seen by `square`, under a configuration.
fn seen(set: impl Fn(&mut Config)) -> Counters {
    let mut config = Config::default();
    set(&mut config);
    let text = mesh_text(1, 1, false, 1);
    run_text(&text, &config).expect("a square").totals()
}

#[test]
fn what_does_not_fit_is_counted_where_it_does_not() {
    let fits = seen(|_| {});
    for counter in [C::PortSaturated, C::PortOverflows, C::LevelClamped, C::LevelNear] {
        assert_eq!(fits.get(counter), 0, "{counter:?} where all fits");
    }
    assert_eq!(fits.get(C::BackfaceTested), 1, "a parallel projection saturates nothing");
    // w = 1 fits a range of 1 in none of the 16 points; x, y and z do.
    let narrow = seen(|c| c.position.clip_range_log2 = Some(0));
    assert_eq!((narrow.get(C::PortSaturated), narrow.get(C::PortOverflows)), (16, 16));
    assert_eq!(narrow.get(C::BackfaceTested), 0, "a patch with a saturated point is kept");
    let clamped = seen(|c| (c.level.level, c.level.max_level) = (Some(8.0), Some(4.0)));
    assert_eq!((clamped.get(C::LevelClamped), clamped.get(C::StitchTriangles)), (6, 32));
    // All points have w = 1: nearer than 2 is every edge, and then the level is the greatest.
    let near = seen(|c| (c.level.near, c.level.max_level) = (Some(2.0), Some(4.0)));
    assert_eq!((near.get(C::LevelNear), near.get(C::StitchTriangles)), (4, 32));
}
