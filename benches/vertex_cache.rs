//! How fast is the cache of shaded vertices? Indices a second on one thread, for each policy.
//!
//! The indices are those of a grid 100 quadrilaterals wide, row by row, as lists: of each row more
//! vertices than any cache holds, so hits and misses both occur. Beside them, the same through the
//! whole of index fetch: strips formed from a patch's triangles. Wanted are 50 million indices a
//! second.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use tessim::config::{CachePolicy, MeshTopology, VertexCache};
use tessim::link::index_stream::IndexStream;
use tessim::link::vertex_cache::Cache;

/// Quadrilaterals in a row, and rows.
const GRID: [u32; 2] = [100, 1000];

fn triangles() -> Vec<[u32; 3]> {
    let [columns, rows] = GRID;
    let vertex = |column: u32, line: u32| line * (columns + 1) + column;
    let quad = |row: u32, c: u32| {
        let [a, b, d, e] =
            [vertex(c, row), vertex(c + 1, row), vertex(c, row + 1), vertex(c + 1, row + 1)];
        [[a, b, d], [d, b, e]]
    };
    (0..rows).flat_map(|row| (0..columns).flat_map(move |c| quad(row, c))).collect()
}

fn vertex_cache(criterion: &mut Criterion) {
    let triangles = triangles();
    let indices = triangles.as_flattened();
    let mut group = criterion.benchmark_group("vertex_cache");
    group.sample_size(20).throughput(Throughput::Elements(indices.len() as u64));
    for policy in [CachePolicy::Unlimited, CachePolicy::Fifo, CachePolicy::Lru] {
        for entries in [8, 24, 64] {
            let mut cache = Cache::new(VertexCache { policy, entries });
            let id = BenchmarkId::new(format!("{policy:?}"), entries);
            group.bench_function(id, |bencher| {
                bencher.iter(|| {
                    cache.clear();
                    black_box(indices).iter().filter(|&&v| cache.misses(v)).count()
                });
            });
        }
    }
    // A patch: rows of the same grid that 16 bits reach.
    let patch: Vec<[u16; 3]> = triangles[..20_000].iter().map(|t| t.map(|v| v as u16)).collect();
    group.throughput(Throughput::Elements(3 * patch.len() as u64));
    for topology in [MeshTopology::StripRestart, MeshTopology::StripDegenerate] {
        let mut stream = IndexStream::default();
        group.bench_function(BenchmarkId::new("form", format!("{topology:?}")), |bencher| {
            bencher.iter(|| {
                stream.form(black_box(&patch), 10_201, topology);
                stream.indices.len()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, vertex_cache);
criterion_main!(benches);
