//! Pictures: triangles of a frame in, pixels out, drawn off screen by the device's own rasteriser.
//!
//! In come facets ([`Facet`]), already in pixels ([`Lens`] takes them there from clip space); out
//! comes an [`Image`]. Nobody compares these to the bit with anything, so floats are allowed. What
//! is compared: a picture drawn tile by tile is the one drawn at once. So corners lie on a grid
//! that no tile's offset can round away, and the shader interpolates by itself, from coordinates
//! of the whole picture.
//!
//! Edges are smoothed by samples on a square grid, [`SAMPLES`] a side, averaged in linear light.

mod image;
mod lens;
mod look;
mod target;

pub use image::Image;
pub use lens::{Clipped, Facet, Lens, Point};
pub use look::{Look, Paint, Scale, colour};

use super::device::Device;
use crate::error::{Error, Result};
use target::Target;

/// Samples of a pixel along either axis.
pub const SAMPLES: u32 = 3;

/// Pixels of a picture along either axis, at most.
pub const SIZE_MAX: u32 = 16_384;

/// Pixels of a tile's side where nothing else is asked for: 38 MB of colours, as much of depths.
const TILE: u32 = 1024;

/// Draws facets into a picture of `size` pixels, in tiles of at most `tile` pixels a side.
///
/// # Errors
/// [`Error::Usage`] for a size of 0 or above [`SIZE_MAX`], [`Error::Device`] where the device
/// fails.
pub fn draw(
    device: &Device,
    facets: &[Facet],
    look: &Look,
    size: [u32; 2],
    tile: Option<u32>,
) -> Result<Image> {
    if size.iter().any(|side| !(1..=SIZE_MAX).contains(side)) {
        let [width, height] = size;
        return Err(Error::Usage(format!(
            "a picture of {width}x{height}: expected 1 to {SIZE_MAX} pixels a side"
        )));
    }
    let most = (target::texture_max(device) / SAMPLES).max(1);
    let side = tile.unwrap_or(TILE).clamp(1, most);
    let target = Target::new(device, look, size.map(|s| s.min(side)))?;
    let batches = target.upload(facets)?;
    let mut image = Image::filled(size, look.background);
    for y in (0..size[1]).step_by(side as usize) {
        for x in (0..size[0]).step_by(side as usize) {
            let samples = target.draw(&batches, [x, y])?;
            image.paste(&samples, target.row(), [x, y], target.size());
        }
    }
    Ok(image)
}
