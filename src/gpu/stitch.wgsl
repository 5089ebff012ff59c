// Stitch: plans in, triangles out (Moreton 2001, section 5.1; Sfarti et al. 2005, section 6). An
// invocation a triangle: its patch is found in the sums before it, its strip by counting. The first
// implementation walks along two rows and keeps an error; here the triangles before this one are
// known to be so many on the inner row by a search on the merge of both rows ("merge path": Odeh,
// Green, Mwassi, Shmueli, Birk 2012), without any of them.

// a: 1 where lists are masks. b and c: the first patch, and the one behind the last. d, e: numbers
// of their first triangle and vertex.
@group(0) @binding(1) var<storage, read_write> starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> triangles: array<u32>;
@group(0) @binding(3) var<storage, read_write> plans: array<u32>;
@group(0) @binding(4) var<storage, read_write> vertex_starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> vertices: array<u32>;
// Word 2: triangles with two equal positions.
@group(0) @binding(6) var<storage, read_write> events: array<atomic<u32>>;

// Two rows and what joins them: Bresenham's walk where the inner row has no list, else a merge of
// lists. `outer` and `inner` are first vertices, the steps to the next ones are -127 to 127.
struct Strip {
    outer: u32,
    outer_step: u32,
    outer_segments: u32,
    inner: u32,
    inner_step: u32,
    inner_segments: u32,
    mirrored: bool,
    // Of a merge: the lists, and the inner one's entry where the inner row begins.
    outer_list: u32,
    inner_list: u32,
    inner_entry: u32,
}

// Between rows of n and of m segments.
fn between(outer: vec2<u32>, n: u32, inner: vec2<u32>, m: u32, mirrored: bool) -> Strip {
    var strip = Strip();
    strip.outer = outer.x;
    strip.outer_step = outer.y;
    strip.outer_segments = n;
    strip.inner = inner.x;
    strip.inner_step = inner.y;
    strip.inner_segments = m;
    strip.mirrored = mirrored;
    return strip;
}

// ---- Where rows stand

fn edge_start(plan: u32, edge: u32) -> u32 {
    var start = 0u;
    for (var k = 0u; k < edge; k += 1u) {
        start += plans[plan + SEGMENTS + k];
    }
    return start;
}

// First vertex and step of a side's edge, from one of its ends: v1 and u0 run against the
// numbering.
fn edge_row(plan: u32, side: u32, end: u32) -> vec2<u32> {
    if ((side < 2u) == (end == 0u)) {
        return vec2<u32>(edge_start(plan, side), 1u);
    }
    return vec2<u32>(edge_start(plan, side + 1u), ~0u);
}

// The same of the interior's outermost row or column.
fn interior_row(plan: u32, side: u32, end: u32) -> vec2<u32> {
    let columns = plans[plan + COLUMNS];
    let upright = (side & 1u) != 0u;
    let beside = side == 1u || side == 2u;
    let right = select(end == 1u, beside, upright);
    let top = select(beside, end == 1u, upright);
    let row = select(0u, plans[plan + ROWS] - 1u, top);
    let first = plans[plan + BOUNDARY] + row * columns + select(0u, columns - 1u, right);
    let step = select(1u, columns, upright);
    return vec2<u32>(first, select(step, 0u - step, end != 0u));
}

// ---- Merging

fn mask_of(plan: u32, list: u32) -> I128 {
    let at = plan + LISTS + 4u * list;
    return I128(plans[at], plans[at + 1u], plans[at + 2u], plans[at + 3u]);
}

// The number, within the strip, of the triangle on inner segment q: q, and the outer segments that
// come first.
fn rank(strip: Strip, plan: u32, q: u32) -> u32 {
    let n = strip.outer_segments;
    if (settings.a == 0u) {
        // Those whose midpoints come before: (2 o + 1) / n < (2 q + 1) / m.
        let m = strip.inner_segments;
        return q + ((2u * q + 1u) * n + m - 1u) / (2u * m);
    }
    // Those that end where this one does, or before: the last one ends at 1.
    let entry = strip.inner_entry + q + 1u;
    if (entry == plans[plan + SEGMENTS + strip.inner_list]) {
        return q + n;
    }
    let key = select128(mask_of(plan, strip.inner_list), entry - 1u);
    return q + count_below128(mask_of(plan, strip.outer_list), key + 1u);
}

// How many of the first `made` triangles stand on the inner row.
fn inner_before(strip: Strip, plan: u32, made: u32) -> u32 {
    var low = 0u;
    var high = min(made, strip.inner_segments);
    while (low < high) {
        let middle = (low + high) / 2u;
        let before = rank(strip, plan, middle) < made;
        low = select(low, middle + 1u, before);
        high = select(middle, high, before);
    }
    return low;
}

fn triangle_of(strip: Strip, plan: u32, made: u32) -> vec3<u32> {
    let q = inner_before(strip, plan, made);
    let o = made - q;
    let walked = strip.outer + o * strip.outer_step;
    // The boundary ends where it began: at vertex 0.
    let outer = select(walked, 0u, walked == plans[plan + BOUNDARY]);
    let inner = strip.inner + q * strip.inner_step;
    var corners = vec3<u32>(outer, walked + strip.outer_step, inner);
    if (q < strip.inner_segments && rank(strip, plan, q) == made) {
        corners = vec3<u32>(inner, outer, inner + strip.inner_step);
    }
    return select(corners, corners.xzy, strip.mirrored);
}

