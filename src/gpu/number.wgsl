// Integers wider than 32 bits, and roundings. Stands before every kernel's own text.
//
// Two's complement, low word first: I64 is vec2<u32>, I128 is vec4<u32>, I256 is two I128. Nothing
// here needs a type that WebGPU does not have; products are made of 16-bit halves. Division and
// roots go bit by bit: by definition, and not as the first implementation does it.

alias I64 = vec2<u32>;
alias I128 = vec4<u32>;

struct I256 {
    lo: I128,
    hi: I128,
}

// Rounding modes, as numbered by `Settings`.
const FLOOR = 0u;
const NEAREST_UP = 1u;
const NEAREST_EVEN = 2u;
const NEAREST_AWAY = 3u;

const NONE64 = I64(0u, 0u);
const NONE128 = I128(0u, 0u, 0u, 0u);

fn word(value: i32) -> I64 {
    return I64(bitcast<u32>(value), bitcast<u32>(value >> 31u));
}

// ---- 64 bits

fn add64(a: I64, b: I64) -> I64 {
    let low = a.x + b.x;
    return I64(low, a.y + b.y + u32(low < a.x));
}

fn neg64(a: I64) -> I64 {
    return add64(~a, I64(1u, 0u));
}

fn sub64(a: I64, b: I64) -> I64 {
    return I64(a.x - b.x, a.y - b.y - u32(a.x < b.x));
}

fn is_negative64(a: I64) -> bool {
    return (a.y >> 31u) != 0u;
}

fn is_zero64(a: I64) -> bool {
    return (a.x | a.y) == 0u;
}

