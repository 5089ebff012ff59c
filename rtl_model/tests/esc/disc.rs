//! The mesh of a patch is a disc: it covers the unit square once, whatever is inserted, whatever
//! the levels of its edges are.
//!
//! `TESSIM_LONG=1` draws twenty times as many at random.

use crate::random::Random;
use crate::shader::{Result, UNIT, any_levels, any_settings, exact, run, subject, view};
use rtl_model::esc::{Insertion, LEVEL_MAX, Surface, slot};
use std::collections::{BTreeMap, BTreeSet};

fn twice_area([a, b, c]: [[i64; 2]; 3]) -> i128 {
    let [x, y] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]].map(i128::from));
    x[0] * y[1] - x[1] * y[0]
}

/// Positive areas that sum to the square's, edges inside that are used once either way, and a
/// boundary that goes from vertex to vertex along the sides: each point is covered once, and no
/// vertex lies inside an edge.
fn assert_disc(result: &Result, what: &dyn std::fmt::Debug) {
    let sites: Vec<[i64; 2]> = result.vertices.iter().map(exact).collect();
    let distinct: BTreeSet<_> = sites.iter().collect();
    assert_eq!(distinct.len(), sites.len(), "a point twice: {what:?}");
    let (mut area, mut used) = (0, vec![false; sites.len()]);
    let mut directed = BTreeSet::new();
    let mut next = 0;
    for triangle in &result.triangles {
        let [a, b, c] = triangle.map(usize::from);
        let twice = twice_area([sites[a], sites[b], sites[c]]);
        assert!(twice > 0, "{triangle:?}: twice its area is {twice}: {what:?}");
        area += twice;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert!(directed.insert((from, to)), "{from} {to} twice: {what:?}");
            used[from] = true;
        }
        for vertex in [a, b, c] {
            assert!(vertex <= next, "numbers in the order of first use: {what:?}");
            next = next.max(vertex + 1);
        }
    }
    assert_eq!(area, 2 * i128::from(UNIT).pow(2), "the square's area: {what:?}");
    assert!(used.iter().all(|&used| used), "a vertex without a triangle: {what:?}");
    let mut sides: [BTreeMap<i64, i64>; 4] = Default::default();
    for &(from, to) in directed.iter().filter(|&&(from, to)| !directed.contains(&(to, from))) {
        let ([u, v], [to_u, to_v]) = (sites[from], sites[to]);
        // Counter-clockwise, each by its growing coordinate.
        let (side, ends) = match () {
            () if v == 0 && to_v == 0 => (0, (u, to_u)),
            () if u == UNIT && to_u == UNIT => (1, (v, to_v)),
            () if v == UNIT && to_v == UNIT => (2, (to_u, u)),
            () if u == 0 && to_u == 0 => (3, (to_v, v)),
            () => panic!("{from} {to} has one side: {what:?}"),
        };
        assert_eq!(sides[side].insert(ends.0, ends.1), None);
    }
    for (side, chain) in sides.iter().enumerate() {
        let on = |s: &&[i64; 2]| [s[1] == 0, s[0] == UNIT, s[1] == UNIT, s[0] == 0][side];
        let along: BTreeSet<i64> = sites.iter().filter(on).map(|s| s[side % 2]).collect();
        let pairs = along.iter().zip(along.iter().skip(1));
        let want: BTreeMap<i64, i64> = pairs.map(|(a, b)| (*a, *b)).collect();
        assert_eq!(chain, &want, "side {side}: {what:?}");
        assert_eq!((along.first(), along.last()), (Some(&0), Some(&UNIT)));
    }
}

#[test]
fn every_patch_is_a_disc() {
    let mut random = Random::new(0xd15c);
    let long = std::env::var_os("TESSIM_LONG").is_some();
    let (mut meshes, mut triangles, mut moved, mut thinned) = (0, 0, 0, 0);
    while meshes < if long { 40_000 } else { 2_000 } {
        let settings = any_settings(&mut random);
        let view = view(&mut random, settings.position);
        let mut shader = Surface::new(settings);
        for _ in 0..4 {
            let (subject, levels) = (subject(&mut random, &settings), any_levels(&mut random));
            let result = run(&mut shader, &subject, &view, levels);
            assert_disc(&result, &(settings, levels));
            let full = 18 * (u64::from(levels.interior) + 1).pow(2);
            triangles += result.triangles.len() as u64;
            moved += result.made.moved;
            thinned += u64::from((result.triangles.len() as u64) < full);
            meshes += 1;
        }
    }
    println!("compared {meshes} meshes, {triangles} triangles, {moved} moved, {thinned} thinned");
    assert!(triangles > 300 * meshes && moved > 4 * meshes && thinned > meshes / 3);
}

