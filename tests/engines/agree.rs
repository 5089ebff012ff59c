//! `timed` and `stepped` say the same of a run, row by row and FIFO by FIFO, under configurations
//! that reach every key of time; and each of them changes what is said.

use crate::random::Random;
use crate::run::{Keep, scale};
use crate::runs::{self, Said, configuration, run_by, said, set};
use rayon::prelude::*;
use rtl_model::counter::{Block, Counter};
use std::ops::Add;
use tessim::config::block::TIMED;
use tessim::config::keys::KEYS;
use tessim::config::{Config, Engine, Unit};

/// A configuration: its name, its preset, its settings, and whether unit `triangles` notices.
type Case = (&'static str, &'static str, Vec<String>, bool);

fn case(name: &'static str, preset: &'static str, settings: &[&str], triangles_too: bool) -> Case {
    (name, preset, settings.iter().map(|&s| s.to_owned()).collect(), triangles_too)
}

/// The setting of every block's key of this name.
fn everywhere(key: &str) -> Vec<String> {
    TIMED.iter().map(|block| format!("block.{}.{key}", block.name())).collect()
}

/// Configurations, the default first.
fn cases() -> Vec<Case> {
    let modern = |name, settings: &[&str], too| case(name, "modern", settings, too);
    let with = |name, keys: &[&str]| -> Case {
        (name, "modern", keys.iter().flat_map(|key| everywhere(key)).collect(), true)
    };
    let shared = ["memory.channels=shared", "vertex_shader.to_memory=true"];
    let slow = ["memory.channels=shared", "memory.bandwidth_mb_s=9000"];
    let streamed = [shared[0], shared[1], "memory.bandwidth_mb_s=30000", "memory.burst=64"];
    let pulled = ["link.transfer=pull", "link.latency=90", "link.outstanding=3", "link.bus=agp4x"];
    let mut shallow = with("fifo 1", &["fifo=1"]);
    shallow.2.push("memory.fifo=1".to_owned());
    vec![
        modern("default", &[], true),
        case("gf3-2001", "gf3-2001", &[], true),
        case("hd5870, 320 lanes", "hd5870", &[], true),
        case("hd6970, overlap", "hd6970", &["frames=overlap"], true),
        modern("overlap", &["frames=overlap"], true),
        modern("pull", &["link.transfer=pull"], true),
        modern("pull, AGP, few requests", &pulled, true),
        modern("shared port", &shared, true),
        modern("shared port, reads and uploads only", &slow, false),
        case(
            "shared port, overlap",
            "gf3-2001",
            &[&shared[..], &["frames=overlap"]].concat(),
            true,
        ),
        modern("shared port, bandwidth", &streamed, true),
        modern(
            "streamed out",
            &["vertex_shader.to_memory=true", "memory.bandwidth_mb_s=9000"],
            true,
        ),
        with("3 lanes", &["lanes=3", "interval=3"]),
        with("3 lanes in turn", &["lanes=3", "interval=3", "lane_order=round_robin"]),
        shallow,
        with("fifo 2", &["fifo=2"]),
        with("one in flight", &["in_flight=1"]),
        with("fast", &["latency=0"]),
        modern("de Casteljau", &["evaluate.scheme=de_casteljau"], false),
        modern("mixed", &["evaluate.scheme=mixed", "block.evaluate.setup=40"], false),
        modern("no culling", &["backface.method=off", "clip.enabled=false"], true),
        modern("net facets", &["backface.method=net_facets", "block.backface.lanes=2"], true),
        modern("fixed level", &["level.level=3.5", "block.level.interval=7"], true),
        modern(
            "uneven",
            &["block.stitch.interval=2", "block.emit.latency=3", "link.bus=agp1x"],
            true,
        ),
    ]
}

/// Traces of every kind, with their names.
fn traces() -> Vec<(String, String)> {
    let shipped = runs::SHIPPED.map(|name| (name.to_owned(), runs::shipped(name)));
    let made = [
        ("teacups", runs::teacups(3, 4, 5)),
        ("grid", runs::grid(18, 3)),
        ("resident grid", runs::resident_grid(18, 3)),
    ];
    shipped.into_iter().chain(made.map(|(name, text)| (name.to_owned(), text))).collect()
}

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
struct Compared {
    runs: u64,
    tokens: u64,
    cycles: u64,
}

