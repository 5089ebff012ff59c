//! Every pattern is a disc: each edge of a triangle once on the boundary and twice inside, areas
//! that sum to the domain's, counts by the closed formulas.

use crate::draw::{DOMAINS, ONE, PARTITIONINGS, Random, pattern};
use rtl_model::d3d11::{Domain, Factors, Output};
use std::collections::HashMap;

/// Twice the area, positive where it is clockwise with v down.
fn twice(points: &[[u32; 2]], triangle: [u16; 3]) -> i64 {
    let [a, b, c] = triangle.map(|k| points[usize::from(k)].map(i64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// What a pattern of triangles promises; how many it has.
fn promises(factors: &Factors) -> usize {
    let (points, indices) = pattern(factors, Output::Ccw);
    let sides = factors.domain().edges();
    let boundary: usize = (0..sides).map(|edge| factors.edge_points(edge) - 1).sum();
    let inner = points.len() - boundary;
    assert_eq!(points.len(), factors.points(), "{factors:?}");
    assert_eq!(indices.len(), 3 * (2 * inner + boundary - 2), "Euler: {factors:?}");
    assert_eq!(indices.len(), factors.indices(Output::Ccw), "{factors:?}");
    let mut directed: HashMap<[u16; 2], u32> = HashMap::new();
    let mut area = 0;
    for &triangle in indices.as_chunks::<3>().0 {
        area += twice(&points, triangle);
        for k in 0..3 {
            *directed.entry([triangle[k], triangle[(k + 1) % 3]]).or_default() += 1;
        }
    }
    let unit = i64::from(ONE) * i64::from(ONE);
    let want = if sides == 4 { -2 * unit } else { -unit };
    assert_eq!(area, want, "areas of {factors:?}");
    let mut on_boundary = 0;
    for (&[a, b], &times) in &directed {
        assert_eq!(times, 1, "a directed edge twice: {a} {b} of {factors:?}");
        if !directed.contains_key(&[b, a]) {
            // The outer ring is counter-clockwise with v up; what lies on it, clockwise.
            let follows = usize::from(a) == (usize::from(b) + 1) % boundary;
            assert!(usize::from(b) < boundary && follows, "{a} {b} of {factors:?}");
            on_boundary += 1;
        }
    }
    assert_eq!(on_boundary, boundary, "{factors:?}");
    let used: std::collections::HashSet<u16> = indices.iter().copied().collect();
    assert_eq!(used.len(), points.len(), "every point once: {factors:?}");
    indices.len() / 3
}

#[test]
fn random_patterns_are_discs() {
    let mut random = Random(10);
    let (mut patterns, mut triangles) = (0, 0);
    for round in 0..6000 {
        let domain = [Domain::Quad, Domain::Tri][round % 2];
        let bits: Vec<u32> = (0..domain.factors()).map(|_| random.factor()).collect();
        let factors = Factors::process(domain, PARTITIONINGS[round / 2 % 4], &bits).unwrap();
        triangles += promises(&factors);
        patterns += 1;
    }
    println!("compared {patterns} patterns, {triangles} triangles");
    assert!(patterns == 6000 && triangles > 500_000);
}

/// All pairs of inner factors of a quad, all inner factors of a tri: every ring, line and centre.
#[test]
fn patterns_of_all_inner_counts_are_discs() {
    let mut patterns = 0;
    for partitioning in PARTITIONINGS {
        for u in 1..=64 {
            for v in (1..=64).filter(|v| u <= 20 && *v <= 20 || (u + v) % 7 == 0) {
                let edges = [1 + (u * 7 + v) % 64, 1 + (u + v * 11) % 64, u, 65 - v];
                let [a, b, c, d] = edges.map(|n| (n as f32).to_bits());
                let bits = [a, b, c, d, (u as f32).to_bits(), (v as f32).to_bits()];
                promises(&Factors::quad(partitioning, bits).unwrap());
                patterns += 1;
            }
            let bits = [u, 65 - u, 1 + u * 5 % 64, u].map(|n| (n as f32).to_bits());
            promises(&Factors::process(Domain::Tri, partitioning, &bits).unwrap());
            patterns += 1;
        }
    }
    println!("compared {patterns} patterns");
    assert!(patterns > 3000);
}

#[test]
fn the_greatest_patterns_have_the_counts_of_the_specification() {
    let most = 64f32.to_bits();
    let quad = Factors::quad(PARTITIONINGS[0], [most; 6]).unwrap();
    assert_eq!((quad.points(), quad.indices(Output::Cw)), (65 * 65, 64 * 64 * 2 * 3));
    let tri = Factors::process(Domain::Tri, PARTITIONINGS[0], &[most; 4]).unwrap();
    assert_eq!((tri.points(), tri.indices(Output::Cw)), (3169, 3 * 6144));
    let lines = Factors::process(Domain::Isoline, PARTITIONINGS[0], &[most; 2]).unwrap();
    assert_eq!((lines.points(), lines.indices(Output::Line)), (64 * 65, 2 * 64 * 64));
}

/// No driver and no vector has a triangle fewer: one, or two, in an order of their own.
#[test]
fn factors_of_one_make_the_least_patterns() {
    let one = 1f32.to_bits();
    for partitioning in PARTITIONINGS.into_iter().take(3) {
        let quad = Factors::quad(partitioning, [one; 6]).unwrap();
        let corners = vec![[0, 0], [ONE, 0], [ONE, ONE], [0, ONE]];
        assert_eq!(pattern(&quad, Output::Cw), (corners.clone(), vec![0, 1, 3, 1, 2, 3]));
        assert_eq!(pattern(&quad, Output::Ccw), (corners, vec![0, 3, 1, 1, 3, 2]));
        assert_eq!(Factors::default(), quad, "the default");
        let tri = Factors::process(Domain::Tri, partitioning, &[one; 4]).unwrap();
        let corners = vec![[0, ONE], [0, 0], [ONE, 0]];
        assert_eq!(pattern(&tri, Output::Cw), (corners, vec![0, 1, 2]));
    }
    let even = Factors::quad(PARTITIONINGS[3], [one; 6]).unwrap();
    assert_eq!((even.points(), promises(&even)), (9, 8));
}

#[test]
fn isolines_are_lines_of_constant_v() {
    let mut random = Random(11);
    let mut compared = 0;
    for round in 0..2000 {
        let partitioning = PARTITIONINGS[round % 4];
        let bits = [random.factor(), random.factor()];
        let factors = Factors::process(Domain::Isoline, partitioning, &bits).unwrap();
        let (points, indices) = pattern(&factors, Output::Line);
        let lines = f32::from_bits(bits[0]).clamp(1.0, 64.0).ceil() as usize;
        let along = factors.edge_points(1);
        assert_eq!(points.len(), lines * along, "{bits:x?}");
        assert_eq!(indices.len(), factors.indices(Output::Line));
        for (k, line) in indices.chunks(2).enumerate() {
            let [row, at] = [k / (along - 1), k % (along - 1)];
            assert_eq!(line[0] as usize, row * along + at, "{bits:x?}");
            assert_eq!(line[1], line[0] + 1);
            let [a, b] = [points[line[0] as usize], points[line[1] as usize]];
            assert!(a[1] == b[1] && a[1].abs_diff((row << 16) as u32 / lines as u32) <= 32);
            compared += 1;
        }
    }
    println!("compared {compared} lines");
    assert!(compared > 100_000 && DOMAINS.len() == 3);
}
