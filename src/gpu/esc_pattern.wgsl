// The pattern of a patch (Concheiro, Amor, Boo, Padron 2014, section 3): coarse edges and
// triangles, where their sites lie on the grid, and parameters. Stands before the texts of the
// surface-level shader; has no bindings. Where the first implementation has tables, this has
// formulas; where it searches, this inverts.
//
// The settings' own words, the same for all entries:
//   a  words from one patch's control points to the next one's
//   b  nets of a patch: 1, or 8 where it is turned
//   c  guard bits; d  fraction bits of a parameter
//   e  boundary: 0 symmetric, 1 plain
//   f  tests: 0 none, 1 on the screen, 2 in object space; g, h  their threshold
//   i  what is compared: 0 net, 1 chord; j  fraction bits in object space
//   k  reuse: 0 none, 1 within a coarse triangle, 2 within a patch
//   l  the greatest level
//   m  levels: 0 criterion, 1 fixed, 2 distance, 3 screen size, 4 of the object; n, o  the number
//   p  segments for which sections are declared

// What is known of a patch before it is tessellated, in words: levels of v0, u1, v1, u0 and of the
// interior; clamped, near, overflows; whether it was kept; by flatness; by length; nothing.
const RESOLUTION = 12u;
const INTERIOR = 4u;
// The interior's level of a patch that goes no further.
const SKIPPED = 0xffffffffu;

const COARSE_EDGES = 33u;
const COARSE_TRIANGLES = 18u;
// Of a coarse edge: which candidates are inserted, and overflows of points that only tests saw.
const DECISION = 2u;
// Lines of the finest grid, and crossings.
const LINES = 49u;
const CROSSINGS = 2401u;

const CORNER = 0u;
const BOUNDARY = 1u;
const COARSE = 2u;
const INSIDE = 3u;

// Not on an edge of the patch.
const NO_SIDE = 4u;

struct Levels {
    edges: vec4<u32>,
    interior: u32,
}

struct CoarseEdge {
    // Corner of cells where it begins, in thirds, and the way to the other end.
    corner: vec2<u32>,
    step: vec2<i32>,
    // The edge of the patch that it is a third of.
    side: u32,
}

// Twelve along u row by row, twelve along v likewise, nine diagonals.
fn coarse_edge(number: u32) -> CoarseEdge {
    if (number < 12u) {
        let row = number / 3u;
        let side = select(select(NO_SIDE, 2u, row == 3u), 0u, row == 0u);
        return CoarseEdge(vec2(number % 3u, row), vec2(1, 0), side);
    }
    if (number < 24u) {
        let column = (number - 12u) % 4u;
        let side = select(select(NO_SIDE, 1u, column == 3u), 3u, column == 0u);
        return CoarseEdge(vec2(column, (number - 12u) / 4u), vec2(0, 1), side);
    }
    let cell = vec2((number - 24u) % 3u + 1u, (number - 24u) / 3u);
    return CoarseEdge(cell, vec2(-1, 1), NO_SIDE);
}

fn level_of(edge: CoarseEdge, levels: Levels) -> u32 {
    if (edge.side == NO_SIDE) {
        return levels.interior;
    }
    return levels.edges[edge.side];
}

// The crossing at a position, 0 to `segments`, of a coarse edge.
fn crossing(edge: CoarseEdge, position: u32, segments: u32) -> vec2<u32> {
    let start = vec2<i32>(edge.corner * segments);
    return vec2<u32>(start + edge.step * i32(position));
}

// The numbers of the left, right and bottom edge of a coarse triangle.
fn edges_of(triangle: u32) -> vec3<u32> {
    let p = triangle / 2u % 3u;
    let q = triangle / 6u;
    let second = triangle & 1u;
    return vec3(3u * (q + second) + p, 12u + 4u * q + p + second, 24u + 3u * q + p);
}

// The crossing of a site (row, place) of a coarse triangle: the second one of a cell is turned.
fn crossing_of(triangle: u32, site: vec2<u32>, segments: u32) -> vec2<u32> {
    let cell = vec2(triangle / 2u % 3u, triangle / 6u);
    let along = vec2(site.x - site.y, site.y);
    if ((triangle & 1u) != 0u) {
        return (cell + 1u) * segments - along;
    }
    return cell * segments + along;
}

// The first coarse triangle that a crossing belongs to.
fn owner(place: vec2<u32>, segments: u32) -> u32 {
    let cell = (max(place, vec2(1u)) - 1u) / segments;
    let within = place - cell * segments;
    return 6u * cell.y + 2u * cell.x + u32(within.x + within.y > segments);
}

fn kind_of(place: vec2<u32>, segments: u32) -> u32 {
    let last = 3u * segments;
    let outer = (place == vec2(0u)) | (place == vec2(last));
    if (all(outer)) {
        return CORNER;
    }
    if (any(outer)) {
        return BOUNDARY;
    }
    let third = any(place % segments == vec2(0u)) || (place.x + place.y) % segments == 0u;
    return select(INSIDE, COARSE, third);
}

