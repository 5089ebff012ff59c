//! Host: what a host that tessellates sends for a patch, and what the device reads of it (unit
//! `triangles`). Patches come in, in the order of the draws, with what their triangles depend on;
//! out go bytes for the link, bytes that device memory takes, and fetches of vertices.
//!
//! ```text
//!   streamed, all vertices kept    link ─ vertices ─► vertex shader; then the draw's indices
//!   streamed, a cache              link ─ vertices, indices ─► memory ─ misses ─► vertex shader
//!   resident                       upload once ─► memory ─ misses of each instance ─► shader
//! ```
//!
//! A draw's triangles are indexed over all of it where they are streamed, over an instance's mesh
//! where that is resident. How wide a streamed draw's indices are is known when its last patch is,
//! so they follow its vertices, and in time the fetches do not wait for them.

use super::chain::{Fate, Flow, Work};
use crate::config::{CachePolicy, Config, Normals};
use crate::link::framing::Framed;
use crate::link::index_stream::{Batches, IndexStream, RESTART, between_patches, index_bytes};
use crate::link::schedule::Parcel;
use crate::link::vertex_cache::Cache;
use crate::link::{Bursts, COMMAND};
use rtl_model::counter::{Counter, Counters};
use rtl_model::patch::Triangle;

/// Bytes of vertices in a fetch: what memory's reads under way are reckoned in.
const FETCH: u64 = 256;

/// What the host knows of an instance's patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Hosted {
    /// The instance's number within the run.
    pub(super) instance: u64,
    /// Bytes of a vertex.
    pub(super) vertex_bytes: u64,
    /// Components of the attributes of a vertex.
    pub(super) components: u64,
    /// Bytes of an index of its mesh, where that is resident.
    pub(super) index_bytes: u64,
}

/// What a patch, or the end of a draw, puts on the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Delivery {
    /// Bytes over the link.
    pub(super) payload: u64,
    /// Bytes of the bursts that write them.
    pub(super) written: u64,
    /// Bytes of the bursts that read indices without vertices.
    pub(super) read: u64,
}

/// What was sent of a streamed draw.
#[derive(Clone, Copy, Debug, Default)]
struct Draw {
    vertices: u64,
    indices: u64,
    vertex_bytes: u64,
}

/// The host's side of the draws, and index fetch on the device's.
pub(super) struct Host<T> {
    config: Config,
    /// Bytes of the command that is being sent.
    payload: u64,
    draw: Draw,
    batches: Batches,
    /// The instance that is being drawn, where meshes are resident.
    instance: Option<u64>,
    /// Vertices and bytes of indices of the mesh before this patch.
    passed: [u64; 2],
    vertices: Bursts,
    indices: Bursts,
    written: Bursts,
    /// The lists that `stream` and `missed` are of: of patches that are alike, the next.
    lists: Option<T>,
    triangles: Vec<Triangle>,
    stream: IndexStream,
    /// Vertices of the patch that must be shaded, in the order of their indices.
    missed: Vec<u16>,
    cache: Cache,
    /// The last patch's fetches.
    pub(super) fetches: Vec<Parcel>,
    counters: Counters,
}

