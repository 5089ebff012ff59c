//! What is counted: reuse by closed formulas, tests, sections, and that none of it changes what is
//! made.

use crate::random::Random;
use crate::shader::{Result, any_levels, any_settings, run, settings, subject, view};
use rtl_model::esc::{
    Boundary, ControlMesh, LEVEL_MAX, Levels, Made, Output, Phase, Reuse, Settings, Surface,
    Threshold,
};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Patch, Vertex};

/// Corners, boundary, coarse edges, interior.
fn classes(made: &Made) -> [u64; 4] {
    [made.corners, made.boundary, made.coarse, made.interior]
}

fn even(level: u8) -> Levels {
    Levels { edges: [level; 4], interior: level }
}

#[test]
fn the_uniform_pattern_is_evaluated_as_often_as_its_formulas_say() {
    let mut random = Random::new(1);
    let subject = subject(&mut random, &settings(Threshold::Uniform));
    for level in 0..=LEVEL_MAX {
        let r = u64::from(level) + 1;
        // Of 18 coarse triangles: three rows of four thirds, used by 6 triangles each inside.
        let strips = 18 * (r * r + 2 * r);
        let triangles = 18 * (r + 1) * (r + 2) / 2;
        let patch = (3 * r + 1).pow(2);
        let inside = 18 * (r - 1) * r.saturating_sub(2) / 2;
        for (reuse, points, buffer) in [
            (Reuse::None, strips, 0),
            (Reuse::CoarseTriangle, triangles, (r + 1) * (r + 2) / 2),
            (Reuse::Patch, patch, patch),
        ] {
            let settings = Settings { reuse, ..settings(Threshold::Uniform) };
            let Result { vertices, triangles, made } =
                run(&mut Surface::new(settings), &subject, &crate::shader::VIEW, even(level));
            assert_eq!(triangles.len() as u64, 18 * r * r);
            assert_eq!((vertices.len() as u64, made.distinct), (patch, patch));
            assert_eq!((made.points(), made.buffer), (points, buffer), "{reuse:?} {level}");
            assert_eq!((made.strip_vertices, made.slots), (strips, 18 * r * r));
            assert_eq!((made.nets, made.object_nets, made.tests, made.tested), (1, 0, 0, 0));
            assert_eq!((made.moved, made.cracks), (0, 0));
            match reuse {
                Reuse::Patch => assert_eq!(
                    classes(&made),
                    [4, 12 * r - 4, 21 * (r - 1) + 4, inside],
                    "level {level}"
                ),
                // Corners of the patch: 2 of one triangle, 2 of two.
                Reuse::CoarseTriangle => {
                    let [corners, boundary, coarse, interior] = classes(&made);
                    assert_eq!((corners, interior), (6, inside));
                    assert_eq!(boundary, 12 * (r - 1) + 24); // 8 thirds of three triangles
                    assert_eq!(coarse, 42 * (r - 1) + 24); // 4 of six
                }
                Reuse::None => {
                    let sum: u64 = classes(&made).iter().sum();
                    assert_eq!(sum, strips);
                }
            }
        }
    }
    // The paper's level.
    let points = |reuse| {
        let settings = Settings { reuse, ..settings(Threshold::Uniform) };
        run(&mut Surface::new(settings), &subject, &crate::shader::VIEW, even(3)).made.points()
    };
    assert_eq!(Reuse::ALL.map(points), [432, 270, 169]);
}

/// Where nothing is flat, the smallest threshold inserts everything; 0 tests nothing.
#[test]
fn a_threshold_of_nothing_is_the_uniform_pattern() {
    assert_eq!(Threshold::pixels(0), Threshold::Uniform);
    assert_eq!(Threshold::object(0), Threshold::Uniform);
    let mut random = Random::new(2);
    let mut compared = 0;
    for _ in 0..400 {
        let any = any_settings(&mut random);
        let wide = |format: Format| Format { width: 40, fraction: format.fraction.min(39) };
        let any =
            Settings { position: wide(any.position), object: wide(any.object), guard: 8, ..any };
        let view = view(&mut random, any.position);
        let (mut subject, levels) = (subject(&mut random, &any), any_levels(&mut random));
        // In front of the eye and bent, so that no point of it is on its control mesh.
        let mut bent = |one: i64| {
            let max = any.position.max() as f64;
            let [x, y, z] = [0; 3].map(|_: i64| (random.real(-0.5, 0.5) * max) as i64);
            [x, y, z, one]
        };
        let ones = [any.position.max() / 2, (1 << any.object.fraction).min(any.object.max())];
        subject.0.points = subject.0.points.map(|_| bent(ones[0]));
        subject.1 = subject.1.map(|_| bent(ones[1]));
        let uniform = Settings { threshold: Threshold::Uniform, ..any };
        let want = run(&mut Surface::new(uniform), &subject, &view, levels);
        for threshold in [Threshold::pixels(1), Threshold::object(1)] {
            let tested = Settings { threshold, ..any };
            let got = run(&mut Surface::new(tested), &subject, &view, levels);
            assert_eq!((&got.vertices, &got.triangles), (&want.vertices, &want.triangles));
            assert_eq!(got.made.tests, got.made.inserted, "{threshold:?}");
            compared += got.vertices.len();
        }
    }
    println!("compared {compared} vertices");
    assert!(compared > 50_000);
}

