//! Path: how far through an animation in, directions, distances and rotations out. Rational
//! functions and square roots only, so that every machine gets the same bits.

use super::super::round;
use glam::{DMat3, DVec3};
use std::f64::consts::SQRT_2;

/// The direction after `n` of `all` parts of a turn: of length 1, exact at every eighth.
///
/// Between eighths the angle is 2 atan(s tan(pi / 8)) for a share s of the eighth, which is less
/// than a fortieth of it from s pi / 4.
pub(super) fn direction(n: u32, all: u32) -> [f64; 2] {
    let (eighths, all) = (8 * u64::from(n), u64::from(all));
    let [x, y] = round::direction((eighths / all % 8) as usize);
    let t = (eighths % all) as f64 / all as f64 * (SQRT_2 - 1.0); // tan of half the angle
    let (c, s) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
    [x * c - y * s, x * s + y * c]
}

/// The rotation about `axis` by the angle of the direction `[c, s]`: Rodrigues.
pub(super) fn rotation(axis: DVec3, [c, s]: [f64; 2]) -> DMat3 {
    let DVec3 { x, y, z } = axis.normalize();
    let u = 1.0 - c;
    DMat3::from_cols_array(&[
        c + u * x * x,
        u * x * y + s * z,
        u * x * z - s * y,
        u * x * y - s * z,
        c + u * y * y,
        u * y * z + s * x,
        u * x * z + s * y,
        u * y * z - s * x,
        c + u * z * z,
    ])
}

/// 2^-p as a chain of straight lines between the whole p, p at least 0.
pub(super) fn halved(p: f64) -> f64 {
    let whole = p.floor();
    (0..whole as u32).fold(1.0, |size, _| size / 2.0) * (1.0 - (p - whole) / 2.0)
}

/// How far frame `n` of `all` is from the first to the last: from 0 to 1; 0 for an only one.
pub(super) fn share(n: u32, all: u32) -> f64 {
    f64::from(n) / f64::from(all.max(2) - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_go_round_once_and_evenly() {
        for all in [1, 2, 3, 8, 24, 100] {
            let mut compared = 0;
            for n in 0..all {
                let [c, s] = direction(n, all);
                assert!((c * c + s * s - 1.0).abs() < 1e-15);
                let turn = std::f64::consts::TAU;
                let off = (s.atan2(c) / turn - f64::from(n) / f64::from(all)).rem_euclid(1.0);
                assert!(off.min(1.0 - off) < 1.0 / 8.0 / 40.0, "{n} of {all}: {off}");
                compared += 1;
            }
            assert_eq!(compared, all);
        }
        assert_eq!(direction(6, 24), [0.0, 1.0]);
        assert_eq!(direction(24, 24), [1.0, 0.0]);
    }

    #[test]
    fn rotations_keep_their_axis_and_turn_right_handed() {
        let axis = DVec3::new(1.0, -2.0, 0.5);
        let turn = rotation(axis, direction(7, 24));
        assert!((turn * axis - axis).length() < 1e-14);
        assert!((turn.determinant() - 1.0).abs() < 1e-14);
        assert_eq!(rotation(DVec3::Z, [0.0, 1.0]) * DVec3::X, DVec3::Y);
    }

    #[test]
    fn halves_join() {
        assert_eq!([0.0, 1.0, 3.0, 0.5].map(halved), [1.0, 0.5, 0.125, 0.75]);
        assert!((halved(1.999_999) - 0.25).abs() < 1e-6);
    }
}
