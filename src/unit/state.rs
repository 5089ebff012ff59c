//! State: the tessellation state of a trace and the configuration in, the state that draws are
//! tessellated under out.

use crate::config::Config;
use rtl_model::level;
use rtl_model::patch::Level;

/// The tessellation state of a draw: the trace's, with what the configuration overrides.
///
/// Levels are quantised to UQ8.16, pixels to UQ16.16 with at least one ulp, both to the nearest.
#[must_use]
pub fn under(trace: &level::State, config: &Config) -> level::State {
    use crate::config::Criterion as Name;
    let over = &config.level;
    let fx16 = |value: f64| (value * 65536.0).round_ties_even() as u64;
    let bound = |value: Option<f64>, other| value.map_or(other, |v| Level::clamped(fx16(v)));
    let pixels = || fx16(over.pixels.unwrap_or(0.5)).clamp(1, u32::MAX.into()) as u32;
    let criterion = match over.chosen() {
        None => trace.criterion,
        Some(Name::Flatness) => level::Criterion::Flatness { pixels: pixels() },
        Some(Name::EdgeLength) => level::Criterion::EdgeLength { pixels: pixels() },
        Some(Name::Fixed) => level::Criterion::Fixed { level: bound(over.level, Level::MIN) },
    };
    let max = bound(over.max_level, trace.max);
    // One of the bounds may come from the trace and the other from the configuration: the greatest
    // wins.
    level::State { criterion, min: bound(over.min_level, trace.min).min(max), max }
}
