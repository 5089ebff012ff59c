//! The kernels' integers against the first implementation's, operation by operation.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use ethnum::{I256, U256};
use rtl_model::number::{
    Format, Modal, OverflowMode, Rounding, RoundingMode, dispatch, divide, shift_right,
    shift_right_wide, sqrt_ceil,
};
use tessim::gpu::{Kernel, rounding};

/// Operands of an operation: what its kernel promises to take.
#[derive(Clone, Copy)]
enum Operands {
    Any64,
    Any128,
    Any256,
    Shift(u32, u32),
    Positive,
    Root,
    /// A mask of 128 bits that has a bit set, and the number of such a bit among them.
    SetBit,
}

struct Operation {
    name: &'static str,
    operands: Operands,
    result: fn(I256, I256, Rounding) -> I256,
}

fn low(a: I256) -> i64 {
    a.as_i64()
}

fn flag(value: bool) -> I256 {
    I256::from(i64::from(value))
}

struct Shift(i128, u32);

impl Modal for Shift {
    type Output = i128;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> i128 {
        match i64::try_from(self.0) {
            Ok(narrow) if self.1 < 62 && narrow.unsigned_abs() < 1 << 62 => {
                shift_right::<R>(narrow, self.1).into()
            }
            _ => shift_right_wide::<R>(self.0, self.1),
        }
    }
}

struct Divide(i128, i128);

impl Modal for Divide {
    type Output = i128;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> i128 {
        divide::<R>(self.0, self.1)
    }
}

struct Fit(i64, Format);

impl Modal for Fit {
    type Output = i64;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> i64 {
        self.1.fit::<O>(self.0).0
    }
}

fn rounded(mode: Rounding, work: impl Modal<Output = i128>) -> I256 {
    I256::from(dispatch(mode, rtl_model::number::Overflow::Saturate, work))
}

use Operands::{Any64, Any128, Any256, Positive, Root};

const OPERATIONS: [Operation; 28] = [
    Operation {
        name: "add64",
        operands: Any64,
        result: |a, b, _| low(a).wrapping_add(low(b)).into(),
    },
    Operation {
        name: "sub64",
        operands: Any64,
        result: |a, b, _| low(a).wrapping_sub(low(b)).into(),
    },
    Operation {
        name: "mul64",
        operands: Any64,
        result: |a, b, _| low(a).wrapping_mul(low(b)).into(),
    },
    Operation { name: "mul_signed", operands: Any64, result: |a, b, _| a * b },
    Operation {
        name: "add128",
        operands: Any128,
        result: |a, b, _| a.as_i128().wrapping_add(b.as_i128()).into(),
    },
    Operation {
        name: "sub128",
        operands: Any128,
        result: |a, b, _| a.as_i128().wrapping_sub(b.as_i128()).into(),
    },
    Operation {
        name: "mul128",
        operands: Any128,
        result: |a, b, _| a.as_i128().wrapping_mul(b.as_i128()).into(),
    },
    Operation { name: "mul_signed128", operands: Any128, result: |a, b, _| a.wrapping_mul(b) },
    Operation { name: "add256", operands: Any256, result: |a, b, _| a.wrapping_add(b) },
    Operation { name: "sub256", operands: Any256, result: |a, b, _| a.wrapping_sub(b) },
    Operation {
        name: "round64",
        operands: Operands::Shift(62, 62),
        result: |a, b, mode| rounded(mode, Shift(low(a).into(), b.as_u32())),
    },
    Operation {
        name: "round128",
        operands: Operands::Shift(126, 126),
        result: |a, b, mode| rounded(mode, Shift(a.as_i128(), b.as_u32())),
    },
    Operation {
        name: "divide_rounded",
        operands: Positive,
        result: |a, b, mode| rounded(mode, Divide(a.as_i128(), b.as_i128())),
    },
    Operation {
        name: "root_up",
        operands: Root,
        result: |a, _, _| U256::from(sqrt_ceil(a.as_u128())).as_i256(),
    },
    Operation { name: "fit", operands: Operands::Shift(62, 1), result: |_, _, _| I256::ZERO },
    Operation { name: "less64", operands: Any64, result: |a, b, _| flag(a < b) },
    Operation { name: "less128", operands: Any128, result: |a, b, _| flag(a < b) },
    Operation { name: "less256", operands: Any256, result: |a, b, _| flag(a < b) },
    Operation {
        name: "divide_up",
        operands: Positive,
        result: |a, b, _| {
            let (a, b) = (a.as_i128().unsigned_abs(), b.as_u128());
            U256::from(a.div_ceil(b)).as_i256()
        },
    },
    Operation {
        name: "shl128",
        operands: Operands::Shift(127, 127),
        result: |a, b, _| (a.as_i128() << b.as_u32()).into(),
    },
    Operation {
        name: "sar128",
        operands: Operands::Shift(127, 127),
        result: |a, b, _| (a.as_i128() >> b.as_u32()).into(),
    },
    Operation {
        name: "max64 abs64",
        operands: Any64,
        result: |a, b, _| low(a).wrapping_abs().max(low(b)).into(),
    },
    Operation {
        name: "max128 abs128",
        operands: Any128,
        result: |a, b, _| a.as_i128().wrapping_abs().max(b.as_i128()).into(),
    },
    Operation { name: "is_positive128", operands: Any128, result: |a, _, _| flag(a.as_i128() > 0) },
    Operation { name: "is_positive256", operands: Any256, result: |a, _, _| flag(a > 0) },
    Operation { name: "mul_mixed", operands: Any128, result: |a, b, _| I256::from(low(a)) * b },
    Operation {
        name: "select128",
        operands: Operands::SetBit,
        result: |a, b, _| set_bit(a, b.as_u32()).into(),
    },
    Operation {
        name: "count_below128",
        operands: Operands::Shift(128, 129),
        result: |a, b, _| {
            let below = (U256::ONE << b.as_u32()) - 1;
            (a.as_u256() & below).count_ones().into()
        },
    },
];

