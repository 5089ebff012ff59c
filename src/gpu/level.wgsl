// Level: patches that culling left in; a level for each edge and for the interior out, or none
// where a patch was culled. An invocation takes a patch.
//
// Points are projected by long division that makes no more bits than a pixel has, lengths are roots
// found bit by bit; the first implementation has the processor's division, and roots by estimates.
// Every length is one of a common list of weighted sums of four points. Roundings are the same, and
// all of them upwards but the projection's.

@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
@group(0) @binding(2) var<storage, read_write> fates: array<u32>;
@group(0) @binding(3) var<storage, read_write> out: array<u32>;

// Words of a patch in `out`: six levels; clamped, near, overflows; three more are 0.
const LEVELS = 12u;

const FLATNESS = 0u;
const EDGE_LENGTH = 1u;
const FIXED = 2u;

// Fraction bits of pixels and levels; bits of a pixel without its sign: 23 before the point.
const FRACTION = 16u;
const PIXEL_BITS = 39u;

// What the roundings of a projection may add to a second difference, in ulps.
const SLACK = 3u;

// Lines 0 to 3 are the net's rows, 4 to 7 its columns: the line of each edge.
const EDGE_LINES = 0x4370u;
const LINES = 8u;
const EDGES = 4u;

// Pixels of the 16 points, x and y, and which points have one.
var<private> pixels: array<I64, 32>;
var<private> projected: u32;
// A bend or a length for each line of the net, and its greatest twist.
var<private> measures: array<I64, 8>;
var<private> twist: I64;
// What the criterion asks for: four edges, u, v.
var<private> asked: array<I64, 6>;

// Digit k of a table in hexadecimal.
fn digit(table: u32, k: u32) -> u32 {
    return (table >> (4u * k)) & 15u;
}

fn coordinate(at: u32, point: u32, axis: u32) -> I64 {
    let first = at + 8u * point + 2u * axis;
    return I64(patches[first], patches[first + 1u]);
}

// ---- projection

struct Pixel {
    value: I64,
    fits: bool,
}

// Where `rest` takes in so many times w: what is left, and in `digit` the bit that says so.
struct Step {
    rest: I64,
    digit: u32,
}

fn step(before: Step, w: I64, bit: u32) -> Step {
    let part = shl64(w, bit);
    if (below64(before.rest, part)) {
        return before;
    }
    return Step(sub64(before.rest, part), before.digit | (1u << bit));
}

// The next four bits of a number that are to come, behind those of another.
fn append(a: I64, digit: u32) -> I64 {
    return I64((a.x << 4u) | digit, (a.y << 4u) | (a.x >> 28u));
}

// c / w in pixels of a viewport of that size, to the nearest, of two the even one. c and w, which
// is above 0, have up to 60 bits; a viewport 15. Four bits of the quotient at a time: lavapipe ends
// the loops of an invocation when they have turned 65535 times, all of them together, and this one
// turns most of a subdivision's times.
fn pixel(c: I64, w: I64, size: u32) -> Pixel {
    let numerator = mul_unsigned(abs64(c), I64(size << (FRACTION - 1u), 0u));
    let high = shr128(numerator, PIXEL_BITS + 1u);
    if (!is_zero64(high.zw) || !below64(high.xy, w)) {
        return Pixel(NONE64, false);
    }
    var rest = high.xy;
    var quotient = NONE64;
    // The numerator's bits that are to come, from the top.
    var bits = shl64(numerator.xy, 63u - PIXEL_BITS);
    for (var k = 0u; k <= PIXEL_BITS; k += 4u) {
        var next = Step(append(rest, bits.y >> 28u), 0u);
        next = step(step(next, w, 3u), w, 2u);
        next = step(step(next, w, 1u), w, 0u);
        rest = next.rest;
        bits = append(bits, 0u);
        quotient = append(quotient, next.digit);
    }
    let twice = shl64(rest, 1u);
    let up = below64(w, twice) || (all(w == twice) && (quotient.x & 1u) != 0u);
    quotient = add64(quotient, I64(u32(up), 0u));
    let value = select(quotient, neg64(quotient), is_negative64(c));
    return Pixel(value, bits64(quotient) <= PIXEL_BITS);
}

