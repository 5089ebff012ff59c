// The domain shader: control points and domain points in, vertices out; in singles, quantised when
// they are done, or in fixed point (Direct3D 11; Concheiro et al. 2014, Equations 5 to 8).
//
// An invocation a vertex. Both arithmetics are integers of two words, so that each form's order of
// operations stands here once; fixed-point products are formed in 128 bits whatever the format. The
// first implementation has the processor's singles four at a time, keeps rows from one point to the
// next, and takes 64 bits where they are enough.
//
// Own settings: d patches, g arithmetic (0 singles, 1 fixed), h form (0 paired, 1 sequential,
// 2 power), i fraction bits of what values are multiplied by, j orientations of a net, k fraction
// bits of a position, two's complement, l how singles are rounded to it.

const FIXED = 1u;
const SEQUENTIAL = 1u;
const POWER = 2u;

// U1.16.
const ONE = 0x10000u;

// Words of a net: 16 points or coefficients of four coordinates of two words.
const NET = 128u;

// Words of the counts of a patch, and those that are counted here.
const ROW = 30u;
const OVERFLOWS = 22u;
const CRACKS = 23u;

// Symmetries of the square: bit 0 reverses u, bit 1 v, after bit 2 has swapped them.
const ORIENTATIONS = 8u;

// ---- one arithmetic or the other

// A single where other numbers stand.
fn single_in(bits: u32) -> I64 {
    return I64(bits, 0u);
}

fn product(a: I64, b: I64) -> I64 {
    if (settings.g == FIXED) {
        return round64(mul64(a, b), settings.i, settings.rounding); // at most 2^60 before
    }
    return single_in(multiply(a.x, b.x));
}

fn scaled(a: I64, p: I64) -> I64 {
    if (settings.g == FIXED) {
        return narrow(round128(mul_signed(a, p), settings.i, settings.rounding));
    }
    return single_in(multiply(a.x, p.x));
}

fn thrice(a: I64) -> I64 {
    if (settings.g == FIXED) {
        return add64(a, shl64(a, 1u));
    }
    return single_in(multiply(a.x, THREE_SINGLE));
}

fn sum(p: I64, q: I64) -> I64 {
    if (settings.g == FIXED) {
        return add64(p, q);
    }
    return single_in(add(p.x, q.x));
}

fn negative(p: I64) -> I64 {
    if (settings.g == FIXED) {
        return neg64(p);
    }
    return single_in(p.x ^ SIGN);
}

// A parameter of U1.16, exactly.
fn parameter(t: u32) -> I64 {
    if (settings.g == FIXED) {
        return shl64(I64(t, 0u), settings.i - 16u);
    }
    return single_in(single_of(I64(t, 0u), -16));
}

// ---- forms

// The weights of the first two points; those of the last two are the same of the other end. For
// Horner, the parameter.
fn half_basis(u: I64, w: I64) -> array<I64, 2> {
    if (settings.h == POWER) {
        return array<I64, 2>(u, u);
    }
    let ww = product(w, w);
    return array<I64, 2>(product(ww, w), thrice(product(u, ww)));
}

fn basis(t: u32) -> array<I64, 4> {
    let u = parameter(t);
    let w = parameter(ONE - t);
    var b: array<I64, 4>;
    for (var end = 0u; end < 2u; end += 1u) {
        let half = half_basis(select(u, w, end == 1u), select(w, u, end == 1u));
        b[3u * end] = half[0];
        b[1u + end] = half[1];
    }
    return b;
}

// ((c3 u + c2) u + c1) u + c0
fn horner(u: I64, p: array<I64, 4>) -> I64 {
    var c = p;
    var value = c[3];
    for (var k = 3u; k > 0u; k -= 1u) {
        value = sum(scaled(u, value), c[k - 1u]);
    }
    return value;
}

// (B0 P0 + B3 P3) + (B1 P1 + B2 P2), or ((B0 P0 + B1 P1) + B2 P2) + B3 P3.
fn bernstein(b: array<I64, 4>, p: array<I64, 4>) -> I64 {
    var weights = b;
    var terms = p;
    for (var k = 0u; k < 4u; k += 1u) {
        terms[k] = scaled(weights[k], terms[k]);
    }
    // Paired, the second sum is one of its own, and the third is that of both.
    let paired = settings.h != SEQUENTIAL;
    var value = terms[0];
    var next = terms[select(1u, 3u, paired)];
    var held = NONE64;
    for (var k = 0u; k < 3u; k += 1u) {
        value = sum(value, next);
        if (k == 0u) {
            held = value;
            value = select(value, terms[1], paired);
            next = terms[2];
        } else {
            next = select(terms[3], held, paired);
        }
    }
    return value;
}

