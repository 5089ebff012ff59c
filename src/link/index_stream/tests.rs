//! Index streams, decoded as a rasteriser would: the same triangles, in the same sense and order.

use super::*;
use crate::config::{CachePolicy, VertexCache};
use crate::link::vertex_cache::Cache;
use proptest::prelude::*;
use rtl_model::patch::{Level, Levels};
use rtl_model::place::{Numbering, Placement};
use rtl_model::stitch;

/// The triangles that strips name, those of two equal corners left out.
fn decoded(indices: &[u16]) -> Vec<Triangle> {
    let strips = indices.split(|&index| index == RESTART);
    let of = |strip: &[u16]| -> Vec<Triangle> {
        let turned = |(k, w): (usize, &[u16])| {
            if k.is_multiple_of(2) { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] }
        };
        strip.windows(3).enumerate().map(turned).collect()
    };
    let has_area = |t: &Triangle| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    strips.flat_map(of).filter(has_area).collect()
}

/// From its least corner on: where a triangle begins does not matter, its sense does.
fn canonical(triangle: Triangle) -> Triangle {
    let [a, b, c] = triangle;
    let first = a.min(b).min(c);
    if a == first {
        triangle
    } else if b == first {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

fn formed(triangles: &[Triangle], topology: MeshTopology) -> IndexStream {
    let mut stream = IndexStream::default();
    stream.form(triangles, 1 << 15, topology);
    stream
}

const STRIPS: [MeshTopology; 2] = [MeshTopology::StripRestart, MeshTopology::StripDegenerate];

fn sorted(triangles: &[Triangle]) -> Vec<Triangle> {
    let mut all: Vec<_> = triangles.iter().copied().map(canonical).collect();
    all.sort_unstable();
    all
}

/// The law of the counters, and the triangles themselves.
fn holds(triangles: &[Triangle], topology: MeshTopology) -> IndexStream {
    let stream = formed(triangles, topology);
    let came = decoded(&stream.indices);
    assert_eq!(sorted(&came), sorted(triangles), "{topology:?}: {:?}", stream.indices);
    let named = triangles.len() as u64 + 2 * stream.strips + stream.repeated + stream.restarts;
    assert_eq!(stream.indices.len() as u64, named, "{topology:?}");
    let restarts = stream.indices.iter().filter(|&&index| index == RESTART).count() as u64;
    let strips = if triangles.is_empty() { 0 } else { restarts + 1 };
    assert_eq!((stream.restarts, stream.strips), (restarts, strips));
    if topology == STRIPS[1] {
        assert!(restarts == 0 && stream.indices.len().is_multiple_of(2), "{:?}", stream.indices);
    }
    stream
}

#[test]
fn strips_are_read_as_by_hand() {
    let fan = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [2, 4, 5]];
    assert_eq!(sorted(&decoded(&[0, 1, 2, 3, 2, 4, 5])), sorted(&fan));
    let two = [[0, 1, 2], [5, 6, 7], [7, 6, 8]];
    assert_eq!(sorted(&decoded(&[0, 1, 2, RESTART, 5, 6, 7, 8])), sorted(&two));
    assert_eq!(sorted(&decoded(&[0, 1, 2, 2, 2, 5, 5, 6, 7, 8])), sorted(&two));
    assert_eq!(sorted(&decoded(&[0, 1, 2, 2, 5, 5, 7, 6, 8])), sorted(&two), "at an odd place");
    for topology in STRIPS {
        holds(&fan, topology);
        holds(&two, topology);
        // The same edge, but turned round: no strip goes on with it.
        let stream = holds(&[[0, 1, 2], [1, 2, 3]], topology);
        assert!(stream.strips == 2 || stream.repeated >= 2, "{topology:?}");
    }
    assert_eq!(formed(&fan, MeshTopology::List).indices, fan.as_flattened());
    assert_eq!(formed(&[], STRIPS[1]), IndexStream::default());
}

#[test]
fn a_row_of_a_grid_is_one_strip() {
    // One diagonal fits the sense of a strip's first triangle; the other may take a turn at first.
    let fits = |k: u16| [[k + 10, k, k + 11], [k + 11, k, k + 1]];
    let turns = |k: u16| [[k, k + 1, k + 10], [k + 10, k + 1, k + 11]];
    for triangles in [(0..8).flat_map(fits).collect(), (0..8).flat_map(turns).collect()] {
        let triangles: Vec<Triangle> = triangles;
        let stream = holds(&triangles, STRIPS[0]);
        assert!(stream.strips == 1 && stream.repeated <= 1, "{:?}", stream.indices);
        let stream = holds(&triangles, STRIPS[1]);
        assert!(stream.repeated <= 2, "made even at its end: {:?}", stream.indices);
    }
}

#[test]
fn a_batch_is_as_long_as_short_indices_reach() {
    let batches = |width, topology, patches: u64, vertices| {
        let mut batches = Batches::default();
        let begun = (0..patches).filter(|_| batches.patch(vertices, width, topology)).count();
        assert_eq!(begun as u64, batches.count);
        batches.count
    };
    let list =
        |patches, vertices| batches(IndexWidth::Uint16, MeshTopology::List, patches, vertices);
    // 65536 = 256 x 256: the last one still fits.
    assert_eq!([256, 257, 512, 513].map(|patches| list(patches, 256)), [1, 2, 2, 3]);
    assert_eq!(list(7, 16641), 3);
    assert_eq!(batches(IndexWidth::Uint16, STRIPS[0], 256, 256), 2, "one index ends strips");
    assert_eq!(batches(IndexWidth::Uint32, MeshTopology::List, 1000, 16641), 1);
    assert_eq!(list(0, 9), 0);
    let bytes = |vertices| index_bytes(IndexWidth::Auto, STRIPS[0], vertices);
    assert_eq!([65535, 65536].map(bytes), [2, 4]);
}

proptest! {
    /// Any triangles at all: those of a few vertices share edges often, in either sense.
    #[test]
    fn strips_name_the_same_triangles(
        triangles in prop::collection::vec((0u16..9, 0u16..9, 0u16..9), 0..60),
    ) {
        let distinct = |t: &[u16; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let triangles: Vec<_> =
            triangles.into_iter().map(|(a, b, c)| [a, b, c]).filter(distinct).collect();
        for topology in STRIPS {
            holds(&triangles, topology);
        }
    }
}

/// Triangles and vertices of a patch of these levels, in UQ8.16.
fn pattern(edges: [u32; 4], interior: [u32; 2]) -> (Vec<Triangle>, usize) {
    let level = |fx16: u32| Level::clamped(fx16.into());
    let mut placement = Placement::default();
    placement.set(&Levels { edges: edges.map(level), interior: interior.map(level) });
    let mut triangles = Vec::new();
    stitch::accept(placement.segments(), &mut triangles);
    (triangles, placement.segments().vertices())
}

/// A row of L quadrilaterals as a strip, with a restart, has 2 L + 3 indices for 2 L triangles.
#[test]
fn strips_of_a_patch_come_near_those_of_rows() {
    for level in 1..=128_u32 {
        let (triangles, _) = pattern([level << 16; 4], [level << 16; 2]);
        let rows = 1.0 + 1.5 / f64::from(level);
        for topology in STRIPS {
            let stream = holds(&triangles, topology);
            let each = stream.indices.len() as f64 / triangles.len() as f64;
            let most = if level < 16 { 1.35 } else { 1.2 };
            assert!(each < most * rows, "{level} {topology:?}: {each}, rows {rows}");
        }
    }
}

#[test]
fn between_patches_the_cache_hits() {
    let (triangles, vertices) = pattern([7 << 16; 4], [9 << 16; 2]);
    for (topology, policy) in [STRIPS[0], STRIPS[1]]
        .into_iter()
        .flat_map(|t| [CachePolicy::Fifo, CachePolicy::Lru].map(|p| (t, p)))
    {
        let settings = VertexCache { policy, entries: 14 };
        let own = holds(&triangles, topology).indices;
        let mut alone = Cache::new(settings);
        let alone = own.iter().filter(|&&v| v != RESTART && alone.misses(v.into())).count();
        // The draw: three patches with vertices of their own.
        let mut draw: Vec<Option<u32>> = Vec::new();
        for patch in 0..3 {
            let index = |&v: &u16| (v != RESTART).then(|| u32::from(v) + patch * vertices as u32);
            let next: Vec<_> = own.iter().map(index).collect();
            if patch > 0 && topology == STRIPS[0] {
                draw.push(None);
            } else if patch > 0 {
                draw.extend([*draw.last().unwrap(), next[0]]);
            }
            draw.extend(next);
        }
        let [between, _] = between_patches(topology);
        assert_eq!(draw.len() as u64, 3 * own.len() as u64 + 2 * between);
        let mut whole = Cache::new(settings);
        let whole = draw.iter().flatten().filter(|&&v| whole.misses(v)).count();
        assert_eq!(whole, 3 * alone, "{topology:?} {policy:?}");
    }
}

#[test]
fn a_better_order_names_the_same_triangles_and_misses_less() {
    let (triangles, vertices) = pattern([32 << 16; 4], [32 << 16; 2]);
    let mut stream = IndexStream::default();
    let misses = |stream: &IndexStream| {
        let mut cache = Cache::new(VertexCache { policy: CachePolicy::Fifo, entries: 16 });
        stream.indices.iter().filter(|&&v| cache.misses(v.into())).count()
    };
    stream.form(&triangles, vertices, MeshTopology::List);
    let list = misses(&stream);
    stream.form(&triangles, vertices, MeshTopology::Optimised);
    let (named, rest) = stream.indices.as_chunks::<3>();
    assert!(rest.is_empty());
    assert_eq!(sorted(named), sorted(&triangles));
    let optimised = misses(&stream);
    assert!(10 * optimised < 7 * list, "{optimised} of {list}");
}

proptest! {
    #[test]
    fn strips_of_any_patch_name_its_triangles(
        edges in prop::array::uniform4(1u32 << 16..20 << 16),
        interior in prop::array::uniform2(1u32 << 16..20 << 16),
    ) {
        let (triangles, _) = pattern(edges, interior);
        for topology in STRIPS {
            holds(&triangles, topology);
        }
    }
}
