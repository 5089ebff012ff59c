//! Scenes whose numbers are known by hand.

use super::{Numbers, compared, config};
use std::fmt::Write;
use tessim::config::{Criterion, Engine, Unit};

/// A flat square patch over part of a viewport of 64 by 32 pixels, drawn as many times: from the
/// left edge as far as `right` of the width, over the whole height.
fn square(right: f32, times: usize, reversed: bool) -> String {
    let identity = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
    let corner = |k: usize, size: f32| -1.0 + size * k as f32 / 3.0;
    let point = |k: usize| format!("[{},{},0.5]", corner(k % 4, 2.0 * right), corner(k / 4, 2.0));
    let points: Vec<String> = (0..16).map(point).collect();
    let front = if reversed { ",\"front\":\"reversed\"" } else { "" };
    let mut text = format!(
        "{{\"tessim\":1}}\n{{\"frame\":{{\"viewport\":[64,32],\"view\":{identity},\
         \"projection\":{identity},\"range\":{{\"clip\":1}}}}}}\n{{\"points\":{{\"id\":0,\
         \"xyz\":[{}]}}}}\n",
        points.join(",")
    );
    let patch = "\"primitive\":\"patches\",\"points\":0,\"count\":1";
    for _ in 0..times {
        writeln!(text, "{{\"draw\":{{{patch},\"cull\":false{front}}}}}").unwrap();
    }
    text + "{\"end\":{}}\n"
}

fn numbers(text: &str, unit: Unit, level: f64) -> Numbers {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.jsonl");
    std::fs::write(&path, text).unwrap();
    let mut config = config(unit, Engine::None);
    config.level.pixels = None;
    (config.level.criterion, config.level.level) = (Some(Criterion::Fixed), Some(level));
    Numbers::of(&compared(&path, &[config], 5)[0])
}

#[test]
fn a_square_over_the_whole_viewport_covers_every_pixel_once() {
    for unit in Unit::ALL {
        for reversed in [false, true] {
            let numbers = numbers(&square(1.0, 1, reversed), unit, 4.0);
            let screen = |name: &str| numbers.count("screen", name);
            assert_eq!([screen("pixels"), screen("samples")], [64 * 32; 2], "{}", unit.name());
            let [front, back] = ["triangles.front", "triangles.back"].map(screen);
            let all = numbers.count("emit", "triangles");
            // x to the right, y up, z away from the viewer: Su x Sv points away.
            let expected = if reversed { [all, 0] } else { [0, all] };
            assert_eq!([front, back], expected, "{}", unit.name());
            // Flat, and on the sub-pixel grid to the half of its step.
            assert!(numbers.real("error", "largest") < 0.01, "{}", unit.name());
        }
    }
}

#[test]
fn half_a_square_drawn_three_times_covers_half_of_it_three_times() {
    let numbers = numbers(&square(0.5, 3, false), Unit::Hybrid, 2.0);
    let screen = |name: &str| numbers.count("screen", name);
    assert_eq!([screen("pixels"), screen("samples")], [32 * 32, 3 * 32 * 32]);
    assert_eq!(numbers.real("screen", "samples_per_pixel"), 3.0);
    // 8 triangles of 16 by 16 pixels each, half a square: 128 square pixels.
    assert_eq!(screen("area.from.64"), 24);
    assert_eq!(numbers.real("screen", "triangles_per_pixel"), 24.0 / 1024.0);
    // Beside a diagonal of 16 pixels 8 quads are shaded twice.
    assert_eq!(screen("quads"), 3 * (16 * 16 + 4 * 8));
}