impl Add for Compared {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            runs: self.runs + other.runs,
            tokens: self.tokens + other.tokens,
            cycles: self.cycles + other.cycles,
        }
    }
}

/// What both engines say of a run.
fn both(what: &str, text: &str, config: &Config) -> (Said, Compared) {
    let report = run_by(Engine::Timed, text, config);
    let (timed, stepped) = (said(&report), said(&run_by(Engine::Stepped, text, config)));
    for (timed, stepped) in timed.0.lines().zip(stepped.0.lines()) {
        assert_eq!(timed, stepped, "{what}: timed against stepped");
    }
    assert_eq!(timed.0, stepped.0, "{what}");
    assert_eq!(timed.1, stepped.1, "{what}: occupancy");
    let (tokens, cycles) = (runs::tokens(&report), runs::elapsed(&report));
    (timed, Compared { runs: 1, tokens, cycles })
}

#[test]
fn timed_and_stepped_agree_under_every_kind_of_configuration() {
    let (cases, traces) = (cases(), traces());
    let all: Vec<(Vec<Said>, Compared)> = cases
        .par_iter()
        .flat_map(|case| ["hybrid", "triangles"].into_par_iter().map(move |unit| (case, unit)))
        .map(|((name, preset, settings, _), unit)| {
            let unit = format!("unit={unit}");
            let settings: Vec<&str> = settings.iter().map(String::as_str).chain([&*unit]).collect();
            let config = configuration(preset, &settings);
            let one = |(trace, text): &(String, String)| {
                both(&format!("{trace}, {unit}, {name}"), text, &config)
            };
            let (said, compared): (Vec<_>, Vec<_>) = traces.iter().map(one).unzip();
            (said, compared.into_iter().fold(Compared::default(), Add::add))
        })
        .collect();
    let compared = all.iter().fold(Compared::default(), |sum, (_, compared)| sum + *compared);
    println!("compared {compared:?}");
    assert_eq!(compared.runs as usize, cases.len() * traces.len() * 2);
    for (pair, case) in all.chunks(2).zip(&cases).skip(1) {
        assert_ne!(pair[0].0, all[0].0, "{}: hybrid does not notice", case.0);
        assert_eq!(pair[1].0 != all[1].0, case.3, "{}: whether triangles notices", case.0);
    }
}

/// Settings of the units that do not divide their patches as the hybrid does. The first of each
/// unit is its default.
const OTHER_UNITS: [&[&str]; 23] = [
    &["unit=sfarti"],
    &["unit=sfarti", "level.termination=bounded"],
    &["unit=sfarti", "level.union=primitive"],
    &["unit=sfarti", "level.union=primitive", "level.termination=bounded", "frames=overlap"],
    &["unit=sfarti", "level.union=primitive", "memory.channels=shared", "block.place.lanes=3"],
    &["unit=sfarti", "level.level=5", "block.level.latency=40", "block.level.fifo=1"],
    &["unit=moreton"],
    &["unit=moreton", "evaluate.scheme=de_casteljau", "link.transfer=pull"],
    &["unit=moreton", "memory.channels=shared", "vertex_shader.to_memory=true"],
    &["unit=d3d11"],
    &["unit=d3d11", "hull.to_memory=true", "memory.bandwidth_mb_s=3000"],
    &["unit=d3d11", "hull.to_memory=true", "memory.channels=shared", "frames=overlap"],
    &["unit=d3d11", "domain.cache_entries=8", "domain.width=16", "domain.shader=naive"],
    &["unit=d3d11", "hull.policy=adaptive", "tessellator.partitioning=even", "block.hull.lanes=5"],
    &["unit=d3d11", "domain.width=1", "block.domain.lanes=7", "tessellator.partitioning=integer"],
    &["unit=d3d11", "level.level=1", "block.connect.interval=9", "block.points.fifo=1"],
    &["unit=esc"],
    &["unit=esc", "esc.width=4", "block.surface.lanes=3", "esc.mu=0"],
    &["unit=esc", "esc.width=1", "frames=overlap", "block.group.fifo=1", "link.transfer=pull"],
    &["unit=esc", "esc.width=7", "esc.reuse=coarse_triangle", "memory.channels=shared"],
    &["unit=esc", "esc.output_values=1024", "esc.level_max=3", "esc.width=16", "esc.space=object"],
    &["unit=esc", "esc.reuse=none", "esc.level=distance", "esc.scope=object", "esc.width=2"],
    &["unit=esc", "esc.level=screen_size", "esc.width=3", "block.emit.interval=9"],
];

