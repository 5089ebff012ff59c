//! Neighbours in unit `esc`: levels that belong to edges, whatever they depend on, and tests that
//! either side decides alike; where boundaries are plain, what cracks is counted, and nothing else
//! differs. Within a patch every edge of a triangle has one other beside it, or is the patch's.

use super::random::Random;
use super::run::{Mesh, scale};
use super::{PAIRS, counted, pair, row, tessellation};
use rtl_model::counter::Counter as C;
use rtl_model::patch::ONE;
use std::collections::HashMap;
use tessim::config::{Boundary, Config, ControlMesh, LevelPolicy, Reuse, Space, Unit};

/// What varies of the unit's own keys, the position's width being what it is. Levels of objects
/// would meet only where they are equal.
pub(super) fn vary(random: &mut Random, config: &mut Config) {
    use LevelPolicy::{Criterion, Distance, Fixed, ScreenSize};
    let esc = &mut config.esc;
    esc.level =
        random.of([Criterion, Criterion, Distance, Distance, ScreenSize, ScreenSize, Fixed]);
    esc.level_max = random.of([1, 3, 3, 8, 15]);
    esc.fixed_level = random.integer(0, esc.level_max);
    esc.full_distance = random.of([0.7, 2.0, 4.0]);
    esc.full_pixels = random.of([60.0, 500.0, 3000.0]);
    esc.control_mesh = random.of(ControlMesh::ALL);
    esc.space = random.of([Space::Pixels, Space::Object]);
    esc.mu = match esc.space {
        Space::Pixels => random.of([0.0, 0.2, 2.0, 30.0]),
        Space::Object => random.of([0.0, 0.001, 0.01, 0.1]),
    };
    esc.reuse = random.of(Reuse::ALL);
    esc.guard = random.integer(0, 20.min(55 - config.position.width));
    esc.parameter_bits = random.integer(16, 46);
    esc.output_values = random.of([None, None, Some(1024)]);
}

/// Holds a mesh to be one disc: each edge of a triangle has its reverse beside it, or lies on the
/// patch's boundary. Returns how many edges have.
fn hold(mesh: &Mesh) -> usize {
    let mut edges: HashMap<[u16; 2], u32> = HashMap::new();
    for [a, b, c] in mesh.triangles.iter().copied() {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    let on_one_side = |[a, b]: [u16; 2]| {
        let [a, b] = [a, b].map(|k| mesh.vertices[usize::from(k)]);
        [0, ONE].iter().any(|side| [a.u, b.u] == [*side; 2] || [a.v, b.v] == [*side; 2])
    };
    let mut inner = 0;
    for (&[a, b], &count) in &edges {
        assert_eq!(count, 1, "{a} to {b} in patch {}", mesh.patch);
        let paired = edges.contains_key(&[b, a]);
        assert_ne!(paired, on_one_side([a, b]), "{a} to {b} in patch {}", mesh.patch);
        inner += usize::from(paired);
    }
    assert_eq!(mesh.triangles.len() + 2, 2 * mesh.vertices.len() - (edges.len() - inner));
    inner
}

#[test]
fn a_plain_boundary_cracks_where_it_says_so_and_levels_meet_all_the_same() {
    let mut random = Random::new(0xe5c_0003);
    let (mut compared, mut differ, mut said, mut inner) = (0, 0, 0, 0);
    for _ in 0..scale(30, 3000) {
        let mut config = super::config(&mut random);
        config.unit = Unit::Esc;
        config.esc.boundary = Boundary::Plain;
        // A patch counts the same for all whom it meets where its decisions are the neighbour's.
        (config.esc.mu, config.esc.guard) = (0.0, random.of([0, 0, 2, 7]));
        let tessellation = tessellation(&mut random);
        let (pairs, shared): (Vec<_>, Vec<_>) = (0..PAIRS).map(|_| pair(&mut random)).unzip();
        let (meshes, counters) = counted(&pairs, tessellation, &config);
        let mut cracks = 0;
        for (k, shared) in shared.iter().enumerate() {
            let (a, b) = (&meshes[k], &meshes[PAIRS + k]);
            let ra = row(config.unit, a, shared.a);
            let mut rb = row(config.unit, b, shared.b);
            if shared.reversed {
                rb.reverse();
            }
            assert_eq!(ra.len(), rb.len(), "{shared:?} under {config:?}");
            for (one, other) in ra.iter().zip(&rb) {
                let there = if shared.reversed { ONE - other.1 } else { other.1 };
                assert_eq!(one.1, there, "{shared:?} under {config:?}");
                cracks += u64::from(one.0 != other.0);
                compared += 1;
            }
            inner += hold(a) + hold(b);
        }
        let counted = counters.get(C::SurfaceCracks);
        assert!(cracks <= counted, "{cracks} of {counted} under {config:?}");
        (differ, said) = (differ + cracks, said + counted);
    }
    println!("compared {compared} vertices: {differ} differ, {said} said to; {inner} inner edges");
    assert!(compared > 10_000 && 10 * differ > compared && inner > 100_000);
}

#[test]
fn meshes_of_any_decisions_are_discs() {
    let mut random = Random::new(0xe5c_0004);
    let (mut inner, mut thinned, mut uniform) = (0, 0, 0);
    for _ in 0..scale(40, 4000) {
        let mut config = super::config(&mut random);
        config.unit = Unit::Esc;
        let tessellation = tessellation(&mut random);
        let pairs: Vec<_> = (0..PAIRS).map(|_| pair(&mut random).0).collect();
        let (meshes, counters) = counted(&pairs, tessellation, &config);
        inner += meshes.iter().map(hold).sum::<usize>();
        let slots = counters.get(C::SurfaceSlots);
        if counters.get(C::SurfaceTriangles) < slots { thinned += 1 } else { uniform += 1 }
    }
    println!("compared {inner} inner edges; {thinned} runs with empty slots, {uniform} without");
    assert!(inner > 100_000 && thinned > 10 && uniform > 0);
}
