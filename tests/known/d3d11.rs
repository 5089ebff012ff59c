//! Counts by hand in the unit `d3d11`, and the laws of its own counters.

use super::units::compare;
use super::{Config, Unit, fixed, mesh_text, random, run_text, shipped};
use rtl_model::counter::Counter as C;
use rtl_model::counter::Counters;
use tessim::config::{
    Arithmetic, DomainKind, FactorPolicy, Form, Normals, Partitioning, TransferMode,
};

/// What varies of the unit's own keys.
pub(super) fn vary(random: &mut random::Random, config: &mut Config) {
    use Partitioning::{Even, Integer, Odd, Pow2};
    config.tessellator.partitioning = random.of([Integer, Pow2, Odd, Even]);
    config.hull.policy = random.of([FactorPolicy::Criterion, FactorPolicy::Adaptive]);
    config.hull.pixels = random.of([0.0, 0.25, 5.0]);
    config.hull.candidates = 1 + random.integer(0, 19);
    config.hull.to_memory = random.integer(0, 1) > 0;
    config.domain.shader = random.of([DomainKind::Naive, DomainKind::Basis]);
    config.domain.form =
        random.of([None, Some(Form::Paired), Some(Form::Sequential), Some(Form::Power)]);
    config.domain.arithmetic = random.of([Arithmetic::F32, Arithmetic::Fixed]);
    config.domain.weight_bits = 16 + random.integer(0, 14);
    config.domain.cache_entries = random.of([None, Some(0), Some(1), Some(16), Some(500)]);
    config.domain.width = random.of([1, 4, 32, 64, 1024]);
}

/// Every law that the unit's declarations state.
pub(super) fn laws(c: &Counters, config: &Config) {
    let get = |counter| c.get(counter);
    let memory = |counter| if config.hull.to_memory { get(counter) } else { 0 };
    let on_chip = if config.hull.to_memory { 0 } else { get(C::HullBytesOut) };
    let width = u64::from(config.domain.width);
    let invocations = get(C::DomainInvocations);
    let nets = match config.domain.shader {
        DomainKind::Naive => invocations,
        DomainKind::Basis => get(C::LevelPatches),
    };
    let ours = config.unit == Unit::D3d11;
    let patches = if ours { get(C::AssemblePatches) } else { 0 };
    let interval = config.costs(rtl_model::counter::Block::Domain).expect("it has").interval;
    let equal = [
        (get(C::HullInvocations), patches),
        (get(C::HullThreads), 16 * patches),
        (get(C::HullBytesOnChip), on_chip),
        (get(C::MemoryWrittenPatches), memory(C::HullBytesOut)),
        (get(C::FactorsProcessed), 6 * patches),
        (get(C::FactorsCulled), if ours { get(C::ClipCulled) + get(C::BackfaceCulled) } else { 0 }),
        (get(C::DomainRepeated), invocations - get(C::PointsGenerated)),
        (get(C::DomainWaves) * width, invocations + get(C::DomainIdle)),
        (get(C::DomainIdleCycles), get(C::DomainIdle) * u64::from(interval)),
        (get(C::DomainBytesControlPoints), if ours { 256 * nets } else { 0 }),
        (get(C::DomainBytesParameters), u64::from(config.domain.bytes_in) * invocations),
        (
            get(C::DomainBytesOut),
            if ours {
                u64::from(config.domain.bytes_out) * invocations + get(C::EmitAttributeBytes)
            } else {
                0
            },
        ),
        (
            get(C::DomainNormals),
            if config.evaluate.normals == Normals::Off { 0 } else { invocations },
        ),
    ];
    for (k, (a, b)) in equal.iter().enumerate() {
        assert_eq!(a, b, "law {k} under {config:?}");
    }
    let cracks = if config.is_order_invariant() { 0 } else { get(C::PointsGenerated) };
    let at_most = [
        (280 * patches, get(C::HullBytesOut)),
        (get(C::MemoryReadPatches), get(C::MemoryWrittenPatches)),
        (get(C::MemoryPatchBursts), get(C::MemoryBursts)),
        (8 * if ours { get(C::LevelPatches) } else { 0 }, get(C::PointsParameters)),
        (get(C::PointsGenerated), invocations),
        (invocations, 3 * get(C::ConnectTriangles)),
        (get(C::PointsNonMonotone), get(C::PointsGenerated)),
        (get(C::ConnectInverted) + get(C::ConnectZeroArea), get(C::ConnectTriangles)),
        (get(C::ConnectDegenerate), get(C::ConnectTriangles)),
        (get(C::DomainCracks), cracks),
    ];
    for (k, (a, b)) in at_most.iter().enumerate() {
        assert!(a <= b, "bound {k}: {a} > {b} under {config:?}");
    }
    if config.domain.cache_entries.is_none() {
        assert_eq!(get(C::DomainRepeated), 0, "all of a patch's points are kept");
    }
    if config.hull.policy == FactorPolicy::Criterion {
        assert_eq!(get(C::HullDistanceTests), 0);
    }
}

/// Integer partitioning, so that every edge has the segments of its level.
fn unit() -> Config {
    let mut config = Config { unit: Unit::D3d11, ..Config::default() };
    config.tessellator.partitioning = Partitioning::Integer;
    config
}

