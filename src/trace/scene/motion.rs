//! Motion: five animated scenes that show what is clipped, what is back-facing and what levels do
//! from frame to frame, as the five animations of Sfarti et al. 2005, section 3, which the paper
//! names and does not describe.
//!
//! Points are resident: they cross the link once, before the first frame, and a frame is a camera
//! and the matrices of its draws. What a scene shows of its motion hangs on the number of frames
//! only by how often it looks: the first and the last frame of `zoom` and `flythrough` are the same
//! at any number, `turning` and `inside` go round once, and `crossing` has three passes.

mod path;
mod shots;

use super::super::command::{Command, Header, Points, Tessellation};
use super::super::write::Writer;
use std::io::{self, Write};
use std::sync::Arc;

/// Which scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A teapot passes through the frustum three times: from left to right, from below to above,
    /// and from before the near plane to behind the far one.
    Crossing,
    /// A teapot turns once about a slanting axis before a camera that sees all of it.
    Turning,
    /// A camera looks round inside the tube of a torus, which is drawn as authored, its front
    /// outside, and reversed.
    Inside,
    /// A camera flies through 48 teapots.
    Flythrough,
    /// A camera comes near a teapot, from where it is a pixel large to where the near plane cuts
    /// it.
    Zoom,
}

impl Kind {
    /// All five.
    pub const ALL: [Self; 5] =
        [Self::Crossing, Self::Turning, Self::Inside, Self::Flythrough, Self::Zoom];

    /// Its name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Crossing => "crossing",
            Self::Turning => "turning",
            Self::Inside => "inside",
            Self::Flythrough => "flythrough",
            Self::Zoom => "zoom",
        }
    }

    /// The scene of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// An animated scene.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Which.
    pub kind: Kind,
    /// Frames; at least 1.
    pub frames: u32,
    /// How finely it is tessellated.
    pub tessellation: Tessellation,
}

impl Motion {
    /// Frames where nothing else is asked for.
    pub const FRAMES: u32 = 24;

    /// Writes the trace.
    ///
    /// # Errors
    /// Those of the output.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let shots::Cast { title, source, licence, points } = shots::cast(self.kind);
        let mut writer = Writer::new(out);
        writer.write(&Command::Header(Header {
            title: title.into(),
            source: source.into(),
            licence: licence.into(),
        }))?;
        let source = Arc::new(points);
        writer.write(&Command::Points(Points { id: 0, source, resident: true }))?;
        writer.write(&Command::Tessellation(self.tessellation))?;
        for frame in 0..self.frames {
            let (camera, draws) = shots::shot(self.kind, frame, self.frames);
            writer.write(&Command::Frame(camera.frame()))?;
            for draw in draws {
                writer.write(&Command::Draw(draw))?;
            }
        }
        writer.write(&Command::End)
    }
}
