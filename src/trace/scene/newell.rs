//! Newell: the four models of Martin Newell's tea set, University of Utah, 1975, as bicubic Bézier
//! patches.
//!
//! The numbers of the 32-patch teapot are those of three.js,
//! `examples/jsm/geometries/TeapotGeometry.js` (MIT, the three.js authors); those of the other
//! three are from freeglut 3.4.0, `src/fg_teapot_data.h`, the comment block `teasetorig.gz` (X11
//! licence, Pawel W. Olszta), by way of P. Schneider, 1990. They are kept as they are, gaps and
//! all: the 28-patch teapot and the teaspoon have seams that are up to 8e-4 apart, and handle,
//! spout and lid meet the body of no pot. The files are plain BPT ([`super::super::import`]).

use super::super::import::read_bpt;

/// A model of the tea set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Newell {
    /// 32 patches, z up, with a bottom; its patches face outward.
    Teapot,
    /// 28 patches, y up, without a bottom; its patches face inward.
    Teapot28,
    /// 26 patches, y up, cup and saucer of one piece; its patches face inward.
    Teacup,
    /// 16 patches, z up, y along the handle; its patches face inward.
    Teaspoon,
}

impl Newell {
    /// Control points, 16 a patch, row-major.
    #[must_use]
    pub fn points(self) -> Vec<[f32; 3]> {
        let (name, text) = match self {
            Self::Teapot => ("teapot.bpt", include_str!("teapot.bpt")),
            Self::Teapot28 => ("teapot_28.bpt", include_str!("teapot_28.bpt")),
            Self::Teacup => ("teacup.bpt", include_str!("teacup.bpt")),
            Self::Teaspoon => ("teaspoon.bpt", include_str!("teaspoon.bpt")),
        };
        read_bpt(text.as_bytes(), name).expect("the models that are built in are well-formed")
    }

    /// Whether `Su x Sv` points into the solid, so that a draw must say `"front":"reversed"`.
    #[must_use]
    pub fn faces_inward(self) -> bool {
        self != Self::Teapot
    }

    /// Whether z is up, not y.
    #[must_use]
    pub fn is_z_up(self) -> bool {
        matches!(self, Self::Teapot | Self::Teaspoon)
    }

    /// Where the numbers are from.
    #[must_use]
    pub fn source(self) -> &'static str {
        match self {
            Self::Teapot => "M. Newell, 1975; numbers as in three.js TeapotGeometry.js",
            _ => "M. Newell, 1975, via P. Schneider, 1990; numbers as in freeglut fg_teapot_data.h",
        }
    }

    /// The licence of the file that the numbers are from.
    #[must_use]
    pub fn licence(self) -> &'static str {
        match self {
            Self::Teapot => "MIT (three.js authors)",
            _ => "X11 (freeglut, Pawel W. Olszta)",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const ALL: [Newell; 4] = [Newell::Teapot, Newell::Teapot28, Newell::Teacup, Newell::Teaspoon];

    /// Bernstein polynomials and their derivatives at `t`.
    fn basis(t: f64) -> ([f64; 4], [f64; 4]) {
        let s = 1.0 - t;
        let values = [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t];
        let slopes = [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t];
        (values, slopes)
    }

    /// Thrice the volume that a patch sweeps from the origin, by the divergence theorem: positive
    /// where it faces out.
    fn volume(patch: &[[f32; 3]]) -> f64 {
        const N: usize = 8;
        let sum = |bu: &[f64; 4], bv: &[f64; 4]| {
            let term = |i: usize| DVec3::from(patch[i].map(f64::from)) * bu[i % 4] * bv[i / 4];
            (0..16).map(term).sum::<DVec3>()
        };
        let at = |i: usize| basis((i as f64 + 0.5) / N as f64);
        let cells = (0..N * N).map(|i| (at(i % N), at(i / N)));
        let swept =
            cells.map(|((bu, du), (bv, dv))| sum(&bu, &bv).dot(sum(&du, &bv).cross(sum(&bu, &dv))));
        swept.sum::<f64>() / (N * N) as f64
    }

    #[test]
    fn models_have_their_patches() {
        let counts = ALL.map(|m| m.points().len());
        assert_eq!(counts, [32 * 16, 28 * 16, 26 * 16, 16 * 16]);
    }

    #[test]
    fn the_sign_of_the_volume_says_which_way_patches_face() {
        for model in ALL {
            let total: f64 = model.points().chunks(16).map(volume).sum();
            assert_eq!(total < 0.0, model.faces_inward(), "{model:?}: {total}");
        }
        // Every patch of the teapot by itself, its origin being inside.
        assert!(Newell::Teapot.points().chunks(16).all(|patch| volume(patch) > 0.0));
    }
}
