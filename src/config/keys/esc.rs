//! The keys `esc.*`: the surface shader of unit `esc`.

use super::{Key, key, optional};

/// A number of pixels, or of object units, above 0.
const POSITIVE: &str = "a number > 0";

pub(super) const KEYS: &[Key] = &[
    key(
        "esc.level",
        "what the level of resolution L depends on (unit esc): the criterion of the trace or of \
         level.*, of which it is the smallest L with 3 (L + 1) segments; a number; the distance \
         from the eye; the size on the screen",
        "criterion, fixed, distance or screen_size",
    ),
    key(
        "esc.scope",
        "what has a level: each edge of each patch, by that edge alone, or the whole of a draw's \
         instance by its bounding box, which the driver looks at",
        "patch or object; patch with esc.level criterion",
    ),
    key(
        "esc.level_max",
        "greatest level, candidates on an edge of a coarse triangle; the paper's is 3",
        "0..=15",
    ),
    key("esc.fixed_level", "the level of fixed", "0..=15; under fixed at most esc.level_max"),
    key(
        "esc.full_distance",
        "w up to which distance gives the greatest level; beyond it L + 1 falls as 1 / w",
        POSITIVE,
    ),
    key(
        "esc.full_pixels",
        "length of an edge's projected control polygon, or side of an object's box, from which on \
         screen_size gives the greatest level; below it L + 1 falls with it",
        "a number > 0, at most 65535",
    ),
    key(
        "esc.control_mesh",
        "what the local test holds the surface against: the control net, or the chord between the \
         surface points at the ends of the coarse edge",
        "net or chord",
    ),
    key(
        "esc.space",
        "in which space it takes the distance; object: of the control points, before model",
        "pixels or object",
    ),
    key(
        "esc.mu",
        "distance above which a candidate is inserted, in pixels or object units; 0: all are, \
         and nothing is tested",
        "a number >= 0, at most 65535",
    ),
    key(
        "esc.boundary",
        "how points of a patch's boundary are evaluated: by the edge's own four points from the \
         nearer corner, the same from either side, or as all others, which cracks",
        "symmetric or plain",
    ),
    key(
        "esc.reuse",
        "how far a point that was evaluated serves: not at all, for its coarse triangle, or for \
         its patch (its section, under esc.output_values)",
        "none, coarse_triangle or patch",
    ),
    key(
        "esc.guard",
        "fraction bits that [N][B][M]^T and Horner's registers have below a position's",
        "0..=20, with position.width + 8 + guard <= 63",
    ),
    key("esc.parameter_bits", "fraction bits of a parameter", "16..=46"),
    optional(
        "esc.output_values",
        "most 32-bit values that an invocation may give, as a geometry shader's 1024 of 2010: a \
         patch is then split into sections of its parametric map, each an invocation",
        "1..=4294967295, at least the longest strip",
        ("1024", "no limit"),
    ),
    key("esc.width", "invocations that a wave runs side by side", "1..=1024"),
    key(
        "esc.registers",
        "registers of an invocation beside the 64 of [N][B][M]^T, in words",
        "0..=65536",
    ),
    key(
        "esc.register_file",
        "registers of a processor, in words: they say how many waves it holds",
        "1..=16777216",
    ),
    key("esc.bytes_out", "bytes of a vertex that leaves, without its attributes", "4..=65536"),
];
