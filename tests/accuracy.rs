//! Accuracy: how far the tessellation is from the true surface, in pixels, against the tolerance
//! that was asked for.
//!
//! Vertices are the hardware's fixed-point clip positions; between them a segment or a triangle
//! is linear on the screen. The true surface is f64 from the control points on. The distance is
//! taken at equal parameters, densely inside every segment and triangle, and divided by the
//! tolerance.
//!
//! Where w is 1 and no level was cut to the greatest, two bounds are rigorous and the ratio is at
//! most 1: the second derivative's for boundary curves, Filip's for triangles of the interior
//! grid. The strips between the two have no such bound where an edge has fewer segments than the
//! interior, and under perspective the bounds are estimates, since a projected cubic is rational:
//! those ratios are printed, not asserted.

#[path = "accuracy/dyadic.rs"]
mod dyadic;
#[allow(dead_code, reason = "tests/agreement draws patches of other kinds")]
#[path = "support/random.rs"]
mod random;
#[allow(dead_code, reason = "tests/agreement reads what is left over here")]
#[path = "support/walk.rs"]
mod walk;

use random::Random;
use rtl_model::evaluate::{Evaluate, Settings};
use rtl_model::level::{self, Criterion, State};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, Level, Levels, Patch, Vertex, View};
use rtl_model::place::Placement;
use rtl_model::stitch;
use tessim::config::{Config, Scheme};
use tessim::golden::place::{Placed, place};
use tessim::golden::{Real, evaluate};

/// What positions may add to a ratio. A shader's f32 coordinate is off by 2^-22 of some 640
/// pixels, a parameter kR / 2^32 makes the last step longer by 2^-26 of itself: each below a
/// thousandth of half a pixel.
const ALLOWANCE: f64 = 2e-3;

/// Samples inside a segment.
const INSIDE: u32 = 16;

/// Ratios of one kind.
#[derive(Default)]
struct Ratios(Vec<f64>);

impl Ratios {
    fn line(&mut self, name: &str) -> f64 {
        self.0.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| {
            let last = self.0.len().saturating_sub(1);
            self.0.get((last as f64 * share) as usize).copied().unwrap_or(0.0)
        };
        let (p50, p99, max) = (at(0.5), at(0.99), at(1.0));
        println!(
            "{name:<44} {:>9} samples  p50 {p50:.4}  p99 {p99:.4}  max {max:.4}",
            self.0.len()
        );
        max
    }
}

/// Ratios of a model, by what bounds them.
#[derive(Default)]
struct Account {
    /// Edges, and triangles of the interior grid, whose levels the criterion chose.
    edges: Ratios,
    grid: Ratios,
    /// Triangles with a vertex on an edge.
    strips: Ratios,
    /// Edges and grids of which the criterion asked more than the greatest level, or that have no
    /// projection.
    cut: Ratios,
}

impl Account {
    fn lines(&mut self, name: &str) -> [f64; 2] {
        let edges = self.edges.line(&format!("{name}: boundary curves"));
        let grid = self.grid.line(&format!("{name}: interior grid"));
        self.strips.line(&format!("{name}: strips"));
        if !self.cut.0.is_empty() {
            self.cut.line(&format!("{name}: cut to the greatest level"));
        }
        [edges, grid]
    }
}

/// A patch that has been tessellated, beside the surface that it stands for.
struct Case<'a> {
    truth: &'a [Real; 16],
    vertices: Vec<[f64; 2]>,
    /// Parameters at which the vertices were evaluated.
    parameters: Vec<[f64; 2]>,
    placed: Placed,
    levels: Levels,
    view: &'a View,
    max: Level,
    pixels: f64,
}

/// Pixels from the centre of the screen.
fn screen([x, y, _, w]: Real, view: &View) -> [f64; 2] {
    [x / w * f64::from(view.viewport[0]) / 2.0, y / w * f64::from(view.viewport[1]) / 2.0]
}

