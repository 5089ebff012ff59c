// Dyadic lists by midpoint subdivision (Sfarti et al. 2005, sections 4 to 6); behind level.wgsl.
//
// An invocation takes a curve. The first implementation keeps the pieces that wait on a stack, with
// their points. Here a piece is two numbers, where it begins and its depth; its points are made
// from the curve's by halving as often as it is deep, and the next piece follows from where the
// last one ended. Whether one is flat is decided by a product with the root of the chord's square,
// where the first implementation divides and squares. Then an invocation takes a patch and unites.

// The levels, as `level` leaves them.
@group(0) @binding(4) var<storage, read_write> levels: array<u32>;
// Six words for each of a patch's eight curves: its list's mask, subdivisions, whether clamped.
@group(0) @binding(5) var<storage, read_write> curves: array<u32>;

// Words of a patch in `out`: six masks; clamped, near, overflows, splits.
const LISTS = 28u;
const CURVE = 6u;
const CURVES = 8u;

// The lines of the net that are divided: v0, u1, v1, u0, then the inner rows and columns.
const CURVE_LINES = 0x65214370u;

// Fraction bits below the position's.
const GUARD = 12u;
const DEPTH_MAX = 7u;
const SEGMENTS = 128u;

// A piece's four points: x, y, w with guard bits, 60 bits each.
var<private> hull: array<I64, 12>;

// The state's bounds as depths: 2^depth segments are at least the level.
fn depth_of(level: u32) -> u32 {
    var depth = 0u;
    while (depth < DEPTH_MAX && (1u << (FRACTION + depth)) < level) {
        depth += 1u;
    }
    return depth;
}

// Whether the patch's lists come of midpoint subdivision.
fn subdivides(item: u32) -> bool {
    return settings.termination == 0u && patches[item * PATCH + CRITERION] == FLATNESS;
}

// Halves the piece, and leaves the half at its beginning or at its end. Every form is rounded down
// once, from the piece's own points.
fn halve(end: bool) {
    for (var axis = 0u; axis < 3u; axis += 1u) {
        // The kept half's side first.
        let first = select(axis, axis + 9u, end);
        let second = select(axis + 3u, axis + 6u, end);
        let third = select(axis + 6u, axis + 3u, end);
        let last = select(axis + 9u, axis, end);
        let a = hull[first];
        let b = hull[second];
        let c = hull[third];
        let inner = add64(b, c);
        let all_four = add64(add64(a, hull[last]), add64(inner, add64(inner, inner)));
        hull[second] = sar64(add64(a, b), 1u);
        hull[third] = sar64(add64(add64(a, b), inner), 2u);
        hull[last] = sar64(all_four, 3u);
    }
}

// Makes the points of the piece that begins at first / 128.
fn make_piece(at: u32, line: u32, first: u32, depth: u32) {
    for (var k = 0u; k < 12u; k += 1u) {
        let axis = select(k % 3u, 3u, k % 3u == 2u);
        hull[k] = shl64(coordinate(at, on_line(line, k / 3u), axis), GUARD);
    }
    for (var k = 0u; k < depth; k += 1u) {
        halve(((first >> (DEPTH_MAX - 1u - k)) & 1u) != 0u);
    }
}

// Projects the piece's points from the k-th on; `projected` says which have pixels.
fn project_piece(from_point: u32) {
    for (var k = from_point; k < 4u; k += 1u) {
        let w = hull[3u * k + 2u];
        var fits = in_front(w, GUARD);
        for (var axis = 0u; axis < 2u && fits; axis += 1u) {
            let size = select(settings.viewport_x, settings.viewport_y, axis == 1u);
            let found = pixel(hull[3u * k + axis], w, size);
            pixels[2u * k + axis] = found.value;
            fits = found.fits;
        }
        projected = (projected & ~(1u << k)) | (u32(fits) << k);
    }
}

// From the piece's first point to another: 41 bits.
fn toward(point: u32, axis: u32) -> I64 {
    return sub64(pixels[2u * point + axis], pixels[axis]);
}

// From the first point, of a vector along u and one along another: the area between, or the square.
fn product(p: u32, q: u32, crossed: bool) -> I128 {
    let one = mul_signed(toward(p, 0u), toward(q, u32(crossed)));
    let other = mul_signed(toward(p, 1u), toward(q, 1u - u32(crossed)));
    if (crossed) {
        return abs128(sub128(one, other));
    }
    return add128(one, other);
}

// Whether the two inner points are within the tolerance of the line through the outer ones, or of
// these where both are one. All four have pixels.
fn is_flat(tolerance: u32) -> bool {
    let chord = product(3u, 3u, false);
    let point = is_zero128(chord);
    var height = NONE128;
    for (var k = 1u; k < 3u; k += 1u) {
        // Over a chord, its height times the chord's length, of which no more is taken than the
        // length rounded down.
        let other = select(3u, k, point);
        height = max128(height, product(k, other, !point));
    }
    let length = sub64(root_up(add128(chord, I128(1u, 0u, 0u, 0u))), I64(1u, 0u));
    let reach = select(length, I64(tolerance, 0u), point);
    return !less128(mul_unsigned(reach, I64(tolerance, 0u)), height);
}

