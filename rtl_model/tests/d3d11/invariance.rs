//! The invariance rules of Direct3D 11 and of OpenGL (ARB_tessellation_shader, appendix A): what an
//! edge, the interior, and the strip between them depend on.

use crate::draw::{ONE, PARTITIONINGS, Random, pattern, quad_edge};
use rtl_model::d3d11::{Domain, Factors, Output, Partitioning, Tessellator};

fn quad(partitioning: Partitioning, bits: [u32; 6]) -> Factors {
    Factors::quad(partitioning, bits).expect("no factor culls")
}

fn ones(factors: &[u32]) -> bool {
    factors.iter().all(|&bits| f32::from_bits(bits) <= 1.0 + 2f32.powi(-17))
}

/// OpenGL's rules 2, 3, 4 and 8.
#[test]
fn an_edge_is_symmetric_and_depends_on_its_own_factor_only() {
    let mut random = Random(1);
    let mut compared = 0;
    for round in 0..2000 {
        let partitioning = PARTITIONINGS[round % 4];
        let own = random.factor();
        // What the edge is: of an isoline pattern, which has nothing else.
        let line = Factors::process(Domain::Isoline, partitioning, &[1f32.to_bits(), own]).unwrap();
        let want: Vec<u32> = pattern(&line, Output::Point).0.iter().map(|[u, _]| *u).collect();
        for (near, far) in want.iter().zip(want.iter().rev()) {
            assert_eq!(near + far, ONE, "{partitioning:?} {own:x}: {want:?}");
        }
        for edge in 0..4 {
            let mut bits = [0; 6].map(|_| random.factor());
            bits[edge] = own;
            if ones(&bits) {
                continue;
            }
            let factors = quad(partitioning, bits);
            let (points, _) = pattern(&factors, Output::Ccw);
            assert_eq!(quad_edge(&factors, &points, edge), want, "{partitioning:?} {bits:x?}");
            compared += 1;
        }
        for edge in 0..3 {
            let mut bits = [0; 4].map(|_| random.factor());
            bits[edge] = own;
            let factors = Factors::process(Domain::Tri, partitioning, &bits).unwrap();
            let (points, _) = pattern(&factors, Output::Ccw);
            let first: usize = (0..edge).map(|e| factors.edge_points(e) - 1).sum();
            let ring: usize = (0..3).map(|e| factors.edge_points(e) - 1).sum();
            let on_edge = (first..first + want.len()).map(|k| points[k % ring]);
            for ([u, v], &t) in on_edge.zip(&want) {
                let at = [[0, ONE - t], [t, 0], [ONE - t, t]][edge];
                assert_eq!([u, v], at, "{partitioning:?} edge {edge} of {bits:x?}");
            }
            compared += 1;
        }
    }
    println!("compared {compared} edges");
    assert!(compared > 12_000);
}

/// OpenGL's rule 6, as far as factors of 1 do not make an odd pattern single.
#[test]
fn the_interior_does_not_depend_on_the_edges() {
    let mut random = Random(2);
    let mut compared = 0;
    for round in 0..3000 {
        let partitioning = PARTITIONINGS[round % 4];
        let inner = [0; 2].map(|_| random.factor());
        let mut interiors = Vec::new();
        for _ in 0..2 {
            let [a, b, c, _] = [0; 4].map(|_| random.factor());
            let above_one = (1.5 + random.below(60) as f32).to_bits(); // no single pattern
            let factors = quad(partitioning, [a, b, c, above_one, inner[0], inner[1]]);
            let outer: usize = (0..4).map(|e| factors.edge_points(e) - 1).sum();
            let (points, indices) = pattern(&factors, Output::Cw);
            // Triangles without a point of the outer ring, numbered from the inner ones' first.
            let triangles: Vec<Vec<usize>> = indices
                .chunks(3)
                .map(|t| t.iter().map(|&k| usize::from(k)).collect::<Vec<_>>())
                .filter(|t| t.iter().all(|&k| k >= outer))
                .map(|t| t.iter().map(|k| k - outer).collect())
                .collect();
            interiors.push((points[outer..].to_vec(), triangles));
        }
        assert_eq!(interiors[0], interiors[1], "{partitioning:?} {inner:x?}");
        compared += interiors[0].0.len();
    }
    println!("compared {compared} inner points");
    assert!(compared > 100_000);
}

