//! The command stream: types, the text form, importers, scenes.

pub mod command;
pub mod points;
