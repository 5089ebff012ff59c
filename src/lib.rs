//! To come.
pub mod error;
pub mod trace;
