//! Back-face removal: `tangent_plane` never drops a patch of which the quantised surface has a
//! front-facing sample, and drops most of those that have none.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/random.rs"]
mod random;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;

use glam::{DVec3, Mat4, Vec3};
use random::Random;
use rtl_model::backface::{self, Method, Verdict};
use rtl_model::number::{Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch};
use rtl_model::patch::{Patch, View};
use rtl_model::port;
use run::{camera, scale};
use tessim::config::Config;
use tessim::shader::control_point;
use tessim::trace::command::{Command, Frame};
use tessim::trace::open::Trace;
use tessim::unit::FrameState;

/// Samples along each direction.
const SAMPLES: usize = 65;

/// The patches of a shipped trace and whether they face inward.
fn model(name: &str) -> (Vec<[[f32; 4]; 16]>, bool) {
    let mut points = Vec::new();
    let mut reversed = false;
    for located in Trace::open(format!("traces/{name}.jsonl")).expect("a shipped trace") {
        match located.expect("a shipped trace is well-formed").command {
            Command::Points(p) => {
                p.source.read(0, p.source.len() as usize, &mut points).expect("inline points");
            }
            Command::Draw(draw) => reversed = draw.reversed,
            _ => {}
        }
    }
    let patch = |c: &[[f32; 4]]| c.try_into().expect("sixteen points");
    (points.chunks_exact(16).map(patch).collect(), reversed)
}

struct Port<'a>(&'a [[f32; 4]; 16], &'a View);

impl Modal for Port<'_> {
    type Output = ([[i64; 4]; 16], bool);

    fn run<R: RoundingMode, O: OverflowMode>(self) -> Self::Output {
        let quantised = self.0.map(|p| port::accept::<R, O>(p.map(f32::to_bits), self.1.position));
        (quantised.map(|q| q.point), quantised.iter().any(|q| q.overflows > 0))
    }
}

/// Signs of a surface's samples, positive in front: x, y, w of the control points.
fn faces_viewer(points: &[DVec3; 16], front: f64) -> bool {
    let bernstein = |t: f64| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let derivative = |t: f64| {
        let s = 1.0 - t;
        [-s * s, s * (s - 2.0 * t), t * (2.0 * s - t), t * t]
    };
    let sum = |c: [DVec3; 4], b: [f64; 4]| c[0] * b[0] + c[1] * b[1] + c[2] * b[2] + c[3] * b[3];
    let at = |k: usize| k as f64 / (SAMPLES - 1) as f64;
    let column = |j: usize| [0, 4, 8, 12].map(|i| points[i + j]);
    let largest = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    for v in (0..SAMPLES).map(at) {
        let along = [0, 1, 2, 3].map(|j| sum(column(j), bernstein(v)));
        let slope = [0, 1, 2, 3].map(|j| sum(column(j), derivative(v)));
        for u in (0..SAMPLES).map(at) {
            let (s, sv) = (sum(along, bernstein(u)), sum(slope, bernstein(u)));
            let su = sum(along, derivative(u));
            // f64 carries 53 bits: below this a sample is edge-on as far as it can tell.
            if s.dot(su.cross(sv)) * front > 1e-13 * largest * largest * largest {
                return true;
            }
        }
    }
    false
}

/// One patch under one view: whether the quantised and the f32 surface face the viewer anywhere,
/// and the verdicts.
struct Seen {
    quantised: bool,
    exact: bool,
    tangent_plane: bool,
    net_facets: bool,
}

fn see(
    points: &[[f32; 4]; 16],
    reversed: bool,
    matrix: &Mat4,
    view: &View,
    config: &Config,
) -> Seen {
    let clip = points.map(|p| control_point::transform(matrix, p));
    let (rounding, overflow) = (config.position.rounding, config.position.overflow);
    let (quantised, saturated) = dispatch(rounding, overflow, Port(&clip, view));
    let patch = Patch { id: 0, points: quantised, saturated, cull: true, reversed };
    let front = (if reversed { -view.facing } else { view.facing }) as f64;
    let culls = |method| backface::accept(&patch, view, method) == Verdict::Culled;
    let integers = quantised.map(|[x, y, _, w]| DVec3::new(x as f64, y as f64, w as f64));
    let singles = clip.map(|[x, y, _, w]| DVec3::new(x.into(), y.into(), w.into()));
    Seen {
        quantised: faces_viewer(&integers, front),
        exact: faces_viewer(&singles, front),
        tangent_plane: culls(Method::TangentPlane),
        net_facets: culls(Method::NetFacets),
    }
}

