// Place: levels or dyadic lists in, a patch's plan out: segments, reciprocals, and what its
// vertices and triangles cost (Moreton 2001 by way of Munkberg et al. 2008, section 2; Sfarti et
// al. 2005, section 6). No list is written out: an entry's parameter has a closed form where it is
// needed. The counts are formulas too; the first implementation counts what it does.

// a: 1 where lists are masks, 0 where they are levels. b: 1 where the interior takes the greater
// level of the two edges along it, whatever it was given.
@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
@group(0) @binding(2) var<storage, read_write> fates: array<u32>;
// LEVEL_WORDS or LIST_WORDS a patch.
@group(0) @binding(3) var<storage, read_write> levels: array<u32>;
// Components of the attributes of a vertex, a word a patch.
@group(0) @binding(4) var<storage, read_write> components: array<u32>;
@group(0) @binding(5) var<storage, read_write> plans: array<u32>;

const LEVEL_WORDS = 12u;
const LIST_WORDS = 28u;
// Triangles of a strip of a zipper, at most.
const ZIPPER_MAX = 64u;

// floor(2^48 / level) of a level above 1, which is below 2^32: by long division, of whose quotient
// the first bit stands 32 below the numerator's. Only so many bits of it are kept.
fn reciprocal(level: u32) -> u32 {
    var quotient = 0u;
    var rest = 1u;
    for (var bit = 0u; bit < 48u; bit += 1u) {
        rest <<= 1u;
        let goes = rest >= level;
        rest -= select(0u, level, goes);
        quotient = (quotient << 1u) | u32(goes);
    }
    return quotient & (~0u << (32u - settings.reciprocal_bits));
}

fn segments_of(level: u32) -> u32 {
    if (level < TWO) {
        return select(3u, 1u, level == ONE);
    }
    return 2u * ((level + TWO - 1u) / TWO);
}

fn place_levels(plan: u32, at: u32) {
    var most = 0u;
    let given = select(6u, 4u, settings.b != 0u);
    for (var list = 0u; list < given; list += 1u) {
        most = max(most, levels[at + list]);
    }
    var divided = 0u;
    for (var list = 0u; list < 6u; list += 1u) {
        var level = levels[at + list];
        if (list >= 4u) {
            if (settings.b != 0u) {
                level = max(levels[at + list - 4u], levels[at + list - 2u]);
            }
            // So that no direction leaves level 1 alone.
            level = max(level, min(most, TWO));
        }
        plans[plan + LISTS + 4u * list] = level;
        plans[plan + LISTS + 4u * list + 1u] = reciprocal(level);
        plans[plan + SEGMENTS + list] = segments_of(level);
        var distinct = u32(level > ONE);
        for (var other = 0u; other < list; other += 1u) {
            distinct &= u32(plans[plan + LISTS + 4u * other] != level);
        }
        divided += distinct;
    }
    plans[plan + RECIPROCALS] = divided;
}

fn place_masks(plan: u32, at: u32) {
    for (var list = 0u; list < 6u; list += 1u) {
        var inner = 0u;
        for (var k = 0u; k < 4u; k += 1u) {
            let part = levels[at + 4u * list + k] & select(~0u, ~1u, k == 0u);
            plans[plan + LISTS + 4u * list + k] = part;
            inner += countOneBits(part);
        }
        plans[plan + SEGMENTS + list] = inner + 1u;
    }
}

// Half-runs and steps (of differences or of curve points) of one curve.
fn cost_of(segments: u32, differences: bool) -> vec2<u32> {
    if (!differences) {
        return vec2<u32>(0u, segments - 1u);
    }
    if (segments < 3u) {
        return vec2<u32>(0u, 0u);
    }
    return vec2<u32>(2u, select(segments - 2u, 2u, segments == 3u));
}

// Strips of the sides: between halves, and across centres.
fn strips_of_halves(plan: u32, columns: u32, rows: u32) -> u32 {
    var strips = 0u;
    for (var side = 0u; side < 4u; side += 1u) {
        let segments = plans[plan + SEGMENTS + side];
        let along = select(columns, rows, (side & 1u) != 0u);
        let inner = select((along - 1u) / 2u, 0u, plans[plan + SEGMENTS + 4u] == 3u);
        strips += select(0u, 2u, segments / 2u + inner > 0u) + (segments & 1u);
    }
    return strips;
}

