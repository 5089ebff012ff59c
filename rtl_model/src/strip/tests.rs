//! Strips against closed formulas, over all segment counts, and against a table by hand.

use super::*;
use crate::patch::{Level, Levels, ONE};
use crate::place::{Numbering, Placement};

fn segments(edges: [u32; 4], interior: [u32; 2]) -> Segments {
    let level = |fx16: &u32| Level::clamped((*fx16).into());
    let mut placement = Placement::default();
    placement.set(&Levels {
        edges: edges.each_ref().map(level),
        interior: interior.each_ref().map(level),
    });
    placement.segments()
}

/// A level for each segment count: 1, 3, 2, 4, ..., 128.
fn levels() -> Vec<u32> {
    [ONE, 3 * ONE / 2].into_iter().chain((1..=64).map(|h| 2 * h * ONE)).collect()
}

/// What the strips of a patch promise of their number, order and rows. Returns their number.
fn check(segments: Segments) -> usize {
    let [columns, rows] = segments.interior();
    let (mut made, mut triangles, mut needed) = (0, 0, 0);
    for strip in segments.strips() {
        assert!(strip.count() > 0, "a strip without triangles, {segments:?}");
        assert_eq!(strip.first, made == 0, "{segments:?}");
        let cells = matches!(strip.kind, Kind::Cells { .. }) && rows > 0;
        assert_eq!(usize::from(strip.rows_needed), if cells { made + 2 } else { rows });
        assert!(strip.rows_needed >= needed, "rows are not given back");
        (made, triangles) = (made + 1, triangles + strip.count() as usize);
        needed = strip.rows_needed;
        assert_eq!(strip.last, made == segments.strip_count(), "{segments:?}");
    }
    assert_eq!(made, segments.strip_count(), "{segments:?}");
    assert_eq!(triangles, segments.triangles(), "{segments:?}");
    assert_eq!(triangles, 2 * columns * rows + segments.boundary() - 2, "2P + B - 2: {segments:?}");
    made
}

#[test]
fn all_segment_counts_keep_the_closed_formulas() {
    let (mut patches, mut made) = (0, 0);
    let mut add = |segments| {
        patches += 1;
        made += check(segments);
    };
    let kinds = [ONE, 3 * ONE / 2, 2 * ONE, 6 * ONE];
    for u in levels() {
        for v in levels() {
            for edge in levels() {
                add(segments([edge; 4], [u, v]));
            }
            for k in 0..256 {
                add(segments([0, 2, 4, 6].map(|bit| kinds[k >> bit & 3]), [u, v]));
            }
        }
    }
    println!("compared {patches} patches, {made} strips");
    assert_eq!(patches, 66 * 66 * (66 + 256));
}

#[test]
fn a_strip_fills_in_what_it_yields_and_touches_no_later_row() {
    let (mut compared, mut out) = (0, Vec::new());
    let levels = [ONE, 3 * ONE / 2, 2 * ONE, 5 * ONE, 6 * ONE, 31 * ONE, 128 * ONE];
    for a in levels {
        for b in levels {
            let segments = segments([a, b, ONE, 6 * ONE], [b, a]);
            let [columns, _] = segments.interior();
            for strip in segments.strips() {
                out.clear();
                out.resize(strip.count() as usize, [0; 3]);
                strip.fill(&mut out);
                assert!(strip.triangles().eq(out.iter().copied()), "{strip:?}");
                assert_eq!(strip.triangles().len(), out.len());
                let end = segments.boundary() + usize::from(strip.rows_needed) * columns;
                assert!(out.iter().flatten().all(|&k| usize::from(k) < end), "{strip:?}");
                compared += out.len();
            }
        }
    }
    println!("compared {compared} triangles");
    assert!(compared > 50_000);
}

#[test]
fn segments_across_a_centre_are_bresenham_strips() {
    // Numbers of vertices drawn by hand: boundary from (0, 0) counter-clockwise, then the interior.
    let across = |edges, interior| -> Vec<Vec<Triangle>> {
        let all = segments(edges, interior).strips();
        all.filter(|s| s.outer_segments == 1).map(|s| s.triangles().collect()).collect()
    };
    assert_eq!(across([ONE; 4], [ONE; 2]), [[[0, 1, 2], [0, 2, 3]]]);
    let point = [[[0, 1, 4]], [[2, 4, 1]], [[2, 3, 4]], [[0, 4, 3]]];
    assert_eq!(across([ONE; 4], [2 * ONE; 2]), point);
    let half = 3 * ONE / 2;
    let ring: Vec<_> = segments([half; 4], [half; 2])
        .strips()
        .filter(|s| s.end > 0 && s.inner_segments == 1)
        .collect();
    assert_eq!(ring.len(), 4);
    assert_eq!(ring[0].triangles().collect::<Vec<_>>(), [[12, 1, 13], [1, 2, 13]]);
}

#[test]
fn a_strip_is_small() {
    assert!(size_of::<Strip>() <= 40, "{} bytes", size_of::<Strip>());
}
