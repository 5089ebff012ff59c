//! PNG: pixels in, framed with what they show, set side by side, and written.
//!
//! A legend stands under its picture: what of, how many, and for a heat map the bar of its colours
//! with ticks. Letters are DejaVu Sans's, so that a picture looks the same on every machine.

mod canvas;
mod legend;

pub use canvas::Canvas;
pub use legend::{Bar, Legend, grouped, ticks};

use std::io::{self, Write};

/// Writes a canvas as PNG: eight bits of red, green and blue, sRGB.
///
/// # Errors
/// Those of `out`.
pub fn write(canvas: &Canvas, out: &mut dyn Write) -> io::Result<()> {
    let [width, height] = canvas.size();
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().map_err(io::Error::from)?;
    writer.write_image_data(canvas.rgb()).map_err(io::Error::from)?;
    writer.finish().map_err(io::Error::from)
}
