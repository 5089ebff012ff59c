//! `tessim` measures a GPU tessellation unit before it exists: commands that draw surfaces come in,
//! triangles stream into a sink, counters come out.
//!
//! ```text
//! trace ─► unit ─► sink (triangles)         rtl_model: the fixed-point blocks of the units
//!           │                               golden:    the same blocks in f64, by definition
//!           └────► report (counters) ─► output
//!
//! study: many runs of one block, and a table of what they show
//! ```
//!
//! The whole interface is one function, [`simulate`]:
//!
//! ```
//! use rtl_model::counter::Counter;
//! use tessim::config::Config;
//! use tessim::sink::NoMesh;
//! use tessim::trace::open::Trace;
//!
//! let trace = Trace::open("traces/teapot.jsonl")?;
//! let commands = trace.map(|located| Ok(located?.command));
//! let report = tessim::simulate(commands, &Config::default(), &mut NoMesh)?;
//! assert_eq!(report.total(Counter::LinkControlPoints), 32 * 16 * 12);
//! # Ok::<(), tessim::error::Error>(())
//! ```
//!
//! What a run computes is in [`config::Config`], nowhere else; the number of threads is that of the
//! current rayon pool and changes nothing. A consumer of triangles implements [`sink::Sink`];
//! [`output`] holds those that the command line has.

pub mod attribute;
pub mod config;
pub mod error;
pub mod golden;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod link;
pub mod output;
pub mod report;
pub mod shader;
pub mod sink;
pub mod study;
pub mod trace;
pub mod unit;

pub use unit::simulate;
