// The hull shader: what it does of a patch-constant function. In come control points in clip space,
// or levels; out come six tessellation factors a patch, f32 as their bits, all 0 where the patch is
// culled, and what was counted.
//
// Under the adaptive policy (Concheiro et al. 2014, Equation 9) an invocation a curve tests all its
// candidates. The first implementation has the processor's singles, four at a time; here they are
// integers, and weights come from a kernel of their own.
//
// Own settings: a partitioning (0 integer, 1 pow2, 2 odd, 3 even), b 0 factors from levels,
// 1 adaptive, c candidates of a cell, d bits of the threshold in pixels, e binary places of the
// least w, two's complement.

// Words of a candidate: Bernstein weights, weights of its cell's ends.
const CANDIDATE = 6u;
// Edges v0 u1 v1 u0, then the net's rows 1 and 2 and columns 1 and 2.
const CURVES = 8u;

const ODD = 2u;
const POW2 = 1u;

// Levels in 16.16, and the least of them.
const ONE_LEVEL = 0x10000u;
const ODD_MOST = 63u;
const MOST = 64u;

// Words of the levels of a patch, and of its events.
const LEVELS = 12u;
const CLAMPED = 6u;

// What is counted of a patch, in the order of its row.
const ROW = 30u;

// ---- bounds

// `reach`: patches.
@group(0) @binding(1) var<storage, read_write> patches: array<u32>;

fn most_level() -> u32 {
    return select(MOST, ODD_MOST, settings.a == ODD) * ONE_LEVEL;
}

// The tessellation state, within what a partitioning reaches.
@compute @workgroup_size(64)
fn reach(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let at = item * PATCH;
    patches[at + LEAST] = min(patches[at + LEAST], most_level());
    patches[at + GREATEST] = min(patches[at + GREATEST], most_level());
}

// ---- the distance test

// `candidates`: a table. `insert`: fates, control points, the table, vertices inserted.
@group(0) @binding(1) var<storage, read_write> table: array<u32>;
@group(0) @binding(1) var<storage, read_write> fates: array<u32>;
@group(0) @binding(2) var<storage, read_write> shaded: array<u32>;
@group(0) @binding(3) var<storage, read_write> weights: array<u32>;
@group(0) @binding(4) var<storage, read_write> inserted: array<u32>;

fn ratio(n: u32, whole: u32) -> u32 {
    return quotient(single_of(I64(n, 0u), 0), single_of(I64(whole, 0u), 0));
}

// Both ends' parameters from integers, so that an edge is the same from either.
@compute @workgroup_size(64)
fn candidates(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let k = item_of(id, groups);
    if (k >= settings.items) {
        return;
    }
    let cell = settings.c + 1u;
    for (var end = 0u; end < 2u; end += 1u) {
        let place = select(k, 3u * cell - k, end == 1u);
        let u = ratio(place, 3u * cell);
        let w = ratio(3u * cell - place, 3u * cell);
        let ww = multiply(w, w);
        table[k * CANDIDATE + 3u * end] = multiply(ww, w);
        table[k * CANDIDATE + 1u + end] = multiply(THREE_SINGLE, multiply(u, ww));
        let rest = k % cell;
        table[k * CANDIDATE + 4u + end] = ratio(select(cell - rest, rest, end == 1u), cell);
    }
}

// The number of control point k of a curve.
fn control_point(curve: u32, k: u32) -> u32 {
    switch curve {
        case 0u: { return k; }
        case 1u: { return 4u * k + 3u; }
        case 2u: { return 12u + k; }
        case 3u: { return 4u * k; }
        case 4u, 5u: { return 4u * (curve - 3u) + k; }
        default: { return 4u * k + curve - 5u; }
    }
}

// x, y or w of a control point.
fn control(item: u32, curve: u32, k: u32, axis: u32) -> u32 {
    return shaded[item * 64u + 4u * control_point(curve, k) + axis];
}

// On the control polygon, linear in its cell.
fn on_polygon(item: u32, curve: u32, k: u32, axis: u32) -> u32 {
    let cell = k / (settings.c + 1u);
    let at = k * CANDIDATE + 4u;
    var terms = vec2<u32>();
    for (var end = 0u; end < 2u; end += 1u) {
        terms[end] = multiply(weights[at + end], control(item, curve, cell + end, axis));
    }
    return add(terms.x, terms.y);
}

// On the curve, paired as the domain shader's.
fn on_curve(item: u32, curve: u32, k: u32, axis: u32) -> u32 {
    var pairs = vec2<u32>();
    for (var pair = 0u; pair < 2u; pair += 1u) {
        var terms = vec2<u32>();
        for (var end = 0u; end < 2u; end += 1u) {
            let point = select(pair, 3u - pair, end == 1u);
            let weight = weights[k * CANDIDATE + point];
            terms[end] = multiply(weight, control(item, curve, point, axis));
        }
        pairs[pair] = add(terms.x, terms.y);
    }
    return add(pairs.x, pairs.y);
}

struct Projected {
    known: bool,
    x: u32,
    y: u32,
}

// Pixels from the viewport's centre.
fn project(x: u32, y: u32, w: u32) -> Projected {
    let near = single_of(I64(settings.near_low, settings.near_high), -bitcast<i32>(settings.e));
    let known = at_least(w, near) && order_of(w) > 0;
    let reciprocal = quotient(ONE_SINGLE, w);
    var on = vec2(x, y);
    for (var axis = 0u; axis < 2u; axis += 1u) {
        let side = select(settings.viewport_x, settings.viewport_y, axis == 1u);
        let half = multiply(single_of(I64(side, 0u), 0), HALF_SINGLE);
        on[axis] = multiply(multiply(on[axis], reciprocal), half);
    }
    return Projected(known, on.x, on.y);
}

