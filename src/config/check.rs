//! What a configuration must satisfy before a unit is built from it: the range of every key, and
//! what keys demand of each other. Each failure names the key, what was found and what was
//! expected.

use super::block::{CYCLES_MAX, ENTRIES_MAX, LANES_MAX, TIMED};
use super::d3d11::{CANDIDATES_MAX, WIDTH_MAX as WAVE_MAX};
use super::link::BANDWIDTH_MAX;
use super::{Attributes, Config, Criterion, Esc, LevelPolicy, LevelScope, WIDTH_MAX, keys};
use crate::error::{Error, Result};
use rtl_model::place::{RECIPROCAL_BITS, RECIPROCAL_BITS_MIN};
use std::fmt::Display;

/// Most tokens in flight in all lanes of a block: what is held for them stays below 32 MB.
const SLOTS_MAX: u64 = 1 << 22;

/// A value that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The dotted path.
    pub key: &'static str,
    /// What was found, and what was expected.
    pub message: String,
}

impl Problem {
    pub(super) fn found(key: &'static str, found: impl Display) -> Self {
        let expected = keys::find(key).expect("a checked key is in the table").expected;
        Self { key, message: format!("found {found}, expected {expected}") }
    }
}

impl From<Problem> for Error {
    fn from(problem: Problem) -> Self {
        Self::Usage(format!("{}: {}", problem.key, problem.message))
    }
}

impl Config {
    /// Refuses what the hardware could not be built with.
    ///
    /// # Errors
    /// [`Error::Usage`] names the key, what was found and what was expected.
    pub fn check(&self) -> Result<()> {
        Ok(self.problem()?)
    }

    /// As [`Self::check`], with the key apart, so that the layers can say where it was set.
    pub(super) fn problem(&self) -> Result<(), Problem> {
        self.formats()?;
        self.levels()?;
        self.shaders()?;
        self.surface()?;
        self.sizes()?;
        self.host_link()?;
        self.device_memory()?;
        self.times()
    }

    fn formats(&self) -> Result<(), Problem> {
        let width = self.position.width;
        within("position.width", width, 8, WIDTH_MAX)?;
        if let Some(log2) = self.position.clip_range_log2 {
            // The exponents of normal f32 numbers: nothing larger can come out of the shader.
            within("position.clip_range_log2", log2, -126, 127)?;
        }
        within("position.object_range_log2", self.position.object_range_log2, -126, 127)?;
        let guard = self.guard();
        if guard < 1 || width.saturating_add(guard).saturating_add(3) > 63 {
            return Err(Problem::found("evaluate.guard", guard_found(guard, width)));
        }
        let bits = self.place.reciprocal_bits;
        within("place.reciprocal_bits", bits, RECIPROCAL_BITS_MIN, RECIPROCAL_BITS)?;
        let Attributes { width, fraction, .. } = self.attributes;
        within("attributes.width", width, 8, 46)?;
        if fraction >= width {
            let found = format!("{fraction} with attributes.width {width}");
            return Err(Problem::found("attributes.fraction", found));
        }
        within("emit.subpixel_bits", self.emit.subpixel_bits, 0, 12)
    }

    fn levels(&self) -> Result<(), Problem> {
        let level = &self.level;
        // UQ16.16 holds no more than 65535 pixels; levels are UQ8.16.
        number("level.pixels", level.pixels, |p| p > 0.0 && p <= 65535.0)?;
        number("level.near", level.near, |w| w > 0.0 && w.is_finite())?;
        let in_range = |l: f64| (1.0..=128.0).contains(&l);
        number("level.level", level.level, in_range)?;
        number("level.min_level", level.min_level, in_range)?;
        number("level.max_level", level.max_level, in_range)?;
        // Where only one is given, the other is the trace's, and the reader of the trace compares
        // them.
        if let (Some(min), Some(max)) = (level.min_level, level.max_level)
            && min > max
        {
            return Err(Problem::found("level.min_level", format!("{min} above max_level {max}")));
        }
        self.criterion()
    }

