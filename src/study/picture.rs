//! Picture: a frame of a trace through a unit in; out what a drawing of it needs: facets in every
//! style, the values that heat maps show, their scales.
//!
//! Triangles are those that the unit emitted, its roundings included. Beside them stand the true
//! surfaces, f64 from the trace's numbers on, for normals and for how far triangles are from them.

mod measure;
mod piece;
mod shot;
mod style;

pub use measure::{Values, scale};
pub use shot::Shot;
pub use style::{STYLES, Style, Taste};