#[test]
fn what_is_kept_and_where_it_is_cut_changes_counts_only() {
    let mut random = Random::new(3);
    let (mut compared, mut cut) = (0, 0);
    for _ in 0..500 {
        let any = any_settings(&mut random);
        let view = view(&mut random, any.position);
        let (subject, levels) = (subject(&mut random, &any), any_levels(&mut random));
        let want = run(&mut Surface::new(any), &subject, &view, levels);
        for reuse in Reuse::ALL {
            let level_max = random.integer(levels.interior.into(), LEVEL_MAX.into()) as u8;
            let least = 2 * (u32::from(level_max) + 1) + 1;
            let values_per_vertex = random.integer(1, 12);
            let values_max = values_per_vertex * random.integer(least, 20 * least);
            let output = Some(Output { values_max, values_per_vertex, level_max });
            let whole = run(&mut Surface::new(Settings { reuse, ..any }), &subject, &view, levels);
            let parts =
                run(&mut Surface::new(Settings { reuse, output, ..any }), &subject, &view, levels);
            for got in [&whole, &parts] {
                assert_eq!((&got.vertices, &got.triangles), (&want.vertices, &want.triangles));
                balances(got, &Settings { reuse, ..any });
                compared += 1;
            }
            let (whole, parts) = (whole.made, parts.made);
            assert_eq!(whole.sections.sections, 1);
            assert_eq!((whole.strip_vertices, whole.slots), (parts.strip_vertices, parts.slots));
            assert!(whole.points() <= parts.points() && whole.tests <= parts.tests);
            assert!(
                whole.buffer >= parts.buffer && parts.nets <= u64::from(parts.sections.sections)
            );
            cut += u32::from(parts.sections.sections > 1);
        }
    }
    println!("compared {compared} results, {cut} in sections");
    assert!(compared == 3_000 && cut > 700);
}

/// Laws between the counts of a patch.
fn balances(result: &Result, settings: &Settings) {
    let made = result.made;
    let Phase { nets, tests, points, slots } = made.sections.sum;
    assert_eq!(
        [nets, tests, points, slots].map(u64::from),
        [made.nets + made.object_nets, made.tests, made.points(), made.slots]
    );
    let most = made.sections.most;
    assert!(most.points <= points && most.slots <= slots && most.tests <= tests && most.nets <= 2);
    assert!(u64::from(most.points) * u64::from(made.sections.sections) >= u64::from(points));
    assert_eq!(made.distinct, result.vertices.len() as u64);
    assert!(made.inserted <= made.tests && made.tested_boundary <= made.tested);
    assert!(made.slots >= result.triangles.len() as u64);
    let mesh: u64 = classes(&made).iter().sum();
    match settings.reuse {
        Reuse::None => assert_eq!(mesh, made.strip_vertices),
        _ => assert!((made.distinct..=made.strip_vertices).contains(&mesh)),
    }
    match settings.threshold {
        Threshold::Uniform => assert_eq!((made.tests, made.tested, made.object_nets), (0, 0, 0)),
        // What a test evaluates on screen goes to the mesh or was not inserted.
        Threshold::Pixels(_) => {
            assert_eq!(made.object_nets, 0);
            if settings.reuse != Reuse::None && made.sections.sections == 1 {
                assert_eq!(made.tested, made.tests - made.inserted);
            }
        }
        Threshold::Object(_) => {
            assert_eq!(made.object_nets, made.nets);
            assert!(made.tested >= made.tests);
        }
    }
    if settings.reuse == Reuse::Patch && made.sections.sections == 1 {
        assert_eq!(mesh, made.distinct);
    }
}

/// How many tests and points for tests alone there are, with everything known: nothing is inserted
/// in a flat patch.
#[test]
fn a_flat_patch_is_tested_and_nothing_else() {
    let at = |k: usize| [(k as i64 % 4) << 20, ((k / 4) as i64 * 5) << 18, 77, 1 << 26];
    let points: [_; 16] = std::array::from_fn(at);
    let patch = Patch { id: 0, points, saturated: false, cull: false, reversed: false };
    let object = points.map(|[x, y, z, _]| [x, y, z, 1 << 30]);
    let levels = Levels { edges: [2, 3, 0, 1], interior: 3 };
    // Candidates: 3 (2 + 3 + 0 + 1) on the boundary, 21 * 3 inside. A side's are tested once or,
    // inside, by either triangle.
    let (outer, inner) = (18, 63);
    for (reuse, times) in [(Reuse::None, 2), (Reuse::CoarseTriangle, 2), (Reuse::Patch, 1)] {
        for threshold in [Threshold::pixels(1 << 16), Threshold::object(256)] {
            let settings = Settings { reuse, ..settings(threshold) };
            let made =
                run(&mut Surface::new(settings), &(patch, object), &crate::shader::VIEW, levels)
                    .made;
            assert_eq!((made.tests, made.inserted), (outer + times * inner, 0), "{reuse:?}");
            assert_eq!((made.tested, made.tested_boundary), (made.tests, outer));
            assert_eq!((made.distinct, made.slots), (16, 18 * 7));
        }
    }
    // With chords, a test looks at its ends too.
    let chord = |threshold, reuse| {
        let settings = Settings { reuse, mesh: ControlMesh::Chord, ..settings(threshold) };
        let made =
            run(&mut Surface::new(settings), &(patch, object), &crate::shader::VIEW, levels).made;
        assert_eq!(made.inserted, 0);
        made.tested - made.tests
    };
    let pixels = Threshold::pixels(1 << 16);
    assert_eq!(chord(pixels, Reuse::Patch), 0);
    assert_eq!(chord(pixels, Reuse::CoarseTriangle), 0);
    // In object space, 12 thirds that are no corner; each triangle has 3, but corners: 6 less.
    assert_eq!(chord(Threshold::object(256), Reuse::Patch), 12);
    assert_eq!(chord(Threshold::object(256), Reuse::CoarseTriangle), 54 - 6);
    // Each test on its own, 2 ends of 54 sides but the three that have no candidates. Of those, the
    // four corners are 2, 4, 3 and 1.
    for threshold in [pixels, Threshold::object(256)] {
        assert_eq!(chord(threshold, Reuse::None), 2 * (54 - 3) - 10);
    }
}

