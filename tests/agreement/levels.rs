//! Level against its closed formulas: the block's roundings are bounded in pixels, and what they
//! become in a level is found by putting the bounds through the formulas.

use super::ledger::Ledger;
use super::table::{At, Quantity as Q};
use rtl_model::level::{self, Criterion, State};
use rtl_model::patch::{EDGES, Levels, Patch, View};
use tessim::golden::level::{self as golden, Bends, Pixel};

/// How much too long the block takes a second or mixed difference, in 2^-16 px: 2 sqrt(2) for
/// four halves of rounding in x and y, 1 for the root rounded up, 3 that it adds for safety.
const PIXELS_MOVED: f64 = 6.83;

/// The same for a control polygon's three segments: sqrt(2) each for the ends, 1 for the root.
pub(crate) const LENGTH_MOVED: f64 = 3.0 * 2.42;

/// Levels in ulps.
const ONE: f64 = 65536.0;

pub(crate) fn level(ledger: &mut Ledger, patch: &Patch, view: &View, state: &State) -> Levels {
    let (got, events) = level::accept(patch, view, state);
    let pixels = golden::project(&patch.points, view);
    let near = EDGES.iter().filter(|edge| edge.iter().any(|&k| pixels[k].is_none())).count();
    let range = [state.min, state.max].map(|level| f64::from(level.fx16()) / ONE);
    let case = Case { got, pixels, range };
    match state.criterion {
        Criterion::Fixed { level } => {
            let want = level.clamp(state.min, state.max);
            ledger.equal(Q::LevelFixed, got, Levels { edges: [want; 4], interior: [want; 2] });
        }
        Criterion::Flatness { pixels } => {
            ledger.equal(Q::LevelNear, events.near as usize, near);
            case.flatness(ledger, f64::from(pixels));
        }
        Criterion::EdgeLength { pixels } => {
            ledger.equal(Q::LevelNear, events.near as usize, near);
            case.edge_length(ledger, f64::from(pixels));
        }
    }
    got
}

struct Case {
    got: Levels,
    pixels: [Pixel; 16],
    range: [f64; 2],
}

impl Case {
    fn granted(&self, asked: Option<f64>) -> f64 {
        asked.map_or(self.range[1], |level| level.clamp(self.range[0], self.range[1]))
    }

    /// An interior's level: never below those of the two edges along it.
    fn inside(&self, asked: Option<f64>, [a, b]: [f64; 2]) -> f64 {
        self.granted(asked).max(a).max(b)
    }

    /// `ulps`: of 2^-16 px.
    fn flatness(&self, ledger: &mut Ledger, ulps: f64) {
        let d = ulps / ONE;
        let asked = golden::asked(&self.pixels, golden::Criterion::Flatness(d), self.range);
        let longer = |n: f64| (n * n + 0.75 * PIXELS_MOVED / ulps).sqrt();
        let most = asked.edges.map(|edge| edge.map(|n| longer(n) + 1.0 / ONE));
        for ((got, asked), most) in self.got.edges.iter().zip(asked.edges).zip(most) {
            let got = f64::from(got.fx16());
            let want = self.granted(asked) * ONE;
            let spread = self.granted(most) * ONE - want;
            ledger.error(Q::LevelFlatEdge, &spread_of(spread), (got - want).abs());
            // f64 is sure of a level to 2^-40.
            ledger.equal(Q::LevelFlatEdgeShort, got < want - 1e-4, false);
        }
        let got = self.got.interior.map(|level| f64::from(level.fx16()) / ONE);
        let Some(bends) = golden::bends(&self.pixels) else {
            ledger.error(Q::LevelFlatInterior, &At::default(), greatest_off(got, self.range[1]));
            return;
        };
        let moved = |b: f64| b + PIXELS_MOVED / ONE;
        let longest = Bends { uu: moved(bends.uu), uv: moved(bends.uv), vv: moved(bends.vv) };
        let low = golden::start(asked.edges, bends, d, self.range);
        let high = golden::start(most, longest, d, self.range).map(|level| level + 1.0 / ONE);
        for axis in 0..2 {
            let across = 1 - axis;
            let edges = |levels: [Option<f64>; 4]| {
                let [a, b] = [[0, 2], [1, 3]][axis];
                [self.granted(levels[a]), self.granted(levels[b])]
            };
            // More along the axis itself asks for more, more across it for less.
            let mix = |own: [f64; 2], other: [f64; 2]| {
                let mut start = own;
                start[across] = other[across];
                start
            };
            let level = |bends, start, edges| {
                self.inside(Some(golden::surface(bends, start, d)[axis]), edges) * ONE
            };
            let want = level(bends, low, edges(asked.edges));
            let above = level(longest, mix(high, low), edges(most)) - want;
            let below = want - level(bends, mix(low, high), edges(asked.edges));
            let at = spread_of(above.max(below));
            ledger.error(Q::LevelFlatInterior, &at, (got[axis] * ONE - want).abs());
        }
        if got.iter().all(|&level| level < self.range[1]) {
            let share = golden::deviation(bends, got) / d;
            ledger.error(Q::LevelDeviation, &At::default(), share);
        }
    }

    fn edge_length(&self, ledger: &mut Ledger, ulps: f64) {
        let d = ulps / ONE;
        let asked = golden::asked(&self.pixels, golden::Criterion::EdgeLength(d), self.range);
        let mut compare = |got: rtl_model::patch::Level, want: f64, asked: Option<f64>| {
            let spread = if asked.is_some() { LENGTH_MOVED / ulps * ONE } else { 0.0 };
            let error = (f64::from(got.fx16()) - want * ONE).abs();
            ledger.error(Q::LevelLength, &spread_of(spread), error);
        };
        let edges = asked.edges.map(|edge| self.granted(edge));
        for ((got, want), asked) in self.got.edges.iter().zip(edges).zip(asked.edges) {
            compare(*got, want, asked);
        }
        for (axis, along) in [[edges[0], edges[2]], [edges[1], edges[3]]].into_iter().enumerate() {
            let want = self.inside(asked.interior[axis], along);
            compare(self.got.interior[axis], want, asked.interior[axis]);
        }
    }
}

fn spread_of(spread: f64) -> At {
    At { spread, ..At::default() }
}

fn greatest_off(got: [f64; 2], want: f64) -> f64 {
    got.map(|level| (level - want).abs() * ONE).into_iter().fold(0.0, f64::max)
}