// Strips of the sides between dyadic lists.
fn strips_of_zippers(plan: u32, columns: u32, rows: u32) -> u32 {
    var strips = 0u;
    for (var side = 0u; side < 4u; side += 1u) {
        let along = select(columns, rows, (side & 1u) != 0u);
        let triangles = plans[plan + SEGMENTS + side] + along - 1u;
        strips += (triangles + ZIPPER_MAX - 1u) / ZIPPER_MAX;
    }
    return strips;
}

fn strips_of(plan: u32, triangles: u32) -> u32 {
    let columns = plans[plan + COLUMNS];
    let rows = plans[plan + ROWS];
    if (columns == 0u) {
        return (triangles + ZIPPER_MAX - 1u) / ZIPPER_MAX;
    }
    let grid = select(rows - 1u, 0u, columns < 2u);
    if (settings.a != 0u) {
        return grid + strips_of_zippers(plan, columns, rows);
    }
    return grid + strips_of_halves(plan, columns, rows);
}

fn count(plan: u32, item: u32) {
    var boundary = 0u;
    var cost = vec2<u32>(0u, 0u);
    let differences = settings.scheme < 2u && settings.a == 0u;
    for (var edge = 0u; edge < 4u; edge += 1u) {
        let segments = plans[plan + SEGMENTS + edge];
        boundary += segments;
        cost += cost_of(segments, differences);
    }
    let u = plans[plan + SEGMENTS + 4u];
    let v = plans[plan + SEGMENTS + 5u];
    let has_interior = u > 1u && v > 1u;
    let columns = select(0u, u - 1u, has_interior);
    let rows = select(0u, v - 1u, has_interior);
    if (has_interior) {
        let inside = settings.scheme == 0u && settings.a == 0u;
        cost += 4u * cost_of(v, inside) + rows * cost_of(u, inside);
    }
    let vertices = boundary + columns * rows;
    let triangles = 2u * vertices - boundary - 2u;
    plans[plan + KEPT] = 1u;
    plans[plan + PARAMETERS] = boundary + columns + rows;
    plans[plan + INVOCATIONS] = vertices + 4u * rows;
    plans[plan + VERTICES] = vertices;
    plans[plan + CURVES] = cost.x;
    plans[plan + STEPS] = cost.y;
    plans[plan + ATTRIBUTES] = vertices * components[item];
    plans[plan + TRIANGLES] = triangles;
    plans[plan + LINES] = select(4u, 8u + rows, has_interior);
    plans[plan + BOUNDARY] = boundary;
    plans[plan + COLUMNS] = columns;
    plans[plan + ROWS] = rows;
    plans[plan + STRIPS] = strips_of(plan, triangles);
}

// What the blocks before said of the patch.
fn count_events(plan: u32, item: u32, at: u32) {
    let criterion = patches[item * PATCH + CRITERION];
    plans[plan + FLATNESS] = u32(criterion == 0u);
    plans[plan + EDGE_LENGTH] = u32(criterion == 1u);
    for (var k = 0u; k < 4u; k += 1u) {
        plans[plan + EVENTS + k] = levels[at + k];
    }
}

@compute @workgroup_size(64)
fn place(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let plan = item * PLAN;
    for (var k = 0u; k < PLAN; k += 1u) {
        plans[plan + k] = 0u;
    }
    let fate = fates[4u * item];
    plans[plan + CLIPPED] = u32(fate == 0u);
    plans[plan + CULLED] = u32(fate == 1u);
    plans[plan + TESTED] = fates[4u * item + 1u];
    plans[plan + FACETS] = fates[4u * item + 2u];
    if (fate != 2u) {
        return;
    }
    if (settings.a != 0u) {
        place_masks(plan, item * LIST_WORDS);
        count_events(plan, item, item * LIST_WORDS + 24u);
    } else {
        place_levels(plan, item * LEVEL_WORDS);
        count_events(plan, item, item * LEVEL_WORDS + 6u);
    }
    count(plan, item);
}
