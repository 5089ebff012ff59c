//! Round: what the scenes of strips, fans and indexed meshes are made of: arcs of a circle as
//! cubics, and a surface's points from where they are on two arcs.
//!
//! Only square roots: an eighth of a turn ends in directions whose coordinates are 0, 1 and
//! sqrt(1/2).

use std::f64::consts::FRAC_1_SQRT_2;

/// Eighths in a turn.
pub(super) const TURN: usize = 8;

/// The direction after `k` eighths of a turn.
pub(super) fn direction(k: usize) -> [f64; 2] {
    let s = FRAC_1_SQRT_2;
    [[1.0, 0.0], [s, s], [0.0, 1.0], [-s, s], [-1.0, 0.0], [-s, -s], [0.0, -1.0], [s, -s]][k % TURN]
}

/// 4/3 tan(a/4) for arcs of a = 1/8 and 1/4 of a turn.
fn handle(quarter: bool) -> f64 {
    let half = |tan: f64| (((1.0 + tan * tan).sqrt()) - 1.0) / tan; // tan of half the angle
    let quarter_handle = half(1.0); // tan(22.5 degrees)
    4.0 / 3.0 * if quarter { quarter_handle } else { half(quarter_handle) }
}

/// The unit circle's arc from one eighth to a later one, an eighth or a quarter of a turn apart.
fn arc(from: usize, to: usize) -> [[f64; 2]; 4] {
    let ([ax, ay], [bx, by]) = (direction(from), direction(to));
    let h = handle(to - from == 2);
    [[ax, ay], [ax - h * ay, ay + h * ax], [bx + h * by, by - h * bx], [bx, by]]
}

/// Point `node` of eighth arcs in a row, three a patch.
pub(super) fn eighth(node: usize) -> [f64; 2] {
    arc(node / 3, node / 3 + 1)[node % 3]
}

/// Point `node` of quarter arcs in a row, three a patch.
pub(super) fn quarter(node: usize) -> [f64; 2] {
    arc(2 * (node / 3), 2 * (node / 3) + 2)[node % 3]
}

/// A point as it is written: + 0.0 turns -0 to 0.
pub(super) fn single(point: [f64; 3]) -> [f32; 3] {
    point.map(|c| c as f32 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_round() {
        for (from, to) in [(0, 1), (3, 4), (7, 8), (0, 2), (6, 8)] {
            let [a, b, c, d] = arc(from, to);
            for t in [0.1, 0.25, 0.5, 0.9] {
                let s: f64 = 1.0 - t;
                let at = |k: usize| {
                    s * s * s * a[k]
                        + 3.0 * s * s * t * b[k]
                        + 3.0 * s * t * t * c[k]
                        + t * t * t * d[k]
                };
                let radius = at(0).hypot(at(1));
                assert!((radius - 1.0).abs() < 3e-4, "{from} to {to} at {t}: {radius}");
            }
        }
    }
}
