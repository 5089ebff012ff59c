// What every kernel is told, and how patches lie in their buffer. Stands before every kernel's own
// text, behind the integers.

struct Settings {
    // How many items the dispatch has, and the number of the first.
    items: u32,
    first: u32,
    // The position format, and the modes as numbered in the integers' file; wraps: 0 or 1.
    width: u32,
    rounding: u32,
    wraps: u32,
    guard: u32,
    // 0 forward, 1 mixed, 2 de Casteljau.
    scheme: u32,
    // The view: pixels; depth 0 from zero to one, 1 from minus one; the least w, low and high
    // word; facing 1 or -1.
    viewport_x: u32,
    viewport_y: u32,
    depth: u32,
    near_low: u32,
    near_high: u32,
    facing: u32,
    // Clip 0 or 1; method 0 off, 1 net_facets, 2 tangent_plane, 3 normal_cone, 4 hull_literal.
    clip: u32,
    backface: u32,
    // 0 eight curves, 1 bounded.
    termination: u32,
    subpixel_bits: u32,
    emit_rounding: u32,
    // Fraction bits of a level's reciprocal, 8 to 32.
    reciprocal_bits: u32,
    // A kernel's own, as its file says.
    a: u32,
    b: u32,
    c: u32,
    d: u32,
    e: u32,
    f: u32,
    g: u32,
    h: u32,
    i: u32,
    j: u32,
    k: u32,
    l: u32,
    m: u32,
    n: u32,
    o: u32,
    p: u32,
}

@group(0) @binding(0) var<uniform> settings: Settings;

// Words of a patch: 16 points of 4 coordinates of 2 words; then its flags (1 saturated, 2 may be
// culled, 4 reversed) and its tessellation state: criterion (0 flatness, 1 edge length, 2 fixed),
// its number, least and greatest level; then three words that are a unit's own.
const PATCH = 136u;
const FLAGS = 128u;
const CRITERION = 129u;
const NUMBER = 130u;
const LEAST = 131u;
const GREATEST = 132u;

// Words of a vertex: 4 coordinates of 2 words, u, v.
const VERTEX = 10u;

// The number of an invocation: dispatches are rows of at most 65535 groups of 64.
fn item_of(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.x + id.y * groups.x * 64u;
}
