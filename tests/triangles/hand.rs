//! Counts by hand.

use crate::counted;
use rtl_model::counter::{Counter as C, Counters};
use std::fmt::Write;

const IDENTITY: &str = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
const PROJECTION: &str = "[1,0,0,0,0,1,0,0,0,0,-0.01,0,0,0,0.5,1]";

/// Points of a flat patch of so much size.
fn patch(size: f64) -> String {
    let at = |k: usize| (k as f64 / 3.0 - 0.5) * size;
    let points = (0..16).map(|k| format!("[{},{},0]", at(k % 4), at(k / 4)));
    points.collect::<Vec<_>>().join(",")
}

/// A patch of two instances in each of so many frames, seen from the front.
fn frames(count: usize, attributes: bool) -> String {
    let mut text = "{\"tessim\":1}\n".to_owned();
    writeln!(text, r#"{{"points":{{"id":0,"xyz":[{}]}}}}"#, patch(1.0)).unwrap();
    if attributes {
        let layout = r#"[{"name":"color","format":"unorm8x4"}]"#;
        let values = "[[1,1,1,1],[0,0,0,1],[0,0,0,1],[0,0,0,1]]";
        let line = format!(r#"{{"attributes":{{"id":0,"layout":{layout},"values":{values}}}}}"#);
        writeln!(text, "{line}").unwrap();
    }
    let with = if attributes { r#","attributes":0"# } else { "" };
    for _ in 0..count {
        let matrices = format!(r#""view":{IDENTITY},"projection":{PROJECTION}"#);
        writeln!(text, r#"{{"frame":{{"viewport":[64,64],{matrices}}}}}"#).unwrap();
        let patches = r#""primitive":"patches","points":0,"count":1"#;
        let instances = format!(r#""instances":[{IDENTITY},{IDENTITY}]"#);
        writeln!(text, r#"{{"draw":{{{patches}{with},{instances}}}}}"#).unwrap();
    }
    text + "{\"end\":{}}\n"
}

fn is(counters: &Counters, known: &[(C, u64)]) {
    for &(counter, value) in known {
        assert_eq!(counters.get(counter), value, "{counter:?}");
    }
}

#[test]
fn a_static_mesh_crosses_once_and_is_read_by_every_instance() {
    let settings = ["triangles.residency=static", "triangles.level=2"];
    let report = counted(&frames(3, false), &settings);
    // 9 vertices of 32 bytes, 8 triangles of 3 indices of 2 bytes: 288 + 48. Frame, upload, draw:
    // 136, 8 + 336, 8 + 2 x 64, each in packets of at most 256 with headers of 24.
    let every = [
        (C::LinkMatrices, 4 * 64),
        (C::LinkControlPoints, 0),
        (C::MemoryReadVertices, 2 * 288),
        (C::MemoryReadIndices, 2 * 48),
        (C::MemoryMeshesPeak, 336),
        (C::EmitVertices, 18),
        (C::EmitTriangles, 16),
        (C::VertexCacheIndices, 48),
        (C::VertexCacheBatches, 2),
        (C::VertexCacheMisses, 18),
        (C::VertexCacheHits, 30),
        (C::VertexShaderBytesIn, 18 * 24),
    ];
    let first = [
        (C::LinkCommands, 3 * 8),
        (C::LinkVertices, 288),
        (C::LinkIndices, 48),
        (C::LinkTotal, 136 + 344 + 136 + 4 * 24),
        (C::MemoryWrittenVertices, 288),
        (C::MemoryWrittenIndices, 48),
        // Each instance: a burst of 32 a vertex, two of indices; the upload as many.
        (C::MemoryBursts, 3 * (9 + 2)),
        (C::MemoryWasted, 3 * 16),
    ];
    let later = [
        (C::LinkCommands, 2 * 8),
        (C::LinkVertices, 0),
        (C::LinkIndices, 0),
        (C::LinkTotal, 136 + 136 + 2 * 24),
        (C::MemoryWrittenVertices, 0),
        (C::MemoryBursts, 2 * (9 + 2)),
    ];
    for (number, frame) in report.frames.iter().enumerate() {
        is(&frame.counters, &every);
        is(&frame.counters, if number == 0 { &first } else { &later });
    }
    // Replaced points are another mesh, in the place of the first.
    let twice = frames(1, false) + &frames(1, false);
    let twice = twice.replace("{\"end\":{}}\n{\"tessim\":1}\n", "");
    let report = counted(&twice, &settings);
    assert_eq!(report.frames.len(), 2);
    for frame in &report.frames {
        is(&frame.counters, &[(C::LinkVertices, 288), (C::MemoryMeshesPeak, 336)]);
    }
}

#[test]
fn a_vertex_with_attributes_has_their_bytes() {
    let settings = ["triangles.residency=static", "triangles.level=2"];
    let report = counted(&frames(2, true), &settings);
    // 24 bytes and a colour of 4; in a burst of 32 each, but that those of the boundary, the first
    // eight in the order of use, are not all in the order of the buffer.
    let known = [
        (C::LinkVertices, 9 * 28),
        (C::LinkAttributes, 0),
        (C::MemoryReadVertices, 2 * 2 * 9 * 28),
        // Four components of 4 bytes besides what a bare vertex has.
        (C::VertexShaderBytesIn, 2 * 2 * 9 * (24 + 16)),
    ];
    is(&report.totals(), &known);
}

#[test]
fn a_streamed_draw_is_written_before_a_cache_reads_it() {
    let fixed = ["level.level=2", "triangles.cache.policy=fifo", "triangles.cache.entries=64"];
    let report = counted(&frames(2, false), &fixed);
    let every = [
        (C::LinkVertices, 2 * 288),
        (C::LinkIndices, 2 * 48),
        (C::LinkCommands, 2 * 8),
        // The draw is one command: 8 + 128 + 576 + 96 bytes in four packets.
        (C::LinkTotal, 136 + 24 + 808 + 4 * 24),
        (C::MemoryWrittenVertices, 2 * 288),
        (C::MemoryReadVertices, 2 * 288),
        (C::MemoryWrittenIndices, 2 * 48),
        (C::MemoryReadIndices, 2 * 48),
        (C::MemoryBursts, 2 * (18 + 3)),
        (C::MemoryWasted, 0),
        (C::MemoryMeshesPeak, 672),
        (C::VertexCacheBatches, 1),
    ];
    report.frames.iter().for_each(|frame| is(&frame.counters, &every));
    // Strips of a square of two by two: two rows, or what the stitcher makes of them.
    let strips = counted(&frames(1, false), &[fixed[0], "triangles.topology=strip_restart"]);
    let [indices, strips, bytes] = [C::VertexCacheIndices, C::VertexCacheStrips, C::LinkIndices]
        .map(|counter| strips.total(counter));
    assert!(indices < 48 && strips >= 2 && bytes == 2 * indices, "{indices} in {strips} strips");
}

#[test]
fn short_indices_cut_what_they_do_not_reach() {
    // 16 patches of 129 x 129 vertices: three of them to a batch of at most 65536.
    let teaspoon = crate::runs::shipped("teaspoon");
    let level = ["level.level=128", "level.max_level=128"];
    let streamed = |width: &str| {
        let width = format!("triangles.index={width}");
        let settings = [level[0], level[1], &width, "clip.enabled=false", "backface.method=off"];
        counted(&teaspoon, &settings).totals()
    };
    let [auto, short, long] = ["auto", "uint16", "uint32"].map(streamed);
    let indices = 16 * 3 * 32768;
    is(&auto, &[(C::LinkIndices, 4 * indices), (C::VertexCacheBatches, 1)]);
    is(&long, &[(C::LinkIndices, 4 * indices), (C::VertexCacheBatches, 1)]);
    is(&short, &[(C::LinkIndices, 2 * indices), (C::VertexCacheBatches, 6)]);
    let [vertices, commands] =
        [C::LinkVertices, C::LinkCommands].map(|c| [auto.get(c), short.get(c)]);
    assert_eq!(vertices[0], vertices[1], "no vertex is in two batches");
    assert_eq!(commands[1], commands[0] + 5 * 8);
    let resident = counted(
        &teaspoon,
        &["triangles.residency=static", "triangles.level=128", "triangles.index=uint16"],
    );
    let known = [
        (C::VertexCacheBatches, 6),
        (C::LinkIndices, 2 * indices),
        (C::LinkVertices, 16 * 16641 * 32),
        (C::LinkCommands, 3 * 8 + 5 * 8),
    ];
    is(&resident.totals(), &known);
}
