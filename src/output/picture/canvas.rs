//! Pixels that rectangles, pictures and letters are laid on.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use std::sync::LazyLock;

/// Letters: DejaVu Sans, of Bitstream Vera, free to use and embed.
static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(dejavu::sans::regular()).expect("the font that is built in is one")
});

/// A picture under construction, white at first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    size: [u32; 2],
    rgb: Vec<u8>,
}

impl Canvas {
    /// An empty one of this width and height.
    #[must_use]
    pub fn new(size: [u32; 2]) -> Self {
        Self::of(size, vec![u8::MAX; 3 * size[0] as usize * size[1] as usize])
    }

    /// Of these pixels, three bytes each, row by row.
    ///
    /// # Panics
    /// When they are not as many.
    #[must_use]
    pub fn of(size: [u32; 2], rgb: Vec<u8>) -> Self {
        assert_eq!(rgb.len(), 3 * size[0] as usize * size[1] as usize, "three bytes a pixel");
        Self { size, rgb }
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Three bytes a pixel, row by row.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Fills a rectangle, as far as it is inside.
    pub fn fill(&mut self, at: [u32; 2], size: [u32; 2], colour: [u8; 3]) {
        for y in at[1]..(at[1] + size[1]).min(self.size[1]) {
            for x in at[0]..(at[0] + size[0]).min(self.size[0]) {
                self.set(x, y, colour);
            }
        }
    }

    /// Lays another picture on this one, which has room for it.
    ///
    /// # Panics
    /// When it has not.
    pub fn paste(&mut self, other: &Self, at: [u32; 2]) {
        assert!((0..2).all(|k| at[k] + other.size[k] <= self.size[k]), "the picture fits");
        let bytes = 3 * other.size[0] as usize;
        if bytes == 0 {
            return;
        }
        for (y, row) in other.rgb.chunks_exact(bytes).enumerate() {
            let first = 3 * ((at[1] as usize + y) * self.size[0] as usize + at[0] as usize);
            self.rgb[first..first + bytes].copy_from_slice(row);
        }
    }

    /// Writes a line whose letters are `height` pixels high, its upper left corner at `at`.
    pub fn text(&mut self, at: [f32; 2], height: f32, colour: [u8; 3], text: &str) {
        let font = FONT.as_scaled(PxScale::from(height));
        let mut pen = at[0];
        let mut last = None;
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            pen += last.map_or(0.0, |last| font.kern(last, id));
            let glyph = id.with_scale_and_position(height, point(pen, at[1] + font.ascent()));
            if let Some(outline) = font.outline_glyph(glyph) {
                let bounds = outline.px_bounds();
                outline.draw(|x, y, cover| {
                    let place =
                        [bounds.min.x as i64 + i64::from(x), bounds.min.y as i64 + i64::from(y)];
                    self.blend(place, colour, cover);
                });
            }
            pen += font.h_advance(id);
            last = Some(id);
        }
    }

    fn blend(&mut self, [x, y]: [i64; 2], colour: [u8; 3], cover: f32) {
        let inside = |at: i64, size: u32| u32::try_from(at).ok().filter(|at| *at < size);
        let (Some(x), Some(y)) = (inside(x, self.size[0]), inside(y, self.size[1])) else { return };
        let first = self.first(x, y);
        for (byte, ink) in self.rgb[first..first + 3].iter_mut().zip(colour) {
            let under = f32::from(*byte);
            *byte = (under + (f32::from(ink) - under) * cover.clamp(0.0, 1.0)).round() as u8;
        }
    }

    fn set(&mut self, x: u32, y: u32, colour: [u8; 3]) {
        let first = self.first(x, y);
        self.rgb[first..first + 3].copy_from_slice(&colour);
    }

    fn first(&self, x: u32, y: u32) -> usize {
        3 * (y as usize * self.size[0] as usize + x as usize)
    }
}

/// How wide a line is.
#[must_use]
pub(super) fn width(height: f32, text: &str) -> f32 {
    let font = FONT.as_scaled(PxScale::from(height));
    let mut last = None;
    let advance = |letter: char| {
        let id = font.glyph_id(letter);
        let kern = last.replace(id).map_or(0.0, |last| font.kern(last, id));
        kern + font.h_advance(id)
    };
    text.chars().map(advance).sum()
}

/// The line, or as much of it as is so wide at most, and three dots.
#[must_use]
pub(super) fn fitted(height: f32, text: &str, most: f32) -> String {
    if width(height, text) <= most {
        return text.to_owned();
    }
    let mut cut: String = text.to_owned();
    while cut.pop().is_some() {
        let dotted = format!("{}\u{2026}", cut.trim_end());
        if width(height, &dotted) <= most {
            return dotted;
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_where_they_are_asked_for_and_are_as_wide_as_said() {
        let mut canvas = Canvas::new([200, 40]);
        canvas.text([20.0, 10.0], 16.0, [0, 0, 0], "Hl\u{221a}");
        let dark = |x: u32, y: u32| canvas.rgb()[canvas.first(x, y)] < 128;
        let columns: Vec<u32> = (0..200).filter(|&x| (0..40).any(|y| dark(x, y))).collect();
        let wide = width(16.0, "Hl\u{221a}");
        assert!(columns[0] >= 20 && *columns.last().unwrap() <= 20 + wide as u32);
        assert!(columns.len() > 8, "{columns:?}");
        let rows: Vec<u32> = (0..40).filter(|&y| (0..200).any(|x| dark(x, y))).collect();
        assert!(rows[0] >= 10 && *rows.last().unwrap() <= 26, "{rows:?}");
        // Nothing is drawn outside, and nothing fails there.
        canvas.text([190.0, 35.0], 16.0, [0, 0, 0], "long");
        canvas.text([-90.0, -35.0], 16.0, [0, 0, 0], "long");
    }

    #[test]
    fn a_line_that_is_too_long_ends_in_dots() {
        let text = "a rather long title";
        assert_eq!(fitted(12.0, text, 1e3), text);
        let cut = fitted(12.0, text, 60.0);
        assert!(cut.ends_with('\u{2026}') && width(12.0, &cut) <= 60.0 && cut.starts_with("a r"));
        assert_eq!(fitted(12.0, text, 1.0), "");
    }

    #[test]
    fn pictures_lie_where_they_are_pasted() {
        let mut canvas = Canvas::new([4, 3]);
        canvas.paste(&Canvas::of([2, 1], vec![1, 2, 3, 4, 5, 6]), [1, 2]);
        canvas.fill([3, 0], [9, 1], [7; 3]);
        assert_eq!(canvas.rgb()[9..12], [7; 3]);
        assert_eq!(canvas.rgb()[27..33], [1, 2, 3, 4, 5, 6]);
        assert_eq!(canvas.rgb()[..9], [255; 9]);
    }
}
