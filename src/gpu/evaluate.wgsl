// Evaluate: plans and control points in, vertices out (Moreton 2001: guard curves, and half-runs
// from both ends). An invocation a vertex: a point of a run in differences is their sum
//   D0 + k D1 + C(k, 2) D2 + C(k, 3) D3   modulo 2^64
// and no step before it is made, as the first implementation does. De Casteljau goes coordinate by
// coordinate, in place, with one product an interpolation: a 2^16 + (b - a) t, whose terms may pass
// 64 bits and whose sum does not.
//
// What belongs to a curve and not to a vertex is done before, once: `fixed_lines` keeps the control
// points and differences of the edges and of the net's columns, `rows` those of interior rows.

// a: 1 where lists are masks. b and c: the first patch, and the one behind the last. d, e: numbers
// of their first line and vertex.
@group(0) @binding(1) var<storage, read_write> plans: array<u32>;
// Where each patch's lines begin.
@group(0) @binding(2) var<storage, read_write> line_starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> lines: array<u32>;
// Word 0: coordinates that did not fit.
@group(0) @binding(4) var<storage, read_write> events: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> patches: array<u32>;
@group(0) @binding(6) var<storage, read_write> starts: array<u32>;
@group(0) @binding(7) var<storage, read_write> vertices: array<u32>;

// Words of a line: for each coordinate its four control points, then D1 D2 D3 from the near end
// and from the far one.
const LINE = 80u;
const AXIS = 20u;
const NEAR_END = 8u;
const FAR_END = 14u;
// Lines before those of the interior's rows: four edges, four columns.
const FIXED = 8u;
const COLUMN = 4u;
// The interior's lists.
const ALONG_U = 4u;
const ALONG_V = 5u;

fn line_at(patch_number: u32, line: u32) -> u32 {
    return LINE * (line_starts[patch_number] - settings.d + line);
}

fn load(at: u32) -> I64 {
    return I64(lines[at], lines[at + 1u]);
}

fn store(at: u32, value: I64) {
    lines[at] = value.x;
    lines[at + 1u] = value.y;
}

// Whether a line is run in differences: an edge, or something of the interior.
fn in_differences(edge: bool) -> bool {
    return settings.a == 0u && settings.scheme < select(1u, 2u, edge);
}

// ---- Set-up

// A coefficient times a power of the step, which has 64 fraction bits and no sign: exactly.
fn times(coefficient: I64, power: I64) -> I128 {
    let size = mul_unsigned(abs64(coefficient), power);
    return select(size, neg128(size), is_negative64(coefficient));
}

// From 64 fraction bits to guard bits, half up; the low 64 bits.
fn register_of(sum: I128) -> I64 {
    let half = shl128(I128(1u, 0u, 0u, 0u), 63u - settings.guard);
    return narrow(sar128(add128(sum, half), 64u - settings.guard));
}

// D1 D2 D3 of the cubic p q r s from p on, for steps of `step` / 2^32, stored from `at` on.
fn set_up(at: u32, p: I64, q: I64, r: I64, s: I64, step: u32) {
    let three = I64(3u, 0u);
    var coefficients = array<I64, 3>(
        add64(sub64(s, p), mul64(three, sub64(q, r))),
        mul64(three, sub64(add64(p, r), shl64(q, 1u))),
        mul64(three, sub64(q, p)),
    );
    let square = mul_words(step, step);
    let cube = mul_unsigned(square, I64(step, 0u));
    var powers = array<I64, 3>(cube.yz, square, I64(0u, step));
    // How often each term is in D1, D2, D3.
    var shares = array<vec3<u32>, 3>(vec3(1u, 1u, 1u), vec3(6u, 2u, 0u), vec3(6u, 0u, 0u));
    for (var order = 0u; order < 3u; order += 1u) {
        var sum = NONE128;
        for (var term = 0u; term < 3u; term += 1u) {
            let share = mul64(coefficients[term], I64(shares[order][term], 0u));
            sum = add128(sum, times(share, powers[term]));
        }
        store(at + 2u * order, register_of(sum));
    }
}

