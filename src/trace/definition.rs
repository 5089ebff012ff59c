//! Definitions: the commands whose effect lasts until another of the same name replaces them, and
//! so makes up the state that is live where a frame begins.

use super::command::Command;

/// What a command defines.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub(crate) enum Definition {
    /// The points of an id.
    Points(u32),
    /// The attributes of an id.
    Attributes(u32),
    /// The tessellation state.
    Tessellation,
}

impl Definition {
    /// What `command` defines, if it does.
    pub(crate) fn of(command: &Command) -> Option<Self> {
        match command {
            Command::Points(points) => Some(Self::Points(points.id)),
            Command::Attributes(attributes) => Some(Self::Attributes(attributes.id)),
            Command::Tessellation(_) => Some(Self::Tessellation),
            Command::Header(_) | Command::Frame(_) | Command::Draw(_) | Command::End => None,
        }
    }
}
