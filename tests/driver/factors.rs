//! Random factors of the kinds that find mistakes: anywhere in the range, small, one ulp around
//! where the number of segments changes, and values that are no factors.

use crate::gl::Bits;
use crate::random::Random;

/// Bits of singles that are special to the rules of factors.
const SPECIAL: [u32; 22] = [
    0x0000_0000, // 0
    0x8000_0000, // -0
    0x0000_0001, // the smallest number
    0x8000_0001,
    0x3380_0000, // 2^-24: nothing in 16 fraction bits
    0x3700_0000, // 2^-17: half of the last fraction bit
    0x3f7f_ffff, // an ulp below 1
    0x3f80_0000, // 1
    0x3f80_0001, // an ulp above 1
    0x3f80_0040, // 1 + 2^-17
    0x3f80_0041, // an ulp above
    0x3f80_0080, // 1 + 2^-16
    0x4280_0000, // 64
    0x4280_0001,
    0x7f7f_ffff, // the largest number
    0xff7f_ffff,
    0x7f80_0000, // infinity
    0xff80_0000,
    0x7fc0_0000, // NaN
    0xffc0_1234, // another
    0x7f80_0001, // a signalling one
    0xbf80_0000, // -1
];

/// Bits of singles around 1, where a factor of 1 ends and an odd inside gets its thinnest ring.
const NEAR_ONE: [u32; 10] = [
    0x3f7f_ffff,
    0x3f80_0001,
    0x3f80_003f,
    0x3f80_0040, // 1 + 2^-17: a tie, rounded to 1
    0x3f80_0041,
    0x3f80_007f,
    0x3f80_0080, // 1 + 2^-16
    0x3f80_0081,
    0x3f80_00c0, // 1 + 1.5 * 2^-16: a tie, rounded to 1 + 2^-15
    0x3f80_0100,
];

/// How a patch's factors are drawn.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Each in 1..64.
    Wide,
    /// Each in 0.9..5, where the cases of the pattern's middle are.
    Small,
    /// Each an integer or one ulp beside it.
    NearInteger,
    /// All the same integer or half, or one ulp beside it.
    Equal,
    /// All within 2 of one value, as neighbours on a surface are.
    Alike,
    /// 1 for most, or next to it.
    NearOne,
    /// Special values for some, small ones for the rest.
    Special,
    /// A special value in one place of the inside, where none culls.
    SpecialInside,
}

/// Factors of one patch; those that a domain does not have are drawn and not looked at.
pub(crate) fn draw(random: &mut Random) -> Bits {
    use Kind::{Alike, Equal, NearInteger, NearOne, Small, Special, SpecialInside, Wide};
    let kind =
        random.of([Wide, Small, Small, NearInteger, Equal, Alike, NearOne, Special, SpecialInside]);
    let centre = random.single(1.0, 64.0);
    let common = near(random, 2);
    let mut bits = [0; 6].map(|_: u32| match kind {
        Wide => random.single(1.0, 64.0).to_bits(),
        Small | SpecialInside => random.single(0.9, 5.0).to_bits(),
        NearInteger => near(random, 1),
        Equal => common,
        Alike => random.single(centre - 2.0, centre + 2.0).max(0.5).to_bits(),
        NearOne if random.integer(0, 3) > 0 => 1f32.to_bits(),
        NearOne => random.of(NEAR_ONE),
        Special if random.integer(0, 2) == 0 => random.of(SPECIAL),
        Special => random.single(0.9, 5.0).to_bits(),
    });
    if matches!(kind, SpecialInside) {
        bits[random.integer(4, 5) as usize] = random.of(SPECIAL);
    }
    bits
}

/// A multiple of 1/`parts` from 1 to 65, or one ulp beside it.
fn near(random: &mut Random, parts: u32) -> u32 {
    let exact = random.integer(parts, 65 * parts) as f32 / parts as f32;
    let ulps = random.integer(0, 2);
    exact.to_bits() + ulps - 1
}
