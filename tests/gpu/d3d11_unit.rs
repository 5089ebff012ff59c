//! Unit `d3d11` from the hull shader on: whole traces beside a run, with everything that it counts,
//! and random patches of every width beside the shaders and the tessellator.

mod shaders;

use crate::d3d11::PARTITIONINGS;
use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use crate::walk;
use rtl_model::backface::{self, Verdict};
use rtl_model::clip;
use rtl_model::counter::{Counter, DECLARATIONS};
use rtl_model::d3d11::wave::Waves;
use rtl_model::d3d11::{Factors, Output, Tessellator};
use rtl_model::level::{self, Criterion, Events, State};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Level, Levels, Patch, Triangle, Vertex, View};
use shaders::{factors, shade};
use tessim::config::d3d11::Form;
use tessim::config::{Arithmetic, Config, DomainKind, FactorPolicy, Unit};
use tessim::gpu::d3d11::{Chosen, D3d11, d3d11, from_hull};
use tessim::gpu::{Backend, Device, LEVELS, Made, Settings, VERTEX, push_patch, words};
use tessim::sink::{FrameInfo, PatchMesh, Sink};
use tessim::study::check::Ledger;
use tessim::trace::open::Trace;

/// A batch as the device gets it.
#[derive(Default)]
struct Batch {
    patches: Vec<u32>,
    shaded: Vec<u32>,
    components: Vec<u32>,
    hull_bytes: Vec<u32>,
    fates: Vec<u32>,
    levels: Vec<u32>,
}

impl Batch {
    fn push(
        &mut self,
        config: &Config,
        view: &View,
        patch: &Patch,
        state: &State,
        components: u32,
    ) {
        let (criterion, number) = match state.criterion {
            Criterion::Flatness { pixels } => (0, pixels),
            Criterion::EdgeLength { pixels } => (1, pixels),
            Criterion::Fixed { level } => (2, level.fx16()),
        };
        let words = [criterion, number, state.min.fx16(), state.max.fx16()];
        push_patch(&mut self.patches, patch, words, [0; 3]);
        self.components.push(components);
        let bytes = 4 * components * config.attributes.component_bytes() as u32;
        self.hull_bytes.push(280 + bytes);
        self.fates.extend(fate(config, view, patch));
        let (levels, events) = level::accept(patch, view, &reachable(config, state));
        self.levels.extend(level_words(&levels, events));
    }

    fn work<'a>(&'a self, config: &'a Config, view: &View) -> D3d11<'a> {
        D3d11 {
            config,
            settings: Settings::new(config, view, view.position),
            position: view.position,
            patches: &self.patches,
            shaded: &self.shaded,
            components: &self.components,
            hull_bytes: &self.hull_bytes,
        }
    }

    fn made(&self, device: &Device, config: &Config, view: &View) -> Made {
        let work = self.work(config, view);
        let chosen = Chosen { fates: &self.fates, levels: &self.levels };
        from_hull(device, &work, chosen).unwrap()
    }
}

fn fate(config: &Config, view: &View, patch: &Patch) -> [u32; 4] {
    if config.clip.enabled && clip::outside(patch, view.depth) {
        return [0; 4];
    }
    let (verdict, facets) = backface::accept(patch, view, config.backface.method);
    let kept = if verdict == Verdict::Culled { 1 } else { 2 };
    [kept, u32::from(verdict != Verdict::Untested), facets, 0]
}

fn reachable(config: &Config, state: &State) -> State {
    let odd = config.tessellator.partitioning == rtl_model::d3d11::Partitioning::Odd;
    let most = Level::clamped(if odd { 63 << 16 } else { 64 << 16 });
    State { min: state.min.min(most), max: state.max.min(most), ..*state }
}

