//! What binds at each level.

use super::{config, trace};
use tessim::config::{Engine, Unit};
use tessim::study::compare::roofline::{self, LEVEL_MAX};
use tessim::trace::replay::Replay;

#[test]
fn triangles_that_reside_are_of_the_level_that_is_asked_for() {
    let mut config = config(Unit::Triangles, Engine::Timed);
    config.triangles.residency = tessim::config::Residency::Discrete;
    let mut trace = Replay::open(&trace("fan")).unwrap();
    let rows = roofline::run(&mut trace, &[config]).unwrap();
    let patches = rows[0].triangles / 2;
    for row in &rows {
        // The pattern has its segments in pairs.
        let segments = if row.level == 1 { 1 } else { u64::from(row.level.next_multiple_of(2)) };
        assert_eq!(row.triangles, 2 * patches * segments.pow(2), "{}", row.level);
    }
}

#[test]
fn no_block_is_busier_than_the_run_is_long_and_the_busiest_binds() {
    let configs = Unit::ALL.map(|unit| {
        let mut config = config(unit, Engine::None);
        config.clip.enabled = false;
        config.backface.method = tessim::config::BackfaceMethod::Off;
        config
    });
    let mut trace = Replay::open(&trace("fan")).unwrap();
    let rows = roofline::run(&mut trace, &configs).unwrap();
    let per_unit = |unit| rows.iter().filter(|row| row.unit == unit).count() as u32;
    for unit in Unit::ALL {
        assert_eq!(per_unit(unit), if unit == Unit::Esc { 48 } else { LEVEL_MAX });
    }
    let patches = rows[0].triangles / 2;
    for row in &rows {
        let most = row.demands.iter().map(|(_, cycles)| *cycles).max().unwrap();
        assert!(most <= row.elapsed, "{row:?}");
        let bound = row.bound.unwrap();
        let of = row.demands.iter().find(|(block, _)| *block == bound.block).unwrap().1;
        // Lanes round up.
        assert!(of + 1 >= most, "{row:?}");
        assert!(
            (bound.used - of as f64 / row.elapsed as f64).abs() < 0.01 + 2.0 / row.elapsed as f64
        );
        if row.unit == Unit::Hybrid && row.level % 2 == 0 {
            assert_eq!(row.triangles, 2 * patches * u64::from(row.level).pow(2));
        }
        if row.unit == Unit::Esc {
            let segments = u64::from(row.level.div_ceil(3) * 3);
            assert_eq!(row.triangles, 2 * patches * segments.pow(2));
        }
    }
    // The more triangles, the farther from what a patch costs before there are any.
    let hybrid: Vec<f64> = rows[..LEVEL_MAX as usize]
        .iter()
        .map(|row| row.triangles as f64 / row.elapsed as f64)
        .collect();
    assert!(hybrid[0] < 0.5 * hybrid[63] && hybrid[63] > 0.9, "{hybrid:?}");
    let csv = roofline::csv(&rows);
    assert_eq!(csv.lines().count(), 1 + rows.iter().map(|row| row.demands.len()).sum::<usize>());
    assert!(roofline::svg(&rows).unwrap().matches("<polyline").count() >= Unit::ALL.len());
    let text = roofline::text(&rows);
    for unit in Unit::ALL {
        assert!(text.lines().any(|line| line.trim_start().starts_with(unit.name())), "{text}");
    }
}
