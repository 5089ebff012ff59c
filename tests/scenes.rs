//! The traces that ship are what the scenes write, to the byte; every scene reads back as a whole
//! trace.
//!
//! `UPDATE_EXPECT=1 cargo test --test scenes` writes the shipped traces anew.

use rtl_model::level::Criterion;
use rtl_model::patch::Level;
use std::path::PathBuf;
use tessim::trace::command::{Command, Primitive, Tessellation};
use tessim::trace::read::Reader;
use tessim::trace::scene::elephants::Elephants;
use tessim::trace::scene::grid::Grid;
use tessim::trace::scene::mesh::Mesh;
use tessim::trace::scene::model::Model;
use tessim::trace::scene::motion::{Kind as Moving, Motion};
use tessim::trace::scene::newell::Newell;
use tessim::trace::scene::primitives::{Kind, Primitives};
use tessim::trace::scene::rational::Rational;
use tessim::trace::scene::teacups::Teacups;
use tessim::trace::write::Writer;

fn shipped(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("traces").join(name)
}

fn model(model: Newell) -> Vec<u8> {
    let mut text = Vec::new();
    let scene = Model { model, tessellation: Tessellation::default() };
    scene.write(&mut text).expect("memory takes all");
    text
}

fn primitives(kind: Kind) -> Vec<u8> {
    let mut text = Vec::new();
    let scene = Primitives { kind, tessellation: Tessellation::default() };
    scene.write(&mut text).expect("memory takes all");
    text
}

fn motion(kind: Moving, frames: u32) -> Vec<u8> {
    let mut text = Vec::new();
    let scene = Motion { kind, frames, tessellation: Tessellation::default() };
    scene.write(&mut text).expect("memory takes all");
    text
}

/// Frames and patches of a trace, which must be whole and survive writing.
fn totals(text: &[u8]) -> (u64, u64) {
    let (mut frames, mut patches) = (0, 0);
    let mut writer = Writer::new(Vec::new());
    for located in Reader::new(text, "scene.jsonl", ".") {
        let command = located.expect("a scene is a whole trace").command;
        writer.write(&command).expect("memory takes all");
        match command {
            Command::Frame(_) => frames += 1,
            Command::Draw(d) => patches += d.primitive.patches() * d.models.len() as u64,
            _ => {}
        }
    }
    assert!(writer.into_inner() == text, "writing what was read gives other bytes");
    (frames, patches)
}

#[test]
fn shipped_traces_are_what_the_scenes_write() {
    let mut mesh = Vec::new();
    Mesh.write(&mut mesh).unwrap();
    let mut rational = Vec::new();
    Rational { tessellation: Tessellation::default() }.write(&mut rational).unwrap();
    let expected = [
        ("teapot.jsonl", model(Newell::Teapot), (1, 32)),
        ("teacup.jsonl", model(Newell::Teacup), (1, 26)),
        ("teaspoon.jsonl", model(Newell::Teaspoon), (1, 16)),
        ("mesh.jsonl", mesh, (2, 96)),
        ("rational.jsonl", rational, (1, 24)),
        ("strip.jsonl", primitives(Kind::Ribbon), (1, 12)),
        ("fan.jsonl", primitives(Kind::Domes), (1, 16)),
        ("indexed.jsonl", primitives(Kind::Rings), (1, 96)),
        ("zoom.jsonl", motion(Moving::Zoom, 8), (8, 8 * 32)),
    ];
    for (name, text, counts) in expected {
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            std::fs::write(shipped(name), &text).unwrap();
        }
        assert_eq!(totals(&text), counts, "{name}");
        let file = std::fs::read(shipped(name)).unwrap();
        assert!(file == text, "{name} differs from its scene; UPDATE_EXPECT=1 writes it anew");
    }
}

#[test]
fn every_shipped_trace_has_its_line_in_the_readme() {
    let readme = std::fs::read_to_string(shipped("README.md")).unwrap();
    let mut checked = 0;
    for entry in std::fs::read_dir(shipped("")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".jsonl") {
            assert!(readme.contains(&format!("| `{name}` |")), "{name}");
            checked += 1;
        }
    }
    assert!(checked >= 9, "{checked}");
}

#[test]
fn grids_of_any_size_are_whole() {
    for (rows, columns) in [(1, 1), (16, 16), (17, 33), (3, 100)] {
        let mut text = Vec::new();
        Grid { rows, columns, tessellation: Tessellation::default() }.write(&mut text).unwrap();
        assert_eq!(totals(&text), (1, u64::from(rows * columns)));
    }
}

#[test]
fn films_of_any_length_are_whole() {
    for kind in Moving::ALL {
        let patches = if kind == Moving::Flythrough { 48 * 32 } else { 32 };
        for frames in [1, 2, 7, 24] {
            let text = motion(kind, frames);
            let all = u64::from(frames);
            assert_eq!(totals(&text), (all, all * patches), "{}", kind.name());
            let points = text.split(|&b| b == b'\n').filter(|l| l.starts_with(b"{\"points\""));
            assert_eq!(points.count(), 1, "points cross the link once");
        }
    }
}

#[test]
fn meshes_of_a_grid_have_at_most_16_by_16_patches() {
    let mut text = Vec::new();
    Grid { rows: 40, columns: 16, tessellation: Tessellation::default() }.write(&mut text).unwrap();
    let mut sizes = Vec::new();
    for located in Reader::new(&text[..], "grid.jsonl", ".") {
        if let Command::Draw(draw) = located.unwrap().command
            && let Primitive::Mesh { rows, columns } = draw.primitive
        {
            sizes.push((rows, columns));
        }
    }
    assert_eq!(sizes, [(16, 16), (16, 16), (8, 16)]);
}

#[test]
fn teacups_take_a_fixed_level() {
    let criterion = Criterion::Fixed { level: Level::clamped(5 << 15) };
    let tessellation = Tessellation { criterion, ..Tessellation::default() };
    let mut text = Vec::new();
    Teacups { count: 5, frames: 2, tessellation }.write(&mut text).unwrap();
    assert_eq!(totals(&text), (2, 2 * 5 * 26));
    assert!(String::from_utf8(text).unwrap().contains(r#""criterion":"fixed","level":2.5,"#));
}

#[test]
fn elephants_take_a_fixed_level() {
    let criterion = Criterion::Fixed { level: Level::clamped(3 << 16) };
    let tessellation = Tessellation { criterion, ..Tessellation::default() };
    let mut text = Vec::new();
    Elephants { count: 3, frames: 2, tessellation }.write(&mut text).unwrap();
    assert_eq!(totals(&text), (2, 2 * 3 * 811));
    assert!(String::from_utf8(text).unwrap().contains(r#""criterion":"fixed","level":3,"#));
}