fn level_words(levels: &Levels, events: Events) -> [u32; LEVELS] {
    let mut out = [0; LEVELS];
    let all = levels.edges.iter().chain(&levels.interior);
    out.iter_mut().zip(all).for_each(|(word, level)| *word = level.fx16());
    let events = [events.clamped, events.near, events.overflows, events.splits];
    out[6..10].copy_from_slice(&events);
    out
}

fn vertex_words(vertex: &Vertex) -> [u32; VERTEX] {
    let mut out = [0; VERTEX];
    let position = vertex.position.iter().flat_map(|&c| words(c)).chain([vertex.u, vertex.v]);
    out.iter_mut().zip(position).for_each(|(word, value)| *word = value);
    out
}

/// What a run emits, flat.
#[derive(Default)]
struct Emitted {
    vertices: Vec<u32>,
    triangles: Vec<u32>,
}

impl Sink for Emitted {
    fn wants(&self, _: u64) -> bool {
        true
    }

    fn frame(&mut self, _: &FrameInfo) -> tessim::error::Result<()> {
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> tessim::error::Result<()> {
        self.vertices.extend(mesh.vertices.iter().flat_map(vertex_words));
        self.triangles.extend(mesh.triangles.as_flattened().iter().map(|&k| u32::from(k)));
        Ok(())
    }
}

fn counter(name: (&str, &str)) -> Counter {
    let found = DECLARATIONS.iter().find(|d| (d.block.name(), d.name) == name);
    found.unwrap_or_else(|| panic!("{name:?} is no counter")).counter
}

/// A configuration of the unit: what bears on words and counts, drawn.
fn config(random: &mut Random) -> Config {
    let mut config = Config { unit: Unit::D3d11, ..Config::default() };
    config.tessellator.partitioning = random.of(PARTITIONINGS);
    config.hull.policy = random.of([FactorPolicy::Criterion, FactorPolicy::Adaptive]);
    config.hull.candidates = random.integer(1, 6);
    config.hull.pixels = random.octaves(0.05, 20.0);
    config.hull.to_memory = random.bits() & 1 == 0;
    config.domain.shader = random.of([DomainKind::Naive, DomainKind::Basis]);
    config.domain.form = random.of([None, Some(Form::Paired), Some(Form::Sequential)]);
    config.domain.arithmetic = random.of(Arithmetic::ALL);
    config.domain.weight_bits = random.integer(16, 30);
    config.domain.cache_entries = random.of([None, Some(0), Some(1), Some(16), Some(40)]);
    config.domain.width = random.of([1, 4, 32, 48]);
    config.evaluate.rounding = random.of(Rounding::ALL);
    config.position.rounding = random.of(Rounding::ALL);
    config.position.overflow = random.of(Overflow::ALL);
    config
}

/// A trace that has one frame, through a run and through the kernels.
fn compare_trace(ledger: &mut Ledger, device: &Device, name: &str, config: &Config) {
    let path = format!("{}/traces/{name}.jsonl", env!("CARGO_MANIFEST_DIR"));
    let commands = Trace::open(path).unwrap().map(|located| Ok(located?.command));
    let mut emitted = Emitted::default();
    let report = tessim::simulate(commands, config, &mut emitted).unwrap();
    let (mut batch, mut view) = (Batch::default(), None);
    let max = config.level.max_level.map(|max| Level::clamped((max * 65536.0) as u64));
    walk::walk(name, config, |_, drawn| {
        view = Some(drawn.frame.view);
        let state = State { max: max.unwrap_or(drawn.state.max), ..drawn.state };
        batch.push(config, &drawn.frame.view, &drawn.patch, &state, 0);
        batch.shaded.extend(drawn.shaded.as_flattened().iter().map(|c| c.to_bits()));
    });
    let made = batch.made(device, config, &view.expect("a trace draws"));
    let place =
        || format!("{name}, {:?} {:?} {:?}", config.tessellator, config.hull, config.domain);
    let pairs = emitted.vertices.chunks(VERTEX).zip(made.vertices.chunks(VERTEX));
    for (k, (want, got)) in pairs.enumerate() {
        ledger.compare(("d3d11", "vertices"), want, got, place, || format!("vertex {k}"));
    }
    ledger.compare(("d3d11", "triangles"), &emitted.triangles, &made.triangles, place, || {
        "triangles".into()
    });
    let lengths = [emitted.vertices.len() as u32, made.triangles.len() as u32];
    let got = [made.vertices.len() as u32, emitted.triangles.len() as u32];
    ledger.compare(("d3d11", "lengths"), &lengths, &got, place, String::new);
    for &(name, count) in &made.counts {
        let want = words(report.total(counter(name)) as i64);
        ledger.compare(("d3d11", "counts"), &want, &words(count as i64), place, || {
            format!("{name:?}")
        });
    }
}

#[test]
fn traces_come_out_of_the_unit_alike_with_all_that_is_counted() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(1104);
    for name in ["teaspoon", "teapot", "rational", "teacup"] {
        for _ in 0..3 * support::effort() {
            let mut config = config(&mut random);
            config.level.max_level = Some(random.of([5.0, 9.5]));
            compare_trace(&mut ledger, device, name, &config);
        }
    }
    support::settle(&ledger, Quantity::KernelD3d11Random);
}

