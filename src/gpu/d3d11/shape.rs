//! Shape: factors and control points in; vertices and triangles out, range by range, and what was
//! counted of them.

use super::Batch;
use super::pattern::{Domain, Laid, Output, Tessellation};
use super::starts::ranges;
use crate::config::{Arithmetic, Config, Form};
use crate::error::Result;
use crate::gpu::surface::{EVENTS, emit};
use crate::gpu::{Buffer, Kernel, Made, Settings, VERTEX, rounding};
use std::ops::Range;

/// Words of a net of one orientation.
const NET: usize = 128;

/// Where a vertex has u and v.
const SITE: usize = 8;

/// Orientations of a net: all where the form may crack.
fn orientations(config: &Config) -> usize {
    if config.is_order_invariant() { 1 } else { 8 }
}

/// Words of a patch's nets.
pub(super) fn net_words(config: &Config) -> usize {
    NET * orientations(config)
}

/// A batch whose factors are processed.
pub(super) struct Shape<'a> {
    batch: &'a Batch<'a>,
    rows: &'a Buffer,
    laid: Laid,
    nets: Buffer,
    /// Components and hull bytes, two words a patch.
    of_patch: Buffer,
    settings: Settings,
}

impl<'a> Shape<'a> {
    pub(super) fn new(batch: &'a Batch<'a>, factors: &Buffer, rows: &'a Buffer) -> Result<Self> {
        let (device, config) = (batch.device, batch.work.config);
        let tessellation = Tessellation {
            domain: Domain::Quad,
            partitioning: config.tessellator.partitioning,
            output: Output::Clockwise,
        };
        let laid = Laid::new(device, tessellation, factors, batch.len())?;
        let settings = settings(batch);
        let nets = device.empty(net_words(config) * batch.len())?;
        let control = match config.domain.arithmetic {
            Arithmetic::F32 => &batch.shaded,
            Arithmetic::Fixed => &batch.words,
        };
        let items = 4 * orientations(config) * batch.len();
        let buffers = [&batch.fates, control, &nets];
        device.run(Kernel::D3d11Domain, "turn", &settings.of(items), &buffers)?;
        let both = |k: usize| [batch.work.components[k], batch.work.hull_bytes[k]];
        let of_patch: Vec<u32> = batch.patches.clone().flat_map(both).collect();
        let of_patch = device.upload(&of_patch)?;
        Ok(Self { batch, rows, laid, nets, of_patch, settings })
    }

    /// Appends vertices and triangles, and counts them. Returns the vertices that stay homogeneous.
    pub(super) fn write(&self, made: &mut Made) -> Result<u64> {
        self.laid.points.append_to(&mut made.vertex_starts);
        self.laid.primitives.append_to(&mut made.triangle_starts);
        let lists = [(&self.laid.points, VERTEX), (&self.laid.primitives, 3)];
        let mut homogeneous = 0;
        for range in ranges(self.batch.device.words_max(), &lists) {
            homogeneous += self.write_range(&range, made)?;
        }
        Ok(homogeneous)
    }

    /// Appends screen positions. Returns the vertices that stay homogeneous.
    fn divide(&self, vertices: &Buffer, count: usize, made: &mut Made) -> Result<u64> {
        let device = self.batch.device;
        if !self.batch.work.config.divides() {
            return Ok(0);
        }
        let events = device.empty(EVENTS)?;
        let screen = emit(device, &self.batch.work.settings, vertices, count, &events)?;
        made.screen.extend(device.read(&screen, 0, 3 * count)?);
        Ok(device.read(&events, 1, 1)?[0].into())
    }

    fn write_range(&self, range: &Range<usize>, made: &mut Made) -> Result<u64> {
        let device = self.batch.device;
        let points = self.laid.points.items(range);
        let vertices = device.empty(VERTEX * points.len())?;
        self.laid.write_points(device, range, &vertices, [VERTEX, SITE])?;
        let settings = self.of(&points);
        let buffers = [&self.nets, &self.laid.points.buffer, &vertices, self.rows];
        device.run(Kernel::D3d11Domain, "domain", &settings, &buffers)?;
        if !self.batch.work.config.is_order_invariant() {
            device.run(Kernel::D3d11Domain, "cracks", &settings, &buffers)?;
        }
        let count = self.laid.primitives.items(range).len();
        let triangles = device.empty(3 * count)?;
        self.laid.write_primitives(device, range, &triangles)?;
        self.count(range, &vertices, &triangles)?;
        made.vertices.extend(device.read(&vertices, 0, VERTEX * points.len())?);
        made.triangles.extend(device.read(&triangles, 0, 3 * count)?);
        self.divide(&vertices, points.len(), made)
    }

    /// Looks at the points and triangles of a range.
    fn count(&self, range: &Range<usize>, vertices: &Buffer, triangles: &Buffer) -> Result<()> {
        let device = self.batch.device;
        let Laid { patterns, points, primitives, .. } = &self.laid;
        let run = |entry, settings: &Settings, buffers: &[&Buffer]| {
            device.run(Kernel::D3d11Count, entry, settings, buffers)
        };
        let mut settings = self.of(&primitives.items(range));
        settings.own[15] = points.items(range).start as u32;
        let buffers = [&primitives.buffer, vertices, triangles, self.rows, &points.buffer];
        run("triangles", &settings, &buffers)?;
        let settings = self.of(&points.items(range));
        run("edges", &settings, &[&points.buffer, patterns, vertices, self.rows])?;
        let brought = device.empty(points.items(range).len())?;
        let buffers = [
            &primitives.buffer,
            patterns,
            triangles,
            self.rows,
            &points.buffer,
            &brought,
            &self.of_patch,
        ];
        run("cache", &self.of(range), &buffers)
    }

    fn of(&self, items: &Range<usize>) -> Settings {
        Settings { first: items.start as u32, ..self.settings }.of(items.len())
    }
}

/// What the domain shader and the counts are told.
fn settings(batch: &Batch<'_>) -> Settings {
    let config = batch.work.config;
    let domain = &config.domain;
    let form = config.form();
    let fixed = domain.arithmetic == Arithmetic::Fixed;
    let mut settings = batch.work.settings;
    settings.own[3] = batch.len() as u32;
    settings.own[6..12].copy_from_slice(&[
        fixed.into(),
        match form {
            Form::Paired => 0,
            Form::Sequential => 1,
            Form::Power => 2,
        },
        // Horner multiplies by u itself, which has 16.
        if form == Form::Power { 16 } else { domain.weight_bits },
        orientations(config) as u32,
        batch.work.position.fraction.cast_unsigned(),
        rounding(config.position.rounding),
    ]);
    let entries = domain.cache_entries.unwrap_or(u32::MAX);
    settings.own[12..15].copy_from_slice(&[entries, domain.width, config.memory.burst]);
    settings
}