// The candidate of the interior's pattern that carries candidate k of an edge: the nearest, of two
// the later one.
fn slot(k: u32, level: u32, interior: u32) -> u32 {
    let own = level + 1u;
    return (2u * k * (interior + 1u) + own) / (2u * own);
}

// The line of an edge's own level that a line of the interior's carries: the first k whose slot is
// not before it. Lines between are nobody's.
fn carried(line: u32, level: u32, interior: u32) -> u32 {
    let inner = interior + 1u;
    let third = line / inner;
    let position = line % inner;
    if (position == 0u) {
        return third * (level + 1u);
    }
    let k = ((2u * position - 1u) * (level + 1u) + 2u * inner - 1u) / (2u * inner);
    return third * (level + 1u) + k;
}

struct Small {
    value: I64,
    rest: u32,
}

// Unsigned, by a divisor below 2^16: four digits of 16 bits.
fn divide_small(a: I64, divisor: u32) -> Small {
    var q = Small(NONE64, 0u);
    for (var digit = 4u; digit > 0u; digit -= 1u) {
        let shift = 16u * (digit - 1u);
        let part = (q.rest << 16u) | (shr64(a, shift).x & 0xffffu);
        q.value |= shl64(I64(part / divisor, 0u), shift);
        q.rest = part % divisor;
    }
    return q;
}

// round(a / divisor), signed, by a divisor below 2^15.
fn divide_few(a: I64, divisor: u32, mode: u32) -> I64 {
    let negative = is_negative64(a);
    var q = divide_small(abs64(a), divisor);
    if (negative) {
        q.value = neg64(q.value);
        if (q.rest != 0u) {
            q.value = sub64(q.value, I64(1u, 0u));
            q.rest = divisor - q.rest;
        }
    }
    let equal = 2u * q.rest == divisor;
    let past = 2u * q.rest >= divisor;
    let up = mode != FLOOR && past && !(equal && tie(mode, (q.value.x & 1u) != 0u, negative));
    return add64(q.value, I64(u32(up), 0u));
}

// Line i of a level: i / (3 (level + 1)) in U1.bits, to nearest; no ties but exact values.
fn parameter(level: u32, line: u32, bits: u32) -> I64 {
    let lines = 3u * (level + 1u);
    let twice = add64(shl64(I64(line, 0u), bits + 1u), I64(lines, 0u));
    return divide_small(twice, 2u * lines).value;
}

// What became of a projection.
const PROJECTED = 0u;
const NEAR = 1u;
const BEYOND = 2u;

struct Pixel {
    x: I64,
    y: I64,
    status: u32,
}

// 2^23 pixels in Q24.16, less an ulp.
const PIXEL_MAX = I64(0xffffffffu, 0x7fu);

fn in_front(w: I64) -> bool {
    let near = I64(settings.near_low, settings.near_high);
    return !less64(w, near) && !is_negative64(w) && !is_zero64(w);
}

// c / w * size / 2 in Q24.16, to nearest even; `fits` where it does. The quotient has at most 40
// bits, so the division is of 40 steps and its remainder below 2 w.
fn pixels(c: I64, w: I64, size: u32, fits: ptr<function, bool>) -> I64 {
    // 48 bits times 14 and 15
    let numerator = mul_unsigned(abs64(c), I64(size * 32768u, 0u));
    *fits = !below128(I128(w, 0u, 0u), shr128(numerator, 39u));
    if (!*fits) {
        return NONE64;
    }
    var rest = shr128(numerator, 40u).xy;
    let low = I64(numerator.x, numerator.y & 0xffu);
    var quotient = NONE64;
    for (var bit = 40u; bit > 0u; bit -= 1u) {
        rest = shl64(rest, 1u) | (shr64(low, bit - 1u) & I64(1u, 0u));
        quotient = shl64(quotient, 1u);
        if (!below64(rest, w)) {
            rest = sub64(rest, w);
            quotient.x |= 1u;
        }
    }
    let twice = shl64(rest, 1u);
    let up = below64(w, twice) || (all(w == twice) && (quotient.x & 1u) != 0u);
    quotient = add64(quotient, I64(u32(up), 0u));
    *fits = !below64(PIXEL_MAX, quotient);
    return select(quotient, neg64(quotient), is_negative64(c));
}

// The pixel of a point, without the viewport's offset.
fn project(x: I64, y: I64, w: I64) -> Pixel {
    if (!in_front(w)) {
        return Pixel(NONE64, NONE64, NEAR);
    }
    var at = array<I64, 2>(x, y);
    var fit_both = true;
    for (var axis = 0u; axis < 2u; axis += 1u) {
        var fits = false;
        let size = select(settings.viewport_x, settings.viewport_y, axis == 1u);
        at[axis] = pixels(at[axis], w, size, &fits);
        fit_both = fit_both && fits;
    }
    return Pixel(at[0], at[1], select(BEYOND, PROJECTED, fit_both));
}
