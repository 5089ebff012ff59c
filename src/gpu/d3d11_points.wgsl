// Points of the tessellator's patterns: an invocation a point, in U1.16.
//
// A point's parameter follows from its number by the definition of the Direct3D 11.3 functional
// specification, section 11.7.6; the first implementation makes the list of each factor by adding
// steps from the middle outwards, and copies runs of them.
//
// Own settings, besides the shared: e words of a point's place, f where in it the point stands.

// Two thirds and one third in U1.16, truncated as the hardware has them.
const TWO_THIRDS = 0xaaaau;
const THIRD = 0x5555u;

// 1 / n in U1.16, rounded to nearest.
fn reciprocal(n: u32) -> u32 {
    return (ONE + n / 2u) / max(n, 1u);
}

// Parameter number k of a factor: between the partitions into floor and ceil segments, of which the
// finer has one point more in each half. It splits off in the ruler's order.
fn parameter(at: u32, factor: u32, k: u32) -> u32 {
    let odd = (patterns[at + PARITY] >> factor) & 1u;
    let last = segments(at, factor);
    if (2u * k == last) {
        return HALF;
    }
    let mirrored = 2u * k > last;
    let p = select(k, last - k, mirrored);
    let points = (last + odd) / 2u; // of a half
    let t = half_of(patterns[at + VALUE + factor], odd) - ((points - 1u) << 16u);
    // Of a single point in a half only the first is asked for, to which nothing of this matters.
    let of_floor = reciprocal(2u * (points - 1u) - odd) * (ONE - t);
    let step = of_floor + reciprocal(last) * t; // U1.32, 2^32 for a single segment
    let before = points - 1u - odd;
    let row = 1u << firstLeadingBit(max(before, 1u));
    let split = select(2u * (before - row) + 1u, 0u, before == 0u);
    let near = (p * step - select(0u, of_floor, p > split) + HALF) >> 16u;
    return select(near, ONE - near, mirrored);
}

// Along a side from its beginning: v down, u up, v up, u down of a quad; v down, u up, w of a tri.
fn along(side: u32, t: u32, low_u: u32, low_v: u32) -> vec2<u32> {
    switch side {
        case 0u: { return vec2(low_u, ONE - t); }
        case 1u: { return vec2(t, low_v); }
        case 2u: { return vec2(ONE - low_u, t); }
        default: { return vec2(ONE - t, ONE - low_v); }
    }
}

fn along_tri(side: u32, t: u32, off: u32, back: u32) -> vec2<u32> {
    switch side {
        case 0u: { return vec2(off, ONE - back - t); }
        case 1u: { return vec2(t - back, off); }
        default: { return vec2(ONE - back - t, t + back - off); }
    }
}

fn edge_point(at: u32, number: u32) -> vec2<u32> {
    var side = 0u;
    var k = number;
    while (k >= segments(at, side)) {
        k -= segments(at, side);
        side += 1u;
    }
    let t = parameter(at, side, k);
    if (settings.a == TRI) {
        return along_tri(side, t, 0u, 0u);
    }
    return along(side, t, 0u, 0u);
}

// The ring that a point inside the edges is on: the last that begins at it or before.
fn ring_of_point(at: u32, number: u32) -> u32 {
    let left = points_from(at, 1u) - (number - on_edges(at));
    var low = 1u;
    var high = rings(at) + 1u;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (points_from(at, middle) >= left) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn quad_point(at: u32, number: u32) -> vec2<u32> {
    let ring = ring_of_point(at, number);
    var k = number - first_of(at, ring);
    // A ring that is a line is one of which two sides have no points; a point is its last corner.
    var side = 0u;
    while (side < 3u && k >= inner(at, side, ring)) {
        k -= inner(at, side, ring);
        side += 1u;
    }
    let t = parameter(at, 5u - (side & 1u), ring + k);
    return along(side, t, parameter(at, 4u, ring), parameter(at, 5u, ring));
}

fn tri_point(at: u32, number: u32) -> vec2<u32> {
    let ring = ring_of_point(at, number);
    let k = number - first_of(at, ring);
    let length = inner(at, 0u, ring);
    if (length == 0u) {
        return vec2(THIRD, THIRD);
    }
    // So far off the edges that the centre is at the centroid; corners are pulled in by half of it.
    let off = (parameter(at, 3u, ring) * TWO_THIRDS + HALF) >> 16u;
    return along_tri(k / length, parameter(at, 3u, ring + k % length), off, (off + 1u) / 2u);
}

fn point(at: u32, number: u32) -> vec2<u32> {
    if (settings.a == ISOLINE) {
        let on_line = segments(at, 1u) + 1u;
        return vec2(
            parameter(at, 1u, number % on_line),
            parameter(at, 0u, number / on_line),
        );
    }
    if (patterns[at] == LEAST_ONE && settings.a == QUAD) {
        // This one has an order of its own.
        return vec2(select(0u, ONE, number == 1u || number == 2u), select(0u, ONE, number > 1u));
    }
    if (number < on_edges(at)) {
        return edge_point(at, number);
    }
    if (settings.a == TRI) {
        return tri_point(at, number);
    }
    return quad_point(at, number);
}

@compute @workgroup_size(64)
fn points(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = settings.first + item;
    let patch_number = owner(number, 0u, settings.d);
    let made = point(patch_number * PATTERN, number - starts[patch_number]);
    out[item * settings.e + settings.f] = made.x;
    out[item * settings.e + settings.f + 1u] = made.y;
}
