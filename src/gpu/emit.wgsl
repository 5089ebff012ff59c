// Emit: vertices in, screen positions out: the perspective divide and the viewport in one exact
// quotient, rounded once. A vertex with w <= 0, or outside the band of the screen format, stays
// homogeneous. By long division of only the bits that the band has, with the remainder at hand; the
// first implementation multiplies by a reciprocal and corrects.

@group(0) @binding(1) var<storage, read_write> vertices: array<u32>;
// Three words a vertex: x, y, whether it was divided.
@group(0) @binding(2) var<storage, read_write> screen: array<u32>;
// Word 1: vertices that stay homogeneous.
@group(0) @binding(3) var<storage, read_write> events: array<atomic<u32>>;

// Integer bits of a screen coordinate without its sign: the band is +-32768 pixels.
const BAND = 15u;

fn coordinate(item: u32, axis: u32) -> I64 {
    let at = VERTEX * item + 2u * axis;
    return I64(vertices[at], vertices[at + 1u]);
}

// round(c size / (2 w)), c of up to 49 bits and its sign, size of 26, w positive; with 0 where it
// surely lies outside the band, else 1.
fn pixel(c: I64, size: u32, w: I64) -> vec2<u32> {
    let divisor = shl64(w, 1u);
    let negative = is_negative64(c);
    // A quotient of one bit more than the band has.
    let bits = BAND + 1u + settings.subpixel_bits;
    let numerator = mul_unsigned(abs64(c), I64(size, 0u));
    let head = shr128(numerator, bits);
    if (!below128(head, I128(divisor, 0u, 0u))) {
        return vec2<u32>(0u, 0u);
    }
    var rest = narrow(head);
    var quotient = 0u;
    for (var bit = bits; bit > 0u; bit -= 1u) {
        let next = extractBits(numerator.x, bit - 1u, 1u);
        rest = add64(shl64(rest, 1u), I64(next, 0u));
        let goes = !below64(rest, divisor);
        rest = sub64(rest, select(NONE64, divisor, goes));
        quotient = (quotient << 1u) | u32(goes);
    }
    if (negative) {
        quotient = 0u - quotient;
        if (!is_zero64(rest)) {
            quotient -= 1u;
            rest = sub64(divisor, rest);
        }
    }
    let twice = shl64(rest, 1u);
    let past = !below64(twice, divisor);
    let mode = settings.emit_rounding;
    let down = all(twice == divisor) && tie(mode, (quotient & 1u) != 0u, negative);
    let up = mode != FLOOR && past && !down;
    return vec2<u32>(quotient + u32(up), 1u);
}

fn project(item: u32) -> vec3<u32> {
    let w = coordinate(item, 3u);
    if (is_negative64(w) || is_zero64(w)) {
        return vec3<u32>(0u, 0u, 0u);
    }
    let bits = settings.subpixel_bits;
    let band = 1u << (BAND + bits);
    var result = vec3<u32>(0u, 0u, 1u);
    for (var axis = 0u; axis < 2u; axis += 1u) {
        // y from the upper edge down.
        let along = coordinate(item, axis);
        let c = add64(w, select(along, neg64(along), axis != 0u));
        let size = select(settings.viewport_x, settings.viewport_y, axis != 0u);
        let p = pixel(c, size << bits, w);
        if (p.y == 0u || p.x + band >= 2u * band) {
            return vec3<u32>(0u, 0u, 0u);
        }
        result[axis] = p.x;
    }
    return result;
}

@compute @workgroup_size(64)
fn emit(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let result = project(item);
    for (var k = 0u; k < 3u; k += 1u) {
        screen[3u * item + k] = result[k];
    }
    if (result.z == 0u) {
        atomicAdd(&events[1], 1u);
    }
}
