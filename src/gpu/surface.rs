//! The units whose patches have lists of parameters, `hybrid`, `triangles`, `moreton` and `sfarti`,
//! from clip to emit: patches and a configuration in, what was made and counted out.
//!
//! ```text
//!   patches ─► clip ─► backface ─► level ─► place ─► evaluate ─► stitch ─► emit
//!              not in moreton      lists             a range of patches after the other
//! ```
//!
//! A batch is cut where a buffer would be larger than a binding may be: first so that the patches
//! and their plans fit, then, as the sums over plans say, so that vertices and triangles do.

mod blocks;
mod counts;

use super::backface::backface;
use super::device::{Buffer, Device};
use super::kernel::Kernel;
use super::level::{level, subdivide};
use super::made::Made;
use super::settings::{PATCH, Settings, VERTEX};
use crate::config::{Config, Normals, Union, Unit};
use crate::error::{Error, Result};
use counts::Counts;
use std::ops::Range;

pub use blocks::{
    COUNTED, EVENTS, PLAN, Placed, Placing, Source, Starts, degenerate, emit, evaluate, place,
    planes, stitch,
};

/// Patches that are placed at once, at most: a kernel that sums over them turns once for each, and
/// some drivers end loops that turn 2^16 times.
const CHUNK_MAX: usize = 1 << 15;

/// A batch of patches of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// The configuration.
    pub config: &'a Config,
    /// What kernels are told of it and of the frame; the format is that of the patches.
    pub settings: Settings,
    /// [`PATCH`] words a patch.
    pub patches: &'a [u32],
    /// The same patches in clip space, where levels are chosen from these.
    pub seen: Option<&'a [u32]>,
    /// Components of a vertex's attributes, a word a patch.
    pub components: &'a [u32],
}

/// Takes a batch through all blocks.
///
/// # Errors
/// [`Error::Usage`] for a unit that has no such blocks, and where patches share lists
/// (`level.union`), which is not done here; [`Error::Device`] where the device fails, or a patch
/// alone does not fit it.
///
/// # Panics
/// When there are not as many components, or patches seen, as patches.
pub fn surface(device: &Device, work: &Surface<'_>) -> Result<Made> {
    let config = work.config;
    if matches!(config.unit, Unit::D3d11 | Unit::Esc) {
        let unit = config.unit.name();
        return Err(Error::Usage(format!("unit {unit} has no lists: it has kernels of its own")));
    }
    if config.union() == Union::Primitive {
        return Err(Error::Usage(
            "level.union = \"primitive\": patches that share lists have no kernels; expected \
             \"off\""
                .into(),
        ));
    }
    let patches = work.patches.len() / PATCH;
    assert_eq!(work.components.len(), patches, "a word of components a patch");
    assert!(work.seen.is_none_or(|seen| seen.len() == work.patches.len()), "seen as they are");
    let mut batch = Batch { device, work, made: Made::default(), counts: Counts::default() };
    batch.made.vertex_starts.push(0);
    batch.made.triangle_starts.push(0);
    // Patches have more words than their plans have.
    let most = (device.words_max() / PATCH).clamp(1, CHUNK_MAX);
    for first in (0..patches).step_by(most) {
        batch.chunk(first..(first + most).min(patches))?;
    }
    batch.made.counts = batch.counts.named(config, patches);
    Ok(batch.made)
}

struct Batch<'a> {
    device: &'a Device,
    work: &'a Surface<'a>,
    made: Made,
    counts: Counts,
}

impl Batch<'_> {
    /// Patches that fit the device at once.
    fn chunk(&mut self, chunk: Range<usize>) -> Result<()> {
        let (device, work) = (self.device, self.work);
        let words = |all: &[u32]| device.upload(&all[PATCH * chunk.start..PATCH * chunk.end]);
        let settings = work.settings.of(chunk.len());
        let patches = words(work.patches)?;
        let seen = work.seen.map(words).transpose()?;
        let fates = self.cull(&settings, &patches)?;
        let components = device.upload(&work.components[chunk])?;
        let (source, levels) = self.levels(&settings, seen.as_ref().unwrap_or(&patches), &fates)?;
        self.made.levels.extend(device.read(&levels, 0, levels.words())?);
        let placing = Placing {
            patches: &patches,
            fates: &fates,
            levels: &levels,
            components: &components,
            source,
        };
        let placed = place(device, &settings, &placing)?;
        self.counts.add_plans(&placed.counts(device)?);
        append_starts(&mut self.made.vertex_starts, &placed.vertices);
        append_starts(&mut self.made.triangle_starts, &placed.triangles);
        for range in placed.ranges(device.words_max()) {
            self.shape(&settings, &patches, &placed, &range)?;
        }
        Ok(())
    }

    /// Clip and backface.
    fn cull(&mut self, settings: &Settings, patches: &Buffer) -> Result<Buffer> {
        let count = settings.items as usize;
        if !counts::culls(self.work.config) {
            return self.device.upload(&[2, 0, 0, 0].repeat(count));
        }
        let fates = self.device.empty(4 * count)?;
        self.device.run(Kernel::Clip, "clip", settings, &[patches, &fates])?;
        backface(self.device, settings, patches, &fates)?;
        self.made.fates.extend(self.device.read(&fates, 0, 4 * count)?);
        Ok(fates)
    }

    /// Levels or lists, from the patches as they are seen.
    fn levels(
        &self,
        settings: &Settings,
        seen: &Buffer,
        fates: &Buffer,
    ) -> Result<(Source, Buffer)> {
        Ok(match self.work.config.unit {
            Unit::Sfarti => (Source::Masks, subdivide(self.device, settings, seen, fates)?),
            Unit::Moreton => (Source::EdgeLevels, level(self.device, settings, seen, fates)?),
            _ => (Source::Levels, level(self.device, settings, seen, fates)?),
        })
    }

    /// The points and triangles of a range of patches.
    fn shape(
        &mut self,
        settings: &Settings,
        patches: &Buffer,
        placed: &Placed,
        range: &Range<usize>,
    ) -> Result<()> {
        let device = self.device;
        let count = placed.vertices.items(range);
        let events = device.empty(EVENTS)?;
        let vertices = evaluate(device, settings, patches, placed, range, &events)?;
        let triangles = stitch(device, settings, placed, range)?;
        degenerate(device, settings, placed, range, [&vertices, &triangles, &events])?;
        if self.work.config.evaluate.normals == Normals::TangentPlane {
            planes(device, settings, placed, range, [patches, &vertices, &events])?;
        }
        let made = &mut self.made;
        if self.work.config.divides() {
            let screen = emit(device, settings, &vertices, count, &events)?;
            made.screen.extend(device.read(&screen, 0, 3 * count)?);
        }
        made.vertices.extend(device.read(&vertices, 0, VERTEX * count)?);
        made.triangles.extend(device.read(&triangles, 0, 3 * placed.triangles.items(range))?);
        self.counts.add_events(&device.read(&events, 0, EVENTS)?);
        Ok(())
    }
}

/// Appends where the patches of a chunk begin behind those before it.
fn append_starts(all: &mut Vec<u32>, starts: &Starts) {
    let before = all.pop().expect("starts end with their number");
    all.extend(starts.words.iter().map(|start| before + start));
}
