//! Unit `triangles`: where its meshes live, how their triangles are indexed, and the cache of
//! shaded vertices behind the index fetch.
//!
//! The unit is what a host that tessellates can do: anew each frame, one mesh made once, or several
//! of them, of which each frame takes the one that suffices. Defaults are the unit as it was before
//! there was a choice: streamed, lists, indices as narrow as they may be, every vertex shaded once.

use super::check::{Problem, within};
use super::{Config, Unit};
use serde::{Deserialize, Serialize};

/// Greatest level of a resident mesh, in segments per whole edge: the level block's own.
pub const LEVEL_MAX: u32 = 128;
/// Fewest entries of a cache: a triangle's corners.
pub const CACHE_ENTRIES_MIN: u32 = 3;
/// Most entries of a cache.
pub const CACHE_ENTRIES_MAX: u32 = 64;

/// Unit `triangles`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Triangles {
    /// Bytes of a vertex on the link: position 12, normal 12, texture coordinates 8.
    pub vertex_bytes: u32,
    /// Bytes of a vertex besides its attributes, in draws that have them: position 12, normal 12.
    pub bare_vertex_bytes: u32,
    /// Where meshes live.
    pub residency: Residency,
    /// The level of `static`, 1..=[`LEVEL_MAX`].
    pub level: u32,
    /// The greatest level of `discrete`, a power of two up to [`LEVEL_MAX`].
    pub max_level: u32,
    /// When the levels of `discrete` cross the link.
    pub upload: Upload,
    /// How wide an index is.
    pub index: IndexWidth,
    /// How indices name triangles.
    pub topology: MeshTopology,
    /// The cache of shaded vertices.
    pub cache: VertexCache,
}

/// Where the meshes of unit `triangles` live.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Residency {
    /// Tessellated anew each frame, under the criterion of the other units, and sent.
    #[default]
    Streamed,
    /// Levels 1, 2, 4, .. in device memory; an instance of a draw takes the least that suffices.
    Discrete,
    /// One level in device memory, whatever the camera sees.
    Static,
}

/// When the levels of discrete meshes cross the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Upload {
    /// Each when an instance first takes it.
    #[default]
    FirstUse,
    /// All of a mesh's, when an instance first takes one.
    Whole,
}

/// How wide an index of a triangle is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IndexWidth {
    /// 2 bytes where they reach all vertices of the mesh or draw, else 4.
    #[default]
    Auto,
    /// 2 bytes; what they do not reach is cut into batches, each a draw with a base of its own.
    Uint16,
    /// 4 bytes.
    Uint32,
}

/// How indices name triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeshTopology {
    /// Three a triangle, in the stitcher's order.
    #[default]
    List,
    /// Strips, a restart index between them.
    StripRestart,
    /// Strips, joined by triangles of two equal corners.
    StripDegenerate,
    /// Three a triangle, each patch's in an order that serves the cache.
    Optimised,
}

/// The cache of shaded vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VertexCache {
    /// Which vertex leaves it.
    pub policy: CachePolicy,
    /// Vertices that it holds, [`CACHE_ENTRIES_MIN`]..=[`CACHE_ENTRIES_MAX`].
    pub entries: u32,
}

/// Which vertex leaves the cache of shaded vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CachePolicy {
    /// None: every distinct vertex is shaded once.
    #[default]
    Unlimited,
    /// The one that came first.
    Fifo,
    /// The one that was named least recently.
    Lru,
}

impl Default for Triangles {
    /// Level 16 is assumed of a static mesh: nothing looks ahead to what the frames will ask for,
    /// and 512 triangles a patch are what tools export for a close view. Discrete levels go as far
    /// as a trace's levels do unless it says otherwise.
    fn default() -> Self {
        Self {
            vertex_bytes: 32,
            bare_vertex_bytes: 24,
            residency: Residency::Streamed,
            level: 16,
            max_level: 64,
            upload: Upload::FirstUse,
            index: IndexWidth::Auto,
            topology: MeshTopology::List,
            cache: VertexCache::default(),
        }
    }
}

impl Default for VertexCache {
    /// 24 entries: what the preset `gf3-2001` has before its vertex shader.
    fn default() -> Self {
        Self { policy: CachePolicy::Unlimited, entries: 24 }
    }
}

impl Triangles {
    /// Whether meshes stay in device memory from frame to frame.
    #[must_use]
    pub fn resides(&self) -> bool {
        self.residency != Residency::Streamed
    }

    /// Whether vertices and indices are read from device memory: those of meshes that stay there,
    /// and those that a cache may ask for again. Others pass from the link to the vertex shader.
    #[must_use]
    pub fn uses_memory(&self) -> bool {
        self.resides() || self.cache.policy != CachePolicy::Unlimited
    }

    /// Whether each patch's indices are three a triangle in the stitcher's order, and every vertex
    /// is shaded once: then nothing of them need be formed to be counted.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.topology == MeshTopology::List && !self.uses_memory()
    }

    pub(super) fn problem(&self) -> Result<(), Problem> {
        let most = 65536;
        within("triangles.vertex_bytes", self.vertex_bytes, 1, most)?;
        within("triangles.bare_vertex_bytes", self.bare_vertex_bytes, 1, most)?;
        within("triangles.level", self.level, 1, LEVEL_MAX)?;
        within("triangles.max_level", self.max_level, 1, LEVEL_MAX)?;
        if !self.max_level.is_power_of_two() {
            return Err(Problem::found("triangles.max_level", self.max_level));
        }
        let VertexCache { entries, .. } = self.cache;
        within("triangles.cache.entries", entries, CACHE_ENTRIES_MIN, CACHE_ENTRIES_MAX)
    }
}

impl Config {
    /// Whether patches out of sight are removed before they are tessellated: not from a mesh that
    /// was made before anything was seen.
    #[must_use]
    pub fn culls_patches(&self) -> bool {
        !(self.unit == Unit::Triangles && self.triangles.resides())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_used_is_refused_with_its_key() {
        type Change = fn(&mut Triangles);
        let wrong: [(Change, &str); 6] = [
            (|t| t.level = 0, "triangles.level: found 0"),
            (|t| t.level = 129, "triangles.level: found 129"),
            (|t| t.max_level = 48, "triangles.max_level: found 48, expected a power of two"),
            (|t| t.cache.entries = 2, "triangles.cache.entries: found 2"),
            (|t| t.cache.entries = 65, "triangles.cache.entries: found 65"),
            (|t| t.vertex_bytes = 0, "triangles.vertex_bytes: found 0"),
        ];
        for (change, says) in wrong {
            let mut config = Config::default();
            change(&mut config.triangles);
            let error = config.check().expect_err(says).to_string();
            assert!(error.starts_with(says), "{error}");
        }
    }

    #[test]
    fn memory_is_used_where_something_is_read_twice() {
        let plain = Triangles::default();
        assert!(plain.is_plain() && !plain.uses_memory() && !plain.resides());
        let strips = Triangles { topology: MeshTopology::StripRestart, ..plain.clone() };
        assert!(!strips.is_plain() && !strips.uses_memory());
        let cache = VertexCache { policy: CachePolicy::Lru, entries: 16 };
        assert!(Triangles { cache, ..plain.clone() }.uses_memory());
        let stays = Triangles { residency: Residency::Static, ..plain };
        assert!(stays.uses_memory() && stays.resides());
    }
}
