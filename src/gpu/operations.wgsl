// The integers' operations one by one, so that they can be compared by themselves. An item is an
// operation (settings.a) on two operands of eight words; its result has eight words.

@group(0) @binding(1) var<storage, read_write> operands: array<u32>;
@group(0) @binding(2) var<storage, read_write> results: array<u32>;

fn operand(at: u32) -> I128 {
    return I128(operands[at], operands[at + 1u], operands[at + 2u], operands[at + 3u]);
}

fn flag(value: bool) -> I256 {
    return I256(I128(u32(value), 0u, 0u, 0u), NONE128);
}

fn operation(a: I256, b: I256) -> I256 {
    let n = b.lo.x;
    switch settings.a {
        case 0u: { return wide128(wide(add64(a.lo.xy, b.lo.xy))); }
        case 1u: { return wide128(wide(sub64(a.lo.xy, b.lo.xy))); }
        case 2u: { return wide128(wide(mul64(a.lo.xy, b.lo.xy))); }
        case 3u: { return wide128(mul_signed(a.lo.xy, b.lo.xy)); }
        case 4u: { return wide128(add128(a.lo, b.lo)); }
        case 5u: { return wide128(sub128(a.lo, b.lo)); }
        case 6u: { return wide128(mul128(a.lo, b.lo)); }
        case 7u: { return mul_signed128(a.lo, b.lo); }
        case 8u: { return add256(a, b); }
        case 9u: { return sub256(a, b); }
        case 10u: { return wide128(wide(round64(a.lo.xy, n, settings.rounding))); }
        case 11u: { return wide128(round128(a.lo, n, settings.rounding)); }
        case 12u: { return wide128(divide_rounded(a.lo, b.lo, settings.rounding)); }
        case 13u: { return wide128(wide(root_up(a.lo))); }
        case 14u: { return wide128(wide(fit(a.lo.xy, settings.width, settings.wraps != 0u))); }
        case 15u: { return flag(less64(a.lo.xy, b.lo.xy)); }
        case 16u: { return flag(less128(a.lo, b.lo)); }
        case 17u: { return flag(less256(a, b)); }
        case 18u: { return wide128(divide_up(abs128(a.lo), b.lo)); }
        case 19u: { return wide128(shl128(a.lo, n)); }
        case 20u: { return wide128(sar128(a.lo, n)); }
        case 21u: { return wide128(wide(max64(abs64(a.lo.xy), b.lo.xy))); }
        case 22u: { return wide128(max128(abs128(a.lo), b.lo)); }
        case 23u: { return flag(is_positive128(a.lo)); }
        case 24u: { return flag(is_positive256(a)); }
        case 25u: { return mul_mixed(a.lo.xy, b.lo); }
        case 26u: { return wide128(wide(I64(select128(a.lo, n), 0u))); }
        case 27u: { return wide128(wide(I64(count_below128(a.lo, n), 0u))); }
        default: { return a; }
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
    let at = 16u * item;
    let a = I256(operand(at), operand(at + 4u));
    let b = I256(operand(at + 8u), operand(at + 12u));
    let result = operation(a, b);
    for (var k = 0u; k < 4u; k += 1u) {
        results[8u * item + k] = result.lo[k];
        results[8u * item + 4u + k] = result.hi[k];
    }
}