    fn criterion(&self) -> Result<(), Problem> {
        let level = &self.level;
        let message = match (level.criterion, level.pixels, level.level) {
            (None, Some(_), Some(_)) => "found both pixels and level, expected one of them",
            (Some(Criterion::Fixed), Some(_), _) => "found fixed with pixels, expected level only",
            (Some(Criterion::Fixed), None, Some(_)) => return Ok(()),
            (Some(Criterion::Fixed), _, None) => {
                "found fixed alone, expected level.level beside it"
            }
            (Some(_), _, Some(_)) => "found level beside it, expected level only with fixed",
            (Some(_), None, None) => "found it alone, expected level.pixels beside it",
            _ => return Ok(()),
        };
        Err(Problem { key: "level.criterion", message: message.to_owned() })
    }

    fn shaders(&self) -> Result<(), Problem> {
        let Self { hull, domain, .. } = self;
        number("hull.pixels", Some(hull.pixels), |p| (0.0..=65535.0).contains(&p))?;
        within("hull.candidates", hull.candidates, 1, CANDIDATES_MAX)?;
        within("domain.weight_bits", domain.weight_bits, 16, 30)?;
        within("domain.cache_entries", domain.cache_entries.unwrap_or(0), 0, 65536)?;
        within("domain.width", domain.width, 1, WAVE_MAX)?;
        within("domain.bytes_in", domain.bytes_in, 0, 65536)?;
        within("domain.bytes_out", domain.bytes_out, 0, 65536)
    }

    fn surface(&self) -> Result<(), Problem> {
        let Esc { level, scope, .. } = self.esc;
        let esc = &self.esc;
        let most = u32::from(rtl_model::esc::LEVEL_MAX);
        within("esc.level_max", esc.level_max, 0, most)?;
        let fixed_most = if level == LevelPolicy::Fixed { esc.level_max } else { most };
        within("esc.fixed_level", esc.fixed_level, 0, fixed_most)?;
        number("esc.full_distance", Some(esc.full_distance), |w| w > 0.0 && w.is_finite())?;
        number("esc.full_pixels", Some(esc.full_pixels), |p| p > 0.0 && p <= 65535.0)?;
        number("esc.mu", Some(esc.mu), |mu| (0.0..=65535.0).contains(&mu))?;
        if (level, scope) == (LevelPolicy::Criterion, LevelScope::Object) {
            return Err(Problem::found("esc.scope", "object with esc.level criterion"));
        }
        within("esc.guard", esc.guard, 0, 20)?;
        if self.net_bits() > 63 {
            let found = guard_found(esc.guard, self.position.width);
            return Err(Problem::found("esc.guard", found));
        }
        within("esc.parameter_bits", esc.parameter_bits, 16, 46)?;
        within("esc.width", esc.width, 1, WAVE_MAX)?;
        within("esc.registers", esc.registers, 0, 65536)?;
        within("esc.register_file", esc.register_file, 1, 1 << 24)?;
        within("esc.bytes_out", esc.bytes_out, 4, 65536)?;
        match self.output() {
            Some(output) if !output.fits() => {
                let values = output.values_max;
                let strip = output.values_per_vertex * (2 * u32::from(output.level_max) + 3);
                let found = format!("{values}, below the {strip} of the longest strip");
                Err(Problem::found("esc.output_values", found))
            }
            _ => Ok(()),
        }
    }

    fn sizes(&self) -> Result<(), Problem> {
        let most = 65536;
        within("emit.vertex_bytes", self.emit.vertex_bytes, 1, most)?;
        within("emit.index_bytes", self.emit.index_bytes, 1, 8)?;
        within("vertex_shader.bytes_in", self.vertex_shader.bytes_in, 0, most)?;
        within("vertex_shader.bytes_in_normal", self.vertex_shader.bytes_in_normal, 0, most)?;
        within("vertex_shader.bytes_out", self.vertex_shader.bytes_out, 0, most)?;
        within("assemble.cache_entries", self.assemble.cache_entries, 0, most)?;
        self.triangles.problem()
    }
}

