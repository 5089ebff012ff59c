//! Fit: a curve in, the thresholds and the size at which it comes nearest to the paper's rows out,
//! by what lies straight between its samples. Whoever asks measures there once more.

use super::{Curve, PAPER, worse};

/// Places of an octave that are looked at.
const PARTS: i32 = 24;
/// Octaves of sizes, to either side of 1.
const SIZES: i32 = 8;

/// Of elephants `size` times as large: the deviation of the worse scene from a row, in parts of the
/// uniform triangles, where it is least, and the common mu at which it is.
pub(super) fn common(curve: &Curve, row: usize, size: f64) -> (f64, f64) {
    let [first, last] = [curve.samples.first(), curve.samples.last()]
        .map(|sample| sample.expect("a curve has samples").mu.log2());
    let steps = ((last - first) * f64::from(PARTS)).round() as i32;
    let at = |k: i32| {
        let mu = (first + f64::from(k) / f64::from(PARTS)).exp2();
        (worse([curve.part(0, mu), curve.part(1, mu / size)], row), mu)
    };
    let least = |a: (f64, f64), b: (f64, f64)| if b.0 < a.0 { b } else { a };
    (0..=steps).map(at).reduce(least).expect("there is one place at least")
}

/// The size of elephants at which the worse row is nearest to the paper.
pub(super) fn size(curve: &Curve) -> f64 {
    let at = |k: i32| {
        let size = (f64::from(k) / f64::from(PARTS)).exp2();
        let off = (0..PAPER.len()).map(|row| common(curve, row, size).0).fold(0.0, f64::max);
        (off, size)
    };
    let least = |a: (f64, f64), b: (f64, f64)| if b.0 < a.0 { b } else { a };
    let sizes = -SIZES * PARTS..=SIZES * PARTS;
    sizes.map(at).reduce(least).expect("there is one size at least").1
}

#[cfg(test)]
mod tests {
    use super::super::{Sample, Sized, Test};
    use super::*;

    fn made(samples: &[(f64, [u64; 2])]) -> Curve {
        let samples: Vec<_> =
            samples.iter().map(|&(mu, triangles)| Sample { mu, triangles }).collect();
        let best = [samples[0]; 2];
        let sized = Sized { size: 1.0, best };
        Curve { test: Test::ALL[0], uniform: [10_000; 2], samples, best, sized }
    }

    #[test]
    fn the_common_threshold_is_where_the_worse_scene_is_nearest() {
        let curve = made(&[(1.0, [9862, 9510]), (2.0, [9362, 8510]), (4.0, [5196, 5068])]);
        let (off, mu) = common(&curve, 0, 1.0);
        assert!(off < 1e-9 && (mu - 2.0).abs() < 1e-9, "{off} {mu}");
        assert!((common(&curve, 1, 1.0).1 - 4.0).abs() < 1e-9);
        // Both fall alike, one 10 points too high where the other fits: 5 for both.
        let curve = made(&[(1.0, [9362, 9510]), (4.0, [8362, 8510])]);
        let (off, mu) = common(&curve, 0, 1.0);
        assert!((off - 0.05).abs() < 0.002 && (mu.log2() - 1.0).abs() < 0.05, "{off} {mu}");
        assert!((curve.part(0, 2.0) - 0.8862).abs() < 1e-9);
        assert_eq!([curve.part(1, 0.1), curve.part(1, 9.0)], [0.9510, 0.8510]);
    }

    #[test]
    fn a_size_that_was_planted_is_found() {
        // Elephants a quarter as large as those of the table: they fall two octaves before.
        let curve = made(&[
            (0.25, [9900, 9900]),
            (0.5, [9900, 8510]),
            (1.0, [9700, 5068]),
            (2.0, [9362, 1000]),
            (4.0, [5196, 1000]),
            (8.0, [1000, 1000]),
        ]);
        assert!((size(&curve) - 4.0).abs() < 0.2, "{}", size(&curve));
        assert!(common(&curve, 1, 1.0).0 > 0.3);
        assert!(common(&curve, 0, 4.0).0 < 1e-9 && common(&curve, 1, 4.0).0 < 1e-9);
    }
}
