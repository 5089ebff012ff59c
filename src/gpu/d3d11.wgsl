// D3d11: the fixed-function tessellator's factors. In come FACTORS words a patch, the bits of f32;
// out comes its pattern: factors in 16.16, and how many points and primitives they make, as the
// Direct3D 11.3 functional specification, section 11.7.4, has them.
//
// Conversion is a shift of the significand with the integers' rounding, up by two's complement, and
// sizes are sums over areas; the first implementation rounds by adding what makes a carry.

@group(0) @binding(1) var<storage, read_write> factors: array<u32>;
@group(0) @binding(2) var<storage, read_write> processed: array<u32>;

const FACTORS = 6u;

// f32: 1; 1 + 2^-17, above which a factor is not 1 in 16.16; 1 + 2^-16, the least odd inside
// factor beside any above 1; 2, 63, 64, infinity.
const ONE_BITS = 0x3f800000u;
const ABOVE_ONE_BITS = 0x3f800040u;
const FRAME_BITS = 0x3f800080u;
const TWO_BITS = 0x40000000u;
const BITS_63 = 0x427c0000u;
const BITS_64 = 0x42800000u;
const INFINITY_BITS = 0x7f800000u;

// A factor clamped, rounded up where the partitioning says so, and in 16.16.
fn convert(partitioning: u32, least: u32, given: u32) -> u32 {
    let most = select(BITS_64, BITS_63, partitioning == ODD);
    // Above infinity are the NaNs, and everything with a sign.
    let bits = select(clamp(given, least, most), least, given > INFINITY_BITS);
    let significand = I64((bits & 0x7fffffu) | 0x800000u, 0u);
    let exponent = (bits >> 23u) - 127u; // 0 to 6
    if (partitioning == ODD || partitioning == EVEN) {
        return round64(significand, 7u - exponent, NEAREST_EVEN).x;
    }
    // Up: minus the floor of minus it.
    return neg64(sar64(neg64(significand), 23u - exponent)).x << 16u;
}

// 1 to 64.
fn segments_of(value: u32, odd: u32) -> u32 {
    return 2u * ((half_of(value, odd) + 0xffffu) >> 16u) - odd;
}

// How many isolines there are is a whole number in every partitioning.
fn partitioning_of(k: u32) -> u32 {
    return select(settings.b, 0u, settings.a == ISOLINE && k == 0u);
}

fn is_odd(at: u32, k: u32) -> u32 {
    let partitioning = partitioning_of(k);
    let whole = (processed[at + VALUE + k] >> 16u) & 1u;
    return select(u32(partitioning == ODD), whole, partitioning < ODD);
}

// The least inside factor. An odd edge of three segments or more needs a ring inside.
fn inside_least(at: u32, count: u32) -> u32 {
    var above = false;
    for (var k = 0u; k < count; k += 1u) {
        let bits = factors[at + k];
        above = above || (bits > ABOVE_ONE_BITS && bits <= INFINITY_BITS);
    }
    if (settings.b == ODD) {
        return select(ONE_BITS, FRAME_BITS, above);
    }
    return select(ONE_BITS, TWO_BITS, settings.b == EVEN);
}

fn any_culls(at: u32, edges: u32) -> bool {
    var culled = false;
    for (var k = 0u; k < edges; k += 1u) {
        let bits = factors[at + k];
        culled = culled || bits == 0u || bits > INFINITY_BITS;
    }
    return culled;
}

fn count_points(at: u32) -> u32 {
    let s = at + SEGMENTS;
    if (settings.a == ISOLINE) {
        return processed[s] * (processed[s + 1u] + 1u);
    }
    let along = processed[s] + processed[s + 1u] + processed[s + 2u];
    if (settings.a == TRI) {
        let inner = processed[s + 3u];
        return along + select(points_in_tri(inner - 2u), 0u, processed[at] == LEAST_ONE);
    }
    let inside = (processed[s + 4u] - 1u) * (processed[s + 5u] - 1u);
    return along + processed[s + 3u] + inside;
}

fn count_triangles(at: u32) -> u32 {
    let s = at + SEGMENTS;
    if (processed[at] == LEAST_ONE) {
        return 2u - settings.a;
    }
    let along = processed[s] + processed[s + 1u] + processed[s + 2u];
    if (settings.a == TRI) {
        let inner = processed[s + 3u] - 2u;
        return along + 3u * inner + 3u * inner * inner / 2u;
    }
    let u = processed[s + 4u] - 2u;
    let v = processed[s + 5u] - 2u;
    return along + processed[s + 3u] + 2u * (u + v + u * v);
}

fn count_primitives(at: u32) -> u32 {
    if (settings.c == POINT) {
        return processed[at + POINTS];
    }
    if (settings.a == ISOLINE) {
        return processed[at + SEGMENTS] * processed[at + SEGMENTS + 1u];
    }
    if (settings.c == LINE) {
        return processed[at + POINTS] - 1u;
    }
    return count_triangles(at);
}

@compute @workgroup_size(64)
fn process(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let begin = item * FACTORS;
    let at = item * PATTERN;
    let edges = edges_of(settings.a);
    let count = factors_of(settings.a);
    if (any_culls(begin, edges)) {
        return; // the words come as 0
    }
    let inside = inside_least(begin, count);
    let outside = select(ONE_BITS, TWO_BITS, settings.b == EVEN);
    for (var k = 0u; k < count; k += 1u) {
        let partitioning = partitioning_of(k);
        let least = select(inside, outside, k < edges);
        processed[at + VALUE + k] =
            convert(partitioning, select(least, ONE_BITS, partitioning == 0u), factors[begin + k]);
    }
    write_pattern(at, count, edges);
}

fn write_pattern(at: u32, count: u32, edges: u32) {
    var odd = 0u;
    var ones = 0u;
    for (var k = 0u; k < count; k += 1u) {
        let parity = is_odd(at, k);
        odd |= parity << k;
        ones |= select(0u, parity, processed[at + VALUE + k] == ONE) << k;
    }
    let all_ones = settings.a != ISOLINE && ones == (1u << count) - 1u;
    if (!all_ones) {
        // An inside of 1 is two segments: a single one could not be joined to the edges.
        odd &= ~((ones >> edges) << edges);
    }
    processed[at] = select(RINGS, LEAST_ONE, all_ones);
    processed[at + PARITY] = odd;
    for (var k = 0u; k < count; k += 1u) {
        processed[at + SEGMENTS + k] = segments_of(processed[at + VALUE + k], (odd >> k) & 1u);
    }
    processed[at + POINTS] = count_points(at);
    processed[at + PRIMITIVES] = count_primitives(at);
}
