//! Levels of resolution against their quotients; and what they promise of edges.

use super::ledger::Ledger;
use super::levels::LENGTH_MOVED;
use super::random::{Kind, Random, patch};
use super::samples;
use super::table::Quantity as Q;
use rtl_model::esc::resolution::{Policy, Resolution, accept};
use rtl_model::esc::{LEVEL_MAX, Levels};
use rtl_model::level::{self, Criterion, State};
use rtl_model::patch::{EDGES, Patch, View};
use tessim::golden::esc::resolution as golden;
use tessim::golden::level as projected;

/// Levels and pixels in ulps.
const ONE: f64 = 65536.0;

/// All policies on one patch. `part` of its own w, and of the viewport's larger side, have full
/// detail.
pub(crate) fn compare(
    ledger: &mut Ledger,
    (patch, view, state): (&Patch, &View, &State),
    level_max: u8,
    part: [f64; 2],
) {
    let at = At { patch, view, state, level_max };
    at.distance(ledger, part[0]);
    at.screen_size(ledger, part[1]);
    at.criterion(ledger);
}

/// All policies, on a patch and settings of any kind.
pub(crate) fn random(ledger: &mut Ledger, random: &mut Random, kind: Kind) {
    let width = random.integer(8, 48);
    let view = samples::view(random, width);
    let patch = patch(random, kind, view.position.max());
    let state = samples::state(random);
    let level_max = random.integer(0, LEVEL_MAX.into()) as u8;
    let part = [random.octaves(1.0 / 64.0, 2.0), random.octaves(1.0 / 64.0, 2.0)];
    compare(ledger, (&patch, &view, &state), level_max, part);
}

struct At<'a> {
    patch: &'a Patch,
    view: &'a View,
    state: &'a State,
    level_max: u8,
}

impl At<'_> {
    fn got(&self, policy: Policy) -> (Levels, level::Events) {
        let resolution = Resolution { policy, level_max: self.level_max };
        accept(self.patch, self.view, self.state, &resolution)
    }

    /// Segments at full detail.
    fn most(&self) -> f64 {
        f64::from(self.level_max) + 1.0
    }

    fn distance(&self, ledger: &mut Ledger, part: f64) {
        let full = full(self.patch, part);
        let (got, events) = self.got(Policy::Distance { full });
        let want = golden::distance(&self.patch.points, self.view, full as f64, self.most());
        let near = want.edges.iter().filter(|edge| edge.is_none()).count();
        let got = ((got.edges, got.interior), events.near as usize, events.clamped);
        ledger.equal(Q::EscDistance, got, (want.levels(self.most()), near, 0));
    }

    fn screen_size(&self, ledger: &mut Ledger, part: f64) {
        let pixels = pixels(self.view, part);
        let (got, events) = self.got(Policy::ScreenSize { pixels });
        let want = |longer: f64| {
            let points = projected::project(&self.patch.points, self.view);
            let full = f64::from(pixels) / ONE;
            let asked = golden::screen_size(&points, full, self.most(), longer / ONE);
            let near = asked.edges.iter().filter(|edge| edge.is_none()).count();
            (asked.levels(self.most()), near, asked.above(self.most()))
        };
        let got = ((got.edges, got.interior), events.near as usize, events.clamped);
        // Its lengths are rounded up, but those that are exact, as 0 is.
        let (low, high) = (want(0.0), want(LENGTH_MOVED));
        if low == high {
            ledger.equal(Q::EscScreen, got, low);
        } else {
            ledger.unsized_edges += 1;
        }
    }

    fn criterion(&self, ledger: &mut Ledger) {
        let (got, events) = self.got(Policy::Criterion);
        // The level block's levels are compared elsewhere, and taken as they are.
        let (levels, seen) = level::accept(self.patch, self.view, self.state);
        let real = |level: rtl_model::patch::Level| f64::from(level.fx16()) / ONE;
        let want = golden::thirds(levels.edges.map(real), levels.interior.map(real));
        let got = ((got.edges, got.interior), events.near, events.overflows);
        ledger.equal(Q::EscCriterion, got, (want.levels(self.most()), seen.near, seen.overflows));
        if let Some(clamped) = self.clamped() {
            ledger.equal(Q::EscClamped, events.clamped, clamped);
        }
    }

    /// How many levels are clamped, where that is known.
    fn clamped(&self) -> Option<u32> {
        let [min, max] = [self.state.min, self.state.max].map(|level| f64::from(level.fx16()));
        let most = 3.0 * self.most() * ONE;
        let asked = match self.state.criterion {
            _ if min > most => return Some(6),
            Criterion::Flatness { .. } => return None,
            Criterion::Fixed { level } => {
                return Some(if f64::from(level.fx16()) > max.min(most) { 6 } else { 0 });
            }
            Criterion::EdgeLength { pixels } => move |longer: f64| {
                let points = projected::project(&self.patch.points, self.view);
                golden::screen_size(&points, f64::from(pixels) / ONE, ONE, longer / ONE)
            },
        };
        let [low, high] = [asked(0.0), asked(LENGTH_MOVED)].map(|all| all.above(max.min(most)));
        (low == high).then_some(low)
    }
}

