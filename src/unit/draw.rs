//! Draw: a draw command in, its patches in the batch: block by block, each with what must be
//! fetched for it. Where the patches of a primitive share their lists (`union`), each instance
//! passes twice: first to be measured, without its attributes; and its points are fetched,
//! transformed and tested again in the second pass.

use super::attributes::Corners;
use super::batch::DrawState;
use super::d3d11;
use super::esc;
use super::fetch::{Brought, Instance, Source};
use super::host::Hosted;
use super::pipeline::Make;
use super::resident::{self, Mesh};
use super::run::Run;
use super::union::{Pass, Shared, Site, Unions};
use crate::config::{Config, Union};
use crate::error::{Error, Result};
use crate::link::{self, Transfer};
use crate::shader::control_point;
use crate::trace::command::{Draw, Primitive};
use glam::Mat4;
use rtl_model::counter::Counter;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Patches of one instance that are drawn together.
#[derive(Clone, Copy)]
struct Block {
    row: u64,
    column: u64,
    rows: u64,
    columns: u64,
}

impl Block {
    /// All patches of an instance; those of no mesh are a row.
    fn whole(primitive: Primitive) -> Self {
        let (rows, columns) = primitive.size();
        Self { row: 0, column: 0, rows, columns }
    }
}

/// Where a block's points are in the batch.
struct Placed {
    /// The first one.
    base: u32,
    /// Of an indexed mesh: each patch's points counted from there, and a bit for each that the
    /// cache lacked.
    indexed: Vec<([u32; 16], u16)>,
}

/// An instance whose blocks are all in the batch: its spans, and where its points are.
type Whole = (Range<usize>, Placed);

