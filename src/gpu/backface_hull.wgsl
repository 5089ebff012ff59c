// Backface by the facets of the hull, taken at their word; behind backface.wgsl.
//
// The first implementation makes the plane of each triple and takes the points' distances from it.
// Here the determinants of all triples of points are made once: a point's side of a plane is the
// sum of four of them, and the viewer's is one alone.

// Triples of 16 points, and words of a determinant: 3 * 48 + 3 bits.
const TRIPLES = 560u;
const STORED = 5u;

var<workgroup> volumes: array<u32, 2800>;

fn pairs(n: u32) -> u32 {
    return n * (n - 1u) / 2u;
}

fn triples(n: u32) -> u32 {
    return n * (n - 1u) * (n - 2u) / 6u;
}

// The number of i < j < k in the order of k, then j, then i: no end of that order matters.
fn place(i: u32, j: u32, k: u32) -> u32 {
    return triples(k) + pairs(j) + i;
}

// The triple at that place.
fn triple(at: u32) -> vec3<u32> {
    var t = vec3<u32>(0u, 1u, 2u);
    while (t.z < 15u && triples(t.z + 1u) <= at) {
        t.z += 1u;
    }
    let rest = at - triples(t.z);
    while (t.y < 14u && pairs(t.y + 1u) <= rest) {
        t.y += 1u;
    }
    t.x = rest - pairs(t.y);
    return t;
}

fn stored(at: u32) -> I256 {
    let first = STORED * at;
    let low = I128(
        volumes[first],
        volumes[first + 1u],
        volumes[first + 2u],
        volumes[first + 3u],
    );
    let high = volumes[first + 4u];
    let sign = bitcast<u32>(bitcast<i32>(high) >> 31u);
    return I256(low, I128(high, sign, sign, sign));
}

// det[X, Y, P] for x < y and any other p.
fn volume_with(x: u32, y: u32, p: u32) -> I256 {
    if (p < x) {
        return stored(place(p, x, y));
    }
    if (p < y) {
        return neg256(stored(place(x, p, y)));
    }
    return stored(place(x, y, p));
}

// Whether no point is on the viewer's side of the plane of t, and the viewer not in it.
fn faces(t: vec3<u32>, own: I256) -> bool {
    // The viewer's side has the sign of -own.
    if (is_zero256(own)) {
        return false;
    }
    for (var p = 0u; p < 16u; p += 1u) {
        if (any(vec3<u32>(p) == t)) {
            continue;
        }
        // det[J - I, K - I, P - I]
        var side = sub256(volume_with(t.y, t.z, p), volume_with(t.x, t.z, p));
        side = sub256(add256(side, volume_with(t.x, t.y, p)), own);
        if (!is_zero256(side) && is_negative256(side) != is_negative256(own)) {
            return false;
        }
    }
    return true;
}

@compute @workgroup_size(64)
fn hull_literal(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = group.x + group.y * groups.x;
    if (item * LANES >= settings.items || !begins(item, lane)) {
        return;
    }
    for (var at = lane; at < TRIPLES; at += LANES) {
        let t = triple(at);
        let own = volume(t.x, t.y, t.z);
        for (var k = 0u; k < 4u; k += 1u) {
            volumes[STORED * at + k] = own.lo[k];
        }
        volumes[STORED * at + 4u] = own.hi.x;
    }
    workgroupBarrier();
    for (var at = lane; at < TRIPLES; at += LANES) {
        let t = triple(at);
        if (faces(t, stored(at))) {
            // In the order of i, then j, then k, from 1.
            let before = TRIPLES - triples(16u - t.x) + pairs(15u - t.x) - pairs(16u - t.y);
            atomicMin(&kept_by, before + t.z - t.y);
        }
    }
    ends(item, lane, TRIPLES);
}
