//! A lot: so many patches as fit the device, taken through the kernels one after another.

use super::settings::{POINTS, Tests, own, policy, sections, turns};
use super::{Decided, Esc};
use crate::config::{Boundary, Config};
use crate::error::Result;
use crate::gpu::backface;
use crate::gpu::device::{Buffer, Device};
use crate::gpu::kernel::Kernel;
use crate::gpu::made::{Made, Name};
use crate::gpu::settings::{PATCH, Settings, VERTEX};
use crate::gpu::surface;

mod counts;

/// Words, as esc_pattern.wgsl and the kernels' texts have them.
const RESOLUTION: usize = 12;
const COARSE_EDGES: usize = 33;
const COARSE_TRIANGLES: usize = 18;
const DECISION: usize = 2;
const CROSSINGS: usize = 49 * 49;
const WALK: usize = 8;
const COST: usize = 16;
const NET: usize = 128;
const PROJECTION: usize = 5;
const EVENTS: usize = 2;

/// Sections of a patch that a dispatch counts, and rows that are summed as one: so that no
/// invocation's loops are long, as esc_count.wgsl says.
const SECTIONS: u32 = 8;
const BLOCK: usize = 1024;

/// Most words of any buffer that a patch may take.
pub(super) fn most_words(config: &Config) -> usize {
    let segments = config.esc.level_max as usize + 1;
    let vertices = (3 * segments + 1).pow(2) * VERTEX;
    let triangles = COARSE_TRIANGLES * segments * segments * 3;
    vertices.max(triangles).max(CROSSINGS).max(NET * turns(config))
}

/// Patches whose levels are known.
pub(super) struct Lot<'a> {
    device: &'a Device,
    work: Esc<'a>,
    settings: Settings,
    patches: Buffer,
    fates: Buffer,
    resolutions: Buffer,
}

/// The vertices and triangles of a lot, on the device.
struct Mesh {
    /// Behind the last coarse triangle, their sums.
    starts: [Vec<u32>; 2],
    start_buffers: [Buffer; 2],
    walks: Buffer,
    sites: Buffer,
    triangles: Buffer,
}

impl<'a> Lot<'a> {
    /// Clips, and chooses levels.
    pub(super) fn resolved(device: &'a Device, work: Esc<'a>) -> Result<Self> {
        let count = work.count();
        assert_eq!(work.components.len(), count, "components of each patch");
        let settings = Settings { own: own(&work), ..work.settings };
        let lot = Self {
            device,
            work,
            settings,
            patches: device.upload(work.patches)?,
            fates: device.empty(4 * count)?,
            resolutions: device.empty(RESOLUTION * count)?,
        };
        lot.run(Kernel::Clip, "clip", count, &[&lot.patches, &lot.fates])?;
        backface(device, &lot.settings.of(count), &lot.patches, &lot.fates)?;
        let projected = device.empty(PROJECTION * 16 * count)?;
        let given = device.upload(work.object_levels.unwrap_or(&[0]))?;
        if matches!(policy(&work).0, 0 | 3) {
            let buffers = [&lot.patches, &lot.fates, &projected];
            lot.run(Kernel::EscLevel, "project_points", 16 * count, &buffers)?;
        }
        let buffers = [&lot.patches, &lot.fates, &projected, &given, &lot.resolutions];
        lot.run(Kernel::EscLevel, "resolve", count, &buffers)?;
        Ok(lot)
    }

    fn run(
        &self,
        kernel: Kernel,
        entry: &'static str,
        items: usize,
        buffers: &[&Buffer],
    ) -> Result<()> {
        self.device.run(kernel, entry, &self.settings.of(items), buffers)
    }

    /// The coefficients of control points that have so many words a patch.
    fn nets(&self, points: &Buffer, stride: usize, turns: usize) -> Result<Buffer> {
        let items = 64 * turns * self.work.count();
        let nets = self.device.empty(2 * items)?;
        let mut settings = self.settings.of(items);
        (settings.own[0], settings.own[1]) = (stride as u32, turns as u32);
        self.device.run(Kernel::Esc, "coefficients", &settings, &[points, &nets])?;
        Ok(nets)
    }

