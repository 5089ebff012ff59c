//! A picture: samples in, averaged in linear light; pixels out, in sRGB.

use super::SAMPLES;
use std::sync::LazyLock;

/// Linear light at full strength. Sums of 9 of them fit 32 bits.
const FULL: f64 = 65_535.0;

/// Steps of linear light that are told apart on the way back: finer than sRGB's darkest step.
const STEPS: u32 = 1 << 13;

/// Rows of pixels, three bytes each, in sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green and blue, row by row from the top.
    pub rgb: Vec<u8>,
}

impl Image {
    /// A picture of one colour.
    #[must_use]
    pub fn filled(size: [u32; 2], colour: [u8; 3]) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, rgb: colour.repeat(pixels) }
    }

    /// The colour of a pixel.
    ///
    /// # Panics
    /// When it is outside.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let at = 3 * (y as usize * self.size[0] as usize + x as usize);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Averages a tile's samples (rows of `row` bytes, four bytes a sample) into the pixels from
    /// `at` on, as far as they are in the picture.
    pub(super) fn paste(&mut self, samples: &[u8], row: usize, at: [u32; 2], tile: [u32; 2]) {
        let [width, height] = [0, 1].map(|k| tile[k].min(self.size[k] - at[k]));
        for y in 0..height {
            let first = 3 * ((at[1] + y) as usize * self.size[0] as usize + at[0] as usize);
            let line = &mut self.rgb[first..first + 3 * width as usize];
            for (x, pixel) in line.chunks_exact_mut(3).enumerate() {
                let corner = (y * SAMPLES) as usize * row + 4 * x * SAMPLES as usize;
                pixel.copy_from_slice(&average(samples, corner, row));
            }
        }
    }
}

/// The pixel whose samples begin at `corner`.
fn average(samples: &[u8], corner: usize, row: usize) -> [u8; 3] {
    let side = SAMPLES as usize;
    let places = (0..side).flat_map(|y| (0..side).map(move |x| corner + y * row + 4 * x));
    let mut sum = [0_u32; 3];
    for place in places {
        for (sum, byte) in sum.iter_mut().zip(&samples[place..place + 3]) {
            *sum += u32::from(LINEAR[usize::from(*byte)]);
        }
    }
    sum.map(|sum| {
        let mean = f64::from(sum) / f64::from(SAMPLES * SAMPLES) / FULL;
        CODED[(mean * f64::from(STEPS)).round() as usize]
    })
}

/// Linear light of each byte of sRGB (IEC 61966-2-1).
static LINEAR: LazyLock<[u16; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let coded = byte as f64 / 255.0;
        let linear =
            if coded <= 0.04045 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) };
        (linear * FULL).round() as u16
    })
});

/// The byte of each step of linear light.
static CODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let step = |step: u32| {
        let linear = f64::from(step) / f64::from(STEPS);
        let coded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * coded).round() as u8
    };
    (0..=STEPS).map(step).collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_of_one_colour_keeps_it_whatever_that_is() {
        for byte in 0..=255 {
            let samples = [byte; 36];
            assert_eq!(average(&samples, 0, 12), [byte; 3]);
        }
    }

    #[test]
    fn samples_are_averaged_as_light_and_land_at_their_place() {
        // Black and white by halves of light: brighter than the middle byte.
        let mut samples = vec![0; 2 * 3 * 4 * 3];
        let row = 24;
        for y in 0..3 {
            for x in 3..6 {
                samples[y * row + 4 * x..][..3].fill(255);
            }
        }
        samples[4..7].fill(255); // one of nine
        let mut image = Image::filled([4, 2], [9; 3]);
        image.paste(&samples, row, [1, 1], [2, 1]);
        assert_eq!(image.pixel(1, 1), [94; 3]); // (1/9)^(1/2.4) in sRGB: 0.3674
        assert_eq!(image.pixel(2, 1), [255; 3]);
        assert_eq!(
            (image.pixel(0, 1), image.pixel(3, 1), image.pixel(1, 0)),
            ([9; 3], [9; 3], [9; 3])
        );
        // What is beyond the edge is left out.
        image.paste(&samples, row, [3, 0], [2, 1]);
        assert_eq!(image.pixel(3, 0), [94; 3]);
        assert_eq!(image.pixel(0, 1), [9; 3]);
    }
}