impl Config {
    fn host_link(&self) -> Result<(), Problem> {
        let (link, most) = (&self.link, 65536);
        within("link.bandwidth_mb_s", link.bandwidth_mb_s, 1, BANDWIDTH_MAX)?;
        within("link.upstream_mb_s", link.upstream_mb_s, 1, BANDWIDTH_MAX)?;
        within("link.payload", link.payload, 0, most)?;
        within("link.header", link.header, 0, most)?;
        if link.payload == 0 && link.header != 0 {
            let found = format!("{} with payload 0", link.header);
            return Err(Problem::found("link.header", found));
        }
        within("link.request", link.request, 1, most)?;
        within("link.request_header", link.request_header, 0, most)?;
        within("link.completion", link.completion, 0, most)?;
        within("link.completion_header", link.completion_header, 0, most)?;
        if link.completion == 0 && link.completion_header != 0 {
            let found = format!("{} with completion 0", link.completion_header);
            return Err(Problem::found("link.completion_header", found));
        }
        within("link.latency", link.latency, 0, CYCLES_MAX)?;
        within("link.outstanding", link.outstanding, 1, ENTRIES_MAX)
    }

    fn device_memory(&self) -> Result<(), Problem> {
        let memory = &self.memory;
        within("memory.burst", memory.burst, 1, 65536)?;
        within("memory.bandwidth_mb_s", memory.bandwidth_mb_s, 1, BANDWIDTH_MAX)?;
        within("memory.latency", memory.latency, 0, CYCLES_MAX)?;
        within("memory.outstanding", memory.outstanding, 1, ENTRIES_MAX)?;
        within("memory.fifo", memory.fifo, 1, ENTRIES_MAX)
    }

    fn times(&self) -> Result<(), Problem> {
        within("clock_mhz", self.clock_mhz, 1, 100_000)?;
        for block in TIMED {
            let costs = self.costs(block).expect("a block that takes time has costs");
            let key = |name: &str| {
                let path = format!("block.{}.{name}", block.name());
                keys::find(&path).expect("the table has the keys of every block").path
            };
            within(key("interval"), costs.interval, 1, CYCLES_MAX)?;
            within(key("latency"), costs.latency, 0, CYCLES_MAX)?;
            within(key("lanes"), costs.lanes, 1, LANES_MAX)?;
            within(key("fifo"), costs.fifo, 1, ENTRIES_MAX)?;
            if let Some(tokens) = costs.in_flight {
                within(key("in_flight"), tokens, 1, ENTRIES_MAX)?;
            }
            let (lanes, tokens) = (costs.lanes, costs.in_flight());
            if u64::from(lanes) * u64::from(tokens) > SLOTS_MAX {
                let message = format!(
                    "found {lanes} lanes of {tokens} tokens in flight, expected at most \
                     {SLOTS_MAX} in all"
                );
                return Err(Problem { key: key("lanes"), message });
            }
        }
        // Written by hand they are checked even under `off`, where no patch takes them.
        let backface = &self.block.backface;
        within("block.backface.interval", backface.interval.unwrap_or(1), 1, CYCLES_MAX)?;
        within("block.backface.latency", backface.latency.unwrap_or(0), 0, CYCLES_MAX)?;
        within("block.domain.interval", self.block.domain.interval.unwrap_or(1), 1, CYCLES_MAX)?;
        within("block.evaluate.setup", self.block.evaluate.setup, 0, CYCLES_MAX)?;
        let surface = &self.block.surface;
        within("block.surface.net", surface.net, 0, CYCLES_MAX)?;
        within("block.surface.test", surface.test, 0, CYCLES_MAX)?;
        within("block.surface.point", surface.point, 0, CYCLES_MAX)?;
        within("block.surface.slot", surface.slot, 0, CYCLES_MAX)
    }
}

fn guard_found(guard: u32, width: u32) -> String {
    format!("{guard} with position.width {width}")
}

pub(super) fn within<T: Copy + PartialOrd + Display>(
    key: &'static str,
    value: T,
    least: T,
    most: T,
) -> Result<(), Problem> {
    if value < least || value > most { Err(Problem::found(key, value)) } else { Ok(()) }
}

