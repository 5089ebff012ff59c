// What the surface-level shader's invocations cost: mesh and decisions in, counts of a patch out.
// One invocation a patch walks through its sections, as what a point costs depends on what the
// same section has seen before. And triangles with equal positions, and greatest counts.
//
// A dispatch takes few sections, and rows are summed in blocks: a driver may end an invocation's
// loops after 65,535 iterations in all without a word (llvmpipe does).
//
// Own words that differ here: `count` takes sections from a to b.

// A word a crossing: the last scope that saw it.
@group(0) @binding(3) var<storage, read_write> stamps: array<u32>;
// The section of strip k of a coarse triangle at 16 times that, and k - 1.
@group(0) @binding(4) var<storage, read_write> sections: array<u32>;
// Components of a vertex's attributes, a word a patch.
@group(0) @binding(5) var<storage, read_write> components: array<u32>;
@group(0) @binding(6) var<storage, read_write> strips: array<u32>;
@group(0) @binding(7) var<storage, read_write> costs: array<u32>;

@group(0) @binding(1) var<storage, read_write> vertices: array<u32>;
@group(0) @binding(2) var<storage, read_write> corners: array<u32>;
@group(0) @binding(3) var<storage, read_write> first_vertices: array<u32>;
@group(0) @binding(4) var<storage, read_write> first_triangles: array<u32>;
@group(0) @binding(5) var<storage, read_write> equals: array<u32>;

@group(0) @binding(1) var<storage, read_write> rows: array<u32>;
@group(0) @binding(2) var<storage, read_write> peaks: array<u32>;

// Words of a patch's counts, and where each stands.
const COST = 16u;
const NETS = 0u;
const OBJECT_NETS = 1u;
const TESTS = 2u;
const INSERTED = 3u;
const KINDS = 4u; // corners, boundary, coarse, inside
const TESTED = 8u;
const TESTED_BOUNDARY = 9u;
const BUFFER = 10u;
const MOVED = 11u;
const LEAVE = 12u;
const ATTRIBUTES = 13u;
const LANES = 14u; // components of a patch that is kept
const SCOPE = 15u; // the last one, while dispatches go on

// Rows that are folded into one.
const BLOCK = 1024u;

const REUSE_NONE = 0u;
const REUSE_TRIANGLE = 1u;
const REUSE_PATCH = 2u;
const TESTS_APART = 2u;

var<private> made: array<u32, 16>;
var<private> scope: u32;
var<private> levels: Levels;
var<private> segments: u32;
var<private> at_patch: u32;
// Coarse edges that the scope has tested, by bit.
var<private> tested: array<u32, 2>;

fn is_new(place: vec2<u32>) -> bool {
    let at = CROSSINGS * at_patch + LINES * place.y + place.x;
    let before = stamps[at];
    stamps[at] = scope;
    return before != scope;
}

fn section_of(triangle: u32, row: u32) -> u32 {
    return sections[16u * triangle + (row * settings.p + segments - 1u) / segments - 1u];
}

// The tests of a coarse triangle's edges that the scope has not made yet.
fn test_edges(triangle: u32) {
    let edges = edges_of(triangle);
    for (var k = 0u; k < 3u; k += 1u) {
        let edge = edges[k];
        if ((tested[edge / 32u] >> (edge % 32u) & 1u) == 0u) {
            made[TESTS] += level_of(coarse_edge(edge), levels);
            let mask = decisions[DECISION * (COARSE_EDGES * at_patch + edge)];
            made[INSERTED] += countOneBits(mask);
            tested[edge / 32u] |= 1u << (edge % 32u);
        }
    }
}

// The points of the strips above rows `first` to `last`.
fn join(triangle: u32, first: u32, last: u32) {
    let insertion = insertion_of(at_patch, triangle, segments);
    for (var row = first; row <= last; row += 1u) {
        if (!has_row(insertion, row)) {
            continue;
        }
        let upper = row_above(insertion, row);
        for (var k = 0u; k < 2u * row - 1u; k += 1u) {
            var three = slot_of(insertion, upper, row, k);
            if (is_dropped(three)) {
                continue;
            }
            for (var corner = 0u; corner < 3u; corner += 1u) {
                let place = crossing_of(triangle, three[corner], segments);
                if (is_new(place) && settings.k != REUSE_NONE) {
                    made[KINDS + kind_of(place, segments)] += 1u;
                }
            }
        }
    }
}

