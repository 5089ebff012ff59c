//! Unit `esc`: the surface-level shader of Concheiro, Amor, Boo, Padron 2014 as kernels. Patches
//! after the port in; vertices, triangles and counts out.
//!
//! ```text
//!   patches ─► clip ─► levels ─► tests ─► strips, counted ─► strips, written ─► points
//!                                33 coarse edges   18 coarse triangles         vertices
//! ```
//!
//! Each arrow is a buffer on the device; only what [`Made`] has is read back.

mod lot;
mod settings;

use super::device::Device;
use super::made::Made;
use super::settings::{PATCH, Settings};
use crate::config::Config;
use crate::error::Result;
use lot::Lot;
use rtl_model::number::Format;
use settings::POINTS;

/// Most patches that are on the device at a time.
const LOT: usize = 1024;

/// A batch of patches for the surface shader.
#[derive(Clone, Copy, Debug)]
pub struct Esc<'a> {
    /// The configuration.
    pub config: &'a Config,
    /// The frame's settings.
    pub settings: Settings,
    /// The position format.
    pub position: Format,
    /// The format of object space: as wide as the position format.
    pub object_format: Format,
    /// [`PATCH`] words a patch.
    pub patches: &'a [u32],
    /// Control points in object space, 128 words a patch: 16 points of 4 coordinates of 2 words.
    /// Needed where the configuration tests there.
    pub object: Option<&'a [u32]>,
    /// The level that the driver chose, a word a patch, where it chooses.
    pub object_levels: Option<&'a [u32]>,
    /// Components of a vertex's attributes, a word a patch.
    pub components: &'a [u32],
}

/// Levels and decisions, and nothing else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Decided {
    /// Twelve words a patch: levels of v0, u1, v1, u0 and the interior (all ones where it is
    /// clipped or culled); clamped, near, overflows; whether it is kept, whether levels were chosen
    /// by flatness, by length; 0.
    pub resolutions: Vec<u32>,
    /// 33 words a patch: of each coarse edge, bit s where the candidate of slot s is inserted.
    pub masks: Vec<u32>,
}

impl<'a> Esc<'a> {
    /// Patches of the batch.
    fn count(&self) -> usize {
        self.patches.len() / PATCH
    }

    /// Some of the patches.
    fn range(&self, first: usize, end: usize) -> Self {
        let part = |words: &'a [u32], each: usize| &words[each * first..each * end];
        Self {
            patches: part(self.patches, PATCH),
            object: self.object.map(|words| part(words, POINTS)),
            object_levels: self.object_levels.map(|words| part(words, 1)),
            components: part(self.components, 1),
            ..*self
        }
    }

    /// Ranges of patches whose buffers fit the device, whatever comes of them.
    fn lots(&self, device: &Device) -> impl Iterator<Item = Self> {
        let room = device.words_max() / lot::most_words(self.config);
        let (count, each) = (self.count(), room.clamp(1, LOT));
        (0..count).step_by(each).map(move |first| self.range(first, count.min(first + each)))
    }
}

/// Tessellates a batch of patches.
///
/// # Errors
/// [`crate::error::Error::Device`] where the device fails, or not even one patch fits it.
///
/// # Panics
/// When the inputs are not as long as the patches are many, or points in object space are missing.
pub fn esc(device: &Device, work: &Esc<'_>) -> Result<Made> {
    let mut made = Made { vertex_starts: vec![0], triangle_starts: vec![0], ..Made::default() };
    for part in work.lots(device) {
        let lot = Lot::resolved(device, part)?;
        append(&mut made, lot.tessellate()?);
    }
    Ok(made)
}

/// Chooses levels of a batch of patches, and candidates that are inserted.
///
/// # Errors
/// As [`esc`].
///
/// # Panics
/// As [`esc`].
pub fn decide(device: &Device, work: &Esc<'_>) -> Result<Decided> {
    let mut all = Decided::default();
    for part in work.lots(device) {
        let decided = Lot::resolved(device, part)?.decisions()?;
        all.resolutions.extend(decided.resolutions);
        all.masks.extend(decided.masks);
    }
    Ok(all)
}

/// Appends what came of the patches behind those of `made`.
fn append(made: &mut Made, part: Made) {
    let shifted = |starts: &mut Vec<u32>, more: &[u32]| {
        let before = starts.pop().expect("starts end with their sum");
        starts.extend(more.iter().map(|start| before + start));
    };
    shifted(&mut made.vertex_starts, &part.vertex_starts);
    shifted(&mut made.triangle_starts, &part.triangle_starts);
    made.fates.extend(part.fates);
    made.vertices.extend(part.vertices);
    made.screen.extend(part.screen);
    made.triangles.extend(part.triangles);
    for (name, count) in part.counts {
        match made.counts.iter_mut().find(|(other, _)| *other == name) {
            Some((_, sum)) if name.1.ends_with(".peak") => *sum = count.max(*sum),
            Some((_, sum)) => *sum += count,
            None => made.counts.push((name, count)),
        }
    }
}
