//! Keys of unit `triangles`.

use super::{Key, key};

/// In the order of the file.
pub(super) const KEYS: &[Key] = &[
    key(
        "triangles.vertex_bytes",
        "bytes of a vertex on the link and in device memory, unit triangles",
        "1..=65536",
    ),
    key(
        "triangles.bare_vertex_bytes",
        "the same besides its attributes, in draws that have them",
        "1..=65536",
    ),
    key(
        "triangles.residency",
        "whether meshes are tessellated anew each frame and sent; or stay in device memory, and \
         each instance of a draw takes the least of the levels 1, 2, 4, .. that suffices; or stay \
         there at one level",
        "streamed, discrete or static",
    ),
    key("triangles.level", "segments per whole edge of a static mesh", "1..=128"),
    key(
        "triangles.max_level",
        "the greatest of the discrete levels, in segments per whole edge",
        "a power of two in 1..=128",
    ),
    key(
        "triangles.upload",
        "when discrete levels cross the link: each when an instance first takes it, or all of a \
         mesh's at once",
        "first_use or whole",
    ),
    key(
        "triangles.index",
        "bytes of an index: 2, or 4 where those do not reach all vertices; or 2, the vertices cut \
         into batches; or 4",
        "auto, uint16 or uint32",
    ),
    key(
        "triangles.topology",
        "how indices name triangles: as a list, as strips with restart indices or degenerate joins \
         between them, or as a list in an order that serves the cache",
        "list, strip_restart, strip_degenerate or optimised",
    ),
    key(
        "triangles.cache.policy",
        "which shaded vertex leaves the cache: none, the first that came, or the least recently \
         named",
        "unlimited, fifo or lru",
    ),
    key("triangles.cache.entries", "shaded vertices that fifo and lru hold", "3..=64"),
];
