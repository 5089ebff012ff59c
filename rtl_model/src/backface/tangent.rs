//! The 81 Bernstein coefficients of det[S, Su, Sv] and the decision on their signs.
//!
//! With binomials multiplied in, s = C(3,i) C(3,j) P_ij and likewise for the derivatives, products
//! of polynomials are plain convolutions and no division is needed: 144 cross products make the 36
//! coefficients of N = Su x Sv, 576 dot products the 81 of S . N. Their size: 70 * 70 * 6 * 4 *
//! 2^(3(W-1)), 3W + 14 bits with the sign; i128 up to 36-bit positions, 256 bits beyond.
//!
//! They are looked at in this order until one is towards the viewer: the four corners, which are
//! cheap, then the others row by row.
//!
//! Most patches are decided earlier, with the same result and the same count: by a corner, or by
//! 15-bit truncations of S, Su, Sv in 64-bit arithmetic with an error bound. Only a coefficient
//! within that bound of zero, before any that is certainly towards the viewer, calls for the exact
//! ones.

use crate::number::Wide;
use ethnum::I256;
use std::cmp::Ordering;

/// x, y, w.
pub(super) type Row<T> = [T; 3];

/// Widest position whose coefficients fit 128 bits.
pub(super) const WIDTH_MAX_128: u32 = 36;

/// Coefficients of bidegree (8, 8).
pub(super) const COEFFICIENTS: u32 = 81;

/// Bits, without the sign, that the estimate keeps: 3 * 15 + log2(6 * 70 * 70) = 59.9.
const ESTIMATE_BITS: u32 = 15;

const BINOMIAL_2: [i64; 3] = [1, 2, 1];
const BINOMIAL_3: [i64; 4] = [1, 3, 3, 1];
const BINOMIAL_8: [i64; 9] = [1, 8, 28, 56, 70, 56, 28, 8, 1];

/// How many coefficients are looked at until one is towards the viewer, `None` if none is; `points`
/// are x, y, w with positive volumes in front.
#[must_use]
pub fn tangent_plane(points: &[Row<i64>; 16], width: u32) -> Option<u32> {
    faces_at_a_corner(points).or_else(|| {
        estimate(points).unwrap_or_else(|| {
            if width <= WIDTH_MAX_128 {
                first_positive(&coefficients::<i128>(points))
            } else {
                first_positive(&coefficients::<I256>(points))
            }
        })
    })
}

fn first_positive<T: Wide>(coefficients: &[[T; 9]; 9]) -> Option<u32> {
    inner(coefficients).find(|&(_, &c)| c > T::default()).map(|(looked_at, _)| looked_at)
}

/// What is left when the corners are not towards the viewer, row by row, each with how many
/// coefficients have been looked at then.
fn inner<T>(coefficients: &[[T; 9]; 9]) -> impl Iterator<Item = (u32, &T)> {
    let corner = |k: usize| matches!(k, 0 | 8 | 72 | 80);
    let all = coefficients.as_flattened().iter().enumerate();
    (5..).zip(all.filter(move |&(k, _)| !corner(k)).map(|(_, c)| c))
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

/// The 36 coefficients of N = Su x Sv, row by row, times C(5,k) C(5,l) / 9.
#[must_use]
pub(super) fn normals<T: Wide>(points: &[Row<i64>; 16]) -> [Row<T>; 36] {
    let Factors { su, sv, .. } = Factors::of(points).weighted();
    let of = |row: Row<i64>| row.map(T::of);
    let normals = products(&su.map(of), &sv.map(of));
    std::array::from_fn(|k| normals[k / 6][k % 6])
}

/// Su x Sv as a convolution.
#[inline(always)]
fn products<T: Wide>(su: &[Row<T>; 12], sv: &[Row<T>; 12]) -> [[Row<T>; 6]; 6] {
    let mut normals = [[[T::default(); 3]; 6]; 6];
    for (a, &u) in su.iter().enumerate() {
        for (b, &v) in sv.iter().enumerate() {
            let n = &mut normals[a / 3 + b / 4][a % 3 + b % 4];
            let c = cross(u, v);
            *n = [n[0] + c[0], n[1] + c[1], n[2] + c[2]];
        }
    }
    normals
}

/// S . (Su x Sv) as convolutions.
#[inline(always)]
fn determinant<T: Wide>(s: &[Row<T>; 16], su: &[Row<T>; 12], sv: &[Row<T>; 12]) -> [[T; 9]; 9] {
    let normals = products(su, sv);
    let mut out = [[T::default(); 9]; 9];
    for (a, &p) in s.iter().enumerate() {
        for (k, row) in normals.iter().enumerate() {
            for (l, &n) in row.iter().enumerate() {
                let o = &mut out[a / 4 + k][a % 4 + l];
                *o = *o + p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
            }
        }
    }
    out
}

/// At a corner the coefficient is the determinant of the corner and its two neighbours. How many
/// corners are looked at until one is towards the viewer.
fn faces_at_a_corner(points: &[Row<i64>; 16]) -> Option<u32> {
    let corners = [[0, 0, 1, 0, 4], [3, 2, 3, 3, 7], [12, 12, 13, 8, 12], [15, 14, 15, 11, 15]];
    let first = corners.iter().position(|&[s, u0, u1, v0, v1]| {
        let (su, sv) = (minus(points[u1], points[u0]), minus(points[v1], points[v0]));
        exact_sign(points[s], su, sv).is_gt()
    });
    first.map(|k| k as u32 + 1)
}

/// The first coefficient towards the viewer, or that none is, where 15 bits suffice to know it and
/// no corner is.
fn estimate(points: &[Row<i64>; 16]) -> Option<Option<u32>> {
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
    let slacks = BINOMIAL_8.map(|k| BINOMIAL_8.map(|l| slack * k * l));
    for ((looked_at, &c), (_, &slack)) in inner(&estimates).zip(inner(&slacks)) {
        if c > slack {
            return Some(Some(looked_at));
        }
        if c > -slack {
            return None;
        }
    }
    Some(None)
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
    dot(a.map(T::of), cross(b.map(T::of), c.map(T::of)))
}

#[inline(always)]
pub(super) fn dot<T: Wide>(a: Row<T>, b: Row<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<T: Wide>(a: Row<T>, b: Row<T>) -> Row<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn minus(a: Row<i64>, b: Row<i64>) -> Row<i64> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times(a: Row<i64>, k: i64) -> Row<i64> {
    a.map(|c| c * k)
}