// Both ends of the line at `at`, whose control points are there, for a list of the plan.
fn set_up_ends(at: u32, plan: u32, list: u32) {
    if (plans[plan + SEGMENTS + list] < 3u) {
        return;
    }
    let step = plans[plan + LISTS + 4u * list + 1u];
    for (var end = 0u; end < 2u; end += 1u) {
        let first = at + 6u * end;
        let second = at + 2u + 2u * end;
        let third = at + 4u - 2u * end;
        let to = at + select(NEAR_END, FAR_END, end != 0u);
        set_up(to, load(first), load(second), load(third), load(at + 6u - 6u * end), step);
    }
}

// A coordinate of an edge or a column: 32 invocations a patch.
@compute @workgroup_size(64)
fn fixed_lines(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = settings.b + item / 32u;
    let line = (item / 4u) % FIXED;
    let axis = item % 4u;
    let plan = number * PLAN;
    if (line >= plans[plan + LINES]) {
        return;
    }
    // Edges v0, u1, v1, u0, then columns: their first points, and from one point to the next.
    var firsts = array<u32, 8>(0u, 3u, 12u, 0u, 0u, 1u, 2u, 3u);
    let apart = select(4u, 1u, line == 0u || line == 2u);
    let at = line_at(number, line) + AXIS * axis;
    for (var k = 0u; k < 4u; k += 1u) {
        let origin = number * PATCH + 8u * (firsts[line] + apart * k) + 2u * axis;
        store(at + 2u * k, I64(patches[origin], patches[origin + 1u]));
    }
    if (in_differences(line < COLUMN)) {
        set_up_ends(at, plan, select(ALONG_V, line, line < COLUMN));
    }
}

// ---- Points

// The parameter of an entry of a list, U1.16.
fn parameter(plan: u32, list: u32, entry: u32) -> u32 {
    let segments = plans[plan + SEGMENTS + list];
    let at = plan + LISTS + 4u * list;
    if (entry == 0u || entry == segments) {
        return select(0u, ONE, entry != 0u);
    }
    if (settings.a != 0u) {
        let mask = I128(plans[at], plans[at + 1u], plans[at + 2u], plans[at + 3u]);
        return select128(mask, entry - 1u) << 9u;
    }
    if (2u * entry == segments) {
        return ONE / 2u;
    }
    let run = run_of(segments, entry);
    let product = add64(mul_words(run.y, plans[at + 1u]), I64(1u << 15u, 0u));
    let distance = shr64(product, 16u).x;
    return select(distance, ONE - distance, run.x != 0u);
}

// From which end an inner entry is reached, and in how many steps. Below level 2 a step from
// either end passes the centre.
fn run_of(segments: u32, entry: u32) -> vec2<u32> {
    if (segments == 3u) {
        return vec2<u32>(2u - entry, 1u);
    }
    let far = 2u * entry > segments;
    return vec2<u32>(u32(far), select(entry, segments - entry, far));
}

fn difference_point(at: u32, segments: u32, entry: u32) -> I64 {
    if (2u * entry == segments) {
        let inner = add64(load(at + 2u), load(at + 4u));
        let sum = add64(add64(load(at), load(at + 6u)), mul64(I64(3u, 0u), inner));
        return round64(sum, 3u, settings.rounding);
    }
    let run = run_of(segments, entry);
    let origin = at + select(NEAR_END, FAR_END, run.x != 0u);
    var sum = shl64(load(at + select(0u, 6u, run.x != 0u)), settings.guard);
    // C(k, n), n = 1, 2, 3: at most 41664 for 64 steps.
    var choose = run.y;
    for (var n = 1u; n <= 3u; n += 1u) {
        sum = add64(sum, mul64(load(origin + 2u * n - 2u), I64(choose, 0u)));
        choose = choose * (run.y - min(n, run.y)) / (n + 1u);
    }
    return round64(sum, settings.guard, settings.rounding);
}

fn casteljau_point(at: u32, t: u32) -> I64 {
    var points = array<I64, 4>(load(at), load(at + 2u), load(at + 4u), load(at + 6u));
    for (var left = 3u; left > 0u; left -= 1u) {
        for (var k = 0u; k < left; k += 1u) {
            let along = mul64(sub64(points[k + 1u], points[k]), I64(t, 0u));
            points[k] = round64(add64(shl64(points[k], 16u), along), 16u, settings.rounding);
        }
    }
    return points[0];
}

