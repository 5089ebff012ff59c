//! Hull and domain shaders against their definitions: vertices in every form and arithmetic, and
//! the decisions of the distance test.

use super::ledger::Ledger;
use super::random::{Kind, Random, patch};
use super::table::budget::weights_matter;
use super::table::{At, Quantity as Q};
use super::walk::Drawn;
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::ONE;
use tessim::config::d3d11::Form;
use tessim::golden::{self, Real};
use tessim::shader::domain::{Evaluator, Fixed, Settings, Single};
use tessim::shader::hull;

/// A unit roundoff of f32.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// Roundings, in units relative to the terms, of a coordinate of V_B: t and 1 - t rounded, a weight
/// of up to three of them and three roundings more, a product and two sums; of V_S: a weight, a
/// product and a sum.
const CURVE_UNITS: f64 = 9.0;
const POLYGON_UNITS: f64 = 3.0;

/// Roundings of a projected coordinate: 1 / w, two products.
const PROJECTION_UNITS: f64 = 3.0;

/// Of a distance: two differences, two squares, their sum, and the threshold's square.
const DISTANCE_UNITS: f64 = 4.0;

/// A patch in both arithmetics at random sites, and its factors.
pub(crate) fn random(ledger: &mut Ledger, random: &mut Random) {
    let kind = random.of(Kind::ALL);
    let settings = settings(random, random_format);
    let raw = patch(random, kind, settings.position.max()).points;
    let size = random.octaves(1e-6, 1e6) / settings.position.max() as f64;
    let singles = raw.map(|p| p.map(|c| (c as f64 * size) as f32));
    for _ in 0..4 {
        let at = [(); 2].map(|()| random.integer(0, ONE));
        let end = random.of([0, ONE]);
        let at = random.of([at, at, [at[0], end]]);
        single(ledger, &singles, at);
        fixed(ledger, &raw, settings, at);
    }
    // Before the camera, or some of it behind.
    let ahead = random.of([0.0, 0.0, 0.6]) as f32;
    let largest = singles.iter().flatten().fold(0f32, |m, c| m.max(c.abs()));
    let points = singles.map(|[x, y, z, w]| [x, y, z, w.abs() - ahead * largest]);
    let near = random.single(0.0, 0.3) * largest;
    let viewport = [random.integer(1, 16384), random.integer(1, 4096)];
    let pixels = random.octaves(0.05, 3000.0) as f32;
    let candidates = random.integer(1, tessim::config::d3d11::CANDIDATES_MAX);
    distances(ledger, &points, hull::Settings { candidates, pixels, viewport, near });
}

/// The same of a patch of a shipped trace.
pub(crate) fn trace(ledger: &mut Ledger, drawn: &Drawn) {
    let mut random = Random::new(0xd3d_0011 + u64::from(drawn.patch.id));
    let position = drawn.frame.view.position;
    let settings = settings(&mut random, |_| position);
    for _ in 0..8 {
        let at = [(); 2].map(|()| random.integer(0, ONE));
        single(ledger, &drawn.shaded, at);
        fixed(ledger, &drawn.patch.points, settings, at);
    }
    for (candidates, pixels) in [(3, 0.5), (15, 0.1), (20, 2.0)] {
        let viewport = drawn.frame.view.viewport;
        distances(
            ledger,
            &drawn.shaded,
            hull::Settings { candidates, pixels, viewport, near: 1e-3 },
        );
    }
}

fn random_format(random: &mut Random) -> Format {
    Format::of_range(random.integer(8, 48), 0)
}

fn settings(random: &mut Random, position: impl Fn(&mut Random) -> Format) -> Settings {
    Settings {
        position: position(random),
        weight_bits: random.integer(16, 30),
        rounding: random.of(Rounding::ALL),
        overflow: random.of(Overflow::ALL),
    }
}

fn reals([u, v]: [u32; 2]) -> [f64; 2] {
    [u, v].map(|t| f64::from(t) / f64::from(ONE))
}

fn single(ledger: &mut Ledger, points: &[[f32; 4]; 16], at: [u32; 2]) {
    let real: [Real; 16] = points.map(|p| p.map(f64::from));
    let [u, v] = reals(at);
    let want = golden::domain::point(&real, u, v);
    for (quantity, form) in [
        (Q::DomainPaired, Form::Paired),
        (Q::DomainSequential, Form::Sequential),
        (Q::DomainPower, Form::Power),
    ] {
        let evaluator = Single::new(form);
        let (got, _) = evaluator.point(&evaluator.net(points), at);
        let terms = match form {
            Form::Power => golden::domain::power_magnitude(&real, u, v),
            _ => golden::domain::magnitude(&real, u, v),
        };
        for axis in (0..4).filter(|&axis| terms[axis] > 1e-30) {
            let error = (f64::from(got[axis]) - want[axis]).abs() / terms[axis] / UNIT;
            ledger.error(quantity, &At::default(), error);
        }
    }
}

