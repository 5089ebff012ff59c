// The tangent plane at a vertex: four coefficients of 32 bits, the minors of (S, Su, Sv) with the
// signs that make plane . p = det[p, S, Su, Sv], shifted down together and rounded to nearest even.
// Points are de Casteljau's, in place and coordinate by coordinate; a minor is expanded along Sv,
// where the first implementation expands along S, and always in 256 bits.

// b and c: the first patch, and the one behind the last. e: number of their first vertex.
@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> vertices: array<u32>;
// Eight words a vertex.
@group(0) @binding(4) var<storage, read_write> planes_out: array<u32>;
// Word 3: vertices where the plane vanishes.
@group(0) @binding(5) var<storage, read_write> events: array<atomic<u32>>;

// Bits of the largest coefficient, without its sign.
const COEFFICIENT = 31u;
// Where a coordinate has more bits than this, what is more than COARSE bits below a coefficient is
// cut off before it is rounded: by definition, and it can move a tie.
const FINE = 40u;
const COARSE = 64u;

// The point of a curve, and three times less than its derivative.
struct Tangent {
    point: I64,
    along: I64,
}

// Of a cubic at t: the last two points of the triangle, whose difference it is, and the one
// between.
fn tangent(control: array<I64, 4>, t: u32) -> Tangent {
    var points = control;
    var along = NONE64;
    for (var left = 3u; left > 0u; left -= 1u) {
        along = sub64(points[1], points[0]);
        for (var k = 0u; k < left; k += 1u) {
            let step = mul64(sub64(points[k + 1u], points[k]), I64(t, 0u));
            points[k] = round64(add64(shl64(points[k], 16u), step), 16u, NEAREST_EVEN);
        }
    }
    return Tangent(points[0], along);
}

// A coordinate of the surface, and of its derivative across: first the four curves whose points
// stand `inner` apart at s, then at t the curve of what they give, which stand `outer` apart.
fn across(at: u32, inner: u32, outer: u32, s: u32, t: u32) -> Tangent {
    var ends = array<I64, 4>(NONE64, NONE64, NONE64, NONE64);
    for (var k = 0u; k < 4u; k += 1u) {
        var points = array<I64, 4>(NONE64, NONE64, NONE64, NONE64);
        for (var j = 0u; j < 4u; j += 1u) {
            let origin = at + 8u * (inner * j + outer * k);
            points[j] = I64(patches[origin], patches[origin + 1u]);
        }
        ends[k] = tangent(points, s).point;
    }
    return tangent(ends, t);
}

fn bits256(value: I256) -> u32 {
    var size = value;
    if (is_negative256(value)) {
        size = neg256(value);
    }
    return select(bits128(size.lo), 128u + bits128(size.hi), !is_zero128(size.hi));
}

// round(value / 2^down); a value of more than 126 bits has a `down` that leaves fewer of it.
fn shifted(value: I256, down: u32, fine: bool) -> I64 {
    var coarse = 0u;
    var cut = value.lo;
    if (!fine && down > COARSE) {
        coarse = down - COARSE;
        cut = shr128(value.lo, coarse) | shl128(value.hi, 128u - coarse);
    }
    return narrow(round128(cut, down - coarse, NEAREST_EVEN));
}

@compute @workgroup_size(64)
fn planes(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let at = owner(settings.e + item, settings.b, settings.c) * PATCH;
    let u = vertices[VERTEX * item + 8u];
    let v = vertices[VERTEX * item + 9u];
    var s = array<I64, 4>(NONE64, NONE64, NONE64, NONE64);
    var su = s;
    var sv = s;
    var longest = 0u;
    for (var axis = 0u; axis < 4u; axis += 1u) {
        let upward = across(at + 2u * axis, 1u, 4u, u, v);
        s[axis] = upward.point;
        sv[axis] = upward.along;
        su[axis] = across(at + 2u * axis, 4u, 1u, v, u).along;
        let sizes = max(bits64(abs64(su[axis])), bits64(abs64(sv[axis])));
        longest = max(longest, max(bits64(abs64(s[axis])), sizes));
    }
    let none = I256(NONE128, NONE128);
    var minors = array<I256, 4>(none, none, none, none);
    var bits = 0u;
    for (var m = 0u; m < 4u; m += 1u) {
        // The three axes that are not m.
        let axes = vec3<u32>(u32(m < 1u), 1u + u32(m < 2u), 2u + u32(m < 3u));
        var sum = none;
        for (var k = 0u; k < 3u; k += 1u) {
            let i = axes[(k + 1u) % 3u];
            let j = axes[(k + 2u) % 3u];
            let minor = sub128(mul_signed(s[i], su[j]), mul_signed(s[j], su[i]));
            sum = add256(sum, mul_mixed(sv[axes[k]], minor));
        }
        if ((m & 1u) != 0u) {
            sum = neg256(sum);
        }
        minors[m] = sum;
        bits = max(bits, bits256(sum));
    }
    let down = max(bits, COEFFICIENT) - COEFFICIENT;
    for (var m = 0u; m < 4u; m += 1u) {
        let coefficient = shifted(minors[m], down, longest <= FINE);
        planes_out[8u * item + 2u * m] = coefficient.x;
        planes_out[8u * item + 2u * m + 1u] = coefficient.y;
    }
    if (bits == 0u) {
        atomicAdd(&events[3], 1u);
    }
}
