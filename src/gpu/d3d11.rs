//! Unit `d3d11` as kernels: patches in, vertices, triangles and counts out.

mod pattern;
mod starts;

pub use pattern::{Domain, FACTORS, Output, Patterns, Tessellation, patterns};
