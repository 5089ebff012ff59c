//! Unified lists within strips, fans and meshes: the same list along a column and along a row, no
//! more in it than the patches ask for, and bit-equal vertices on every edge that two share.

use super::random::Random;
use super::run::{Keep, Mesh, camera, draw, points, scale};
use super::{config, tessellation};
use glam::Vec3;
use rtl_model::counter::{Counter as C, Counters};
use rtl_model::level::{Criterion, Termination};
use rtl_model::patch::{ONE, Point};
use std::collections::BTreeSet;
use tessim::config::{Config, Union, Unit};
use tessim::trace::command::{Command, Draw, FanEncoding, Primitive, Tessellation};
use tessim::unit::simulate;

/// A bumpy surface with as many points as the primitive has.
fn surface(random: &mut Random, primitive: Primitive) -> Vec<[f32; 3]> {
    let count = primitive.points().expect("not indexed");
    let across = match primitive {
        Primitive::Mesh { columns, .. } => 3 * u64::from(columns) + 1,
        Primitive::Strip { .. } => 4,
        _ => (count as f64).sqrt() as u64 + 1,
    };
    let (step, bump) = (3.0 / across as f32, random.of([0.02, 0.2, 1.0]));
    let mut point = |k: u64| {
        let mut jitter = || bump * step * random.single(-1.0, 1.0);
        [
            (k % across) as f32 * step - 1.5 + jitter(),
            (k / across) as f32 * step - 1.5 + jitter(),
            4.0 * jitter(),
        ]
    };
    (0..count).map(&mut point).collect()
}

fn run(draw: &Draw, list: &[[f32; 3]], t: Tessellation, config: &Config) -> (Vec<Mesh>, Counters) {
    let commands = [
        Command::Tessellation(t),
        Command::Frame(camera(Vec3::new(3.0, 2.0, 1.5), 0.5, 12.0)),
        points(0, list.to_vec()),
        Command::Draw(draw.clone()),
    ];
    let mut keep = Keep::default();
    let report = simulate(commands.into_iter().map(Ok), config, &mut keep);
    (keep.meshes, report.expect("the commands are well-formed").totals())
}

/// Positions and parameters along an edge, ascending.
fn along(mesh: &Mesh, edge: usize) -> Vec<(u32, Point)> {
    let on = |v: &&rtl_model::patch::Vertex| [v.v == 0, v.u == ONE, v.v == ONE, v.u == 0][edge];
    let mut row: Vec<_> = mesh
        .vertices
        .iter()
        .filter(on)
        .map(|v| (if edge & 1 == 0 { v.u } else { v.v }, v.position))
        .collect();
    row.sort_unstable();
    row
}

/// Parameters along u and along v.
fn lists(mesh: &Mesh) -> [BTreeSet<u32>; 2] {
    [mesh.vertices.iter().map(|v| v.u).collect(), mesh.vertices.iter().map(|v| v.v).collect()]
}

/// What was compared.
#[derive(Debug, Default)]
struct Compared {
    patches: usize,
    shared: usize,
    raised: usize,
    exact: usize,
}

/// Holds the meshes of one instance to what unified lists promise. `own` has the meshes of the same
/// draw where each edge has its own list; `hidden`: those may lack what inner curves ask for.
fn hold(primitive: Primitive, [meshes, own]: [&[Mesh]; 2], hidden: bool, compared: &mut Compared) {
    let across = primitive.size().1 as usize;
    let place = |mesh: &Mesh| [mesh.patch as usize % across, mesh.patch as usize / across];
    let at = |patch: usize| meshes.binary_search_by_key(&patch, |m| m.patch as usize).ok();
    let mut asked = [vec![None; across], vec![None; primitive.size().0 as usize]];
    for mesh in own {
        let has_interior = mesh.vertices.iter().any(|v| v.u % ONE != 0 && v.v % ONE != 0);
        for (axis, list) in lists(mesh).into_iter().enumerate() {
            let (union, whole): &mut (BTreeSet<u32>, bool) =
                asked[axis][place(mesh)[axis]].get_or_insert_with(|| (BTreeSet::new(), true));
            union.extend(list);
            // Without an interior the inner curves' entries are not to be seen.
            *whole &= has_interior || !hidden;
        }
    }
    for mesh in meshes {
        let [u, v] = lists(mesh);
        compared.patches += 1;
        assert_eq!(mesh.vertices.len(), u.len() * v.len(), "a whole grid");
        assert_eq!(mesh.triangles.len(), 2 * (u.len() - 1) * (v.len() - 1), "nothing to zip");
        for (axis, list) in [u, v].into_iter().enumerate() {
            let (union, whole) = asked[axis][place(mesh)[axis]].as_ref().expect("it was drawn");
            assert!(union.is_subset(&list), "patch {} lacks what some ask for", mesh.patch);
            assert!(!whole || *union == list, "patch {} has what none asks for", mesh.patch);
            compared.exact += usize::from(*whole);
        }
        let patch = mesh.patch as usize;
        let right = if (patch + 1).is_multiple_of(across) { None } else { at(patch + 1) };
        for (edge, other, facing) in [(1, right, 3), (2, at(patch + across), 0)] {
            let Some(other) = other else { continue };
            assert_eq!(along(mesh, edge), along(&meshes[other], facing), "patch {patch}");
            compared.shared += 1;
        }
    }
    for (a, b) in meshes.iter().zip(own) {
        compared.raised += usize::from(a.vertices.len() > b.vertices.len());
    }
}