/// Control points as a shader has them: those of the patch, some of them far out, and now and then
/// one that is no number.
fn singles(random: &mut Random, patch: &Patch, view: &View) -> [[f32; 4]; 16] {
    let scale = f64::from(-view.position.fraction).exp2() * random.of([1.0, 1.0, 1.0, 3.0, 1e12]);
    let mut points = patch.points.map(|p| p.map(|c| (c as f64 * scale) as f32));
    if random.integer(0, 5) == 0 {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e-44, -0.0];
        points[random.integer(0, 15) as usize][random.integer(0, 3) as usize] = random.of(odd);
    }
    points
}

/// A draw's state: levels that a pattern of a few hundred points has, and some of all.
fn state(random: &mut Random) -> State {
    let most = if random.integer(0, 40) == 0 { 80.0 } else { random.of([3.0, 7.0, 12.0, 30.0]) };
    let level = |segments: f64| Level::clamped((segments * 65536.0) as u64);
    let min = level(random.octaves(0.9, most));
    let max = level(random.octaves(0.9, 2.0 * most)).max(min);
    let pixels = random.integer(1 << 12, 1 << 22);
    let criterion = match random.integer(0, 2) {
        0 => Criterion::Flatness { pixels },
        1 => Criterion::EdgeLength { pixels },
        // Now and then next to a whole number of segments.
        _ if random.bits() & 1 == 0 => {
            let whole = u64::from(random.integer(1, most as u32)) << 16;
            Criterion::Fixed { level: Level::clamped(whole - 1 + u64::from(random.integer(0, 2))) }
        }
        _ => Criterion::Fixed { level: level(random.octaves(1.0, most)) },
    };
    State { criterion, min, max }
}

