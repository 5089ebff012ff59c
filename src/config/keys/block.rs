//! The keys `block.NAME.*`, six a block: what they mean, and the reason for the default.

use super::{CYCLES, FIFO, Key, key, optional};

const INTERVAL: &str = "1..=1000000";
const ENTRIES: &str = "1..=65536";
const IN_FLIGHT: &str = "floor(latency / interval) + 1, which hides the latency";
/// A token is a patch there, and an item one of its six levels.
const LEVELS: &str = "4: six levels each fill the pipeline of 16";
const EVALUATE: &str = "2: one patch runs while the next one's first curve is set up";
const HULL: &str = "16: 17 threads each, so many patches fill the program's 200 cycles";
const FACTORS: &str = "4: six factors each fill the pipeline";
const PATTERN: &str = "2: one patch is walked while the next one arrives";
/// A token is a wave there.
const SURFACE: &str = "as many waves as esc.register_file holds";
const ORDERS: &str = "first_free or round_robin";

/// The keys of the blocks, in the order of the data. Paths and meanings must be joined before the
/// program runs, which no function can do.
macro_rules! keys {
    ($($block:literal {
        interval: $interval:literal $(absent $no_interval:expr)?,
        latency: $latency:literal $(absent $no_latency:expr)?,
        in_flight: $in_flight:literal $(that is $few:expr)?,
        fifo: $fifo:literal
        $(, $extra:expr)*
    })*) => {
        &[$(
            perhaps(
                concat!("block.", $block, ".interval"),
                concat!("cycles from one work item to the next on a lane; ", $interval),
                INTERVAL,
                &[$($no_interval)?],
            ),
            perhaps(
                concat!("block.", $block, ".latency"),
                concat!("cycles from a work item's acceptance to its result; ", $latency),
                CYCLES,
                &[$($no_latency)?],
            ),
            optional(
                concat!("block.", $block, ".in_flight"),
                "tokens under way in a lane at once",
                ENTRIES,
                ($in_flight, [$($few,)? IN_FLIGHT][0]),
            ),
            key(concat!("block.", $block, ".lanes"), "lanes side by side", "1..=4096"),
            key(
                concat!("block.", $block, ".lane_order"),
                "which lane takes the next token",
                ORDERS,
            ),
            key(
                concat!("block.", $block, ".fifo"),
                concat!("entries of the FIFO before the block: ", $fifo),
                FIFO,
            ),
            $($extra,)*
        )*]
    };
}

/// A key that may be absent if there is something to be said of that.
const fn perhaps(
    path: &'static str,
    meaning: &'static str,
    expected: &'static str,
    absent: &[(&'static str, &'static str)],
) -> Key {
    Key { path, meaning, expected, absent: if absent.is_empty() { None } else { Some(absent[0]) } }
}

