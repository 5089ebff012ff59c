//! Programmable cores: f32, a fixed order of operations, no fused multiply-add, so that every
//! machine computes the same bits and equal control points under equal matrices stay equal.

pub mod control_point;
pub mod domain;
pub mod hull;
pub mod object_level;
