//! Which side of a surface the viewer sees, sample by sample: the truth that culling is held
//! against.

use crate::golden::evaluate::{basis, basis_derivative};
use crate::golden::{Real, clip};
use rtl_model::patch::Depth;

/// Samples along each direction.
pub const SAMPLES: usize = 65;

/// x, y, w.
type Row = [f64; 3];

/// Whether a surface faces the viewer in one of [`SAMPLES`] by [`SAMPLES`] points: its control
/// points over the rows x, y, w; `front` is the sign of det[S, Su, Sv] in front. A sample that f64
/// cannot tell from edge-on does not.
#[must_use]
pub fn faces_viewer(points: &[Row; 16], front: f64) -> bool {
    let noise = noise(points);
    any(points, |s, su, sv| volume(s, su, sv) * front > noise)
}

/// Whether a surface shows itself in one of these points: inside the visible volume and, where
/// there is a `front`, facing the viewer as in [`faces_viewer`].
#[must_use]
pub fn in_sight(points: &[Real; 16], front: Option<f64>, depth: Depth) -> bool {
    let row = |[x, y, _, w]: Real| [x, y, w];
    let noise = noise(&points.map(row));
    any(points, |s, su, sv| {
        let faces = |front| volume(row(s), row(su), row(sv)) * front > noise;
        clip::inside(s, depth) && front.is_none_or(faces)
    })
}

/// What a determinant may be wrong by: coordinates are, by a few ulps of the largest, and
/// derivatives by six times that.
fn noise(points: &[Row; 16]) -> f64 {
    let largest = points.iter().flatten().fold(0f64, |m, c| m.max(c.abs()));
    1e-12 * largest * largest * largest
}

/// Whether S, Su, Sv of one of the samples are such.
fn any<const N: usize>(
    points: &[[f64; N]; 16],
    such: impl Fn([f64; N], [f64; N], [f64; N]) -> bool,
) -> bool {
    let at = |k: usize| k as f64 / (SAMPLES - 1) as f64;
    let weights: [_; SAMPLES] = std::array::from_fn(|k| (basis(at(k)), basis_derivative(at(k))));
    let column = |j: usize| [points[j], points[j + 4], points[j + 8], points[j + 12]];
    weights.iter().any(|(value, slope)| {
        let along = [0, 1, 2, 3].map(|j| sum(column(j), value));
        let across = [0, 1, 2, 3].map(|j| sum(column(j), slope));
        weights
            .iter()
            .any(|(value, slope)| such(sum(along, value), sum(along, slope), sum(across, value)))
    })
}

fn sum<const N: usize>(p: [[f64; N]; 4], w: &[f64; 4]) -> [f64; N] {
    std::array::from_fn(|k| p[0][k] * w[0] + p[1][k] * w[1] + p[2][k] * w[2] + p[3][k] * w[3])
}

fn volume(a: Row, b: Row, c: Row) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_net_shows_its_front_from_one_side_and_a_bump_from_both() {
        let net = |lift: f64| -> [Row; 16] {
            std::array::from_fn(|k| {
                let (i, j) = (k / 4, k % 4);
                let inner = (1..3).contains(&i) && (1..3).contains(&j);
                [j as f64 - 1.5, i as f64 - 1.5, 10.0 + if inner { lift } else { 0.0 }]
            })
        };
        assert!(faces_viewer(&net(0.0), 1.0) && !faces_viewer(&net(0.0), -1.0));
        // So steep that its sides pass the line of sight.
        let steep = net(0.0).map(|[x, y, w]| [x, y + 8.0 * (x * x - 0.75), w]);
        assert!(faces_viewer(&steep, 1.0));
        assert!(faces_viewer(&net(-60.0), 1.0) && faces_viewer(&net(-60.0), -1.0));
        assert!(!faces_viewer(&[[0.0; 3]; 16], 1.0), "nothing has no front");
    }

    #[test]
    fn what_is_in_sight_is_in_the_volume_and_faces_the_viewer() {
        let net = |right: f64| -> [Real; 16] {
            std::array::from_fn(|k| [right + (k % 4) as f64, (k / 4) as f64 - 1.5, 5.0, 10.0])
        };
        let seen = |net: &[Real; 16], front| in_sight(net, front, Depth::ZeroToOne);
        assert!(seen(&net(0.0), Some(1.0)) && seen(&net(0.0), None));
        assert!(!seen(&net(0.0), Some(-1.0)));
        assert!(seen(&net(9.5), Some(1.0)), "a sixth of it");
        assert!(!seen(&net(10.5), Some(1.0)) && !seen(&net(10.5), None));
        let behind = net(0.0).map(|p| p.map(|c| -c));
        assert!(!seen(&behind, None) && !seen(&behind, Some(-1.0)) && !seen(&behind, Some(1.0)));
    }
}