pub(super) const KEYS: &[Key] = keys! {
    "transform" {
        interval: "an item is a control point",
        latency: "a shader program and its waits, hidden by other points",
        in_flight: "201",
        fifo: "control points"
    }
    "port" {
        interval: "an item is a control point, its four components converted side by side",
        latency: "shift, round and saturate between two registers",
        in_flight: "2",
        fifo: "control points"
    }
    "assemble" {
        interval: "an item is a control point, written to the patch store",
        latency: "one write",
        in_flight: "2",
        fifo: "control points"
    }
    "hull" {
        interval: "an item is a thread: 16 a patch for its control points, and one for its factors",
        latency: "a shader program and its waits, hidden by other patches",
        in_flight: "16" that is HULL,
        fifo: "patches"
    }
    "clip" {
        interval: "an item is a patch: 16 outcodes, four a cycle, so that the 9 new points of a \
                   mesh's patch never wait for it",
        latency: "the four cycles, and a register",
        in_flight: "2",
        fifo: "patches"
    }
    "backface" {
        interval: "an item is a patch that is tested; any other takes 1 cycle"
            absent ("81", "by method, one a cycle: 18 facets of the net (net_facets), 81 \
                     coefficients (tangent_plane), 36 coefficients of the normal \
                     (normal_cone), 560 triples of points (hull_literal)"),
        latency: "of a patch that is tested; any other takes 1 cycle"
            absent ("89", "interval + 8: three multipliers deep, and registers"),
        in_flight: "2",
        fifo: "patches"
    }
    "level" {
        interval: "an item is a level: six a patch (four edges, two interior directions) under \
                   flatness and edge_length, one under fixed",
        latency: "a pipelined square root and divide",
        in_flight: "4" that is LEVELS,
        fifo: "patches"
    }
    "place" {
        interval: "an item is a reciprocal: one for each distinct level above 1",
        latency: "a pipelined reciprocal",
        in_flight: "4" that is LEVELS,
        fifo: "patches"
    }
    "factors" {
        interval: "an item is a tessellation factor: six a patch",
        latency: "to 16.16, clamped, halved, floor and ceiling",
        in_flight: "4" that is FACTORS,
        fifo: "patches"
    }
    "points" {
        interval: "an item is a domain point",
        latency: "two multiplications and an addition",
        in_flight: "2" that is PATTERN,
        fifo: "patches"
    }
    "connect" {
        interval: "an item is a triangle",
        latency: "a step of the walk, and the cache of shaded points",
        in_flight: "2" that is PATTERN,
        fifo: "patches"
    }
    "evaluate" {
        interval: "an item is a point: a forward-difference step of a vec4 (12 adders) a cycle",
        latency: "three additions in a row, and rounding",
        in_flight: "2" that is EVALUATE,
        fifo: "patches",
        key(
            "block.evaluate.setup",
            "cycles to set up a curve's differences, its two half-runs together, while the curve \
             before runs: a change of basis by shifts and additions, and three powers of the step",
            CYCLES,
        )
    }
    "stitch" {
        interval: "an item is a triangle: a step of the Bresenham walk",
        latency: "one step",
        in_flight: "2",
        fifo: "rows"
    }
    "domain" {
        interval: "an item is a wave"
            absent ("64", "domain.width, a point a cycle as in vertex_shader; four times that \
                     under naive, which reads 256 bytes a point, 64 a cycle"),
        latency: "a shader program and its waits, hidden by other waves",
        in_flight: "4",
        fifo: "waves"
    }
    "group" {
        interval: "an item is a patch that joins a wave",
        latency: "one write",
        in_flight: "2",
        fifo: "patches"
    }
    "surface" {
        interval: "an item is an instruction of a wave: 64 invocations on 16 lanes",
        latency: "from a wave's last instruction to its output, hidden by other waves",
        in_flight: "10" that is SURFACE,
        fifo: "waves",
        key(
            "block.surface.net",
            "instructions of a vec4 for [N][B][M]^T: 8 products of 4 x 4 by a vec4 of columns, \
             shifts and additions each",
            CYCLES,
        ),
        key(
            "block.surface.test",
            "instructions of a distance test besides its point: an interpolation, two \
             projections with a reciprocal each, a squared length",
            CYCLES,
        ),
        key(
            "block.surface.point",
            "instructions of a point: 15 multiply-adds by Horner, and rounding; presets hd5870 \
             and hd6970: 20, the length of all their programs",
            CYCLES,
        ),
        key(
            "block.surface.slot",
            "instructions of a slot of a strip: the walk, the comparison, the output",
            CYCLES,
        )
    }
    "emit" {
        interval: "an item is a vertex (a divide), or a triangle that brings none; units d3d11 and \
                   esc: of a wave its points or its triangles, whichever are more",
        latency: "a pipelined reciprocal",
        in_flight: "17",
        fifo: "vertices and triangles"
    }
    "vertex_shader" {
        interval: "an item is a vertex",
        latency: "a shader program and its waits, hidden by other vertices",
        in_flight: "201",
        fifo: "vertices"
    }
};
