//! Scenes: a name and a size in, the commands that draw it out.

use crate::error::Result;
use crate::trace::command::{Command, Tessellation};
use crate::trace::read::Reader;
use crate::trace::scene::elephants::Elephants;
use crate::trace::scene::model::Model;
use crate::trace::scene::newell::Newell;
use crate::trace::scene::teacups::Teacups;

/// A scene of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// A walk among so many teacups.
    Teacups(u32),
    /// A walk among so many elephants.
    Elephants(u32),
    /// A model alone, in one frame.
    Model(Newell),
}

impl Scene {
    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Teacups(_) => "teacups",
            Self::Elephants(_) => "elephants",
            Self::Model(Newell::Teapot) => "teapot",
            Self::Model(Newell::Teapot28) => "teapot28",
            Self::Model(Newell::Teacup) => "teacup",
            Self::Model(Newell::Teaspoon) => "teaspoon",
        }
    }

    /// Its commands, over so many frames where it has any number.
    pub(super) fn commands(self, frames: u32) -> Result<Vec<Command>> {
        let tessellation = Tessellation::default();
        let mut text = Vec::new();
        let written = match self {
            Self::Teacups(count) => Teacups { count, frames, tessellation }.write(&mut text),
            Self::Elephants(count) => Elephants { count, frames, tessellation }.write(&mut text),
            Self::Model(model) => Model { model, tessellation }.write(&mut text),
        };
        written.expect("memory takes everything");
        Reader::new(&text[..], self.name(), ".").map(|located| Ok(located?.command)).collect()
    }
}

/// Patches that the commands draw, over all frames.
pub(super) fn patches(commands: &[Command]) -> u64 {
    let drawn = commands.iter().map(|command| match command {
        Command::Draw(draw) => draw.models.len() as u64 * draw.primitive.patches(),
        _ => 0,
    });
    drawn.sum()
}
