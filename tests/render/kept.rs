//! Small pictures of shipped traces against those that are kept.
//!
//! Adapters round differently, and smooth edges move by a sample: so a mean, a share and a greatest
//! difference are tolerated that no eye sees. A light that moved, other colours and a triangle that
//! is missing are far beyond them.

use super::support::{device, path, picture, shot};
use std::fs;
use std::path::Path;
use tessim::gpu::render::Image;
use tessim::output::picture::{Canvas, write};
use tessim::study::picture::Style;

/// The mean difference of a channel, of 255.
const MEAN: f64 = 0.4;

/// What few pixels differ by more than in any channel, and how many of a thousand those are.
const VISIBLE: u8 = 24;
const FEW: usize = 2;

/// Of a byte, the greatest difference of all: an edge's sample of nine, twice.
const GREATEST: u8 = 90;

const SIZE: [u32; 2] = [160, 128];

/// Few large triangles, so that one that is missing is seen.
const COARSE: &str = "level.level=3";
const FIXED: &str = "level.criterion=fixed";

#[test]
fn shaded() {
    check("teacup-shaded", "teacup", Style::Shaded, &[]);
}

#[test]
fn wireframe() {
    check("teapot-wireframe", "teapot", Style::Wireframe, &[FIXED, COARSE]);
}

#[test]
fn level() {
    check("teapot-level", "teapot", Style::Level, &[]);
}

#[test]
fn error() {
    check("teaspoon-error", "teaspoon", Style::Error, &[FIXED, COARSE]);
}

#[test]
fn area() {
    check("rational-area", "rational", Style::Area, &["unit=d3d11"]);
}

#[test]
fn before_transform() {
    check("teacup-moreton", "teacup", Style::Wireframe, &["unit=moreton", FIXED, COARSE]);
}

/// Draws a shipped trace and compares it to the picture of this name.
fn check(name: &str, trace: &str, style: Style, settings: &[&str]) {
    let Some(device) = device() else { return };
    let drawn = picture(device, &shot(trace, 0, settings), style, SIZE);
    let file = path("tests/render").join(format!("{name}.png"));
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        return save(&drawn, &file);
    }
    let kept = load(&file);
    assert_eq!(kept.size, drawn.size);
    let differences: Vec<u8> =
        kept.rgb.iter().zip(&drawn.rgb).map(|(kept, drawn)| kept.abs_diff(*drawn)).collect();
    let sum: u64 = differences.iter().map(|d| u64::from(*d)).sum();
    let mean = sum as f64 / differences.len() as f64;
    let greatest = differences.iter().copied().max().unwrap();
    let visible = differences.chunks(3).filter(|d| d.iter().any(|d| *d > VISIBLE)).count();
    let pixels = differences.len() / 3;
    println!("{name}: mean {mean:.4}, greatest {greatest}, {visible} of {pixels} pixels visible");
    if mean > MEAN || greatest > GREATEST || 1000 * visible > FEW * pixels {
        let place = std::env::temp_dir().join(format!("tessim-{name}-difference.png"));
        let loud = differences.iter().map(|d| 255 - d.saturating_mul(4)).collect();
        save(&Image { size: SIZE, rgb: loud }, &place);
        panic!(
            "{name} is not as kept: mean {mean:.3}, greatest {greatest}, {visible} of {pixels} \
             pixels visible; the difference is in {}",
            place.display()
        );
    }
}

fn save(image: &Image, path: &Path) {
    let mut png = Vec::new();
    write(&Canvas::of(image.size, image.rgb.clone()), &mut png).unwrap();
    fs::write(path, png).unwrap();
}

/// Reads a picture that was kept.
fn load(path: &Path) -> Image {
    let file = fs::File::open(path).unwrap_or_else(|error| {
        panic!("{}: {error}; UPDATE_EXPECT=1 draws it", path.display());
    });
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgb).unwrap();
    rgb.truncate(info.buffer_size());
    Image { size: [info.width, info.height], rgb }
}
