// Clip: patches wholly outside one plane of the clip volume go no further (Sfarti et al. 2005,
// section 3). Plane by plane, and by the distance of each point from the plane; the first
// implementation takes point by point, and comparisons.

@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
// A patch's fate, in four words: 0 clipped, 1 culled, 2 kept; whether it was tested by backface;
// what that looked at; the planes that all its points are outside of.
@group(0) @binding(2) var<storage, read_write> fates: array<u32>;

fn coordinate(patch_at: u32, point: u32, axis: u32) -> I64 {
    let at = patch_at + 8u * point + 2u * axis;
    return I64(patches[at], patches[at + 1u]);
}

// How far inside a plane a point is: x + w, w - x, y + w, w - y, z or z + w, w - z.
fn inside(patch_at: u32, point: u32, plane: u32) -> I64 {
    let c = coordinate(patch_at, point, plane / 2u);
    let w = coordinate(patch_at, point, 3u);
    if ((plane & 1u) != 0u) {
        return sub64(w, c);
    }
    if (plane == 4u && settings.depth == 0u) {
        return c;
    }
    return add64(w, c);
}

@compute @workgroup_size(64)
fn clip(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    var planes = 0u;
    for (var plane = 0u; plane < 6u; plane += 1u) {
        var outside = 1u;
        for (var point = 0u; point < 16u; point += 1u) {
            outside &= u32(is_negative64(inside(item * PATCH, point, plane)));
        }
        planes |= outside << plane;
    }
    fates[4u * item] = select(2u, 0u, settings.clip != 0u && planes != 0u);
    fates[4u * item + 1u] = 0u;
    fates[4u * item + 2u] = 0u;
    fates[4u * item + 3u] = planes;
}