/// Tessellates; `None` where a point is behind the near threshold, so that nothing is seen of the
/// error.
fn tessellate<'a>(
    patch: &Patch,
    truth: &'a [Real; 16],
    view: &'a View,
    state: &State,
    config: &Config,
    triangles: &mut Vec<[u16; 3]>,
) -> Option<Case<'a>> {
    let (levels, events) = level::accept(patch, view, state);
    let Criterion::Flatness { pixels } = state.criterion else { return None };
    if events.near > 0 {
        return None;
    }
    let mut placement = Placement::of_reciprocal(config.place.reciprocal_bits);
    placement.set(&levels);
    let settings = Settings {
        position: view.position,
        guard: config.guard(),
        scheme: Scheme::Forward,
        rounding: config.evaluate.rounding,
        overflow: config.position.overflow,
    };
    let mut vertices: Vec<Vertex> = Vec::new();
    Evaluate::new(settings).accept(patch, &placement, &mut vertices);
    triangles.clear();
    stitch::accept(placement.segments(), triangles);
    let placed = place(&levels, config.place.reciprocal_bits);
    let parameters = placed.sites().iter().map(|site| [site.u.run, site.v.run]).collect();
    let pixel = |v: &Vertex| screen(v.position.map(|c| c as f64), view);
    Some(Case {
        truth,
        vertices: vertices.iter().map(pixel).collect(),
        parameters,
        placed,
        levels,
        view,
        max: state.max,
        pixels: f64::from(pixels) / 65536.0,
    })
}

impl Case<'_> {
    /// The ratio at a point of the triangle (or segment, with a weight of 0) of `corners`.
    fn ratio(&self, corners: [usize; 3], weights: [f64; 3]) -> f64 {
        let mix = |of: &[[f64; 2]], axis: usize| {
            (0..3).map(|k| weights[k] * of[corners[k]][axis]).sum::<f64>()
        };
        let [u, v] = [0, 1].map(|axis| mix(&self.parameters, axis));
        let truth = screen(evaluate::surface(self.truth, u, v), self.view);
        let [x, y] = [0, 1].map(|axis| mix(&self.vertices, axis) - truth[axis]);
        x.hypot(y) / self.pixels
    }

    fn boundary(&self, account: &mut Account) {
        let counts = self.placed.edges.each_ref().map(|entries| entries.len() - 1);
        let boundary: usize = counts.iter().sum();
        let mut first = 0;
        for (edge, segments) in counts.into_iter().enumerate() {
            let cut = self.levels.edges[edge] == self.max;
            let ratios = if cut { &mut account.cut } else { &mut account.edges };
            for k in first..first + segments {
                let corners = [k, (k + 1) % boundary, k];
                ratios.0.extend((1..INSIDE).map(|i| {
                    let t = f64::from(i) / f64::from(INSIDE);
                    self.ratio(corners, [1.0 - t, t, 0.0])
                }));
            }
            first += segments;
        }
    }

    fn inside(&self, triangles: &[[u16; 3]], account: &mut Account) {
        let boundary: usize = self.placed.edges.iter().map(|entries| entries.len() - 1).sum();
        let cut = self.levels.interior.contains(&self.max);
        for t in triangles {
            let t = t.map(usize::from);
            let ratios = match t.iter().any(|&k| k < boundary) {
                true => &mut account.strips,
                false if cut => &mut account.cut,
                false => &mut account.grid,
            };
            const N: u32 = 5;
            for (i, j) in (0..=N).flat_map(|i| (0..=N - i).map(move |j| (i, j))) {
                let [a, b] = [i, j].map(|k| f64::from(k) / f64::from(N));
                ratios.0.push(self.ratio(t, [a, b, 1.0 - a - b]));
            }
        }
    }
}

/// A patch under an orthographic camera: w = 1, so raw coordinates are the truth.
fn orthographic(random: &mut Random, view: &View) -> Patch {
    let one = view.position.max();
    let size = random.octaves(0.02, 0.9);
    let noise = random.octaves(0.001, 1.0);
    let twist = random.of([0.0, 0.0, 1.0]);
    let points = std::array::from_fn(|k| {
        let (u, v) = ((k % 4) as f64 / 1.5 - 1.0, (k / 4) as f64 / 1.5 - 1.0);
        let mut jitter = || random.real(-noise, noise);
        let x = size * (u + jitter() + twist * u * v);
        let y = size * (v + jitter() - twist * u * v);
        let raw = |c: f64| ((c * 0.33 * one as f64) as i64).clamp(-one, one);
        [raw(x), raw(y), 0, one]
    });
    Patch { id: 0, points, saturated: false, cull: false, reversed: false }
}