#[test]
fn timed_and_stepped_agree_in_every_unit() {
    let traces = traces();
    let all: Vec<(Vec<Said>, Compared)> = OTHER_UNITS
        .par_iter()
        .map(|settings| {
            let config = set(settings);
            let one = |(trace, text): &(String, String)| {
                let (said, compared) = both(&format!("{trace}, {settings:?}"), text, &config);
                meshes_do_not_change(text, &config, &said);
                (said, compared)
            };
            let (said, compared): (Vec<_>, Vec<_>) = traces.iter().map(one).unzip();
            (said, compared.into_iter().fold(Compared::default(), Add::add))
        })
        .collect();
    let compared = all.iter().fold(Compared::default(), |sum, (_, compared)| sum + *compared);
    println!("compared {compared:?}");
    for (k, (said, _)) in all.iter().enumerate() {
        assert!(all[..k].iter().all(|(other, _)| other != said), "{:?}", OTHER_UNITS[k]);
    }
}

/// A run whose meshes are wanted says the same, and they are as many as it says.
fn meshes_do_not_change(text: &str, config: &Config, counted: &Said) {
    let mut sink = Keep::default();
    let report = runs::run_into(text, config, &mut sink);
    assert!(said(&report) == *counted, "meshes change what is said");
    let [vertices, triangles] = [
        sink.meshes.iter().map(|mesh| mesh.vertices.len()).sum::<usize>(),
        sink.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
    ];
    let again = report.total(Counter::DomainRepeated);
    let leave = report.total(Counter::EmitVertices);
    // A surface shader may give a point more than once, which the mesh has once.
    let once =
        if config.unit == Unit::Esc { Counter::SurfacePoints } else { Counter::EmitVertices };
    assert_eq!(vertices as u64 + again, report.total(once));
    assert!(vertices as u64 <= leave);
    assert_eq!(triangles as u64, report.total(Counter::EmitTriangles));
    assert_eq!(sink.meshes.len() as u64, report.total(Counter::LevelPatches));
}

/// Settings of a unit that has the block: waves of a few patches, so that there are several.
fn unit_with(block: Block) -> [&'static str; 2] {
    use Block::{Connect, Domain, Factors, Group, Hull, Points, Surface};
    let unit = match block {
        Hull | Factors | Points | Connect | Domain => "unit=d3d11",
        Group | Surface => "unit=esc",
        _ => "unit=hybrid",
    };
    [unit, "esc.width=4"]
}

/// A setting of a block's key that is far from its default.
fn far(block: Block, key: &str) -> Option<[String; 2]> {
    let path = |key: &str| format!("block.{}.{key}", block.name());
    let (base, value) = match key {
        "interval" => ("latency=0", "200"),
        "latency" => ("latency=0", "2500"),
        "in_flight" => ("latency=300", "1"),
        "lanes" => ("interval=90", "3"),
        "fifo" => ("interval=90", "300"),
        "setup" => ("latency=0", "300"),
        "net" | "test" | "point" | "slot" => ("latency=0", "900"),
        _ => return None, // which of equal lanes takes a token often makes no difference
    };
    Some([path(base), format!("{}={value}", path(key))])
}

#[test]
fn every_key_of_a_block_makes_a_difference_that_both_engines_see() {
    let text = runs::teacups(3, 2, 4);
    let mut changed = 0;
    for block in TIMED {
        let [unit, width] = unit_with(block);
        let prefix = format!("block.{}.", block.name());
        for key in KEYS.iter().filter_map(|key| key.path.strip_prefix(&prefix)) {
            let Some([base, far]) = far(block, key) else { continue };
            let what = format!("{far} beside {base}");
            let ((before, _), (after, _)) = (
                both(&what, &text, &set(&[unit, width, &base])),
                both(&what, &text, &set(&[unit, width, &base, &far])),
            );
            assert_ne!(before, after, "{what} changes nothing");
            changed += 1;
        }
    }
    assert_eq!(changed, 18 * 5 + 1 + 4, "every key but the order of lanes");
    println!("compared {changed} pairs of runs");
}

