//! The study on the five scenes, small; and that it would tell.

use super::*;
use crate::config::{BackfaceMethod, Union, Unit};
use crate::trace::command::Tessellation;
use crate::trace::open::Trace;
use crate::trace::scene::motion::Kind;

fn film(kind: Kind, frames: u32, config: &Config) -> Film {
    let tessellation = Tessellation { max_level: 2 << 16, ..Tessellation::default() };
    scene(Motion { kind, frames, tessellation }, config).unwrap()
}

#[test]
fn counts_add_up_and_no_thread_changes_them() {
    let config = Config::default();
    for kind in [Kind::Crossing, Kind::Inside] {
        let film_on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| film(kind, 6, &config))
        };
        let film = film_on(1);
        assert_eq!(film, film_on(3));
        assert_eq!(film.frames.len(), 6);
        for c in &film.frames {
            assert_eq!(c.patches, 32);
            assert_eq!(c.reached, c.patches - c.clipped);
            assert_eq!(c.tessellated, c.reached - c.culled);
            assert!(c.culled <= c.away && c.away <= c.reached && c.triangles >= 2 * c.tessellated);
        }
    }
}

/// The other methods, formats and blocks switched off: unit and golden model agree about all.
#[test]
fn unit_and_golden_model_agree_under_other_configurations() {
    let mut agreed = 0;
    for method in BackfaceMethod::ALL {
        for (width, enabled, unit) in [(32, true, Unit::Sfarti), (14, false, Unit::Hybrid)] {
            let mut config = Config { unit, ..Config::default() };
            config.backface.method = method;
            // Of patches a few ulps large the block's cones keep some that golden ones, though
            // farther apart than `ROUNDING`, drop: at 14 bits 7 of the first frame of `zoom`.
            let cones = method == BackfaceMethod::NormalCone;
            config.position.width = if cones { width.max(24) } else { width };
            config.clip.enabled = enabled;
            let films: Vec<_> = [Kind::Zoom, Kind::Inside].map(|k| film(k, 4, &config)).into();
            check(&films).unwrap();
            for film in &films {
                let totals = film.totals();
                assert!(enabled || totals.clipped == 0);
                assert!(method != BackfaceMethod::Off || totals.culled == 0);
                agreed += totals.patches;
            }
        }
    }
    assert_eq!(agreed, 5 * 2 * 2 * 4 * 32);
}

/// Where patches are measured before they are drawn, they are clipped twice and counted once.
#[test]
fn a_patch_that_passes_twice_is_one_patch() {
    let mut config = Config { unit: Unit::Sfarti, ..Config::default() };
    let film = |config: &Config| {
        let trace = Trace::open("traces/mesh.jsonl").unwrap();
        run("mesh", trace.map(|located| Ok(located?.command)), config).unwrap()
    };
    let apart = film(&config).totals();
    config.level.union = Union::Primitive;
    let films = [film(&config)];
    check(&films).unwrap();
    let unified = films[0].totals();
    assert!(apart.clipped > 0, "a patch that is clipped in either pass");
    let triangles = unified.triangles;
    assert!(triangles > apart.triangles);
    assert_eq!(unified, Counts { triangles, ..apart });
}

#[test]
fn a_unit_that_culls_nothing_is_refused() {
    for unit in [Unit::Moreton, Unit::Triangles] {
        let config = Config { unit, ..Config::default() };
        let error = run("none", std::iter::empty(), &config).unwrap_err();
        assert!(error.to_string().contains(unit.name()) && error.exit_code() == 2);
    }
}

fn judged(fate: Fate, in_sight: bool) -> Judged {
    Judged { fate, clipped_exact: false, away: false, in_sight, in_sight_exact: in_sight }
}

fn counters(clipped: u64, culled: u64) -> Counters {
    let mut counters = Counters::default();
    counters.add(C::TracePatches, 4);
    counters.add(C::ClipCulled, clipped);
    counters.add(C::BackfaceCulled, culled);
    counters
}

#[test]
fn whatever_the_unit_does_otherwise_is_a_disagreement() {
    let frame = [Fate::Clipped, Fate::Kept, Fate::Culled, Fate::Kept].map(|f| {
        // What the golden models keep is in sight.
        judged(f, f == Fate::Kept)
    });
    let of = |kept: &[u32], clipped, culled| {
        let counts = Counts::of(&frame, kept, &counters(clipped, culled));
        (counts.disagreements, counts.false_quantised)
    };
    assert_eq!(of(&[1, 3], 1, 1), (0, 0));
    assert_eq!(of(&[1, 2, 3], 1, 0), (1, 0), "kept what shows no front");
    assert_eq!(of(&[3], 1, 2), (1, 1), "dropped what is in sight");
    assert_eq!(of(&[0, 3], 1, 1), (2, 1), "one for another");
    assert_eq!(of(&[1, 3], 2, 0), (1, 0), "the wrong block removed it");
    assert_eq!(of(&[1, 3, 4], 1, 1), (1, 0), "a patch that nobody drew");
    let films = |counts| [Film { name: "a film".into(), frames: vec![Counts::default(), counts] }];
    let counts = Counts::of(&frame, &[3], &counters(1, 2));
    let error = check(&films(counts)).unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().ends_with("of 1 frames: a film, frame 1: 1"), "{error}");
    check(&films(Counts::default())).unwrap();
}

#[test]
fn cones_within_their_rounding_may_go_either_way() {
    let frame = [Fate::CulledWithinRounding; 4].map(|fate| judged(fate, false));
    let of = |kept: &[u32], culled| Counts::of(&frame, kept, &counters(0, culled)).disagreements;
    assert_eq!([of(&[0, 1], 2), of(&[], 4), of(&[0, 1, 2, 3], 0)], [0; 3]);
    assert_eq!(of(&[0, 1], 1), 1);
}

#[test]
fn tables_have_a_row_a_frame_or_every_so_many_and_totals() {
    let frame = Counts { patches: 3, clipped: 2, ..Counts::default() };
    let film = |n: usize| Film { name: format!("film, {n}"), frames: vec![frame; n] };
    let one = text(&[film(40)]);
    assert_eq!(one.lines().filter(|line| line.starts_with('|')).count(), 2 + 40 + 1);
    assert!(one.contains("| total |     120 |"), "{one}");
    let two = text(&[film(41), film(1)]);
    assert!(two.contains("41 frames, one in 3 of them here"), "{two}");
    assert_eq!(two.lines().filter(|line| line.starts_with('|')).count(), 17 + 4 + 4);
    let csv = csv(&[film(2)]);
    assert_eq!(csv.lines().nth(2), Some("film_ 2,1,3,2,0,0,0,0,0,0,0,0,0,0,0"));
    assert!(csv.starts_with("trace,frame,patches,clipped,") && csv.lines().count() == 3);
}