fn curve(b: array<I64, 4>, p: array<I64, 4>) -> I64 {
    if (settings.h == POWER) {
        return horner(b[0], p);
    }
    return bernstein(b, p);
}

// The coefficients of 1, u, u^2, u^3 of four points. Differences are sums of what is negated,
// which rounds nothing.
fn power(p: array<I64, 4>) -> array<I64, 4> {
    var points = p;
    var c = p;
    // 3 p1 - 3 p0, 3 p2 - 3 p1.
    for (var k = 0u; k < 2u; k += 1u) {
        c[k + 1u] = sum(thrice(points[k + 1u]), negative(thrice(points[k])));
    }
    let second = c[2];
    c[2] = sum(second, negative(c[1]));
    c[3] = sum(sum(points[3], negative(points[0])), negative(second));
    return c;
}

// ---- nets

@group(0) @binding(1) var<storage, read_write> fates: array<u32>;
// Per patch: 64 singles in clip space, or 16 points of a patch in the position format.
@group(0) @binding(2) var<storage, read_write> control: array<u32>;
@group(0) @binding(3) var<storage, read_write> nets: array<u32>;

// Where the turned patch has its point k.
fn turned(orientation: u32, k: u32) -> u32 {
    let column = select(k % 4u, 3u - k % 4u, (orientation & 1u) != 0u);
    let row = select(k / 4u, 3u - k / 4u, (orientation & 2u) != 0u);
    return select(4u * row + column, 4u * column + row, (orientation & 4u) != 0u);
}

fn control_point(item: u32, orientation: u32, k: u32, axis: u32) -> I64 {
    let place = 4u * turned(orientation, k) + axis;
    if (settings.g == FIXED) {
        let at = item * PATCH + 2u * place;
        return I64(control[at], control[at + 1u]);
    }
    return single_in(control[item * 64u + place]);
}

// An invocation a patch, orientation and coordinate.
@compute @workgroup_size(64)
fn turn(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    let axis = item % 4u;
    let orientation = item / 4u % settings.j;
    let patch_number = item / (4u * settings.j);
    if (item >= settings.items || fates[4u * patch_number] != 2u) {
        return;
    }
    var net: array<I64, 16>;
    for (var k = 0u; k < 16u; k += 1u) {
        net[k] = control_point(patch_number, orientation, k, axis);
    }
    if (settings.h == POWER) {
        // Rows first, then what comes of them by columns.
        for (var line = 0u; line < 8u; line += 1u) {
            let first = select(4u * line, line % 4u, line >= 4u);
            let step = select(1u, 4u, line >= 4u);
            var c = power(array<I64, 4>(
                net[first],
                net[first + step],
                net[first + 2u * step],
                net[first + 3u * step],
            ));
            for (var k = 0u; k < 4u; k += 1u) {
                net[first + k * step] = c[k];
            }
        }
    }
    let base = (patch_number * settings.j + orientation) * NET + 2u * axis;
    for (var k = 0u; k < 16u; k += 1u) {
        nets[base + 8u * k] = net[k].x;
        nets[base + 8u * k + 1u] = net[k].y;
    }
}

// ---- points

// For `domain` and `cracks`: nets as they stand above, where each patch's vertices begin, the
// vertices, and what is counted.
@group(0) @binding(1) var<storage, read_write> made: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> vertices: array<u32>;
@group(0) @binding(4) var<storage, read_write> rows: array<atomic<u32>>;

// A coordinate of the point of a net. Rows first, then the curve along v.
fn coordinate(net: u32, axis: u32, u: array<I64, 4>, v: array<I64, 4>) -> I64 {
    var rows_of: array<I64, 4>;
    var b = u;
    var value = NONE64;
    for (var row = 0u; row < 5u; row += 1u) {
        var p = rows_of;
        if (row < 4u) {
            for (var k = 0u; k < 4u; k += 1u) {
                let at = net + 32u * row + 8u * k + 2u * axis;
                p[k] = I64(made[at], made[at + 1u]);
            }
        } else {
            b = v;
        }
        value = curve(b, p);
        if (row < 4u) {
            rows_of[row] = value;
        }
    }
    if (settings.g == FIXED) {
        return value;
    }
    // Of both zeros one.
    return single_in(add(value.x, 0u));
}

