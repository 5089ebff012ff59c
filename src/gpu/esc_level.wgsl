// Levels of resolution: patches in, the level of each edge's thirds and of the interior out
// (Concheiro, Amor, Boo, Padron 2014, section 2.2, and what the first implementation makes of it).
// Points are projected one by one; the number of segments is formed by a division, where the first
// implementation counts comparisons, and squares roots bit by bit.

@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
@group(0) @binding(2) var<storage, read_write> fates: array<u32>;
// Five words a control point: x and y in Q24.16, what became of it.
@group(0) @binding(3) var<storage, read_write> projected: array<u32>;
// The level that the driver chose, a word a patch.
@group(0) @binding(4) var<storage, read_write> given: array<u32>;
@group(0) @binding(5) var<storage, read_write> resolutions: array<u32>;

const KEPT = 2u;
const PROJECTION = 5u;
const ONE = 65536u;

const BY_CRITERION = 0u;
// 1: by a fixed level.
const BY_DISTANCE = 2u;
const BY_SCREEN_SIZE = 3u;
const BY_OBJECT = 4u;

const FLATNESS = 0u;
const EDGE_LENGTH = 1u;

// Stands where a point has no projection; no level and no length is as large.
const NOWHERE = I64(0xffffffffu, 0xffffffffu);

// Lines of the net: rows 0 to 3, columns 4 to 7; those of v0, u1, v1, u0.
const EDGE_LINES = vec4<u32>(0u, 7u, 3u, 4u);

var<private> measures: array<I64, 8>;
// Of the four edges, and of the interior along u and v.
var<private> asked: array<I64, 6>;

@compute @workgroup_size(64)
fn project_points(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let at = item / 16u * PATCH + item % 16u * 8u;
    let x = I64(patches[at], patches[at + 1u]);
    let y = I64(patches[at + 2u], patches[at + 3u]);
    let pixel = project(x, y, I64(patches[at + 6u], patches[at + 7u]));
    let to = PROJECTION * item;
    projected[to] = pixel.x.x;
    projected[to + 1u] = pixel.x.y;
    projected[to + 2u] = pixel.y.x;
    projected[to + 3u] = pixel.y.y;
    projected[to + 4u] = pixel.status;
}

// The k-th point of a line of the net.
fn point_of(line: u32, k: u32) -> u32 {
    return select(4u * line + k, 4u * k + line - 4u, line >= 4u);
}

fn pixel_of(item: u32, point: u32) -> Pixel {
    let at = PROJECTION * (16u * item + point);
    let x = I64(projected[at], projected[at + 1u]);
    let y = I64(projected[at + 2u], projected[at + 3u]);
    return Pixel(x, y, projected[at + 4u]);
}

// |(x, y)|, rounded up; both below 2^43.
fn norm(x: I64, y: I64) -> I64 {
    return root_up(add128(mul_signed(x, x), mul_signed(y, y)));
}

// The length of a line's polygon; or the greater of its second differences, and what rounding may
// have taken off that: under 3 ulps.
fn measure(item: u32, line: u32, bends: bool) -> I64 {
    var most = NONE64;
    var before = pixel_of(item, point_of(line, 0u));
    var here = pixel_of(item, point_of(line, 1u));
    var gone = before.status | here.status;
    if (!bends) {
        most = norm(sub64(here.x, before.x), sub64(here.y, before.y));
    }
    for (var k = 2u; k < 4u; k += 1u) {
        let next = pixel_of(item, point_of(line, k));
        gone |= next.status;
        var x = sub64(next.x, here.x);
        var y = sub64(next.y, here.y);
        if (bends) {
            x = sub64(x, sub64(here.x, before.x));
            y = sub64(y, sub64(here.y, before.y));
        }
        let size = norm(x, y);
        if (bends) {
            most = max64(most, add64(size, I64(3u, 0u)));
        } else {
            most = add64(most, size);
        }
        before = here;
        here = next;
    }
    return select(most, NOWHERE, gone != 0u);
}

// The greatest mixed difference of the nine facets, with the same three ulps.
fn twist(item: u32) -> I64 {
    var most = NONE64;
    for (var facet = 0u; facet < 9u; facet += 1u) {
        let k = facet / 3u * 4u + facet % 3u;
        let a = pixel_of(item, k);
        let b = pixel_of(item, k + 1u);
        let c = pixel_of(item, k + 4u);
        let d = pixel_of(item, k + 5u);
        let x = sub64(add64(a.x, d.x), add64(b.x, c.x));
        let y = sub64(add64(a.y, d.y), add64(b.y, c.y));
        most = max64(most, add64(norm(x, y), I64(3u, 0u)));
    }
    return most;
}

