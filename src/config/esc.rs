//! The surface shader of unit `esc`, as keys `esc.*`. Plain data.

use super::Config;
use rtl_model::esc::{Boundary, ControlMesh, NET_BITS, Output, Reuse};
use serde::{Deserialize, Serialize};

/// Words of `[N][B][M]^T`: 16 coefficients of four components.
pub const NET_WORDS: u32 = 64;

/// What a patch's level of resolution depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LevelPolicy {
    /// The trace's criterion, or the one of `level.*` that overrides it: the smallest L of which
    /// 3 (L + 1) segments are enough.
    #[default]
    Criterion,
    /// `esc.fixed_level` everywhere.
    Fixed,
    /// The distance from the eye plane: L + 1 falls as 1 / w beyond `esc.full_distance`.
    Distance,
    /// The size on the screen: L + 1 falls with the length in pixels below `esc.full_pixels`.
    ScreenSize,
}

/// What has a level of resolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LevelScope {
    /// Each edge of a patch, by that edge alone; its interior has the greatest.
    #[default]
    Patch,
    /// The whole of a draw's instance, chosen by the driver (Concheiro et al. 2014, section 2.2:
    /// "the level of resolution of each object").
    Object,
}

/// In which space distances are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// On the screen.
    #[default]
    Pixels,
    /// In the units of the control points, before `model`: independent of the view, as the paper
    /// writes it. The unit then gets control points in object space beside those in clip space.
    Object,
}

/// The surface shader.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Esc {
    /// What levels of resolution depend on.
    pub level: LevelPolicy,
    /// What has one.
    pub scope: LevelScope,
    /// The greatest level, 0..=15.
    pub level_max: u32,
    /// The level of [`LevelPolicy::Fixed`], 0..=15.
    pub fixed_level: u32,
    /// w up to which [`LevelPolicy::Distance`] gives the greatest level.
    pub full_distance: f64,
    /// Pixels from which on [`LevelPolicy::ScreenSize`] gives the greatest level.
    pub full_pixels: f64,
    /// What the surface is compared with.
    pub control_mesh: ControlMesh,
    /// In which space.
    pub space: Space,
    /// Distance above which a candidate is inserted, in pixels or object units; 0: all are.
    pub mu: f64,
    /// How points of the boundary are evaluated.
    pub boundary: Boundary,
    /// How far a point that was evaluated serves.
    pub reuse: Reuse,
    /// Fraction bits of the coefficients below a position's, 0..=20.
    pub guard: u32,
    /// Fraction bits of a parameter, 16..=46.
    pub parameter_bits: u32,
    /// Most 32-bit values that an invocation gives; absent: no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_values: Option<u32>,
    /// Invocations that a wave runs side by side, 1..=1024.
    pub width: u32,
    /// Registers of an invocation beside those of the coefficients, in words.
    pub registers: u32,
    /// Registers of a processor, in words.
    pub register_file: u32,
    /// Bytes of a vertex that leaves, without its attributes.
    pub bytes_out: u32,
}

impl Default for Esc {
    /// Half a pixel, as flatness has it. Levels to 15 reach 48 segments an edge. 40 = 32 + 8 bits
    /// of a parameter keep its rounding below an ulp of the default position, and 7 guard bits
    /// leave room at every width. A processor holds
    /// 256 KB of registers, as those of 2009 and of today do.
    fn default() -> Self {
        Self {
            level: LevelPolicy::Criterion,
            scope: LevelScope::Patch,
            level_max: 15,
            fixed_level: 3,
            full_distance: 1.0,
            full_pixels: 512.0,
            control_mesh: ControlMesh::Net,
            space: Space::Pixels,
            mu: 0.5,
            boundary: Boundary::Symmetric,
            reuse: Reuse::Patch,
            guard: 7,
            parameter_bits: 40,
            output_values: None,
            width: 64,
            registers: 32,
            register_file: 65536,
            bytes_out: 32,
        }
    }
}

impl Esc {
    /// Waves whose registers a processor holds, at least 1.
    #[must_use]
    pub fn waves_in_flight(&self) -> u32 {
        let words = u64::from(self.width) * u64::from(NET_WORDS + self.registers);
        (u64::from(self.register_file) / words).clamp(1, 1 << 16) as u32
    }

    /// Values of 32 bits that leave with a vertex, without its attributes.
    fn values(&self) -> u32 {
        self.bytes_out.div_ceil(4)
    }

    /// Whether distances are taken in object space, and control points in it are wanted.
    #[must_use]
    pub fn tests_in_object_space(&self) -> bool {
        self.space == Space::Object && self.mu > 0.0
    }
}

impl Config {
    /// The limit of an invocation's output, if there is one. Attributes are not in it.
    #[must_use]
    pub fn output(&self) -> Option<Output> {
        self.esc.output_values.map(|values_max| Output {
            values_max,
            values_per_vertex: self.esc.values(),
            level_max: self.esc.level_max as u8, // at most 15
        })
    }

    /// Bits of a coefficient of the surface.
    #[must_use]
    pub fn net_bits(&self) -> u32 {
        self.position.width + NET_BITS + self.esc.guard
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_say_how_many_waves_a_processor_holds() {
        let waves = |width, registers| Esc { width, registers, ..Esc::default() }.waves_in_flight();
        assert_eq!((waves(64, 32), waves(64, 0), waves(1024, 32), waves(1, 0)), (10, 16, 1, 1024));
    }
}
