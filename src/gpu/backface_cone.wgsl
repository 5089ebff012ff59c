// Backface by a cone around the points and one around the normals; behind backface.wgsl.
//
// An invocation takes a direction. The result depends on the roundings, which are those of the
// first implementation; but the widest direction is the least of quotients, each divided bit by
// bit, where that multiplies across and divides once.

// Two axes, 16 points, 36 coefficients of Su x Sv.
const LOOKED_AT = 53u;
const DIRECTIONS = 52u;
const POINTS = 16u;
// Bits of the largest component of a direction and of an axis, and of a cosine's fraction.
const DIRECTION_BITS = 20u;
const AXIS_BITS = 12u;
const COSINE_BITS = 20u;

var<workgroup> directions: array<vec3<i32>, 52>;
// Of the points, of the normals.
var<workgroup> axes: array<vec3<i32>, 2>;
// Squares of cosines, with 40 bits of fraction.
var<workgroup> squares: array<I64, 52>;
var<workgroup> some_normal: u32;

// A direction shifted until its largest component has so many bits: 0 stays 0.
fn normalised(x: I128, y: I128, w: I128, bits: u32) -> vec3<i32> {
    let has = bits128(max128(max128(abs128(x), abs128(y)), abs128(w)));
    let down = max(has, bits) - bits;
    let up = bits - min(has, bits);
    let low = vec3<u32>(sar128(x, down).x, sar128(y, down).x, sar128(w, down).x);
    return select(bitcast<vec3<i32>>(low << vec3<u32>(up)), vec3<i32>(0), has == 0u);
}

fn dot64(a: vec3<i32>, b: vec3<i32>) -> I64 {
    var sum = NONE64;
    for (var k = 0u; k < 3u; k += 1u) {
        sum = add64(sum, mul64(word(a[k]), word(b[k])));
    }
    return sum;
}

fn direction(lane: u32) -> vec3<i32> {
    var at: array<I128, 3>;
    for (var axis = 0u; axis < 3u; axis += 1u) {
        if (lane < POINTS) {
            at[axis] = wide(rows[3u * lane + axis]);
        } else {
            let k = lane - POINTS;
            at[axis] = crossed(SU, SV, k / 6u, k % 6u, axis);
        }
    }
    return normalised(at[0], at[1], at[2], DIRECTION_BITS);
}

// The sum of the directions of a cone, of 12 bits.
fn make_axis(cone: u32) {
    var sum = vec3<i32>(0);
    var some = false;
    let end = select(DIRECTIONS, POINTS, cone == 0u);
    for (var k = select(POINTS, 0u, cone == 0u); k < end; k += 1u) {
        sum += directions[k];
        some = some || any(directions[k] != vec3<i32>(0));
    }
    axes[cone] = normalised(wide(word(sum.x)), wide(word(sum.y)), wide(word(sum.z)), AXIS_BITS);
    if (cone == 1u) {
        some_normal = u32(some);
    }
}

// The cosine of no angle at all, squared.
fn straight() -> I64 {
    return shl64(I64(1u, 0u), 2u * COSINE_BITS);
}

// The square of a lower bound of the cosine between a direction and its axis; above 1 where there
// is none. The shift of a direction cut off less than 1 of each component.
fn cosine_squared(lane: u32) -> I64 {
    let axis = axes[u32(lane >= POINTS)];
    let toward = directions[lane];
    let one = straight();
    if (all(toward == vec3<i32>(0))) {
        return one;
    }
    let cut = dot64(abs(axis), vec3<i32>(1));
    let along = sub64(dot64(axis, toward), cut);
    if (is_negative64(along) || is_zero64(along)) {
        return add64(one, I64(1u, 0u));
    }
    let longer = abs(toward) + vec3<i32>(1);
    let square = shl128(mul_unsigned(along, along), 2u * COSINE_BITS);
    let lengths = mul_unsigned(dot64(axis, axis), dot64(longer, longer));
    // An axis is in its own cone.
    let ratio = divide_unsigned(square, lengths).value;
    return select(one, ratio.xy, below128(ratio, wide(one)));
}

// Whether both cones together stay 90 degrees or more apart.
fn apart() -> bool {
    let one = straight();
    // Rounded down and up.
    var cosines = array<u32, 2>();
    var sines = array<u32, 2>();
    for (var cone = 0u; cone < 2u; cone += 1u) {
        var least = one;
        let end = select(DIRECTIONS, POINTS, cone == 0u);
        for (var k = select(POINTS, 0u, cone == 0u); k < end; k += 1u) {
            least = select(least, squares[k], below64(squares[k], least));
        }
        let cosine = root_up(wide(add64(least, I64(1u, 0u)))).x - 1u;
        let square = mul_words(cosine, cosine);
        cosines[cone] = cosine;
        sines[cone] = root_up(wide(sub64(one, square))).x;
    }
    // Together more than 90 degrees.
    if (cosines[0] < sines[1]) {
        return false;
    }
    let sum = add64(mul_words(sines[0], cosines[1]), mul_words(cosines[0], sines[1]));
    let lengths = mul64(dot64(axes[0], axes[0]), dot64(axes[1], axes[1]));
    let least = mul_unsigned(root_up(wide(lengths)), sum);
    let along = abs64(dot64(axes[0], axes[1]));
    return !below128(shl128(wide(along), 2u * COSINE_BITS), least);
}

@compute @workgroup_size(64)
fn normal_cone(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = group.x + group.y * groups.x;
    if (item * LANES >= settings.items || !begins(item, lane)) {
        return;
    }
    make_factors(lane);
    if (lane < DIRECTIONS) {
        directions[lane] = direction(lane);
    }
    workgroupBarrier();
    if (lane < 2u) {
        make_axis(lane);
    }
    workgroupBarrier();
    // A curve or a point has no normal: nothing to see.
    let some = some_normal != 0u;
    let towards = !is_negative64(dot64(axes[0], axes[1]));
    if (some && towards && lane == 0u) {
        atomicMin(&kept_by, 1u);
    }
    if (some && !towards && lane < DIRECTIONS) {
        let square = cosine_squared(lane);
        squares[lane] = square;
        if (below64(straight(), square)) {
            atomicMin(&kept_by, lane + 2u);
        }
    }
    if (!decided(lane) && lane == 0u && some && !apart()) {
        atomicMin(&kept_by, LOOKED_AT);
    }
    ends(item, lane, LOOKED_AT);
}
