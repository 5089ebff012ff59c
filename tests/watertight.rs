//! Two patches that share a bit-equal edge have bit-equal boundary vertices along it: forward,
//! reversed or transposed, in other draws, primitives and frames, in every unit that tessellates,
//! at every width, rounding, overflow and scheme, under every criterion and termination.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/random.rs"]
mod random;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;
#[path = "watertight/surface.rs"]
mod surface;
#[path = "watertight/unified.rs"]
mod unified;

use glam::Vec3;
use random::Random;
use rtl_model::counter::Counters;
use rtl_model::level::{Criterion, Termination};
use rtl_model::number::{Overflow, Rounding};
use rtl_model::patch::{EDGES, Level, ONE, Point};
use run::{Keep, Mesh, camera, draw, points, scale};
use std::sync::Arc;
use tessim::config::{Arithmetic, Config, FactorPolicy, Partitioning, Scheme, Unit};
use tessim::trace::command::{Command, Draw, FanEncoding, Primitive, Tessellation};
use tessim::trace::indices::{IndexFormat, Indices};
use tessim::unit::simulate;

/// Pairs of patches in one run.
const PAIRS: usize = 40;

/// Two patches that share an edge: which edge of each, and whether the second runs it backwards.
#[derive(Clone, Copy, Debug)]
struct Shared {
    a: usize,
    b: usize,
    reversed: bool,
}

/// Vertices along an edge in the direction of its growing parameter: position and parameter.
fn row(unit: Unit, mesh: &Mesh, edge: usize) -> Vec<(Point, u32)> {
    let on = |v: &&rtl_model::patch::Vertex| [v.v == 0, v.u == ONE, v.v == ONE, v.u == 0][edge];
    let along = |v: &rtl_model::patch::Vertex| (v.position, if edge & 1 == 0 { v.u } else { v.v });
    if unit == Unit::Esc {
        // In the order of the strips; parameters of different vertices differ.
        let mut row: Vec<_> = mesh.vertices.iter().filter(on).map(along).collect();
        row.sort_unstable_by_key(|vertex| vertex.1);
        return row;
    }
    // Euler's formula: an inner vertex may have come to lie on an edge, too.
    let boundary = 2 * mesh.vertices.len() - mesh.triangles.len() - 2;
    let mut row: Vec<_> = mesh.vertices[..boundary].iter().filter(on).map(along).collect();
    // Counter-clockwise from (0, 0) or, in d3d11, from (0, 1): of the last edge, vertex 0 is the
    // first, and the others are numbered backwards.
    let from_above = mesh.vertices[0].v == ONE;
    match (edge, from_above) {
        (2, false) | (3, true) => row.reverse(),
        (3, false) | (2, true) => row[1..].reverse(),
        _ => {}
    }
    row
}

/// Whether two rows are one, the second walked backwards or not.
fn same(a: &[(Point, u32)], b: &[(Point, u32)], reversed: bool) -> bool {
    let flip = |&(p, t): &(Point, u32)| (p, if reversed { ONE - t } else { t });
    let mut b: Vec<_> = b.iter().map(flip).collect();
    if reversed {
        b.reverse();
    }
    a == b
}

fn patch(random: &mut Random, reach: f32) -> Vec<[f32; 3]> {
    let centre = [(); 3].map(|()| random.single(-1.0, 1.0));
    let mut patch = vec![[0.0; 3]; 16];
    for (k, point) in patch.iter_mut().enumerate() {
        let lattice = [(k % 4) as f32 / 3.0 - 0.5, (k / 4) as f32 / 3.0 - 0.5, 0.0];
        for i in 0..3 {
            point[i] = centre[i] + reach * (lattice[i] + random.single(-0.4, 0.4));
        }
    }
    if random.integer(0, 7) == 0 {
        let first = patch[0];
        patch[..4].fill(first); // a collapsed edge
    }
    patch
}

/// A pair and how it shares.
fn pair(random: &mut Random) -> ([Vec<[f32; 3]>; 2], Shared) {
    let reach = random.of([0.05, 0.5, 2.0, 6.0]);
    let (a, mut b) = (patch(random, reach), patch(random, reach));
    let shared = Shared {
        a: random.integer(0, 3) as usize,
        b: random.integer(0, 3) as usize,
        reversed: random.integer(0, 1) == 1,
    };
    for k in 0..4 {
        let j = if shared.reversed { 3 - k } else { k };
        b[EDGES[shared.b][j]] = a[EDGES[shared.a][k]];
    }
    ([a, b], shared)
}

