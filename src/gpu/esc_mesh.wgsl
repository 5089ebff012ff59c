// The mesh of the surface-level shader: decisions in, triangles and the places of vertices out, in
// the order in which the first implementation's single walk meets them. Here coarse triangles go
// side by side: a vertex belongs to the first of them that has it, where it gets its number by
// first use; sums over coarse triangles make that a number of the patch's. A strip's slot k is a
// function of k: nothing is carried along a row, and what stands in for a missing vertex is
// searched outwards.

@group(0) @binding(1) var<storage, read_write> resolutions: array<u32>;
@group(0) @binding(2) var<storage, read_write> decisions: array<u32>;
// A word a crossing, CROSSINGS a patch: 1 and the vertex's owner in 8 bits and number there in 8;
// 0 where there is none.
@group(0) @binding(3) var<storage, read_write> numbers: array<u32>;
// WALK words a coarse triangle: vertices that it owns, triangles, slots, vertices of its strips'
// lists, and of those the ones of each kind.
@group(0) @binding(4) var<storage, read_write> walks: array<u32>;
// Where coarse triangles' vertices and triangles begin.
@group(0) @binding(4) var<storage, read_write> vertex_starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> triangle_starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> sites: array<u32>;
@group(0) @binding(7) var<storage, read_write> triangles: array<u32>;

const WALK = 8u;

@compute @workgroup_size(64)
fn walk(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let at_patch = item / COARSE_TRIANGLES;
    let number = item % COARSE_TRIANGLES;
    let segments = resolutions[RESOLUTION * at_patch + INTERIOR] + 1u;
    if (segments == 0u) {
        return;
    }
    let insertion = insertion_of(at_patch, number, segments);
    var local = 0u;
    var count = 0u;
    var slots = 0u;
    for (var row = 1u; row <= segments; row += 1u) {
        if (!has_row(insertion, row)) {
            continue;
        }
        let upper = row_above(insertion, row);
        slots += 2u * row - 1u;
        for (var k = 0u; k < 2u * row - 1u; k += 1u) {
            var three = slot_of(insertion, upper, row, k);
            if (is_dropped(three)) {
                continue;
            }
            count += 1u;
            for (var corner = 0u; corner < 3u; corner += 1u) {
                let place = crossing_of(number, three[corner], segments);
                let at = CROSSINGS * at_patch + LINES * place.y + place.x;
                if (owner(place, segments) == number && numbers[at] == 0u) {
                    numbers[at] = 1u + (number << 8u | local);
                    local += 1u;
                }
            }
        }
    }
    walks[WALK * item] = local;
    walks[WALK * item + 1u] = count;
    walks[WALK * item + 2u] = slots;
    list_strips(item, insertion);
}

// The vertices of the strips as the paper lists them (section 3): equal neighbours are one, and
// v_i v_j v_k, the last two of one row, becomes v_i v_j v_i v_k.
fn list_strips(item: u32, insertion: Insertion) {
    let number = item % COARSE_TRIANGLES;
    var kinds = vec4(0u);
    for (var row = 1u; row <= insertion.segments; row += 1u) {
        if (!has_row(insertion, row)) {
            continue;
        }
        let upper = row_above(insertion, row);
        // The last two that were listed; no site has this row.
        var before = vec2(99u);
        var last = vec2(99u);
        for (var n = 0u; n <= 2u * row; n += 1u) {
            var site: vec2<u32>;
            if ((n & 1u) == 0u) {
                site = entry(insertion, row, n / 2u);
            } else {
                site = spread(insertion, upper, row, n / 2u);
            }
            if (all(site == last)) {
                continue;
            }
            if (before.x != 99u && last.x == site.x) {
                kinds[kind_of(crossing_of(number, before, insertion.segments),
                    insertion.segments)] += 1u;
                last = before;
            }
            kinds[kind_of(crossing_of(number, site, insertion.segments),
                insertion.segments)] += 1u;
            before = last;
            last = site;
        }
    }
    walks[WALK * item + 3u] = kinds.x + kinds.y + kinds.z + kinds.w;
    for (var k = 0u; k < 4u; k += 1u) {
        walks[WALK * item + 4u + k] = kinds[k];
    }
}

// The same walk again: triangles by their vertices' numbers, and where the vertices are.
@compute @workgroup_size(64)
fn write(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    let at_patch = item / COARSE_TRIANGLES;
    let number = item % COARSE_TRIANGLES;
    let segments = resolutions[RESOLUTION * at_patch + INTERIOR] + 1u;
    if (segments == 0u) {
        return;
    }
    let insertion = insertion_of(at_patch, number, segments);
    let first = vertex_starts[COARSE_TRIANGLES * at_patch];
    var to = 3u * triangle_starts[item];
    for (var row = 1u; row <= segments; row += 1u) {
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
                let place = crossing_of(number, three[corner], segments);
                let named = numbers[CROSSINGS * at_patch + LINES * place.y + place.x] - 1u;
                let of_patch = COARSE_TRIANGLES * at_patch + (named >> 8u);
                let vertex = vertex_starts[of_patch] + (named & 0xffu);
                triangles[to] = vertex - first;
                to += 1u;
                if ((named >> 8u) == number) {
                    sites[2u * vertex] = at_patch;
                    sites[2u * vertex + 1u] = place.y << 16u | place.x;
                }
            }
        }
    }
}
