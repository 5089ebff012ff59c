//! Test: a point of the surface and one of the control mesh in, whether a vertex is inserted out.
//!
//! Concheiro et al. 2014, equation 9, of the edge tests of Concheiro et al. 2011 the one that they
//! chose: |V_S - V_B| > mu. Both points are rounded to their format (V_B is what would be emitted)
//! and projected once; the comparison of squared distances is exact. All of it is a function of the
//! two points as a pair, so an edge's decisions are the same from either end.
//!
//! In object space a point is divided by its w, rounded to 1/256 ulp, the threshold's own unit;
//! where w is one, that is exact. Homogeneous points cross-multiplied would need 300 bits.
//!
//! Another edge test is another variant of [`Test`].

use crate::level::{Events, project};
use crate::number::{NearestEven, divide};
use crate::patch::{Point, View};

/// A test and what it needs to know.
#[derive(Clone, Copy, Debug)]
pub(super) enum Test<'a> {
    /// Distance on screen.
    Pixels {
        /// mu in UQ16.16.
        most: u32,
        view: &'a View,
    },
    /// Distance in object space.
    Object {
        /// mu in 1/256 ulp of the object format.
        most: u64,
        /// Fraction bits of the object format: w = 1 is 2^fraction.
        fraction: u32,
    },
}

impl Test<'_> {
    /// Whether the two are further apart than the threshold. Where one has no projection, no
    /// distance says that the vertex may be left out.
    pub(super) fn inserts(&self, mesh: Point, surface: Point) -> bool {
        match *self {
            Self::Pixels { most, view } => {
                let pixel = |point| project(point, view, &mut Events::default());
                match (pixel(mesh), pixel(surface)) {
                    (Some(a), Some(b)) => distant(a, b, most.into()),
                    _ => true,
                }
            }
            Self::Object { most, fraction } => {
                match (affine(mesh, fraction), affine(surface, fraction)) {
                    (Some(a), Some(b)) => distant(a, b, most),
                    _ => true,
                }
            }
        }
    }
}

/// Exact: coordinates below 2^62, so that a square is below 2^126 and three of them below 2^128.
fn distant<const N: usize>(a: [i64; N], b: [i64; N], most: u64) -> bool {
    let differences: [u64; N] = std::array::from_fn(|k| a[k].abs_diff(b[k]));
    if differences.iter().any(|&d| d > most) {
        return true;
    }
    let square = |d: u64| u128::from(d) * u128::from(d);
    differences.iter().map(|&d| square(d)).sum::<u128>() > square(most)
}

/// x / w, y / w, z / w in 1/256 ulp; none where w is not positive or a quotient is 2^61 or more.
fn affine(point: Point, fraction: u32) -> Option<[i64; 3]> {
    let [x, y, z, w] = point;
    if w == 1 << fraction {
        return Some([x, y, z].map(|c| c << 8));
    }
    if w <= 0 {
        return None;
    }
    let quotient = |c: i64| {
        // 48 + 47 + 8 bits
        let quotient = divide::<NearestEven>(i128::from(c) << (fraction + 8), w.into());
        i64::try_from(quotient).ok().filter(|q| q.unsigned_abs() < 1 << 61)
    };
    Some([quotient(x)?, quotient(y)?, quotient(z)?])
}
