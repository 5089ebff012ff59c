//! The command stream: types, the text and the binary form, importers, scenes.

mod attributes;
pub mod binary;
pub mod command;
pub mod import;
pub mod indices;
pub mod open;
pub mod points;
pub mod read;
pub mod replay;
pub mod scene;
pub mod write;

mod check;
mod definition;
mod draw;
mod fast;
mod field;
mod json;
mod lines;
mod only;
mod parse;
mod state;
