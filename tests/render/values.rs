//! Heat maps: their values against numbers computed here, their colours against their values.

use super::support::{config, device, look, path, picture, shot, trace};
use tessim::config::Config;
use tessim::error::Result;
use tessim::gpu::render::{Image, Scale, colour, draw};
use tessim::sink::{FrameInfo, PatchMesh, Sink};
use tessim::study::picture::{Shot, Style, scale};
use tessim::study::walk::Walk;
use tessim::trace::command::Command;
use tessim::trace::open::Trace;

type Place = [f64; 2];

/// A triangle: its corners in clip space and their parameters.
#[derive(Clone, Copy)]
struct Made {
    patch: usize,
    clip: [[f64; 4]; 3],
    at: [Place; 3],
}

/// Triangles in draw order, and the surfaces' control points in clip space.
#[derive(Default)]
struct Known {
    viewport: [u32; 2],
    worth: f64,
    triangles: Vec<Made>,
    surfaces: Vec<[[f64; 4]; 16]>,
}

impl Sink for Known {
    fn wants(&self, frame: u64) -> bool {
        frame == 0
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.viewport = frame.view.viewport;
        self.worth = 0.5_f64.powi(frame.view.position.fraction);
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        for triangle in mesh.triangles {
            let corners = triangle.map(|index| mesh.vertices[usize::from(index)]);
            self.triangles.push(Made {
                patch: mesh.patch as usize,
                clip: corners.map(|v| v.position.map(|c| c as f64 * self.worth)),
                at: corners.map(|v| [v.u, v.v].map(|t| f64::from(t) / 65536.0)),
            });
        }
        Ok(())
    }
}

impl Known {
    fn of(name: &str, config: &Config) -> Self {
        let mut known = Self::default();
        let commands = || Trace::open(trace(name)).unwrap().map(|located| located.unwrap().command);
        tessim::simulate(commands().map(Ok), config, &mut known).unwrap();
        let mut walk = Walk::new(config);
        let mut frames = 0;
        for command in commands() {
            frames += u32::from(matches!(command, Command::Frame(_)));
            if frames > 1 {
                break;
            }
            walk.command(&command, &mut |_, drawn| known.surfaces.push(drawn.exact)).unwrap();
        }
        known
    }

    fn pixel(&self, [x, y, _, w]: [f64; 4]) -> Place {
        let [width, height] = self.viewport.map(f64::from);
        [(x / w + 1.0) / 2.0 * width, (1.0 - y / w) / 2.0 * height]
    }

    /// Half the cross product of two sides.
    fn area(&self, made: &Made) -> f64 {
        let [a, b, c] = made.clip.map(|p| self.pixel(p));
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0
    }

    /// Whether another triangle is nearer at a pixel of this one.
    fn is_hidden(&self, made: &Made, at: Place) -> bool {
        let own = self.depth(made, at).expect("the pixel is the triangle's own");
        self.triangles.iter().any(|other| self.depth(other, at).is_some_and(|z| z < own - 1e-6))
    }

    /// The depth at a pixel; `None` where that is not the triangle's.
    fn depth(&self, made: &Made, at: Place) -> Option<f64> {
        let places = made.clip.map(|p| self.pixel(p));
        let turn = |a: Place, b: Place, c: Place| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let [a, b, c] = places;
        let weights = [turn(b, c, at), turn(c, a, at), turn(a, b, at)].map(|t| t / turn(a, b, c));
        let inside = weights.iter().all(|weight| *weight >= -1e-9);
        inside.then(|| (0..3).map(|k| weights[k] * made.clip[k][2] / made.clip[k][3]).sum())
    }