// Whether both are more pixels apart than the threshold; also where one has no projection, and
// where what is between them is no number.
fn is_apart(item: u32, curve: u32, k: u32) -> bool {
    var at: array<vec2<u32>, 2>;
    var known = true;
    for (var which = 0u; which < 2u; which += 1u) {
        var p = vec3<u32>();
        for (var c = 0u; c < 3u; c += 1u) {
            let axis = select(c, 3u, c == 2u);
            if (which == 0u) {
                p[c] = on_polygon(item, curve, k, axis);
            } else {
                p[c] = on_curve(item, curve, k, axis);
            }
        }
        let projected = project(p.x, p.y, p.z);
        known = known && projected.known;
        at[which] = vec2(projected.x, projected.y);
    }
    var squares = vec2<u32>();
    for (var axis = 0u; axis < 2u; axis += 1u) {
        let apart = subtract(at[0][axis], at[1][axis]);
        squares[axis] = multiply(apart, apart);
    }
    let threshold = multiply(settings.d, settings.d);
    return !known || !at_least(threshold, add(squares.x, squares.y));
}

// An invocation a patch and curve.
@compute @workgroup_size(64)
fn insert(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items || fates[4u * (item / CURVES)] != 2u) {
        return;
    }
    var count = 0u;
    let cell = settings.c + 1u;
    for (var k = 1u; k < 3u * cell; k += 1u) {
        if (k % cell != 0u) {
            count += u32(is_apart(item / CURVES, item % CURVES, k));
        }
    }
    inserted[item] = count;
}

// ---- factors

// `hull`: patches, fates, levels or vertices inserted, factors, counts.
@group(0) @binding(2) var<storage, read_write> fate: array<u32>;
@group(0) @binding(3) var<storage, read_write> chosen: array<u32>;
@group(0) @binding(4) var<storage, read_write> factors: array<u32>;
@group(0) @binding(5) var<storage, read_write> rows: array<u32>;

// Of which curves the interior along an axis has the greatest factor.
fn greatest(item: u32, axis: u32) -> u32 {
    var most = 0u;
    for (var k = 0u; k < 4u; k += 1u) {
        // v0 v1 and rows; u1 u0 and columns.
        let edge = 2u * k + axis;
        let net = 2u + 2u * axis + k;
        most = max(most, chosen[item * CURVES + select(edge, net, k >= 2u)]);
    }
    return most;
}

// Level `place` of u0 v0 u1 v1 u v, in 16.16, before it is clamped here.
fn level_of(item: u32, place: u32) -> u32 {
    // Edges stand as v0 u1 v1 u0.
    let edge = (place + 3u) % 4u;
    if (settings.b == 0u) {
        return chosen[item * LEVELS + select(edge, place, place >= 4u)];
    }
    if (place >= 4u) {
        return (3u + greatest(item, place - 4u)) * ONE_LEVEL;
    }
    return (3u + chosen[item * CURVES + edge]) * ONE_LEVEL;
}

// Up to a power of two: under pow2 it is this shader that rounds.
fn rounded(level: u32) -> u32 {
    if (settings.a != POW2) {
        return level;
    }
    let whole = (level + ONE_LEVEL - 1u) / ONE_LEVEL;
    return (1u << (32u - countLeadingZeros(whole - 1u))) * ONE_LEVEL;
}

// Writes the six factors. Returns how many were clamped.
fn write_factors(item: u32) -> u32 {
    let at = item * PATCH;
    var clamped = 0u;
    for (var place = 0u; place < 6u; place += 1u) {
        var level = level_of(item, place);
        if (settings.b != 0u) {
            let most = min(patches[at + GREATEST], most_level());
            clamped += u32(level > most);
            level = clamp(level, min(patches[at + LEAST], most_level()), most);
        }
        factors[item * 6u + place] = single_of(I64(rounded(level), 0u), -16);
    }
    return clamped;
}

// The first words of a row: clip culled; backface in, tested, facets, culled; kept; levels by
// flatness, by edge length, splits, clamped, near, overflows; distance tests.
fn count_fate(item: u32) {
    let at = item * ROW;
    let became = fate[4u * item];
    rows[at] = u32(became == 0u);
    rows[at + 1u] = u32(became != 0u);
    // Both 0 where it is clipped.
    rows[at + 2u] = fate[4u * item + 1u];
    rows[at + 3u] = fate[4u * item + 2u];
    rows[at + 4u] = u32(became == 1u);
    rows[at + 5u] = u32(became == 2u);
}

@compute @workgroup_size(64)
fn hull(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    count_fate(item);
    if (fate[4u * item] != 2u) {
        return; // what is culled has factors of 0, as they come
    }
    let at = item * ROW + 6u;
    let clamped = write_factors(item);
    if (settings.b != 0u) {
        rows[at + 3u] = clamped;
        rows[at + 6u] = CURVES * 3u * settings.c;
        return;
    }
    let criterion = patches[item * PATCH + CRITERION];
    rows[at] = u32(criterion == 0u);
    rows[at + 1u] = u32(criterion == 1u);
    rows[at + 2u] = chosen[item * LEVELS + CLAMPED + 3u];
    for (var k = 0u; k < 3u; k += 1u) {
        rows[at + 3u + k] = chosen[item * LEVELS + CLAMPED + k];
    }
}