impl<M: Make> Run<'_, M> {
    /// Carries out a draw.
    pub(super) fn draw(&mut self, draw: &Draw) -> Result<()> {
        let frame = self.frame.expect("the reader refuses a draw before any frame");
        let known = "the reader refuses unknown ids";
        let points = self.points.get(&draw.points).expect(known).clone();
        let attributes = draw.attributes.map(|id| self.attributes.get(&id).expect(known).clone());
        let indexed = link::is_indexed(self.config.unit, draw);
        let source = Source { draw, points, attributes, indexed };
        let levels = self.resident_levels(&source)?;
        self.begin_draw(&source, &levels)?;
        let surfaces = self.config.unit.has_surface_primitives();
        let state = DrawState {
            number: self.draws.len() as u32 - 1,
            cull: draw.cull,
            reversed: draw.reversed,
            state: super::state::under(&self.state, self.config),
            to_world: frame.to_world,
            hosted: self.hosted(&source),
            attributes: source.attributes.clone(),
            edges: (surfaces && draw.primitive.shares_edges()).then(|| draw.primitive.size()),
            shared: None,
            hull_bytes: d3d11::hull_bytes(source.components(), self.config) as u32, // < 2^16
            object_level: None,
        };
        // What the first of two passes takes.
        let bare = Source { points: source.points.clone(), attributes: None, ..source };
        let bounds = esc::bounds(draw, &source.points.source, self.config)?;
        // The spans of the instance before, while the batch holds all of it.
        let mut whole = None;
        for (number, model) in draw.models.iter().enumerate() {
            let mut state = state.clone();
            self.instances += 1;
            state.hosted.instance = self.instances;
            match levels.get(number) {
                None => {}
                Some(None) => {
                    self.patches += draw.primitive.patches(); // out of sight, all of them
                    continue;
                }
                Some(&Some((level, mesh))) => {
                    state.state = resident::fixed(level);
                    state.hosted.index_bytes = mesh.index_bytes;
                }
            }
            if self.config.unit.in_object_space() {
                state.to_world = model.map(f64::from);
            }
            let model = Mat4::from_cols_array(model);
            let matrix = control_point::concatenate(&frame.clip_from_world, &model);
            state.object_level = bounds
                .as_ref()
                .map(|bounds| esc::object_level(bounds, &matrix, self.config, &frame));
            if !self.unites(draw.primitive) {
                whole = self.pass(&source, Instance::new(matrix, state, self.config), whole)?;
                continue;
            }
            let unions = Arc::new(Unions::new(draw.primitive.size()));
            for (pass, source) in [(Pass::Measure, &bare), (Pass::Draw, &source)] {
                let shared = Some(Shared { pass, unions: unions.clone() });
                let attributes = source.attributes.clone();
                let state = DrawState { shared, attributes, ..state.clone() };
                let before = self.patches;
                whole = self.pass(source, Instance::new(matrix, state, self.config), whole)?;
                if pass == Pass::Measure {
                    self.patches = before; // their numbers are those of the second pass
                }
            }
        }
        Ok(())
    }

    /// Where meshes are resident: the level of each instance, and its mesh, which is in device
    /// memory from now on; `None` for one that is not drawn. Empty where they are not.
    fn resident_levels(&mut self, source: &Source<'_>) -> Result<Vec<Option<(u32, Mesh)>>> {
        let config = self.config;
        if config.culls_patches() {
            return Ok(Vec::new());
        }
        let frame = self.frame.expect("the reader refuses a draw before any frame");
        let state = super::state::under(&self.state, config);
        let bytes = vertex_bytes(source.attributes.as_deref(), config);
        let (mut levels, mut uploads) = (Vec::new(), Vec::new());
        for model in &source.draw.models {
            let model = Mat4::from_cols_array(model);
            let matrix = control_point::concatenate(&frame.clip_from_world, &model);
            let level = resident::level(source, &matrix, &state, &frame, config)?;
            levels.push(level.map(|level| {
                (level, self.resident.mesh(source, level, (config, bytes), &mut uploads))
            }));
        }
        for mesh in uploads {
            let uploaded = mesh.upload((config, bytes), &mut self.counters);
            self.send(uploaded.transfer.payload(), uploaded.written)?;
        }
        self.counters.add(Counter::MemoryMeshesPeak, self.resident.bytes());
        Ok(levels)
    }

    /// What a host that tessellates knows of a draw.
    fn hosted(&self, source: &Source<'_>) -> Hosted {
        Hosted {
            instance: 0,
            vertex_bytes: vertex_bytes(source.attributes.as_deref(), self.config),
            components: source.components(),
            index_bytes: 0,
        }
    }

    /// Whether the patches of this primitive get unified lists.
    fn unites(&self, primitive: Primitive) -> bool {
        self.config.union() == Union::Primitive && primitive.shares_edges()
    }

    /// All patches of an instance, once.
    fn pass(
        &mut self,
        source: &Source<'_>,
        mut instance: Instance,
        whole: Option<Whole>,
    ) -> Result<Option<Whole>> {
        let primitive = source.draw.primitive;
        let whole = match whole {
            Some((spans, mut placed)) if self.batch.room() as u64 >= primitive.patches() => {
                self.batch.draw(instance.state.clone());
                placed.base = self.batch.again(instance.matrix, spans.clone());
                self.patches(source, &mut instance, Block::whole(primitive), &placed);
                Some((spans, placed))
            }
            _ => self.instance(source, &mut instance)?,
        };
        instance.count(source, self.config, &mut self.counters);
        Ok(whole)
    }

    /// What a draw counts whatever becomes of its patches.
    fn begin_draw(&mut self, source: &Source<'_>, levels: &[Option<(u32, Mesh)>]) -> Result<()> {
        let Source { draw, attributes, .. } = source;
        let primitive = draw.primitive;
        let patches = primitive.patches() * draw.models.len() as u64;
        if self.patches + patches > u64::from(u32::MAX) {
            let count = self.patches + patches;
            let most = u32::MAX;
            return Err(Error::Usage(format!(
                "a frame of {count} patches: expected at most {most}"
            )));
        }
        let unites = self.unites(primitive);
        let counters = &mut self.counters;
        counters.add(Counter::TraceDraws, 1);
        counters.add(Counter::TracePatches, patches);
        counters.add(Counter::AssemblePatches, patches);
        if unites {
            let (rows, columns) = primitive.size();
            counters.add(Counter::AssemblePatches, patches);
            counters.add(Counter::AssembleMeasured, patches);
            counters.add(Counter::PlaceListsPeak, rows + columns);
        }
        if self.config.unit.has_surface_primitives() {
            counters.add(Counter::AssembleEdgePeak, primitive.edge_entries_peak());
            counters.add(Counter::AssembleEdgeLifetime, primitive.edge_lifetime_peak());
            if attributes.is_some() {
                counters.add(Counter::AssembleCornerPeak, primitive.corner_entries_peak());
            }
        }
        let transfer = link::host_draw(draw);
        self.draws.push((transfer, vertex_bytes(attributes.as_deref(), self.config)));
        let batches = resident::batches(levels);
        let headers = batches.saturating_sub(1) * link::COMMAND;
        self.send_as_host(Transfer { command: transfer.command + headers, ..transfer })
    }

    /// One instance, in blocks that fit a batch: whole rows of patches, or parts of a row. Returns
    /// its spans, if one block took it all.
    fn instance(&mut self, source: &Source<'_>, instance: &mut Instance) -> Result<Option<Whole>> {
        let Block { rows, columns, .. } = Block::whole(source.draw.primitive);
        let (mut row, mut column) = (0, 0);
        let mut whole = None;
        while row < rows {
            if self.batch.room() == 0 {
                self.flush()?;
            }
            let room = self.batch.room() as u64;
            let block = if column > 0 || columns > room {
                Block { row, column, rows: 1, columns: room.min(columns - column) }
            } else {
                Block { row, column, rows: (room / columns).min(rows - row), columns }
            };
            let first = self.batch.spans();
            self.batch.draw(instance.state.clone());
            let placed = self.place(source, instance, block)?;
            self.patches(source, instance, block, &placed);
            whole = (block.rows * block.columns == rows * columns)
                .then(|| (first..self.batch.spans(), placed));
            column += block.columns;
            if column == columns {
                (row, column) = (row + block.rows, 0);
            }
        }
        Ok(whole)
    }

    /// Puts the points of a block into the batch. Those that the block before brought are there
    /// again, and are not counted.
    fn place(
        &mut self,
        source: &Source<'_>,
        instance: &mut Instance,
        block: Block,
    ) -> Result<Placed> {
        let Source { draw, points, .. } = source;
        let Block { row, column, rows, columns } = block;
        let base = self.batch.next_point();
        let mut run = |first: u64, count: u64, repeated: u64| -> Result<()> {
            points.source.read(draw.first + first, count as usize, &mut self.scratch)?;
            self.batch.points(instance.matrix, &self.scratch, repeated as usize);
            Ok(())
        };
        let later = u64::from(column > 0);
        if source.indexed {
            let across = draw.primitive.size().1;
            let of = |row| (column..column + columns).map(move |column| row * across + column);
            let rows: Vec<_> =
                (row..row + rows).flat_map(of).map(|number| source.row(number)).collect();
            let indexed = self.gather(source, &rows, instance)?;
            return Ok(Placed { base, indexed });
        }
        match draw.primitive {
            Primitive::Patches { .. } => run(16 * column, 16 * columns, 0)?,
            Primitive::Strip { .. } => run(12 * column, 4 * (3 * columns + 1), 4 * later)?,
            Primitive::Fan { encoding, .. } => {
                // The centre, the radial curve that the patch before ended with, the patches'.
                let of = |count| Primitive::Fan { count, encoding }.points().expect("a fan's");
                run(0, 1, later)?;
                run(of(column) - 3, of(columns) - 1, 3 * later)?;
            }
            Primitive::Mesh { columns: across, .. } => {
                let stride = 3 * u64::from(across) + 1;
                for line in 3 * row..=3 * (row + rows) {
                    // A block's first line and column came with the block below and to the left.
                    let seen_line = line == 3 * row && row > 0;
                    let width = 3 * columns + 1;
                    let repeated = if seen_line { width } else { later };
                    run(line * stride + 3 * column, width, repeated)?;
                }
            }
            Primitive::Indexed { .. } => unreachable!("an indexed mesh is indexed"),
        }
        Ok(Placed { base, indexed: Vec::new() })
    }

    /// The points of some patches of an indexed mesh: those that the cache lacks, and, without
    /// being counted, those that it has from an earlier block.
    fn gather(
        &mut self,
        source: &Source<'_>,
        rows: &[[u32; 16]],
        instance: &mut Instance,
    ) -> Result<Vec<([u32; 16], u16)>> {
        let Source { draw, points, .. } = source;
        let base = self.batch.next_point();
        let mut placed: HashMap<u32, u32> = HashMap::new();
        let mut gathered = Vec::with_capacity(rows.len());
        for row in rows {
            let (mut missed, mut fetched, mut held) = (0_u16, Vec::new(), Vec::new());
            for (k, index) in row.iter().enumerate() {
                if !instance.cache.fetch(*index) {
                    missed |= 1 << k;
                    fetched.push(*index);
                } else if ![&fetched, &held].iter().any(|list| list.contains(index))
                    && !placed.contains_key(index)
                {
                    held.push(*index);
                }
            }
            for (list, repeated) in [(&fetched, 0), (&held, held.len())] {
                let mut found = Vec::with_capacity(list.len());
                for &index in list {
                    points.source.read(draw.first + u64::from(index), 1, &mut self.scratch)?;
                    found.push(self.scratch[0]);
                }
                let first = self.batch.next_point() - base;
                placed.extend(list.iter().zip(first..).map(|(&index, at)| (index, at)));
                if !list.is_empty() {
                    self.batch.points(instance.matrix, &found, repeated);
                }
            }
            gathered.push((row.map(|index| placed[&index]), missed));
        }
        Ok(gathered)
    }

    /// The patches of a block whose points stand in the batch.
    fn patches(
        &mut self,
        source: &Source<'_>,
        instance: &mut Instance,
        block: Block,
        placed: &Placed,
    ) {
        let primitive = source.draw.primitive;
        let Block { row, column, rows, columns } = block;
        let local = match primitive {
            Primitive::Patches { .. } => Primitive::Patches { count: columns },
            Primitive::Strip { .. } => Primitive::Strip { count: columns },
            Primitive::Fan { encoding, .. } => Primitive::Fan { count: columns, encoding },
            Primitive::Mesh { .. } => {
                Primitive::Mesh { rows: rows as u32, columns: columns as u32 }
            }
            Primitive::Indexed { .. } => Primitive::Indexed { count: columns },
        };
        let across = primitive.size().1;
        for n in 0..local.patches() {
            let (row, column) = (row + n / columns, column + n % columns);
            let number = row * across + column;
            let site = Site { row: row as u32, column: column as u32 }; // at most 2^24
            let (indices, brought) = match placed.indexed.get(n as usize) {
                Some(&(indices, missed)) => (indices, Brought::Missed(missed)),
                None => {
                    let indices = local.indices(n).map(|i| i as u32);
                    (indices, Brought::Next(primitive.received(number)))
                }
            };
            let corners = source.corners(number);
            let fetch = instance.fetch(source, number, brought, self.config);
            let indices = indices.map(|i| placed.base + i);
            self.batch.patch(self.patches as u32, site, indices, corners, fetch);
            self.patches += 1;
        }
    }
}

/// Bytes of a vertex on the link, where the host tessellates.
fn vertex_bytes(attributes: Option<&Corners>, config: &Config) -> u64 {
    match attributes {
        None => config.triangles.vertex_bytes.into(),
        Some(corners) => {
            u64::from(config.triangles.bare_vertex_bytes) + corners.table.corner_bytes()
        }
    }
}
