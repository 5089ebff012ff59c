//! The same of midpoint subdivision: how far its triangles are from the surface, where eight curves
//! are divided until they are flat, and where lists come from the bound.
//!
//! By the bound the ratio is at most 1 where the hybrid's is. Of eight curves only this is known
//! without perspective: a piece of a boundary curve whose inner points are within the tolerance of
//! its chord is within it, too. At equal parameters a curve may run ahead of its chord, and between
//! the curves the surface is nobody's care: a twist has eight straight curves.

use super::random::Random;
use super::walk;
use super::{ALLOWANCE, INSIDE, Ratios, orthographic, screen};
use rtl_model::evaluate::{Evaluate, Settings};
use rtl_model::level::{self, Criterion, State, Termination};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, Level, ONE, Patch, Triangle, Vertex, View};
use rtl_model::place::DyadicPlacement;
use rtl_model::stitch::Stitch;
use tessim::config::{Config, Scheme};
use tessim::golden::{Real, evaluate};

const TERMINATIONS: [(Termination, &str); 2] =
    [(Termination::EightCurves, "eight_curves"), (Termination::Bounded, "bounded")];

/// Ratios to the tolerance.
#[derive(Default)]
struct Account {
    /// Distance of boundary curves from the lines of their chords.
    chords: Ratios,
    /// At equal parameters: boundary curves, triangles of the interior grid, triangles with a
    /// vertex on an edge.
    edges: Ratios,
    grid: Ratios,
    strips: Ratios,
    /// All of those, of patches that were cut to the greatest depth.
    cut: Ratios,
    patches: usize,
    triangles: usize,
}

impl Account {
    /// Greatest ratios of chords, edges and grid.
    fn lines(&mut self, name: &str) -> [f64; 3] {
        println!("{name}: {} patches, {} triangles", self.patches, self.triangles);
        let chords = self.chords.line(&format!("{name}: from the chord's line"));
        let edges = self.edges.line(&format!("{name}: boundary curves"));
        let grid = self.grid.line(&format!("{name}: interior grid"));
        self.strips.line(&format!("{name}: strips"));
        if !self.cut.0.is_empty() {
            self.cut.line(&format!("{name}: cut to the greatest depth"));
        }
        [chords, edges, grid]
    }
}

/// A patch that has been tessellated, beside the surface that it stands for.
struct Case<'a> {
    truth: &'a [Real; 16],
    vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
    view: &'a View,
    pixels: f64,
    cut: bool,
}

/// Tessellates; `None` where a point is behind the near threshold.
fn tessellate<'a>(
    patch: &Patch,
    truth: &'a [Real; 16],
    view: &'a View,
    state: &State,
    termination: Termination,
) -> Option<Case<'a>> {
    let (lists, events) = level::subdivide(patch, view, state, termination);
    let Criterion::Flatness { pixels } = state.criterion else { return None };
    if events.near > 0 {
        return None;
    }
    let config = Config::default();
    let settings = Settings {
        position: view.position,
        guard: config.guard(),
        scheme: Scheme::DeCasteljau,
        rounding: config.evaluate.rounding,
        overflow: config.position.overflow,
    };
    let mut placement = DyadicPlacement::default();
    placement.set_lists(&lists);
    let mut vertices = Vec::new();
    Evaluate::new(settings).accept(patch, &placement, &mut vertices);
    let triangles = Stitch::default().accept(lists).to_vec();
    let (pixels, cut) = (f64::from(pixels) / 65536.0, events.clamped > 0);
    Some(Case { truth, vertices, triangles, view, pixels, cut })
}

