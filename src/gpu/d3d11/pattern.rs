//! Pattern: tessellation factors in, the fixed-function tessellator's points and primitives out, in
//! its order; for all domains, partitionings and outputs.

use super::starts::{Starts, ranges};
use crate::config::Partitioning;
use crate::error::{Error, Result};
use crate::gpu::{Buffer, Device, Kernel, Settings};
use std::ops::Range;

/// Words of a patch's factors, whatever its domain.
pub const FACTORS: usize = 6;

/// Words of a processed pattern, and which of them count points and primitives.
pub(super) const PATTERN: usize = 16;
const POINTS: usize = 14;
const PRIMITIVES: usize = 15;

/// Patches of a batch at most: sums over them are 64 loops side by side, twice, and lavapipe ends
/// the loops of an invocation after 65535 turns.
const BATCH_MAX: usize = 1 << 20;

/// What is tessellated, as the kernels number it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The unit square: six factors.
    Quad,
    /// The triangle u + v + w = 1: four.
    Tri,
    /// Lines of constant v: two.
    Isoline,
}

/// What the indices make, as the kernels number it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Points.
    Point,
    /// Lines.
    Line,
    /// Triangles, clockwise with v down.
    Clockwise,
    /// Triangles, counter-clockwise with v down.
    CounterClockwise,
}

impl Output {
    /// Numbers of points in a primitive.
    #[must_use]
    pub const fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Clockwise | Self::CounterClockwise => 3,
        }
    }
}

/// What the patterns of a batch have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tessellation {
    /// What is tessellated.
    pub domain: Domain,
    /// How a factor becomes segments.
    pub partitioning: Partitioning,
    /// What the indices make.
    pub output: Output,
}

/// The patterns of a batch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Patterns {
    /// Where each patch's points begin, and behind the last one their number.
    pub point_starts: Vec<u32>,
    /// Where each patch's primitives begin, and behind the last one their number.
    pub primitive_starts: Vec<u32>,
    /// Two words a point: u, v in U1.16.
    pub points: Vec<u32>,
    /// Numbers of points within the patch, as many a primitive as it has corners.
    pub indices: Vec<u32>,
}

/// The patterns of factors given as f32 bits, [`FACTORS`] words a patch, in the order of Direct3D;
/// of those that cull, nothing.
///
/// # Errors
/// [`Error::Usage`] where triangles are asked of isolines; what the device objects to.
pub fn patterns(device: &Device, tessellation: Tessellation, factors: &[u32]) -> Result<Patterns> {
    if tessellation.domain == Domain::Isoline && tessellation.output.corners() == 3 {
        return Err(Error::Usage("an isoline domain has points and lines, no triangles".into()));
    }
    let mut made = Patterns { point_starts: vec![0], primitive_starts: vec![0], ..<_>::default() };
    let most = (device.words_max() / (PATTERN + 1)).clamp(1, BATCH_MAX);
    for chunk in factors.chunks(FACTORS * most) {
        let patches = chunk.len() / FACTORS;
        let laid = Laid::new(device, tessellation, &device.upload(chunk)?, patches)?;
        laid.points.append_to(&mut made.point_starts);
        laid.primitives.append_to(&mut made.primitive_starts);
        let corners = tessellation.output.corners();
        let lists = [(&laid.points, 2), (&laid.primitives, corners)];
        for range in ranges(device.words_max(), &lists) {
            let points = 2 * laid.points.items(&range).len();
            let out = device.empty(points)?;
            laid.write_points(device, &range, &out, [2, 0])?;
            made.points.extend(device.read(&out, 0, points)?);
            let indices = corners * laid.primitives.items(&range).len();
            let out = device.empty(indices)?;
            laid.write_primitives(device, &range, &out)?;
            made.indices.extend(device.read(&out, 0, indices)?);
        }
    }
    Ok(made)
}

/// Processed factors on the device, and where what they make begins.
pub(super) struct Laid {
    pub(super) patterns: Buffer,
    pub(super) points: Starts,
    pub(super) primitives: Starts,
    settings: Settings,
}

impl Laid {
    /// Processes the factors of so many patches.
    pub(super) fn new(
        device: &Device,
        tessellation: Tessellation,
        factors: &Buffer,
        patches: usize,
    ) -> Result<Self> {
        let mut settings = Settings::default().of(patches);
        settings.own[..4].copy_from_slice(&[
            tessellation.domain as u32,
            partitioning(tessellation.partitioning),
            tessellation.output as u32,
            settings.items,
        ]);
        let patterns = device.empty(PATTERN * patches)?;
        device.run(Kernel::D3d11, "process", &settings, &[factors, &patterns])?;
        let points = Starts::of(device, &patterns, patches, [PATTERN, POINTS])?;
        let primitives = Starts::of(device, &patterns, patches, [PATTERN, PRIMITIVES])?;
        Ok(Self { patterns, points, primitives, settings })
    }

    /// The settings of a kernel with an invocation for each of these items.
    pub(super) fn settings(&self, items: &Range<usize>) -> Settings {
        Settings { first: items.start as u32, ..self.settings }.of(items.len())
    }

    /// Writes the points of a range of patches, at a place in each so many words.
    pub(super) fn write_points(
        &self,
        device: &Device,
        patches: &Range<usize>,
        out: &Buffer,
        [stride, place]: [usize; 2],
    ) -> Result<()> {
        let mut settings = self.settings(&self.points.items(patches));
        settings.own[4..6].copy_from_slice(&[stride as u32, place as u32]);
        let buffers = [&self.patterns, &self.points.buffer, out];
        device.run(Kernel::D3d11Points, "points", &settings, &buffers)
    }

    /// Writes the primitives of a range of patches.
    pub(super) fn write_primitives(
        &self,
        device: &Device,
        patches: &Range<usize>,
        out: &Buffer,
    ) -> Result<()> {
        let settings = self.settings(&self.primitives.items(patches));
        let buffers = [&self.patterns, &self.primitives.buffer, out];
        device.run(Kernel::D3d11Connect, "connect", &settings, &buffers)
    }
}

/// A partitioning's number.
pub(super) fn partitioning(partitioning: Partitioning) -> u32 {
    match partitioning {
        Partitioning::Integer => 0,
        Partitioning::Pow2 => 1,
        Partitioning::Odd => 2,
        Partitioning::Even => 3,
    }
}