#[test]
fn a_teapot_by_shaders_is_what_arithmetic_says() {
    let report = run_text(&fixed("teapot", "8"), &unit()).expect("a teapot");
    let known = [
        (C::LinkControlPoints, 6144),
        (C::LinkIndices, 0),
        (C::LinkFactors, 0),
        (C::HullInvocations, 32),
        (C::HullThreads, 512),
        (C::HullBytesIn, 512 * 12),
        (C::HullBytesOut, 32 * 280),
        (C::HullBytesOnChip, 32 * 280),
        (C::ClipIn, 32),
        (C::LevelPatches, 32),
        (C::FactorsProcessed, 192),
        (C::PointsGenerated, 32 * 81),
        (C::PointsParameters, 32 * 6 * 9),
        (C::ConnectTriangles, 32 * 128),
        (C::ConnectZeroArea, 0),
        (C::ConnectInverted, 0),
        (C::DomainInvocations, 32 * 81),
        (C::DomainWaves, 32 * 2), // 64 points and 17
        (C::DomainIdle, 32 * 47),
        (C::DomainIdleCycles, 32 * 47 * 64),
        (C::DomainBytesControlPoints, 32 * 256),
        (C::DomainBytesParameters, 2592 * 8),
        (C::DomainBytesOut, 2592 * 32),
        (C::EmitBytes, 2592 * 16 + 4096 * 6),
        (C::VertexShaderInvocations, 0),
    ];
    compare(&report.totals(), &known);
}

#[test]
fn what_passes_through_memory_is_counted_there_and_nowhere_on_the_link() {
    let on_chip = run_text(&shipped("teapot"), &unit()).expect("a teapot").totals();
    let mut config = unit();
    config.hull.to_memory = true;
    let through = run_text(&shipped("teapot"), &config).expect("a teapot").totals();
    let kept = through.get(C::LevelPatches);
    assert!(kept < 32, "some patches are culled");
    // 280 bytes are nine bursts of 32: 8 bytes are wasted, each way.
    let known = [
        (C::MemoryWrittenPatches, 32 * 280),
        (C::MemoryReadPatches, kept * 280),
        (C::MemoryPatchBursts, (32 + kept) * 9),
        (C::MemoryBursts, (32 + kept) * 9),
        (C::MemoryWasted, (32 + kept) * 8),
        (C::HullBytesOut, 32 * 280),
        (C::HullBytesOnChip, 0),
    ];
    compare(&through, &known);
    for counter in [C::LinkTotal, C::DomainInvocations, C::DomainBytesControlPoints] {
        assert_eq!(on_chip.get(counter), through.get(counter), "{counter:?}");
    }
}

#[test]
fn caches_and_shaders_cost_what_they_say() {
    let of = |set: &dyn Fn(&mut Config)| {
        let mut config = unit();
        set(&mut config);
        run_text(&fixed("teapot", "8"), &config).expect("a teapot").totals()
    };
    // No cache: three invocations a triangle, in six full waves.
    let none = of(&|c| c.domain.cache_entries = Some(0));
    let known = [
        (C::DomainInvocations, 32 * 128 * 3),
        (C::DomainRepeated, 32 * (128 * 3 - 81)),
        (C::DomainWaves, 32 * 6),
        (C::DomainIdle, 0),
        (C::EmitVertices, 32 * 128 * 3),
    ];
    compare(&none, &known);
    let mut last = u64::MAX;
    for entries in [1, 4, 8, 16, 32, 81] {
        let shaded = of(&|c| c.domain.cache_entries = Some(entries)).get(C::DomainInvocations);
        assert!(shaded <= last && shaded >= 2592, "{entries}: {shaded} after {last}");
        last = shaded;
    }
    assert_eq!(last, 2592, "a cache of all points is ideal");
    let naive = of(&|c| c.domain.shader = DomainKind::Naive);
    compare(&naive, &[(C::DomainBytesControlPoints, 2592 * 256), (C::DomainInvocations, 2592)]);
    let narrow = of(&|c| c.domain.width = 4);
    compare(&narrow, &[(C::DomainWaves, 32 * 21), (C::DomainIdle, 32 * 3)]);
}

#[test]
fn a_mesh_crosses_the_link_as_indexed_patches() {
    // Three by two patches: 10 x 7 points once, and 16 indices of 2 bytes a patch.
    let text = mesh_text(3, 2, false, 1);
    let mut config = unit();
    config.link.transfer = TransferMode::Push;
    let report = run_text(&text, &config).expect("a mesh").totals();
    let hybrid = run_text(&text, &Config::default()).expect("a mesh").totals();
    assert_eq!(report.get(C::LinkControlPoints), hybrid.get(C::LinkControlPoints));
    let known = [
        (C::LinkIndices, 6 * 16 * 2),
        (C::AssemblePatches, 6),
        (C::AssembleEdgePeak, 0), // that is for those who know what a mesh is
        (C::HullThreads, 6 * 16),
    ];
    compare(&report, &known);
    assert_eq!(report.get(C::AssembleReceived) + report.get(C::AssembleReused), 96);
}

#[test]
fn adaptive_tests_each_candidate_of_four_edges_and_four_inner_curves() {
    let of = |pixels| {
        let mut config = unit();
        config.hull.policy = FactorPolicy::Adaptive;
        config.hull.pixels = pixels;
        run_text(&shipped("teapot"), &config).expect("a teapot").totals()
    };
    let (all, none) = (of(0.0), of(1e4));
    let kept = all.get(C::LevelPatches);
    assert_eq!(all.get(C::HullDistanceTests), kept * 8 * 9); // L = 3: nine candidates a curve
    assert_eq!(none.get(C::HullDistanceTests), kept * 8 * 9);
    // Nothing is far enough: 3 segments everywhere; everything is: 12, but on collapsed edges.
    assert_eq!(none.get(C::ConnectTriangles), kept * 18);
    let most = kept * 288;
    let got = all.get(C::ConnectTriangles);
    assert!(got <= most && 10 * got > 9 * most, "{got} of {most}");
    assert_eq!(all.get(C::LevelFlatness), 0, "no criterion was computed");
}
