//! To come.
pub mod config;
pub mod error;
pub mod output;
pub mod report;
pub mod sink;
pub mod trace;
