//! Every mesh covers its triangle once and uses what is inserted: all insertions of the lower
//! levels, random ones of the higher.
//!
//! `TESSIM_LONG=1` goes through all of one level more, and draws twenty times as many at random.

use crate::random::Random;
use crate::support::lists;
use rtl_model::esc::{Insertion, LEVEL_MAX, Site, Triangle};
use std::ops::AddAssign;

/// What has been looked at.
#[derive(Default)]
struct Seen {
    meshes: u32,
    triangles: u32,
    /// Segments of edges that span more than one of the uniform pattern's.
    long: u32,
    /// Longest list of a strip less the uniform one's, of all strips: at most 0.
    longer: i32,
}

impl AddAssign for Seen {
    fn add_assign(&mut self, more: Self) {
        self.meshes += more.meshes;
        self.triangles += more.triangles;
        self.long += more.long;
        self.longer = self.longer.max(more.longer);
    }
}

/// Lattice coordinates, sheared, v up: areas and betweenness are those of the triangle.
fn lattice(site: Site) -> [i32; 2] {
    [i32::from(site.place), -i32::from(site.row)]
}

fn twice_area([a, b, c]: [[i32; 2]; 3]) -> i32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// What is inserted, from the words of the paper and not from the block: the edges' own bits, and
/// inner sites of rows with an end.
fn inserted(level: u8, masks: [u16; 3]) -> Vec<Site> {
    let [left, right, bottom] = masks;
    let last = level + 1;
    let bit =
        |mask: u16, position: u8| position == 0 || position == last || mask >> position & 1 == 1;
    let mut sites = Vec::new();
    for row in 0..=last {
        for place in 0..=row {
            let there = match (row == last, place == 0, place == row) {
                (true, ..) => bit(bottom, place),
                (_, true, true) => true,
                (_, true, _) => bit(left, row),
                (_, _, true) => bit(right, row),
                _ => bit(left, row) || bit(right, row),
            };
            if there {
                sites.push(Site { row, place });
            }
        }
    }
    sites
}

/// The boundary as it must be: from the apex down the left, along the bottom, up the right.
fn boundary(level: u8, vertices: &[Site]) -> Vec<Site> {
    let last = level + 1;
    let on = |at: fn(Site, u8) -> bool| vertices.iter().copied().filter(move |&s| at(s, last));
    let mut chain: Vec<Site> = on(|s, last| s.place == 0 && s.row < last).collect();
    chain.extend(on(|s, last| s.row == last));
    let mut right: Vec<Site> =
        on(|s, last| s.place == s.row && s.row < last && s.row > 0).collect();
    right.reverse();
    chain.extend(right);
    chain
}

