//! Resident: meshes that stay in device memory (unit `triangles`). A draw comes in; out go the
//! level at which each of its instances is drawn, and uploads of meshes that are not there yet.
//!
//! A mesh is of a draw's control points, in object space, at one level on all edges and within: so
//! it is watertight, with whatever else has that level. `static` has one level for all that is
//! drawn. `discrete` has 1, 2, 4, .., and an instance gets the least that suffices for all of its
//! patches that are in sight, so that the patches of a draw meet; draws that meet each other at
//! different levels do not. The host knows which patches are in sight from the tests that the other
//! units have, and it does not draw an instance of which none is. A device that reads what a host
//! made before it saw anything removes no patch.
//!
//! A mesh is there until its points or attributes are replaced.

use super::fetch::Source;
use super::frame::FrameState;
use crate::config::{Config, Residency, Upload};
use crate::error::Result;
use crate::link::index_stream::{Batches, IndexStream, between_patches, index_bytes};
use crate::link::{Bursts, COMMAND, Transfer};
use crate::shader::control_point;
use crate::trace::command::Primitive;
use crate::trace::indices::Indices;
use glam::Mat4;
use rayon::prelude::*;
use rtl_model::backface::{self, Verdict};
use rtl_model::clip;
use rtl_model::counter::{Counter, Counters};
use rtl_model::level::{self, Criterion, State};
use rtl_model::number::{Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::patch::{Level, Levels, Patch};
use rtl_model::place::{Numbering, Placement};
use rtl_model::port;
use rtl_model::stitch;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// Patches that are looked at together.
const LOT: u64 = 4096;

/// A mesh in device memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Mesh {
    vertices: u64,
    indices: u64,
    /// Bytes of an index.
    pub(super) index_bytes: u64,
    /// Draws of the device that show it.
    pub(super) batches: u64,
}

impl Mesh {
    /// So many patches at a level.
    fn of(patches: u64, level: u32, config: &Config) -> Self {
        let settings = &config.triangles;
        let (width, topology) = (settings.index, settings.topology);
        let level = whole(level);
        let mut placement = Placement::default();
        placement.set(&Levels { edges: [level; 4], interior: [level; 2] });
        let lists = placement.segments();
        let (mut triangles, mut stream) = (Vec::new(), IndexStream::default());
        stitch::accept(lists, &mut triangles);
        stream.form(&triangles, lists.vertices(), topology);
        let each = lists.vertices() as u64;
        let mut batches = Batches::default();
        for _ in 0..patches {
            batches.patch(each, width, topology);
        }
        let [between, _] = between_patches(topology);
        let vertices = patches * each;
        Self {
            vertices,
            indices: patches * stream.indices.len() as u64 + (patches - batches.count) * between,
            index_bytes: index_bytes(width, topology, vertices),
            batches: batches.count,
        }
    }

    /// Its upload.
    fn transfer(&self, vertex_bytes: u64) -> Transfer {
        Transfer {
            command: COMMAND,
            vertices: self.vertices * vertex_bytes,
            indices: self.indices * self.index_bytes,
            ..Transfer::default()
        }
    }
}

/// The meshes of a draw.
#[derive(Debug)]
struct Meshes {
    first: u64,
    primitive: Primitive,
    indices: Option<Arc<Indices>>,
    attributes: Option<u32>,
    vertex_bytes: u64,
    levels: BTreeMap<u32, Mesh>,
}

impl Meshes {
    fn shows(&self, source: &Source<'_>) -> bool {
        let draw = source.draw;
        self.first == draw.first
            && self.primitive == draw.primitive
            && self.attributes == draw.attributes
            && self.indices == draw.indices
    }
}

/// A mesh that must cross the link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Uploaded {
    pub(super) transfer: Transfer,
    /// Bytes of the bursts that write it.
    pub(super) written: u64,
}

/// What is in device memory.
#[derive(Debug, Default)]
pub(super) struct Resident {
    /// By the id of their points.
    meshes: HashMap<u32, Vec<Meshes>>,
    bytes: u64,
}

impl Resident {
    /// Points are replaced, and what was made of them goes.
    pub(super) fn replace_points(&mut self, id: u32) {
        for gone in self.meshes.remove(&id).unwrap_or_default() {
            self.bytes -= bytes(&gone);
        }
    }

    /// Attributes are replaced.
    pub(super) fn replace_attributes(&mut self, id: u32) {
        for meshes in self.meshes.values_mut() {
            for gone in meshes.extract_if(.., |meshes| meshes.attributes == Some(id)) {
                self.bytes -= bytes(&gone);
            }
        }
    }

    /// The mesh of a draw at a level. What is not there yet goes to `upload`.
    pub(super) fn mesh(
        &mut self,
        source: &Source<'_>,
        level: u32,
        (config, vertex_bytes): (&Config, u64),
        upload: &mut Vec<Mesh>,
    ) -> Mesh {
        let draw = source.draw;
        let all = self.meshes.entry(draw.points).or_default();
        let at = all.iter().position(|meshes| meshes.shows(source)).unwrap_or_else(|| {
            all.push(Meshes {
                first: draw.first,
                primitive: draw.primitive,
                indices: draw.indices.clone(),
                attributes: draw.attributes,
                vertex_bytes,
                levels: BTreeMap::new(),
            });
            all.len() - 1
        });
        let meshes = &mut all[at];
        let whole = config.triangles.residency == Residency::Discrete
            && config.triangles.upload == Upload::Whole;
        let wanted = if whole { discrete(config).collect() } else { vec![level] };
        for level in wanted {
            meshes.levels.entry(level).or_insert_with(|| {
                let mesh = Mesh::of(draw.primitive.patches(), level, config);
                self.bytes += mesh.transfer(vertex_bytes).payload() - COMMAND;
                upload.push(mesh);
                mesh
            });
        }
        meshes.levels[&level]
    }