    /// The greatest distance, over a lattice of 32 parts a side.
    fn error(&self, made: &Made) -> f64 {
        const PARTS: u32 = 32;
        let places = (0..=PARTS).flat_map(|i| (0..=PARTS - i).map(move |j| [PARTS - i - j, i, j]));
        let error = |weights: [u32; 3]| {
            let weights = weights.map(|w| f64::from(w) / f64::from(PARTS));
            let mix = |of: [f64; 3]| (0..3).map(|k| weights[k] * of[k]).sum::<f64>();
            let clip = [0, 1, 2, 3].map(|axis| mix(made.clip.map(|c| c[axis])));
            let [u, v] = [0, 1].map(|axis| mix(made.at.map(|t| t[axis])));
            let (a, b) = (self.pixel(clip), self.pixel(surface(&self.surfaces[made.patch], u, v)));
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        places.map(error).fold(0.0, f64::max)
    }
}

/// De Casteljau's algorithm, along u and then along v.
fn surface(points: &[[f64; 4]; 16], u: f64, v: f64) -> [f64; 4] {
    let mix = |a: [f64; 4], b: [f64; 4], t: f64| [0, 1, 2, 3].map(|k| a[k] * (1.0 - t) + b[k] * t);
    let curve = |mut p: [[f64; 4]; 4], t: f64| {
        for last in (1..4).rev() {
            for k in 0..last {
                p[k] = mix(p[k], p[k + 1], t);
            }
        }
        p[0]
    };
    let rows = [0, 4, 8, 12].map(|row| curve([0, 1, 2, 3].map(|k| points[row + k]), u));
    curve(rows, v)
}

#[test]
fn errors_and_areas_are_those_of_a_computation_of_their_own() {
    for (name, settings) in [
        ("teapot", vec!["level.criterion=fixed", "level.level=5"]),
        ("rational", vec!["level.pixels=2"]),
        ("mesh", vec!["unit=d3d11"]),
    ] {
        let (shot, known) = (shot(name, 0, &settings), Known::of(name, &config(&settings)));
        let [areas, errors] = [Style::Area, Style::Error].map(|style| shot.values(style));
        assert_eq!((areas.len(), errors.len()), (known.triangles.len(), known.triangles.len()));
        assert!(areas.len() > 100 && errors.iter().any(|error| *error > 0.3), "{name}");
        for (k, made) in known.triangles.iter().enumerate() {
            let (area, error) = (known.area(made), known.error(made));
            assert!(
                (areas[k] - area).abs() < 1e-6 * (1.0 + area),
                "{name} {k}: {} {area}",
                areas[k]
            );
            // A lattice of 4, 8 or 16 parts is some of the points of one of 32.
            assert!(errors[k] <= error + 1e-6, "{name} {k}: {} {error}", errors[k]);
            assert!(error <= 1.2 * errors[k] + 0.01, "{name} {k}: {} {error}", errors[k]);
        }
    }
}

#[test]
fn a_fixed_level_is_one_colour() {
    let Some(device) = device() else { return };
    let shot = shot("teapot", 0, &["level.criterion=fixed", "level.level=8"]);
    assert!(shot.values(Style::Level).iter().all(|level| *level == 8.0));
    let size = [200, 160];
    let look = look(&shot, Style::Level, size).without_lines();
    let image = draw(device, &shot.facets(Style::Level, size), &look, size, None).unwrap();
    let one = colour(0.5);
    let (mut pure, mut mixed) = (0, 0);
    for pixel in image.rgb.chunks(3) {
        if pixel == look.background {
            continue;
        }
        pure += usize::from((0..3).all(|k| pixel[k].abs_diff(one[k]) <= 1));
        // At its outline, between the one colour and the background.
        let between = |k: usize| {
            let ends = [look.background[k], one[k]];
            (ends[0].min(ends[1]).saturating_sub(1)..=ends[0].max(ends[1]).saturating_add(1))
                .contains(&pixel[k])
        };
        assert!((0..3).all(between), "{pixel:?}");
        mixed += 1;
    }
    assert!(pure > 5000 && 10 * pure > 9 * mixed, "{pure} of {mixed}");
}

/// The place on the scale whose colour a pixel has, and how far off that colour is.
fn nearest(pixel: [u8; 3]) -> (f64, u32) {
    let off = |place: f64| {
        let colour = colour(place);
        (0..3).map(|k| u32::from(pixel[k].abs_diff(colour[k]))).sum::<u32>()
    };
    let places = (0..=1000).map(|k| f64::from(k) / 1000.0);
    places.map(|place| (place, off(place))).min_by_key(|(_, off)| *off).unwrap()
}

/// How many triangles show a colour of their value where their middle is, and how many are large
/// enough to be asked.
fn agreeing(image: &Image, known: &Known, shot: &Shot, style: Style, scale: Scale) -> [usize; 2] {
    let (mut asked, mut right) = (0, 0);
    for (made, value) in known.triangles.iter().zip(shot.values(style)) {
        let corners = made.clip.map(|p| known.pixel(p));
        let middle = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
        let inside = (0..2).all(|k| (1.0..f64::from(image.size[k]) - 1.0).contains(&middle[k]));
        if known.area(made) < 60.0 || !inside || known.is_hidden(made, middle) {
            continue;
        }
        asked += 1;
        let (place, off) = nearest(image.pixel(middle[0] as u32, middle[1] as u32));
        right += usize::from(off <= 6 && (place - scale.place(value)).abs() < 0.02);
    }
    [right, asked]
}

#[test]
fn colours_of_areas_are_those_of_their_values() {
    let Some(device) = device() else { return };
    let settings = ["level.criterion=fixed", "level.level=5"];
    let (shot, known) = (shot("teapot", 0, &settings), Known::of("teapot", &config(&settings)));
    let size = shot.viewport();
    let scale = scale(Style::Area, &shot.measured(Style::Area));
    let look = look(&shot, Style::Area, size).without_lines();
    let image = draw(device, &shot.facets(Style::Area, size), &look, size, None).unwrap();
    let [right, asked] = agreeing(&image, &known, &shot, Style::Area, scale);
    println!("{right} of {asked}");
    assert!(asked > 200 && 100 * right > 97 * asked, "{right} of {asked}");
}

#[test]
fn lamps_stand_where_they_are_said_to_and_every_part_is_drawn() {
    let Some(device) = device() else { return };
    assert!(path("traces").exists());
    let shot = shot("teapot", 0, &[]);
    let size = [320, 256];
    let image = picture(device, &shot, Style::Shaded, size);
    let background = look(&shot, Style::Shaded, size).background;
    let drawn = |x: u32, y: u32| image.pixel(x, y) != background;
    let light = |part: &dyn Fn(u32) -> bool| {
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let lit = pixels.filter(|&(x, y)| part(x) && drawn(x, y));
        let lights: Vec<u32> =
            lit.map(|(x, y)| image.pixel(x, y).iter().map(|c| u32::from(*c)).sum()).collect();
        f64::from(lights.iter().sum::<u32>()) / lights.len() as f64
    };
    // The key light is on the left.
    let (left, right) = (light(&|x| x < 130), light(&|x| x > 190));
    assert!(left > 1.05 * right, "{left} {right}");
    let covered =
        (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).filter(|&(x, y)| drawn(x, y));
    let share = covered.count() as f64 / f64::from(size[0] * size[1]);
    assert!((0.1..0.6).contains(&share), "{share}");
}