/// Everything that a mesh promises.
///
/// Positive areas, every inner edge once in either direction and a boundary that is the triangle's
/// mean that each point is covered as often as any other; the areas' sum, that it is once.
fn promises(level: u8, masks: [u16; 3]) -> Seen {
    let [left, right, bottom] = masks;
    let insertion = Insertion::new(level, left, right, bottom);
    let vertices = inserted(level, masks);
    assert_eq!(insertion.vertices().collect::<Vec<_>>(), vertices, "{insertion:?}");
    let number = |site: Site| usize::from(site.number()) - 1;
    let sites = (usize::from(level) + 2) * (usize::from(level) + 3) / 2;
    let mut there = vec![false; sites];
    vertices.iter().for_each(|&site| there[number(site)] = true);

    let triangles: Vec<Triangle> = insertion.triangles().collect();
    let count = insertion.triangle_count();
    assert_eq!(triangles.len(), count as usize, "2 (V - B) + B - 2 of {insertion:?}");
    let chain = boundary(level, &vertices);
    assert_eq!(chain.len(), insertion.boundary() as usize, "{insertion:?}");
    assert_eq!(vertices.len() - chain.len(), insertion.interior() as usize, "{insertion:?}");
    assert_eq!(slots(insertion), [insertion.slot_count(), count]);

    let mut used = vec![false; sites];
    let mut directed = vec![0_u8; sites * sites];
    let mut area = 0;
    for triangle in &triangles {
        let twice = twice_area(triangle.map(lattice));
        assert!(twice > 0, "{triangle:?} of {insertion:?}: twice its area is {twice}");
        area += twice;
        for k in 0..3 {
            let [from, to] = [triangle[k], triangle[(k + 1) % 3]];
            used[number(from)] = true;
            directed[number(from) * sites + number(to)] += 1;
            assert!(!crosses_a_vertex(from, to, &there), "{from:?} {to:?} of {insertion:?}");
        }
    }
    assert_eq!(area, i32::from(level + 1).pow(2), "areas of {insertion:?}");
    assert_eq!(used, there, "vertices used and inserted of {insertion:?}");
    let mut expected = directed.clone();
    for (from, to) in (0..sites).flat_map(|from| (0..from).map(move |to| (from, to))) {
        let [there, back] = [from * sites + to, to * sites + from];
        let both = directed[there].max(directed[back]).min(1);
        (expected[there], expected[back]) = (both, both);
    }
    let mut long = 0;
    for k in 0..chain.len() {
        let [from, to] = [chain[k], chain[(k + 1) % chain.len()]];
        expected[number(from) * sites + number(to)] = 1;
        expected[number(to) * sites + number(from)] = 0;
        long += u32::from(common_steps(from, to) > 1);
    }
    assert!(directed == expected, "an edge without its other side, or twice: {insertion:?}");
    assert_eq!(listed(insertion), unwound(&triangles), "lists of {insertion:?}");
    let longer = insertion.strips().zip(lists(insertion));
    let longer = longer.map(|(strip, list)| list.len() as i32 - 2 * i32::from(strip.lower()) - 1);
    Seen { meshes: 1, triangles: count, long, longer: longer.max().unwrap() }
}

/// Three in a row of the paper's lists, where they are three: in order, but wound either way.
fn listed(insertion: Insertion) -> Vec<[u16; 3]> {
    let mut triangles = Vec::new();
    for list in lists(insertion) {
        let threes = list.windows(3).map(|three| [three[0], three[1], three[2]]);
        triangles.extend(threes.filter(|[a, b, c]| a != b && b != c && c != a));
    }
    triangles.iter_mut().for_each(|triangle| triangle.sort_unstable());
    triangles
}

/// Triangles by number, without their winding.
fn unwound(triangles: &[Triangle]) -> Vec<[u16; 3]> {
    let mut triangles: Vec<_> = triangles.iter().map(|t| t.map(Site::number)).collect();
    triangles.iter_mut().for_each(|triangle| triangle.sort_unstable());
    triangles
}

/// Slots of all strips, and those with a triangle.
fn slots(insertion: Insertion) -> [u32; 2] {
    let mut counts = [0; 2];
    for strip in insertion.strips() {
        assert_eq!(strip.slots().count(), strip.slot_count() as usize);
        counts[0] += strip.slot_count();
        counts[1] += strip.slots().flatten().count() as u32;
    }
    counts
}

/// Lattice steps between two sites: one more than the sites strictly between them.
fn common_steps(a: Site, b: Site) -> i32 {
    let ([ax, ay], [bx, by]) = (lattice(a), lattice(b));
    let (mut x, mut y) = ((bx - ax).abs(), (by - ay).abs());
    while y != 0 {
        (x, y) = (y, x % y);
    }
    x
}

/// A T-junction: a vertex that is inserted strictly between the ends of a triangle's edge.
fn crosses_a_vertex(a: Site, b: Site, there: &[bool]) -> bool {
    let steps = common_steps(a, b);
    (1..steps).any(|k| {
        let between =
            |a: u8, b: u8| (i32::from(a) + (i32::from(b) - i32::from(a)) * k / steps) as u8;
        let site = Site { row: between(a.row, b.row), place: between(a.place, b.place) };
        there[usize::from(site.number()) - 1]
    })
}