impl<T: Flow> Host<T> {
    pub(super) fn new(config: &Config) -> Self {
        Self {
            config: config.clone(),
            payload: 0,
            draw: Draw::default(),
            batches: Batches::default(),
            instance: None,
            passed: [0; 2],
            vertices: Bursts::default(),
            indices: Bursts::default(),
            written: Bursts::default(),
            lists: None,
            triangles: Vec::new(),
            stream: IndexStream::default(),
            missed: Vec::new(),
            cache: Cache::new(config.triangles.cache),
            fetches: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// A command begins, with so many bytes of its own.
    pub(super) fn command(&mut self, payload: u64) {
        self.payload = payload;
    }

    /// A patch of the command.
    pub(super) fn patch(&mut self, work: &Work<T>, of: Hosted) -> Delivery {
        self.fetches.clear();
        if work.fate != Fate::Kept {
            return Delivery::default();
        }
        if self.config.triangles.resides() && self.instance != Some(of.instance) {
            self.end_mesh();
            self.instance = Some(of.instance);
        }
        let [vertices, triangles] = work.made();
        self.form(work.lists, vertices);
        let indices = self.index(vertices, triangles);
        let misses = self.misses(vertices);
        self.count_shader(misses, of.components);
        let delivery = self.send(vertices, indices, of);
        if self.config.triangles.uses_memory() {
            self.fetch(indices * of.index_bytes, of.vertex_bytes);
        }
        self.passed[0] += vertices;
        delivery
    }

    /// Forms the patch's indices, where something depends on them.
    fn form(&mut self, lists: T, vertices: u64) {
        if self.config.triangles.is_plain() || self.lists == Some(lists) {
            return;
        }
        self.lists = Some(lists);
        self.triangles.clear();
        lists.join(&mut self.triangles);
        let topology = self.config.triangles.topology;
        self.stream.form(&self.triangles, vertices as usize, topology);
        self.look_up();
    }

    /// The patch's indices, and what they ask of the cache. Returns how many the draw gets.
    fn index(&mut self, vertices: u64, triangles: u64) -> u64 {
        let settings = &self.config.triangles;
        let begins = self.batches.patch(vertices, settings.index, settings.topology);
        let between = if begins { [0, 0] } else { between_patches(settings.topology) };
        let [between, parted] = between;
        let plain = settings.is_plain();
        let own = if plain { 3 * triangles } else { self.stream.indices.len() as u64 };
        let (all, restarts) = (own + between, self.stream.restarts + parted);
        let misses = self.misses(vertices);
        let (stream, counters) = (&self.stream, &mut self.counters);
        counters.add(Counter::VertexCacheBatches, u64::from(begins));
        counters.add(Counter::VertexCacheIndices, all);
        counters.add(Counter::VertexCacheStrips, stream.strips);
        counters.add(Counter::VertexCacheRestarts, restarts);
        counters.add(Counter::VertexCacheRepeated, stream.repeated + between - parted);
        counters.add(Counter::VertexCacheHits, all - restarts - misses);
        counters.add(Counter::VertexCacheMisses, misses);
        all
    }

    /// The patch through the cache. What stands between patches is a hit: the last vertex of the
    /// one, and the first of the other, which is named again at once.
    fn look_up(&mut self) {
        if !self.config.triangles.uses_memory() {
            return;
        }
        self.cache.clear();
        self.missed.clear();
        let named = self.stream.indices.iter().copied();
        let cache = &mut self.cache;
        self.missed.extend(named.filter(|&v| v != RESTART && cache.misses(v.into())));
    }

    /// Vertices of the patch that are shaded.
    fn misses(&self, vertices: u64) -> u64 {
        match self.config.triangles.cache.policy {
            CachePolicy::Unlimited => vertices,
            CachePolicy::Fifo | CachePolicy::Lru => self.missed.len() as u64,
        }
    }

    fn count_shader(&mut self, invocations: u64, components: u64) {
        let shader = &self.config.vertex_shader;
        let normal = match self.config.evaluate.normals {
            Normals::Off => 0,
            Normals::TangentPlane => shader.bytes_in_normal,
        };
        let attributes = components * self.config.attributes.component_bytes();
        let bytes = u64::from(shader.bytes_in + normal) + attributes;
        self.counters.add(Counter::VertexShaderInvocations, invocations);
        self.counters.add(Counter::VertexShaderBytesIn, invocations * bytes);
        let bytes = u64::from(shader.bytes_out);
        self.counters.add(Counter::VertexShaderBytesOut, invocations * bytes);
    }

    /// What of a patch crosses the link: nothing where its mesh is there already.
    fn send(&mut self, vertices: u64, indices: u64, of: Hosted) -> Delivery {
        if self.config.triangles.resides() {
            return Delivery::default();
        }
        self.draw.vertices += vertices;
        self.draw.indices += indices;
        self.draw.vertex_bytes = of.vertex_bytes;
        let payload = vertices * of.vertex_bytes;
        let written = if self.config.triangles.uses_memory() {
            let memory = &self.config.memory;
            let at = self.written.bytes();
            self.written.next(at, payload, memory) * u64::from(memory.burst)
        } else {
            0
        };
        Delivery { payload, written, read: 0 }
    }

    /// The reads of a patch: its part of the index buffer, where that is there, and vertices.
    fn fetch(&mut self, index_bytes: u64, vertex_bytes: u64) {
        let memory = &self.config.memory;
        let burst = u64::from(memory.burst);
        let [before, indices_before] = self.passed;
        let mut bursts = self.indices.next(indices_before, index_bytes, memory);
        self.passed[1] += index_bytes;
        let most = (FETCH / vertex_bytes).clamp(1, 16) as usize;
        for missed in self.missed.chunks(most) {
            for &vertex in missed {
                let at = (before + u64::from(vertex)) * vertex_bytes;
                bursts += self.vertices.next(at, vertex_bytes, memory);
            }
            let read = u32::try_from(std::mem::take(&mut bursts) * burst);
            let read = read.expect("a fetch is of 16 vertices and a patch's indices at most");
            self.fetches.push(Parcel { points: missed.len() as u8, read, ..Parcel::default() });
        }
    }

    /// The last instance's mesh, or the draw's, has been read.
    fn end_mesh(&mut self) {
        let (memory, counters) = (&self.config.memory, &mut self.counters);
        counters.add(Counter::MemoryReadVertices, self.vertices.bytes());
        counters.add(Counter::MemoryReadIndices, self.indices.bytes());
        for bursts in [&mut self.vertices, &mut self.indices] {
            std::mem::take(bursts).count(memory, counters);
        }
        self.batches = Batches::default();
        (self.passed, self.instance) = ([0; 2], None);
    }

    /// What follows a draw's last patch: its indices, and a header for each batch but the first.
    pub(super) fn end_draw(&mut self) -> Delivery {
        let draw = std::mem::take(&mut self.draw);
        let settings = &self.config.triangles;
        let width = index_bytes(settings.index, settings.topology, draw.vertices);
        let (vertices, indices) = (draw.vertices * draw.vertex_bytes, draw.indices * width);
        let headers = if settings.resides() { 0 } else { self.batches.count.saturating_sub(1) };
        let headers = headers * COMMAND;
        let mut delivery = Delivery { payload: indices + headers, written: 0, read: 0 };
        let counters = &mut self.counters;
        counters.add(Counter::LinkVertices, vertices);
        counters.add(Counter::LinkIndices, indices);
        counters.add(Counter::LinkCommands, headers);
        if settings.uses_memory() && !settings.resides() {
            let memory = &self.config.memory;
            counters.add(Counter::MemoryMeshesPeak, vertices + indices);
            counters.add(Counter::MemoryWrittenVertices, vertices);
            counters.add(Counter::MemoryWrittenIndices, indices);
            std::mem::take(&mut self.written).count(memory, counters);
            let mut write = Bursts::default();
            delivery.written = write.next(0, indices, memory) * u64::from(memory.burst);
            write.count(memory, counters);
            // They are read from first to last, as they were written.
            delivery.read = self.indices.next(0, indices, memory) * u64::from(memory.burst);
        }
        self.end_mesh();
        self.count_framing(vertices + delivery.payload);
        delivery
    }

    /// A command has been sent, with what followed its own bytes.
    fn count_framing(&mut self, followed: u64) {
        let payload = std::mem::take(&mut self.payload) + followed;
        let framed = Framed::of(payload, &self.config.link);
        self.counters.add(Counter::LinkOverhead, framed.overhead);
        self.counters.add(Counter::LinkRequests, framed.request_bytes);
        self.counters.add(Counter::LinkTotal, framed.total());
    }

    /// What was counted since this was asked last.
    pub(super) fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}