fn primitive(random: &mut Random) -> Primitive {
    let count = 1 + u64::from(random.integer(0, 20));
    match random.integer(0, 3) {
        0 => Primitive::Strip { count },
        1 => Primitive::Fan { count, encoding: FanEncoding::Compact },
        2 => Primitive::Fan { count, encoding: FanEncoding::Full },
        _ => Primitive::Mesh { rows: 1 + random.integer(0, 5), columns: 1 + random.integer(0, 5) },
    }
}

fn compare(random: &mut Random, primitive: Primitive, config: &Config, compared: &mut Compared) {
    let list = surface(random, primitive);
    let tessellation = Tessellation { max_level: 16 << 16, ..tessellation(random) };
    let mut draw = draw(primitive, 0, 0);
    draw.cull = random.integer(0, 2) == 0;
    let mut unified = Config { unit: Unit::Sfarti, ..config.clone() };
    let (own, apart) = run(&draw, &list, tessellation, &unified);
    unified.level.union = Union::Primitive;
    let (meshes, counters) = run(&draw, &list, tessellation, &unified);
    let numbers = |meshes: &[Mesh]| meshes.iter().map(|m| m.patch).collect::<Vec<_>>();
    assert_eq!(numbers(&meshes), numbers(&own), "the same patches are culled");
    let hidden = matches!(
        (tessellation.criterion, config.level.termination),
        (Criterion::Flatness { .. }, Termination::EightCurves)
    );
    hold(primitive, [&meshes, &own], hidden, compared);
    for (counter, times) in [
        (C::AssemblePatches, 2),
        (C::AssembleReceived, 2),
        (C::AssembleReused, 2),
        (C::PortPoints, 2),
        (C::ClipCulled, 2),
        (C::BackfaceCulled, 2),
        (C::LevelPatches, 1),
        (C::LevelSplits, 1),
        (C::LevelClamped, 1),
        (C::TracePatches, 1),
    ] {
        assert_eq!(counters.get(counter), times * apart.get(counter), "{counter:?}");
    }
    let (rows, columns) = primitive.size();
    assert_eq!(counters.get(C::PlaceMeasured), meshes.len() as u64);
    assert_eq!(counters.get(C::AssembleMeasured), primitive.patches());
    assert_eq!(counters.get(C::PlaceListsPeak), rows + columns);
    assert_eq!(apart.get(C::PlaceListsPeak) + apart.get(C::PlaceMeasured), 0);
}

#[test]
fn patches_of_a_column_and_of_a_row_have_one_list() {
    let mut random = Random::new(11);
    let mut compared = Compared::default();
    for _ in 0..scale(300, 20_000) {
        let (config, primitive) = (config(&mut random), primitive(&mut random));
        compare(&mut random, primitive, &config, &mut compared);
    }
    println!("compared {compared:?}");
    let Compared { patches, shared, raised, exact } = compared;
    assert!(patches > 1000 && shared > 1000 && 3 * raised > patches && exact > 500);
}

/// Larger than a batch: what the last patch asks for reaches the first.
#[test]
fn primitives_of_many_patches_have_one_list() {
    let mut random = Random::new(12);
    let mut compared = Compared::default();
    for primitive in [
        Primitive::Strip { count: 5000 },
        Primitive::Fan { count: 4500, encoding: FanEncoding::Full },
        Primitive::Mesh { rows: 3, columns: 1500 },
        Primitive::Mesh { rows: 100, columns: 50 },
    ] {
        compare(&mut random, primitive, &Config::default(), &mut compared);
    }
    println!("compared {compared:?}");
    assert!(compared.shared > 10_000 && compared.raised > 1000);
}

/// Instances, of which the batch holds the points of the one before, in any number of threads.
#[test]
fn instances_have_their_own_lists_whatever_the_threads() {
    let mut random = Random::new(13);
    let primitive = Primitive::Mesh { rows: 5, columns: 7 };
    let list = surface(&mut random, primitive);
    let mut config = Config { unit: Unit::Sfarti, ..Config::default() };
    config.clip.enabled = false;
    config.level.union = Union::Primitive;
    let model = |k: u32| {
        let mut model = tessim::trace::command::IDENTITY;
        (model[0], model[12]) = (1.0 + k as f32 / 8.0, k as f32 / 100.0);
        model
    };
    let one = |models: Vec<[f32; 16]>| Draw { models, models_sent: true, ..draw(primitive, 0, 0) };
    let t = Tessellation { max_level: 16 << 16, ..Tessellation::default() };
    let all = one((0..80).map(model).collect());
    let (meshes, counters) = run(&all, &list, t, &config);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let again = pool.expect("a pool of threads").install(|| run(&all, &list, t, &config));
        assert!(again == (meshes.clone(), counters.clone()), "{threads} threads");
    }
    let mut distinct = BTreeSet::new();
    let mut received = 0;
    for (k, instance) in meshes.chunks(35).enumerate() {
        let (alone, counters) = run(&one(vec![model(k as u32)]), &list, t, &config);
        let same =
            |(a, b): (&Mesh, &Mesh)| (&a.vertices, &a.triangles) == (&b.vertices, &b.triangles);
        assert!(instance.len() == 35 && instance.iter().zip(&alone).all(same), "instance {k}");
        distinct.insert(instance[0].vertices.len());
        received += counters.get(C::PortPoints);
    }
    assert_eq!(counters.get(C::PortPoints), received);
    assert_eq!(counters.get(C::PlaceListsPeak), 5 + 7, "no more for more instances");
    assert!(distinct.len() > 1, "instances differ in their lists");
}
