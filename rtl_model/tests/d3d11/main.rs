//! The tessellator: against vectors bit for bit, and what its patterns promise for every factor.

mod draw;
mod invariance;
mod inversions;
mod mesh;
mod process;
mod vectors;