/// OpenGL's rule 7.
#[test]
fn the_strip_between_depends_on_its_edge_and_the_interior_only() {
    let mut random = Random(3);
    let mut compared = 0;
    for round in 0..3000 {
        let partitioning = PARTITIONINGS[round % 4];
        let edge = round / 4 % 4;
        let (own, across) = (random.factor(), (1.5 + random.below(20) as f32).to_bits());
        let mut strips = Vec::new();
        for _ in 0..2 {
            let mut bits = [0; 6].map(|_| random.factor());
            bits[edge] = own;
            // The inner factor along the edge: the other one decides where the ring is.
            bits[if edge % 2 == 0 { 5 } else { 4 }] = across;
            let factors = quad(partitioning, bits);
            // Only where the ring's sides are the same: not in a line.
            if factors.inner_points(0).min(factors.inner_points(1)) < 4 {
                continue;
            }
            strips.push(strip(&factors, edge));
        }
        if let [one, other] = &strips[..] {
            assert_eq!(one, other, "{partitioning:?} edge {edge}");
            compared += one.len();
        }
    }
    println!("compared {compared} triangles");
    assert!(compared > 30_000);
}

/// A row, and a number along it.
type Along = (bool, usize);

/// The triangles of the strip at an edge of a quad, numbered along both rows.
fn strip(factors: &Factors, edge: usize) -> Vec<[Along; 3]> {
    let (_, indices) = pattern(factors, Output::Ccw);
    let segments = |e: usize| factors.edge_points(e) - 1;
    let inner = |e: usize| factors.inner_points(1 - e % 2) - 3;
    let [outer_ring, ring]: [usize; 2] = [(0..4).map(segments).sum(), (0..4).map(inner).sum()];
    let [first, inner_first]: [usize; 2] =
        [(0..edge).map(segments).sum(), (0..edge).map(inner).sum()];
    let begin: usize = (0..edge).map(|e| segments(e) + inner(e)).sum();
    let along = |&k: &u16| {
        let k = usize::from(k);
        match k.checked_sub(outer_ring) {
            None => (false, (k + outer_ring - first) % outer_ring),
            Some(k) => (true, (k + ring - inner_first) % ring),
        }
    };
    let strip = &indices[3 * begin..3 * (begin + segments(edge) + inner(edge))];
    strip.chunks(3).map(|t| [along(&t[0]), along(&t[1]), along(&t[2])]).collect()
}

#[test]
fn clockwise_is_counter_clockwise_mirrored_and_points_do_not_change() {
    let mut random = Random(4);
    let mut kept = Tessellator::default();
    let mut compared = 0;
    for round in 0..3000 {
        let partitioning = PARTITIONINGS[round % 4];
        let domain = [Domain::Quad, Domain::Tri][round % 2];
        let bits: Vec<u32> = (0..domain.factors()).map(|_| random.factor()).collect();
        let factors = Factors::process(domain, partitioning, &bits).unwrap();
        let (points, ccw) = pattern(&factors, Output::Ccw);
        // A tessellator that has made other patterns makes the same.
        kept.accept(&factors, Output::Cw);
        assert_eq!(kept.points(), points);
        for (cw, ccw) in kept.indices().chunks(3).zip(ccw.chunks(3)) {
            assert_eq!([cw[0], cw[2], cw[1]], ccw, "{partitioning:?} {bits:x?}");
            compared += 1;
        }
        kept.accept(&factors, Output::Point);
        assert_eq!((kept.points(), kept.indices().len()), (&points[..], points.len()));
        assert!(kept.indices().iter().enumerate().all(|(k, &index)| k == usize::from(index)));
        kept.accept(&factors, Output::Line);
        assert_eq!(kept.indices().len(), 2 * (points.len() - 1));
        let lines = kept.indices().chunks(2).enumerate();
        assert!(lines.into_iter().all(|(k, l)| [k, k + 1] == [l[0], l[1]].map(usize::from)));
    }
    println!("compared {compared} triangles");
    assert!(compared > 400_000);
}
