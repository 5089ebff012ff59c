//! Small pictures of shipped traces against those that are kept.
//!
//! Adapters round differently, and smooth edges move by a sample: so a mean, a share and a greatest
//! difference are tolerated that no eye sees. A light that moved, other colours and a triangle that
//! is missing are far beyond them.

use super::support::{device, look, path, picture, shot};
use std::fs;
use std::path::{Path, PathBuf};
use tessim::gpu::render::{Facet, Image, Look, Paint, Scale, draw};
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
    let file = place(name);
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        return save(&drawn, &file);
    }
    let kept = load(&file);
    println!("{name}: {:?}", Difference::between(&kept, &drawn));
    if Difference::between(&kept, &drawn).is_visible() {
        let place = std::env::temp_dir().join(format!("tessim-{name}-difference.png"));
        let bytes = kept.rgb.iter().zip(&drawn.rgb);
        let loud = bytes.map(|(a, b)| 255 - a.abs_diff(*b).saturating_mul(4)).collect();
        save(&Image { size: SIZE, rgb: loud }, &place);
        let difference = Difference::between(&kept, &drawn);
        panic!("{name} is not as kept: {difference:?}; {} shows where", place.display());
    }
}

/// How far two pictures of one size are apart.
#[derive(Debug)]
struct Difference {
    /// Of a channel.
    mean: f64,
    /// Of any channel.
    greatest: u8,
    /// Pixels.
    visible: usize,
    /// All of them.
    pixels: usize,
}

impl Difference {
    fn between(kept: &Image, drawn: &Image) -> Self {
        assert_eq!(kept.size, drawn.size);
        let bytes = kept.rgb.iter().zip(&drawn.rgb);
        let apart: Vec<u8> = bytes.map(|(kept, drawn)| kept.abs_diff(*drawn)).collect();
        let sum: u64 = apart.iter().map(|d| u64::from(*d)).sum();
        Self {
            mean: sum as f64 / apart.len() as f64,
            greatest: apart.iter().copied().max().unwrap(),
            visible: apart.chunks(3).filter(|d| d.iter().any(|d| *d > VISIBLE)).count(),
            pixels: apart.len() / 3,
        }
    }

    fn is_visible(&self) -> bool {
        self.mean > MEAN || self.greatest > GREATEST || 1000 * self.visible > FEW * self.pixels
    }
}

/// The tolerance hides nothing that matters: what is broken on purpose is seen.
#[test]
fn moved_lamps_other_colours_and_missing_triangles_are_seen() {
    let Some(device) = device() else { return };
    let seen = |what: &str, kept: &Image, facets: &[Facet], look: &Look| {
        let difference =
            Difference::between(kept, &draw(device, facets, look, SIZE, None).unwrap());
        println!("{what}: {difference:?}");
        assert!(difference.is_visible(), "{what}: {difference:?}");
    };
    let cup = shot("teacup", 0, &[]);
    let (kept, mut facets) = (load(&place("teacup-shaded")), cup.facets(Style::Shaded, SIZE));
    let shaded = look(&cup, Style::Shaded, SIZE);
    assert!(
        !Difference::between(&kept, &draw(device, &facets, &shaded, SIZE, None).unwrap())
            .is_visible()
    );
    // Normals that turn by 10 degrees about the upward axis are lamps that turn the other way.
    let (sin, cos) = 10_f32.to_radians().sin_cos();
    for corner in facets.iter_mut().flatten() {
        let [x, y, z] = corner.normal;
        corner.normal = [cos * x + sin * z, y, cos * z - sin * x];
    }
    seen("lamps", &kept, &facets, &shaded);

    let pot = shot("teapot", 0, &[]);
    let (kept, facets) = (load(&place("teapot-level")), pot.facets(Style::Level, SIZE));
    let map = look(&pot, Style::Level, SIZE);
    let Paint::Map(scale) = map.paint else { panic!("levels are a heat map") };
    let longer =
        Paint::Map(Scale { most: scale.least + 1.1 * (scale.most - scale.least), ..scale });
    seen("colours", &kept, &facets, &Look { paint: longer, ..map });

    let coarse = shot("teapot", 0, &[FIXED, COARSE]);
    let (kept, facets) = (load(&place("teapot-wireframe")), coarse.facets(Style::Wireframe, SIZE));
    let wires = look(&coarse, Style::Wireframe, SIZE);
    // The one that is nearest to the middle of the body, on the front.
    let seen_from = |facet: &Facet| facet.iter().map(|c| c.place[2]).sum::<f32>();
    let middle = |facet: &Facet| {
        let at = |k: usize| facet.iter().map(|c| c.place[k]).sum::<f32>() / 9.0; // in pixels
        (at(0) - 60.0).hypot(at(1) - 72.0)
    };
    let near = facets.iter().enumerate().filter(|(_, facet)| middle(facet) < 12.0);
    let first = near.min_by(|a, b| seen_from(a.1).total_cmp(&seen_from(b.1))).unwrap().0;
    let rest = [&facets[..first], &facets[first + 1..]].concat();
    seen("a triangle", &kept, &rest, &wires);
}

fn place(name: &str) -> PathBuf {
    path("tests/render").join(format!("{name}.png"))
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
