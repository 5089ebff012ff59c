//! Two cones: points in; whether the cone of all directions to the surface is everywhere at a right
//! angle or more to the cone of all its normals out.
//!
//! After Shirmun and Abi-Ezzi 1993, whose cone of normals is tested against the viewer; the
//! formulation over the rows x, y, w is ours. There the viewer is the origin, and the front shows
//! where det[S, Su, Sv] = S . N > 0 with N = Su x Sv. S is a convex combination of the 16 points,
//! N (a polynomial of bidegree (5, 5)) of its 36 Bernstein coefficients. So if every P lies within
//! the angle A of an axis a, and every N within B of an axis b, A and B below 90 degrees, then S
//! and N do, and the angle between them is at least angle(a, b) - A - B. If that is 90 degrees or
//! more, no point shows its front. Nothing here is particular to a position of the viewer, to
//! parallel or perspective projections, or to weights.
//!
//! Integers, and every rounding outwards. Directions are shifted to 20 bits, which moves a
//! component by less than one; axes, whose choice is free, are sums of directions shifted to 12
//! bits. Cosines are rounded down and sines up, to 20 bits: a cone of one direction is 0.2 degrees
//! wide.

use super::tangent::{self, Row};

/// Bits of a direction's largest component, without the sign.
const DIRECTION_BITS: u32 = 20;
/// Bits of an axis' largest component.
const AXIS_BITS: u32 = 12;
/// Fraction bits of a cosine; of its square twice as many.
const COSINE_BITS: u32 = 20;

/// The axes, the points, the coefficients of the normal.
pub(super) const DIRECTIONS: u32 = 1 + 16 + 36;

/// How many directions are looked at until the patch must be kept, `None` if it need not: first the
/// two axes against each other, then the points, then the coefficients of the normal, row by row;
/// with the last of these the widths of the cones are known and decide. `points` are x, y, w with
/// positive volumes in front.
#[must_use]
pub fn normal_cone(points: &[Row<i64>; 16]) -> Option<u32> {
    let directions = points.map(|p| normalised(p.map(i128::from), DIRECTION_BITS));
    let coefficients = tangent::normals::<i128>(points); // 2 W + 9 bits
    let normals = coefficients.map(|n| normalised(n, DIRECTION_BITS));
    if normals.iter().all(|&n| n == [0; 3]) {
        return None; // a curve or a point: nothing to see
    }
    let (a, b) = (axis(&directions), axis(&normals));
    let along = dot(a, b);
    if along >= 0 {
        return Some(1);
    }
    let squares = widest(a, &directions)
        .map_err(|k| 2 + k)
        .and_then(|s| Ok([s, widest(b, &normals).map_err(|k| 18 + k)?]));
    match squares {
        Ok(squares) if apart(along, dot(a, a) * dot(b, b), squares) => None,
        Ok(_) => Some(DIRECTIONS),
        Err(looked_at) => Some(looked_at),
    }
}

/// Whether the angle between the axes, their dot product `along`, below 0, and the product of their
/// squared lengths, is at least 90 degrees and the half-angles of both cones, the squares of their
/// cosines.
fn apart(along: i64, lengths: i64, squares: [u64; 2]) -> bool {
    let one = 1u64 << (2 * COSINE_BITS);
    let [cos_a, cos_b] = squares.map(u64::isqrt);
    let sine = |cosine: u64| root_up((one - cosine * cosine).into());
    let (sin_a, sin_b) = (sine(cos_a), sine(cos_b));
    // cos A < sin B: A + B is more than 90 degrees.
    if u128::from(cos_a) < sin_b {
        return false;
    }
    let sine_of_sum = sin_a * u128::from(cos_b) + u128::from(cos_a) * sin_b; // U2.40
    let length = root_up(lengths.unsigned_abs().into()); // of 52 bits
    u128::from(along.unsigned_abs()) << (2 * COSINE_BITS) >= length * sine_of_sum
}

/// The square of a lower bound of the cosine of a cone's half-angle, U1.40; the number of the first
/// direction, from 0, that may be at 90 degrees or more to the axis. Nothing has no direction, and
/// is in every cone.
fn widest(axis: Row<i64>, directions: &[Row<i64>]) -> Result<u64, u32> {
    let squared = |v| u128::from(dot(v, v).unsigned_abs());
    // What the shift cut off a component is at least 0 and less than 1.
    let cut: i64 = axis.iter().map(|c| c.abs()).sum();
    // (axis . direction)^2 over direction^2, the least so far: at first that of the axis itself.
    let mut least = (squared(axis), 1);
    for (k, &direction) in (0..).zip(directions).filter(|(_, v)| **v != [0; 3]) {
        let along = dot(axis, direction) - cut; // 34 bits
        if along <= 0 {
            return Err(k);
        }
        let ratio =
            (u128::from(along.unsigned_abs()).pow(2), squared(direction.map(|c| c.abs() + 1)));
        if ratio.0 * least.1 < least.0 * ratio.1 {
            least = ratio; // 68 bits over 42
        }
    }
    Ok(((least.0 << (2 * COSINE_BITS)) / (squared(axis) * least.1)) as u64)
}