// What the tests of a coarse edge evaluated and the mesh did not get.
fn settle_edge(number: u32) {
    let edge = coarse_edge(number);
    let level = level_of(edge, levels);
    if ((tested[number / 32u] >> (number % 32u) & 1u) == 0u || level == 0u) {
        return;
    }
    if (settings.k == REUSE_NONE) {
        scope += 1u;
    }
    // Candidates, and with chords the ends.
    let ends = select(0u, 2u, settings.i != 0u);
    for (var k = 1u; k <= level + ends; k += 1u) {
        var position = (k - level - 1u) * segments;
        if (k <= level) {
            position = slot(k, level, levels.interior);
        }
        let place = crossing(edge, position, segments);
        let kind = kind_of(place, segments);
        if (kind != CORNER && is_new(place)) {
            made[TESTED] += 1u;
            made[TESTED_BOUNDARY] += u32(kind == BOUNDARY);
        }
    }
}

// The same of all edges that the scope tested: those of a coarse triangle, or any.
fn settle(triangle: u32) {
    if (settings.f == TESTS_APART) {
        scope += 1u;
    }
    let edges = edges_of(triangle);
    let whole = settings.k == REUSE_PATCH;
    for (var n = 0u; n < select(3u, COARSE_EDGES, whole); n += 1u) {
        var number = n;
        if (!whole) {
            number = edges[n];
        }
        settle_edge(number);
    }
}

// Distinct places of the uniform pattern that the strips of a section have.
fn places_of(section: u32) -> u32 {
    scope += 1u;
    var places = 0u;
    for (var triangle = 0u; triangle < COARSE_TRIANGLES; triangle += 1u) {
        for (var row = 1u; row <= segments; row += 1u) {
            if (section_of(triangle, row) != section) {
                continue;
            }
            for (var n = 0u; n < 2u * row + 1u; n += 1u) {
                let site = select(vec2(row - 1u, n - row - 1u), vec2(row, n), n <= row);
                places += u32(is_new(crossing_of(triangle, site, segments)));
            }
        }
    }
    return places;
}

// A coarse triangle's rows of one section.
fn take_part(triangle: u32, first: u32, last: u32) {
    if (settings.k != REUSE_PATCH) {
        tested = array<u32, 2>(0u, 0u);
        scope += 1u;
    }
    if (settings.f != 0u) {
        test_edges(triangle);
    }
    join(triangle, first, last);
    if (settings.k == REUSE_TRIANGLE) {
        // Sites of rows first - 1 to last.
        let held = ((last + 1u) * (last + 2u) - first * (first - 1u)) / 2u;
        made[BUFFER] = max(made[BUFFER], held);
    }
    if (settings.k != REUSE_PATCH) {
        settle(triangle);
    }
}

// Ends a section, and begins the next.
fn close(section: u32) {
    if (section == COARSE_TRIANGLES * 16u) {
        return;
    }
    made[NETS] += 1u;
    made[OBJECT_NETS] += u32(settings.f == TESTS_APART);
    if (settings.k == REUSE_PATCH) {
        settle(0u);
        made[BUFFER] = max(made[BUFFER], places_of(section));
    }
    tested = array<u32, 2>(0u, 0u);
    scope += 1u;
}

fn take_sections() {
    var open = COARSE_TRIANGLES * 16u; // none
    for (var triangle = 0u; triangle < COARSE_TRIANGLES; triangle += 1u) {
        var first = 1u;
        while (first <= segments) {
            let section = section_of(triangle, first);
            var last = first;
            while (last < segments && section_of(triangle, last + 1u) == section) {
                last += 1u;
            }
            if (section >= settings.a && section < settings.b) {
                if (section != open) {
                    close(open);
                    open = section;
                }
                take_part(triangle, first, last);
            }
            first = last + 1u;
        }
    }
    close(open);
}