/// The site of a coarse triangle in its own coordinates, over the product of the three edges'
/// segments: the left edge along x, the right one along y.
fn site(row: u8, place: u8, level: u8, sides: [u8; 2]) -> [i64; 2] {
    let [own, left, right] = [level, sides[0], sides[1]].map(|level| i64::from(level) + 1);
    let unit = own * left * right;
    // The candidate that this slot carries, if the row is no corner.
    let carried = |side: u8| (1..=side).find(|&k| slot(k, side, level) == row).map(i64::from);
    let grid = |k: u8| i64::from(k) * left * right;
    if row == 0 || row > level {
        return [grid(row - place), grid(place)];
    }
    match place {
        0 => [carried(sides[0]).expect("a candidate") * (unit / left), 0],
        _ if place == row => [0, carried(sides[1]).expect("a candidate") * (unit / right)],
        _ => [grid(row - place), grid(place)],
    }
}

/// The mesh of a coarse triangle whose left and right edges have levels of their own, `masks` of
/// their candidates and of the bottom's: bit k - 1 for candidate k. Returns how many triangles.
fn assert_turned(level: u8, sides: [u8; 2], masks: [u32; 3]) -> u32 {
    let mask = |bits: u32, side: u8| -> u16 {
        (1..=side).map(|k| ((bits >> (k - 1) & 1) as u16) << slot(k, side, level)).sum()
    };
    let [left, right] = sides;
    let [a, b, c] = masks;
    let insertion = Insertion::new(level, mask(a, left), mask(b, right), mask(c, level));
    let (mut area, mut triangles) = (0, 0);
    for triangle in insertion.triangles() {
        let sites = triangle.map(|s| site(s.row, s.place, level, sides));
        let twice = twice_area(sites);
        assert!(twice > 0, "{triangle:?} of {insertion:?}, {sides:?}");
        area += twice;
        triangles += 1;
    }
    let unit = [level, left, right].map(|level| i128::from(level) + 1);
    assert_eq!(area, unit.iter().product::<i128>().pow(2), "{insertion:?}, {sides:?}");
    triangles
}

/// As at the patch's corners: every combination of levels and insertions.
#[test]
fn every_insertion_on_edges_of_lower_levels_keeps_all_triangles_turned_right() {
    let (mut meshes, mut triangles, mut moved) = (0, 0, 0);
    for level in 0..=5_u8 {
        let sides = (0..=level).flat_map(|left| (0..=level).map(move |right| [left, right]));
        for [left, right] in sides {
            for bits in 0..1_u32 << (left + right + level) {
                let low = |bits: u32, count: u8| bits & ((1 << count) - 1);
                let masks = [low(bits, left), low(bits >> left, right), bits >> (left + right)];
                triangles += assert_turned(level, [left, right], masks);
                meshes += 1;
                moved += u32::from(left < level && masks[0] != 0);
            }
        }
    }
    println!("compared {meshes} meshes, {triangles} triangles, {moved} with moved vertices");
    // (2^(L+1) - 1)^2 2^L of each level
    assert_eq!(meshes, 1 + 18 + 196 + 1_800 + 15_376 + 127_008);
    assert!(triangles > 10 * meshes && moved > meshes / 4);
}

#[test]
fn so_do_random_ones_of_the_higher_levels() {
    let mut random = Random::new(0x1e4e1);
    let (mut meshes, mut triangles) = (0, 0);
    let each = if std::env::var_os("TESSIM_LONG").is_some() { 100_000 } else { 5_000 };
    for level in 6..=LEVEL_MAX {
        for _ in 0..each {
            let sides = [0; 2].map(|_: u8| random.integer(0, level.into()) as u8);
            let masks = [0; 3].map(|_: u32| {
                let (a, b) = (random.bits() as u32, random.bits() as u32);
                random.of([0, a & b, a, a | b, u32::MAX])
            });
            triangles += assert_turned(level, sides, masks);
            meshes += 1;
        }
    }
    println!("compared {meshes} meshes, {triangles} triangles");
    assert!(meshes == 10 * each && triangles > 30 * meshes);
}