/// A signed integer of up to so many bits: of any length, or near a power of two, or a word's end.
fn draw(random: &mut Random, bits: u32) -> I256 {
    let words: [u128; 2] =
        std::array::from_fn(|_| u128::from(random.bits()) << 64 | u128::from(random.bits()));
    let any = I256::from_words(words[0].cast_signed(), words[1].cast_signed());
    let shift = 256 - random.integer(1, bits);
    match random.integer(0, 4) {
        0 => (I256::ONE << random.integer(0, bits - 2)) - I256::from(random.integer(0, 2)),
        1 => -(I256::ONE << random.integer(0, bits - 2)) + I256::from(random.integer(0, 2)),
        _ => any >> shift,
    }
}

fn operands(random: &mut Random, kind: Operands) -> (I256, I256) {
    match kind {
        Any64 => (draw(random, 64), draw(random, 64)),
        Any128 => (draw(random, 128), draw(random, 128)),
        Any256 => (draw(random, 256), draw(random, 256)),
        Operands::Shift(bits, most) => {
            (draw(random, bits), I256::from(random.integer(0, most - 1)))
        }
        Positive => {
            let divisor = draw(random, 120).abs().max(I256::ONE);
            let many = draw(random, 120);
            // Also ties, and exact quotients.
            match random.integer(0, 2) {
                0 => (
                    many % I256::from(1 << 30) * (divisor >> 40u32),
                    (divisor >> 40u32).max(I256::ONE),
                ),
                1 => {
                    let half = (divisor >> 41u32).max(I256::ONE);
                    ((many % I256::from(1 << 30)) * half, half * 2)
                }
                _ => (many, divisor),
            }
        }
        Operands::SetBit => {
            let mask = draw(random, 128);
            let mask = if mask == 0 { I256::ONE } else { mask };
            let bits = mask.as_u128().count_ones();
            (mask, random.integer(0, bits - 1).into())
        }
        Root => {
            let root = draw(random, 62).abs();
            let off = I256::from(i64::from(random.integer(0, 2)) - 1);
            let square = if random.bits() & 1 == 0 { root * root + off } else { draw(random, 125) };
            (square.abs(), I256::ZERO)
        }
    }
}

/// The number of set bit `k` of the low 128, by asking each of them.
fn set_bit(mask: I256, k: u32) -> u32 {
    let set = |&bit: &u32| mask.as_u128() >> bit & 1 != 0;
    (0..128).filter(set).nth(k as usize).expect("as many bits are set")
}

fn words(value: I256) -> [u32; 8] {
    let (high, low) = value.into_words();
    let word = |k: usize| {
        let half = if k < 4 { low } else { high };
        (half >> (32 * (k % 4))) as u32
    };
    std::array::from_fn(word)
}

#[test]
fn integers_agree_operation_by_operation() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(71);
    for (number, operation) in OPERATIONS.iter().enumerate() {
        for mode in Rounding::ALL {
            for width in [8, 31, 32, 33, 48] {
                let wraps = random.bits() & 1 != 0;
                let items = 400 * support::effort();
                let inputs: Vec<_> =
                    (0..items).map(|_| operands(&mut random, operation.operands)).collect();
                let mut settings = support::settings(width).of(items);
                settings.rounding = rounding(mode);
                settings.wraps = wraps.into();
                settings.own[0] = number as u32;
                let flat: Vec<u32> =
                    inputs.iter().flat_map(|&(a, b)| [words(a), words(b)].concat()).collect();
                let flat = device.upload(&flat).unwrap();
                let out = device.empty(8 * items).unwrap();
                device.run(Kernel::Number, "operate", &settings, &[&flat, &out]).unwrap();
                let got = device.read(&out, 0, 8 * items).unwrap();
                for (&(a, b), got) in inputs.iter().zip(got.chunks(8)) {
                    let want = if operation.name == "fit" {
                        let overflow = rtl_model::number::Overflow::ALL[usize::from(!wraps)];
                        let format = Format::of_range(width, 0);
                        dispatch(mode, overflow, Fit(low(a), format)).into()
                    } else {
                        (operation.result)(a, b, mode)
                    };
                    ledger.compare(
                        ("number", operation.name),
                        &words(want),
                        got,
                        || format!("{mode:?}, {width} bits"),
                        || format!("{a:x}, {b:x}"),
                    );
                }
            }
        }
    }
    support::settle(&ledger, Quantity::KernelNumber);
}