// a < b, unsigned.
fn below64(a: I64, b: I64) -> bool {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// a < b, signed.
fn less64(a: I64, b: I64) -> bool {
    let x = bitcast<i32>(a.y);
    let y = bitcast<i32>(b.y);
    return x < y || (x == y && a.x < b.x);
}

fn max64(a: I64, b: I64) -> I64 {
    return select(a, b, less64(a, b));
}

fn abs64(a: I64) -> I64 {
    return select(a, neg64(a), is_negative64(a));
}

// n from 0 to 63; so in the other shifts of 64 bits.
fn shl64(a: I64, n: u32) -> I64 {
    if (n == 0u) {
        return a;
    }
    if (n >= 32u) {
        return I64(0u, a.x << (n - 32u));
    }
    return I64(a.x << n, (a.y << n) | (a.x >> (32u - n)));
}

// Logical.
fn shr64(a: I64, n: u32) -> I64 {
    if (n == 0u) {
        return a;
    }
    if (n >= 32u) {
        return I64(a.y >> (n - 32u), 0u);
    }
    return I64((a.x >> n) | (a.y << (32u - n)), a.y >> n);
}

// Arithmetic.
fn sar64(a: I64, n: u32) -> I64 {
    if (is_negative64(a)) {
        return ~shr64(~a, n);
    }
    return shr64(a, n);
}

// Two words, exactly: unsigned.
fn mul_words(a: u32, b: u32) -> I64 {
    let al = a & 0xffffu;
    let ah = a >> 16u;
    let bl = b & 0xffffu;
    let bh = b >> 16u;
    let low = al * bl;
    let mid = ah * bl + (low >> 16u);
    let mix = al * bh + (mid & 0xffffu);
    return I64((mix << 16u) | (low & 0xffffu), ah * bh + (mid >> 16u) + (mix >> 16u));
}

// The low 64 bits.
fn mul64(a: I64, b: I64) -> I64 {
    let low = mul_words(a.x, b.x);
    return I64(low.x, low.y + a.x * b.y + a.y * b.x);
}

// Bits of an unsigned integer without its leading zeros.
fn bits64(a: I64) -> u32 {
    return select(32u - countLeadingZeros(a.x), 64u - countLeadingZeros(a.y), a.y != 0u);
}

// ---- 128 bits

fn wide(a: I64) -> I128 {
    let sign = bitcast<u32>(bitcast<i32>(a.y) >> 31u);
    return I128(a, sign, sign);
}

fn narrow(a: I128) -> I64 {
    return a.xy;
}

fn add128(a: I128, b: I128) -> I128 {
    let low = add64(a.xy, b.xy);
    let high = add64(a.zw, b.zw);
    return I128(low, add64(high, I64(u32(below64(low, a.xy)), 0u)));
}

fn neg128(a: I128) -> I128 {
    return add128(~a, I128(1u, 0u, 0u, 0u));
}

fn sub128(a: I128, b: I128) -> I128 {
    return add128(add128(a, ~b), I128(1u, 0u, 0u, 0u));
}

fn is_negative128(a: I128) -> bool {
    return (a.w >> 31u) != 0u;
}

fn is_zero128(a: I128) -> bool {
    return (a.x | a.y | a.z | a.w) == 0u;
}

fn is_positive128(a: I128) -> bool {
    return !is_negative128(a) && !is_zero128(a);
}

fn below128(a: I128, b: I128) -> bool {
    return below64(a.zw, b.zw) || (all(a.zw == b.zw) && below64(a.xy, b.xy));
}

fn less128(a: I128, b: I128) -> bool {
    return less64(a.zw, b.zw) || (all(a.zw == b.zw) && below64(a.xy, b.xy));
}

fn max128(a: I128, b: I128) -> I128 {
    return select(a, b, less128(a, b));
}

fn abs128(a: I128) -> I128 {
    return select(a, neg128(a), is_negative128(a));
}

// n from 0 to 127; so in the other shifts of 128 bits.
fn shl128(a: I128, n: u32) -> I128 {
    if (n == 0u) {
        return a;
    }
    if (n >= 64u) {
        return I128(NONE64, shl64(a.xy, n - 64u));
    }
    return I128(shl64(a.xy, n), shl64(a.zw, n) | shr64(a.xy, 64u - n));
}

// Logical.
fn shr128(a: I128, n: u32) -> I128 {
    if (n == 0u) {
        return a;
    }
    if (n >= 64u) {
        return I128(shr64(a.zw, n - 64u), NONE64);
    }
    return I128(shr64(a.xy, n) | shl64(a.zw, 64u - n), shr64(a.zw, n));
}

// Arithmetic.
fn sar128(a: I128, n: u32) -> I128 {
    if (is_negative128(a)) {
        return ~shr128(~a, n);
    }
    return shr128(a, n);
}

// Two 64-bit integers, exactly: unsigned.
fn mul_unsigned(a: I64, b: I64) -> I128 {
    var sum = I128(mul_words(a.x, b.x), mul_words(a.y, b.y));
    sum = add128(sum, I128(0u, mul_words(a.x, b.y), 0u));
    return add128(sum, I128(0u, mul_words(a.y, b.x), 0u));
}

// Two 64-bit integers, exactly: signed.
fn mul_signed(a: I64, b: I64) -> I128 {
    let size = mul_unsigned(abs64(a), abs64(b));
    return select(size, neg128(size), is_negative64(a) != is_negative64(b));
}

// The low 128 bits.
fn mul128(a: I128, b: I128) -> I128 {
    var product = mul_unsigned(a.xy, b.xy);
    let cross = add64(mul64(a.xy, b.zw), mul64(a.zw, b.xy));
    return I128(product.xy, add64(product.zw, cross));
}

fn bits128(a: I128) -> u32 {
    return select(bits64(a.xy), 64u + bits64(a.zw), !is_zero64(a.zw));
}

// The number of the k-th bit that is set, from the lowest one, which is the 0th; there is one.
fn select128(mask: I128, k: u32) -> u32 {
    var left = k;
    var word_number = 0u;
    while (word_number < 3u && left >= countOneBits(mask[word_number])) {
        left -= countOneBits(mask[word_number]);
        word_number += 1u;
    }
    var part = mask[word_number];
    var at = 32u * word_number;
    for (var half = 16u; half > 0u; half /= 2u) {
        let below = countOneBits(part & ((1u << half) - 1u));
        if (left >= below) {
            left -= below;
            part >>= half;
            at += half;
        }
    }
    return at;
}

// How many of the n lowest bits are set, n from 0 to 128.
fn count_below128(mask: I128, n: u32) -> u32 {
    var sum = 0u;
    for (var k = 0u; k < 4u; k += 1u) {
        let bits = clamp(n, 32u * k, 32u * k + 32u) - 32u * k;
        sum += countOneBits(extractBits(mask[k], 0u, bits));
    }
    return sum;
}

// ---- 256 bits

fn wide128(a: I128) -> I256 {
    return I256(a, I128(bitcast<u32>(bitcast<i32>(a.w) >> 31u)));
}

fn add256(a: I256, b: I256) -> I256 {
    let lo = add128(a.lo, b.lo);
    let carry = I128(u32(below128(lo, a.lo)), 0u, 0u, 0u);
    return I256(lo, add128(add128(a.hi, b.hi), carry));
}

fn neg256(a: I256) -> I256 {
    return add256(I256(~a.lo, ~a.hi), I256(I128(1u, 0u, 0u, 0u), NONE128));
}

fn sub256(a: I256, b: I256) -> I256 {
    return add256(a, neg256(b));
}

fn is_negative256(a: I256) -> bool {
    return is_negative128(a.hi);
}

fn is_zero256(a: I256) -> bool {
    return is_zero128(a.lo | a.hi);
}

fn is_positive256(a: I256) -> bool {
    return !is_negative256(a) && !is_zero256(a);
}

fn less256(a: I256, b: I256) -> bool {
    return less128(a.hi, b.hi) || (all(a.hi == b.hi) && below128(a.lo, b.lo));
}

// Two 128-bit integers, exactly: unsigned.
fn mul_unsigned128(a: I128, b: I128) -> I256 {
    var sum = I256(mul_unsigned(a.xy, b.xy), mul_unsigned(a.zw, b.zw));
    let p = mul_unsigned(a.xy, b.zw);
    let q = mul_unsigned(a.zw, b.xy);
    sum = add256(sum, I256(I128(NONE64, p.xy), I128(p.zw, NONE64)));
    return add256(sum, I256(I128(NONE64, q.xy), I128(q.zw, NONE64)));
}

// Two 128-bit integers, exactly: signed.
fn mul_signed128(a: I128, b: I128) -> I256 {
    let size = mul_unsigned128(abs128(a), abs128(b));
    if (is_negative128(a) != is_negative128(b)) {
        return neg256(size);
    }
    return size;
}

// Of 64 and 128 bits, exactly: signed.
fn mul_mixed(a: I64, b: I128) -> I256 {
    let size = abs128(b);
    let low = mul_unsigned(abs64(a), size.xy);
    let high = mul_unsigned(abs64(a), size.zw);
    let product = add256(I256(low, NONE128), I256(I128(NONE64, high.xy), I128(high.zw, NONE64)));
    if (is_negative64(a) != is_negative128(b)) {
        return neg256(product);
    }
    return product;
}

// ---- rounding

// What is added to a value before it is shifted down by n >= 1: a half, or less on the ties that go
// down.
fn tie(mode: u32, odd: bool, negative: bool) -> bool {
    return (mode == NEAREST_EVEN && !odd) || (mode == NEAREST_AWAY && negative);
}

// round(value / 2^n), n from 0 to 126.
fn round128(value: I128, n: u32, mode: u32) -> I128 {
    let floor = sar128(value, n);
    if (n == 0u || mode == FLOOR) {
        return floor;
    }
    // The bit that is worth a half, and whether anything stands below it.
    let half = (shr128(value, n - 1u).x & 1u) != 0u;
    let below = n > 1u && !is_zero128(shl128(value, 129u - n));
    let up = half && (below || !tie(mode, (floor.x & 1u) != 0u, is_negative128(value)));
    return add128(floor, I128(u32(up), 0u, 0u, 0u));
}

// round(value / 2^n), n from 0 to 62.
fn round64(value: I64, n: u32, mode: u32) -> I64 {
    let floor = sar64(value, n);
    if (n == 0u || mode == FLOOR) {
        return floor;
    }
    let half = (shr64(value, n - 1u).x & 1u) != 0u;
    let below = n > 1u && !is_zero64(shl64(value, 65u - n));
    let up = half && (below || !tie(mode, (floor.x & 1u) != 0u, is_negative64(value)));
    return add64(floor, I64(u32(up), 0u));
}

struct Quotient {
    value: I128,
    rest: I128,
}

// Unsigned, the divisor above 0 and below 2^127: bit by bit.
fn divide_unsigned(numerator: I128, divisor: I128) -> Quotient {
    var q = Quotient(NONE128, NONE128);
    for (var bit = bits128(numerator); bit > 0u; bit -= 1u) {
        q.rest = shl128(q.rest, 1u) | I128(shr128(numerator, bit - 1u).x & 1u, 0u, 0u, 0u);
        q.value = shl128(q.value, 1u);
        if (!below128(q.rest, divisor)) {
            q.rest = sub128(q.rest, divisor);
            q.value.x |= 1u;
        }
    }
    return q;
}

// round(numerator / divisor), the divisor above 0 and below 2^126.
fn divide_rounded(numerator: I128, divisor: I128, mode: u32) -> I128 {
    let negative = is_negative128(numerator);
    var q = divide_unsigned(abs128(numerator), divisor);
    if (negative) {
        // To the floor: -(value + rest / divisor).
        q.value = neg128(q.value);
        if (!is_zero128(q.rest)) {
            q.value = sub128(q.value, I128(1u, 0u, 0u, 0u));
            q.rest = sub128(divisor, q.rest);
        }
    }
    let twice = shl128(q.rest, 1u);
    let equal = all(twice == divisor);
    let past = !below128(twice, divisor);
    let up = mode != FLOOR && past && !(equal && tie(mode, (q.value.x & 1u) != 0u, negative));
    return add128(q.value, I128(u32(up), 0u, 0u, 0u));
}

// ceil(numerator / divisor), both unsigned.
fn divide_up(numerator: I128, divisor: I128) -> I128 {
    let q = divide_unsigned(numerator, divisor);
    return add128(q.value, I128(u32(!is_zero128(q.rest)), 0u, 0u, 0u));
}

// The least integer whose square is at least `value`, for a value below 2^126: bit by bit.
fn root_up(value: I128) -> I64 {
    var root = NONE64;
    let top = (bits128(value) + 1u) / 2u;
    for (var bit = top; bit > 0u; bit -= 1u) {
        let trial = root | shl64(I64(1u, 0u), bit - 1u);
        if (!below128(value, mul_unsigned(trial, trial))) {
            root = trial;
        }
    }
    return add64(root, I64(u32(below128(mul_unsigned(root, root), value)), 0u));
}

// The value that fits `width` bits: the nearest end of the symmetric range, or the low bits.
fn fit(value: I64, width: u32, wraps: bool) -> I64 {
    if (wraps) {
        return sar64(shl64(value, 64u - width), 64u - width);
    }
    let most = sub64(shl64(I64(1u, 0u), width - 1u), I64(1u, 0u));
    if (less64(most, value)) {
        return most;
    }
    let least = neg64(most);
    return select(value, least, less64(value, least));
}
