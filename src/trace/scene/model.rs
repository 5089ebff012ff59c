//! Model: one of Newell's models alone, three-quarter view from a bit above, default tessellation.

use super::super::command::{Command, Draw, Header, IDENTITY, Points, Primitive, Tessellation};
use super::super::points::PointSource;
use super::super::write::Writer;
use super::camera::Camera;
use super::newell::Newell;
use std::io::{self, Write};
use std::sync::Arc;

/// A frame with one model in it.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// The model.
    pub model: Newell,
    /// How finely it is tessellated.
    pub tessellation: Tessellation,
}

/// y up to z up: x stays, y becomes z, z becomes -y.
pub(super) const Y_UP: [f32; 16] =
    [1., 0., 0., 0., 0., 0., 1., 0., 0., -1., 0., 0., 0., 0., 0., 1.];

impl Model {
    /// Writes the trace.
    ///
    /// # Errors
    /// Those of the output.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let points = self.model.points();
        let (title, from) = match self.model {
            Newell::Teapot => ("teapot", [0.5, -1.0, 0.55]),
            Newell::Teapot28 => ("teapot of 28 patches", [0.5, -1.0, 0.55]),
            Newell::Teacup => ("teacup", [0.5, -1.0, 0.7]),
            Newell::Teaspoon => ("teaspoon", [1.0, -0.6, 0.8]),
        };
        let upright =
            |&[x, y, z]: &[f32; 3]| if self.model.is_z_up() { [x, y, z] } else { [x, -z, y] };
        let world: Vec<[f32; 3]> = points.iter().map(upright).collect();
        let mut writer = Writer::new(out);
        writer.write(&Command::Header(Header {
            title: title.into(),
            source: self.model.source().into(),
            licence: self.model.licence().into(),
        }))?;
        writer.write(&Command::Frame(Camera::on(&world, from).frame()))?;
        writer.write(&Command::Tessellation(self.tessellation))?;
        let count = points.len() as u64 / 16;
        let source = Arc::new(PointSource::Xyz(points));
        writer.write(&Command::Points(Points { id: 0, source, resident: false }))?;
        writer.write(&Command::Draw(Draw {
            models: vec![if self.model.is_z_up() { IDENTITY } else { Y_UP }],
            models_sent: !self.model.is_z_up(),
            reversed: self.model.faces_inward(),
            ..Draw::new(Primitive::Patches { count }, 0)
        }))?;
        writer.write(&Command::End)
    }
}
