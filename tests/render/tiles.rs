//! Tiles, batches of triangles, and sizes: none changes more than a sample at a seam.

use super::support::{device, look, shot};
use tessim::gpu::render::draw;
use tessim::gpu::{Backend, Device, Sources};
use tessim::study::picture::{STYLES, Shot, Style};

#[test]
fn a_picture_in_tiles_is_the_one_drawn_at_once_but_for_a_sample_or_two() {
    let Some(device) = device() else { return };
    let size = [150, 121];
    for (name, unit) in [("teapot", "hybrid"), ("fan", "sfarti"), ("teacup", "moreton")] {
        let shot = shot(name, 0, &[&format!("unit={unit}")]);
        for style in STYLES {
            let [differ, greatest] = differing(device, &shot, style, size);
            assert!(is_a_sample(differ, greatest), "{name} {style:?}: {differ} {greatest}");
        }
    }
}

/// Whether so many bytes, of 163 350 in three pictures, that differ by so much are samples that
/// fall to the other side of a seam: one of the nine of a pixel, of dark on light. A tile that is
/// missing or a pixel off differs in thousands.
fn is_a_sample(differ: usize, greatest: usize) -> bool {
    differ <= 60 && greatest <= 48
}

/// Where triangles reach far beyond a tile, the rasteriser cuts them itself, and may give a sample
/// at a seam to the other side of it: a byte of a heat map may be off by 1.
#[test]
fn what_reaches_out_of_the_picture_is_the_same_but_for_a_few_samples() {
    let Some(device) = device() else { return };
    let shot = shot("zoom", 7, &["unit=esc"]);
    for style in STYLES {
        let [differ, greatest] = differing(device, &shot, style, [150, 121]);
        println!("{style:?}: {differ} bytes differ by at most {greatest}");
        assert!(is_a_sample(differ, greatest), "{style:?}: {differ} {greatest}");
    }
}

/// Bytes that differ from the picture that is drawn at once, and by how much at most.
fn differing(device: &Device, shot: &Shot, style: Style, size: [u32; 2]) -> [usize; 2] {
    let (facets, look) = (shot.facets(style, size), look(shot, style, size));
    let whole = draw(device, &facets, &look, size, None).unwrap();
    let mut differ = [0, 0];
    for tile in [31, 64, 149] {
        let tiled = draw(device, &facets, &look, size, Some(tile)).unwrap();
        for (a, b) in whole.rgb.iter().zip(&tiled.rgb).filter(|(a, b)| a != b) {
            differ = [differ[0] + 1, differ[1].max(usize::from(a.abs_diff(*b)))];
        }
    }
    differ
}

#[test]
fn triangles_in_small_batches_give_the_same_picture() {
    let Ok(mut limited) = Device::open(Backend::Auto, Sources::default()) else { return };
    let Some(device) = device() else { return };
    limited.limit_words(36 * 100);
    let shot = shot("teapot", 0, &[]);
    let size = [96, 77];
    let (facets, look) = (shot.facets(Style::Area, size), look(&shot, Style::Area, size));
    assert!(facets.len() > 1000);
    let [whole, parts] =
        [device, &limited].map(|device| draw(device, &facets, &look, size, None).unwrap());
    assert!(whole == parts);
    assert!(whole.rgb.chunks(3).any(|pixel| pixel != look.background));
}

#[test]
fn large_pictures_are_possible_and_larger_ones_refused() {
    let Some(device) = device() else { return };
    let shot = shot("teacup", 0, &["level.criterion=fixed", "level.level=2"]);
    let look = look(&shot, Style::Shaded, [16_384, 40]);
    let facets = shot.facets(Style::Shaded, [16_384, 40]);
    let wide = draw(device, &facets, &look, [16_384, 40], None).unwrap();
    // In the middle there is the cup, at the ends nothing.
    assert_eq!(wide.pixel(0, 20), look.background);
    assert_eq!(wide.pixel(16_383, 20), look.background);
    assert!((8_100..8_280).any(|x| wide.pixel(x, 20) != look.background));
    for size in [[16_385, 1], [1, 0]] {
        assert_eq!(draw(device, &[], &look, size, None).unwrap_err().exit_code(), 2);
    }
}