/// A batch of random patches of a width, beside the shaders and the tessellator.
fn compare_width(ledger: &mut Ledger, device: &Device, random: &mut Random, width: u32) {
    let mut config = config(random);
    config.position.width = width;
    config.clip.enabled = false;
    let position = Format::of_range(width, random.of([0, 0, 5, -3, 100]));
    let near = i64::from(random.integer(0, 1 << 6));
    let depth = random.of([Depth::ZeroToOne, Depth::MinusOneToOne]);
    let view = View { position, near, depth, ..support::view(width) };
    let mut batch = Batch::default();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let (mut shaded_points, mut sums, mut levels) = (0, [0; 2], [0; 6]);
    let mut tessellator = Tessellator::default();
    for _ in 0..6 {
        let kind = random.of(Kind::ALL);
        let mut patch = random::patch(random, kind, position.max());
        if random.integer(0, 7) == 0 {
            // So near that projections do not fit.
            patch.points = patch.points.map(|[x, y, z, w]| [x, y, z, w >> 22]);
        }
        let (state, shaded) = (state(random), singles(random, &patch, &view));
        batch.push(&config, &view, &patch, &state, 0);
        batch.shaded.extend(shaded.as_flattened().iter().map(|c| c.to_bits()));
        if batch.fates[batch.fates.len() - 4] != 2 {
            continue;
        }
        let criterion = &batch.patches[batch.patches.len() - 7];
        let &[.., clamped, near, overflows, splits, _, _] = &batch.levels[..] else { panic!() };
        let flat = [u32::from(*criterion == 0), u32::from(*criterion == 1)];
        let events = [flat[0], flat[1], splits, clamped, near, overflows];
        levels.iter_mut().zip(events).for_each(|(sum, count)| *sum += count);
        let bits = factors(&config, &view, &patch, &state, &shaded);
        let processed = Factors::quad(config.tessellator.partitioning, bits).unwrap();
        tessellator.accept(&processed, Output::Cw);
        let (made, over, cracks) = shade(&config, &view, &patch, &shaded, tessellator.points());
        vertices.extend(made.iter().flat_map(vertex_words));
        let made: &[Triangle] = tessellator.indices().as_chunks().0;
        triangles.extend(made.as_flattened().iter().map(|&k| u32::from(k)));
        let mut waves = Waves::new(config.domain.cache_entries, config.domain.width as u16);
        shaded_points += waves.walk(made, |_| {});
        sums = [sums[0] + over, sums[1] + cracks];
    }
    let made = batch.made(device, &config, &view);
    let place = || format!("{width} bits, {position:?} {:?} {:?}", config.hull, config.domain);
    for (k, (want, got)) in vertices.chunks(VERTEX).zip(made.vertices.chunks(VERTEX)).enumerate() {
        let inputs = || format!("vertex {k}, {:?}", made.vertex_starts);
        ledger.compare(("d3d11", "vertices"), want, got, place, inputs);
    }
    ledger.compare(("d3d11", "triangles"), &triangles, &made.triangles, place, || "".into());
    let counted = |name| {
        let found = made.counts.iter().find(|(counter, _)| *counter == name);
        found.expect("a counter of the unit").1 as u32
    };
    let of = |name| counted(("domain", name));
    let want = [vertices.len() as u32, shaded_points as u32, sums[0] as u32, sums[1] as u32];
    let cracks = if config.is_order_invariant() { want[3] } else { of("cracks") };
    let got = [made.vertices.len() as u32, of("invocations"), of("overflows"), cracks];
    ledger.compare(("d3d11", "counts"), &want, &got, place, String::new);
    if config.hull.policy == FactorPolicy::Criterion {
        let names = ["patches.flatness", "patches.edge_length", "splits", "levels.clamped"];
        let got = [names[0], names[1], names[2], names[3], "edges.near", "overflows"]
            .map(|name| counted(("level", name)));
        ledger.compare(("d3d11", "levels"), &levels, &got, place, String::new);
    }
}

#[test]
fn random_patches_come_out_of_the_unit_alike_in_every_width() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(1105);
    for _ in 0..2 * support::effort() {
        for width in 8..=48 {
            compare_width(&mut ledger, device, &mut random, width);
        }
    }
    support::settle(&ledger, Quantity::KernelD3d11Random);
}

