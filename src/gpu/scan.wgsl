// Sums over patches: where each one's part of a common buffer begins, and what all of them counted.

@group(0) @binding(1) var<storage, read_write> rows: array<u32>;
@group(0) @binding(2) var<storage, read_write> out: array<u32>;

var<workgroup> sums: array<u32, 64>;

// The sums of column c of a rows of b words before each row, and behind the last the sum of all:
// one group, which takes 64 stretches side by side. Totals stay below 2^32,
// and rows below 2^21, for the same reason as in `columns`.
@compute @workgroup_size(64)
fn scan(@builtin(local_invocation_id) id: vec3<u32>) {
    let count = settings.a;
    let part = (count + 63u) / 64u;
    let first = min(id.x * part, count);
    let end = min(first + part, count);
    var sum = 0u;
    for (var row = first; row < end; row += 1u) {
        sum += rows[row * settings.b + settings.c];
    }
    sums[id.x] = sum;
    workgroupBarrier();
    var before = 0u;
    for (var k = 0u; k < id.x; k += 1u) {
        before += sums[k];
    }
    for (var row = first; row < end; row += 1u) {
        out[row] = before;
        before += rows[row * settings.b + settings.c];
    }
    if (id.x == 63u) {
        out[count] = before;
    }
}

// The sum of each column over a rows of b words, of two words. At most 32768 rows: some drivers end
// the loops of an invocation, all of them together, after 65535 turns.
@compute @workgroup_size(64)
fn columns(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let column = item_of(id, groups);
    if (column >= settings.items) {
        return;
    }
    var sum = NONE64;
    for (var row = 0u; row < settings.a; row += 1u) {
        sum = add64(sum, I64(rows[row * settings.b + column], 0u));
    }
    out[2u * column] = sum.x;
    out[2u * column + 1u] = sum.y;
}
