//! Distances that must fall, counts that must be met, and ways that must be the same.

use super::*;
use crate::trace::scene::newell::Newell;
use rtl_model::esc::ControlMesh;

fn run_of(targets: &[u32], level: u32) -> Vec<Row> {
    let scene = Scene::Model(Newell::Teacup);
    let options = Options { scene, targets: targets.to_vec(), level, segments: 17 };
    run(&options, &Config::default()).unwrap()
}

fn of(rows: &[Row], way: Way) -> Vec<Row> {
    rows.iter().filter(|row| row.way == way).copied().collect()
}

#[test]
fn uniform_patterns_come_nearer_with_every_level_by_the_square_of_their_segments() {
    let rows = run_of(&[3, 6, 12], 3);
    for way in [Way::EscUniform, Way::D3d11Fixed] {
        let rows = of(&rows, way);
        let counts: Vec<_> = rows.iter().map(|row| row.triangles).collect();
        assert_eq!(counts, [468, 1872, 7488], "{way:?}");
        for pair in rows.windows(2) {
            let fell = pair[0].deviation.mean() / pair[1].deviation.mean();
            assert!((3.0..5.0).contains(&fell), "{way:?}: {fell}");
            assert!(pair[0].deviation.largest > 2.0 * pair[1].deviation.largest, "{way:?}");
        }
    }
}

#[test]
fn adaptive_ways_meet_their_targets_and_end_in_the_uniform_pattern() {
    let rows = run_of(&[7, 12], 3);
    for test in Test::ALL {
        let rows = of(&rows, Way::Esc(test));
        assert!(rows[0].is_near(), "{:?}", rows[0]);
        assert!(rows[0].triangles < rows[1].triangles);
    }
    // All candidates: at mu = 0 and by hardly any threshold, but where the surface is flat.
    let all = of(&rows, Way::Esc(Test { mesh: ControlMesh::Net, space: Space::Pixels }))[1];
    let uniform = of(&rows, Way::EscUniform)[0];
    assert!(all.triangles as f64 > 0.9 * uniform.triangles as f64, "{all:?}");
    assert!(all.deviation.largest < 1.5 * uniform.deviation.largest, "{all:?} {uniform:?}");
    assert!(of(&rows, Way::EscUniform).len() == 1, "7 segments are not its own");
}

#[test]
fn tables_tell_a_count_that_is_off_and_hold_integers() {
    let mut rows = run_of(&[6], 3);
    let told = text(&rows);
    assert!(told.contains("6 x 6: 1872") && !told.contains("| *"), "{told}");
    rows[0].triangles = 1872 + 38; // 2.03 %
    assert!(text(&rows).contains(" *1910"));
    let csv = csv(&rows);
    for line in csv.lines().skip(1) {
        let numbers = line.split(',').skip(1).filter(|cell| !cell.is_empty());
        assert!(numbers.map(str::parse::<u64>).all(|n| n.is_ok()), "{line}");
    }
    assert!(svg(&rows).unwrap().contains("d3d11, one factor"));
}