/// Those that tessellate.
const UNITS: [Unit; 5] = [Unit::Hybrid, Unit::Sfarti, Unit::Moreton, Unit::D3d11, Unit::Esc];

fn config(random: &mut Random) -> Config {
    let unit = random.of(UNITS);
    let mut config = Config { unit, ..Config::default() };
    use Partitioning::{Even, Integer, Odd, Pow2};
    config.tessellator.partitioning = random.of([Integer, Pow2, Odd, Even]);
    config.hull.policy = random.of([FactorPolicy::Criterion, FactorPolicy::Adaptive]);
    config.hull.pixels = random.of([0.1, 2.0, 40.0]);
    config.domain.arithmetic = random.of([Arithmetic::F32, Arithmetic::Fixed]);
    config.domain.weight_bits = 16 + random.integer(0, 14);
    config.level.termination = random.of([Termination::EightCurves, Termination::Bounded]);
    config.position.width = 8 + random.integer(0, 40);
    config.position.rounding = random.of(Rounding::ALL);
    config.position.overflow = random.of(Overflow::ALL);
    config.evaluate.rounding = random.of(Rounding::ALL);
    config.evaluate.scheme = random.of([Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau]);
    if random.integer(0, 1) == 0 {
        config.evaluate.guard = Some(1 + random.integer(0, 20.min(60 - config.position.width) - 1));
    }
    // A range that is too small now and then, so that saturation and wrapping are met.
    config.position.clip_range_log2 = [None, None, None, Some(1)][random.integer(0, 3) as usize];
    surface::vary(random, &mut config);
    config
}

fn tessellation(random: &mut Random) -> Tessellation {
    let pixels = random.of([1 << 13, 1 << 16, 40 << 16]);
    let criterion = match random.integer(0, 3) {
        0 => Criterion::EdgeLength { pixels: 8 * pixels.min(40 << 16) },
        1 => Criterion::Fixed { level: Level::clamped(random.integer(ONE, 21 * ONE).into()) },
        _ => Criterion::Flatness { pixels },
    };
    Tessellation { criterion, min_level: ONE, max_level: 64 * ONE }
}

/// A run's commands: the first patches of all pairs in one frame as `patches`, the second in the
/// next, each as a primitive of its own.
fn commands(pairs: &[[Vec<[f32; 3]>; 2]], tessellation: Tessellation) -> Vec<Command> {
    let frame = || Command::Frame(camera(Vec3::new(3.0, 2.0, 1.5), 0.5, 12.0));
    let mut commands = vec![Command::Tessellation(tessellation), frame()];
    let firsts = pairs.iter().flat_map(|p| p[0].clone()).collect();
    commands.push(points(0, firsts));
    let count = pairs.len() as u64;
    commands.push(Command::Draw(draw(Primitive::Patches { count }, 0, 0)));
    commands.push(frame());
    for (k, pair) in pairs.iter().enumerate() {
        commands.extend(alone(k, &pair[1]));
    }
    commands
}

/// A patch as a primitive of one patch, which `k` chooses: a fan where its row 0 is collapsed.
fn alone(k: usize, patch: &[[f32; 3]]) -> [Command; 2] {
    let collapsed = patch[..4].iter().all(|p| *p == patch[0]);
    let primitive = match k % 3 {
        _ if collapsed => Primitive::Fan { count: 1, encoding: FanEncoding::Full },
        0 => Primitive::Mesh { rows: 1, columns: 1 },
        1 => Primitive::Strip { count: 1 },
        _ => Primitive::Indexed { count: 1 },
    };
    let mut list = vec![[0.0; 3]; primitive.points().unwrap_or(16) as usize];
    if let Primitive::Indexed { .. } = primitive {
        list.copy_from_slice(patch);
        list.reverse();
        let row = std::array::from_fn(|k| 15 - k as u32);
        let indices = Indices { format: IndexFormat::Uint16, points: vec![row], corners: vec![] };
        let indexed = Draw { indices: Some(Arc::new(indices)), ..draw(primitive, 1, 0) };
        return [points(1, list), Command::Draw(indexed)];
    }
    for (index, point) in primitive.indices(0).into_iter().zip(patch) {
        list[index as usize] = *point;
    }
    [points(1, list), Command::Draw(draw(primitive, 1, 0))]
}

fn meshes(pairs: &[[Vec<[f32; 3]>; 2]], tessellation: Tessellation, config: &Config) -> Vec<Mesh> {
    counted(pairs, tessellation, config).0
}