// Whether a point of that w is far enough to be projected; w and the threshold of the same format.
fn in_front(w: I64, guard: u32) -> bool {
    let near = shl64(I64(settings.near_low, settings.near_high), guard);
    return !less64(w, near) && less64(NONE64, w);
}

// Projects the points of a patch; how many of them are far enough, and have no pixel.
fn project(at: u32) -> u32 {
    projected = 0u;
    var overflows = 0u;
    for (var k = 0u; k < 16u; k += 1u) {
        let w = coordinate(at, k, 3u);
        if (!in_front(w, 0u)) {
            continue;
        }
        var fits = true;
        for (var axis = 0u; axis < 2u; axis += 1u) {
            let size = select(settings.viewport_x, settings.viewport_y, axis == 1u);
            let found = pixel(coordinate(at, k, axis), w, size);
            pixels[2u * k + axis] = found.value;
            fits = fits && found.fits;
        }
        projected |= u32(fits) << k;
        overflows += u32(!fits);
    }
    return overflows;
}

fn on_line(line: u32, k: u32) -> u32 {
    return select(line - LINES / 2u + 4u * k, 4u * line + k, line < LINES / 2u);
}

// Whether all points of a line have pixels.
fn whole(line: u32) -> bool {
    let points = select(0x1111u << (line & 3u), 0xfu << (4u * (line & 3u)), line < LINES / 2u);
    return (projected & points) == points;
}

// ---- lengths

// The length of a weighted sum of four points, rounded up.
fn norm(points: vec4<u32>, weights: vec4<i32>) -> I64 {
    var square = NONE128;
    for (var axis = 0u; axis < 2u; axis += 1u) {
        var sum = NONE64;
        for (var k = 0u; k < 4u; k += 1u) {
            sum = add64(sum, mul64(word(weights[k]), pixels[2u * points[k] + axis]));
        }
        square = add128(square, mul_unsigned(abs64(sum), abs64(sum)));
    }
    return root_up(square);
}

// Lengths over the lines that have pixels: of three segments each. Or bends, the greater of two
// second differences each, and behind them the mixed differences of nine facets.
fn measure(flat: bool) {
    let segments = select(3u, 2u, flat);
    let of_lines = LINES * segments;
    for (var k = 0u; k < of_lines + select(0u, 9u, flat); k += 1u) {
        var points: vec4<u32>;
        var weights = vec4<i32>(-1, 1, 0, 0);
        let line = k / segments;
        let of_line = k < of_lines;
        if (of_line) {
            if (!whole(line)) {
                continue;
            }
            let first = on_line(line, k % segments);
            let step = select(4u, 1u, line < LINES / 2u);
            // The last point is of weight 0 for both.
            points = vec4<u32>(first, first + step, first + step + step * u32(flat), first);
            if (flat) {
                weights = vec4<i32>(1, -2, 1, 0);
            }
        } else {
            let facet = k - of_lines;
            let first = 4u * (facet / 3u) + facet % 3u;
            points = vec4<u32>(first, first + 1u, first + 4u, first + 5u);
            weights = vec4<i32>(1, -1, -1, 1);
        }
        let length = norm(points, weights);
        let slack = I64(SLACK, 0u);
        if (!of_line) {
            twist = max64(twist, add64(length, slack));
        } else if (flat) {
            measures[line] = max64(measures[line], add64(length, slack));
        } else {
            measures[line] = add64(measures[line], length);
        }
    }
}

// ---- levels

fn bounded(level: I64, at: u32) -> I64 {
    let least = I64(patches[at + LEAST], 0u);
    let greatest = I64(patches[at + GREATEST], 0u);
    return select(max64(level, least), greatest, less64(greatest, level));
}

