// Connect: the primitives of the tessellator's patterns: an invocation a primitive, of one, two or
// three numbers of points.
//
// A triangle finds its ring, its side and its place there by areas. Between an edge and the inner
// partition, which row a triangle stands on follows from ranks in the ruler's order, found by
// bisection over the places of half an edge; the first implementation has tables of bit strings for
// all pairs of counts, walks them five steps at a time, and closes rings by replacing numbers
// afterwards. Here rows are rings, whose numbers are taken modulo their length.

// A place on a row, given as the distance from its ring's first point.
const INSIDE = 0x8000u;

// A transition's triangle: places passed on the outer and on the inner row, and whether it stands
// on the inner one.
struct Step {
    outer: u32,
    inner: u32,
    on_inner: bool,
}

// How many of the points numbered 1 to n - 1 in the ruler's order are within x 32nds of an edge's
// corner: 1/2; 1/4, 3/4; the odd eighths; and so on.
fn rank(x: u32, n: u32) -> u32 {
    var sum = 0u;
    for (var row = 1u; row <= 16u; row *= 2u) {
        // Points row + j of it stand at (2 j + 1) 16 / row.
        let present = min(max(n, row) - row, row);
        sum += min(present, (x * row / 16u + 1u) / 2u);
    }
    return sum;
}

// Triangle k of half a walk, from the corner to the middle: rows of so many segments of a half, the
// corner's triangle on the outer one.
fn half_step(k: u32, inner_count: u32, outer_count: u32) -> Step {
    let corner = u32(outer_count > 0u);
    if (k < corner) {
        return Step(0u, 0u, false);
    }
    // The first place by which more than k are done.
    var low = 0u;
    var high = 31u;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (rank(middle, inner_count) + rank(middle, outer_count) + corner > k) {
            high = middle;
        } else {
            low = middle;
        }
    }
    let before = rank(low, inner_count);
    let outer_before = rank(low, outer_count) + corner;
    let both = rank(high, inner_count) > before;
    let second = k > before + outer_before;
    return Step(outer_before, before + u32(both && second), both && !second);
}

// The triangle of a transition in terms of its rows' places, counter-clockwise. Rows of so many
// segments, the inner one that of the partition, whose ring has two less.
fn transition(k: u32, inner_count: u32, outer_count: u32) -> vec3<u32> {
    let inner_half = inner_count / 2u;
    let outer_half = outer_count / 2u;
    let steps = inner_half - 1u + outer_half;
    let across = inner_count % 2u + outer_count % 2u;
    var step = Step(outer_half, inner_half - 1u, true);
    if (k < steps) {
        step = half_step(k, inner_half, outer_half);
    } else if (k >= steps + across) {
        // The same from the other corner: what is left there after this one.
        let mirror = half_step(2u * steps + across - 1u - k, inner_half, outer_half);
        step.on_inner = mirror.on_inner;
        step.outer = outer_count - mirror.outer - u32(!mirror.on_inner);
        step.inner = inner_count - 2u - mirror.inner - u32(mirror.on_inner);
    } else if (k > steps || inner_count % 2u == 0u) {
        // On the outer row, across the middle: it begins at the inner one.
        let i = inner_half - 1u + inner_count % 2u;
        return vec3(i | INSIDE, outer_half + 1u, outer_half);
    }
    if (step.on_inner) {
        return vec3(step.inner | INSIDE, (step.inner + 1u) | INSIDE, step.outer);
    }
    return vec3(step.outer, step.inner | INSIDE, step.outer + 1u);
}

// Triangle k of the strip between a side of so many segments, at least 2, and one of two less:
// diagonals lean towards the middle.
fn strip(k: u32, count: u32) -> vec3<u32> {
    let pairs = count - 2u;
    let first = (pairs + 1u) / 2u;
    let pair = k / 2u;
    if (k <= 2u * first) {
        if (k % 2u == 0u) {
            return vec3(pair, pair | INSIDE, pair + 1u);
        }
        return vec3(pair + 1u, pair | INSIDE, (pair + 1u) | INSIDE);
    }
    if (k == 2u * pairs + 1u) {
        return vec3(pairs + 1u, pairs | INSIDE, pairs + 2u);
    }
    let i = (k - 1u) / 2u;
    if (k % 2u == 1u) {
        return vec3(i | INSIDE, i + 2u, i + 1u);
    }
    return vec3(i | INSIDE, (i + 1u) | INSIDE, i + 2u);
}

// The number of a point so many places along a ring, which may be a line: there and back again.
fn number_on(at: u32, ring: u32, place: u32) -> u32 {
    let first = first_of(at, ring);
    let v = inner(at, 0u, ring);
    let u = inner(at, 1u, ring);
    if (v == 0u || u == 0u) {
        let length = select(max(v, u), 0u, settings.a == TRI);
        return first + min(place, 2u * length - place);
    }
    let count = select(2u * (v + u), 3u * v, settings.a == TRI);
    return first + place % count;
}

