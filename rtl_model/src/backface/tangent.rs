//! The 81 Bernstein coefficients of det[S, Su, Sv] and the decision on their signs.
//!
//! With binomials multiplied in, s = C(3,i) C(3,j) P_ij and likewise for the derivatives, products
//! of polynomials are plain convolutions and no division is needed: 144 cross products make the 36
//! coefficients of N = Su x Sv, 576 dot products the 81 of S . N. Their size: 70 * 70 * 6 * 4 *
//! 2^(3(W-1)), 3W + 14 bits with the sign; i128 up to 36-bit positions, 256 bits beyond.
//!
//! Most patches are decided earlier, with the same result: by one of the four corners, which are
//! exact and cheap, or by 15-bit truncations of S, Su, Sv in 64-bit arithmetic with an error bound.
//! Only a coefficient within that bound of zero calls for the exact ones.

use crate::number::Wide;
use ethnum::I256;
use std::cmp::Ordering;

/// x, y, w.
type Row<T> = [T; 3];

/// Widest position whose coefficients fit 128 bits.
const WIDTH_MAX_128: u32 = 36;

/// Bits, without the sign, that the estimate keeps: 3 * 15 + log2(6 * 70 * 70) = 59.9.
const ESTIMATE_BITS: u32 = 15;

const BINOMIAL_2: [i64; 3] = [1, 2, 1];
const BINOMIAL_3: [i64; 4] = [1, 3, 3, 1];
const BINOMIAL_8: [i64; 9] = [1, 8, 28, 56, 70, 56, 28, 8, 1];

/// Whether the surface has no coefficient towards the viewer; `points` are x, y, w with positive
/// volumes in front.
#[must_use]
pub fn tangent_plane(points: &[Row<i64>; 16], width: u32) -> bool {
    if faces_at_a_corner(points) {
        return false;
    }
    estimate(points).unwrap_or_else(|| {
        if width <= WIDTH_MAX_128 {
            none_positive(&coefficients::<i128>(points))
        } else {
            none_positive(&coefficients::<I256>(points))
        }
    })
}

fn none_positive<T: Wide>(coefficients: &[[T; 9]; 9]) -> bool {
    coefficients.iter().flatten().all(|&c| c <= T::default())
}

/// The exact coefficients, row k along v, column l along u, times C(8,k) C(8,l) / 9.
#[must_use]
pub fn coefficients<T: Wide>(points: &[Row<i64>; 16]) -> [[T; 9]; 9] {
    Factors::of(points).weighted().determinant()
}

/// S, Su / 3 and Sv / 3 in Bernstein form: 4 x 4, 4 x 3 and 3 x 4 coefficients, row-major.
#[derive(Clone, Copy)]
struct Factors {
    s: [Row<i64>; 16],
    su: [Row<i64>; 12],
    sv: [Row<i64>; 12],
}

impl Factors {
    fn of(points: &[Row<i64>; 16]) -> Self {
        let su = |k: usize| {
            let left = 4 * (k / 3) + k % 3;
            minus(points[left + 1], points[left])
        };
        let sv = |k: usize| minus(points[k + 4], points[k]);
        Self { s: *points, su: std::array::from_fn(su), sv: std::array::from_fn(sv) }
    }

    /// With the binomials multiplied in.
    fn weighted(mut self) -> Self {
        for (k, p) in self.s.iter_mut().enumerate() {
            *p = times(*p, BINOMIAL_3[k / 4] * BINOMIAL_3[k % 4]);
        }
        for (k, p) in self.su.iter_mut().enumerate() {
            *p = times(*p, BINOMIAL_3[k / 3] * BINOMIAL_2[k % 3]);
        }
        for (k, p) in self.sv.iter_mut().enumerate() {
            *p = times(*p, BINOMIAL_2[k / 4] * BINOMIAL_3[k % 4]);
        }
        self
    }

    fn determinant<T: Wide>(&self) -> [[T; 9]; 9] {
        let of = |row: Row<i64>| row.map(T::of);
        determinant(&self.s.map(of), &self.su.map(of), &self.sv.map(of))
    }
}

