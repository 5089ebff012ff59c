//! Teacups: cups on a plane in, a walk among them out, one frame after another.
//!
//! The cup's points are resident: they cross the link once, and every frame sends the matrices of
//! its instances. Cups stand about three units apart on a jittered square lattice, each turned its
//! own way; the eye walks from the front row towards the middle and sways a little, so that cups
//! are seen large and small, and some are passed.

use super::super::command::{Command, Draw, Header, Points, Primitive, Tessellation};
use super::super::points::PointSource;
use super::super::write::Writer;
use super::camera::Camera;
use super::grid::random;
use super::newell::Newell;
use std::io::{self, Write};
use std::sync::Arc;

/// Between neighbours of the lattice, before jitter; a saucer is 2 across.
const SPACING: f64 = 3.0;
/// The most that a cup is off its lattice point, along each axis.
const JITTER: f64 = 0.45;

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
        let cup = Newell::Teacup;
        let points = cup.points();
        let count = points.len() as u64 / 16;
        let draw = Command::Draw(Draw {
            models: (0..self.count).map(|i| self.model(i)).collect(),
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
            writer.write(&Command::Frame(self.camera(frame).frame()))?;
            writer.write(&draw)?;
        }
        writer.write(&Command::End)
    }

    /// Cups along a side of the lattice: the least square that holds them.
    fn side(&self) -> u32 {
        let root = self.count.isqrt();
        if root * root < self.count { root + 1 } else { root }
    }

    /// Where cup `i` stands and how it is turned; y of the cup becomes z.
    fn model(&self, i: u32) -> [f32; 16] {
        let (row, column) = (i / self.side(), i % self.side());
        let jitter = |axis| JITTER * (2.0 * random(i, axis) - 1.0);
        let x = f64::from(column) * SPACING + jitter(0);
        let y = f64::from(row) * SPACING + jitter(1);
        // (1 - t t, 2 t) / (1 + t t) is on the unit circle; with t from -1 to 1 it is on the right
        // half.
        let t = 2.0 * random(i, 2) - 1.0;
        let half = if random(i, 3) < 0.5 { 1.0 } else { -1.0 };
        let (c, s) = (half * (1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        [c, s, 0., 0., 0., 0., 1., 0., s, -c, 0., 0., x, y, 0., 1.].map(|n| n as f32)
    }

    /// The eye of a frame.
    fn camera(&self, frame: u32) -> Camera {
        let size = f64::from(self.side() - 1) * SPACING;
        let t = f64::from(frame) / f64::from(self.frames.max(2) - 1);
        // A cubic that leaves the middle, comes back at the half and at the end: half a unit to
        // either side.
        let sway = 10.0 * t * (t - 0.5) * (t - 1.0);
        let x = size / 2.0 + sway;
        let y = -5.0 + t * (size / 2.0 + 2.0);
        let eye = [x, y, 3.0];
        Camera::at(eye, [size / 2.0, y + 8.0, 0.0], 0.25, size * 2.0 + 20.0)
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

    #[test]
    fn models_turn_and_do_not_mirror() {
        let scene = Teacups { count: 7, frames: 1, tessellation: Tessellation::default() };
        for i in 0..7 {
            let model = glam::Mat4::from_cols_array(&scene.model(i));
            assert!((model.determinant() - 1.0).abs() < 1e-5, "{model}");
        }
    }
}