    /// Which candidates are inserted, from the space in which they are tested.
    fn decide(&self, nets: &Buffer) -> Result<Buffer> {
        let items = COARSE_EDGES * self.work.count();
        let decisions = self.device.empty(DECISION * items)?;
        if Tests::of(self.work.config) != Tests::Object {
            let buffers = [&self.patches, nets, &self.resolutions, &decisions];
            self.run(Kernel::Esc, "decide", items, &buffers)?;
            return Ok(decisions);
        }
        let points = self.work.object.expect("an object-space net, where it is tested");
        let points = self.device.upload(points)?;
        let nets = self.nets(&points, POINTS, 1)?;
        let mut settings = self.settings.of(items);
        (settings.own[0], settings.own[1]) = (POINTS as u32, 1);
        let buffers = [&points, &nets, &self.resolutions, &decisions];
        self.device.run(Kernel::Esc, "decide", &settings, &buffers)?;
        Ok(decisions)
    }

    fn clip_nets(&self) -> Result<Buffer> {
        self.nets(&self.patches, PATCH, turns(self.work.config))
    }

    /// Levels and decisions.
    pub(super) fn decisions(&self) -> Result<Decided> {
        let decisions = self.decide(&self.clip_nets()?)?;
        let words = self.device.read(&decisions, 0, decisions.words())?;
        Ok(Decided {
            resolutions: self.device.read(&self.resolutions, 0, self.resolutions.words())?,
            masks: words.chunks(DECISION).map(|word| word[0]).collect(),
        })
    }

    /// All of it.
    pub(super) fn tessellate(&self) -> Result<Made> {
        let nets = self.clip_nets()?;
        let decisions = self.decide(&nets)?;
        let mesh = self.mesh(&decisions)?;
        let [vertices, triangles] =
            mesh.starts.each_ref().map(|starts| *starts.last().expect("a sum") as usize);
        let points = self.device.empty(VERTEX * vertices)?;
        let events = self.device.empty(EVENTS * vertices)?;
        let buffers = [&self.patches, &nets, &self.resolutions, &mesh.sites, &points, &events];
        self.run(Kernel::Esc, "evaluate", vertices, &buffers)?;
        if self.work.config.esc.boundary == Boundary::Plain {
            self.run(Kernel::Esc, "cracks", vertices, &buffers)?;
        }
        let [vertex_starts, triangle_starts] = mesh
            .starts
            .each_ref()
            .map(|starts| starts.iter().step_by(COARSE_TRIANGLES).copied().collect());
        let mut counts = self.counts(&decisions, &mesh, &points, &events)?;
        let screen = self.divide(&points, vertices, &mut counts)?;
        let fates = self.device.read(&self.fates, 0, self.fates.words())?;
        counts.extend(counts::culled(&fates));
        Ok(Made {
            levels: Vec::new(),
            fates,
            vertex_starts,
            triangle_starts,
            vertices: self.device.read(&points, 0, VERTEX * vertices)?,
            screen,
            triangles: self.device.read(&mesh.triangles, 0, 3 * triangles)?,
            counts,
        })
    }

    /// Screen positions, where the unit divides; those that stay homogeneous are counted.
    fn divide(
        &self,
        points: &Buffer,
        vertices: usize,
        counts: &mut Vec<(Name, u64)>,
    ) -> Result<Vec<u32>> {
        if !self.work.config.divides() {
            return Ok(Vec::new());
        }
        let events = self.device.empty(surface::EVENTS)?;
        let screen = surface::emit(self.device, &self.work.settings, points, vertices, &events)?;
        let homogeneous = self.device.read(&events, 1, 1)?[0];
        counts.push((("emit", "vertices.to_clipper"), homogeneous.into()));
        self.device.read(&screen, 0, 3 * vertices)
    }