/// A part of the w of one of the patch's points, raw.
fn full(patch: &Patch, part: f64) -> i64 {
    (patch.points[6][3].abs() as f64 * part) as i64
}

/// A part of the viewport's larger side, UQ16.16.
fn pixels(view: &View, part: f64) -> u32 {
    let [width, height] = view.viewport;
    (f64::from(width.max(height)) * part * ONE).max(1.0) as u32
}

/// A patch, where it is seen and how its levels are chosen.
fn sample(random: &mut Random, k: usize) -> (Patch, View, State, Resolution) {
    let width = random.integer(8, 48);
    let view = samples::view(random, width);
    let patch = patch(random, Kind::ALL[k % 7], view.position.max());
    let policy = match k % 4 {
        0 => Policy::Criterion,
        1 => Policy::Distance { full: full(&patch, random.octaves(1.0 / 64.0, 1.0)) },
        2 => Policy::ScreenSize { pixels: pixels(&view, random.octaves(1.0 / 64.0, 2.0)) },
        _ => Policy::Fixed(random.integer(0, 15) as u8),
    };
    let level_max = random.integer(0, LEVEL_MAX.into()) as u8;
    (patch, view, samples::state(random), Resolution { policy, level_max })
}

/// Where the eight orientations of a patch have each of its points.
fn orientations() -> [[usize; 16]; 8] {
    std::array::from_fn(|turn| {
        std::array::from_fn(|k| {
            let (i, j) = (k / 4, k % 4);
            let (i, j) = if turn & 1 == 1 { (j, i) } else { (i, j) };
            let flip = |at: usize, bit: usize| if turn >> bit & 1 == 1 { 3 - at } else { at };
            4 * flip(i, 1) + flip(j, 2)
        })
    })
}

#[test]
fn levels_turn_with_the_patch_and_are_never_above_the_pattern_s() {
    let mut random = Random::new(0xe5c_0001);
    let (mut compared, mut between) = (0, 0);
    for k in 0..8_400 {
        let (patch, view, state, resolution) = sample(&mut random, k);
        let (levels, events) = accept(&patch, &view, &state, &resolution);
        assert!(levels.interior <= resolution.level_max, "{levels:?}");
        assert!(levels.edges.iter().all(|&edge| edge <= levels.interior), "{levels:?}");
        for places in orientations() {
            let turned = Patch { points: places.map(|k| patch.points[k]), ..patch };
            let (got, also) = accept(&turned, &view, &state, &resolution);
            assert_eq!((got.interior, also), (levels.interior, events), "{places:?}");
            for (edge, level) in EDGES.iter().zip(got.edges) {
                let mut source = edge.map(|k| places[k]);
                source.sort_unstable();
                let old = EDGES.iter().position(|edge| *edge == source).unwrap();
                assert_eq!(level, levels.edges[old], "{places:?} {resolution:?}");
                compared += 1;
                between += u32::from((1..resolution.level_max).contains(&level));
            }
        }
    }
    println!("compared {compared} levels of edges, {between} between the least and the greatest");
    assert!(compared == 8_400 * 32 && between > compared / 8);
}

#[test]
fn the_level_of_an_edge_is_a_function_of_its_own_points() {
    let mut random = Random::new(0xe5c_0002);
    let (mut compared, mut between, mut apart) = (0, 0, 0);
    for k in 0..8_400 {
        let (one, view, state, resolution) = sample(&mut random, k);
        let mut two = patch(&mut random, Kind::ALL[k / 7 % 7], view.position.max());
        let [a, b] = [(); 2].map(|()| random.integer(0, 3) as usize);
        let back = random.bits() & 1 == 1;
        for (place, from) in EDGES[a].into_iter().enumerate() {
            two.points[EDGES[b][if back { 3 - place } else { place }]] = one.points[from];
        }
        let [one, two] = [one, two].map(|p| accept(&p, &view, &state, &resolution).0);
        assert_eq!(one.edges[a], two.edges[b], "{resolution:?}, {a} and {b}, back: {back}");
        compared += 1;
        between += u32::from((1..resolution.level_max).contains(&one.edges[a]));
        apart += u32::from(one.interior != two.interior);
    }
    println!("compared {compared} pairs, {between} of levels between, {apart} of two patterns");
    assert!(compared == 8_400 && between > compared / 8 && apart > compared / 8);
}