/// `holds` is false for NaN, whatever it compares with.
fn number(
    key: &'static str,
    value: Option<f64>,
    holds: impl Fn(f64) -> bool,
) -> Result<(), Problem> {
    match value {
        Some(value) if !holds(value) => Err(Problem::found(key, value)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::BackfaceMethod;

    fn refused(key: &str, change: impl FnOnce(&mut Config)) {
        let mut config = Config::default();
        change(&mut config);
        let problem = config.problem().expect_err(key);
        assert_eq!(problem.key, key, "{problem:?}");
        assert!(problem.message.contains("found") && problem.message.contains("expected"));
    }

    #[test]
    fn what_cannot_be_built_is_refused_by_its_key() {
        refused("position.width", |c| c.position.width = 7);
        refused("position.width", |c| c.position.width = 49);
        refused("position.width", |c| c.position.width = u32::MAX);
        refused("position.clip_range_log2", |c| c.position.clip_range_log2 = Some(128));
        refused("evaluate.guard", |c| c.evaluate.guard = Some(0));
        refused("evaluate.guard", |c| c.evaluate.guard = Some(29));
        refused("evaluate.guard", |c| c.evaluate.guard = Some(u32::MAX));
        refused("level.pixels", |c| c.level.pixels = Some(0.0));
        refused("level.pixels", |c| c.level.pixels = Some(f64::NAN));
        refused("level.near", |c| c.level.near = Some(f64::INFINITY));
        refused("level.level", |c| c.level.level = Some(0.5));
        refused("level.max_level", |c| c.level.max_level = Some(129.0));
        refused("hull.pixels", |c| c.hull.pixels = f64::NAN);
        refused("hull.candidates", |c| c.hull.candidates = 21);
        refused("domain.weight_bits", |c| c.domain.weight_bits = 15);
        refused("domain.cache_entries", |c| c.domain.cache_entries = Some(65537));
        refused("domain.width", |c| c.domain.width = 0);
        refused("domain.bytes_in", |c| c.domain.bytes_in = 65537);
        refused("domain.bytes_out", |c| c.domain.bytes_out = 65537);
        refused("block.domain.interval", |c| c.block.domain.interval = Some(0));
        refused("emit.subpixel_bits", |c| c.emit.subpixel_bits = 13);
        refused("place.reciprocal_bits", |c| c.place.reciprocal_bits = 7);
        refused("place.reciprocal_bits", |c| c.place.reciprocal_bits = 33);
        refused("link.header", |c| c.link.payload = 0);
        refused("link.bandwidth_mb_s", |c| c.link.bandwidth_mb_s = 0);
        refused("link.upstream_mb_s", |c| c.link.upstream_mb_s = 10_000_001);
        refused("link.request", |c| c.link.request = 0);
        refused("link.request_header", |c| c.link.request_header = 65537);
        refused("link.completion", |c| c.link.completion = 65537);
        refused("link.completion_header", |c| c.link.completion = 0);
        refused("link.latency", |c| c.link.latency = 1_000_001);
        refused("link.outstanding", |c| c.link.outstanding = 0);
        refused("memory.burst", |c| c.memory.burst = 0);
        refused("memory.bandwidth_mb_s", |c| c.memory.bandwidth_mb_s = 0);
        refused("memory.latency", |c| c.memory.latency = u32::MAX);
        refused("memory.outstanding", |c| c.memory.outstanding = 0);
        refused("memory.fifo", |c| c.memory.fifo = 0);
        refused("clock_mhz", |c| c.clock_mhz = 0);
        refused("clock_mhz", |c| c.clock_mhz = 100_001);
        refused("block.clip.interval", |c| c.block.clip.interval = 0);
        refused("block.level.latency", |c| c.block.level.latency = 1_000_001);
        refused("block.backface.interval", |c| c.block.backface.interval = Some(u32::MAX));
        refused("block.backface.latency", |c| c.block.backface.latency = Some(u32::MAX));
        refused("block.backface.interval", |c| {
            c.backface.method = BackfaceMethod::Off;
            c.block.backface.interval = Some(0);
        });
        refused("block.emit.lanes", |c| c.block.emit.lanes = 0);
        refused("block.emit.lanes", |c| c.block.emit.lanes = 4097);
        refused("block.stitch.fifo", |c| c.block.stitch.fifo = 0);
        refused("block.stitch.fifo", |c| c.block.stitch.fifo = 65537);
        refused("block.port.in_flight", |c| c.block.port.in_flight = Some(0));
        // 4096 x 1024 slots are as many as there may be; a latency of 1024 takes 1025 a lane.
        let lanes = |latency| {
            let mut config = Config::default();
            (config.block.port.lanes, config.block.port.latency) = (4096, latency);
            config.problem().map_err(|problem| problem.key)
        };
        assert_eq!((lanes(1023), lanes(1024)), (Ok(()), Err("block.port.lanes")));
        refused("block.evaluate.setup", |c| c.block.evaluate.setup = 1_000_001);
        refused("level.min_level", |c| {
            c.level.min_level = Some(4.0);
            c.level.max_level = Some(3.0);
        });
    }

    #[test]
    fn what_no_surface_shader_has_is_refused_by_its_key() {
        refused("esc.level_max", |c| c.esc.level_max = 16);
        refused("esc.fixed_level", |c| (c.esc.level, c.esc.level_max) = (LevelPolicy::Fixed, 2));
        refused("esc.full_distance", |c| c.esc.full_distance = f64::INFINITY);
        refused("esc.full_pixels", |c| c.esc.full_pixels = 0.0);
        refused("esc.mu", |c| c.esc.mu = -0.5);
        refused("esc.mu", |c| c.esc.mu = f64::NAN);
        refused("esc.scope", |c| c.esc.scope = LevelScope::Object);
        refused("esc.guard", |c| c.esc.guard = 21);
        refused("esc.guard", |c| (c.position.width, c.esc.guard) = (48, 8));
        refused("esc.parameter_bits", |c| c.esc.parameter_bits = 15);
        refused("esc.output_values", |c| c.esc.output_values = Some(131));
        refused("esc.width", |c| c.esc.width = 1025);
        refused("esc.registers", |c| c.esc.registers = 65537);
        refused("esc.register_file", |c| c.esc.register_file = 0);
        refused("esc.bytes_out", |c| c.esc.bytes_out = 3);
        refused("block.surface.net", |c| c.block.surface.net = 1_000_001);
        refused("block.surface.test", |c| c.block.surface.test = 1_000_001);
        refused("block.surface.point", |c| c.block.surface.point = 1_000_001);
        refused("block.surface.slot", |c| c.block.surface.slot = 1_000_001);
        // Under other policies its default may exceed a lower bound.
        let mut config = Config::default();
        config.esc.level_max = 2;
        assert_eq!(config.problem(), Ok(()));
    }

    #[test]
    fn a_criterion_needs_its_number_and_no_other() {
        let with = |criterion, pixels, level| {
            let mut config = Config::default();
            (config.level.criterion, config.level.pixels, config.level.level) =
                (criterion, pixels, level);
            config.problem().is_ok()
        };
        use Criterion::{EdgeLength, Fixed, Flatness};
        let (p, l) = (Some(0.5), Some(8.0));
        assert!(with(None, None, None) && with(None, p, None) && with(None, None, l));
        assert!(with(Some(Flatness), p, None) && with(Some(Fixed), None, l));
        assert!(!with(None, p, l) && !with(Some(Fixed), p, l) && !with(Some(Fixed), p, None));
        assert!(!with(Some(Flatness), None, l) && !with(Some(EdgeLength), None, None));
        assert!(!with(Some(EdgeLength), p, l));
    }

    #[test]
    fn the_default_guard_leaves_room_at_every_width() {
        for width in 8..=WIDTH_MAX {
            let mut config = Config::default();
            config.position.width = width;
            assert_eq!(config.problem(), Ok(()), "width {width}");
        }
    }
}