fn fixed(ledger: &mut Ledger, points: &[[i64; 4]; 16], settings: Settings, at: [u32; 2]) {
    let Settings { position, weight_bits, rounding, overflow } = settings;
    let real = golden::real(points);
    let [u, v] = reals(at);
    let want = golden::domain::point(&real, u, v);
    let span = 2f64.powi(position.width as i32);
    for form in Form::ALL {
        let evaluator = Fixed::new(form, settings);
        let (got, _) = evaluator.point(&evaluator.net(points), at);
        for axis in 0..4 {
            let off = (got[axis] as f64 - want[axis]).abs();
            // What wrapped is as good as what did not.
            let error = if overflow == Overflow::Wrap { off.min((span - off).abs()) } else { off };
            let largest = real.iter().fold(0.0, |m: f64, p| m.max(p[axis].abs()));
            let spread = largest * 2f64.powi(-(weight_bits as i32));
            let at = At { width: position.width, rounding, spread, ..At::default() };
            let quantity = if form == Form::Power { Q::DomainFixedPower } else { Q::DomainFixed };
            ledger.error(quantity, &at, error);
            if form != Form::Power && weights_matter(&at) {
                ledger.error(Q::DomainFixedWeights, &at, error);
            }
        }
    }
}

fn distances(ledger: &mut Ledger, points: &[[f32; 4]; 16], settings: hull::Settings) {
    let hull::Settings { candidates, pixels, viewport, near } = settings;
    let adaptive = hull::Adaptive::new(settings);
    let inserted = |candidate: &golden::hull::Candidate| {
        let distance = candidate.distance(viewport, f64::from(near));
        distance.is_none_or(|distance| distance > f64::from(pixels))
    };
    let mut sure = true;
    for k in 0..8 {
        let curve =
            if k < 4 { [0, 1, 2, 3].map(|j| 4 * k + j) } else { [0, 4, 8, 12].map(|i| i + k - 4) };
        let curve = curve.map(|k| points[k]);
        let got = adaptive.insertions(&curve);
        let curve = curve.map(|p| p.map(f64::from));
        for candidate in golden::hull::candidates(&curve, candidates) {
            if doubtful(&curve, &candidate, settings) {
                ledger.untested += 1;
                sure = false;
            } else {
                let got = got >> candidate.k & 1 == 1;
                ledger.equal(Q::HullDecision, got, inserted(&candidate));
            }
        }
    }
    if sure {
        let real = points.map(|p| p.map(f64::from));
        let want = golden::hull::factors(&real, candidates, inserted);
        let got = adaptive.factors(points);
        ledger.equal(Q::HullFactors, got.factors.map(f64::from), want);
    }
}

/// Whether f32 may decide otherwise.
fn doubtful(
    curve: &[Real; 4],
    candidate: &golden::hull::Candidate,
    settings: hull::Settings,
) -> bool {
    let hull::Settings { candidates, pixels, viewport, near } = settings;
    let near = f64::from(near);
    let t = f64::from(candidate.k) / f64::from(3 * (candidates + 1));
    let magnitudes = curve.map(|p| p.map(f64::abs));
    let sides = [
        (candidate.polygon, golden::hull::polygon(&magnitudes, t).map(|m| m * POLYGON_UNITS)),
        (candidate.curve, golden::domain::curve(&magnitudes, t).map(|m| m * CURVE_UNITS)),
    ];
    let ws = sides.map(|(p, units)| (p[3], units[3] * UNIT));
    if ws.iter().any(|(w, off)| (w - near.max(0.0)).abs() <= *off) {
        return true;
    }
    let Some(distance) = candidate.distance(viewport, near) else { return false };
    let off = |axis: usize| -> f64 {
        let side = |(p, units): &(Real, Real)| {
            let (x, w) = (p[axis].abs(), p[3] - units[3] * UNIT);
            (units[axis] + x / w * units[3] + PROJECTION_UNITS * x) / w
        };
        f64::from(viewport[axis]) / 2.0 * UNIT * sides.iter().map(side).sum::<f64>()
    };
    let band = off(0).hypot(off(1)) + DISTANCE_UNITS * UNIT * distance;
    (distance - f64::from(pixels)).abs() <= band
}
