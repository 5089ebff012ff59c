//! Neighbours: an edge's vertices are a function of the edge, bit for bit, whatever else the two
//! patches have and however they are turned.

use crate::random::Random;
use crate::shader::{Result, UNIT, any_settings, exact, run, subject, view};
use rtl_model::esc::{Boundary, ControlMesh, LEVEL_MAX, Levels, Surface, Threshold};
use rtl_model::patch::{EDGES, Patch, Point};
use std::collections::{BTreeMap, BTreeSet};

type Subject = (Patch, [Point; 16]);

/// An edge of a patch, in the direction of its growing parameter or against it.
#[derive(Clone, Copy, Debug)]
struct Side {
    edge: usize,
    reversed: bool,
}

impl Side {
    fn any(random: &mut Random) -> Self {
        Self { edge: random.integer(0, 3) as usize, reversed: random.bits() & 1 == 0 }
    }

    fn indices(self) -> [usize; 4] {
        let [a, b, c, d] = EDGES[self.edge];
        if self.reversed { [d, c, b, a] } else { [a, b, c, d] }
    }

    /// The vertices of the side by their place on it, over UNIT.
    fn vertices(self, result: &Result) -> BTreeMap<i64, Point> {
        let sites = result.vertices.iter().map(|vertex| (exact(vertex), vertex.position));
        let on = sites.filter(|([u, v], _)| [*v == 0, *u == UNIT, *v == UNIT, *u == 0][self.edge]);
        let along = on.map(|(site, position)| {
            let t = site[self.edge % 2];
            (if self.reversed { UNIT - t } else { t }, position)
        });
        along.collect()
    }
}

/// Levels of which those of `side` are `level`.
fn levels(random: &mut Random, side: Side, level: u8) -> Levels {
    let interior = random.integer(level.into(), LEVEL_MAX.into()) as u8;
    let mut edges = [0; 4].map(|_: u8| random.integer(0, interior.into()) as u8);
    edges[side.edge] = level;
    Levels { edges, interior }
}

/// A patch whose `side` is that of another one.
fn neighbour(other: &Subject, mine: Side, subject: &mut Subject, side: Side) {
    for (from, to) in mine.indices().into_iter().zip(side.indices()) {
        subject.0.points[to] = other.0.points[from];
        subject.1[to] = other.1[from];
    }
}

#[test]
fn neighbours_make_the_same_vertices_on_their_edge() {
    let mut random = Random::new(0x5ea3);
    let (mut pairs, mut vertices, mut partly, mut levelled) = (0, 0, 0, 0);
    let mut kinds = BTreeMap::new();
    while pairs < 6_000 {
        let settings = any_settings(&mut random);
        let view = view(&mut random, settings.position);
        let mut shader = Surface::new(settings);
        for _ in 0..3 {
            let (mine, yours) = (Side::any(&mut random), Side::any(&mut random));
            let first = subject(&mut random, &settings);
            let mut second = subject(&mut random, &settings);
            neighbour(&first, mine, &mut second, yours);
            let level = random.integer(0, LEVEL_MAX.into()) as u8;
            let all = [mine, yours].map(|side| levels(&mut random, side, level));
            let a = run(&mut shader, &first, &view, all[0]);
            let b = run(&mut shader, &second, &view, all[1]);
            let (a, b) = (mine.vertices(&a), yours.vertices(&b));
            assert_eq!(a, b, "{mine:?} {yours:?} of {all:?} under {settings:?}");
            let inserted = a.len() - 4;
            pairs += 1;
            vertices += inserted;
            partly += usize::from(inserted > 0 && inserted < 3 * usize::from(level));
            levelled += usize::from(all[0].interior != all[1].interior);
            let space = match settings.threshold {
                Threshold::Uniform => 0,
                Threshold::Pixels(_) => 1,
                Threshold::Object(_) => 2,
            };
            *kinds.entry((space, settings.mesh as u8)).or_insert(0) += 1;
        }
    }
    println!("compared {vertices} vertices of {pairs} pairs, {partly} with some candidates only");
    println!("spaces and meshes: {kinds:?}; {levelled} of different levels");
    assert!(vertices > 40_000 && partly > 800 && levelled > 3_000);
    assert!(kinds.len() == 6 && kinds.values().all(|&pairs| pairs > 500));
}

/// One of the eight symmetries of the square: the turned patch and net, and for each of its edges
/// the side of the patch that it is.
fn turned(subject: &Subject, turn: usize) -> (Subject, [Side; 4]) {
    let [swapped, reversed_u, reversed_v] = [4, 1, 2].map(|bit| turn & bit != 0);
    let from = |k: usize| {
        let flip = |line: usize, reversed| if reversed { 3 - line } else { line };
        let (column, row) = (flip(k % 4, reversed_u), flip(k / 4, reversed_v));
        if swapped { 4 * column + row } else { 4 * row + column }
    };
    let points = std::array::from_fn(|k| subject.0.points[from(k)]);
    let object = std::array::from_fn(|k| subject.1[from(k)]);
    let sides = EDGES.map(|edge| {
        let sources = edge.map(from);
        let sides = (0..4).flat_map(|edge| [false, true].map(|reversed| Side { edge, reversed }));
        sides.into_iter().find(|side| side.indices() == sources).unwrap()
    });
    ((Patch { points, ..subject.0 }, object), sides)
}

