//! Forward differencing in half-runs: from each end of a cubic to its middle, a step of three
//! additions a vertex.
//!
//! Moreton 2001 (half-edges, reversed curves); the set-up in integers is ours. With W the position
//! width, g the guard bits and R = 1/level in U0.32 (the truncated reciprocal that also made the
//! parameters):
//!
//! ```text
//!   a = -B0+3B1-3B2+B3   b = 3B0-6B1+3B2   c = 3(B1-B0)        exact, W + 4 bits
//!   h2 = R R                                                    64 fraction bits, exact
//!   h3 = (h2 R) >> 32                                           64 fraction bits, truncated
//!   D1 = a h3 + b h2 + c R    D2 = 6a h3 + 2b h2    D3 = 6a h3  rounded half up to g bits, once
//!   D0 = B0 << g;  a step: D0 += D1, D1 += D2, D2 += D3;      vertex = D0 rounded to position bits
//! ```
//!
//! The registers are modular; their true widths are D0 and D1 W + 1, D2 and D3 W + 6, plus g. A run
//! from the other end is the same on B3..B0, for which a changes its sign only. So a reversed edge
//! gives the same bits.

use super::Slot;
use crate::number::{Rounding, RoundingMode, shift_right};
use crate::patch::{Level, Point};
use crate::place::List;

/// Steps of a half-run at most.
const STEPS_MAX: i64 = 64;

/// How far, in output ulps rounded up, an output may leave the hull of the control points: with
/// every coefficient off by half an accumulator ulp, n/2 + C(n,2)/2 + C(n,3)/2 of those after n
/// steps, and the output's rounding.
pub(super) fn error_max(guard: u32) -> i64 {
    const N: i64 = STEPS_MAX;
    const ULPS: i64 = (N + N * (N - 1) / 2 + N * (N - 1) * (N - 2) / 6) / 2;
    (ULPS >> guard) + 2
}

/// What D0 is kept above its value, so that it is never negative and a logical shift rounds it:
/// vectors of 64-bit integers have no arithmetic one. Even after the shift, so parity is kept.
const OFFSET: u64 = 1 << 61;

/// Difference registers, x y z w each, `guard` fraction bits below the position's; D0 with its
/// offset.
#[derive(Clone, Copy)]
struct Registers {
    d0: [u64; 4],
    d1: [u64; 4],
    d2: [u64; 4],
    d3: [u64; 4],
}

impl Registers {
    #[inline(always)]
    fn step(&mut self) {
        for i in 0..4 {
            self.d0[i] = self.d0[i].wrapping_add(self.d1[i]);
            self.d1[i] = self.d1[i].wrapping_add(self.d2[i]);
            self.d2[i] = self.d2[i].wrapping_add(self.d3[i]);
        }
    }

    /// D0 rounded to the position format.
    #[inline(always)]
    fn output<R: RoundingMode>(&self, guard: u32) -> Point {
        let half = (1 << guard) >> 1;
        self.d0.map(|d| {
            let bias = match R::MODE {
                Rounding::Floor => 0,
                Rounding::NearestUp => half,
                Rounding::NearestEven => half - 1 + (d >> guard & 1),
                Rounding::NearestAway => half - 1 + (d >> 61 & 1), // a tie below 0 goes down
            };
            ((d + bias) >> guard).wrapping_sub(OFFSET >> guard) as i64
        })
    }
}

/// Runs a curve from both ends; `out` has a place for each inner entry of the list. Returns
/// half-runs and steps.
pub(super) fn run<R: RoundingMode, S: Slot>(
    curve: &[Point; 4],
    list: &List,
    guard: u32,
    out: &mut [S],
) -> (u64, u64) {
    if list.level() == Level::MIN {
        return (0, 0);
    }
    if list.level() == Level::TWO {
        out[0].put(centre::<R>(curve));
        return (0, 0);
    }
    let r = list.reciprocal();
    let [mut near, mut far] = if r < 1 << 31 {
        set_up::<Signed>(curve, r, guard)
    } else {
        set_up::<Unsigned>(curve, r, guard)
    };
    if list.crosses_centre() {
        // 1 < level < 2: each end's single step passes the centre and makes the other half's
        // vertex.
        near.step();
        far.step();
        out[1].put(near.output::<R>(guard));
        out[0].put(far.output::<R>(guard));
        return (2, 2);
    }
    let steps = list.half_segments() - 1;
    let (first, second) = out.split_at_mut(steps);
    for slot in first {
        near.step();
        slot.put(near.output::<R>(guard));
    }
    second[0].put(centre::<R>(curve));
    for slot in second[1..].iter_mut().rev() {
        far.step();
        slot.put(far.output::<R>(guard));
    }
    (2, 2 * steps as u64)
}

/// The middle of the curve, its sum paired so that either end gives the same: W + 3 bits.
fn centre<R: RoundingMode>([a, b, c, d]: &[Point; 4]) -> Point {
    std::array::from_fn(|i| shift_right::<R>((a[i] + d[i]) + 3 * (b[i] + c[i]), 3))
}

/// Registers at both ends for a step of `r` (U0.32).
#[inline(always)]
fn set_up<P: Product>([b0, b1, b2, b3]: &[Point; 4], r: u64, guard: u32) -> [Registers; 2] {
    let h2 = r * r; // U0.64: r < 2^32 above level 1
    let h3 = ((u128::from(h2) * u128::from(r)) >> 32) as u64;
    let h1 = r << 32;
    let mut ends = [Registers { d0: [0; 4], d1: [0; 4], d2: [0; 4], d3: [0; 4] }; 2];
    for i in 0..4 {
        let a = b3[i] - b0[i] + 3 * (b1[i] - b2[i]);
        // W + 4 and W + 7 bits, times 64: 119 at W = 48
        let (cubic, six_cubic) = (P::of(a, h3), P::of(6 * a, h3));
        let [near, far] = &mut ends;
        for (end, [p, q, s], cubic, six_cubic) in [
            (near, [b0[i], b1[i], b2[i]], cubic, six_cubic),
            (far, [b3[i], b2[i], b1[i]], -cubic, -six_cubic),
        ] {
            let b = 3 * (p + s - 2 * q);
            end.d0[i] = ((p << guard) as u64).wrapping_add(OFFSET);
            end.d1[i] = rounded(cubic + P::of(b, h2) + P::of(3 * (q - p), h1), guard);
            end.d2[i] = rounded(six_cubic + P::of(2 * b, h2), guard);
            end.d3[i] = rounded(six_cubic, guard);
        }
    }
    ends
}

/// The exact product of a coefficient and a power of the step with 64 fraction bits.
trait Product {
    fn of(a: i64, h: u64) -> i128;
}

/// For steps below 1/2, whose powers are below 2^63: one signed multiplication.
struct Signed;

/// For any step.
struct Unsigned;

impl Product for Signed {
    #[inline(always)]
    fn of(a: i64, h: u64) -> i128 {
        i128::from(a) * i128::from(h as i64)
    }
}

impl Product for Unsigned {
    #[inline(always)]
    fn of(a: i64, h: u64) -> i128 {
        i128::from(a) * i128::from(h)
    }
}

/// From 64 fraction bits to `guard`, half up; the low 64 bits of the register.
#[inline(always)]
fn rounded(sum: i128, guard: u32) -> u64 {
    let sum = sum + (1 << (63 - guard));
    // guard < 64, said so that one funnel shift does it.
    (((sum as u128) << (guard & 63)) >> 64) as u64
}
