//! The second implementation: every block again, as compute kernels in WGSL for wgpu.
//!
//! In come control points after the port and a configuration; out come vertices, screen positions,
//! triangles and what was counted, equal to the first implementation's to the bit. It shares
//! nothing with that but the words of patches and settings, so what both say is not one mistake
//! made once. Kernels have integers only, of 32 bits ([`Sources`]): they run wherever WebGPU does.
//!
//! ```text
//! block           the first implementation              this one
//! integers        the processor's, 64 and 128 bits;     limbs of 32 bits, products of 16-bit
//!                 256 from a library                    halves; division and roots by bits
//! clip            outcodes, point by point              signs of distances, plane by plane
//! backface:
//!   tangent_plane an estimate, then S . (Su x Sv)       (S x Su) . Sv, an invocation a coefficient
//!   net_facets    differences, facet by facet           det of the points, an invocation a facet
//!   hull_literal  planes, each point's side             determinants of triples, sums of four
//!   normal_cone   multiplies across, divides once       a quotient a direction, the least of them
//! level           the processor's division and roots    long division, roots, of the bits needed
//!   dyadic lists  a stack of pieces; divides, squares   two numbers a piece; product with a root
//! place           lists written out                     closed forms, ranks by population counts
//! evaluate:
//!   forward       three additions a step                D0 + k D1 + C(k,2) D2 + C(k,3) D3 mod 2^64
//!   de Casteljau  vec4 by vec4, two products            in place, a coordinate, one product
//!   normals       128 bits where they suffice           256 bits, expanded along Sv
//! stitch          a walk with an error, a zipper's      an invocation a triangle: bisection in the
//!                 mask of steps                         merge of two rows
//! emit            a reciprocal, corrected               long division of the bits of the band
//! d3d11:
//!   points        each factor's list, by steps          the definition, an invocation a point
//!   connect       rings walked, tables of transitions   rings by areas, ranks in the ruler's order
//!   shaders       the processor's singles               singles made of integers
//! esc:
//!   levels, net   counts comparisons; products          a division; the double sum
//!   strips        tables, one walk along all rows       formulas, coarse triangles side by side
//! ```
//!
//! Roundings that are part of a block's definition are the same in both: what follows from one
//! integer to the next must be, to the bit.

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
