//! Laws between counters, held in every combination of what can be configured.

use crate::runs::{self, run, run_by, said};
use crate::{counted, host};
use rtl_model::counter::{Block, Counter as C, Counters, DECLARATIONS};
use tessim::config::{
    CachePolicy, Config, Engine, IndexWidth, MeshTopology, Residency, TransferMode,
};
use tessim::report::Report;

const RESIDENCIES: [&str; 3] = ["streamed", "discrete", "static"];
const INDICES: [&str; 3] = ["auto", "uint16", "uint32"];
const CACHES: [&str; 3] = ["unlimited", "fifo", "lru"];

const TOPOLOGIES: [&str; 4] = ["list", "strip_restart", "strip_degenerate", "optimised"];

/// Every combination, with its settings.
fn combinations() -> impl Iterator<Item = [String; 4]> {
    RESIDENCIES.into_iter().flat_map(|residency| {
        INDICES.into_iter().flat_map(move |index| {
            TOPOLOGIES.into_iter().flat_map(move |topology| {
                CACHES.map(|cache| {
                    [
                        format!("triangles.residency={residency}"),
                        format!("triangles.index={index}"),
                        format!("triangles.topology={topology}"),
                        format!("triangles.cache.policy={cache}"),
                    ]
                })
            })
        })
    })
}

/// The sum of a block's counters whose names begin like this.
fn sum(counters: &Counters, block: Block, start: &str) -> u64 {
    let named = DECLARATIONS.iter().filter(|d| d.block == block && d.name.starts_with(start));
    named.map(|d| counters.get(d.counter)).sum()
}

/// The link and device memory.
fn moved(c: &Counters, config: &Config, vertex_bytes: u64) {
    let total = c.get(C::LinkTotal);
    assert_eq!(sum(c, Block::Link, "bytes."), 2 * total);
    let read = sum(c, Block::Memory, "bytes.read.");
    let written = sum(c, Block::Memory, "bytes.written.");
    let moved = c.get(C::MemoryBursts) * u64::from(config.memory.burst);
    assert_eq!(moved, read + written + c.get(C::MemoryWasted));
    let settings = &config.triangles;
    let width = match settings.index {
        IndexWidth::Uint16 => 2..=2,
        IndexWidth::Uint32 => 4..=4,
        IndexWidth::Auto => 2..=4,
    };
    let indices = c.get(C::VertexCacheIndices);
    if settings.uses_memory() {
        assert_eq!(c.get(C::MemoryReadVertices), c.get(C::VertexCacheMisses) * vertex_bytes);
        let bytes = c.get(C::MemoryReadIndices);
        assert!(width.start() * indices <= bytes && bytes <= width.end() * indices, "{bytes}");
        assert_eq!(c.get(C::MemoryWrittenVertices), c.get(C::LinkVertices));
        assert_eq!(c.get(C::MemoryWrittenIndices), c.get(C::LinkIndices));
        assert!(c.get(C::MemoryMeshesPeak) > 0);
    } else {
        assert_eq!((read, written, c.get(C::MemoryMeshesPeak)), (0, 0, 0));
    }
    if settings.residency == Residency::Streamed {
        assert_eq!(c.get(C::LinkVertices), c.get(C::EmitVertices) * vertex_bytes);
        let bytes = c.get(C::LinkIndices);
        assert!(width.start() * indices <= bytes && bytes <= width.end() * indices, "{bytes}");
    }
}

/// Index fetch, its cache and the vertex shader.
fn fetched(c: &Counters, config: &Config, shader_bytes: u64) {
    let settings = &config.triangles;
    let [indices, restarts, repeated, strips, batches, hits, misses, triangles] = [
        C::VertexCacheIndices,
        C::VertexCacheRestarts,
        C::VertexCacheRepeated,
        C::VertexCacheStrips,
        C::VertexCacheBatches,
        C::VertexCacheHits,
        C::VertexCacheMisses,
        C::EmitTriangles,
    ]
    .map(|counter| c.get(counter));
    assert_eq!(hits + misses + restarts, indices);
    match settings.topology {
        MeshTopology::List | MeshTopology::Optimised => {
            assert_eq!((indices, restarts, repeated, strips), (3 * triangles, 0, 0, 0));
        }
        MeshTopology::StripRestart | MeshTopology::StripDegenerate => {
            assert_eq!(indices, triangles + 2 * strips + repeated + restarts);
            let parted = settings.topology == MeshTopology::StripRestart;
            assert_eq!(restarts, if parted { strips - batches } else { 0 });
            assert!(indices <= 3 * triangles);
        }
    }
    assert!(triangles > 0 && batches > 0);
    assert_eq!(c.get(C::VertexShaderInvocations), misses);
    assert_eq!(c.get(C::VertexShaderBytesIn), misses * shader_bytes);
    assert_eq!(c.get(C::VertexShaderBytesOut), misses * 32);
    let vertices = c.get(C::EmitVertices);
    if settings.cache.policy == CachePolicy::Unlimited {
        assert_eq!(misses, vertices);
    } else {
        assert!(vertices <= misses && misses <= 3 * triangles);
    }
}

/// Settings that leave the triangles as they are give the same triangles.
fn made(report: &Report) -> Vec<[u64; 2]> {
    let counters = report.frames.iter().map(|frame| &frame.counters);
    counters.map(|c| [c.get(C::EmitVertices), c.get(C::EmitTriangles)]).collect()
}