fn corner(at: u32, ring: u32, outer: u32, inside: u32, place: u32) -> u32 {
    if (place >= INSIDE) {
        return number_on(at, ring + 1u, inside + (place & ~INSIDE));
    }
    if (ring == 0u) {
        return (outer + place) % on_edges(at);
    }
    return number_on(at, ring, outer + place);
}

// The strip inside an odd axis' last ring.
fn centre(at: u32, ring: u32, k: u32) -> vec3<u32> {
    let first = first_of(at, ring);
    if (settings.a == TRI) {
        return vec3(first, first + 2u, first + 1u);
    }
    let tall = inner(at, 0u, ring);
    let wide = inner(at, 1u, ring);
    let end = first + 2u * (tall + wide);
    let j = k / 2u;
    let odd = k % 2u == 1u;
    if (wide > tall) {
        // From the left: the upper side begins at the first point, the lower at the second.
        let upper = select(end - j, first, j == 0u);
        if (odd) {
            return vec3(upper, end - j - 1u, first + j + 2u);
        }
        return vec3(upper, first + j + 2u, first + j + 1u);
    }
    let a = first + j;
    let c = end - 1u - j;
    let middle = tall % 2u == 1u && j == tall / 2u;
    if (tall % 2u == 0u) {
        return select(vec3(c, a + 1u, a), vec3(c, c - 1u, a + 1u), odd);
    }
    if (middle) {
        return select(vec3(a, c, c - 1u), vec3(a, c - 1u, a + 1u), odd);
    }
    return select(vec3(a, c, a + 1u), vec3(c, c - 1u, a + 1u), odd);
}

// A triangle inside the first ring.
fn inside_triangle(at: u32, number: u32) -> vec3<u32> {
    let left = triangles_from(at, 1u) - number;
    var low = 1u;
    var high = (min(inner(at, 0u, 0u), inner(at, 1u, 0u)) + 1u) / 2u;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (triangles_from(at, middle) >= left) {
            low = middle;
        } else {
            high = middle;
        }
    }
    var k = triangles_from(at, low) - left;
    if (inner(at, 0u, low) == 1u || inner(at, 1u, low) == 1u) {
        return centre(at, low, k);
    }
    var side = 0u;
    var outer = 0u;
    var inside = 0u;
    while (side < 3u && k >= 2u * (inner(at, side, low) - 1u)) {
        k -= 2u * (inner(at, side, low) - 1u);
        outer += inner(at, side, low);
        inside += inner(at, side, low) - 2u;
        side += 1u;
    }
    let t = strip(k, inner(at, side, low));
    return corners(at, low, outer, inside, t);
}

fn corners(at: u32, ring: u32, outer: u32, inside: u32, places: vec3<u32>) -> vec3<u32> {
    var numbers = vec3<u32>();
    for (var k = 0u; k < 3u; k += 1u) {
        numbers[k] = corner(at, ring, outer, inside, places[k]);
    }
    return numbers;
}

// Counter-clockwise.
fn triangle(at: u32, number: u32) -> vec3<u32> {
    if (patterns[at] == LEAST_ONE) {
        if (settings.a == TRI) {
            return vec3(0u, 2u, 1u);
        }
        return select(vec3(0u, 3u, 1u), vec3(1u, 3u, 2u), number == 1u);
    }
    var k = number;
    var outer = 0u;
    var inside = 0u;
    for (var side = 0u; side < edges_of(settings.a); side += 1u) {
        let count = inner(at, side, 1u) + segments(at, side);
        if (k < count) {
            let t = transition(k, inner(at, side, 0u), segments(at, side));
            return corners(at, 0u, outer, inside, t);
        }
        k -= count;
        outer += segments(at, side);
        inside += inner(at, side, 1u);
    }
    return inside_triangle(at, k);
}

@compute @workgroup_size(64)
fn connect(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let number = settings.first + item;
    let patch_number = owner(number, 0u, settings.d);
    let at = patch_number * PATTERN;
    let k = number - starts[patch_number];
    if (settings.c == POINT) {
        out[item] = k;
        return;
    }
    if (settings.c == LINE) {
        // Of isolines, the last point of each begins no line.
        let skipped = select(0u, k / max(segments(at, 1u), 1u), settings.a == ISOLINE);
        out[2u * item] = k + skipped;
        out[2u * item + 1u] = k + skipped + 1u;
        return;
    }
    let t = triangle(at, k);
    out[3u * item] = t.x;
    out[3u * item + 1u] = select(t.y, t.z, settings.c == CLOCKWISE);
    out[3u * item + 2u] = select(t.z, t.y, settings.c == CLOCKWISE);
}
