// What the kernels of the tessellator share: a pattern's words, and where its rings are. Stands
// before their own texts.
//
// The first implementation walks the rings one after another; here the place of each in the order
// of points and of triangles is a difference of areas, so that an invocation finds its own by
// bisection.
//
// Own settings: a domain (0 quad, 1 tri, 2 isoline), b partitioning (0 integer, 1 pow2, 2 odd,
// 3 even), c output (0 point, 1 line, 2 clockwise, 3 counter-clockwise), d patches.

// `points`, `connect`: patterns, and where each one's items begin.
@group(0) @binding(1) var<storage, read_write> patterns: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> out: array<u32>;

// Words of a pattern: what it is; six factors in 16.16; bit k: factor k has odd segments; the
// segments of each; points; primitives.
const PATTERN = 16u;
const VALUE = 1u;
const PARITY = 7u;
const SEGMENTS = 8u;
const POINTS = 14u;
const PRIMITIVES = 15u;

// What a pattern is, which is 0 where it is nothing: rings, or one triangle or two.
const RINGS = 1u;
const LEAST_ONE = 2u;

const QUAD = 0u;
const TRI = 1u;
const ISOLINE = 2u;

const ODD = 2u;
const EVEN = 3u;

const POINT = 0u;
const LINE = 1u;
const CLOCKWISE = 2u;

// 16.16: a half and 1.
const HALF = 0x8000u;
const ONE = 0x10000u;

fn edges_of(domain: u32) -> u32 {
    return 4u - domain;
}

fn factors_of(domain: u32) -> u32 {
    return 6u - 2u * domain;
}

// A factor in half-edges, of which an odd one has half a segment more: 1 to 32.5.
fn half_of(value: u32, odd: u32) -> u32 {
    let half = (value + 1u) >> 1u;
    return half + select(0u, HALF, odd != 0u || half == HALF);
}

// Points inside a ring of a tri of so many segments, its own included.
fn points_in_tri(side: u32) -> u32 {
    let half = (side + 1u) / 2u;
    return 3u * half * (half + 1u - (side & 1u)) + 1u - (side & 1u);
}

fn segments(at: u32, k: u32) -> u32 {
    return patterns[at + SEGMENTS + k];
}

// Segments of the inner partition along a side, less those of so many rings around.
fn inner(at: u32, side: u32, ring: u32) -> u32 {
    let k = select(5u - (side & 1u), 3u, settings.a == TRI);
    return segments(at, k) - 2u * ring;
}

// Points on the edges.
fn on_edges(at: u32) -> u32 {
    var sum = 0u;
    for (var k = 0u; k < edges_of(settings.a); k += 1u) {
        sum += segments(at, k);
    }
    return sum;
}

// Points of a ring and of all inside it.
fn points_from(at: u32, ring: u32) -> u32 {
    if (settings.a == TRI) {
        return points_in_tri(inner(at, 0u, ring));
    }
    return (inner(at, 0u, ring) + 1u) * (inner(at, 1u, ring) + 1u);
}

// Triangles inside a ring.
fn triangles_from(at: u32, ring: u32) -> u32 {
    let side = inner(at, 0u, ring);
    if (settings.a == TRI) {
        return 3u * side * side / 2u;
    }
    return 2u * side * inner(at, 1u, ring);
}

// The last ring, which may be a line or a point.
fn rings(at: u32) -> u32 {
    return min(inner(at, 0u, 0u), inner(at, 1u, 0u)) / 2u;
}

fn first_of(at: u32, ring: u32) -> u32 {
    return on_edges(at) + points_from(at, 1u) - points_from(at, ring);
}