// The measure of an edge, or the greatest of the lines along u (4) or v (5).
fn measure_of(k: u32) -> I64 {
    if (k < EDGES) {
        return measures[digit(EDGE_LINES, k)];
    }
    var most = NONE64;
    let first = select(0u, LINES / 2u, k == 5u);
    for (var line = first; line < first + LINES / 2u; line += 1u) {
        most = max64(most, measures[line]);
    }
    return most;
}

fn times(a: I64, by: u32) -> I64 {
    return mul64(a, I64(by, 0u));
}

// 6 uu m^2 + 18 uv n m + 6 vv n^2 for the bends uu and vv and the twist uv: 42 bits each, and 24
// for the levels n and m.
fn bound(n: I64, m: I64) -> I128 {
    var sum = mul_unsigned(times(measure_of(4u), 6u), mul64(m, m));
    sum = add128(sum, mul_unsigned(times(twist, 18u), mul64(n, m)));
    return add128(sum, mul_unsigned(times(measure_of(5u), 6u), mul64(n, n)));
}

// What the criterion asks for, from the measures: edges, interior, and by flatness the interior
// once more, raised until the twist is within bounds too.
fn ask(at: u32, flat: bool) {
    let tolerance = patches[at + NUMBER];
    // The interior's levels as they were before either is raised.
    var start = array<I64, 2>();
    for (var k = 0u; k < select(6u, 8u, flat); k += 1u) {
        let raised = k >= 6u;
        var numerator = shl128(wide(measure_of(min(k, 5u))), FRACTION);
        var divisor = I128(tolerance, 0u, 0u, 0u);
        if (k == 6u) {
            // By the levels that the edges along it will have, and its own.
            for (var way = 0u; way < 2u; way += 1u) {
                let edges = max64(asked[way], asked[way + 2u]);
                start[way] = bounded(max64(edges, asked[4u + way]), at);
            }
        }
        if (raised) {
            let across = start[7u - k];
            numerator = shl128(bound(start[0], start[1]), 2u * FRACTION - 3u);
            divisor = mul128(divisor, wide(mul64(across, across)));
        } else if (flat) {
            // The square of sqrt(3/4 bend / tolerance), with twice as many fraction bits.
            numerator = shl128(wide(times(measure_of(k), 3u)), 2u * FRACTION - 2u);
        }
        let quotient = divide_up(numerator, divisor);
        if (!flat) {
            asked[k] = quotient.xy;
        } else if (raised) {
            asked[k - 2u] = max64(root_up(quotient), start[k - 6u]);
        } else {
            asked[k] = root_up(quotient);
        }
    }
}

// Writes the levels within the state's bounds; an interior is never coarser than the edges along
// it. What has no pixels has the greatest level. Returns how many were asked to be greater.
fn grant(at: u32, to: u32) -> u32 {
    var clamped = 0u;
    for (var k = 0u; k < 6u; k += 1u) {
        let known = select(projected == 0xffffu, whole(digit(EDGE_LINES, k & 3u)), k < EDGES);
        let greatest = patches[at + GREATEST];
        var level = greatest;
        if (known) {
            clamped += u32(less64(I64(greatest, 0u), asked[k]));
            level = bounded(asked[k], at).x;
        }
        if (k >= EDGES) {
            level = max(level, max(out[to + k - EDGES], out[to + k - EDGES + 2u]));
        }
        out[to + k] = level;
    }
    return clamped;
}

@compute @workgroup_size(64)
fn level(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items || fates[4u * item] != 2u) {
        return;
    }
    let at = item * PATCH;
    let to = item * LEVELS;
    let criterion = patches[at + CRITERION];
    var near = 0u;
    var overflows = 0u;
    if (criterion == FIXED) {
        projected = 0xffffu;
        for (var k = 0u; k < 6u; k += 1u) {
            asked[k] = I64(patches[at + NUMBER], 0u);
        }
    } else {
        overflows = project(at);
        measure(criterion == FLATNESS);
        for (var k = 0u; k < EDGES; k += 1u) {
            near += u32(!whole(digit(EDGE_LINES, k)));
        }
        ask(at, criterion == FLATNESS);
    }
    out[to + 6u] = grant(at, to);
    out[to + 7u] = near;
    out[to + 8u] = overflows;
}
