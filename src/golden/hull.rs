//! Hull: control points in clip space in, the distance test's two points at each candidate position
//! out, and tessellation factors from what is inserted (Concheiro et al. 2014, Equation 9).
//!
//! The polygon is the piecewise linear function of its four vertices at 0, 1/3, 2/3, 1; the curve
//! comes from de Casteljau. Their distance on the screen is taken over one denominator, where the
//! shader divides each point.

use super::{Real, domain};

/// A candidate position on a curve.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The numerator k of its parameter k / (3 (L + 1)).
    pub k: u32,
    /// V_S, on the control polygon.
    pub polygon: Real,
    /// V_B, on the curve.
    pub curve: Real,
}

/// All candidates of a curve, ascending, with L in each of its three cells.
#[must_use]
pub fn candidates(curve: &[Real; 4], l: u32) -> Vec<Candidate> {
    let all = 1..3 * (l + 1);
    let inside = all.filter(|k| k % (l + 1) > 0);
    let candidate = |k: u32| {
        let t = f64::from(k) / f64::from(3 * (l + 1));
        Candidate { k, polygon: polygon(curve, t), curve: domain::curve(curve, t) }
    };
    inside.map(candidate).collect()
}

/// The control polygon at `t`, with hat functions at the thirds.
#[must_use]
pub fn polygon(curve: &[Real; 4], t: f64) -> Real {
    let hat = |i: usize| (1.0 - (3.0 * t - i as f64).abs()).max(0.0);
    std::array::from_fn(|axis| (0..4).map(|i| hat(i) * curve[i][axis]).sum())
}

impl Candidate {
    /// |V_S - V_B| in pixels; `None` where a w is below `near` or not above 0.
    #[must_use]
    pub fn distance(&self, viewport: [u32; 2], near: f64) -> Option<f64> {
        let ([s, b], half) = ([self.polygon, self.curve], viewport.map(|n| f64::from(n) / 2.0));
        let seen = |w: f64| w >= near && w > 0.0;
        let apart = |axis: usize| half[axis] * (s[axis] * b[3] - b[axis] * s[3]) / (s[3] * b[3]);
        (seen(s[3]) && seen(b[3])).then(|| apart(0).hypot(apart(1)))
    }
}

/// Ueq0 Veq0 Ueq1 Veq1 InU InV of a patch, `inserted` saying which candidates are.
#[must_use]
pub fn factors(points: &[Real; 16], l: u32, inserted: impl Fn(&Candidate) -> bool) -> [f64; 6] {
    let factor = |curve: [Real; 4]| {
        candidates(&curve, l).iter().filter(|candidate| inserted(candidate)).count() as f64 + 3.0
    };
    let rows = [0, 1, 2, 3].map(|i| factor([0, 1, 2, 3].map(|j| points[4 * i + j])));
    let columns = [0, 1, 2, 3].map(|j| factor([0, 1, 2, 3].map(|i| points[4 * i + j])));
    let greatest = |four: [f64; 4]| four.into_iter().fold(0.0, f64::max);
    [columns[0], rows[0], columns[3], rows[3], greatest(rows), greatest(columns)]
}
