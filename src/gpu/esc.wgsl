// The surface-level shader (Concheiro, Amor, Boo, Padron 2014): coefficients [N][B][M]^T of a
// surface (equation 8), samples of it, the tests of candidates (equation 9), and cracks. The order
// of roundings is part of the definition and so the first implementation's; coefficients come
// from the definition's double sum, one invocation each, every point is evaluated by itself, and
// lines between two points are divided digit by digit.

// Control points of the space at hand: `settings.a` words a patch.
@group(0) @binding(1) var<storage, read_write> points: array<u32>;
// Coefficients: 128 words a net, `settings.b` nets a patch. Of a net, that of u^a v^b in component
// c has the two words 2 (16 a + 4 b + c).
@group(0) @binding(2) var<storage, read_write> nets: array<u32>;
@group(0) @binding(3) var<storage, read_write> resolutions: array<u32>;
@group(0) @binding(4) var<storage, read_write> decisions: array<u32>;
// Two words a vertex: the patch; the crossing, u and v in 16 bits each.
@group(0) @binding(4) var<storage, read_write> sites: array<u32>;
@group(0) @binding(5) var<storage, read_write> vertices: array<u32>;
// Two words a vertex: overflows; whether a neighbour could compute other bits.
@group(0) @binding(6) var<storage, read_write> events: array<u32>;

const NET = 128u;
const PLAIN = 1u;
const ON_SCREEN = 1u;
const IN_OBJECT_SPACE = 2u;

// Rows of N: coefficients of 1, t, t^2, t^3 from control points.
const BASIS = array<i32, 16>(1, 0, 0, 0, -3, 3, 0, 0, 3, -6, 3, 0, -1, 3, -3, 1);

// Coordinates that did not fit, since it was last cleared.
var<private> overflows: u32;

fn levels_at(item: u32) -> Levels {
    let at = RESOLUTION * item;
    let edges = vec4(
        resolutions[at], resolutions[at + 1u], resolutions[at + 2u], resolutions[at + 3u]
    );
    return Levels(edges, resolutions[at + INTERIOR]);
}

fn control(item: u32, number: u32, axis: u32) -> I64 {
    let at = item * settings.a + 8u * number + 2u * axis;
    return I64(points[at], points[at + 1u]);
}

// The control point that a patch has at k when it is turned: bit 2 swaps u and v, bits 0 and 1
// then reverse them.
fn turned(turn: u32, k: u32) -> u32 {
    var column = k % 4u;
    var row = k / 4u;
    if ((turn & 1u) != 0u) {
        column = 3u - column;
    }
    if ((turn & 2u) != 0u) {
        row = 3u - row;
    }
    return select(4u * row + column, 4u * column + row, (turn & 4u) != 0u);
}

// One coefficient: W + 8 bits, then guard bits.
@compute @workgroup_size(64)
fn coefficients(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    var basis = BASIS;
    let turn = item / 64u % settings.b;
    let a = item / 16u % 4u;
    let b = item / 4u % 4u;
    var sum = NONE64;
    for (var k = 0u; k < 16u; k += 1u) {
        let weight = basis[4u * a + k % 4u] * basis[4u * b + k / 4u];
        let c = control(item / (64u * settings.b), turned(turn, k), item % 4u);
        sum = add64(sum, mul64(word(weight), c));
    }
    sum = shl64(sum, settings.c);
    nets[2u * item] = sum.x;
    nets[2u * item + 1u] = sum.y;
}

// round(c t), t in U1.F.
fn product(c: I64, t: I64) -> I64 {
    return round128(mul_signed(c, t), settings.d, settings.rounding).xy;
}

fn horner(curve: array<I64, 4>, t: I64) -> I64 {
    var c = curve;
    var value = c[3];
    for (var k = 3u; k > 0u; k -= 1u) {
        value = add64(c[k - 1u], product(value, t));
    }
    return value;
}

