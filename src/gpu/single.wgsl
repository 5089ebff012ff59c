// Singles: IEEE 754 binary32 in integers, to nearest with ties to even, with subnormals. Stands
// before the texts of kernels that go on in f32.
//
// A single is its bits in a u32. WebGPU's own f32 may be contracted, flushed to zero and off by
// units of the last place, and drivers do all three; so each operation is made of its definition:
// the exact result with a sticky bit for what does not fit, rounded once. The first implementation
// has the processor's singles. A result that is no number is NOT_A_NUMBER, whatever came in.

const SIGN = 0x80000000u;
const INFINITY = 0x7f800000u;
const NOT_A_NUMBER = 0x7fc00000u;
const ONE_SINGLE = 0x3f800000u;
const HALF_SINGLE = 0x3f000000u;
const THREE_SINGLE = 0x40400000u;

// Stored bits of the significand, and the bit before them.
const FRACTION = 0x7fffffu;
const HIDDEN = 0x800000u;
const BIAS = 127;

fn magnitude(a: u32) -> u32 {
    return a & ~SIGN;
}

// m / 2^n; the lowest bit says whether anything was lost.
fn jam(m: u32, n: u32) -> u32 {
    if (n == 0u) {
        return m;
    }
    if (n >= 32u) {
        return u32(m != 0u);
    }
    return (m >> n) | u32((m << (32u - n)) != 0u);
}

// The single nearest to m / 2^30 * 2^(e - 127), m of 2^30..2^31: seven bits more than are kept, of
// which the lowest is sticky.
fn pack(sign: u32, e: i32, m: u32) -> u32 {
    let kept = jam(m, u32(max(1 - e, 0)));
    let tied = u32((kept & 0x7fu) == 0x40u);
    let rounded = ((kept + 0x40u) >> 7u) & ~tied;
    // The hidden bit, and what rounding carries, go into the exponent.
    let bits = (u32(max(e, 1) - 1) << 23u) + rounded;
    return sign | min(bits, INFINITY);
}

// A number's exponent and its significand of 2^23..2^24.
struct Parts {
    e: i32,
    m: u32,
}

// Of a magnitude that is neither 0 nor infinite.
fn parts(a: u32) -> Parts {
    let e = i32(a >> 23u);
    if (e == 0) {
        let shift = countLeadingZeros(a) - 8u;
        return Parts(1 - i32(shift), a << shift);
    }
    return Parts(e, (a & FRACTION) | HIDDEN);
}

fn multiply(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let x = magnitude(a);
    let y = magnitude(b);
    if (max(x, y) >= INFINITY) {
        return select(sign | INFINITY, NOT_A_NUMBER, max(x, y) > INFINITY || min(x, y) == 0u);
    }
    if (min(x, y) == 0u) {
        return sign;
    }
    let p = parts(x);
    let q = parts(y);
    let product = mul_words(p.m, q.m); // 2^46 to 2^48
    let high = (product.y << 16u) | (product.x >> 16u) | u32((product.x & 0xffffu) != 0u);
    let carry = high >> 31u;
    return pack(sign, p.e + q.e - BIAS + i32(carry), jam(high, carry));
}

fn add(a: u32, b: u32) -> u32 {
    let swapped = magnitude(a) < magnitude(b);
    let big = select(a, b, swapped);
    let small = select(b, a, swapped);
    let x = magnitude(big);
    let y = magnitude(small);
    let unlike = ((a ^ b) & SIGN) != 0u;
    if (x >= INFINITY) {
        return select(big, NOT_A_NUMBER, x > INFINITY || (y == INFINITY && unlike));
    }
    let e = max(x >> 23u, 1u);
    let f = max(y >> 23u, 1u);
    // Six bits more than are kept, and room for a carry.
    let m = ((x & FRACTION) | select(0u, HIDDEN, x >= HIDDEN)) << 6u;
    let n = jam(((y & FRACTION) | select(0u, HIDDEN, y >= HIDDEN)) << 6u, e - f);
    let sum = select(m + n, m - n, unlike);
    if (sum == 0u) {
        return a & b & SIGN;
    }
    let shift = countLeadingZeros(sum) - 1u;
    return pack(big & SIGN, i32(e) + 1 - i32(shift), sum << shift);
}

fn subtract(a: u32, b: u32) -> u32 {
    return add(a, b ^ SIGN);
}

fn quotient(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let x = magnitude(a);
    let y = magnitude(b);
    if (max(x, y) > INFINITY || (x == y && (x == 0u || x == INFINITY))) {
        return NOT_A_NUMBER;
    }
    if (x == INFINITY || y == 0u) {
        return sign | INFINITY;
    }
    if (y == INFINITY || x == 0u) {
        return sign;
    }
    let p = parts(x);
    let q = parts(y);
    // Bit by bit, the first of them 1.
    let less = u32(p.m < q.m);
    var rest = p.m << less;
    var digits = 0u;
    for (var k = 0u; k < 31u; k += 1u) {
        let fits = rest >= q.m;
        digits = (digits << 1u) | u32(fits);
        rest = select(rest, rest - q.m, fits) << 1u;
    }
    return pack(sign, p.e - q.e + BIAS - i32(less), digits | u32(rest != 0u));
}

// An order of all numbers, both zeros alike.
fn order_of(a: u32) -> i32 {
    let size = bitcast<i32>(magnitude(a));
    return select(size, -size, a >= SIGN);
}

fn is_number(a: u32) -> bool {
    return magnitude(a) <= INFINITY;
}

// a >= b; no number is not.
fn at_least(a: u32, b: u32) -> bool {
    return is_number(a) && is_number(b) && order_of(a) >= order_of(b);
}

// a = b; no number is not.
fn same(a: u32, b: u32) -> bool {
    return is_number(a) && is_number(b) && order_of(a) == order_of(b);
}

// The single nearest to n * 2^scale, n not negative.
fn single_of(n: I64, scale: i32) -> u32 {
    if (is_zero64(n)) {
        return 0u;
    }
    let bits = bits64(n);
    let top = shl64(n, 64u - bits);
    let m = (top.y >> 1u) | u32(((top.y & 1u) | top.x) != 0u);
    return pack(0u, BIAS + i32(bits) - 1 + scale, m);
}
