//! Teacups: cups on a plane in, a walk among them out, one frame after another.
//!
//! The cup's points are resident: they cross the link once, and every frame sends the matrices of
//! its instances. Cups stand about three units apart ([`super::crowd`]); the eye walks from the
//! front row towards the middle and sways a little, so that cups are seen large and small, and some
//! are passed.

use super::super::command::{Command, Draw, Header, Points, Primitive, Tessellation};
use super::super::points::PointSource;
use super::super::write::Writer;
use super::crowd::Crowd;
use super::newell::Newell;
use std::io::{self, Write};
use std::sync::Arc;

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
        let points = cup.points();
        let count = points.len() as u64 / 16;
        let draw = Command::Draw(Draw {
            models: (0..self.count).map(|i| crowd.model(i)).collect(),
            models_sent: true,
            reversed: cup.faces_inward(),
            ..Draw::new(Primitive::Patches { count }, 0)
        });
        let mut writer = Writer::new(out);
        writer.write(&Command::Header(Header {
            title: format!("a walk among {} teacups", self.count),
            source: cup.source().into(),
            licence: cup.licence().into(),
        }))?;
        let source = Arc::new(PointSource::Xyz(points));
        writer.write(&Command::Points(Points { id: 0, source, resident: true }))?;
        writer.write(&Command::Tessellation(self.tessellation))?;
        for frame in 0..self.frames {
            writer.write(&Command::Frame(crowd.camera(frame, self.frames).frame()))?;
            writer.write(&draw)?;
        }
        writer.write(&Command::End)
    }
}

#[cfg(test)]
mod tests {
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
