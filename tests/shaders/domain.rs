//! Domain: vertices on edges, corners, and cracks.

use crate::random::Random;
use crate::sides::{SIDES, site, turns, with_edge};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::ONE;
use tessim::config::d3d11::Form;
use tessim::shader::domain::{Evaluator, Fixed, Orientations, Settings, Single};

const CORNERS: [(usize, [u32; 2]); 4] =
    [(0, [0, 0]), (3, [ONE, 0]), (12, [0, ONE]), (15, [ONE, ONE])];

/// Fixed-point formats: the default, the least and the most of each width, and all modes.
fn formats() -> Vec<Settings> {
    let of = |width, weight_bits, rounding, overflow| Settings {
        position: Format::of_range(width, 4),
        weight_bits,
        rounding,
        overflow,
    };
    let mut all = Vec::new();
    for rounding in Rounding::ALL {
        for overflow in Overflow::ALL {
            for (width, bits) in [(32, 24), (12, 16), (48, 30), (20, 30), (38, 24), (48, 16)] {
                all.push(of(width, bits, rounding, overflow));
            }
        }
    }
    all
}

/// A point before the camera, rational or not, of up to half of `size`; zeros of both signs.
fn point(random: &mut Random, size: f64, rational: bool) -> [f64; 4] {
    let mut real = |least| match random.integer(0, 15) {
        0 if least < 0.0 => random.of([0.0, -0.0]),
        _ => random.real(least, 0.5) * size,
    };
    let [x, y, z] = [real(-0.5), real(-0.5), real(-0.5)];
    [x, y, z, if rational { real(0.05) } else { size / 4.0 }]
}

fn singles(random: &mut Random) -> [[f32; 4]; 16] {
    let (size, rational) = (random.octaves(1e-3, 1e6), random.bits() & 1 == 0);
    [(); 16].map(|()| point(random, size, rational).map(|c| c as f32))
}

fn integers(random: &mut Random, settings: &Settings) -> [[i64; 4]; 16] {
    // Up to the ends of the format, where roundings make vertices that do not fit.
    let size = 2.0 * settings.position.max() as f64 * random.of([1.0, 1.0, 0.01]);
    let rational = random.bits() & 1 == 0;
    let max = settings.position.max();
    let extreme = random.integer(0, 7) == 0;
    [(); 16].map(|()| {
        point(random, size, rational).map(|c| match extreme {
            true => max * if c < 0.0 { -1 } else { 1 },
            false => c as i64,
        })
    })
}

/// A parameter, often near an end or the middle.
fn parameter(random: &mut Random) -> u32 {
    match random.integer(0, 3) {
        0 => random.of([0, 1, ONE / 3, ONE / 2, ONE - 1, ONE]),
        _ => random.integer(0, ONE),
    }
}

/// Vertices of one curve in two unrelated patches, on all sides of both: how many were compared,
/// how many of them differ, and of these, how many are counted in neither patch.
fn shared<E: Evaluator>(
    evaluator: &E,
    random: &mut Random,
    mut patch: impl FnMut(&mut Random) -> [[E::Coordinate; 4]; 16],
) -> [u64; 3] {
    let (one, other, donor) = (patch(random), patch(random), patch(random));
    let curve = [donor[0], donor[1], donor[2], donor[3]];
    let t = parameter(random);
    let [one, other] = [one, other].map(|rest| {
        SIDES.map(|side| {
            let points = with_edge(&rest, &curve, side);
            let at = site(side, t);
            let vertex = evaluator.point(&evaluator.net(&points), at);
            (vertex, Orientations::new(evaluator, &points).crack(at))
        })
    });
    let mut counts = [0; 3];
    for (a, counted_a) in one {
        for (b, counted_b) in other {
            let differ = a != b;
            counts[0] += 1;
            counts[1] += u64::from(differ);
            counts[2] += u64::from(differ && !counted_a && !counted_b);
        }
    }
    counts
}

fn add(total: &mut [u64; 3], more: [u64; 3]) {
    for (sum, n) in total.iter_mut().zip(more) {
        *sum += n;
    }
}