@compute @workgroup_size(64)
fn curve(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let number = item_of(id, groups);
    let item = number / CURVES;
    if (number >= settings.items || fates[4u * item] != 2u || !subdivides(item)) {
        return;
    }
    let at = item * PATCH;
    let line = digit(CURVE_LINES, number % CURVES);
    let tolerance = patches[at + NUMBER];
    let least = depth_of(patches[at + LEAST]);
    let most = depth_of(patches[at + GREATEST]);
    var list = NONE128;
    var splits = 0u;
    var clamped = false;
    var first = 0u;
    var depth = 0u;
    // Its first point is that of the piece before, or the last point of that.
    var known = 0u;
    while (first < SEGMENTS) {
        make_piece(at, line, first, depth);
        var divided = true;
        if (depth >= least) {
            project_piece(known);
            known = 1u;
            let whole_piece = (projected & 15u) == 15u;
            let flat = whole_piece && is_flat(tolerance);
            divided = depth < most && !flat;
            clamped = clamped || (depth >= most && whole_piece && !flat);
        }
        if (divided) {
            depth += 1u;
            splits += 1u;
            list |= shl128(I128(1u, 0u, 0u, 0u), first + (SEGMENTS >> depth));
        } else {
            first += SEGMENTS >> depth;
            // The piece that begins where this one ends is as long as the lowest bit.
            depth = DEPTH_MAX - min(countTrailingZeros(first), DEPTH_MAX);
            pixels[0] = pixels[6];
            pixels[1] = pixels[7];
            projected = projected >> 3u;
        }
    }
    for (var k = 0u; k < 4u; k += 1u) {
        out[CURVE * number + k] = list[k];
    }
    out[CURVE * number + 4u] = splits;
    out[CURVE * number + 5u] = u32(clamped);
}

// ---- lists of a patch

// The list of 2^depth equal segments for a level.
fn equal_segments(level: u32) -> I128 {
    let step = SEGMENTS >> depth_of(level);
    var list = NONE128;
    for (var k = step; k < SEGMENTS; k += step) {
        list |= shl128(I128(1u, 0u, 0u, 0u), k);
    }
    return list;
}

// Six lists of equal segments from a patch's levels. What the interior has beyond its edges stands
// on inner rows or columns, so one of them there must be.
fn by_levels(from_levels: u32) -> array<I128, 6> {
    var lists: array<I128, 6>;
    for (var k = 0u; k < 6u; k += 1u) {
        lists[k] = equal_segments(levels[from_levels + k]);
    }
    let half = shl128(I128(1u, 0u, 0u, 0u), SEGMENTS / 2u);
    let u_beyond = any((lists[0] | lists[2]) != lists[4]);
    let v_beyond = any((lists[1] | lists[3]) != lists[5]);
    if (is_zero128(lists[5]) && u_beyond) {
        lists[5] = half;
    } else if (is_zero128(lists[4]) && v_beyond) {
        lists[4] = half;
    }
    return lists;
}

fn curve_list(from_curve: u32) -> I128 {
    return I128(
        curves[from_curve],
        curves[from_curve + 1u],
        curves[from_curve + 2u],
        curves[from_curve + 3u],
    );
}

@compute @workgroup_size(64)
fn lists(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items || fates[4u * item] != 2u) {
        return;
    }
    var found = by_levels(item * LEVELS);
    var clamped = levels[item * LEVELS + 6u];
    var splits = 0u;
    if (subdivides(item)) {
        clamped = 0u;
        found = array<I128, 6>();
        // The edges, and what the two inner rows and the two inner columns have together.
        var over = array<u32, 6>();
        for (var k = 0u; k < CURVES; k += 1u) {
            let from_curve = CURVE * (CURVES * item + k);
            let to_list = select(k, k / 2u + 2u, k >= EDGES);
            found[to_list] |= curve_list(from_curve);
            splits += curves[from_curve + 4u];
            over[to_list] |= curves[from_curve + 5u];
        }
        for (var k = 0u; k < 6u; k += 1u) {
            clamped += over[k];
        }
    }
    found[4] |= found[0] | found[2];
    found[5] |= found[1] | found[3];
    for (var k = 0u; k < 24u; k += 1u) {
        out[item * LISTS + k] = found[k / 4u][k % 4u];
    }
    out[item * LISTS + 24u] = clamped;
    out[item * LISTS + 25u] = levels[item * LEVELS + 7u];
    out[item * LISTS + 26u] = levels[item * LEVELS + 8u];
    out[item * LISTS + 27u] = splits;
}