impl Case<'_> {
    fn pixel(&self, vertex: usize) -> [f64; 2] {
        screen(self.vertices[vertex].position.map(|c| c as f64), self.view)
    }

    fn truth(&self, corners: [usize; 3], weights: [f64; 3]) -> [f64; 2] {
        let mix = |of: fn(&Vertex) -> u32| -> f64 {
            let weighted = |k: usize| weights[k] * f64::from(of(&self.vertices[corners[k]]));
            (0..3).map(weighted).sum::<f64>() / f64::from(ONE)
        };
        screen(evaluate::surface(self.truth, mix(|v| v.u), mix(|v| v.v)), self.view)
    }

    /// The ratio at a point of a triangle, or of a segment with a weight of 0.
    fn ratio(&self, corners: [usize; 3], weights: [f64; 3]) -> f64 {
        let [x, y] = self.truth(corners, weights);
        let mut off = [-x, -y];
        for (corner, weight) in corners.into_iter().zip(weights) {
            let pixel = self.pixel(corner);
            off = [off[0] + weight * pixel[0], off[1] + weight * pixel[1]];
        }
        off[0].hypot(off[1]) / self.pixels
    }

    /// The truth's distance from the line through both ends of a segment, or from their one point.
    fn height(&self, [a, b]: [usize; 2], t: f64) -> f64 {
        let [x, y] = self.truth([a, b, a], [1.0 - t, t, 0.0]);
        let (from, to) = (self.pixel(a), self.pixel(b));
        let (chord, point) = ([to[0] - from[0], to[1] - from[1]], [x - from[0], y - from[1]]);
        let length = chord[0].hypot(chord[1]);
        // A chord of less than the position's rounding has no direction.
        let off = match length < 1e-3 {
            true => point[0].hypot(point[1]) - length,
            false => (chord[0] * point[1] - chord[1] * point[0]).abs() / length,
        };
        off / self.pixels
    }

    fn on_edge(&self, vertex: usize) -> bool {
        let Vertex { u, v, .. } = self.vertices[vertex];
        u % ONE == 0 || v % ONE == 0
    }

    /// Both vertices are on the same edge, neighbours on it where they share a triangle.
    fn along_edge(&self, [a, b]: [usize; 2]) -> bool {
        let [a, b] = [a, b].map(|k| self.vertices[k]);
        (a.u == b.u && a.u % ONE == 0) || (a.v == b.v && a.v % ONE == 0)
    }

    fn add(&self, account: &mut Account) {
        account.patches += 1;
        account.triangles += self.triangles.len();
        for triangle in &self.triangles {
            let t = triangle.map(usize::from);
            for side in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                if self.along_edge(side) {
                    self.segment(side, account);
                }
            }
            let ratios = match t.iter().any(|&k| self.on_edge(k)) {
                _ if self.cut => &mut account.cut,
                true => &mut account.strips,
                false => &mut account.grid,
            };
            const N: u32 = 6; // the middle of a side is a sample
            for (i, j) in (0..=N).flat_map(|i| (0..=N - i).map(move |j| (i, j))) {
                let [a, b] = [i, j].map(|k| f64::from(k) / f64::from(N));
                ratios.0.push(self.ratio(t, [a, b, 1.0 - a - b]));
            }
        }
    }

    fn segment(&self, side: [usize; 2], account: &mut Account) {
        let [a, b] = side;
        for t in (1..INSIDE).map(|i| f64::from(i) / f64::from(INSIDE)) {
            let ratio = self.ratio([a, b, a], [1.0 - t, t, 0.0]);
            if self.cut {
                account.cut.0.push(ratio);
            } else {
                account.edges.0.push(ratio);
                account.chords.0.push(self.height(side, t));
            }
        }
    }
}

fn flat_view(viewport: [u32; 2]) -> View {
    let position = Format::of_range(32, 0);
    View { position, viewport, depth: Depth::ZeroToOne, near: 1, facing: 1 }
}