#[test]
fn paired_vertices_are_those_of_the_edge_alone() {
    let mut random = Random::new(0xd0_0001);
    let mut total = [0; 3];
    for _ in 0..4_000 {
        add(&mut total, shared(&Single::new(Form::Paired), &mut random, singles));
    }
    for settings in formats() {
        let evaluator = Fixed::new(Form::Paired, settings);
        for _ in 0..100 {
            add(&mut total, shared(&evaluator, &mut random, |r| integers(r, &settings)));
        }
    }
    println!("paired: compared {} vertices, {} differ", total[0], total[1]);
    assert_eq!((total[0], total[1]), ((4_000 + 48 * 100) * 64, 0));
}

#[test]
fn zeros_of_an_edge_have_one_sign() {
    let mut random = Random::new(0xd0_0002);
    let single = Single::new(Form::Paired);
    let mut compared = 0;
    for _ in 0..2_000 {
        // Curves whose points cancel or vanish, among neighbours that do not.
        let zero = |random: &mut Random| random.of([0.0f32, -0.0, 1.0, -1.0]);
        let curve = [(); 4].map(|()| [(); 4].map(|()| zero(&mut random)));
        let t = parameter(&mut random);
        let bits = SIDES.map(|side| {
            let points = with_edge(&singles(&mut random), &curve, side);
            single.point(&single.net(&points), site(side, t)).0.map(f32::to_bits)
        });
        for other in &bits[1..] {
            assert_eq!(bits[0], *other, "{curve:?} at {t}");
            compared += 1;
        }
    }
    assert_eq!(compared, 14_000);
}

/// Every crack of the patch by turning it, against what is counted: vertices, and cracks.
fn cracks<E: Evaluator>(
    evaluator: &E,
    random: &mut Random,
    points: &[[E::Coordinate; 4]; 16],
) -> [u64; 2] {
    let orientations = Orientations::new(evaluator, points);
    let mut counts = [0; 2];
    for _ in 0..16 {
        let at = site(random.of(SIDES), parameter(random));
        let mut all = turns(points, at).into_iter();
        let mut vertex = || all.next().map(|(p, at)| evaluator.point(&evaluator.net(&p), at).0);
        let own = vertex().unwrap();
        let differs = std::iter::from_fn(vertex).filter(|other| *other != own).count() > 0;
        assert_eq!(orientations.crack(at), differs, "{points:?} at {at:?}");
        counts[0] += 1;
        counts[1] += u64::from(differs);
    }
    counts
}

#[test]
fn cracks_are_those_that_turning_the_patch_shows() {
    let mut random = Random::new(0xd0_0003);
    for form in Form::ALL {
        let (mut float, mut fixed) = ([0; 2], [0; 2]);
        for _ in 0..1_000 {
            let points = singles(&mut random);
            let counts = cracks(&Single::new(form), &mut random, &points);
            float = [float[0] + counts[0], float[1] + counts[1]];
        }
        for settings in formats() {
            for _ in 0..20 {
                let points = integers(&mut random, &settings);
                let counts = cracks(&Fixed::new(form, settings), &mut random, &points);
                fixed = [fixed[0] + counts[0], fixed[1] + counts[1]];
            }
        }
        println!("{}: cracks {float:?} in f32, {fixed:?} in fixed point", form.name());
        assert_eq!([float[0], fixed[0]], [16_000, 15_360]);
        let share = |[all, cracks]: [u64; 2]| 100 * cracks / all;
        match form {
            Form::Paired => assert_eq!([float[1], fixed[1]], [0, 0]),
            // Products are rounded, and integers are summed in any order.
            Form::Sequential => assert!(share(float) > 20 && fixed[1] == 0),
            Form::Power => assert!(share(float) > 50 && share(fixed) > 50),
        }
    }
}

#[test]
fn a_vertex_that_differs_between_neighbours_is_counted_in_one() {
    let mut random = Random::new(0xd0_0004);
    for form in [Form::Sequential, Form::Power] {
        let (mut float, mut fixed) = ([0; 3], [0; 3]);
        for _ in 0..300 {
            add(&mut float, shared(&Single::new(form), &mut random, singles));
        }
        for settings in formats() {
            let evaluator = Fixed::new(form, settings);
            for _ in 0..6 {
                add(&mut fixed, shared(&evaluator, &mut random, |r| integers(r, &settings)));
            }
        }
        println!("{}: [compared, differ, uncounted] {float:?} {fixed:?}", form.name());
        assert_eq!([float[0], fixed[0]], [300 * 64, 288 * 64]);
        assert_eq!([float[2], fixed[2]], [0, 0], "{}: not counted", form.name());
        assert!(float[1] > 1_000 && (fixed[1] > 1_000) == (form == Form::Power));
    }
}