#[test]
fn keys_of_link_and_memory_make_the_difference_that_they_should() {
    let text = runs::teacups(3, 2, 4);
    let pull = ["link.transfer=pull", "link.bandwidth_mb_s=4000"];
    let slow = ["memory.bandwidth_mb_s=6000", "memory.latency=50"];
    let far = ["memory.latency=3000", "memory.bandwidth_mb_s=90000"];
    let out = ["vertex_shader.to_memory=true", "memory.bandwidth_mb_s=90000"];
    // Beside which settings which one takes more cycles.
    let slower: [(&[&str], &str); 13] = [
        (&[], "link.bandwidth_mb_s=200"),
        (&pull, "link.latency=5000"),
        (&pull, "link.outstanding=1"),
        (&pull, "link.request=16"),
        (&pull, "link.upstream_mb_s=20"),
        (&pull, "link.completion_header=200"),
        (&slow, "memory.bandwidth_mb_s=3000"),
        (&slow, "memory.latency=3000"),
        (&slow, "memory.burst=4096"),
        (&far, "memory.outstanding=1"),
        (&slow, "memory.channels=shared"),
        (&["memory.bandwidth_mb_s=30000"], "vertex_shader.to_memory=true"),
        (&out, "vertex_shader.bytes_out=400"),
    ];
    for (base, change) in slower {
        let what = format!("{change} beside {base:?}");
        let cycles = |settings: &[&str]| both(&what, &text, &set(settings)).1.cycles;
        let (before, after) = (cycles(base), cycles(&[base, &[change]].concat()));
        assert!(after > before, "{what}: {after} cycles after {before}");
    }
    println!("compared {} pairs of runs", slower.len());
}

/// Any configuration.
fn any(random: &mut Random) -> Config {
    let mut settings = vec![
        format!("clock_mhz={}", random.of([50, 400, 2000])),
        format!("frames={}", random.of(["drain", "overlap"])),
        format!("unit={}", random.of(UNITS)),
        format!("hull.policy={}", random.of(["criterion", "adaptive"])),
        format!("hull.to_memory={}", random.of(["false", "true"])),
        format!("tessellator.partitioning={}", random.of(["integer", "pow2", "odd", "even"])),
        format!("domain.shader={}", random.of(["naive", "basis"])),
        format!("domain.cache_entries={}", random.of([0, 1, 12, 65536])),
        format!("domain.width={}", random.of([1, 4, 64])),
        format!("level.termination={}", random.of(["eight_curves", "bounded"])),
        format!("level.union={}", random.of(["off", "primitive"])),
        format!("esc.level={}", random.of(["criterion", "fixed", "distance", "screen_size"])),
        format!("esc.mu={}", random.of(["0", "0.5", "4"])),
        format!("esc.reuse={}", random.of(["none", "coarse_triangle", "patch"])),
        format!("esc.space={}", random.of(["pixels", "object"])),
        format!("esc.output_values={}", random.of([264, 1024, 65536])),
        format!("esc.width={}", random.of([1, 2, 5, 64, 1024])),
        format!("esc.register_file={}", random.octaves(100.0, 65536.0) as u32),
        format!("block.surface.point={}", random.integer(0, 20)),
        format!("link.bus={}", random.of(["agp1x", "agp8x", "pcie1x1", "pcie4x16"])),
        format!("link.transfer={}", random.of(["push", "pull"])),
        format!("link.latency={}", random.integer(0, 300)),
        format!("link.outstanding={}", random.integer(1, 9)),
        format!("memory.bandwidth_mb_s={}", random.octaves(500.0, 500_000.0) as u32),
        format!("memory.latency={}", random.integer(0, 500)),
        format!("memory.outstanding={}", random.integer(1, 80)),
        format!("memory.channels={}", random.of(["separate", "shared"])),
        format!("memory.fifo={}", random.integer(1, 5)),
        format!("vertex_shader.to_memory={}", random.of(["false", "true"])),
        format!("backface.method={}", random.of(METHODS)),
        format!("clip.enabled={}", random.of(["false", "true"])),
        format!("evaluate.scheme={}", random.of(["forward", "mixed", "de_casteljau"])),
        format!("block.evaluate.setup={}", random.integer(0, 40)),
    ];
    for block in TIMED {
        let mut key = |name: &str, value: u32| {
            settings.push(format!("block.{}.{name}={value}", block.name()));
        };
        key("interval", random.octaves(1.0, 12.0) as u32);
        key("latency", random.octaves(1.0, 90.0) as u32 - 1);
        key("lanes", random.of([1, 1, 1, 2, 3, 5]));
        key("fifo", random.octaves(1.0, 40.0) as u32);
        if random.integer(0, 1) > 0 {
            key("in_flight", random.octaves(1.0, 20.0) as u32);
        }
        let order = random.of(["first_free", "round_robin"]);
        settings.push(format!("block.{}.lane_order={order}", block.name()));
    }
    set(&settings.iter().map(String::as_str).collect::<Vec<_>>())
}