/// The meshes, and what the run counted.
fn counted(
    pairs: &[[Vec<[f32; 3]>; 2]],
    tessellation: Tessellation,
    config: &Config,
) -> (Vec<Mesh>, Counters) {
    let mut keep = Keep::default();
    let mut whole = config.clone();
    whole.clip.enabled = false;
    let commands = commands(pairs, tessellation).into_iter().map(Ok);
    let report = simulate(commands, &whole, &mut keep).expect("the commands are well-formed");
    assert_eq!(keep.meshes.len(), 2 * pairs.len());
    (keep.meshes, report.totals())
}

#[test]
fn shared_edges_are_bit_identical() {
    let mut random = Random::new(2);
    let (mut edges, mut vertices, mut uneven) = (0, 0, 0);
    let mut of_unit = [0; Unit::ALL.len()];
    for _ in 0..scale(250, 30_000) {
        let (config, tessellation) = (config(&mut random), tessellation(&mut random));
        let (pairs, shared): (Vec<_>, Vec<_>) = (0..PAIRS).map(|_| pair(&mut random)).unzip();
        let meshes = meshes(&pairs, tessellation, &config);
        for (k, shared) in shared.iter().enumerate() {
            let (a, b) = (&meshes[k], &meshes[PAIRS + k]);
            let (ra, rb) = (row(config.unit, a, shared.a), row(config.unit, b, shared.b));
            assert!(
                same(&ra, &rb, shared.reversed),
                "pair {k} {shared:?} under {config:?}, {tessellation:?}:\n{ra:?}\n{rb:?}"
            );
            let segments = |m: &Mesh| [0, 1, 2, 3].map(|e| row(config.unit, m, e).len());
            let others = [segments(a), segments(b)].concat();
            uneven += usize::from(others.iter().any(|&n| n != ra.len()));
            edges += 1;
            vertices += ra.len();
            of_unit[config.unit as usize] += 1;
        }
    }
    println!(
        "compared {edges} edge pairs, {vertices} vertices; {uneven} beside an edge of another \
         level; by unit {of_unit:?}"
    );
    assert!(
        edges >= 10_000 && vertices > 5 * edges,
        "only {edges} edges, {vertices} vertices compared"
    );
    for unit in UNITS {
        assert!(of_unit[unit as usize] * 8 > edges, "{unit:?}: {of_unit:?} of {edges}");
    }
    assert!(2 * uneven >= edges, "levels differ on only {uneven} of {edges}");
}

/// The comparison sees what it is there to see.
#[test]
fn planted_faults_are_caught() {
    let mut random = Random::new(3);
    let (mut tried, mut surface_run, mut rounding) = (0, 0, 0);
    for _ in 0..20 {
        let mut right = Config::default();
        let unit = right.unit;
        right.position.width = 24 + random.integer(0, 19);
        let mut flipped = right.clone();
        flipped.evaluate.rounding = Rounding::Floor;
        let mut surface = right.clone();
        surface.evaluate.scheme = Scheme::DeCasteljau;
        let criterion = Criterion::Fixed { level: Level::clamped(u64::from(7 * ONE + 12_345)) };
        let tessellation = Tessellation { criterion, ..Tessellation::default() };
        let (pairs, shared): (Vec<_>, Vec<_>) = (0..PAIRS).map(|_| pair(&mut random)).unzip();
        let [right, flipped, surface] =
            [right, flipped, surface].map(|config| meshes(&pairs, tessellation, &config));
        for (k, shared) in shared.iter().enumerate() {
            let good = row(unit, &right[k], shared.a);
            let collapsed = good.iter().all(|v| v.0 == good[0].0);
            if collapsed {
                continue; // every evaluator makes the same point of it
            }
            tried += 1;
            let neighbour = row(unit, &right[PAIRS + k], shared.b);
            assert!(same(&good, &neighbour, shared.reversed));
            let middle = 2;
            // That vertex as the surface's own evaluator makes it, at the reported parameter; and
            // rounded down.
            let mut planted = good.clone();
            planted[middle] = row(unit, &surface[k], shared.a)[middle];
            surface_run += usize::from(!same(&planted, &neighbour, shared.reversed));
            let mut planted = good.clone();
            planted[middle] = row(unit, &flipped[k], shared.a)[middle];
            rounding += usize::from(!same(&planted, &neighbour, shared.reversed));
        }
    }
    println!("planted {tried}: surface run caught {surface_run}, rounding caught {rounding}");
    assert!(tried > 500);
    // Of four coordinates rounded down, one in sixteen times none differs.
    assert!(surface_run * 10 >= tried * 9 && rounding * 10 >= tried * 8);
}