/// The turned patch has the turned boundary.
#[test]
fn a_turned_patch_has_the_same_boundary() {
    let mut random = Random::new(0x7042);
    let mut compared = 0;
    for _ in 0..600 {
        let settings = any_settings(&mut random);
        let view = view(&mut random, settings.position);
        let mut shader = Surface::new(settings);
        let subject = subject(&mut random, &settings);
        let interior = random.integer(0, LEVEL_MAX.into()) as u8;
        let edges = [0; 4].map(|_: u8| random.integer(0, interior.into()) as u8);
        let own = run(&mut shader, &subject, &view, Levels { edges, interior });
        for turn in 0..8 {
            let (subject, sides) = turned(&subject, turn);
            let levels = Levels { edges: sides.map(|side| edges[side.edge]), interior };
            let result = run(&mut shader, &subject, &view, levels);
            for (edge, side) in sides.into_iter().enumerate() {
                let got = Side { edge, reversed: false }.vertices(&result);
                assert_eq!(got, side.vertices(&own), "turn {turn}, edge {edge}, {settings:?}");
                compared += got.len();
            }
        }
    }
    println!("compared {compared} vertices");
    assert!(compared > 100_000);
}

/// By definition: vertices at which the patch, turned in some way, makes another point.
#[test]
fn cracks_are_what_some_turned_patch_makes_otherwise() {
    let mut random = Random::new(0x8c4a);
    let (mut patches, mut vertices, mut cracks) = (0, 0, 0);
    for _ in 0..400 {
        let mut settings = any_settings(&mut random);
        (settings.boundary, settings.threshold) = (Boundary::Plain, Threshold::Uniform);
        // Few roundings differ where there are guard bits.
        settings.guard = settings.guard.min(random.integer(0, 6));
        let view = view(&mut random, settings.position);
        let mut shader = Surface::new(settings);
        let subject = subject(&mut random, &settings);
        let interior = random.integer(0, 7) as u8;
        let edges = [0; 4].map(|_: u8| random.integer(0, interior.into()) as u8);
        let own = run(&mut shader, &subject, &view, Levels { edges, interior });
        let mut differing = BTreeSet::new();
        for turn in 0..8 {
            let (subject, sides) = turned(&subject, turn);
            let levels = Levels { edges: sides.map(|side| edges[side.edge]), interior };
            let result = run(&mut shader, &subject, &view, levels);
            for (edge, side) in sides.into_iter().enumerate() {
                let mine = side.vertices(&own);
                vertices += mine.len();
                for (t, point) in (Side { edge, reversed: false }).vertices(&result) {
                    if mine[&t] != point {
                        let t = if side.reversed { UNIT - t } else { t };
                        differing.insert((side.edge, t));
                    }
                }
            }
        }
        assert_eq!(own.made.cracks, differing.len() as u64, "{edges:?} under {settings:?}");
        patches += 1;
        cracks += own.made.cracks;
    }
    println!("compared {vertices} vertices of {patches} patches, {cracks} cracks");
    assert!(cracks > 5_000 && 16 * cracks < vertices as u64);
}

/// Under the plain policy boundaries do differ, and where they do one of the two patches says so.
#[test]
fn what_differs_under_the_plain_policy_is_counted_as_a_crack() {
    let mut random = Random::new(0xc4ac);
    let (mut pairs, mut differing, mut counted, mut vertices) = (0, 0, 0, 0);
    for _ in 0..1_500 {
        let mut settings = any_settings(&mut random);
        settings.boundary = Boundary::Plain;
        settings.threshold = Threshold::Uniform;
        settings.mesh = ControlMesh::Net;
        let view = view(&mut random, settings.position);
        let mut shader = Surface::new(settings);
        let (mine, yours) = (Side::any(&mut random), Side::any(&mut random));
        let first = subject(&mut random, &settings);
        let mut second = subject(&mut random, &settings);
        neighbour(&first, mine, &mut second, yours);
        let level = random.integer(0, 7) as u8;
        let a = run(&mut shader, &first, &view, levels(&mut random, mine, level));
        let b = run(&mut shader, &second, &view, levels(&mut random, yours, level));
        let cracks = a.made.cracks + b.made.cracks;
        let (a, b) = (mine.vertices(&a), yours.vertices(&b));
        assert!(a.keys().eq(b.keys()));
        let differ = a.iter().filter(|(t, p)| b[t] != **p).count() as u64;
        assert!(differ <= cracks, "{differ} differ, {cracks} counted: {settings:?}");
        pairs += 1;
        differing += differ;
        counted += cracks;
        vertices += a.len() - 2;
    }
    println!("compared {vertices} vertices of {pairs} pairs: {differing} differ, {counted} cracks");
    assert!(differing > 1_000 && counted > 3 * differing);
}