/// The axis of a cone: the sum of its directions, all of about the same length. It need not be the
/// best.
fn axis(directions: &[Row<i64>]) -> Row<i64> {
    let sum = directions.iter().fold([0; 3], |s, d| [s[0] + d[0], s[1] + d[1], s[2] + d[2]]);
    normalised(sum.map(i128::from), AXIS_BITS)
}

/// A direction shifted until its largest component has so many bits; bits shifted out are cut off
/// (floor). Nothing stays nothing.
fn normalised(row: Row<i128>, bits: u32) -> Row<i64> {
    let largest = row.iter().map(|c| c.unsigned_abs()).max().unwrap_or(0);
    if largest == 0 {
        return [0; 3];
    }
    let has = u128::BITS - largest.leading_zeros();
    let shift = |c: i128| if has > bits { c >> (has - bits) } else { c << (bits - has) };
    row.map(|c| shift(c) as i64)
}

fn dot(a: Row<i64>, b: Row<i64>) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The root, rounded up.
fn root_up(square: u128) -> u128 {
    let root = square.isqrt();
    root + u128::from(root * root < square)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat net around (0, 0, 1000) with edges of 3 `size`, positive in front for `side` 1.
    fn flat(size: i64, side: i64) -> [Row<i64>; 16] {
        std::array::from_fn(|k| {
            let (i, j) = (k as i64 / 4, k as i64 % 4);
            [side * size * (2 * j - 3) / 2, size * (2 * i - 3) / 2, 1000]
        })
    }

    #[test]
    fn a_flat_patch_is_removed_from_behind_while_it_fills_less_than_a_half_space() {
        for size in [2, 100, 1000, 10_000] {
            assert_eq!(normal_cone(&flat(size, 1)), Some(1), "{size}: seen from the front");
            assert_eq!(normal_cone(&flat(size, -1)), None, "{size}: seen from behind");
        }
        // Tilted, and then so near that the viewer is beside a corner and hardly behind the plane.
        let tilted = |w: i64| flat(100, -1).map(|[x, y, _]| [x, y, w + y]);
        assert_eq!(normal_cone(&tilted(1000)), None);
        assert_eq!(normal_cone(&tilted(200)), Some(DIRECTIONS));
    }

    #[test]
    fn what_has_no_area_is_removed_and_what_turns_too_far_is_kept() {
        assert_eq!(normal_cone(&[[0; 3]; 16]), None);
        assert_eq!(normal_cone(&[[3, 4, 5]; 16]), None);
        let line = std::array::from_fn(|k| [k as i64, 2 * k as i64, 9]);
        assert_eq!(normal_cone(&line), None);
        // The viewer between the points: no axis is within 90 degrees of all of them.
        let around = flat(100, -1).map(|[x, y, w]| [x, y, w - 1000 + x]);
        assert!(normal_cone(&around).is_some());
    }

    #[test]
    fn cosines_are_rounded_down_and_widths_add_up() {
        let one = 1u64 << 40;
        let axis = [4095, 0, 0];
        let square = |direction| widest(axis, &[normalised(direction, DIRECTION_BITS)]);
        let (ahead, slanted) = (square([1, 0, 0]).unwrap(), square([5, 5, 0]).unwrap());
        assert!(ahead < one && one - ahead < one >> 17, "{ahead}");
        assert!(slanted < one / 2 && one / 2 - slanted < one >> 17, "{slanted}");
        assert_eq!(square([0, 1, 0]), Err(0));
        assert_eq!(square([0, 0, 0]), Ok(one));
        let [near, far] = [[1, 0, 0], [5, 5, 0]].map(|v| normalised(v, DIRECTION_BITS));
        assert_eq!(widest(axis, &[near, far, near]), Ok(slanted), "the widest counts");
        assert_eq!(widest(axis, &[far, [-1, 0, 0]]), Err(1));
        // Axes 120 degrees apart: cos = -1/2. 15 + 15 degrees fit, 15 + 16 do not.
        let cosine = |degrees: f64| (degrees.to_radians().cos().powi(2) * one as f64) as u64;
        let at = |a: f64, b: f64| apart(-1000, 2000 * 2000, [cosine(a), cosine(b)]);
        assert!(at(15.0, 14.99) && !at(15.0, 15.01) && at(29.9, 0.001) && !at(50.0, 50.0));
        // Opposite axes, and cones of 160 degrees together: the sine of that is small again.
        assert!(!apart(-2000, 2000 * 2000, [cosine(80.0), cosine(80.0)]));
    }

    #[test]
    fn what_is_cut_off_a_direction_never_narrows_a_cone() {
        let mut state = 1u64;
        let mut draw = |bits: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as i128 % (2 << bits) - (1 << bits)
        };
        let mut compared = 0;
        for _ in 0..20_000 {
            let axis = normalised([(); 3].map(|()| draw(11)), AXIS_BITS);
            let v = [(); 3].map(|()| draw(28));
            if let Ok(square) = widest(axis, &[normalised(v, DIRECTION_BITS)]) {
                let a = axis.map(i128::from);
                let dot = |b: Row<i128>, c: Row<i128>| b[0] * c[0] + b[1] * c[1] + b[2] * c[2];
                let along = dot(a, v);
                assert!(
                    along > 0 && i128::from(square) * dot(a, a) * dot(v, v) <= along.pow(2) << 40
                );
                compared += 1;
            }
        }
        assert!(compared > 5_000, "{compared}");
    }
}
