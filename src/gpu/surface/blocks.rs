//! The blocks behind the levels one by one: buffers in, buffers out. The chain is made of the same
//! functions that a comparison of single blocks calls.

use crate::error::Result;
use crate::gpu::device::{Buffer, Device};
use crate::gpu::kernel::Kernel;
use crate::gpu::settings::{Settings, VERTEX};
use std::ops::Range;

/// Words of a patch's plan, as plan.wgsl says.
pub const PLAN: usize = 56;

/// Words of a plan that are counted over all patches, from the first one.
pub const COUNTED: usize = 20;

/// Words of a line: the control points and the differences of a curve.
const LINE: usize = 80;

/// Invocations a patch for the lines that every patch has: eight of four coordinates.
const FIXED_LINES: usize = 32;

/// Which lists a patch has, and whence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Levels of four edges and two directions of the interior.
    Levels,
    /// The same, but the interior takes the greater level of the two edges along it.
    EdgeLevels,
    /// Masks of dyadic lists.
    Masks,
}

/// What place is given: all of them buffers of so many patches as the settings have items.
#[derive(Clone, Copy, Debug)]
pub struct Placing<'a> {
    /// The patches, for their criteria.
    pub patches: &'a Buffer,
    /// What culling left.
    pub fates: &'a Buffer,
    /// 12 words of levels a patch, or 28 of lists.
    pub levels: &'a Buffer,
    /// Components of a vertex's attributes, a word a patch.
    pub components: &'a Buffer,
    /// What `levels` holds.
    pub source: Source,
}

/// Where each patch's part of a common buffer begins, and behind the last one their number: on the
/// device and here.
#[derive(Clone, Debug)]
pub struct Starts {
    buffer: Buffer,
    /// The same words.
    pub words: Vec<u32>,
}

impl Starts {
    /// How many items these patches have.
    #[must_use]
    pub fn items(&self, patches: &Range<usize>) -> usize {
        (self.words[patches.end] - self.words[patches.start]) as usize
    }
}

/// The plans of a batch of patches.
#[derive(Clone, Debug)]
pub struct Placed {
    /// `PLAN` words a patch.
    pub plans: Buffer,
    /// Curves whose control points are kept for evaluation.
    pub lines: Starts,
    /// Vertices.
    pub vertices: Starts,
    /// Triangles.
    pub triangles: Starts,
    dyadic: bool,
}

/// Words that kernels count events in: coordinates that did not fit, vertices left homogeneous,
/// degenerate triangles, vertices without a tangent plane.
pub const EVENTS: usize = 4;

/// Places the settings' items.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn place(device: &Device, settings: &Settings, work: &Placing<'_>) -> Result<Placed> {
    let patches = settings.items as usize;
    let plans = device.empty(PLAN * patches)?;
    let dyadic = work.source == Source::Masks;
    let mut own = *settings;
    own.own[0] = dyadic.into();
    own.own[1] = u32::from(work.source == Source::EdgeLevels);
    let buffers = [work.patches, work.fates, work.levels, work.components, &plans];
    device.run(Kernel::Place, "place", &own, &buffers)?;
    let starts = |column| starts(device, &plans, patches, column);
    // The words LINES, VERTICES and TRIANGLES of a plan.
    let (lines, vertices, triangles) = (starts(20)?, starts(14)?, starts(19)?);
    Ok(Placed { plans, lines, vertices, triangles, dyadic })
}

fn starts(device: &Device, plans: &Buffer, patches: usize, column: u32) -> Result<Starts> {
    let buffer = device.empty(patches + 1)?;
    // One group.
    let mut settings = Settings::default().of(1);
    settings.own[..3].copy_from_slice(&[patches as u32, PLAN as u32, column]);
    device.run(Kernel::Scan, "scan", &settings, &[plans, &buffer])?;
    let words = device.read(&buffer, 0, patches + 1)?;
    Ok(Starts { buffer, words })
}

impl Placed {
    /// The sums of the first [`COUNTED`] words of all plans.
    ///
    /// # Errors
    /// As [`Device::run`].
    pub fn counts(&self, device: &Device) -> Result<Vec<u64>> {
        let sums = device.empty(2 * COUNTED)?;
        let mut settings = Settings::default().of(COUNTED);
        settings.own[..2].copy_from_slice(&[self.patches() as u32, PLAN as u32]);
        device.run(Kernel::Scan, "columns", &settings, &[&self.plans, &sums])?;
        let words = device.read(&sums, 0, 2 * COUNTED)?;
        Ok(words.chunks(2).map(|sum| u64::from(sum[1]) << 32 | u64::from(sum[0])).collect())
    }

    /// How many patches there are.
    #[must_use]
    pub fn patches(&self) -> usize {
        self.vertices.words.len() - 1
    }