/// S . (Su x Sv) as convolutions.
#[inline(always)]
fn determinant<T: Wide>(s: &[Row<T>; 16], su: &[Row<T>; 12], sv: &[Row<T>; 12]) -> [[T; 9]; 9] {
    let mut normal = [[[T::default(); 3]; 6]; 6];
    for (a, &u) in su.iter().enumerate() {
        for (b, &v) in sv.iter().enumerate() {
            let n = &mut normal[a / 3 + b / 4][a % 3 + b % 4];
            let c = cross(u, v);
            *n = [n[0] + c[0], n[1] + c[1], n[2] + c[2]];
        }
    }
    let mut out = [[T::default(); 9]; 9];
    for (a, p) in s.iter().enumerate() {
        for (k, row) in normal.iter().enumerate() {
            for (l, n) in row.iter().enumerate() {
                let o = &mut out[a / 4 + k][a % 4 + l];
                *o = *o + p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
            }
        }
    }
    out
}

/// At a corner the coefficient is the determinant of the corner and its two neighbours.
fn faces_at_a_corner(points: &[Row<i64>; 16]) -> bool {
    [[0, 0, 1, 0, 4], [3, 2, 3, 3, 7], [12, 12, 13, 8, 12], [15, 14, 15, 11, 15]].iter().any(
        |&[s, u0, u1, v0, v1]| {
            let (su, sv) = (minus(points[u1], points[u0]), minus(points[v1], points[v0]));
            exact_sign(points[s], su, sv).is_gt()
        },
    )
}

/// The verdict where 15 bits suffice for it.
fn estimate(points: &[Row<i64>; 16]) -> Option<bool> {
    // Truncated before the binomials are multiplied in: 15 bits hold a control point, not its
    // multiple.
    let mut factors = Factors::of(points);
    let ms = truncate(&mut factors.s);
    let (mu, mv) = (truncate(&mut factors.su), truncate(&mut factors.sv));
    let estimates: [[i64; 9]; 9] = factors.weighted().determinant();
    // Truncation moves each factor by less than one: (s+1)(u+1)(v+1) - suv for each of the six
    // products of a 3 x 3 determinant. Binomial weights of a coefficient add up to C(8,k)
    // C(8,l).
    let slack = 6 * (mu * mv + ms * mv + ms * mu + ms + mu + mv + 1);
    let mut certain = true;
    for (k, row) in estimates.iter().enumerate() {
        for (l, &c) in row.iter().enumerate() {
            let slack = slack * BINOMIAL_8[k] * BINOMIAL_8[l];
            if c > slack {
                return Some(false);
            }
            certain &= c <= -slack;
        }
    }
    certain.then_some(true)
}

/// Shifts all components down until the largest fits the estimate; returns the largest magnitude
/// left.
fn truncate<const N: usize>(rows: &mut [Row<i64>; N]) -> i64 {
    let largest = rows.iter().flatten().map(|c| c.unsigned_abs()).max().unwrap_or(0);
    let bits = u64::BITS - largest.leading_zeros();
    let shift = bits.saturating_sub(ESTIMATE_BITS);
    for c in rows.iter_mut().flatten() {
        *c >>= shift;
    }
    (largest >> shift) as i64 + 1 // floor of a negative is one larger in magnitude
}

/// The exact sign of det[a, b, c], at any width.
#[must_use]
pub(super) fn exact_sign(a: Row<i64>, b: Row<i64>, c: Row<i64>) -> Ordering {
    let small = |row: &Row<i64>| row.iter().all(|c| c.unsigned_abs() < 1 << 40);
    if small(&a) && small(&b) && small(&c) {
        volume::<i128>(a, b, c).cmp(&0) // 3 * 40 + 3 bits
    } else {
        volume::<I256>(a, b, c).cmp(&I256::ZERO)
    }
}

fn volume<T: Wide>(a: Row<i64>, b: Row<i64>, c: Row<i64>) -> T {
    let (a, n) = (a.map(T::of), cross(b.map(T::of), c.map(T::of)));
    a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
}

#[inline(always)]
fn cross<T: Wide>(a: Row<T>, b: Row<T>) -> Row<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn minus(a: Row<i64>, b: Row<i64>) -> Row<i64> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times(a: Row<i64>, k: i64) -> Row<i64> {
    a.map(|c| c * k)
}
