// The singles' operations one by one, so that they can be compared by themselves. An item is an
// operation (settings.a) on two operands of a word; its result is a word.

@group(0) @binding(1) var<storage, read_write> operands: array<u32>;
@group(0) @binding(2) var<storage, read_write> results: array<u32>;

// Of a conversion, the second operand is the power of two from this one on.
const SCALE = -320;

fn single_operation(a: u32, b: u32) -> u32 {
    switch settings.a {
        case 0u: { return add(a, b); }
        case 1u: { return subtract(a, b); }
        case 2u: { return multiply(a, b); }
        case 3u: { return quotient(a, b); }
        case 4u: { return u32(at_least(a, b)); }
        case 5u: { return u32(same(a, b)); }
        default: { return single_of(I64(a, b >> 16u), i32(b & 0x1ffu) + SCALE); }
    }
}

@compute @workgroup_size(64)
fn operate(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let item = item_of(id, groups);
    if (item >= settings.items) {
        return;
    }
    results[item] = single_operation(operands[2u * item], operands[2u * item + 1u]);
}
