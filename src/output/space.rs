//! Numbers of the hardware as real numbers: exact clip coordinates, and positions in world space
//! for viewing.

use crate::sink::Grid;
use rtl_model::esc::fraction;
use rtl_model::number::Format;
use rtl_model::patch::{ONE, Point};

/// What one unit in the last place is worth: a power of two.
///
/// # Panics
/// When it is no normal f64, which formats of at most 48 bits around f32's exponents never reach.
#[must_use]
pub fn ulp(format: Format) -> f64 {
    let exponent = 1023 - i64::from(format.fraction);
    assert!((1..2047).contains(&exponent), "the ulp of {format:?} is a normal number");
    // Not `powi`, whose precision is not specified.
    f64::from_bits((exponent as u64) << 52)
}

/// The homogeneous coordinates of a raw point: exact, for 48 bits are fewer than 53.
#[must_use]
pub fn real(point: Point, ulp: f64) -> [f64; 4] {
    point.map(|raw| raw as f64 * ulp)
}

/// A parameter: U1.16 is exact, a fraction the nearest double.
#[must_use]
pub fn parameter(raw: u32, grid: Grid) -> f64 {
    let (parts, all) = match grid {
        Grid::Fx16 => (raw, ONE),
        Grid::Thirds => fraction(raw),
    };
    f64::from(parts) / f64::from(all)
}

/// Where in the world the matrix `m`, column-major, takes a homogeneous point, to f32 precision.
/// Where that is nowhere (w = 0), the origin: a viewer can do nothing with NaN.
#[must_use]
pub fn world(m: &[f64; 16], point: [f64; 4]) -> [f32; 3] {
    let row = |r: usize| (0..4).map(|c| m[4 * c + r] * point[c]).sum::<f64>();
    let w = row(3);
    let position = [0, 1, 2].map(|r| (row(r) / w) as f32);
    if position.iter().all(|c| c.is_finite()) { position } else { [0.0; 3] }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::sink::FrameInfo;
    use rtl_model::patch::{Depth, View};

    /// A world that is the clip space halved.
    pub(in crate::output) const HALVED: [f64; 16] =
        [0.5, 0., 0., 0., 0., 0.5, 0., 0., 0., 0., 0.5, 0., 0., 0., 0., 1.];

    /// A frame with 16 fraction bits.
    pub(in crate::output) fn frame() -> FrameInfo {
        let view = View {
            position: Format { width: 32, fraction: 16 },
            viewport: [640, 480],
            depth: Depth::ZeroToOne,
            near: 1,
            facing: 1,
        };
        FrameInfo { number: 0, view, grid: Grid::Fx16, eye: view, object: view.position, near: 0.1 }
    }

    #[test]
    fn raw_integers_become_exact_reals() {
        assert_eq!(ulp(Format { width: 32, fraction: 16 }), 1.0 / 65536.0);
        assert_eq!(ulp(Format { width: 8, fraction: -3 }), 8.0);
        let odd = (1 << 47) - 1;
        assert_eq!(real([odd, -odd, 0, 1], 1.0), [odd as f64, -(odd as f64), 0.0, 1.0]);
    }

    #[test]
    fn parameters_are_what_their_grid_makes_of_them() {
        assert_eq!([0, 21845, ONE].map(|t| parameter(t, Grid::Thirds)), [0.0, 1.0 / 3.0, 1.0]);
        assert_eq!(parameter(21845, Grid::Fx16), 21845.0 / 65536.0);
        assert_eq!(parameter(63_716, Grid::Thirds), 35.0 / 36.0); // 63715.6
    }

    #[test]
    fn world_positions_are_divided_and_always_finite() {
        assert_eq!(world(&HALVED, [2.0, -4.0, 6.0, 2.0]), [0.5, -1.0, 1.5]);
        assert_eq!(world(&HALVED, [2.0, 0.0, 0.0, 0.0]), [0.0; 3]);
        assert_eq!(world(&HALVED, [0.0; 4]), [0.0; 3]);
    }
}
