//! The patch's pattern: who shares which edge, where candidates are, and parameters as fractions.

use rtl_model::esc::{
    COARSE_EDGES, CoarseEdge, CoarseTriangle, Corner, Edge, Insertion, LEVEL_MAX, Levels, Site,
    fraction, slot, uniform,
};
use std::collections::{BTreeMap, BTreeSet};

/// The corners of a coarse triangle: apex, the left one, the right one.
fn corners(triangle: CoarseTriangle) -> [Corner; 3] {
    [(0, 0), (1, 0), (1, 1)].map(|(row, place)| triangle.place(Site { row, place }, 1))
}

#[test]
fn coarse_triangles_tile_the_patch_and_share_its_edges() {
    let mut directed = BTreeMap::new();
    for triangle in CoarseTriangle::ALL {
        let [a, b, c] = corners(triangle);
        let [x, y, z] = [a, b, c].map(|corner| corner.map(i32::from));
        let twice = (y[0] - x[0]) * (z[1] - x[1]) - (z[0] - x[0]) * (y[1] - x[1]);
        assert_eq!(twice, 1, "{triangle:?} is half a cell, counter-clockwise");
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert_eq!(directed.insert((from, to), ()), None, "{from:?} {to:?} twice");
        }
        // Its edges are those that it names, in its own or the other direction.
        for (edge, ends) in triangle.edges.iter().zip([[a, b], [a, c], [b, c]]) {
            let CoarseEdge { from, to } = CoarseEdge::ALL[*edge];
            assert_eq!(ends, if triangle.second { [to, from] } else { [from, to] });
        }
    }
    let mut sides = 0;
    for edge in CoarseEdge::ALL {
        let ways = [(edge.from, edge.to), (edge.to, edge.from)];
        let users = ways.iter().filter(|way| directed.contains_key(way)).count();
        assert_eq!(users, if edge.third().is_some() { 1 } else { 2 }, "{edge:?}");
        sides += users;
    }
    assert_eq!((directed.len(), sides), (54, 54));
    let distinct: BTreeSet<_> = CoarseEdge::ALL.iter().map(|e| (e.from, e.to)).collect();
    assert_eq!(distinct.len(), COARSE_EDGES);
    let thirds: BTreeSet<_> = CoarseEdge::ALL.iter().filter_map(|e| e.third()).collect();
    let all = (0..4).flat_map(|edge| (0..3).map(move |third| (edge, third)));
    assert_eq!(thirds, all.collect());
    // v0, u1, v1, u0, each along its growing parameter.
    for edge in CoarseEdge::ALL {
        let Some((side, third)) = edge.third() else { continue };
        let ends = [third, third + 1].map(|t| [[t, 0], [3, t], [t, 3], [0, t]][side]);
        assert_eq!(ends, [edge.from, edge.to]);
    }
}

/// Where a coarse triangle has a site of its edge, and with it the bit that says whether it is
/// inserted, the coarse edge has it too.
#[test]
fn a_coarse_edge_is_read_alike_by_both_its_triangles() {
    let mut compared = 0;
    for level in 0..=LEVEL_MAX {
        let last = level + 1;
        for triangle in CoarseTriangle::ALL {
            for (n, &edge) in triangle.edges.iter().enumerate() {
                for position in 1..=level {
                    let mut masks = [0; COARSE_EDGES];
                    masks[edge] = 1 << position;
                    let insertion = triangle.insertion(level, &masks);
                    let side = [Edge::Left, Edge::Right, Edge::Bottom][n];
                    let own = insertion.mask(side).trailing_zeros() as u8;
                    let site = match side {
                        Edge::Left => Site { row: own, place: 0 },
                        Edge::Right => Site { row: own, place: own },
                        Edge::Bottom => Site { row: last, place: own },
                    };
                    assert!(insertion.has(site) && insertion.boundary() == 4);
                    let place = CoarseEdge::ALL[edge].place(position, last);
                    assert_eq!(triangle.place(site, last), place, "{triangle:?} {position}");
                    compared += 1;
                }
            }
        }
    }
    println!("compared {compared} positions");
    assert_eq!(compared, 54 * 120);
}

#[test]
fn candidates_of_a_lower_level_have_slots_of_their_own() {
    let mut seen = 0;
    for interior in 0..=LEVEL_MAX {
        for level in 0..=interior {
            let slots: Vec<u8> = (1..=level).map(|k| slot(k, level, interior)).collect();
            assert!(slots.is_sorted_by(|a, b| a < b), "{level} of {interior}: {slots:?}");
            assert!(slots.iter().all(|s| (1..=interior).contains(s)), "{slots:?}");
            for (k, s) in (1..).zip(&slots) {
                // |k / R' - s / R| <= 1 / (2 R), and no other slot is nearer
                let [own, inner] = [level, interior].map(|l| i32::from(l) + 1);
                assert!((2 * (k * inner - i32::from(*s) * own)).abs() <= own, "{k} of {level}");
                seen += 1;
            }
            let levels = Levels { edges: [level, interior, 0, level], interior };
            let masks = uniform(levels);
            for (edge, mask) in CoarseEdge::ALL.iter().zip(masks) {
                assert_eq!(u32::from(edge.level(levels)), mask.count_ones());
                let bits = Insertion::all(interior).mask(Edge::Left);
                assert_eq!(mask & !bits, 0);
                if edge.third().is_none() {
                    assert_eq!(mask, bits);
                }
            }
        }
        assert!((0..=interior).all(|k| k == 0 || slot(k, interior, interior) == k));
    }
    println!("compared {seen} slots");
    assert_eq!(seen, 680);
}

#[test]
fn every_parameter_is_one_fraction() {
    let mut seen = BTreeMap::new();
    for n in 1..=48_u64 {
        for i in 0..=n {
            let fx16 = (((2 * i) << 16) + n) / (2 * n);
            let gcd = (1..=n).rfind(|d| n % d == 0 && i % d == 0).unwrap();
            let reduced = ((i / gcd) as u32, (n / gcd) as u32);
            assert_eq!(fraction(fx16 as u32), reduced, "{i} / {n}");
            let other = seen.insert(fx16, reduced);
            assert!(other.is_none_or(|other| other == reduced), "{i} / {n} and {other:?}");
        }
    }
    println!("compared {} fractions", seen.len());
    assert_eq!(seen.len(), 713); // Farey's sequence of 48
}