// Inserted candidates that do not stand where the slot that carries them is.
fn count_moved() {
    for (var number = 0u; number < COARSE_EDGES; number += 1u) {
        let level = level_of(coarse_edge(number), levels);
        let mask = decisions[DECISION * (COARSE_EDGES * at_patch + number)];
        for (var k = 1u; k <= level; k += 1u) {
            let carrier = slot(k, level, levels.interior);
            let elsewhere = k * segments != carrier * (level + 1u);
            made[MOVED] += u32(elsewhere && (mask >> carrier & 1u) != 0u);
        }
    }
}

// Whether the patch goes further; and its levels.
fn load(item: u32) -> bool {
    let at = RESOLUTION * item;
    let edges = vec4(
        resolutions[at], resolutions[at + 1u], resolutions[at + 2u], resolutions[at + 3u]
    );
    levels = Levels(edges, resolutions[at + INTERIOR]);
    at_patch = item;
    segments = levels.interior + 1u;
    return levels.interior != SKIPPED;
}

@compute @workgroup_size(64)
fn count(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items || !load(item)) {
        return;
    }
    for (var k = 0u; k < COST; k += 1u) {
        made[k] = costs[COST * item + k];
    }
    scope = made[SCOPE] + 1u;
    take_sections();
    made[SCOPE] = scope;
    for (var k = 0u; k < COST; k += 1u) {
        costs[COST * item + k] = made[k];
    }
}

// What needs no section.
@compute @workgroup_size(64)
fn sum_up(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items || !load(item)) {
        return;
    }
    count_moved();
    let to = COST * item;
    var listed = 0u;
    for (var triangle = 0u; triangle < COARSE_TRIANGLES; triangle += 1u) {
        let row = WALK * (COARSE_TRIANGLES * item + triangle);
        listed += strips[row + 3u];
        for (var k = 0u; k < 4u && settings.k == REUSE_NONE; k += 1u) {
            costs[to + KINDS + k] += strips[row + 4u + k];
        }
    }
    let at = to + KINDS;
    let points = costs[at] + costs[at + 1u] + costs[at + 2u] + costs[at + 3u];
    let leave = select(points, listed, settings.k == REUSE_NONE);
    costs[to + MOVED] = made[MOVED];
    costs[to + LEAVE] = leave;
    costs[to + ATTRIBUTES] = leave * components[item];
    costs[to + LANES] = components[item];
}

fn is_same(a: u32, b: u32) -> bool {
    var same = true;
    for (var k = 0u; k < 8u; k += 1u) {
        same = same && vertices[VERTEX * a + k] == vertices[VERTEX * b + k];
    }
    return same;
}

// Triangles of a coarse triangle with two equal positions.
@compute @workgroup_size(64)
fn degenerate(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let first = first_vertices[item / COARSE_TRIANGLES * COARSE_TRIANGLES];
    var sum = 0u;
    for (var n = first_triangles[item]; n < first_triangles[item + 1u]; n += 1u) {
        let a = first + corners[3u * n];
        let b = first + corners[3u * n + 1u];
        let c = first + corners[3u * n + 2u];
        sum += u32(is_same(a, b) || is_same(b, c) || is_same(c, a));
    }
    equals[item] = sum;
}

// The greatest of column `settings.c` of `settings.a` rows of `settings.b` words.
@compute @workgroup_size(64)
fn peak(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x > 0u) {
        return;
    }
    var most = 0u;
    for (var row = 0u; row < settings.a; row += 1u) {
        most = max(most, rows[settings.b * row + settings.c]);
    }
    peaks[0] = most;
}

// Sums of a column over a block of rows; so a common sum has few rows. Of each of `settings.a` rows
// of `settings.b` words.
@compute @workgroup_size(64)
fn fold(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let first = item / settings.b * BLOCK;
    var sum = 0u;
    for (var row = first; row < min(first + BLOCK, settings.a); row += 1u) {
        sum += rows[settings.b * row + item % settings.b];
    }
    peaks[item] = sum;
}
