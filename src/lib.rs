//! To come.
pub mod config;
pub mod error;
pub mod report;
pub mod sink;
pub mod trace;