#[test]
fn polynomial_patches_are_within_the_tolerance() {
    let mut random = Random::new(0xacc);
    let config = Config::default();
    let count = if std::env::var_os("TESSIM_LONG").is_some() { 10_000 } else { 700 };
    let mut account = Account::default();
    let mut triangles = Vec::new();
    for _ in 0..count {
        let view = View {
            position: Format::of_range(32, 0),
            viewport: [random.integer(64, 4096), random.integer(64, 4096)],
            depth: Depth::ZeroToOne,
            near: 1,
            facing: 1,
        };
        let patch = orthographic(&mut random, &view);
        let truth = tessim::golden::real(&patch.points);
        let criterion = Criterion::Flatness { pixels: random.octaves(2e4, 1e6) as u32 };
        let state = State { criterion, min: Level::MIN, max: Level::MAX };
        let case = tessellate(&patch, &truth, &view, &state, &config, &mut triangles)
            .expect("w is 1 everywhere");
        case.boundary(&mut account);
        case.inside(&triangles, &mut account);
    }
    let [edges, grid] = account.lines("orthographic");
    assert!(account.edges.0.len() > 50_000 && account.grid.0.len() > 500_000);
    assert!(edges <= 1.0 + ALLOWANCE, "boundary curves: {edges}");
    assert!(grid <= 1.0 + ALLOWANCE, "interior grid: {grid}");
    // Not vacuous: a level a little lower would have been seen.
    assert!(edges > 0.95 && grid > 0.7, "boundary curves {edges}, interior grid {grid}");
}

#[test]
fn shipped_models_under_their_cameras() {
    let config = Config::default();
    let mut triangles = Vec::new();
    for name in walk::SHIPPED {
        let mut account = Account::default();
        walk::walk(name, &config, |_, drawn| {
            let view = &drawn.frame.view;
            let case =
                tessellate(&drawn.patch, &drawn.exact, view, &drawn.state, &config, &mut triangles);
            if let Some(case) = case {
                case.boundary(&mut account);
                case.inside(&triangles, &mut account);
            }
        });
        account.lines(name);
        assert!(account.edges.0.len() + account.cut.0.len() > 1000, "{name}");
    }
}

/// The shipped polynomial models again, seen without perspective: there the bounds hold for them,
/// too.
#[test]
fn shipped_models_without_perspective_are_within_the_tolerance() {
    let config = Config::default();
    let mut triangles = Vec::new();
    for name in walk::SHIPPED.into_iter().filter(|&name| name != "rational") {
        let mut account = Account::default();
        let mut reach = 0f64;
        walk::walk(name, &config, |_, drawn| {
            let all = drawn.object.iter().flatten();
            reach = all.fold(reach, |most, c| most.max(c.abs()));
        });
        walk::walk(name, &config, |_, drawn| {
            let view = View { position: Format::of_range(32, 0), near: 1, ..drawn.frame.view };
            let one = view.position.max();
            // Any linear map into -1..1 will do.
            let flat = |[x, y, z, _]: Real| {
                let raw = |c: f64| (c / (1.3 * reach) * one as f64) as i64;
                [raw(x + 0.3 * z), raw(z + 0.2 * y), 0, one]
            };
            let points = drawn.object.map(flat);
            let truth = tessim::golden::real(&points);
            let patch = Patch { points, ..drawn.patch };
            let criterion = Criterion::Flatness { pixels: 1 << 15 };
            let state = State { criterion, ..drawn.state };
            let case = tessellate(&patch, &truth, &view, &state, &config, &mut triangles)
                .expect("w is 1 everywhere");
            case.boundary(&mut account);
            case.inside(&triangles, &mut account);
        });
        let [edges, grid] = account.lines(&format!("{name}, orthographic"));
        assert!(edges <= 1.0 + ALLOWANCE && grid <= 1.0 + ALLOWANCE, "{name}: {edges} {grid}");
        assert!(account.edges.0.len() > 1000, "{name}");
    }
}
