//! The hardware, and nothing else: integers in, integers out. No floating point, no files, no
//! threads, no `unsafe`.
//!
//! ```text
//! points            patches                     levels, parameters     points, triangles
//! f32 ─► port ─► assemble ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit
//!       Q formats  reuse    AND of   exact sign  edges   half-    forward    Bresenham  divide,
//!                          outcodes  of 81       alone   lists    differences  walk     snap
//!                                    coefficients
//! ```
//!
//! What flows from evaluate to stitch is a [`strip`]: two rows whose vertices are complete.
//!
//! [`d3d11`] is another unit's: the fixed-function tessellator, from factors to a pattern. [`esc`]
//! too: a patch through a shader that does pattern, tests, evaluation and mesh in one.
//!
//! A file imports only [`number`], [`mod@time`], [`counter`], [`patch`] and the blocks that stand
//! above it in the list below, which is the order of the data.

#![forbid(unsafe_code)]

pub mod number;

pub mod time;

pub mod counter;
pub mod patch;

pub mod port;

pub mod assemble;

pub mod clip;

pub mod backface;

pub mod level;

pub mod place;

pub mod strip;

pub mod evaluate;

pub mod attribute;

pub mod stitch;

pub mod emit;

pub mod d3d11;

pub mod esc;