// A coordinate of the surface at (u, v), before it is fitted: along v for each power of u, then
// along u.
fn surface(net: u32, u: I64, v: I64, axis: u32) -> I64 {
    var along_u: array<I64, 4>;
    for (var a = 0u; a < 4u; a += 1u) {
        var curve: array<I64, 4>;
        for (var b = 0u; b < 4u; b += 1u) {
            let at = NET * net + 2u * (16u * a + 4u * b + axis);
            curve[b] = I64(nets[at], nets[at + 1u]);
        }
        along_u[a] = horner(curve, v);
    }
    return horner(along_u, u);
}

// A register without its lowest bits, rounded and fitted.
fn fitted(value: I64, bits: u32) -> I64 {
    let rounded = round64(value, bits, settings.rounding);
    let result = fit(rounded, settings.width, settings.wraps != 0u);
    overflows += u32(any(result != rounded));
    return result;
}

// How a crossing is sampled.
struct Spot {
    // An edge of the patch, or none; the level and line of its own.
    side: u32,
    level: u32,
    line: u32,
    corner: bool,
    // Levels and lines along u and v, as parameters.
    u: I64,
    v: I64,
}

fn spot_of(levels: Levels, place: vec2<u32>) -> Spot {
    let last = 3u * (levels.interior + 1u);
    var spot: Spot;
    spot.side = NO_SIDE;
    spot.corner = kind_of(place, levels.interior + 1u) == CORNER;
    if (place.y == 0u) {
        spot.side = 0u;
    } else if (place.y == last) {
        spot.side = 2u;
    } else if (place.x == 0u) {
        spot.side = 3u;
    } else if (place.x == last) {
        spot.side = 1u;
    }
    var level = vec2(levels.interior);
    var line = place;
    if (spot.side != NO_SIDE) {
        let axis = spot.side & 1u;
        level[axis] = levels.edges[spot.side];
        line[axis] = carried(place[axis], level[axis], levels.interior);
        spot.level = level[axis];
        spot.line = line[axis];
    }
    spot.u = parameter(level.x, line.x, settings.d);
    spot.v = parameter(level.y, line.y, settings.d);
    return spot;
}

// The k-th control point of an edge of the patch.
fn on_edge(side: u32, k: u32) -> u32 {
    switch side {
        case 0u: { return k; }
        case 1u: { return 4u * k + 3u; }
        case 2u: { return 12u + k; }
        default: { return 4u * k; }
    }
}

// A coordinate of a point of an edge, from its own control points and the nearer corner; fitted.
fn halved(item: u32, spot: Spot, axis: u32) -> I64 {
    let last = 3u * (spot.level + 1u);
    let far = 2u * spot.line > last;
    var p: array<I64, 4>;
    for (var k = 0u; k < 4u; k += 1u) {
        p[k] = control(item, on_edge(spot.side, select(k, 3u - k, far)), axis);
    }
    if (2u * spot.line == last) {
        let inner = mul64(I64(3u, 0u), add64(p[1], p[2]));
        return fitted(add64(add64(p[0], p[3]), inner), 3u);
    }
    var basis = BASIS;
    var curve: array<I64, 4>;
    for (var a = 0u; a < 4u; a += 1u) {
        for (var k = 0u; k < 4u; k += 1u) {
            curve[a] = add64(curve[a], mul64(word(basis[4u * a + k]), p[k]));
        }
        curve[a] = shl64(curve[a], settings.c);
    }
    let line = select(spot.line, last - spot.line, far);
    return fitted(horner(curve, parameter(spot.level, line, settings.d)), settings.c);
}

// The point at a spot: fitted coordinates.
fn point_at(item: u32, spot: Spot, place: vec2<u32>) -> array<I64, 4> {
    var result: array<I64, 4>;
    for (var axis = 0u; axis < 4u; axis += 1u) {
        if (spot.corner) {
            let number = select(0u, 3u, place.x != 0u) + select(0u, 12u, place.y != 0u);
            result[axis] = control(item, number, axis);
        } else if (spot.side != NO_SIDE && settings.e != PLAIN) {
            result[axis] = halved(item, spot, axis);
        } else {
            let value = surface(item * settings.b, spot.u, spot.v, axis);
            result[axis] = fitted(value, settings.c);
        }
    }
    return result;
}

