//! The laws of the counters of unit `esc`, and what varies of its keys where they are tried.

use super::{Config, Unit, random};
use rtl_model::counter::{Block, Counter as C, Counters, DECLARATIONS};
use tessim::config::{Boundary, ControlMesh, LevelPolicy, LevelScope, Normals, Reuse, Space};

/// What varies of the unit's own keys, the position's width being what it is.
pub(super) fn vary(random: &mut random::Random, config: &mut Config) {
    use LevelPolicy::{Criterion, Distance, Fixed, ScreenSize};
    let esc = &mut config.esc;
    esc.level = random.of([Criterion, Fixed, Distance, ScreenSize]);
    esc.scope = random.of([LevelScope::Patch, LevelScope::Object]);
    if esc.level == Criterion {
        esc.scope = LevelScope::Patch;
    }
    esc.level_max = random.integer(0, 15);
    esc.fixed_level = random.integer(0, esc.level_max);
    esc.full_distance = random.of([0.5, 5.0, 50.0]);
    esc.full_pixels = random.of([10.0, 200.0, 3000.0]);
    esc.control_mesh = random.of(ControlMesh::ALL);
    esc.space = random.of([Space::Pixels, Space::Object]);
    esc.mu = random.of([0.0, 0.01, 0.3, 5.0]);
    esc.boundary = random.of(Boundary::ALL);
    esc.reuse = random.of(Reuse::ALL);
    esc.guard = random.integer(0, 20.min(55 - config.position.width));
    esc.parameter_bits = random.integer(16, 46);
    esc.bytes_out = random.of([16, 32, 34]);
    let strip = (2 * esc.level_max + 3) * esc.bytes_out.div_ceil(4);
    esc.output_values = random.of([None, Some(strip), Some(strip.max(1024)), Some(20_000)]);
    esc.width = random.of([1, 3, 64, 1024]);
    esc.registers = random.integer(0, 100);
}

/// Whether triangles leave as indices.
pub(super) fn is_indexed(config: &Config) -> bool {
    config.unit != Unit::Esc || config.esc.reuse != Reuse::None
}

/// What the driver sends: 4 bytes an instance. Of a frame of a shipped trace all draws send their
/// models, or none does, and then each has one instance.
pub(super) fn link_factors(c: &Counters, config: &Config) -> u64 {
    if config.unit != Unit::Esc || config.esc.scope == LevelScope::Patch {
        return 0;
    }
    let models = c.get(C::LinkMatrices) / 64 - 2 * c.get(C::TraceFrames);
    4 * if models > 0 { models } else { c.get(C::TraceDraws) }
}

/// Vertices that the shader gives: those that it evaluated for the mesh, and the copied ones.
pub(super) fn vertices(c: &Counters, config: &Config) -> u64 {
    let parts = [C::SurfaceCorners, C::SurfaceBoundary, C::SurfaceCoarse, C::SurfaceInterior];
    let sum = parts.map(|part| c.get(part)).iter().sum();
    if config.unit == Unit::Esc && config.esc.reuse == Reuse::None {
        assert_eq!(c.get(C::SurfaceStripVertices), sum, "without reuse, each that a strip names");
    }
    sum
}

/// Invocations that a patch needs: consecutive coarse triangles, or strips, as long as their lists
/// fit; strip k has 2 k + 1 vertices.
pub(super) fn sections(config: &Config) -> u64 {
    let Some(values) = config.esc.output_values else { return 1 };
    let room = values / config.esc.bytes_out.div_ceil(4);
    let segments = config.esc.level_max + 1;
    let whole = segments * (segments + 2);
    if whole <= room {
        return 18_u64.div_ceil(u64::from(room / whole));
    }
    let (mut count, mut left) = (1, room);
    for need in (0..18).flat_map(|_| (1..=segments).map(|k| 2 * k + 1)) {
        if need > left {
            (count, left) = (count + 1, room);
        }
        left -= need;
    }
    count
}

/// Every law that the unit's declarations state.
pub(super) fn laws(c: &Counters, config: &Config) {
    if config.unit == Unit::Esc {
        equal(c, config);
        at_most(c, config);
        return;
    }
    let blocks = [Block::Group, Block::Surface];
    for declared in DECLARATIONS.iter().filter(|declared| blocks.contains(&declared.block)) {
        assert_eq!(c.get(declared.counter), 0, "{:?} under {config:?}", declared.counter);
    }
    assert_eq!(c.get(C::PortObjectSaturated), 0);
}

