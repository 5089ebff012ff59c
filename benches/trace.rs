//! How fast a trace is read: bytes of its text a second over long lines of points, over draws with
//! many instances, and over lines as short as the format has; and how fast the same trace in the
//! binary form, still by the bytes of its text, so that the two compare.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use tessim::trace::binary;
use tessim::trace::command::Tessellation;
use tessim::trace::read::Reader;
use tessim::trace::scene::grid::Grid;
use tessim::trace::scene::teacups::Teacups;

/// The same trace in the binary form.
fn blocks(text: &[u8]) -> Vec<u8> {
    let mut writer = binary::write::Writer::new(Vec::new()).expect("a compressor");
    for located in Reader::new(text, "bench.jsonl", ".") {
        let command = located.expect("the trace is well-formed").command;
        writer.write(&command).expect("memory takes all");
    }
    writer.into_inner()
}

fn read(criterion: &mut Criterion) {
    let tessellation = Tessellation::default();
    let mut points = Vec::new();
    let grid = Grid { rows: 128, columns: 128, tessellation };
    grid.write(&mut points).expect("memory takes all");
    let mut instances = Vec::new();
    let teacups = Teacups { count: 100, frames: 100, tessellation };
    teacups.write(&mut instances).expect("memory takes all");
    let short = "{\"tessim\":1}\n".to_string()
        + &"{\"tessellation\":{\"criterion\":\"fixed\",\"level\":4}}\n".repeat(20_000)
        + "{\"end\":{}}\n";
    let mut group = criterion.benchmark_group("read");
    group.sample_size(20);
    for (name, text) in
        [("points", points), ("instances", instances), ("short lines", short.into_bytes())]
    {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                for command in Reader::new(&text[..], "bench.jsonl", ".") {
                    black_box(command.expect("the trace is well-formed"));
                }
            });
        });
        let blocks = blocks(&text);
        println!("{name}: {} bytes of text, {} in the binary form", text.len(), blocks.len());
        group.bench_function(format!("{name}, binary"), |b| {
            b.iter(|| {
                for command in binary::read::Reader::new(&blocks[..], "bench.tsb", ".") {
                    black_box(command.expect("the trace is well-formed"));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
