//! Midpoint subdivision: a piece of a curve in, whether it is flat in pixels out.
//!
//! The piece's control points come from the curve's blossom in f64, at its two ends and nothing
//! between, so no error is handed down from piece to piece. How far the block's own rounding may
//! move the height is worked out beside it: where that could turn the verdict, there is none.

use super::PIXEL_MAX;
use rtl_model::patch::{Point, View};

/// What is to become of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A point of it has no projection.
    NoProjection,
    /// Its inner points are within so many pixels of its chord.
    Flat,
    /// They are not.
    Bent,
    /// Rounding may decide.
    Unsure,
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// The whole curve.
    pub curve: &'a [Point; 4],
    /// Where the piece begins, in 128ths.
    pub first: u32,
    /// Divisions that led to it.
    pub depth: u32,
}

/// A projected point, and how far the block's may be from it.
struct Projected {
    pixel: [f64; 2],
    blur: f64,
}

/// Whether a piece is flat to within `d` pixels.
#[must_use]
pub fn verdict(piece: Piece<'_>, view: &View, d: f64) -> Verdict {
    let [s, t] = [piece.first, piece.first + (128 >> piece.depth)].map(|k| f64::from(k) / 128.0);
    let points = [[s, s, s], [s, s, t], [s, t, t], [t, t, t]];
    let projected = points.map(|at| project(blossom(piece.curve, at), view, piece.depth));
    if projected.iter().any(|p| matches!(p, Some(Err(())))) {
        return Verdict::NoProjection;
    }
    let [Some(Ok(a)), Some(Ok(b)), Some(Ok(c)), Some(Ok(e))] = projected else {
        return Verdict::Unsure;
    };
    let blur = [&a, &b, &c, &e].map(|p| p.blur).into_iter().fold(0.0, f64::max);
    let from = |p: &Projected| [p.pixel[0] - a.pixel[0], p.pixel[1] - a.pixel[1]];
    let ([x, y], inner) = (from(&e), [from(&b), from(&c)]);
    let chord = x.hypot(y);
    let reach = inner.map(|[x, y]| x.hypot(y)).into_iter().fold(0.0, f64::max);
    let (height, moved) = if chord > 4.0 * blur {
        let heights = inner.map(|p| (p[0] * y - p[1] * x).abs() / chord);
        // A line through two blurred points is off by more where it is prolonged; and the block
        // rounds the chord's length down.
        let lever = 1.0 + 2.0 * (1.0 + reach / (chord - 2.0 * blur));
        (heights[0].max(heights[1]), blur * lever + d / 65536.0 / chord * 1.01)
    } else if piece.depth == 0 && chord == 0.0 {
        (reach, 2.0 * blur)
    } else {
        return Verdict::Unsure;
    };
    match height - d {
        off if off.abs() <= moved => Verdict::Unsure,
        off if off > 0.0 => Verdict::Bent,
        _ => Verdict::Flat,
    }
}

/// The multi-affine form of a cubic, its coordinates x, y and w.
fn blossom(curve: &[Point; 4], at: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for choice in 0..8_usize {
        let bit = |k: usize| choice >> k & 1 == 1;
        let factor = |k: usize| if bit(k) { at[k] } else { 1.0 - at[k] };
        let weight = factor(0) * factor(1) * factor(2);
        let [x, y, _, w] = curve[choice.count_ones() as usize].map(|c| c as f64);
        [x, y, w].iter().zip(&mut sum).for_each(|(c, sum)| *sum += weight * c);
    }
    sum
}

/// `Err` where there is no projection, `None` where rounding may decide that.
fn project([x, y, w]: [f64; 3], view: &View, depth: u32) -> Option<Result<Projected, ()>> {
    // Each division rounds down by up to 2^-12 ulps, once for each form.
    let off = f64::from(depth) / 4096.0 + x.abs().max(y.abs()).max(w) * 2f64.powi(-50);
    let least = view.near.max(0) as f64;
    if depth == 0 {
        if w < view.near as f64 || w <= 0.0 {
            return Some(Err(()));
        }
    } else if w < least - off {
        return Some(Err(()));
    } else if w <= least + off {
        return None;
    }
    let (mut blur, mut farthest) = (0f64, 0f64);
    let pixel = [(x, 0), (y, 1)].map(|(c, k)| {
        let half = f64::from(view.viewport[k]) / 2.0;
        let moved = if depth == 0 { 0.0 } else { off / (w - off) * (1.0 + (c / w).abs()) };
        blur = blur.max(half * moved);
        farthest = farthest.max((c / w * half).abs());
        c / w * half
    });
    // Half an ulp of rounding; a diagonal is the longer of two blurs.
    let blur = (blur + 0.51 / 65536.0 + farthest * 2f64.powi(-48)) * std::f64::consts::SQRT_2;
    if (farthest - PIXEL_MAX).abs() <= blur + 2.0 / 65536.0 {
        return None;
    }
    Some(if farthest > PIXEL_MAX { Err(()) } else { Ok(Projected { pixel, blur }) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blossom_at_one_parameter_is_the_curve() {
        let curve: [Point; 4] = [[5, 0, 0, 9], [-70, 3, 0, 11], [40, 90, 0, 4], [8, 8, 0, 2]];
        let mut compared = 0;
        for k in 0..=128 {
            let t = f64::from(k) / 128.0;
            let want = crate::golden::evaluate::curve(&crate::golden::real(&curve), t);
            let got = blossom(&curve, [t; 3]);
            for (got, want) in got.iter().zip([want[0], want[1], want[3]]) {
                assert!((got - want).abs() < 1e-12);
                compared += 1;
            }
        }
        assert_eq!(compared, 129 * 3);
    }
}