/// The 2014 limit at the paper's level, four values a vertex: ten coarse triangles and eight.
#[test]
fn a_geometry_shader_takes_the_patch_in_two_sections() {
    let mut random = Random::new(4);
    let subject = subject(&mut random, &settings(Threshold::Uniform));
    let output = Some(Output { values_max: 1024, values_per_vertex: 4, level_max: 3 });
    let made = |reuse| {
        let settings = Settings { reuse, output, ..settings(Threshold::Uniform) };
        run(&mut Surface::new(settings), &subject, &crate::shader::VIEW, even(3)).made
    };
    for reuse in Reuse::ALL {
        let made = made(reuse);
        assert_eq!((made.sections.sections, made.nets), (2, 2));
        assert_eq!((made.sections.most.slots, made.sections.sum.slots), (160, 288));
    }
    assert_eq!(made(Reuse::None).sections.most.points, 240);
    assert_eq!(made(Reuse::CoarseTriangle).sections.most.points, 150);
    // Five cells: 13 by 5 places, then two cells of 4 rows more; the other way round, one of them.
    assert_eq!(made(Reuse::Patch).sections.most.points, 13 * 5 + 9 * 4);
    assert_eq!(made(Reuse::Patch).points(), 101 + (13 * 5 + 5 * 4));
    assert_eq!(made(Reuse::Patch).buffer, 101);
}

#[test]
fn what_a_patch_gives_does_not_depend_on_the_ones_before() {
    let mut random = Random::new(5);
    let mut compared = 0;
    for _ in 0..60 {
        let any = Settings {
            boundary: random.of(Boundary::ALL),
            reuse: random.of(Reuse::ALL),
            ..any_settings(&mut random)
        };
        let view = view(&mut random, any.position);
        let mut shader = Surface::new(any);
        let tasks = [0; 5].map(|_| (subject(&mut random, &any), any_levels(&mut random)));
        for _ in 0..20 {
            let (subject, levels) = &tasks[random.integer(0, 4) as usize];
            let got = run(&mut shader, subject, &view, *levels);
            assert_eq!(got, run(&mut Surface::new(any), subject, &view, *levels));
            compared += 1;
        }
    }
    println!("compared {compared} results");
    assert_eq!(compared, 1_200);
}

/// A plane at the end of the range: without guard bits, samples leave it by their roundings.
#[test]
fn a_sample_beyond_the_range_is_fitted_and_counted() {
    let format = Format { width: 16, fraction: 12 };
    let max = format.max();
    let mut random = Random::new(6);
    let mut counted = [0; 2];
    for _ in 0..200 {
        let near = |random: &mut Random| max - i64::from(random.integer(0, 3));
        let points = [[0; 4]; 16].map(|_| [0; 4].map(|_: i64| near(&mut random)));
        let patch = Patch { id: 0, points, saturated: false, cull: false, reversed: false };
        for (n, overflow) in [Overflow::Saturate, Overflow::Wrap].into_iter().enumerate() {
            let settings = Settings {
                position: format,
                object: format,
                guard: 0,
                rounding: Rounding::NearestAway,
                overflow,
                ..settings(Threshold::Uniform)
            };
            let result =
                run(&mut Surface::new(settings), &(patch, points), &crate::shader::VIEW, even(7));
            let beyond =
                |vertex: &Vertex| vertex.position.iter().filter(|&&c| c < 0).count() as u64;
            let wrapped: u64 = result.vertices.iter().map(beyond).sum();
            match overflow {
                Overflow::Saturate => assert_eq!(wrapped, 0),
                Overflow::Wrap => assert_eq!(wrapped, result.made.overflows),
            }
            counted[n] += result.made.overflows;
        }
    }
    println!("compared {} overflows", counted[0]);
    assert!(counted[0] == counted[1] && counted[0] > 100);
}
