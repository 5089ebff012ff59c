//! The kernels' singles against the processor's, operation by operation: random and special
//! operands, near each other, near powers of two, subnormal, and results that overflow or vanish.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use tessim::gpu::Kernel;

/// Numbers of operations, by name: as single_operations.wgsl has them.
type Operation = (&'static str, fn(f32, f32) -> f32);

const OPERATIONS: [Operation; 4] = [
    ("add", |a, b| a + b),
    ("subtract", |a, b| a - b),
    ("multiply", |a, b| a * b),
    ("quotient", |a, b| a / b),
];

const SPECIAL: [u32; 16] = [
    0,
    1,
    2,
    0x0040_0000,
    0x007f_ffff,
    0x0080_0000,
    0x0080_0001,
    0x3f00_0000,
    0x3f7f_ffff,
    0x3f80_0000,
    0x3f80_0001,
    0x7f7f_ffff,
    0x7f80_0000,
    0x7f80_0001,
    0x7fc0_0000,
    0x7fff_ffff,
];

/// Any bits, or special ones, of either sign.
fn single(random: &mut Random) -> u32 {
    let bits = random.bits() as u32;
    match random.integer(0, 7) {
        0 => random.of(SPECIAL) | bits & 1 << 31,
        1 => bits & 0x80ff_ffff,                 // subnormal, or nearly
        2 => bits & 0x8000_0fff,                 // few bits
        3 => (bits & 0x80ff_f000) | 0x3f00_0000, // short significands: ties
        4 => (bits & 0x81ff_ffff) | 0x3e00_0000, // about 1
        _ => bits,
    }
}

/// The second operand: any, or near the first one, or so that the result is near an end of the
/// range.
fn second(random: &mut Random, first: u32) -> u32 {
    let bits = random.bits() as u32;
    match random.integer(0, 5) {
        0 => first ^ (bits & 0x8000_0007),
        1 => (first ^ (bits & 0x8000_0fff)).wrapping_sub(bits >> 7 & 0x0180_0000),
        2 => {
            // The product's exponent is near 0 or 255.
            let exponent = first >> 23 & 0xff;
            let wanted = random.of([127, 127 + 255]) + random.integer(0, 26);
            let own = wanted.saturating_sub(13 + exponent).min(254);
            own << 23 | bits & 0x807f_ffff
        }
        _ => single(random),
    }
}

/// Of no numbers, one: which one a processor gives is its own affair.
fn canonical(value: f32) -> u32 {
    if value.is_nan() { 0x7fc0_0000 } else { value.to_bits() }
}

fn run(operation: usize, operands: &[u32]) -> Option<Vec<u32>> {
    let device = support::device()?;
    let items = operands.len() / 2;
    let mut settings = support::settings(32).of(items);
    settings.own[0] = operation as u32;
    let flat = device.upload(operands).unwrap();
    let out = device.empty(items).unwrap();
    device.run(Kernel::SingleOperations, "operate", &settings, &[&flat, &out]).unwrap();
    Some(device.read(&out, 0, items).unwrap())
}

#[test]
fn singles_agree_operation_by_operation() {
    let mut ledger = support::ledger();
    let mut random = Random::new(1102);
    let items = 400_000 * support::effort();
    let mut compare = |operation: usize, name, want: &dyn Fn(f32, f32) -> u32| {
        let mut operands = Vec::with_capacity(2 * items);
        for _ in 0..items {
            let first = single(&mut random);
            operands.extend([first, second(&mut random, first)]);
        }
        let Some(got) = run(operation, &operands) else { return };
        for (pair, got) in operands.chunks(2).zip(got) {
            let [a, b] = [pair[0], pair[1]].map(f32::from_bits);
            let inputs = || format!("{a:e}, {b:e}: {pair:08x?}");
            ledger.compare(("single", name), &[want(a, b)], &[got], String::new, inputs);
        }
    };
    for (k, (name, operation)) in OPERATIONS.into_iter().enumerate() {
        compare(k, name, &|a, b| canonical(operation(a, b)));
    }
    compare(4, "at_least", &|a, b| (a >= b).into());
    compare(5, "same", &|a, b| (a == b).into());
    if support::device().is_some() {
        support::settle(&ledger, Quantity::KernelSingle);
    }
}

#[test]
fn integers_become_singles_as_the_definition_has_it() {
    let mut ledger = support::ledger();
    let mut random = Random::new(1103);
    let mut operands = Vec::new();
    for _ in 0..50_000 * support::effort() {
        let keep = random.integer(0, 31);
        let low = (random.bits() as u32) >> keep;
        let high = if keep == 0 { random.integer(0, 0xffff) } else { 0 };
        operands.extend([low, high << 16 | random.integer(0, 511)]);
    }
    let Some(got) = run(6, &operands) else { return };
    for (pair, got) in operands.chunks(2).zip(got) {
        let scale = (pair[1] & 511) as i32 - 320;
        let integer = u64::from(pair[1] >> 16) << 32 | u64::from(pair[0]);
        // Exact in a double, which is rounded once.
        let want = (integer as f64 * f64::from(scale).exp2()) as f32;
        let inputs = || format!("{integer} 2^{scale}");
        ledger.compare(("single", "of integer"), &[want.to_bits()], &[got], String::new, inputs);
    }
    support::settle(&ledger, Quantity::KernelSingle);
}