fn is_long() -> bool {
    std::env::var_os("TESSIM_LONG").is_some()
}

#[test]
fn every_insertion_of_the_lower_levels_makes_a_disc() {
    let most = if is_long() { 6 } else { 5 };
    let mut seen = Seen::default();
    for level in 0..=most {
        let masks = 1_u32 << (3 * level);
        for bits in 0..masks {
            let edge = |k: u32| (bits >> (k * u32::from(level)) & ((1 << level) - 1)) << 1;
            seen += promises(level, [0, 1, 2].map(|k| edge(k) as u16));
        }
    }
    println!(
        "compared {} meshes, {} triangles, {} long segments",
        seen.meshes, seen.triangles, seen.long
    );
    assert_eq!(seen.meshes, if is_long() { 299_593 } else { 37_449 });
    assert_eq!(seen.longer, 0, "the longest lists are the uniform pattern's");
    assert!(seen.triangles > 500_000 && seen.long > 100_000);
}

/// An edge's bits: few, half, most, a run, or all.
fn mask(random: &mut Random, level: u8) -> u16 {
    let all = (1_u32 << (level + 1)) - 2;
    let mut bits = || random.bits() as u32;
    let (a, b, kind) = (bits(), bits(), bits() % 8);
    let mask = match kind {
        0 => 0,
        1 => all,
        2 | 3 => a & b & bits(),
        4 | 5 => a,
        6 => a | b | bits(),
        _ => u32::MAX << (a % 16) & u32::MAX >> (b % 32),
    };
    (mask & all) as u16
}

#[test]
fn random_insertions_of_the_higher_levels_make_discs() {
    let mut random = Random::new(0xe5c);
    let each = if is_long() { 20_000 } else { 1_000 };
    let mut seen = Seen::default();
    for level in 5..=LEVEL_MAX {
        for _ in 0..each {
            let masks = [0; 3].map(|_: u16| mask(&mut random, level));
            seen += promises(level, masks);
        }
    }
    println!(
        "compared {} meshes, {} triangles, {} long segments",
        seen.meshes, seen.triangles, seen.long
    );
    assert_eq!(seen.meshes, 11 * each);
    assert!(seen.triangles / seen.meshes > 30 && seen.long / seen.meshes > 2);
    assert_eq!(seen.longer, 0);
}

/// An edge's chain is a function of its own mask: neighbours that share the edge agree about it.
/// The mirrored mask has the mirrored chain.
#[test]
fn an_edge_looks_alike_from_either_side() {
    let mut random = Random::new(0x51de);
    let mut compared = 0;
    for _ in 0..2_000 {
        let level = random.integer(1, 15) as u8;
        let last = level + 1;
        let shared = mask(&mut random, level);
        let mirrored = (u32::from(shared).reverse_bits() >> (30 - level)) as u16;
        let mut others = || mask(&mut random, level);
        let left = Insertion::new(level, shared, others(), others());
        let right = Insertion::new(level, others(), mirrored, others());
        let bottom = Insertion::new(level, others(), others(), shared);
        let on = |insertion: Insertion, at: &dyn Fn([Site; 2]) -> Option<[u8; 2]>| {
            let edges =
                insertion.triangles().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
            let mut segments: Vec<[u8; 2]> = edges.filter_map(at).collect();
            segments.sort_unstable();
            segments
        };
        let want = on(left, &|[a, b]| (a.place == 0 && b.place == 0).then_some([a.row, b.row]));
        let got = on(right, &|[a, b]| {
            (a.place == a.row && b.place == b.row).then_some([last - a.row, last - b.row])
        });
        assert_eq!(got, want, "right of level {level}, {shared:b}");
        let got =
            on(bottom, &|[a, b]| (a.row == last && b.row == last).then_some([a.place, b.place]));
        assert_eq!(got, want, "bottom of level {level}, {shared:b}");
        compared += want.len();
    }
    println!("compared {compared} segments");
    assert!(compared > 6_000);
}
