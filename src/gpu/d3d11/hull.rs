//! Hull: levels, or control points in clip space, in; the factors that the hull shader writes out.

use super::Batch;
use super::pattern::{FACTORS, partitioning};
use crate::config::FactorPolicy;
use crate::error::Result;
use crate::gpu::{Buffer, Kernel, Settings};

/// Words of a candidate position, and curves of a patch that are tested.
const CANDIDATE: usize = 6;
const CURVES: usize = 8;

impl Batch<'_> {
    /// The factors, and the first words of the rows.
    pub(super) fn hull(&self, rows: &Buffer) -> Result<Buffer> {
        let settings = self.hull_settings();
        let chosen = match self.work.config.hull.policy {
            FactorPolicy::Criterion => self.levels(&settings)?,
            FactorPolicy::Adaptive => self.inserted(&settings)?,
        };
        let factors = self.device.empty(FACTORS * self.len())?;
        let buffers = [&self.words, &self.fates, &chosen, &factors, rows];
        self.device.run(Kernel::D3d11Hull, "hull", &settings, &buffers)?;
        Ok(factors)
    }

    fn hull_settings(&self) -> Settings {
        let config = self.work.config;
        let mut settings = self.work.settings.of(self.len());
        settings.own[..5].copy_from_slice(&[
            partitioning(config.tessellator.partitioning),
            u32::from(config.hull.policy == FactorPolicy::Adaptive),
            config.hull.candidates,
            (config.hull.pixels as f32).to_bits(),
            self.work.position.fraction.cast_unsigned(),
        ]);
        settings
    }

    /// Levels within what the partitioning reaches.
    fn levels(&self, settings: &Settings) -> Result<Buffer> {
        if let Some(levels) = &self.levels {
            return Ok(levels.clone());
        }
        self.device.run(Kernel::D3d11Hull, "reach", settings, &[&self.words])?;
        let settings = self.work.settings.of(self.len());
        crate::gpu::level(self.device, &settings, &self.words, &self.fates)
    }

    /// How many vertices the distance test inserts on each curve.
    fn inserted(&self, settings: &Settings) -> Result<Buffer> {
        let positions = 3 * (self.work.config.hull.candidates as usize + 1);
        let table = self.device.empty(CANDIDATE * positions)?;
        let run = |entry, items, buffers: &[&Buffer]| {
            self.device.run(Kernel::D3d11Hull, entry, &settings.of(items), buffers)
        };
        run("candidates", positions, &[&table])?;
        let inserted = self.device.empty(CURVES * self.len())?;
        let buffers = [&self.fates, &self.shaded, &table, &inserted];
        run("insert", CURVES * self.len(), &buffers)?;
        Ok(inserted)
    }
}
