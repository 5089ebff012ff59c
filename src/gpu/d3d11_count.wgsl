// What the tessellator, the cache of shaded points and the domain shader did for a patch: vertices
// and triangles in, words of its row of counts out.
//
// Triangles and edges are looked at one an invocation. An invocation a patch walks the cache,
// each point with the number of the miss that brought it last; waves are what fills them. The first
// implementation gathers waves one by one, and looks up what it has counted of a pattern before.
//
// Own settings: d patches, m entries of the cache, all ones for no end, n points of a wave, o bytes
// of a burst of memory.

// Where items begin: points for `edges`, else triangles. `triangles` and `edges` have the vertices
// of a range of patches; `cache` has, besides, a word a vertex, all 0, and two words a patch:
// components of a vertex' attributes, and bytes that the hull shader hands on.
@group(0) @binding(1) var<storage, read_write> starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> vertices: array<u32>;
@group(0) @binding(3) var<storage, read_write> triangle_words: array<u32>;
@group(0) @binding(4) var<storage, read_write> rows: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> point_starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> patterns: array<u32>;
@group(0) @binding(3) var<storage, read_write> on_edges: array<u32>;
@group(0) @binding(6) var<storage, read_write> brought: array<u32>;
@group(0) @binding(7) var<storage, read_write> of_patch: array<u32>;

const QUAD_EDGES = 4u;
// A pattern's words, its factors, and where the segments of each stand.
const PATTERN = 16u;
const FACTORS = 6u;
const SEGMENTS = 8u;

// A row's words from here on.
const ROW = 30u;
const PARAMETERS = 13u;
const POINTS = 14u;
const NON_MONOTONE = 15u;
const TRIANGLES = 16u;
const INVERTED = 17u;
const ZERO_AREA = 18u;
const DEGENERATE = 19u;
const SHADED = 20u;
const WAVES = 21u;
const ATTRIBUTES = 24u;
const COMPONENTS = 25u;
const BYTES = 26u;
const BURSTS = 27u;
const WRITTEN = 28u;
const WRITTEN_BURSTS = 29u;

fn count(patch_number: u32, column: u32, more: bool) {
    if (more) {
        atomicAdd(&rows[patch_number * ROW + column], 1u);
    }
}

// ---- triangles

fn difference(a: u32, b: u32, axis: u32) -> I64 {
    let of_a = vertices[a * VERTEX + 8u + axis];
    return word(bitcast<i32>(vertices[b * VERTEX + 8u + axis] - of_a));
}

// Twice the area in the domain.
fn area(a: u32, b: u32, c: u32) -> I64 {
    let p = mul64(difference(a, b, 0u), difference(a, c, 1u));
    let q = mul64(difference(a, b, 1u), difference(a, c, 0u));
    return sub64(p, q);
}

// An invocation a triangle of a range of patches, whose first vertex is number p.
@compute @workgroup_size(64)
fn triangles(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let patch_number = owner(settings.first + item, 0u, settings.d);
    let first = point_starts[patch_number] - settings.p;
    let a = first + triangle_words[3u * item];
    let b = first + triangle_words[3u * item + 1u];
    let c = first + triangle_words[3u * item + 2u];
    let twice = area(a, b, c);
    count(patch_number, INVERTED, is_negative64(twice));
    count(patch_number, ZERO_AREA, is_zero64(twice));
    count(
        patch_number,
        DEGENERATE,
        same_position(a, b) || same_position(b, c) || same_position(c, a),
    );
}

// ---- edges

// Whether the next point of the outer ring lies before one of it. The ring goes down U = 0, then
// along V = 0, U = 1 and back along V = 1.
fn turns_back(at: u32, first: u32, number: u32, points: u32) -> bool {
    var side = 0u;
    var k = number;
    while (side < QUAD_EDGES - 1u && k >= patterns[at + SEGMENTS + side]) {
        k -= patterns[at + SEGMENTS + side];
        side += 1u;
    }
    let axis = 9u - side % 2u;
    let here = on_edges[(first + number) * VERTEX + axis];
    let next = on_edges[(first + (number + 1u) % points) * VERTEX + axis];
    if (side == 1u || side == 2u) {
        return here > next;
    }
    return here < next;
}

// An invocation a point of a range of patches, the first of them number `first`.
@compute @workgroup_size(64)
fn edges(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let patch_number = owner(settings.first + item, 0u, settings.d);
    let at = patch_number * PATTERN;
    var points = 0u;
    for (var k = 0u; k < QUAD_EDGES; k += 1u) {
        points += patterns[at + SEGMENTS + k];
    }
    let number = settings.first + item - starts[patch_number];
    if (number < points) {
        let back = turns_back(at, item - number, number, points);
        count(patch_number, NON_MONOTONE, back);
    }
}

// ---- the cache of shaded points

// Points that are shaded for a patch's triangles: first in, first out. A point is there until as
// many others as there are entries have come.
fn misses(first: u32, begin: u32, end: u32) -> u32 {
    var missed = 0u;
    for (var k = begin; k < end; k += 1u) {
        let point = first + triangle_words[k];
        let last = brought[point];
        if (last == 0u || missed - last >= settings.m) {
            missed += 1u;
            brought[point] = missed;
        }
    }
    return missed;
}

// An invocation a patch, from number `first` on.
@compute @workgroup_size(64)
fn cache(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = settings.first + item;
    let at = number * ROW;
    let components = of_patch[2u * number];
    let bytes = of_patch[2u * number + 1u];
    let bursts = (bytes + settings.o - 1u) / settings.o;
    // The hull shader hands on what is culled, too.
    atomicStore(&rows[at + WRITTEN], bytes);
    atomicStore(&rows[at + WRITTEN_BURSTS], bursts);
    let points = point_starts[number + 1u] - point_starts[number];
    if (points == 0u) {
        return;
    }
    let base = starts[settings.first];
    let first = point_starts[number] - point_starts[settings.first];
    let shaded = misses(first, 3u * (starts[number] - base), 3u * (starts[number + 1u] - base));
    var parameters = 0u;
    for (var k = 0u; k < FACTORS; k += 1u) {
        parameters += patterns[number * PATTERN + SEGMENTS + k] + 1u;
    }
    atomicStore(&rows[at + PARAMETERS], parameters);
    atomicStore(&rows[at + POINTS], points);
    atomicStore(&rows[at + TRIANGLES], starts[number + 1u] - starts[number]);
    atomicStore(&rows[at + SHADED], shaded);
    atomicStore(&rows[at + WAVES], (shaded + settings.n - 1u) / settings.n);
    atomicStore(&rows[at + ATTRIBUTES], shaded * components);
    atomicStore(&rows[at + COMPONENTS], components);
    atomicStore(&rows[at + BYTES], bytes);
    atomicStore(&rows[at + BURSTS], bursts);
}