// ---- Strips

// A cell of two triangles, its diagonal from `a` or from `d`.
fn cell(a: u32, b: u32, c: u32, d: u32, rising: bool, second: bool) -> vec3<u32> {
    if (rising) {
        return select(vec3<u32>(a, b, c), vec3<u32>(a, c, d), second);
    }
    return select(vec3<u32>(a, b, d), vec3<u32>(b, c, d), second);
}

// Diagonals point at the patch's centre.
fn grid_triangle(plan: u32, number: u32) -> vec3<u32> {
    let columns = plans[plan + COLUMNS];
    let width = columns - 1u;
    let row = number / (2u * width);
    let column = (number / 2u) % width;
    let lower = 2u * row < plans[plan + ROWS] - 1u;
    let a = plans[plan + BOUNDARY] + row * columns + column;
    let rising = (2u * column < width) == lower;
    return cell(a, a + 1u, a + columns + 1u, a + columns, rising, (number & 1u) != 0u);
}

// A half of a side, or (part 2) the segment across its centre.
fn half_strip(plan: u32, side: u32, part: u32, n: u32, m: u32) -> Strip {
    let across = part == 2u;
    let end = select(part, u32(side == 1u || side == 2u), across);
    let outer = edge_row(plan, side, end);
    let inner = interior_row(plan, side, end);
    let mirrored = (side >= 2u) != (end == 1u);
    if (!across) {
        return between(outer, n, inner, m, mirrored);
    }
    let below_two = u32(plans[plan + SEGMENTS + 4u] == 3u);
    let first = vec2(outer.x + n * outer.y, outer.y);
    return between(first, 1u, vec2(inner.x + m * inner.y, inner.y), below_two, mirrored);
}

fn fractional_side(plan: u32, side: u32, along: u32, number: u32) -> vec3<u32> {
    let n = plans[plan + SEGMENTS + side] / 2u;
    let m = select((along - 1u) / 2u, 0u, plans[plan + SEGMENTS + 4u] == 3u);
    // Both halves have as many, and with none there is only the segment across.
    var part = 2u;
    if (number < 2u * (n + m)) {
        part = number / (n + m);
    }
    let strip = half_strip(plan, side, part, n, m);
    return triangle_of(strip, plan, number - part * (n + m));
}

fn dyadic_side(plan: u32, side: u32, along: u32, number: u32) -> vec3<u32> {
    let outer = edge_row(plan, side, 0u);
    let inner = interior_row(plan, side, 0u);
    let n = plans[plan + SEGMENTS + side];
    var strip = between(outer, n, inner, along - 1u, side >= 2u);
    strip.outer_list = side;
    strip.inner_list = 4u + (side & 1u);
    strip.inner_entry = 1u;
    return triangle_of(strip, plan, number);
}

// A patch without interior, between the two opposite edges that have entries.
fn zipped(plan: u32, number: u32) -> vec3<u32> {
    let side = select(0u, 3u, plans[plan + SEGMENTS + 4u] == 1u);
    let opposite = (side + 2u) % 4u;
    let outer = edge_row(plan, side, 0u);
    let inner = edge_row(plan, opposite, 0u);
    let n = plans[plan + SEGMENTS + side];
    let m = plans[plan + SEGMENTS + opposite];
    var strip = between(outer, n, inner, m, side == 3u);
    strip.outer_list = side;
    strip.inner_list = opposite;
    return triangle_of(strip, plan, number);
}

fn patch_triangle(plan: u32, number: u32) -> vec3<u32> {
    let columns = plans[plan + COLUMNS];
    if (columns == 0u) {
        if (plans[plan + VERTICES] == 4u) {
            return cell(0u, 1u, 2u, 3u, true, number != 0u);
        }
        return zipped(plan, number);
    }
    let grid = 2u * (columns - 1u) * (plans[plan + ROWS] - 1u);
    if (number < grid) {
        return grid_triangle(plan, number);
    }
    // A side has a triangle for each segment of its two rows.
    var left = number - grid;
    var side = 0u;
    var along = columns;
    while (side < 3u && left >= plans[plan + SEGMENTS + side] + along - 1u) {
        left -= plans[plan + SEGMENTS + side] + along - 1u;
        side += 1u;
        along = select(columns, plans[plan + ROWS], (side & 1u) != 0u);
    }
    if (settings.a != 0u) {
        return dyadic_side(plan, side, along, left);
    }
    return fractional_side(plan, side, along, left);
}

@compute @workgroup_size(64)
fn stitch(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = owner(settings.d + item, settings.b, settings.c);
    let corners = patch_triangle(number * PLAN, settings.d + item - starts[number]);
    for (var k = 0u; k < 3u; k += 1u) {
        triangles[3u * item + k] = corners[k];
    }
}

// ---- Degenerate triangles

// Counts the triangles that have two equal clip positions.
@compute @workgroup_size(64)
fn degenerate(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = owner(settings.d + item, settings.b, settings.c);
    let first = vertex_starts[number] - settings.e;
    var equal = false;
    for (var k = 0u; k < 3u; k += 1u) {
        let next = triangles[3u * item + (k + 1u) % 3u];
        equal |= same_position(first + triangles[3u * item + k], first + next);
    }
    if (equal) {
        atomicAdd(&events[2], 1u);
    }
}
