//! Teacups: cups on a plane in, a walk among them out, one frame after another.
//!
//! Cups stand about three units apart; the eye walks from the front row towards
//! the middle and sways a little, so that cups are seen large and small, and some are passed.

use super::super::command::Tessellation;
use super::crowd::{Crowd, Model};
use super::newell::Newell;
use std::io::{self, Write};

/// Between neighbours; a saucer is 2 across.
const SPACING: f64 = 3.0;

/// A walk among teacups.
#[derive(Clone, Copy, Debug)]
pub struct Teacups {
    /// Cups, 26 patches each; at least 1.
    pub count: u32,
    /// Frames.
    pub frames: u32,
    /// How finely they are tessellated.
    pub tessellation: Tessellation,
}

impl Teacups {
    /// Writes the trace.
    ///
    /// # Errors
    /// Those of the output.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let crowd = Crowd { count: self.count, spacing: SPACING, y_up: true };
        let cup = Newell::Teacup;
        let model = Model {
            plural: "teacups",
            source: cup.source().into(),
            licence: cup.licence().into(),
            points: cup.points(),
            reversed: cup.faces_inward(),
        };
        crowd.write(model, self.tessellation, self.frames, out)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::command::Command;
    use super::super::super::read::Reader;
    use super::*;

    #[test]
    fn a_hundred_cups_are_2600_patches_a_frame() {
        let mut text = Vec::new();
        let scene = Teacups { count: 100, frames: 3, tessellation: Tessellation::default() };
        scene.write(&mut text).unwrap();
        let (mut frames, mut patches) = (0, 0);
        for located in Reader::new(&text[..], "teacups.jsonl", ".") {
            match located.unwrap().command {
                Command::Frame(_) => frames += 1,
                Command::Draw(d) => patches += d.models.len() as u64 * d.primitive.patches(),
                _ => {}
            }
        }
        assert_eq!((frames, patches), (3, 3 * 2600));
    }
}
