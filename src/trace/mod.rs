//! The command stream: types, the text form, importers, scenes.

pub mod command;
pub mod points;
pub mod read;

mod draw;
mod fast;
mod field;
mod json;
mod lines;
mod parse;
mod state;
