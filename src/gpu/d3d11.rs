//! Unit `d3d11` as kernels: patches in, vertices, triangles and counts out.
//!
//! ```text
//!   clip ─► backface ─► level ─► hull ─► factors ─► points ─► domain ─► counts
//!                       or the distance test     └► connect ┘
//! ```
//!
//! What is culled has factors of 0, of which the tessellator makes nothing: nothing behind it asks
//! for fates. Batches are as long as a buffer can hold, and what a batch makes is written in ranges
//! of patches that fit.

mod counts;
mod hull;
mod pattern;
mod shape;
mod starts;

pub use pattern::{Domain, FACTORS, Output, Patterns, Tessellation, patterns};

use super::{Buffer, Device, Kernel, LEVELS, Made, PATCH, Settings};
use crate::config::Config;
use crate::error::Result;
use rtl_model::number::Format;
use shape::Shape;

/// Words of a patch's control points as the shaders have them: x, y, z, w of 16, f32 bits.
pub const SHADED: usize = 64;

/// Words of a patch's fate.
const FATE: usize = 4;

/// Patches of a batch at most: what adds up their rows goes through them in a loop, and lavapipe
/// ends the loops of an invocation after 65535 turns.
const BATCH_MAX: usize = 1 << 15;

/// A batch of patches, in the order of draws.
#[derive(Clone, Copy, Debug)]
pub struct D3d11<'a> {
    /// What the unit does.
    pub config: &'a Config,
    /// The frame's.
    pub settings: Settings,
    /// The format of positions.
    pub position: Format,
    /// [`PATCH`] words a patch, quantised.
    pub patches: &'a [u32],
    /// [`SHADED`] words a patch, in clip space.
    pub shaded: &'a [u32],
    /// Components of the attributes of a vertex, a word a patch.
    pub components: &'a [u32],
    /// Bytes that the hull shader hands on, a word a patch.
    pub hull_bytes: &'a [u32],
}

/// What the blocks before the hull shader say of a batch, where they do not run.
#[derive(Clone, Copy, Debug)]
pub struct Chosen<'a> {
    /// Four words a patch.
    pub fates: &'a [u32],
    /// [`LEVELS`] words a patch.
    pub levels: &'a [u32],
}

/// A batch through the whole unit.
///
/// # Errors
/// What the device objects to.
///
/// # Panics
/// When the words of `work` are not those of as many patches.
pub fn d3d11(device: &Device, work: &D3d11<'_>) -> Result<Made> {
    whole(device, work, None)
}

/// The same from the hull shader on, with fates and levels that are given.
///
/// # Errors
/// What the device objects to.
///
/// # Panics
/// When the words of `work` and `chosen` are not those of as many patches.
pub fn from_hull(device: &Device, work: &D3d11<'_>, chosen: Chosen<'_>) -> Result<Made> {
    whole(device, work, Some(chosen))
}

fn whole(device: &Device, work: &D3d11<'_>, chosen: Option<Chosen<'_>>) -> Result<Made> {
    let patches = work.components.len();
    let lengths = [work.patches.len() / PATCH, work.shaded.len() / SHADED, work.hull_bytes.len()];
    assert_eq!(lengths, [patches; 3], "words of as many patches");
    let widest = PATCH.max(shape::net_words(work.config)).max(counts::ROW);
    let most = (device.words_max() / widest).clamp(1, BATCH_MAX);
    let mut made = Made { vertex_starts: vec![0], triangle_starts: vec![0], ..Made::default() };
    let mut sums = [0; counts::SUMS];
    for first in (0..patches).step_by(most) {
        let end = patches.min(first + most);
        let batch = Batch::new(device, work, first..end, chosen)?;
        batch.run(&mut made, &mut sums)?;
    }
    made.counts = counts::of(&sums, work.config);
    Ok(made)
}

/// Patches that a device holds at once.
struct Batch<'a> {
    device: &'a Device,
    work: &'a D3d11<'a>,
    patches: std::ops::Range<usize>,
    words: Buffer,
    shaded: Buffer,
    fates: Buffer,
    /// Levels that are given.
    levels: Option<Buffer>,
}

impl<'a> Batch<'a> {
    fn new(
        device: &'a Device,
        work: &'a D3d11<'a>,
        patches: std::ops::Range<usize>,
        chosen: Option<Chosen<'_>>,
    ) -> Result<Self> {
        let upload = |words: &[u32], each: usize| {
            device.upload(&words[each * patches.start..each * patches.end])
        };
        let words = upload(work.patches, PATCH)?;
        let fates = match chosen {
            Some(chosen) => upload(chosen.fates, FATE)?,
            None => {
                let fates = device.empty(FATE * patches.len())?;
                let settings = work.settings.of(patches.len());
                device.run(Kernel::Clip, "clip", &settings, &[&words, &fates])?;
                crate::gpu::backface(device, &settings, &words, &fates)?;
                fates
            }
        };
        let levels = chosen.map(|chosen| upload(chosen.levels, LEVELS)).transpose()?;
        let shaded = upload(work.shaded, SHADED)?;
        Ok(Self { device, work, patches, words, shaded, fates, levels })
    }

    /// How many patches.
    fn len(&self) -> usize {
        self.patches.len()
    }

    /// Appends what comes of it, and adds up what is counted.
    fn run(&self, made: &mut Made, sums: &mut [u64; counts::SUMS]) -> Result<()> {
        let rows = self.device.empty(counts::ROW * self.len())?;
        let factors = self.hull(&rows)?;
        let homogeneous = Shape::new(self, &factors, &rows)?.write(made)?;
        sums[counts::ROW] += homogeneous;
        made.fates.extend(self.device.read(&self.fates, 0, FATE * self.len())?);
        counts::add(self.device, &rows, self.len(), sums)
    }
}
