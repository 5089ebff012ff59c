//! Object level: the driver's f32 against the quotient in f64.

use crate::random::Random;
use glam::{DVec4, Mat4, Vec3};
use tessim::shader::object_level::{Bounds, Policy, Settings, level};

/// Four roundings of products and three of sums lie between a corner and its transform, one of a
/// division before them, and the terms' sizes are 2^-24 of each: a bound with room.
const TRANSFORMED: f64 = 8.0 / 16_777_216.0;

/// An object of 2 to 20 points, rational or not, before a camera that looks anywhere.
fn object(random: &mut Random) -> (Vec<[f32; 4]>, Mat4) {
    let (size, rational) = (random.octaves(0.01, 10.0) as f32, random.bits() & 1 == 0);
    let count = random.integer(2, 20);
    let points = (0..count).map(|_| {
        let w = if rational { random.single(0.5, 2.0) } else { 1.0 };
        let mut c = || random.single(-size, size) * w;
        [c(), c(), c(), w]
    });
    let points = points.collect();
    let [a, b, away] = [3.0, 3.0, 0.0].map(|most| random.single(-most, most + 0.1));
    let away = (away.abs() + 1.0) * random.octaves(0.5, 40.0) as f32;
    let projection = Mat4::from_cols_array(&[
        1.4, 0.0, 0.0, 0.0, 0.0, 1.9, 0.0, 0.0, 0.0, 0.0, -1.02, -1.0, 0.0, 0.0, -0.5, 0.0,
    ]);
    let turned = Mat4::from_rotation_x(a) * Mat4::from_rotation_y(b);
    (points, projection * Mat4::from_translation(Vec3::new(0.3, -0.2, -away)) * turned)
}

fn settings(random: &mut Random) -> Settings {
    let policy = match random.bits() & 1 {
        0 => Policy::Distance { full: random.octaves(0.2, 40.0) as f32 },
        _ => Policy::ScreenSize { pixels: random.octaves(10.0, 4000.0) as f32 },
    };
    Settings {
        policy,
        level_max: random.integer(0, 15) as u8,
        viewport: [random.integer(1, 4096), random.integer(1, 4096)],
        near: random.octaves(0.01, 1.0) as f32,
    }
}

fn bounds(points: &[[f32; 4]]) -> Bounds {
    let mut bounds = Bounds::default();
    points.iter().for_each(|&p| bounds.include(p));
    bounds
}

/// A corner in clip space, and how far f32's may be from it.
fn corner(matrix: &Mat4, [x, y, z]: [f64; 3]) -> (DVec4, DVec4) {
    let (mut sum, mut size) = (DVec4::ZERO, DVec4::ZERO);
    for (k, c) in [x, y, z, 1.0].into_iter().enumerate() {
        let term = matrix.col(k).as_dvec4() * c;
        sum += term;
        size += term.abs();
    }
    (sum, size * TRANSFORMED)
}

/// The level by its definition; `None` where f32 may have another.
fn defined(points: &[[f32; 4]], matrix: &Mat4, settings: &Settings) -> Option<u8> {
    let divided = points.iter().map(|p| [0, 1, 2].map(|k| f64::from(p[k]) / f64::from(p[3])));
    let (mut least, mut most) = ([f64::MAX; 3], [f64::MIN; 3]);
    for p in divided {
        least = std::array::from_fn(|k| least[k].min(p[k]));
        most = std::array::from_fn(|k| most[k].max(p[k]));
    }
    let mut corners = Vec::new();
    for k in 0..8 {
        let at = std::array::from_fn(|axis| if k >> axis & 1 == 1 { most } else { least }[axis]);
        corners.push(corner(matrix, at));
    }
    let near = f64::from(settings.near);
    if corners.iter().any(|(p, blur)| (p.w - near).abs() <= blur.w) {
        return None;
    }
    if corners.iter().any(|(p, _)| p.w < near) {
        return Some(settings.level_max);
    }
    let (asked, blur) = match settings.policy {
        Policy::Distance { full } => {
            let nearest = corners.iter().map(|(p, _)| p.w).fold(f64::MAX, f64::min);
            let off = corners.iter().map(|(_, blur)| blur.w).fold(0.0, f64::max);
            let asked = f64::from(full) / nearest;
            (asked, asked * (off / (nearest - off) + TRANSFORMED))
        }
        Policy::ScreenSize { pixels } => {
            let (side, off) = side(&corners, settings.viewport);
            (side / f64::from(pixels), (off + side * TRANSFORMED) / f64::from(pixels))
        }
    };
    let segments = f64::from(settings.level_max) + 1.0;
    let level = |asked: f64| (segments * asked).ceil().clamp(1.0, segments) as u8 - 1;
    (level(asked - blur) == level(asked + blur)).then(|| level(asked))
}

/// The larger side of the corners' box on the screen, and how far f32's may be from it.
fn side(corners: &[(DVec4, DVec4)], viewport: [u32; 2]) -> (f64, f64) {
    let sides = [0, 1].map(|axis| {
        let half = f64::from(viewport[axis]) / 2.0;
        let (mut least, mut most, mut off) = (f64::MAX, f64::MIN, 0f64);
        for (p, blur) in corners {
            let pixel = p[axis] / p.w * half;
            (least, most) = (least.min(pixel), most.max(pixel));
            let blur = (blur[axis] * half + pixel.abs() * blur.w) / (p.w - blur.w);
            off = off.max(blur + pixel.abs() * TRANSFORMED);
        }
        (most - least, 2.0 * off)
    });
    let [(width, a), (height, b)] = sides;
    (width.max(height), a.max(b))
}

#[test]
fn the_driver_s_level_is_the_definition_s() {
    let mut random = Random::new(0x0b7e_0001);
    let (mut compared, mut open, mut between) = (0, 0, 0);
    for _ in 0..40_000 {
        let (points, matrix) = object(&mut random);
        let settings = settings(&mut random);
        let got = level(&bounds(&points), &matrix, &settings);
        let Some(want) = defined(&points, &matrix, &settings) else {
            open += 1;
            continue;
        };
        assert_eq!(got, want, "{settings:?}");
        compared += 1;
        between += u32::from((1..settings.level_max).contains(&got));
    }
    println!("compared {compared}, {between} of them between; {open} within rounding");
    assert!(open < 400 && between > 8_000, "{open} open, {between} between");
}

#[test]
fn more_points_never_ask_for_less_by_distance() {
    let mut random = Random::new(0x0b7e_0002);
    let mut more = 0;
    for _ in 0..20_000 {
        let (points, matrix) = object(&mut random);
        let policy = Policy::Distance { full: random.octaves(1.0, 20.0) as f32 };
        let settings = Settings { policy, level_max: 15, ..settings(&mut random) };
        let part = level(&bounds(&points[..1]), &matrix, &settings);
        let whole = level(&bounds(&points), &matrix, &settings);
        assert!(part <= whole, "{part} above {whole}: {settings:?}");
        more += u32::from(part < whole);
    }
    assert!(more > 1_000, "{more} times more");
}
