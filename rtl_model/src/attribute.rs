//! Attribute: the values of a patch's corners and a vertex's parameters in, the vertex's values
//! out.
//!
//! Bilinear in (u, v), as Sfarti et al. have the texture coordinates of a patch from those of its
//! corners: along u below and above, then along v, each interpolation rounded once and symmetric
//! in its ends. On an edge the result is a function of that edge's two corners alone, and the same
//! from either end, so that attributes have no seams where positions have no cracks.

use crate::number::{RoundingMode, lerp};

/// The value at (u, v), both U1.16, of a component whose corners P0 P3 P12 P15 are given, in any
/// format of at most 46 bits.
#[must_use]
#[inline]
pub fn accept<R: RoundingMode>([a, b, c, d]: [i64; 4], u: u32, v: u32) -> i64 {
    let (below, above) = (lerp::<R>(a, b, u, 16), lerp::<R>(c, d, u, 16));
    lerp::<R>(below, above, v, 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::NearestEven;
    use crate::patch::{HALF, ONE};
    use proptest::prelude::*;

    fn at(corners: [i64; 4], u: u32, v: u32) -> i64 {
        accept::<NearestEven>(corners, u, v)
    }

    #[test]
    fn corners_are_themselves_and_the_middle_is_their_mean() {
        let corners = [10, -20, 1 << 31, 6];
        assert_eq!([at(corners, 0, 0), at(corners, ONE, 0)], [10, -20]);
        assert_eq!([at(corners, 0, ONE), at(corners, ONE, ONE)], [1 << 31, 6]);
        assert_eq!(at([4, 8, 12, 16], HALF, HALF), 10);
    }

    proptest! {
        #[test]
        fn an_edge_is_a_function_of_its_corners_from_either_end(
            edge in prop::array::uniform2(-(1i64 << 31)..1 << 31),
            others in prop::array::uniform4(-(1i64 << 31)..1 << 31),
            t in 0..=ONE,
        ) {
            let [p, q] = edge;
            let [a, b, c, d] = others;
            let along = at([p, q, a, b], t, 0);
            for again in [
                at([q, p, c, d], ONE - t, 0),
                at([c, d, p, q], t, ONE),
                at([p, a, q, b], 0, t),
                at([c, q, d, p], ONE, ONE - t),
            ] {
                prop_assert_eq!(along, again);
            }
        }
    }
}
