//! Crowd: a model, how many of it and how far apart in, a trace out: where each of them stands, and
//! a walk from the front row towards the middle.
//!
//! The model's points are resident: they cross the link once, and every frame sends the matrices of
//! its instances.
//!
//! Models stand on a jittered square lattice, each turned its own way. Concheiro et al. 2014,
//! section 4: "a walk-through animation with the same movement of the camera".

use super::super::command::{Command, Draw, Header, Points, Primitive, Tessellation};
use super::super::points::PointSource;
use super::super::write::Writer;
use super::camera::Camera;
use super::grid::random;
use std::io::{self, Write};
use std::sync::Arc;

/// The most that a model is off its lattice point along each axis, in parts of the spacing.
const JITTER: f64 = 0.15;

/// Models on a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crowd {
    /// Models, at least 1.
    pub(super) count: u32,
    /// Between neighbours of the lattice, before jitter.
    pub(super) spacing: f64,
    /// Whether the model's y is up, and becomes z.
    pub(super) y_up: bool,
}

/// What stands there.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// Several of it, in a title.
    pub(super) plural: &'static str,
    /// Where it is from.
    pub(super) source: String,
    /// Under which licence.
    pub(super) licence: String,
    /// 16 points a patch.
    pub(super) points: Vec<[f32; 3]>,
    /// Whether its patches face inwards.
    pub(super) reversed: bool,
}

impl Crowd {
    /// Writes the trace of a walk.
    ///
    /// # Errors
    /// Those of the output.
    pub(super) fn write(
        &self,
        model: Model,
        tessellation: Tessellation,
        frames: u32,
        out: &mut impl Write,
    ) -> io::Result<()> {
        let Model { plural, source, licence, points, reversed } = model;
        let count = points.len() as u64 / 16;
        let draw = Command::Draw(Draw {
            models: (0..self.count).map(|i| self.model(i)).collect(),
            models_sent: true,
            reversed,
            ..Draw::new(Primitive::Patches { count }, 0)
        });
        let mut writer = Writer::new(out);
        let title = format!("a walk among {} {plural}", self.count);
        writer.write(&Command::Header(Header { title, source, licence }))?;
        let source = Arc::new(PointSource::Xyz(points));
        writer.write(&Command::Points(Points { id: 0, source, resident: true }))?;
        writer.write(&Command::Tessellation(tessellation))?;
        for frame in 0..frames {
            writer.write(&Command::Frame(self.camera(frame, frames).frame()))?;
            writer.write(&draw)?;
        }
        writer.write(&Command::End)
    }

    /// Models along a side of the lattice: the least square that holds them.
    fn side(&self) -> u32 {
        let root = self.count.isqrt();
        if root * root < self.count { root + 1 } else { root }
    }

    /// Where model `i` stands and how it is turned, column-major.
    fn model(&self, i: u32) -> [f32; 16] {
        let (row, column) = (i / self.side(), i % self.side());
        let jitter = |axis| JITTER * self.spacing * (2.0 * random(i, axis) - 1.0);
        let x = f64::from(column) * self.spacing + jitter(0);
        let y = f64::from(row) * self.spacing + jitter(1);
        // (1 - t t, 2 t) / (1 + t t) is on the unit circle; with t from -1 to 1 it is on the right
        // half.
        let t = 2.0 * random(i, 2) - 1.0;
        let half = if random(i, 3) < 0.5 { 1.0 } else { -1.0 };
        let (c, s) = (half * (1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let matrix = if self.y_up {
            [c, s, 0., 0., 0., 0., 1., 0., s, -c, 0., 0., x, y, 0., 1.]
        } else {
            [c, s, 0., 0., -s, c, 0., 0., 0., 0., 1., 0., x, y, 0., 1.]
        };
        matrix.map(|n| n as f32)
    }

    /// The eye of a frame of so many.
    fn camera(&self, frame: u32, frames: u32) -> Camera {
        let size = f64::from(self.side() - 1) * self.spacing;
        // Of models three apart; larger ones are seen from as much farther.
        let unit = self.spacing / 3.0;
        let t = f64::from(frame) / f64::from(frames.max(2) - 1);
        // A cubic that leaves the middle, comes back at the half and at the end: half a unit to
        // either side.
        let sway = 10.0 * unit * t * (t - 0.5) * (t - 1.0);
        let x = size / 2.0 + sway;
        let y = -5.0 * unit + t * (size / 2.0 + 2.0 * unit);
        let target = [size / 2.0, y + 8.0 * unit, 0.0];
        Camera::at([x, y, 3.0 * unit], target, 0.25 * unit, size * 2.0 + 20.0 * unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_turn_and_do_not_mirror() {
        for y_up in [false, true] {
            let crowd = Crowd { count: 7, spacing: 3.0, y_up };
            for i in 0..7 {
                let model = glam::Mat4::from_cols_array(&crowd.model(i));
                assert!((model.determinant() - 1.0).abs() < 1e-5, "{model}");
                let up = if y_up { glam::Vec3::Y } else { glam::Vec3::Z };
                assert_eq!(model.transform_vector3(up), glam::Vec3::Z);
            }
        }
    }

    #[test]
    fn neighbours_keep_apart() {
        let crowd = Crowd { count: 10, spacing: 6.0, y_up: false };
        let at = |i| glam::Vec2::from_slice(&crowd.model(i)[12..14]);
        for i in 0..10 {
            for j in 0..i {
                assert!((at(i) - at(j)).length() > 0.7 * 6.0 - 1e-3, "{i} {j}");
            }
        }
    }
}
