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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Format;
    use crate::patch::Depth;

    const VIEW: View = View {
        position: Format { width: 32, fraction: 16 },
        viewport: [8, 16],
        depth: Depth::ZeroToOne,
        near: 1 << 16,
        facing: 1,
    };

    /// 3-4-5: on the threshold nothing is inserted, an ulp of either side of it decides.
    #[test]
    fn the_distance_is_compared_exactly() {
        let one = 1 << 16;
        let inserts = |most, p, q| Test::Pixels { most, view: &VIEW }.inserts(p, q);
        // x / w * 4 and y / w * 8 pixels: 5 and 4 apart
        let [a, b] = [[one, one, 0, 2 * one], [7 * one / 2, 2 * one, 5, 2 * one]];
        let root = (41_f64.sqrt() * 65536.0) as u32; // rounded down
        assert!(inserts(root, a, b) && !inserts(root + 1, a, b));
        // 3 and 4
        let b = [5 * one / 2, 2 * one, 5, 2 * one];
        assert!(!inserts(5 << 16, a, b) && inserts((5 << 16) - 1, a, b));
        assert!(!inserts(5 << 16, b, a) && inserts((5 << 16) - 1, b, a));
        assert!(!inserts(0, a, a) && inserts(1, a, b));
    }

    #[test]
    fn what_has_no_projection_is_inserted() {
        let point = |w| [5, 5, 5, w];
        let inserts = |w| {
            let test = Test::Pixels { most: u32::MAX, view: &VIEW };
            assert_eq!(
                test.inserts(point(w), point(1 << 20)),
                test.inserts(point(1 << 20), point(w))
            );
            test.inserts(point(w), point(1 << 20))
        };
        assert!(inserts((1 << 16) - 1) && !inserts(1 << 16));
        assert!(inserts(0) && inserts(-5));
        let object = |w| {
            let test = Test::Object { most: u64::MAX, fraction: 8 };
            assert_eq!(test.inserts(point(w), point(9)), test.inserts(point(9), point(w)));
            test.inserts(point(w), point(9))
        };
        assert!(object(0) && object(-1) && !object(1) && !object(256));
        // A quotient of 2^61 and more is none.
        let near = Test::Object { most: u64::MAX, fraction: 40 };
        assert!(!near.inserts([(1 << 13) - 1, 0, 0, 1], [0, 0, 0, 1]));
        assert!(near.inserts([1 << 13, 0, 0, 1], [0, 0, 0, 1]));
        assert!(near.inserts([0, 0, -(1 << 13), 1], [0, 0, 0, 1]));
    }

    /// Three axes, in 1/256 ulp; homogeneous points stand for what they are divided.
    #[test]
    fn in_object_space_w_divides() {
        let fraction = 10;
        let one = 1 << fraction;
        let inserts = |most, p, q| Test::Object { most, fraction }.inserts(p, q);
        let [a, b] = [[10, 20, 30, one], [12, 23, 36, one]]; // 2, 3, 6: 7
        assert!(
            !inserts(7 << 8, a, b) && inserts((7 << 8) - 1, a, b) && inserts((7 << 8) - 1, b, a)
        );
        let doubled = |p: Point| p.map(|c| 2 * c);
        for (p, q) in [(doubled(a), b), (a, doubled(b)), (doubled(a), doubled(b))] {
            assert!(!inserts(7 << 8, p, q) && inserts((7 << 8) - 1, p, q));
        }
        // x = 10 / 3, y = 20 / 3, z = 10 in ulps; a quotient is rounded to 1/256.
        let third = [10, 20, 30, 3 * one];
        let distance = |c: f64, x: f64| ((c - x) * 256.0).round();
        let exact = [10.0, 20.0, 30.0].map(|c| distance(c, c / 3.0).powi(2)).iter().sum::<f64>();
        assert!(
            inserts(exact.sqrt() as u64, a, third) && !inserts(exact.sqrt() as u64 + 1, a, third)
        );
        let axis = |k: usize| std::array::from_fn(|n| a[n] + i64::from(n == k));
        assert!((0..3).all(|k| inserts(255, a, axis(k)) && !inserts(256, a, axis(k))));
    }

    /// The greatest differences: no square overflows.
    #[test]
    fn the_widest_distances_are_exact() {
        let end = 1 << 61;
        assert!(!distant([end; 3], [end; 3], 0));
        assert!(distant([end; 3], [-end; 3], 1 << 62)); // sqrt(3) times that
        assert!(!distant([end, 0, 0], [-end, 0, 0], 1 << 62));
        assert!(distant([end, 1, 0], [-end, 0, 0], 1 << 62));
        assert!(distant([end, 0], [-end, 0], (1 << 62) - 1));
    }
}
