//! The second implementation: every block again, as compute kernels in WGSL for wgpu.
//!
//! In come control points after the port and a configuration; out come vertices, screen positions,
//! triangles and what was counted, equal to the first implementation's to the bit. It shares
//! nothing with that but the words of patches and settings, so what both say is not one mistake
//! made once. Kernels have integers only, of 32 bits ([`Sources`]): they run wherever WebGPU does.

mod device;
mod kernel;
mod made;
pub mod render;
mod settings;

pub use device::{Backend, Buffer, Device};
pub use kernel::{Kernel, Sources};
pub use made::{Made, Name};
pub use settings::{PATCH, Settings, State, VERTEX, integer, push_patch, rounding, words};
