// Backface: patches that clip left in; which of them no viewer can see from the front, and how many
// facets say so, out. A group of 64 invocations takes one patch, an entry is one test.
//
// The first implementation goes through facets one by one, and mostly decides by estimates. Here
// every facet has an invocation, every number is exact, and the first facet that keeps the patch is
// the least number of one that does:
//   net_facets    det[A, B, C] of the points themselves, not of differences between them;
//   tangent_plane (S x Su) . Sv, coefficient by coefficient, where the first has S . (Su x Sv).
// The other two tests stand in files of their own, behind this one.

@group(0) @binding(1) var<storage, read_write> patches: array<u32>;
@group(0) @binding(2) var<storage, read_write> fates: array<u32>;

const LANES = 64u;
// Of a patch that no facet keeps.
const NEVER = 0xffffffffu;
// Flags of a patch.
const SATURATED = 1u;
const MAY_BE_CULLED = 2u;
const REVERSED = 4u;

// x, y, w of the 16 points, x mirrored where a negative determinant is the front.
var<workgroup> rows: array<I64, 48>;
// The number, from 1, of the first facet known to keep the patch.
var<workgroup> kept_by: atomic<u32>;
var<workgroup> flag: u32;

// Digit k of a table in hexadecimal.
fn digit(table: u32, k: u32) -> u32 {
    return (table >> (4u * k)) & 15u;
}

// Begins a patch; whether it is tested, the same in all invocations.
fn begins(item: u32, lane: u32) -> bool {
    let flags = patches[item * PATCH + FLAGS];
    if (lane == 0u) {
        atomicStore(&kept_by, NEVER);
        let tested = (flags & (SATURATED | MAY_BE_CULLED)) == MAY_BE_CULLED;
        flag = u32(tested && fates[4u * item] != 0u);
    }
    let mirrored = ((flags & REVERSED) != 0u) == (bitcast<i32>(settings.facing) > 0);
    if (lane < 48u) {
        let axis = lane % 3u;
        let at = item * PATCH + 8u * (lane / 3u) + select(2u * axis, 6u, axis == 2u);
        let value = I64(patches[at], patches[at + 1u]);
        rows[lane] = select(value, neg64(value), axis == 0u && mirrored);
    }
    return workgroupUniformLoad(&flag) != 0u;
}

// Whether a facet is known that keeps the patch, the same in all invocations.
fn decided(lane: u32) -> bool {
    workgroupBarrier();
    if (lane == 0u) {
        flag = u32(atomicLoad(&kept_by) != NEVER);
    }
    return workgroupUniformLoad(&flag) != 0u;
}

// Ends a patch whose test has so many facets.
fn ends(item: u32, lane: u32, facets: u32) {
    workgroupBarrier();
    if (lane == 0u) {
        let first = atomicLoad(&kept_by);
        fates[4u * item] = select(2u, 1u, first == NEVER);
        fates[4u * item + 1u] = 1u;
        fates[4u * item + 2u] = min(first, facets);
    }
}

// det[A, B, C] of three points: 3 W + 3 bits.
fn volume(a: u32, b: u32, c: u32) -> I256 {
    var sum = I256(NONE128, NONE128);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let p = (axis + 1u) % 3u;
        let q = (axis + 2u) % 3u;
        let one = mul_signed(rows[3u * b + p], rows[3u * c + q]);
        let other = mul_signed(rows[3u * b + q], rows[3u * c + p]);
        sum = add256(sum, mul_mixed(rows[3u * a + axis], sub128(one, other)));
    }
    return sum;
}

// ---- net_facets

// Two triangles for either diagonal of nine facets.
const TRIANGLES = 36u;
// Corners of a facet round it, and which of them each triangle leaves out.
const CORNERS = 0x4510u;
const LEFT_OUT = 0x0213u;

@compute @workgroup_size(64)
fn net_facets(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = group.x + group.y * groups.x;
    if (item * LANES >= settings.items || !begins(item, lane)) {
        return;
    }
    if (lane < TRIANGLES) {
        let facet = lane / 4u;
        let corner = 4u * (facet / 3u) + facet % 3u;
        var points = vec3<u32>(0u);
        var out = digit(LEFT_OUT, lane % 4u);
        for (var k = 0u; k < 3u; k += 1u) {
            points[k] = corner + digit(CORNERS, k + u32(k >= out));
        }
        if (is_positive256(volume(points[0], points[1], points[2]))) {
            atomicMin(&kept_by, lane + 1u);
        }
    }
    ends(item, lane, TRIANGLES);
}

// ---- nets of coefficients with their binomials multiplied in

struct Net {
    // Its first coefficient in `factors`.
    first: u32,
    rows: u32,
    columns: u32,
}

const S = Net(0u, 4u, 4u);
// Su / 3 and Sv / 3.
const SU = Net(16u, 4u, 3u);
const SV = Net(28u, 3u, 4u);
const BINOMIAL_2 = 0x121u;
const BINOMIAL_3 = 0x1331u;