/// A view from outside: 2.5 to 8 radii away from the middle of a model.
fn view(random: &mut Random, centre: Vec3, radius: f32) -> (Frame, Mat4) {
    let direction = loop {
        let d = Vec3::from([(); 3].map(|()| random.single(-1.0, 1.0)));
        if (0.1..1.0).contains(&d.length()) {
            break d.normalize();
        }
    };
    let distance = radius * random.single(2.5, 8.0);
    let frame = camera(direction * distance, radius, distance + 2.0 * radius);
    (frame, Mat4::from_translation(-centre))
}

fn bounds(patches: &[[[f32; 4]; 16]]) -> (Vec3, f32) {
    let points = || patches.iter().flatten().map(|p| Vec3::new(p[0], p[1], p[2]));
    let (low, high) =
        (points().fold(Vec3::INFINITY, Vec3::min), points().fold(Vec3::NEG_INFINITY, Vec3::max));
    ((low + high) / 2.0, (high - low).length() / 2.0)
}

/// Patches without a front-facing sample, how many of them were dropped, and false culls.
#[derive(Clone, Copy, Default)]
struct Score {
    away: u32,
    dropped: u32,
    false_culls: u32,
}

impl Score {
    fn add(&mut self, faces: bool, culled: bool) {
        self.away += u32::from(!faces);
        self.dropped += u32::from(!faces && culled);
        self.false_culls += u32::from(faces && culled);
    }

    fn print(&self, what: &str) {
        let rate = 100.0 * f64::from(self.dropped) / f64::from(self.away.max(1));
        println!(
            "{what:<40} {:>6} away, dropped {rate:5.1} %, false culls {}",
            self.away, self.false_culls
        );
    }
}

#[test]
fn at_the_default_format_most_back_facing_patches_are_dropped_and_no_other() {
    let config = Config::default();
    let mut random = Random::new(4);
    let mut pooled = Score::default();
    for name in ["teapot", "teacup", "teaspoon"] {
        let (patches, reversed) = model(name);
        let (centre, radius) = bounds(&patches);
        let mut scores = [Score::default(); 3];
        for _ in 0..scale(200, 2000) {
            let (frame, matrix) = view(&mut random, centre, radius);
            let state = FrameState::new(&frame, &config).expect("a finite far plane");
            let matrix = control_point::concatenate(&state.clip_from_world, &matrix);
            for patch in &patches {
                let seen = see(patch, reversed, &matrix, &state.view, &config);
                assert!(!(seen.tangent_plane && seen.quantised), "{name}: a visible patch dropped");
                pooled.add(seen.quantised, seen.tangent_plane);
                scores[0].add(seen.quantised, seen.tangent_plane);
                scores[1].add(seen.exact, seen.tangent_plane);
                scores[2].add(seen.quantised, seen.net_facets);
            }
        }
        for (score, what) in
            scores.iter().zip(["tangent_plane", "tangent_plane, f32 surface", "net_facets"])
        {
            score.print(&format!("{name}: {what}"));
        }
    }
    pooled.print("pooled: tangent_plane");
    assert!(pooled.away > 1500, "only {} patches faced away", pooled.away);
    assert!(f64::from(pooled.dropped) >= 0.85 * f64::from(pooled.away));
}

#[test]
fn at_any_format_no_patch_with_a_front_facing_sample_is_dropped() {
    let mut random = Random::new(5);
    let (mut dropped, mut tested) = (0, 0);
    for _ in 0..scale(4000, 100_000) {
        let mut config = Config::default();
        config.position.width = 8 + random.integer(0, 40);
        config.position.rounding = random.of(Rounding::ALL);
        config.position.overflow = random.of(Overflow::ALL);
        let bulge = random.of([0.0, 0.02, 0.3, 1.0]);
        let patch = std::array::from_fn(|k| {
            let mut p = [(k % 4) as f32 / 3.0, (k / 4) as f32 / 3.0, 0.0, 1.0];
            for c in &mut p[..3] {
                *c += random.single(-bulge, bulge);
            }
            p
        });
        let (frame, matrix) = view(&mut random, Vec3::new(0.5, 0.5, 0.0), 1.0);
        let state = FrameState::new(&frame, &config).expect("a finite far plane");
        let matrix = control_point::concatenate(&state.clip_from_world, &matrix);
        let seen = see(&patch, random.integer(0, 1) == 1, &matrix, &state.view, &config);
        assert!(!(seen.tangent_plane && seen.quantised), "dropped under {config:?}: {patch:?}");
        dropped += u32::from(seen.tangent_plane);
        tested += 1;
    }
    println!("compared {tested} patches, {dropped} dropped");
    assert!(dropped * 5 > tested, "only {dropped} of {tested} dropped: the test saw nothing");
}