fn greater(a: I64, b: I64) -> I64 {
    return select(a, b, below64(a, b));
}

// The greatest of the four lines from `first`; nowhere is greater than all.
fn greatest(first: u32) -> I64 {
    var most = NONE64;
    for (var k = 0u; k < 4u; k += 1u) {
        most = greater(most, measures[first + k]);
    }
    return most;
}

fn is_nowhere(a: I64) -> bool {
    return all(a == NOWHERE);
}

// n >= sqrt(3/4 bend / d) in UQ.16.
fn curve_level(bend: I64, d: u32) -> I64 {
    let three = mul_unsigned(bend, I64(3u, 0u));
    return root_up(divide_up(shl128(three, 30u), I128(d, 0u, 0u, 0u)));
}

fn clamped_level(level: I64, least: u32, most: u32) -> u32 {
    if (level.y != 0u || level.x > most) {
        return most;
    }
    return max(level.x, least);
}

// level, raised until level^2 is bound 2^29 / (d across^2).
fn raised(level: u32, across: u32, bound: I128, d: u32) -> I64 {
    let square = mul_unsigned(mul_words(across, across), I64(d, 0u));
    let root = root_up(divide_up(shl128(bound, 29u), square));
    return greater(root, I64(level, 0u));
}

// The interior's two levels: 6 Muu / n^2 + 18 Muv / (n m) + 6 Mvv / m^2 <= 8 d (Filip, Magedson,
// Markot 1986), from the levels of the edges and of the net's own lines on.
fn interior_flatness(item: u32, d: u32, least: u32, most: u32) {
    asked[4] = NOWHERE;
    asked[5] = NOWHERE;
    let uu = greatest(0u);
    let vv = greatest(4u);
    if (is_nowhere(uu) || is_nowhere(vv)) {
        return;
    }
    let start_u = greater(greater(asked[0], asked[2]), curve_level(uu, d));
    let start_v = greater(greater(asked[1], asked[3]), curve_level(vv, d));
    let n = clamped_level(start_u, least, most);
    let m = clamped_level(start_v, least, most);
    // 45 bits for each M, 24 for n and m.
    var bound = mul128(wide(uu), mul_unsigned(mul_words(m, m), I64(6u, 0u)));
    let mixed = mul_unsigned(mul_words(n, m), I64(18u, 0u));
    bound = add128(bound, mul128(wide(twist(item)), mixed));
    bound = add128(bound, mul128(wide(vv), mul_unsigned(mul_words(n, n), I64(6u, 0u))));
    asked[4] = raised(n, m, bound, d);
    asked[5] = raised(m, n, bound, d);
}

// Segments but one, of `all` parts of size `unit`: at least 0, at most the greatest level.
fn segments_less_one(parts: I128, unit: I64) -> u32 {
    let quotient = divide_up(parts, I128(unit, 0u, 0u));
    if (quotient.y != 0u || quotient.x > settings.l) {
        return settings.l;
    }
    return max(quotient.x, 1u) - 1u;
}

// Measures all lines, and asks for edges and interior what they give.
fn measure_all(item: u32, bends: bool) {
    for (var line = 0u; line < 8u; line += 1u) {
        measures[line] = measure(item, line, bends);
    }
    for (var edge = 0u; edge < 4u; edge += 1u) {
        asked[edge] = measures[EDGE_LINES[edge]];
    }
    asked[4] = greatest(0u);
    asked[5] = greatest(4u);
}

// Edges without projection, and points that did not fit.
fn count_projections(item: u32) -> vec2<u32> {
    var counts = vec2(0u);
    for (var edge = 0u; edge < 4u; edge += 1u) {
        counts.x += u32(is_nowhere(measures[EDGE_LINES[edge]]));
    }
    for (var k = 0u; k < 16u; k += 1u) {
        counts.y += u32(projected[PROJECTION * (16u * item + k) + 4u] == BEYOND);
    }
    return counts;
}

struct Chosen {
    levels: array<u32, 6>,
    clamped: u32,
    near: u32,
    overflows: u32,
    kind: u32,
}