// A coordinate of the point at an inner entry of a list, as it fits; counts those that do not.
fn line_point(at: u32, plan: u32, list: u32, entry: u32, differences: bool) -> I64 {
    var value = NONE64;
    if (differences) {
        value = difference_point(at, plans[plan + SEGMENTS + list], entry);
    } else {
        value = casteljau_point(at, parameter(plan, list, entry));
    }
    let fitted = fit(value, settings.width, settings.wraps != 0u);
    if (any(fitted != value)) {
        atomicAdd(&events[0], 1u);
    }
    return fitted;
}

// A coordinate of an interior row: four invocations a line, of which those of the fixed lines have
// nothing to do.
@compute @workgroup_size(64)
fn rows(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = patch_of_line(settings.d + item / 4u);
    let line = settings.d + item / 4u - line_starts[number];
    if (line < FIXED) {
        return;
    }
    let plan = number * PLAN;
    let axis = item % 4u;
    let at = line_at(number, line) + AXIS * axis;
    let differences = in_differences(false);
    for (var column = 0u; column < 4u; column += 1u) {
        let origin = line_at(number, COLUMN + column) + AXIS * axis;
        let entry = line - FIXED + 1u;
        store(at + 2u * column, line_point(origin, plan, ALONG_V, entry, differences));
    }
    if (differences) {
        set_up_ends(at, plan, ALONG_U);
    }
}

// ---- Vertices

// The last patch whose lines begin at `line` or before it: one that has any.
fn patch_of_line(line: u32) -> u32 {
    var low = settings.b;
    var high = settings.c;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        let before = line_starts[middle] <= line;
        low = select(low, middle, before);
        high = select(middle, high, before);
    }
    return low;
}

// Where a vertex stands: its line, that line's list, and its entry there.
struct Where {
    line: u32,
    list: u32,
    entry: u32,
}

// v1 and u0 run against the numbering.
fn on_boundary(plan: u32, local: u32) -> Where {
    var left = local;
    var edge = 0u;
    while (edge < 3u && left >= plans[plan + SEGMENTS + edge]) {
        left -= plans[plan + SEGMENTS + edge];
        edge += 1u;
    }
    let entry = select(left, plans[plan + SEGMENTS + edge] - left, edge >= 2u);
    return Where(edge, edge, entry);
}

fn inside(plan: u32, local: u32) -> Where {
    let columns = plans[plan + COLUMNS];
    return Where(FIXED + local / columns, ALONG_U, local % columns + 1u);
}

fn parameters(plan: u32, place: Where) -> vec2<u32> {
    let t = parameter(plan, place.list, place.entry);
    if (place.line < 4u) {
        let across = select(0u, ONE, place.line == 1u || place.line == 2u);
        return select(vec2<u32>(t, across), vec2<u32>(across, t), (place.line & 1u) != 0u);
    }
    return vec2<u32>(t, parameter(plan, ALONG_V, place.line - FIXED + 1u));
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
    let number = owner(settings.e + item, settings.b, settings.c);
    let plan = number * PLAN;
    let local = settings.e + item - starts[number];
    let boundary = plans[plan + BOUNDARY];
    var place = on_boundary(plan, min(local, boundary - 1u));
    if (local >= boundary) {
        place = inside(plan, local - boundary);
    }
    let differences = in_differences(local < boundary);
    let segments = plans[plan + SEGMENTS + place.list];
    for (var axis = 0u; axis < 4u; axis += 1u) {
        let at = line_at(number, place.line) + AXIS * axis;
        // Corners are the corner points.
        var value = load(at + select(0u, 6u, place.entry != 0u));
        if (place.entry != 0u && place.entry != segments) {
            value = line_point(at, plan, place.list, place.entry, differences);
        }
        vertices[VERTEX * item + 2u * axis] = value.x;
        vertices[VERTEX * item + 2u * axis + 1u] = value.y;
    }
    let uv = parameters(plan, place);
    vertices[VERTEX * item + 8u] = uv.x;
    vertices[VERTEX * item + 9u] = uv.y;
}
