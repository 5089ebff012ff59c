//! Studies: questions about a design that take many runs of one block, each with its table.
//!
//! In come options, out comes a table: as text for the terminal and the README, as CSV with
//! integers only for everything else. A study is a function of its options: inputs are seeded, and
//! any number of threads gives the same bytes.

pub mod backface;
pub mod bandwidth;
#[cfg(feature = "gpu")]
pub mod check;
pub mod compare;
mod distance;
pub mod energy;
pub mod esc;
mod markdown;
pub mod motion;
mod nearest;
#[cfg(feature = "gpu")]
pub mod picture;
mod plot;
pub mod precision;
pub mod provenance;
mod random;
pub mod raster;
pub mod sweep;
pub mod walk;