// |a - b|, unsigned: both below 2^62.
fn apart(a: I64, b: I64) -> I64 {
    return abs64(sub64(a, b));
}

// Whether three differences, below 2^63, are a longer way than `most`.
fn distant(d: array<I64, 3>) -> bool {
    let most = I64(settings.g, settings.h);
    var way = d;
    var sum = NONE128;
    for (var k = 0u; k < 3u; k += 1u) {
        if (below64(most, way[k])) {
            return true;
        }
        sum = add128(sum, mul_unsigned(way[k], way[k]));
    }
    return below128(mul_unsigned(most, most), sum);
}

fn distant_on_screen(a: array<I64, 4>, b: array<I64, 4>) -> bool {
    let p = project(a[0], a[1], a[3]);
    let q = project(b[0], b[1], b[3]);
    if ((p.status | q.status) != PROJECTED) {
        return true;
    }
    return distant(array<I64, 3>(apart(p.x, q.x), apart(p.y, q.y), NONE64));
}

// c / w in 1/256 ulp; clears `fits` where that is 2^61 or more.
fn quotient(c: I64, w: I64, fits: ptr<function, bool>) -> I64 {
    let numerator = shl128(wide(c), settings.j + 8u);
    let result = divide_rounded(numerator, wide(w), NEAREST_EVEN);
    *fits = *fits && bits128(abs128(result)) <= 61u;
    return result.xy;
}

fn distant_in_space(a: array<I64, 4>, b: array<I64, 4>) -> bool {
    var p = a;
    var q = b;
    let none = I64(1u, 0u);
    if (less64(p[3], none) || less64(q[3], none)) {
        return true;
    }
    var fits = true;
    var d: array<I64, 3>;
    for (var k = 0u; k < 3u; k += 1u) {
        d[k] = apart(quotient(p[k], p[3], &fits), quotient(q[k], q[3], &fits));
    }
    return !fits || distant(d);
}

// Whether no earlier coarse edge with candidates ends at a corner of cells: then this one counts
// what happened there.
fn is_first_at(corner: vec2<u32>, number: u32, levels: Levels) -> bool {
    for (var before = 0u; before < number; before += 1u) {
        let edge = coarse_edge(before);
        let other = vec2<u32>(vec2<i32>(edge.corner) + edge.step);
        let meets = all(edge.corner == corner) || all(other == corner);
        if (meets && level_of(edge, levels) > 0u) {
            return false;
        }
    }
    return true;
}

// Point k of the line between two, of so many segments.
fn on_line(a: array<I64, 4>, b: array<I64, 4>, k: u32, segments: u32) -> array<I64, 4> {
    var p = a;
    var q = b;
    for (var axis = 0u; axis < 4u; axis += 1u) {
        let sum = add64(
            mul64(p[axis], I64(segments - k, 0u)),
            mul64(q[axis], I64(k, 0u)),
        );
        p[axis] = divide_few(sum, segments, settings.rounding);
    }
    return p;
}

