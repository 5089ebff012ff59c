//! Counts against the pattern, and fractions against what a threshold must do.

use super::*;

fn small(level: u32) -> Options {
    Options { cups: 2, elephants: 1, frames: 1, level, density: 1 }
}

#[test]
fn uniform_patterns_have_288_triangles_a_patch_at_level_3_and_fractions_fall_with_mu() {
    let study = run(small(3), &Config::default()).unwrap();
    assert_eq!(study.patches, [52, 811]);
    assert_eq!(study.uniform, [52 * 288, 811 * 288]);
    assert_eq!(study.curves.len(), 4);
    for curve in &study.curves {
        assert_eq!(curve.uniform, study.uniform);
        let parts: Vec<_> = curve.samples.iter().map(|s| curve.fractions(s)).collect();
        for scene in 0..2 {
            let name = curve.test.name();
            assert!(parts.windows(2).all(|p| p[0][scene] >= p[1][scene]), "{name}: {parts:?}");
            assert!(parts[0][scene] > 0.9 && parts[0][scene] <= 1.0, "{name}: {parts:?}");
            // At least the coarse triangles: a sixteenth.
            let last = parts.last().unwrap()[scene];
            assert!((1.0 / 16.0..0.5).contains(&last), "{name}: {parts:?}");
        }
        for row in 0..2 {
            let best = curve.deviation(&curve.best[row], row);
            let least = curve.samples.iter().map(|s| curve.deviation(s, row));
            let least = least.fold(f64::INFINITY, f64::min);
            assert!(best <= least + 0.02, "{}: {best} {least}", curve.test.name());
            // Elephants of another size are measured where the fit says that they fit.
            let Sized { size, best } = &curve.sized;
            let [_, elephants] = curve.fractions(&best[row]);
            let said = curve.part(1, best[row].mu / size);
            assert!((elephants - said).abs() < 0.06, "{}: {elephants} {said}", curve.test.name());
            let before = (0..2).map(|k| curve.deviation(&curve.best[k], k)).fold(0.0, f64::max);
            assert!(curve.deviation(&best[row], row) <= before + 0.05, "{}", curve.test.name());
        }
    }
    let text = text(&study);
    assert!(text.contains("811 x 288, equal") && !text.contains("NOT EQUAL"), "{text}");
    assert_eq!(csv(&study).lines().count(), 1 + 2 * (12 + 11) + 4 * 4);
    let picture = svg(&study).unwrap();
    assert!(picture.contains("paper, medium") && picture.contains("net, pixels, size 1.00"));
    assert_eq!(picture.matches("net, pixels, size").count(), 2, "of either size");
}

#[test]
fn in_object_units_neither_copies_nor_frames_matter() {
    let test = Test::ALL[2];
    let part = |count, frames| {
        let commands = Scene::Teacups(count).commands(frames).unwrap();
        let config = test.config(&Config::default(), 3, 0.01);
        let triangles = super::count(&commands, &config).unwrap();
        assert_eq!(triangles % u64::from(count * frames), 0);
        triangles / u64::from(count * frames)
    };
    let one = part(1, 1);
    assert!(one > 26 * 18 && one < 26 * 288, "{one}");
    assert_eq!((part(3, 1), part(2, 2)), (one, one));
}

#[test]
fn a_pattern_that_is_not_the_papers_is_told() {
    let mut study = run(Options { cups: 1, ..small(1) }, &Config::default()).unwrap();
    assert_eq!(study.uniform, [26 * 72, 811 * 72]);
    study.uniform[1] += 1;
    assert!(text(&study).contains("NOT EQUAL"));
}