// Three components a coefficient, of up to W + 4 bits.
var<workgroup> factors: array<I64, 120>;

fn weight(k: u32, rows_of: u32, columns_of: u32) -> u32 {
    let row = select(BINOMIAL_3, BINOMIAL_2, rows_of == 3u);
    let column = select(BINOMIAL_3, BINOMIAL_2, columns_of == 3u);
    return digit(row, k / columns_of) * digit(column, k % columns_of);
}

fn factor(coefficient: u32, axis: u32) -> I64 {
    var net = S;
    // From which point to which the difference is.
    var from_point = coefficient;
    var step = 0u;
    if (coefficient >= SV.first) {
        net = SV;
        from_point = coefficient - net.first;
        step = 4u;
    } else if (coefficient >= SU.first) {
        net = SU;
        let k = coefficient - net.first;
        from_point = 4u * (k / 3u) + k % 3u;
        step = 1u;
    }
    var value = rows[3u * (from_point + step) + axis];
    if (step != 0u) {
        value = sub64(value, rows[3u * from_point + axis]);
    }
    return mul64(value, I64(weight(coefficient - net.first, net.rows, net.columns), 0u));
}

fn make_factors(lane: u32) {
    for (var k = lane; k < 120u; k += LANES) {
        factors[k] = factor(k / 3u, k % 3u);
    }
    workgroupBarrier();
}

// A component of a coefficient of the cross product of two nets: 2 W + 10 bits.
fn crossed(a: Net, b: Net, row: u32, column: u32, axis: u32) -> I128 {
    let p = (axis + 1u) % 3u;
    let q = (axis + 2u) % 3u;
    var sum = NONE128;
    for (var k = 0u; k < a.rows * a.columns; k += 1u) {
        // Beyond the net also where these would be negative.
        let i = row - k / a.columns;
        let j = column - k % a.columns;
        if (i < b.rows && j < b.columns) {
            let x = 3u * (a.first + k);
            let y = 3u * (b.first + i * b.columns + j);
            sum = add128(sum, mul_signed(factors[x + p], factors[y + q]));
            sum = sub128(sum, mul_signed(factors[x + q], factors[y + p]));
        }
    }
    return sum;
}

// ---- tangent_plane

const COEFFICIENTS = 81u;
// Rows and columns of S x Su.
const MOMENT_ROWS = 7u;
const MOMENT_COLUMNS = 6u;

var<workgroup> moments: array<I128, 126>;

// The number of entry k of a matrix: the corners, then the others row by row.
fn ordered(k: u32, rows_of: u32, columns_of: u32) -> u32 {
    let last_row = (rows_of - 1u) * columns_of;
    if (k < 4u) {
        return select(0u, columns_of - 1u, (k & 1u) != 0u) + select(0u, last_row, k >= 2u);
    }
    var at = k - 3u;
    at += u32(at >= columns_of - 1u);
    return at + u32(at >= last_row);
}

// A coefficient of det[S, Su, Sv] times its binomials: 3 W + 14 bits.
fn coefficient(at: u32) -> I256 {
    var sum = I256(NONE128, NONE128);
    for (var k = 0u; k < 12u; k += 1u) {
        let i = at / 9u - k / 4u;
        let j = at % 9u - k % 4u;
        if (i < MOMENT_ROWS && j < MOMENT_COLUMNS) {
            for (var axis = 0u; axis < 3u; axis += 1u) {
                let moment = moments[3u * (i * MOMENT_COLUMNS + j) + axis];
                sum = add256(sum, mul_mixed(factors[3u * (SV.first + k) + axis], moment));
            }
        }
    }
    return sum;
}

@compute @workgroup_size(64)
fn tangent_plane(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = group.x + group.y * groups.x;
    if (item * LANES >= settings.items || !begins(item, lane)) {
        return;
    }
    make_factors(lane);
    // First what the corners need, and then, where none of them keeps the patch, the rest.
    for (var part = 0u; part < 2u; part += 1u) {
        let corners = part == 0u;
        let end = select(3u * MOMENT_ROWS * MOMENT_COLUMNS, 12u, corners);
        for (var k = select(12u, 0u, corners) + lane; k < end; k += LANES) {
            let at = ordered(k / 3u, MOMENT_ROWS, MOMENT_COLUMNS);
            let row = at / MOMENT_COLUMNS;
            let column = at % MOMENT_COLUMNS;
            moments[3u * at + k % 3u] = crossed(S, SU, row, column, k % 3u);
        }
        workgroupBarrier();
        let last = select(COEFFICIENTS, 4u, corners);
        for (var k = select(4u, 0u, corners) + lane; k < last; k += LANES) {
            if (is_positive256(coefficient(ordered(k, 9u, 9u)))) {
                atomicMin(&kept_by, k + 1u);
            }
        }
        if (decided(lane)) {
            break;
        }
    }
    ends(item, lane, COEFFICIENTS);
}
