//! What a run leaves behind: counters, summary and configuration in a result folder, meshes and
//! pictures, and the table on the terminal.
//!
//! In come a [`Report`](crate::report::Report) and, patch by patch, meshes through the
//! [`Sink`](crate::sink::Sink) interface; out come files that two identical runs write byte by byte
//! the same: no time, no path of the machine, no order that depends on threads. Everything appears
//! by rename when it is complete.

pub mod counters;
pub mod edges;
pub mod file;
pub mod folder;
pub mod mesh;
pub mod obj;
pub mod occupancy;
pub mod page;
#[cfg(feature = "gpu")]
pub mod picture;
pub mod ply;
pub mod result;
pub mod space;
pub mod summary;
pub mod svg;
pub mod table;
pub mod timeline;

#[cfg(test)]
mod sample;
#[cfg(test)]
pub(crate) use sample::timed_report;