// A coarse edge: its two ends first, then its candidates.
fn decide_edge(item: u32, number: u32, levels: Levels) -> vec2<u32> {
    let edge = coarse_edge(number);
    let level = level_of(edge, levels);
    let segments = levels.interior + 1u;
    var ends: array<array<I64, 4>, 2>;
    var mask = 0u;
    var lost = 0u;
    for (var n = 0u; n < level + 2u && level > 0u; n += 1u) {
        let k = n - 1u;
        var position = n * segments;
        if (n >= 2u) {
            position = slot(k, level, levels.interior);
        }
        if (settings.f == 0u) {
            mask |= select(0u, 1u << position, n >= 2u);
            continue;
        }
        let place = crossing(edge, position, segments);
        overflows = 0u;
        var here: array<I64, 4>;
        if (n < 2u && settings.i == 0u) {
            let corner = vec2<u32>(vec2<i32>(edge.corner) + edge.step * i32(n));
            for (var axis = 0u; axis < 4u; axis += 1u) {
                here[axis] = control(item, 4u * corner.y + corner.x, axis);
            }
        } else {
            here = point_at(item, spot_of(levels, place), place);
        }
        if (n < 2u) {
            ends[n] = here;
            let corner = place / segments;
            if (settings.f == IN_OBJECT_SPACE && is_first_at(corner, number, levels)) {
                lost += overflows;
            }
            continue;
        }
        let mesh = on_line(ends[0], ends[1], k, level + 1u);
        var inserted = false;
        if (settings.f == ON_SCREEN) {
            inserted = distant_on_screen(mesh, here);
        } else {
            inserted = distant_in_space(mesh, here);
        }
        mask |= u32(inserted) << position;
        // What the mesh uses is counted there.
        if (settings.f == IN_OBJECT_SPACE || !inserted) {
            lost += overflows;
        }
    }
    return vec2(mask, lost);
}

@compute @workgroup_size(64)
fn decide(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let levels = levels_at(item / COARSE_EDGES);
    var decided = vec2(0u);
    if (levels.interior != SKIPPED) {
        decided = decide_edge(item / COARSE_EDGES, item % COARSE_EDGES, levels);
    }
    decisions[DECISION * item] = decided.x;
    decisions[DECISION * item + 1u] = decided.y;
}

@compute @workgroup_size(64)
fn evaluate(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let owner_patch = sites[2u * item];
    let place = vec2(sites[2u * item + 1u] & 0xffffu, sites[2u * item + 1u] >> 16u);
    let levels = levels_at(owner_patch);
    let spot = spot_of(levels, place);
    overflows = 0u;
    var position = point_at(owner_patch, spot, place);
    for (var axis = 0u; axis < 4u; axis += 1u) {
        vertices[VERTEX * item + 2u * axis] = position[axis].x;
        vertices[VERTEX * item + 2u * axis + 1u] = position[axis].y;
    }
    // In U1.16, from the same lines.
    var level = vec2(levels.interior);
    var line = place;
    if (spot.side != NO_SIDE) {
        level[spot.side & 1u] = spot.level;
        line[spot.side & 1u] = spot.line;
    }
    vertices[VERTEX * item + 8u] = parameter(level.x, line.x, 16u).x;
    vertices[VERTEX * item + 9u] = parameter(level.y, line.y, 16u).x;
    events[2u * item] = overflows;
}

// Whether the patch, turned in any way, has other bits at a vertex of its boundary.
@compute @workgroup_size(64)
fn cracks(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let owner_patch = sites[2u * item];
    let place = vec2(sites[2u * item + 1u] & 0xffffu, sites[2u * item + 1u] >> 16u);
    let levels = levels_at(owner_patch);
    if (kind_of(place, levels.interior + 1u) != BOUNDARY) {
        return;
    }
    let spot = spot_of(levels, place);
    let one = shl64(I64(1u, 0u), settings.d);
    var differs = 0u;
    for (var n = 4u; n < 32u; n += 1u) {
        let turn = n / 4u;
        let axis = n % 4u;
        var u = select(spot.u, spot.v, (turn & 4u) != 0u);
        var v = select(spot.v, spot.u, (turn & 4u) != 0u);
        if ((turn & 1u) != 0u) {
            u = sub64(one, u);
        }
        if ((turn & 2u) != 0u) {
            v = sub64(one, v);
        }
        let other = fitted(surface(owner_patch * settings.b + turn, u, v, axis), settings.c);
        let at = VERTEX * item + 2u * axis;
        differs |= u32(any(other != I64(vertices[at], vertices[at + 1u])));
    }
    events[2u * item + 1u] = differs;
}