// By the tessellation state, in thirds of an edge.
fn by_criterion(item: u32) -> Chosen {
    let at = item * PATCH;
    let kind = patches[at + CRITERION];
    let number = patches[at + NUMBER];
    let top = 3u * (settings.l + 1u) * ONE;
    let least = min(patches[at + LEAST], top);
    let most = min(patches[at + GREATEST], top);
    var chosen: Chosen;
    chosen.kind = kind;
    if (kind == FLATNESS || kind == EDGE_LENGTH) {
        measure_all(item, kind == FLATNESS);
        let events = count_projections(item);
        chosen.near = events.x;
        chosen.overflows = events.y;
    }
    for (var k = 0u; k < 6u; k += 1u) {
        if (kind == FLATNESS) {
            if (k == 4u) {
                interior_flatness(item, number, least, most);
            } else if (k < 4u && !is_nowhere(asked[k])) {
                asked[k] = curve_level(asked[k], number);
            }
        } else if (kind == EDGE_LENGTH) {
            if (!is_nowhere(asked[k])) {
                let parts = shl128(I128(asked[k], 0u, 0u), 16u);
                asked[k] = divide_up(parts, I128(number, 0u, 0u, 0u)).xy;
            }
        } else {
            asked[k] = I64(number, 0u);
        }
    }
    for (var k = 0u; k < 6u; k += 1u) {
        let over = below64(I64(most, 0u), asked[k]);
        chosen.clamped += u32(over && !is_nowhere(asked[k]));
        let level = clamped_level(asked[k], least, most);
        chosen.levels[k] = segments_less_one(I128(level, 0u, 0u, 0u), I64(3u * ONE, 0u));
    }
    if (patches[at + LEAST] > top) {
        chosen.clamped = 6u;
    }
    return chosen;
}

// The least w of a line, or of all points, if it is in front.
fn nearest_w(item: u32, line: u32) -> I64 {
    var least = I64(0xffffffffu, 0x7fffffffu);
    for (var k = 0u; k < 16u; k += 1u) {
        let counts = line == 8u || k < 4u;
        let point = select(point_of(line, k), k, line == 8u);
        if (counts) {
            let at = item * PATCH + 8u * point + 6u;
            let w = I64(patches[at], patches[at + 1u]);
            least = select(least, w, less64(w, least));
        }
    }
    return select(NOWHERE, least, in_front(least));
}

// N full / w segments.
fn by_distance(item: u32) -> Chosen {
    var chosen: Chosen;
    chosen.kind = 2u;
    let parts = mul_unsigned(I64(settings.n, settings.o), I64(settings.l + 1u, 0u));
    for (var k = 0u; k < 5u; k += 1u) {
        var line = 8u;
        if (k < 4u) {
            line = EDGE_LINES[k];
        }
        let w = nearest_w(item, line);
        chosen.near += u32(is_nowhere(w) && k < 4u);
        chosen.levels[k] = settings.l;
        if (!is_nowhere(w)) {
            chosen.levels[k] = segments_less_one(parts, w);
        }
    }
    return chosen;
}

// N length / pixels segments.
fn by_screen_size(item: u32) -> Chosen {
    var chosen: Chosen;
    chosen.kind = EDGE_LENGTH;
    let full = I64(settings.n, 0u);
    measure_all(item, false);
    let events = count_projections(item);
    chosen.near = events.x;
    chosen.overflows = events.y;
    for (var k = 0u; k < 6u; k += 1u) {
        chosen.levels[k] = settings.l;
        if (!is_nowhere(asked[k])) {
            chosen.clamped += u32(below64(full, asked[k]));
            let parts = mul_unsigned(asked[k], I64(settings.l + 1u, 0u));
            chosen.levels[k] = segments_less_one(parts, full);
        }
    }
    return chosen;
}

fn same(level: u32) -> Chosen {
    var chosen: Chosen;
    chosen.kind = 2u;
    chosen.clamped = select(0u, 6u, level > settings.l);
    for (var k = 0u; k < 6u; k += 1u) {
        chosen.levels[k] = min(level, settings.l);
    }
    return chosen;
}

@compute @workgroup_size(64)
fn resolve(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let to = RESOLUTION * item;
    if (fates[4u * item] != KEPT) {
        resolutions[to + INTERIOR] = SKIPPED;
        return;
    }
    var chosen: Chosen;
    switch settings.m {
        case BY_CRITERION: { chosen = by_criterion(item); }
        case BY_DISTANCE: { chosen = by_distance(item); }
        case BY_SCREEN_SIZE: { chosen = by_screen_size(item); }
        case BY_OBJECT: { chosen = same(given[item]); }
        default: { chosen = same(settings.n); }
    }
    var most = 0u;
    for (var k = 0u; k < 6u; k += 1u) {
        most = max(most, chosen.levels[k]);
        if (k < 4u) {
            resolutions[to + k] = chosen.levels[k];
        }
    }
    resolutions[to + INTERIOR] = most;
    resolutions[to + 5u] = chosen.clamped;
    resolutions[to + 6u] = chosen.near;
    resolutions[to + 7u] = chosen.overflows;
    resolutions[to + 8u] = 1u;
    resolutions[to + 9u] = u32(chosen.kind == FLATNESS);
    resolutions[to + 10u] = u32(chosen.kind == EDGE_LENGTH);
}
