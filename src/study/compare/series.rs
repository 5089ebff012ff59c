//! Series: a run in, every number of it out: over the whole run, and frame by frame with the least,
//! the median and the most of them.
//!
//! First the rows of the report, then what follows from it and from what was seen on the screen.
//! `docs/compare.md` defines each.

use super::Run;
use super::gauge::Seen;
use crate::output::summary::ratio;
use crate::report::{Frame, Report};
use crate::study::energy::{self, Prices};
use crate::study::raster::LEAST;
use rtl_model::counter::{Block, Counter as C, Counters};
use std::cmp::Ordering;
use std::fmt;

/// A number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A counter.
    Count(u64),
    /// What is computed from counters, or measured in f64.
    Real(f64),
}

impl Value {
    /// As a real number.
    #[must_use]
    pub const fn real(self) -> f64 {
        match self {
            Self::Count(count) => count as f64,
            Self::Real(real) => real,
        }
    }

    /// Two of a series, which are of one kind.
    fn order(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Count(a), Self::Count(b)) => a.cmp(b),
            _ => self.real().total_cmp(&other.real()),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(count) => write!(f, "{count}"),
            Self::Real(real) => write!(f, "{real:.6}"),
        }
    }
}

/// A number with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// The block, or what takes its place: `screen`, `error`, `energy`.
    pub block: &'static str,
    /// The name within the block.
    pub name: String,
    /// The unit of measurement.
    pub measure: &'static str,
    /// `None` where there is nothing to divide by.
    pub value: Option<Value>,
}

/// A number of a run, and what it was in the frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Over the whole run.
    pub whole: Number,
    /// In each frame.
    pub frames: Vec<Option<Value>>,
}

impl Series {
    /// The least, the median and the most of the frames that have it: of an even number of them the
    /// median is the lower of the middle two.
    #[must_use]
    pub fn spread(&self) -> Option<[Value; 3]> {
        let mut values: Vec<Value> = self.frames.iter().copied().flatten().collect();
        values.sort_by(Value::order);
        let last = values.len().checked_sub(1)?;
        Some([values[0], values[last / 2], values[last]])
    }
}

/// Every number of a run, in the order of reports.
///
/// # Panics
/// When what was seen is of other frames than the report.
#[must_use]
pub fn series(run: &Run) -> Vec<Series> {
    let Run { report, seen } = run;
    assert_eq!(report.frames.len(), seen.len(), "every frame was seen");
    let (mut resident, mut meshes) = (0, 0);
    let frames = report.frames.iter().zip(seen).map(|(frame, seen)| {
        resident += written_to_stay(&frame.counters);
        meshes = frame.counters.get(C::MemoryMeshesPeak).max(meshes);
        numbers(report, frame, seen, 1, resident + meshes)
    });
    let frames: Vec<Vec<Number>> = frames.collect();
    let whole =
        numbers(report, &report.whole(), &whole(seen), seen.len() as u64, resident + meshes);
    let of = |(k, whole): (usize, Number)| {
        let frames = frames.iter().map(|numbers| numbers[k].value).collect();
        Series { whole, frames }
    };
    whole.into_iter().enumerate().map(of).collect()
}

/// All frames as one.
#[must_use]
pub(super) fn whole(seen: &[Seen]) -> Seen {
    seen.iter().fold(Seen::default(), Seen::with)
}

/// Bytes of points and attributes that go into device memory to stay there.
fn written_to_stay(counters: &Counters) -> u64 {
    let kinds = [C::MemoryWrittenControlPoints, C::MemoryWrittenAttributes];
    kinds.map(|kind| counters.get(kind)).iter().sum()
}

/// Energy in picojoules: operations, bytes on the chip, of device memory, over the link.
pub(super) fn energies(report: &Report, frame: &Frame) -> [f64; 4] {
    let prices = Prices::default();
    let (_, operations, _) = energy::operations(report, frame, &prices);
    // Without the block nobody reads what its counters would say.
    let memory = report.blocks.contains(&Block::Memory);
    let bursts = if memory { frame.counters.get(C::MemoryBursts) } else { 0 };
    let bursts = bursts * u64::from(report.config.memory.burst);
    let bytes = [energy::chip_bytes(&frame.counters), bursts, frame.counters.get(C::LinkTotal)];
    let [chip, memory, link] = bytes.map(|bytes| bytes as f64);
    [operations, chip * prices.chip_byte, memory * prices.memory_byte, link * prices.link_byte]
}

