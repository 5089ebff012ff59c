//! The command stream: types, the text form, importers, scenes.

pub mod attributes;
pub mod command;
pub mod import;
pub mod indices;
pub mod points;
pub mod read;
pub mod replay;
pub mod scene;
pub mod write;

mod draw;
mod fast;
mod field;
mod json;
mod lines;
mod parse;
mod state;