const UNITS: [&str; 6] = ["hybrid", "sfarti", "moreton", "triangles", "d3d11", "esc"];

const METHODS: [&str; 5] = ["off", "net_facets", "tangent_plane", "normal_cone", "hull_literal"];

#[test]
fn timed_and_stepped_agree_under_any_configuration() {
    let traces = [
        runs::teacups(2, 4, 4),
        runs::resident_grid(17, 2),
        runs::shipped("mesh"),
        runs::shipped("teaspoon"),
        runs::shipped("strip"),
        runs::shipped("indexed"),
    ];
    let (count, started) = (scale(120, 3000), std::time::Instant::now());
    let compared = (0..count as u64)
        .into_par_iter()
        .map(|seed| {
            let config = any(&mut Random::new(seed));
            let trace = &traces[seed as usize % traces.len()];
            both(&format!("seed {seed}, {config:?}"), trace, &config).1
        })
        .reduce(Compared::default, Add::add);
    println!("compared {compared:?} in {:?}", started.elapsed());
    assert_eq!(compared.runs as usize, count);
}

#[test]
fn without_an_engine_all_but_the_cycles_is_the_same() {
    let mut rows = 0;
    let overlap = ["frames=overlap", "vertex_shader.to_memory=true", "memory.channels=shared"];
    let invocations = ["unit=esc", "esc.width=8", "esc.output_values=1024", "esc.level_max=7"];
    for (name, text) in traces() {
        for settings in
            [&[][..], &["unit=triangles"], &["link.transfer=pull"], &overlap, &invocations]
        {
            let config = set(settings);
            let [timed, none] =
                [Engine::Timed, Engine::None].map(|engine| run_by(engine, &text, &config));
            assert!(none.occupancy.is_empty() && none.frames.iter().all(|f| f.times.is_none()));
            let (timed, none) = (said(&timed).0, said(&none).0);
            let engines_own = |row: &&str| row.contains(",cycles.") || row.contains(",fifo.peak,");
            let (own, shared): (Vec<_>, Vec<_>) = timed.lines().partition(engines_own);
            assert_eq!(shared, none.lines().collect::<Vec<_>>(), "{name} {settings:?}");
            assert!(!own.is_empty());
            rows += shared.len();
        }
    }
    println!("compared {rows} rows");
}

#[test]
fn threads_and_meshes_do_not_change_what_is_timed() {
    // More patches than a batch holds, with commands among them; and instances of one draw.
    let traces = [runs::grid(66, 1), runs::teacups(170, 2, 1), runs::shipped("mesh")];
    let unified = ["unit=sfarti", "level.union=primitive"];
    let shaders = ["unit=d3d11", "domain.cache_entries=8", "hull.to_memory=true"];
    let invocations = ["unit=esc", "esc.width=24", "esc.reuse=coarse_triangle"];
    let objects =
        ["unit=esc", "esc.scope=object", "esc.level=distance", "esc.space=object", "esc.width=100"];
    let mut runs = 0;
    for (k, text) in traces.iter().enumerate() {
        for settings in [
            &[][..],
            &["unit=triangles", "frames=overlap"],
            &["memory.channels=shared"],
            &unified,
            &shaders,
            &invocations,
            &objects,
        ] {
            let config = set(settings);
            let expected = said(&runs::run(text, &config));
            for threads in [1, 2, 3, 7] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                let pool = pool.expect("a pool of threads");
                let [counted, meshed] = pool.install(|| {
                    let mut sink = Keep::default();
                    let meshed = runs::run_into(text, &config, &mut sink);
                    assert!(!sink.meshes.is_empty());
                    [said(&runs::run(text, &config)), said(&meshed)]
                });
                assert!(counted == expected, "trace {k}, {settings:?}, {threads} threads");
                assert!(meshed == expected, "trace {k}, {settings:?}, {threads} threads, meshes");
                runs += 2;
            }
        }
    }
    println!("compared {runs} runs");
}