fn numbers(
    report: &Report,
    frame: &Frame,
    seen: &Seen,
    frames: u64,
    footprint: u64,
) -> Vec<Number> {
    let rows = report.rows(frame).into_iter().map(|row| Number {
        block: row.block.name(),
        name: row.name,
        measure: row.measure.name(),
        value: Some(Value::Count(row.value)),
    });
    let mut all: Vec<Number> = rows.collect();
    let mut put = |block, name: &str, measure, value: Option<Value>| {
        all.push(Number { block, name: name.to_owned(), measure, value });
    };
    let real = |value: Option<f64>| value.map(Value::Real);
    if let Some(times) = &frame.times {
        let clock = u64::from(report.config.clock_mhz);
        let per_second = ratio(frames * clock * 1_000_000, times.elapsed);
        put("unit", "time", "ms", real(ratio(times.elapsed, 1000 * clock)));
        put("unit", "frames", "1/s", real(per_second));
    }
    if report.blocks.contains(&Block::Memory) {
        put("memory", "footprint", "bytes", Some(Value::Count(footprint)));
    }
    screen(seen, &mut put);
    let deviation = &seen.deviation;
    let measured = deviation.samples > 0;
    put("error", "samples", "count", Some(Value::Count(deviation.samples)));
    put("error", "largest", "pixels", real(measured.then_some(deviation.largest_pixels)));
    put("error", "mean", "pixels", real(measured.then(|| deviation.mean_pixels())));
    let energies = energies(report, frame);
    for (name, energy) in ["operations", "chip", "memory", "link"].iter().zip(energies) {
        put("energy", name, "pJ", Some(Value::Real(energy)));
    }
    put("energy", "total", "pJ", Some(Value::Real(energies.iter().sum())));
    all
}

fn screen(seen: &Seen, put: &mut impl FnMut(&'static str, &str, &'static str, Option<Value>)) {
    let t = &seen.triangles;
    let classes = [
        ("triangles.to_clipper", t.homogeneous),
        ("triangles.zero_area", t.zero_area),
        ("triangles.outside", t.outside),
        ("triangles.front", t.front),
        ("triangles.back", t.back),
        ("triangles.sub_pixel", t.sub_pixel()),
        ("triangles.no_sample", t.no_sample),
    ];
    for (name, count) in classes {
        put("screen", name, "count", Some(Value::Count(count)));
    }
    for (k, count) in t.areas.iter().enumerate() {
        put("screen", &area(k), "count", Some(Value::Count(*count)));
    }
    for (name, count) in [("samples", t.samples), ("quads", t.quads), ("pixels", seen.pixels)] {
        put("screen", name, "count", Some(Value::Count(count)));
    }
    let rates = [
        ("quad_efficiency", ratio(t.samples, 4 * t.quads)),
        ("samples_per_pixel", ratio(t.samples, seen.pixels)),
        ("triangles_per_pixel", ratio(t.all(), seen.pixels)),
    ];
    for (name, rate) in rates {
        put("screen", name, "ratio", rate.map(Value::Real));
    }
}

/// The name of a class of areas: `area.below.1/64`, then `area.from.` its least in square pixels.
pub(super) fn area(class: usize) -> String {
    match class {
        0 => format!("area.below.{}", bound(1)),
        class => format!("area.from.{}", bound(class)),
    }
}

/// The least area of a class from 1 on, in square pixels.
pub(super) fn bound(class: usize) -> String {
    match LEAST + class as i64 - 1 {
        exponent @ ..0 => format!("1/{}", 1 << (-2 * exponent)),
        exponent => (1 << (2 * exponent)).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::timed_report;
    use crate::study::raster::CLASSES;

    #[test]
    fn areas_are_named_by_their_bounds() {
        let names: Vec<String> = (0..CLASSES).map(area).collect();
        assert_eq!(names[..3], ["area.below.1/64", "area.from.1/64", "area.from.1/16"]);
        assert_eq!(names[4..6], ["area.from.1", "area.from.4"]);
        assert_eq!(names[10], "area.from.4096");
    }

    #[test]
    fn frames_have_a_least_a_median_and_a_most_and_add_up() {
        let mut report = timed_report();
        report.blocks = &[Block::Memory, Block::Emit];
        report.frames[1].counters.add(C::EmitTriangles, 5);
        report.frames[1].counters.add(C::MemoryWrittenControlPoints, 70);
        let mut seen = [Seen { pixels: 3, ..Seen::default() }, Seen::default()];
        seen[1].triangles.front = 8;
        let all = series(&Run { report, seen: seen.to_vec() });
        let of = |block: &str, name: &str| {
            let found = all.iter().find(|s| s.whole.block == block && s.whole.name == name);
            found.unwrap_or_else(|| panic!("{block}.{name}")).clone()
        };
        let count = |n| Some(Value::Count(n));
        let triangles = of("emit", "triangles");
        let [first, second] =
            [triangles.frames[0].unwrap().real(), triangles.frames[1].unwrap().real()];
        assert_eq!(triangles.whole.value.unwrap().real(), first + second);
        let spread = triangles.spread().unwrap().map(Value::real);
        assert_eq!(spread, [first.min(second), first.min(second), first.max(second)]);
        assert_eq!(of("memory", "footprint").frames, [count(0), count(70)]);
        assert_eq!(of("memory", "footprint").whole.value, count(70));
        // A ratio of the whole is of sums, and there is none where there are no pixels.
        assert_eq!(of("screen", "triangles_per_pixel").whole.value, Some(Value::Real(8.0 / 3.0)));
        assert_eq!(of("screen", "triangles_per_pixel").frames, [Some(Value::Real(0.0)), None]);
        assert_eq!(of("screen", "triangles_per_pixel").spread().unwrap(), [Value::Real(0.0); 3]);
        // 200 cycles at 2000 MHz for two frames.
        let rate = of("unit", "frames").whole.value.unwrap().real();
        assert!((rate / 2e7 - 1.0).abs() < 1e-12, "{rate}");
        assert_eq!(of("error", "largest").whole.value, None);
    }
}