#[test]
fn sequential_is_paired_where_sums_are_exact() {
    let mut random = Random::new(0xd0_0005);
    let mut compared = 0;
    for settings in formats() {
        let [paired, sequential] =
            [Form::Paired, Form::Sequential].map(|form| Fixed::new(form, settings));
        for _ in 0..100 {
            let points = integers(&mut random, &settings);
            let at = [parameter(&mut random), parameter(&mut random)];
            let [a, b] = [paired, sequential].map(|e| e.point(&e.net(&points), at));
            assert_eq!(a, b, "{settings:?} at {at:?}");
            compared += 1;
        }
    }
    assert_eq!(compared, 4_800);
}

#[test]
fn corners_are_the_corner_points() {
    let mut random = Random::new(0xd0_0006);
    let mut compared = 0;
    for form in [Form::Paired, Form::Sequential] {
        let single = Single::new(form);
        for _ in 0..2_000 {
            let points = singles(&mut random);
            for (k, at) in CORNERS {
                assert_eq!(single.point(&single.net(&points), at), (points[k], 0));
                compared += 1;
            }
        }
    }
    for form in Form::ALL {
        for settings in formats() {
            let fixed = Fixed::new(form, settings);
            for _ in 0..50 {
                let points = integers(&mut random, &settings);
                for (k, at) in CORNERS {
                    assert_eq!(fixed.point(&fixed.net(&points), at), (points[k], 0), "{form:?}");
                    compared += 1;
                }
            }
        }
    }
    assert_eq!(compared, 2 * 8_000 + 3 * 9_600);
}

#[test]
fn only_the_vertex_is_fitted_and_what_does_not_fit_is_counted() {
    let mut random = Random::new(0xd0_0007);
    let (mut compared, mut overflows) = (0, 0);
    for settings in formats().into_iter().filter(|s| s.position.width <= 44) {
        // Four more bits, in ulps of the same size, hold what a vertex may stray from its hull.
        let Format { width, fraction } = settings.position;
        let roomy = Settings { position: Format { width: width + 4, fraction }, ..settings };
        for form in Form::ALL {
            let [narrow, wide] = [settings, roomy].map(|s| Fixed::new(form, s));
            for _ in 0..400 {
                let points = integers(&mut random, &settings);
                let at = [parameter(&mut random), parameter(&mut random)];
                let (exact, none) = wide.point(&wide.net(&points), at);
                assert_eq!(none, 0);
                let max = settings.position.max();
                let want = exact.map(|c| match settings.overflow {
                    Overflow::Saturate => c.clamp(-max, max),
                    Overflow::Wrap => (c + max + 1).rem_euclid(2 * (max + 1)) - max - 1,
                });
                let differ = (0..4).filter(|&k| want[k] != exact[k]).count() as u32;
                assert_eq!(narrow.point(&narrow.net(&points), at), (want, differ));
                compared += 1;
                overflows += u64::from(differ);
            }
        }
    }
    println!("compared {compared} vertices, {overflows} coordinates did not fit");
    assert!(compared == 32 * 3 * 400 && overflows > 100);
}

#[test]
fn a_visit_gives_what_single_points_give() {
    let mut random = Random::new(0xd0_0008);
    let mut compared = 0;
    for form in Form::ALL {
        for _ in 0..200 {
            let points = singles(&mut random);
            let single = Single::new(form);
            let net = single.net(&points);
            // Runs along a ring share one parameter or the other.
            let mut at = [0; 2];
            let sites: Vec<[u32; 2]> = (0..40)
                .map(|_| {
                    at[random.integer(0, 1) as usize] = parameter(&mut random);
                    at
                })
                .collect();
            let mut visited = Vec::new();
            single.visit(&net, &sites, &mut |p, over| visited.push((p, over)));
            let alone: Vec<_> = sites.iter().map(|&at| single.point(&net, at)).collect();
            assert_eq!(visited, alone);
            compared += visited.len();
        }
    }
    assert_eq!(compared, 24_000);
}