#[test]
fn the_unit_makes_the_same_where_buffers_are_small() {
    let Some(device) = support::device() else { return };
    let mut small = support::another(Backend::Auto).unwrap();
    small.limit_words(3000); // two patches' nets in eight orientations
    let mut random = Random::new(1107);
    let mut config = config(&mut random);
    config.domain.form = Some(Form::Sequential);
    config.hull.policy = FactorPolicy::Criterion;
    let view = support::view(32);
    let mut batch = Batch::default();
    for _ in 0..9 {
        let patch = random::patch(&mut random, Kind::Sheet, view.position.max());
        let level = |segments: u64| Level::clamped(segments << 16);
        let criterion = Criterion::Fixed { level: level(random.integer(1, 12).into()) };
        let state = State { criterion, min: level(1), max: level(12) };
        let components = random.integer(0, 5);
        batch.push(&config, &view, &patch, &state, components);
        let shaded = singles(&mut random, &patch, &view);
        batch.shaded.extend(shaded.as_flattened().iter().map(|c| c.to_bits()));
    }
    let want = batch.made(device, &config, &view);
    assert!(want.triangles.len() > 1000 && want.counts.iter().any(|(_, count)| *count > 1000));
    assert_eq!(batch.made(&small, &config, &view), want);
}

#[test]
fn the_unit_by_itself_chooses_what_it_is_given_otherwise() {
    let Some(device) = support::device() else { return };
    let mut random = Random::new(1108);
    let mut triangles = 0;
    for name in ["teaspoon", "teapot"] {
        for _ in 0..3 {
            let config = config(&mut random);
            let (mut batch, mut view) = (Batch::default(), None);
            walk::walk(name, &config, |_, drawn| {
                view = Some(drawn.frame.view);
                batch.push(&config, &drawn.frame.view, &drawn.patch, &drawn.state, 0);
                batch.shaded.extend(drawn.shaded.as_flattened().iter().map(|c| c.to_bits()));
            });
            let view = view.expect("a trace draws");
            let want = batch.made(device, &config, &view);
            let made = d3d11(device, &batch.work(&config, &view)).unwrap();
            triangles += made.triangles.len();
            // The planes that points are outside of are clip's own affair.
            let fates = |made: &Made| made.fates.chunks(4).map(|f| f[..3].to_vec()).collect();
            let (want_fates, got): (Vec<_>, Vec<_>) = (fates(&want), fates(&made));
            assert_eq!(got, want_fates, "{name}");
            assert_eq!(made.counts, want.counts, "{name}");
            assert!(made.vertices == want.vertices && made.triangles == want.triangles, "{name}");
        }
    }
    assert!(triangles > 1000, "only {triangles} words of triangles");
}

#[test]
fn levels_are_held_within_what_a_partitioning_reaches() {
    let Some(device) = support::device() else { return };
    let mut random = Random::new(1109);
    let view = support::view(32);
    for partitioning in PARTITIONINGS {
        for policy in [FactorPolicy::Criterion, FactorPolicy::Adaptive] {
            for [min, max] in [[70, 100], [1, 100]] {
                let mut config = Config { unit: Unit::D3d11, ..Config::default() };
                config.tessellator.partitioning = partitioning;
                config.hull.policy = policy;
                config.clip.enabled = false;
                let mut patch = random::patch(&mut random, Kind::Sheet, view.position.max());
                patch.cull = false;
                let level = |segments: u64| Level::clamped(segments << 16);
                let criterion = Criterion::Fixed { level: level(100) };
                let state = State { criterion, min: level(min), max: level(max) };
                let mut batch = Batch::default();
                batch.push(&config, &view, &patch, &state, 0);
                let shaded = singles(&mut random, &patch, &view);
                batch.shaded.extend(shaded.as_flattened().iter().map(|c| c.to_bits()));
                let made = d3d11(device, &batch.work(&config, &view)).unwrap();
                // Nothing asks the adaptive policy for more than its candidates, but for `min`.
                if policy == FactorPolicy::Criterion || min > 1 {
                    let odd = partitioning == rtl_model::d3d11::Partitioning::Odd;
                    let segments = if odd { 63 } else { 64 };
                    let want = (segments + 1) * (segments + 1);
                    assert_eq!(made.vertices.len(), VERTEX * want, "{partitioning:?} {policy:?}");
                }
                assert!(made == batch.made(device, &config, &view), "{partitioning:?} {policy:?}");
            }
        }
    }
}