struct Fitted {
    value: I64,
    overflowed: bool,
}

fn fitted(value: I64) -> Fitted {
    let kept = fit(value, settings.width, settings.wraps != 0u);
    return Fitted(kept, any(kept != value));
}

// A single in the position format. What is no number is 0.
fn quantised(bits: u32) -> Fitted {
    if (!is_number(bits)) {
        return Fitted(NONE64, true);
    }
    let stored = (bits >> 23u) & 0xffu;
    let m = I64((bits & FRACTION) | select(0u, HIDDEN, stored != 0u), 0u);
    let value = select(m, neg64(m), bits >= SIGN);
    let shift = i32(max(stored, 1u)) - 150 + bitcast<i32>(settings.k);
    let finite = magnitude(bits) < INFINITY;
    if (finite && shift < 0) {
        // 40 places leave nothing but the sign.
        return fitted(round64(value, u32(min(-shift, 40)), settings.l));
    }
    if (finite && shift < 38) {
        return fitted(shl64(value, u32(shift)));
    }
    // Beyond every format, and its low bits.
    let low = select(NONE64, shl64(value, u32(clamp(shift, 0, 63))), finite && shift < 64);
    let most = sub64(shl64(I64(1u, 0u), settings.width - 1u), I64(1u, 0u));
    let end = select(most, neg64(most), bits >= SIGN);
    let beyond = select(end, fit(low, settings.width, true), settings.wraps != 0u);
    return Fitted(select(beyond, NONE64, is_zero64(m)), !is_zero64(m));
}

@compute @workgroup_size(64)
fn domain(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let patch_number = owner(settings.first + item, 0u, settings.d);
    let at = item * VERTEX;
    let u = basis(vertices[at + 8u]);
    let v = basis(vertices[at + 9u]);
    let net = patch_number * settings.j * NET;
    var overflows = 0u;
    for (var axis = 0u; axis < 4u; axis += 1u) {
        let value = coordinate(net, axis, u, v);
        var result: Fitted;
        if (settings.g == FIXED) {
            result = fitted(value);
        } else {
            result = quantised(value.x);
        }
        overflows += u32(result.overflowed);
        vertices[at + 2u * axis] = result.value.x;
        vertices[at + 2u * axis + 1u] = result.value.y;
    }
    if (overflows > 0u) {
        atomicAdd(&rows[patch_number * ROW + OVERFLOWS], overflows);
    }
}

fn is_end(t: u32) -> bool {
    return t == 0u || t == ONE;
}

fn alike(a: I64, b: I64) -> bool {
    if (settings.g == FIXED) {
        return all(fitted(a).value == fitted(b).value);
    }
    return same(a.x, b.x);
}

// Whether a point comes out otherwise where the patch is turned.
fn is_crack(net: u32, u: u32, v: u32) -> bool {
    var own: array<I64, 4>;
    var differs = false;
    for (var orientation = 0u; orientation < ORIENTATIONS && !differs; orientation += 1u) {
        let swapped = (orientation & 4u) != 0u;
        let s = select(u, v, swapped);
        let t = select(v, u, swapped);
        let b = basis(select(s, ONE - s, (orientation & 1u) != 0u));
        let c = basis(select(t, ONE - t, (orientation & 2u) != 0u));
        for (var axis = 0u; axis < 4u; axis += 1u) {
            let value = coordinate(net + orientation * NET, axis, b, c);
            if (orientation == 0u) {
                own[axis] = value;
            } else {
                differs = differs || !alike(own[axis], value);
            }
        }
    }
    return differs;
}

// An invocation a vertex: boundary points, corners left out, that a neighbour may get otherwise.
@compute @workgroup_size(64)
fn cracks(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let u = vertices[item * VERTEX + 8u];
    let v = vertices[item * VERTEX + 9u];
    if (is_end(u) == is_end(v)) {
        return;
    }
    let patch_number = owner(settings.first + item, 0u, settings.d);
    if (is_crack(patch_number * ORIENTATIONS * NET, u, v)) {
        atomicAdd(&rows[patch_number * ROW + CRACKS], 1u);
    }
}