fn equal(c: &Counters, config: &Config) {
    let get = |counter| c.get(counter);
    let esc = &config.esc;
    let (patches, invocations) = (get(C::LevelPatches), get(C::SurfaceInvocations));
    let (width, words) = (u64::from(config.position.width), u64::from(esc.registers));
    let registers = 64 * (width + 8 + u64::from(esc.guard)) + 32 * words;
    let apart = esc.space == Space::Object && esc.mu > 0.0;
    let evaluated = [C::SurfaceBoundary, C::SurfaceCoarse, C::SurfaceInterior, C::SurfaceTested];
    let leave = get(C::EmitVertices);
    let by_pixels = esc.level == LevelPolicy::ScreenSize && esc.scope == LevelScope::Patch;
    let equal = [
        (invocations, sections(config) * patches),
        (get(C::GroupInvocations), invocations),
        (get(C::GroupRounds) * u64::from(esc.width), invocations + get(C::GroupIdle)),
        (get(C::SurfaceControlPoints), 16 * invocations),
        (get(C::SurfaceObjectNets), if apart { get(C::SurfaceNets) } else { 0 }),
        (get(C::SurfaceEvaluations), evaluated.map(get).iter().sum()),
        (get(C::SurfaceRegistersPeak), if patches > 0 { registers } else { 0 }),
        (get(C::SurfaceLaneCycles), get(C::SurfaceUsedCycles) + get(C::SurfaceIdleCycles)),
        (get(C::SurfaceLaneCycles) % u64::from(esc.width), 0),
        (get(C::SurfaceBytesOut), leave * u64::from(esc.bytes_out) + get(C::EmitAttributeBytes)),
        (get(C::SurfaceNormals), if config.evaluate.normals == Normals::Off { 0 } else { leave }),
        (get(C::SurfaceTriangles), get(C::EmitTriangles)),
    ];
    for (k, (a, b)) in equal.iter().enumerate() {
        assert_eq!(a, b, "law {k} under {config:?}");
    }
    if esc.mu == 0.0 {
        let tests =
            [C::SurfaceTests, C::SurfaceInserted, C::SurfaceTested, C::SurfaceTestedBoundary];
        assert_eq!(tests.map(get), [0; 4], "nothing is tested under {config:?}");
    }
    if esc.boundary == Boundary::Symmetric {
        assert_eq!(get(C::SurfaceCracks), 0, "under {config:?}");
    }
    if esc.reuse == Reuse::Patch && esc.output_values.is_none() {
        // Each point once; and of a disc with V vertices, B of them on its edge, the triangles.
        let (points, edge) =
            (get(C::SurfacePoints), get(C::SurfaceCorners) + get(C::SurfaceBoundary));
        assert_eq!((points, get(C::SurfaceCorners)), (leave, 4 * patches), "under {config:?}");
        assert_eq!(get(C::SurfaceTriangles) + edge + 2 * patches, 2 * points, "under {config:?}");
    }
    if esc.level == LevelPolicy::Fixed || esc.scope == LevelScope::Object {
        assert_eq!(get(C::SurfaceMoved), 0, "edges of one level under {config:?}");
    }
    if esc.level != LevelPolicy::Criterion {
        let measured = [C::LevelFlatness, C::LevelEdgeLength].map(get);
        assert_eq!(measured, [0, if by_pixels { patches } else { 0 }], "under {config:?}");
    }
    let bare = [C::AssembleCorners, C::AssembleCornersReused].map(get) == [0; 2];
    let net = if apart { 256 + 192 } else { 256 };
    if bare {
        assert_eq!(get(C::SurfaceBytesIn), invocations * net, "without attributes");
    }
}

fn at_most(c: &Counters, config: &Config) {
    let get = |counter| c.get(counter);
    let esc = &config.esc;
    let (patches, invocations) = (get(C::LevelPatches), get(C::SurfaceInvocations));
    let segments = u64::from(esc.level_max) + 1;
    let position = 4 * u64::from(config.position.width);
    let held = match esc.reuse {
        Reuse::None => 0,
        Reuse::CoarseTriangle => (segments + 1) * (segments + 2) / 2 * position,
        Reuse::Patch => (3 * segments + 1).pow(2) * position,
    };
    // Coarse edges that an invocation tests, each once, or once for each coarse triangle.
    let tests = if esc.reuse == Reuse::Patch { 33 } else { 54 } * u64::from(esc.level_max);
    let plain = if esc.boundary == Boundary::Plain { get(C::SurfacePoints) } else { 0 };
    let at_most = [
        (if esc.output_values.is_none() { invocations } else { patches }, get(C::SurfaceNets)),
        (get(C::SurfaceNets), invocations),
        (get(C::GroupWaves), get(C::GroupRounds)),
        (get(C::GroupRounds), invocations),
        (256 * invocations, get(C::SurfaceBytesIn)),
        (get(C::SurfaceInserted), get(C::SurfaceTests)),
        (get(C::SurfaceTests), tests * invocations),
        (get(C::SurfaceTestedBoundary), get(C::SurfaceTested)),
        (get(C::SurfacePoints), get(C::EmitVertices)),
        (get(C::SurfacePoints), get(C::SurfaceStripVertices)),
        (get(C::EmitVertices), get(C::SurfaceStripVertices)),
        (get(C::SurfaceTriangles), get(C::SurfaceSlots)),
        // At least a strip in each coarse triangle, of slots and two vertices more.
        (get(C::SurfaceTriangles) + 2 * 18 * patches, get(C::SurfaceStripVertices)),
        (18 * patches, get(C::SurfaceTriangles)),
        (get(C::SurfaceSlots), 18 * segments * segments * patches),
        (get(C::SurfaceDegenerate), get(C::SurfaceTriangles)),
        (get(C::SurfaceMoved), get(C::SurfacePoints)),
        (get(C::SurfaceCracks), plain),
        (get(C::SurfaceBufferPeak), held),
        (get(C::PortObjectSaturated), get(C::PortPoints)),
    ];
    for (k, (a, b)) in at_most.iter().enumerate() {
        assert!(a <= b, "bound {k}: {a} > {b} under {config:?}");
    }
}
