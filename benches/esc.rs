//! How fast is the surface shader? Triangles a second on one thread, from control points to
//! vertices and triangles in memory: the uniform pattern, whose mesh serves all patches of a level,
//! and tested ones, each of which has its own.
//!
//! Sheets before the camera, bent at random: at half a pixel two thirds of the uniform pattern's
//! triangles are left, at four pixels a third.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use random::{Kind, Random, patch};
use rtl_model::esc::{Boundary, ControlMesh, Input, Levels, Reuse, Settings, Surface, Threshold};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Patch, Vertex, View};
use std::hint::black_box;

#[expect(dead_code, reason = "tests use the rest")]
#[path = "../tests/support/random.rs"]
mod random;

/// Patches a measurement goes round.
const PATCHES: usize = 64;

const POSITION: Format = Format { width: 32, fraction: 31 };

fn settings(threshold: Threshold) -> Settings {
    Settings {
        position: POSITION,
        object: POSITION,
        guard: 20,
        parameter_bits: 32,
        rounding: Rounding::NearestEven,
        overflow: Overflow::Saturate,
        mesh: ControlMesh::Net,
        threshold,
        boundary: Boundary::Symmetric,
        reuse: Reuse::Patch,
        output: None,
    }
}

/// Takes all patches; their triangles.
fn take(
    shader: &mut Surface,
    patches: &[Patch],
    levels: Levels,
    vertices: &mut Vec<Vertex>,
) -> usize {
    let position = POSITION;
    let view =
        View { position, viewport: [1280, 1024], depth: Depth::ZeroToOne, near: 1, facing: 1 };
    let mut triangles = 0;
    for patch in patches {
        let input = Input { patch, object: None, view: &view, levels };
        black_box(shader.accept(&input, vertices));
        black_box(&vertices);
        triangles += black_box(shader.triangles()).len();
    }
    triangles
}

fn surfaces(criterion: &mut Criterion) {
    let mut random = Random::new(5);
    let sheet = |_| patch(&mut random, Kind::Sheet, POSITION.max());
    let patches: Vec<Patch> = (0..PATCHES).map(sheet).collect();
    let mut vertices = Vec::new();
    let mut group = criterion.benchmark_group("esc");
    group.sample_size(20);
    for (name, threshold) in [
        ("uniform", Threshold::Uniform),
        ("half a pixel", Threshold::pixels(1 << 15)),
        ("four pixels", Threshold::pixels(4 << 16)),
    ] {
        let mut shader = Surface::new(settings(threshold));
        for level in [3, 7, 15] {
            let levels = Levels { edges: [level; 4], interior: level };
            let triangles = take(&mut shader, &patches, levels, &mut vertices);
            group.throughput(Throughput::Elements(triangles as u64));
            group.bench_function(BenchmarkId::new(name, level), |bencher| {
                bencher.iter(|| take(&mut shader, black_box(&patches), levels, &mut vertices));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, surfaces);
criterion_main!(benches);
