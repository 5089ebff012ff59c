//! What the surface-level shader's kernels are told: a configuration in, the settings' own words
//! and the table of sections out. Numbers that are real in a configuration become integers here,
//! by the same rule as in the first implementation: to nearest, and 0 only where they are 0.

use super::Esc;
use crate::config::{Boundary, Config, ControlMesh, LevelPolicy, Reuse};
use crate::gpu::settings::{PATCH, words};

/// Words of a patch's control points in object space.
pub(super) const POINTS: usize = 128;

/// Segments of a coarse edge at the greatest level there is.
const SEGMENTS: u32 = 16;
const COARSE_TRIANGLES: u32 = 18;

/// Where V_S and V_B are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tests {
    /// Nowhere.
    None,
    /// On the screen.
    Pixels,
    /// In object space.
    Object,
}

impl Tests {
    pub(super) fn of(config: &Config) -> Self {
        if config.esc.mu <= 0.0 {
            Self::None
        } else if config.esc.tests_in_object_space() {
            Self::Object
        } else {
            Self::Pixels
        }
    }
}

/// Nets of a patch: one for each of the eight ways to turn it, where cracks are looked for.
pub(super) fn turns(config: &Config) -> usize {
    if config.esc.boundary == Boundary::Plain { 8 } else { 1 }
}

/// A positive number in units of 1 / `scale`, to nearest and at least 1; 0 stays 0.
fn scaled(value: f64, scale: f64) -> u64 {
    if value > 0.0 { ((value * scale).round() as u64).max(1) } else { 0 }
}

fn pixels(value: f64) -> u32 {
    scaled(value, 65536.0).min(u32::MAX.into()) as u32
}

/// mu in UQ16.16 pixels, or in 1/256 ulp of object space.
fn threshold(work: &Esc<'_>) -> u64 {
    let mu = work.config.esc.mu;
    match Tests::of(work.config) {
        Tests::None => 0,
        Tests::Pixels => pixels(mu).into(),
        Tests::Object => scaled(mu, f64::from(work.object_format.fraction + 8).exp2()),
    }
}

/// Which levels are chosen, as the kernels number it, and by what.
pub(super) fn policy(work: &Esc<'_>) -> (u32, [u32; 2]) {
    let esc = &work.config.esc;
    if work.object_levels.is_some() {
        return (4, [0; 2]);
    }
    match esc.level {
        LevelPolicy::Criterion => (0, [0; 2]),
        LevelPolicy::Fixed => (1, [esc.fixed_level, 0]),
        LevelPolicy::Distance => {
            let ulps = (esc.full_distance * f64::from(work.position.fraction).exp2()).round();
            (2, words(ulps.clamp(1.0, work.position.max() as f64) as i64))
        }
        LevelPolicy::ScreenSize => (3, [pixels(esc.full_pixels), 0]),
    }
}

/// The own words, as esc_pattern.wgsl says.
pub(super) fn own(work: &Esc<'_>) -> [u32; 16] {
    let esc = &work.config.esc;
    let [low, high] = words(threshold(work) as i64);
    let (policy, number) = policy(work);
    [
        PATCH as u32,
        turns(work.config) as u32,
        esc.guard,
        esc.parameter_bits,
        u32::from(esc.boundary == Boundary::Plain),
        Tests::of(work.config) as u32,
        low,
        high,
        u32::from(esc.control_mesh == ControlMesh::Chord),
        work.object_format.fraction as u32,
        match esc.reuse {
            Reuse::None => 0,
            Reuse::CoarseTriangle => 1,
            Reuse::Patch => 2,
        },
        esc.level_max,
        policy,
        number[0],
        number[1],
        if esc.output_values.is_some() { esc.level_max + 1 } else { SEGMENTS },
    ]
}

/// The section of each strip of each coarse triangle at the greatest level, 16 a coarse triangle;
/// and how many sections there are.
pub(super) fn sections(config: &Config) -> (Vec<u32>, u32) {
    let mut table = vec![0; (COARSE_TRIANGLES * SEGMENTS) as usize];
    let Some(output) = config.output() else { return (table, 1) };
    let room = output.vertices();
    let segments = u32::from(output.level_max) + 1;
    // Strips have 3, 5, 7 .. vertices: n (n + 2) in all.
    let whole = segments * (segments + 2);
    let (mut section, mut left) = (0, room);
    for triangle in 0..COARSE_TRIANGLES {
        for strip in 0..segments {
            let need = match (whole <= room, strip) {
                (true, 0) => whole,
                (true, _) => 0,
                (false, _) => 2 * strip + 3,
            };
            if need > left {
                (section, left) = (section + 1, room);
            }
            left -= need;
            table[(SEGMENTS * triangle + strip) as usize] = section;
        }
    }
    (table, section + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Level 3: strips of 3, 5, 7 and 9 vertices, four values each.
    #[test]
    fn sections_take_whole_coarse_triangles_or_strips() {
        let of = |values| {
            let mut config = Config::default();
            (config.esc.level_max, config.esc.bytes_out) = (3, 16);
            config.esc.output_values = values;
            sections(&config)
        };
        assert_eq!(of(None).1, 1);
        assert_eq!(of(Some(1024)).1, 2); // ten coarse triangles at a time
        assert_eq!(of(Some(96)).1, 18);
        let (table, count) = of(Some(92)); // 23: 3 + 5 + 7, 9 + 3 + 5, 7 + 9 + 3 and so on
        assert_eq!(table[..4], [0, 0, 0, 1]);
        assert_eq!(table[16..20], [1, 1, 2, 2]);
        assert_eq!(count, table[16 * 17 + 3] + 1);
    }
}
