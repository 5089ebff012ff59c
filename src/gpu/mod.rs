//! The second implementation: every block again, as compute kernels in WGSL for wgpu.
//!
//! In come control points after the port and a configuration; out come vertices, screen positions,
//! triangles and what was counted, equal to the first implementation's to the bit. It shares
//! nothing with that but the words of patches and settings, so what both say is not one mistake
//! made once. Kernels have integers only, of 32 bits ([`Sources`]): they run wherever WebGPU does.

mod backface;
pub mod d3d11;
mod device;
mod esc;
mod kernel;
mod level;
mod made;
mod record;
pub mod render;
mod settings;
pub mod surface;

pub use backface::backface;
pub use device::{Backend, Buffer, Device};
pub use esc::{Decided, Esc, decide, esc};
pub use kernel::{Kernel, Sources};
pub use level::{LEVELS, LISTS, level, subdivide};
pub use made::{Made, Name};
pub use record::Dispatch;
pub use settings::{PATCH, Settings, State, VERTEX, integer, push_patch, rounding, words};