    /// The strips, counted and then written.
    fn mesh(&self, decisions: &Buffer) -> Result<Mesh> {
        let (device, count) = (self.device, self.work.count());
        let items = COARSE_TRIANGLES * count;
        let numbers = device.empty(CROSSINGS * count)?;
        let walks = device.empty(WALK * items)?;
        let buffers = [&self.resolutions, decisions, &numbers, &walks];
        self.run(Kernel::EscMesh, "walk", items, &buffers)?;
        let start_buffers = [self.scanned(&walks, items, 0)?, self.scanned(&walks, items, 1)?];
        let starts = [0, 1].map(|k: usize| device.read(&start_buffers[k], 0, items + 1));
        let [vertices, triangles] = starts;
        let starts = [vertices?, triangles?];
        let [vertices, triangles] = starts.each_ref().map(|starts| starts[items] as usize);
        let sites = device.empty(2 * vertices)?;
        let written = device.empty(3 * triangles)?;
        let [of_vertices, of_triangles] = &start_buffers;
        let buffers =
            [&self.resolutions, decisions, &numbers, of_vertices, of_triangles, &sites, &written];
        self.run(Kernel::EscMesh, "write", items, &buffers)?;
        Ok(Mesh { starts, start_buffers, walks, sites, triangles: written })
    }

    /// Sums of a column before each row, and behind the last row.
    fn scanned(&self, walks: &Buffer, rows: usize, column: u32) -> Result<Buffer> {
        let sums = self.device.empty(rows + 1)?;
        let mut settings = self.settings.of(64);
        settings.own[..3].copy_from_slice(&[rows as u32, WALK as u32, column]);
        self.device.run(Kernel::Scan, "scan", &settings, &[walks, &sums])?;
        Ok(sums)
    }

    /// The sums of the columns of rows of so many words.
    fn summed(&self, rows: &Buffer, each: usize, count: usize) -> Result<Vec<u64>> {
        let sums = self.device.empty(2 * each)?;
        let mut settings = self.settings.of(each);
        settings.own[..2].copy_from_slice(&[count as u32, each as u32]);
        self.device.run(Kernel::Scan, "columns", &settings, &[rows, &sums])?;
        let words = self.device.read(&sums, 0, 2 * each)?;
        let sum = |pair: &[u32]| u64::from(pair[1]) << 32 | u64::from(pair[0]);
        Ok(words.chunks(2).map(sum).collect())
    }

    /// The same of any number of rows, whose sums over a block fit 32 bits.
    fn summed_by_blocks(&self, rows: &Buffer, each: usize, count: usize) -> Result<Vec<u64>> {
        let blocks = count.div_ceil(BLOCK);
        let sums = self.device.empty(each * blocks)?;
        let mut settings = self.settings.of(each * blocks);
        settings.own[..2].copy_from_slice(&[count as u32, each as u32]);
        self.device.run(Kernel::EscMesh, "fold", &settings, &[rows, &sums])?;
        self.summed(&sums, each, blocks)
    }

    /// What invocations cost: rows of COST words.
    fn costs(&self, decisions: &Buffer, walks: &Buffer) -> Result<Buffer> {
        let (device, count) = (self.device, self.work.count());
        let stamps = device.empty(CROSSINGS * count)?;
        let (table, sections) = sections(self.work.config);
        let table = device.upload(&table)?;
        let components = device.upload(self.work.components)?;
        let costs = device.empty(COST * count)?;
        let buffers = [&self.resolutions, decisions, &stamps, &table, &components, walks, &costs];
        for first in (0..sections).step_by(SECTIONS as usize) {
            let mut settings = self.settings.of(count);
            settings.own[..2].copy_from_slice(&[first, first + SECTIONS]);
            device.run(Kernel::EscMesh, "count", &settings, &buffers)?;
        }
        self.run(Kernel::EscMesh, "sum_up", count, &buffers)?;
        Ok(costs)
    }

    /// Triangles with two equal positions.
    fn degenerate(&self, mesh: &Mesh, points: &Buffer) -> Result<u64> {
        let items = COARSE_TRIANGLES * self.work.count();
        let found = self.device.empty(items)?;
        let [vertices, triangles] = &mesh.start_buffers;
        let buffers = [points, &mesh.triangles, vertices, triangles, &found];
        self.run(Kernel::EscMesh, "degenerate", items, &buffers)?;
        Ok(self.summed(&found, 1, items)?[0])
    }

    /// The greatest of a column.
    fn peak(&self, costs: &Buffer, column: u32) -> Result<u64> {
        let most = self.device.empty(1)?;
        let mut settings = self.settings.of(1);
        let rows = self.work.count() as u32;
        settings.own[..3].copy_from_slice(&[rows, COST as u32, column]);
        self.device.run(Kernel::EscMesh, "peak", &settings, &[costs, &most])?;
        Ok(self.device.read(&most, 0, 1)?[0].into())
    }
}