    /// Bytes of all meshes.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Mesh {
    /// Counts its upload, as far as it is not framing.
    pub(super) fn upload(
        &self,
        (config, vertex_bytes): (&Config, u64),
        counters: &mut Counters,
    ) -> Uploaded {
        let transfer = self.transfer(vertex_bytes);
        transfer.count_payload(counters);
        counters.add(Counter::MemoryWrittenVertices, transfer.vertices);
        counters.add(Counter::MemoryWrittenIndices, transfer.indices);
        let mut written = 0;
        for bytes in [transfer.vertices, transfer.indices] {
            let mut write = Bursts::default();
            write.next(0, bytes, &config.memory);
            written += write.count(&config.memory, counters);
        }
        Uploaded { transfer, written }
    }
}

fn bytes(meshes: &Meshes) -> u64 {
    let each = |mesh: &Mesh| mesh.transfer(meshes.vertex_bytes).payload() - COMMAND;
    meshes.levels.values().map(each).sum()
}

/// The levels of discrete meshes.
fn discrete(config: &Config) -> impl Iterator<Item = u32> {
    let most = config.triangles.max_level;
    (0..=most.ilog2()).map(|k| 1 << k)
}

/// Draws of the device that show the instances of a draw: one for each batch of each level.
pub(super) fn batches(levels: &[Option<(u32, Mesh)>]) -> u64 {
    let meshes: BTreeMap<u32, Mesh> = levels.iter().copied().flatten().collect();
    meshes.values().map(|mesh| mesh.batches).sum()
}

/// A whole number of segments, at most 128, as a level.
fn whole(segments: u32) -> Level {
    Level::clamped(u64::from(segments) << 16)
}

/// The state under which a mesh of that level is tessellated.
pub(super) fn fixed(segments: u32) -> State {
    let level = whole(segments);
    State { criterion: Criterion::Fixed { level }, min: level, max: level }
}

/// The level at which an instance of a draw is drawn; `None` where it is not.
///
/// # Errors
/// Those of points in a file.
pub(super) fn level(
    source: &Source<'_>,
    matrix: &Mat4,
    state: &State,
    frame: &FrameState,
    config: &Config,
) -> Result<Option<u32>> {
    let settings = &config.triangles;
    if settings.residency != Residency::Discrete {
        return Ok(Some(settings.level));
    }
    let (draw, patches) = (source.draw, source.draw.primitive.patches());
    let (mut greatest, mut point) = (None, Vec::new());
    for first in (0..patches).step_by(LOT as usize) {
        let mut nets = Vec::new();
        for number in first..patches.min(first + LOT) {
            let mut net = [[0.0; 4]; 16];
            for (out, index) in net.iter_mut().zip(source.row(number)) {
                source.points.source.read(draw.first + u64::from(index), 1, &mut point)?;
                *out = point[0];
            }
            nets.push(net);
        }
        let look = Look { source, matrix, state, frame, config, nets: &nets };
        greatest = greatest.max(dispatch(config.position.rounding, config.position.overflow, look));
    }
    // Options order by their level, and none is least.
    Ok(greatest.map(|level: Level| {
        level.fx16().div_ceil(1 << 16).next_power_of_two().min(settings.max_level)
    }))
}

/// Patches that the host looks at.
struct Look<'a> {
    source: &'a Source<'a>,
    matrix: &'a Mat4,
    state: &'a State,
    frame: &'a FrameState,
    config: &'a Config,
    nets: &'a [[[f32; 4]; 16]],
}

impl Modal for Look<'_> {
    type Output = Option<Level>;

    /// The greatest level of those in sight.
    fn run<R: RoundingMode, O: OverflowMode>(self) -> Option<Level> {
        let one = |net: &[[f32; 4]; 16]| {
            let quantised = net.map(|point| {
                let clip = control_point::transform(self.matrix, point);
                port::accept::<R, O>(clip.map(f32::to_bits), self.frame.view.position)
            });
            let patch = Patch {
                id: 0,
                points: quantised.map(|q| q.point),
                saturated: quantised.iter().any(|q| q.overflows > 0),
                cull: self.source.draw.cull,
                reversed: self.source.draw.reversed,
            };
            self.level(&patch)
        };
        self.nets.par_iter().with_min_len(16).map(one).max().flatten()
    }
}

impl Look<'_> {
    fn level(&self, patch: &Patch) -> Option<Level> {
        let view = &self.frame.view;
        if self.config.clip.enabled && clip::outside(patch, view.depth) {
            return None;
        }
        let (verdict, _) = backface::accept(patch, view, self.config.backface.method);
        if verdict == Verdict::Culled {
            return None;
        }
        let (Levels { edges, interior }, _) = level::accept(patch, view, self.state);
        edges.into_iter().chain(interior).max()
    }
}