    /// The patches in ranges of which no buffer has more words than this, as far as single patches
    /// have not.
    #[must_use]
    pub fn ranges(&self, words_max: usize) -> Vec<Range<usize>> {
        let mut ranges = Vec::new();
        let mut range = 0..0;
        for end in 1..=self.patches() {
            let longer = range.start..end;
            let words = [
                LINE * self.lines.items(&longer),
                VERTEX * self.vertices.items(&longer),
                3 * self.triangles.items(&longer),
            ];
            if words.into_iter().any(|words| words > words_max) && !range.is_empty() {
                ranges.push(range);
                range = end - 1..end;
            } else {
                range = longer;
            }
        }
        ranges.push(range);
        ranges
    }

    /// The settings with what the kernels behind place are told of a range.
    fn settings(&self, settings: &Settings, range: &Range<usize>, second: [u32; 2]) -> Settings {
        let mut own = *settings;
        let first = [u32::from(self.dyadic), range.start as u32, range.end as u32];
        own.own[..3].copy_from_slice(&first);
        own.own[3..5].copy_from_slice(&second);
        own
    }
}

/// The vertices of a range of patches, [`VERTEX`] words each. Coordinates that do not fit are added
/// to word 0 of `events`.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn evaluate(
    device: &Device,
    settings: &Settings,
    patches: &Buffer,
    placed: &Placed,
    range: &Range<usize>,
    events: &Buffer,
) -> Result<Buffer> {
    let (line_count, count) = (placed.lines.items(range), placed.vertices.items(range));
    let lines = device.empty(LINE * line_count)?;
    let vertices = device.empty(VERTEX * count)?;
    let first = [placed.lines.words[range.start], placed.vertices.words[range.start]];
    let own = placed.settings(settings, range, first);
    let starts = [&placed.lines.buffer, &placed.vertices.buffer];
    let buffers = [&placed.plans, starts[0], &lines, events, patches, starts[1], &vertices];
    let run = |entry, items| device.run(Kernel::Evaluate, entry, &own.of(items), &buffers);
    run("fixed_lines", FIXED_LINES * range.len())?;
    run("rows", 4 * line_count)?;
    run("evaluate", count)?;
    Ok(vertices)
}

/// The tangent planes at the vertices of a range of patches, four coefficients of two words each,
/// all 0 where there is none; these are added to word 3 of `events`.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn planes(
    device: &Device,
    settings: &Settings,
    placed: &Placed,
    range: &Range<usize>,
    [patches, vertices, events]: [&Buffer; 3],
) -> Result<Buffer> {
    let count = placed.vertices.items(range);
    let planes = device.empty(8 * count)?;
    let first = [0, placed.vertices.words[range.start]];
    let own = placed.settings(settings, range, first).of(count);
    let buffers = [patches, &placed.vertices.buffer, vertices, &planes, events];
    device.run(Kernel::Normal, "planes", &own, &buffers)?;
    Ok(planes)
}

/// The triangles of a range of patches, three words each: numbers of vertices within the patch.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn stitch(
    device: &Device,
    settings: &Settings,
    placed: &Placed,
    range: &Range<usize>,
) -> Result<Buffer> {
    let count = placed.triangles.items(range);
    let triangles = device.empty(3 * count)?;
    let first = [placed.triangles.words[range.start], placed.vertices.words[range.start]];
    let own = placed.settings(settings, range, first).of(count);
    let buffers = [&placed.triangles.buffer, &triangles, &placed.plans];
    device.run(Kernel::Stitch, "stitch", &own, &buffers)?;
    Ok(triangles)
}

/// Adds the triangles of a range that have two equal positions to word 2 of `events`.
///
/// # Errors
/// As [`Device::run`].
pub fn degenerate(
    device: &Device,
    settings: &Settings,
    placed: &Placed,
    range: &Range<usize>,
    [vertices, triangles, events]: [&Buffer; 3],
) -> Result<()> {
    let first = [placed.triangles.words[range.start], placed.vertices.words[range.start]];
    let own = placed.settings(settings, range, first).of(placed.triangles.items(range));
    let starts = [&placed.triangles.buffer, &placed.vertices.buffer];
    let buffers = [starts[0], triangles, &placed.plans, starts[1], vertices, events];
    device.run(Kernel::Stitch, "degenerate", &own, &buffers)
}

/// The screen positions of so many vertices of [`VERTEX`] words: x, y, whether it was divided.
/// Those that stay homogeneous are added to word 1 of `events`.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn emit(
    device: &Device,
    settings: &Settings,
    vertices: &Buffer,
    count: usize,
    events: &Buffer,
) -> Result<Buffer> {
    let screen = device.empty(3 * count)?;
    device.run(Kernel::Emit, "emit", &settings.of(count), &[vertices, &screen, events])?;
    Ok(screen)
}