#[test]
fn every_combination_keeps_the_laws() {
    // A bare vertex has 32 bytes, of which a shader reads 24; one with a colour and texture
    // coordinates 24 + 4 + 8, of which the six components are read as 4 bytes each.
    let texts = [
        (runs::shipped("mesh"), 32, 24),
        (runs::shipped("fan"), 36, 24 + 24),
        (runs::shipped("indexed"), 36, 24 + 24),
        (runs::teacups(3, 3, 12), 32, 24),
        (runs::resident_grid(17, 5), 32, 24),
    ];
    let (mut frames, mut missed) = (0, 0);
    for (text, vertex_bytes, shader_bytes) in &texts {
        let hybrid = made(&run(text, &runs::set(&["engine=none"])));
        let mut of_residency = std::collections::HashMap::new();
        for settings in combinations() {
            let settings = settings.each_ref().map(String::as_str);
            let report = counted(text, &[&settings[..], &["triangles.cache.entries=9"]].concat());
            for frame in report.frames.iter().chain([&report.whole()]) {
                moved(&frame.counters, &report.config, *vertex_bytes);
                fetched(&frame.counters, &report.config, *shader_bytes);
                frames += 1;
            }
            let whole = report.whole().counters;
            missed += whole.get(C::VertexCacheMisses) - whole.get(C::EmitVertices);
            let made = made(&report);
            let first = of_residency.entry(settings[0].to_owned()).or_insert_with(|| made.clone());
            assert_eq!(*first, made, "{settings:?}");
            if report.config.triangles.residency == Residency::Streamed {
                assert_eq!(made, hybrid, "the same triangles as a unit's");
            }
        }
    }
    assert!(frames > 500 && missed > 1000, "{frames} frames, {missed} vertices shaded again");
    println!("{frames} frames");
}

/// A static mesh is what a unit that culls nothing makes at that level.
#[test]
fn a_static_mesh_has_the_triangles_of_a_fixed_level() {
    let mut triangles = 0;
    for text in [runs::shipped("mesh"), runs::shipped("teapot"), runs::teacups(3, 2, 12)] {
        for level in [1, 2, 3, 8, 17, 64] {
            let level = level.to_string();
            let whole = format!("triangles.level={level}");
            let fixed =
                [&format!("level.level={level}"), "level.min_level=1", "level.max_level=128"];
            let own = counted(&text, &["triangles.residency=static", &whole]);
            let config = runs::set(&[&["unit=moreton", "engine=none"], &fixed[..]].concat());
            let other = run(&text, &config);
            assert_eq!(made(&own), made(&other), "level {level}");
            triangles += own.total(C::EmitTriangles);
        }
    }
    println!("{triangles} triangles");
}

/// What moves in a run of the default is what moved before there was a choice: the host's link
/// bytes as every unit reports them.
#[test]
fn streamed_lists_are_what_units_are_compared_with() {
    for name in runs::SHIPPED {
        let report = counted(&runs::shipped(name), &[]);
        assert_eq!(report.total(C::LinkTotal), report.host_link_bytes, "{name}");
        let indices = report.total(C::VertexCacheIndices);
        assert_eq!(report.total(C::LinkIndices), 2 * indices, "{name}");
        // What is read from memory has crossed the link before: the same bytes.
        let cached = counted(&runs::shipped(name), &["triangles.cache.policy=lru"]);
        assert_eq!(cached.total(C::LinkTotal), report.host_link_bytes, "{name}");
        let strips = counted(&runs::shipped(name), &["triangles.topology=strip_restart"]);
        assert_eq!(strips.host_link_bytes, report.host_link_bytes, "{name}");
        assert!(strips.total(C::LinkTotal) < report.host_link_bytes, "{name}");
    }
}

#[test]
fn both_engines_and_any_threads_say_the_same() {
    let shared = ["memory.channels=shared", "vertex_shader.to_memory=true"];
    let cases: [&[&str]; 7] = [
        &["triangles.residency=static"],
        &["triangles.residency=discrete", "triangles.max_level=4", "frames=overlap"],
        &["triangles.residency=discrete", "triangles.upload=whole", "link.transfer=pull"],
        &["triangles.cache.policy=fifo", "triangles.topology=strip_restart"],
        &["triangles.cache.policy=lru", "link.transfer=pull", "link.bus=agp4x"],
        &["triangles.residency=static", shared[0], shared[1], "memory.bandwidth_mb_s=9000"],
        &["triangles.cache.policy=lru", shared[0], "memory.burst=64", "triangles.index=uint16"],
    ];
    let pools = [1, 3].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap());
    let mut rows = 0;
    for text in [runs::shipped("mesh"), runs::teacups(2, 3, 6)] {
        for case in cases {
            let mut config = host(&[case, &["triangles.level=3"]].concat());
            let by = |engine| said(&run_by(engine, &text, &config));
            let timed = by(Engine::Timed);
            assert_eq!(timed, by(Engine::Stepped), "{case:?}");
            for pool in &pools {
                assert_eq!(pool.install(|| said(&run(&text, &config))), timed, "{case:?}");
            }
            rows += timed.0.lines().count();
            if config.link.transfer == TransferMode::Pull {
                continue;
            }
            // What is read holds memory: with a fraction of the bandwidth it takes longer.
            let fast = runs::elapsed(&run(&text, &config));
            config.memory.bandwidth_mb_s = 1000;
            assert!(runs::elapsed(&run(&text, &config)) > fast, "{case:?}");
        }
    }
    assert!(rows > 500, "{rows}");
}