#[test]
fn midpoints_of_polynomial_patches_are_as_near_as_they_say() {
    let count = if std::env::var_os("TESSIM_LONG").is_some() { 6000 } else { 400 };
    for (termination, name) in TERMINATIONS {
        let mut random = Random::new(0xacd);
        let mut account = Account::default();
        for _ in 0..count {
            let view = flat_view([random.integer(64, 4096), random.integer(64, 4096)]);
            let patch = orthographic(&mut random, &view);
            let truth = tessim::golden::real(&patch.points);
            let criterion = Criterion::Flatness { pixels: random.octaves(2e4, 1e6) as u32 };
            let state = State { criterion, min: Level::MIN, max: Level::MAX };
            let case = tessellate(&patch, &truth, &view, &state, termination);
            case.expect("w is 1 everywhere").add(&mut account);
        }
        let [chords, edges, grid] = account.lines(&format!("orthographic, {name}"));
        assert!(account.edges.0.len() > 20_000 && account.grid.0.len() > 100_000);
        assert!(chords <= 1.0 + ALLOWANCE, "{name}: {chords} from the chord");
        if termination == Termination::Bounded {
            assert!(edges <= 1.0 + ALLOWANCE && grid <= 1.0 + ALLOWANCE, "{edges} {grid}");
            assert!(edges > 0.9, "a level less would have been seen");
        } else {
            assert!(chords > 0.7 && grid > 1.0, "what is not bounded shows: {chords} {grid}");
        }
    }
}

#[test]
fn midpoints_of_shipped_models() {
    for model in ["teapot", "teacup", "mesh"] {
        for (termination, name) in TERMINATIONS {
            let mut account = Account::default();
            walk::walk(model, &Config::default(), |_, drawn| {
                let (view, state) = (&drawn.frame.view, &drawn.state);
                if let Some(case) = tessellate(&drawn.patch, &drawn.exact, view, state, termination)
                {
                    case.add(&mut account);
                }
            });
            account.lines(&format!("{model}, {name}"));
            assert!(account.edges.0.len() + account.cut.0.len() > 1000, "{model}");
        }
    }
}

/// A square of 400 pixels, of which one corner is lifted by 200: x = 400 u, y = 400 v + 200 u v.
#[test]
fn a_twist_has_eight_straight_curves() {
    let view = flat_view([1024, 1024]);
    let one = view.position.max() as f64;
    let points = std::array::from_fn(|k| {
        let (u, v) = ((k % 4) as f64 / 3.0, (k / 4) as f64 / 3.0);
        let raw = |pixels: f64| (pixels / 512.0 * one) as i64;
        [raw(400.0 * u - 200.0), raw(400.0 * v - 300.0 + 200.0 * u * v), 0, one as i64]
    });
    let patch = Patch { id: 0, points, saturated: false, cull: false, reversed: false };
    let truth = tessim::golden::real(&patch.points);
    let criterion = Criterion::Flatness { pixels: 1 << 15 };
    let state = State { criterion, min: Level::MIN, max: Level::MAX };
    let worst = |termination| {
        let mut account = Account::default();
        let case = tessellate(&patch, &truth, &view, &state, termination).expect("w is 1");
        case.add(&mut account);
        let most = |ratios: &Ratios| ratios.0.iter().fold(0.0, |a: f64, b| a.max(*b)) / 2.0;
        assert!(!case.cut);
        (case.triangles.len(), [&account.edges, &account.grid, &account.strips].map(most))
    };
    let (two, [edges, _, error]) = worst(Termination::EightCurves);
    let (bounded, [_, grid, strips]) = worst(Termination::Bounded);
    println!(
        "a twist of 200 px: eight_curves {two} triangles, {error:.3} px; bounded {bounded}, grid \
         {grid:.3} px, strips {strips:.3} px"
    );
    // In the middle of the diagonal 200 (0.5 * 0.5), or 200 (0.5 - 0.25).
    assert_eq!(two, 2);
    assert!((error - 50.0).abs() < 0.01 && edges < 0.01, "{error} px, {edges} px");
    // The edges stay what they are: between their one segment and the first of fifteen rows are
    // 200 px / 16 of twist, of which a quarter shows.
    assert!(bounded > 400 && grid <= 0.5 * (1.0 + ALLOWANCE), "{bounded}: {grid} px");
    assert!(strips <= 200.0 / 16.0 / 4.0, "{strips} px");
}
