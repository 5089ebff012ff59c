//! Back-face removal: how much of what could be dropped each test drops, what it drops that it must
//! not, and at what price.
//!
//! In come a number of views of each of Newell's models and a number of random patches; out come
//! rows, one a model, place of the viewer and method ([`Method::ALL`] without `off`). Each patch is
//! transformed in f32 and quantised as in a run with the default configuration. It *shows its
//! front* if any of 65 x 65 samples of det[S, Su, Sv] does ([`faces_viewer`]), on the quantised
//! surface, and apart from that on the one that the f32 points span. A *false cull* is a patch that
//! was removed and shows its front; samples can miss some, so false culls are at least so many.
//!
//! Viewers stand outside the convex hull of every patch, where a closed hull cannot but show them a
//! facet, and then within: at the mean of the patch's own control points. Which way a viewer looks
//! plays no part in what he would see the front of; one who stands there and turns round sees it.
//! Without that second place the literal reading of the paper would only seem useless, not wrong.

mod scene;
mod table;

use crate::config::{BackfaceMethod as Method, Config};
use crate::error::Result;
use crate::golden::backface::faces_viewer;
use crate::shader::control_point;
use crate::study::walk::Port;
use crate::unit::FrameState;
use crate::unit::arithmetic;
use glam::Mat4;
use rayon::prelude::*;
use rtl_model::backface::{Verdict, accept};
use rtl_model::counter::standard::Ops;
use rtl_model::number::dispatch;
use rtl_model::patch::{Patch, View};
use scene::Seen;

pub use scene::{Place, Source};
pub use table::{CSV_HEADER, csv, text};

/// The tests that are compared: those that test.
pub const METHODS: [Method; 4] =
    [Method::HullLiteral, Method::NetFacets, Method::NormalCone, Method::TangentPlane];

/// How much is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Views of each model.
    pub views: usize,
    /// Random patches, each with a view of its own.
    pub random: usize,
}

/// What a method made of the patches of a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The patches.
    pub source: Source,
    /// Where the viewers stood.
    pub place: Place,
    /// The test.
    pub method: Method,
    /// What was counted.
    pub score: Score,
    /// Operations for all facets of all patches.
    pub ops: Ops,
    /// Operations where a test stops at the first facet that keeps its patch.
    pub ops_early: Ops,
}

/// Counts of patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Score {
    /// Tested.
    pub tested: u64,
    /// Of these, no sample of the quantised surface shows its front.
    pub away: u64,
    /// Of these, removed.
    pub away_culled: u64,
    /// Removed.
    pub culled: u64,
    /// Removed, and the quantised surface shows its front.
    pub false_quantised: u64,
    /// Removed, and the f32 surface shows its front.
    pub false_f32: u64,
    /// Facets looked at until the first that keeps the patch.
    pub facets: u64,
}

impl Score {
    fn add(&mut self, culled: bool, facets: u32, seen: Fronts) {
        self.tested += 1;
        self.away += u64::from(!seen.quantised);
        self.away_culled += u64::from(culled && !seen.quantised);
        self.culled += u64::from(culled);
        self.false_quantised += u64::from(culled && seen.quantised);
        self.false_f32 += u64::from(culled && seen.single);
        self.facets += u64::from(facets);
    }

    fn merge(&mut self, other: &Self) {
        self.tested += other.tested;
        self.away += other.away;
        self.away_culled += other.away_culled;
        self.culled += other.culled;
        self.false_quantised += other.false_quantised;
        self.false_f32 += other.false_f32;
        self.facets += other.facets;
    }
}

/// Carries out the study in the current rayon pool.
///
/// # Errors
/// None that can be expected: those of a frame without a far plane.
pub fn run(options: Options) -> Result<Vec<Row>> {
    let config = Config::default();
    let mut rows = Vec::new();
    for place in Place::ALL {
        for source in Source::ALL {
            let cases = source.cases(place, options);
            let tallies = cases.into_par_iter().map(|case| -> Result<Tally> {
                let mut tally = Tally::new();
                source.see(place, case, &mut |seen| tally.add(&seen, &config))?;
                Ok(tally)
            });
            let tally = tallies.try_reduce(Tally::new, |a, b| Ok(a.merged(&b)))?;
            rows.extend(tally.rows(source, place, &config));
        }
    }
    Ok(rows)
}

/// Sums over some patches, and for each method how many of them had so many facets looked at.
struct Tally([(Score, Vec<u64>); METHODS.len()]);

impl Tally {
    fn new() -> Self {
        Self(METHODS.map(|method| (Score::default(), vec![0; method.facets() as usize + 1])))
    }

    fn add(&mut self, seen: &Seen<'_>, config: &Config) -> Result<()> {
        let frame = FrameState::new(seen.frame, config)?;
        let (patch, single) = quantised(seen, &frame, config);
        let mut fronts = None;
        for (method, (score, histogram)) in METHODS.into_iter().zip(&mut self.0) {
            let (verdict, facets) = accept(&patch, &frame.view, method);
            if verdict == Verdict::Untested {
                return Ok(()); // a point did not fit; so it is for every method
            }
            // One for all methods: it takes longer than any of them.
            let fronts = *fronts.get_or_insert_with(|| Fronts::of(&patch, &single, &frame.view));
            score.add(verdict == Verdict::Culled, facets, fronts);
            histogram[facets as usize] += 1;
        }
        Ok(())
    }

    fn merged(mut self, other: &Self) -> Self {
        for ((score, histogram), (more, and_more)) in self.0.iter_mut().zip(&other.0) {
            score.merge(more);
            histogram.iter_mut().zip(and_more).for_each(|(sum, n)| *sum += n);
        }
        self
    }

    fn rows(&self, source: Source, place: Place, config: &Config) -> Vec<Row> {
        let row = |(method, (score, histogram)): (Method, &(Score, Vec<u64>))| {
            let cost = |facets| arithmetic::backface::test(method, facets, config);
            let early = (0..).zip(histogram).filter(|(_, n)| **n > 0);
            Row {
                source,
                place,
                method,
                score: *score,
                ops: Ops::default().with(score.tested, cost(method.facets())),
                ops_early: early.fold(Ops::default(), |sum, (k, n)| sum.with(*n, cost(k))),
            }
        };
        METHODS.into_iter().zip(&self.0).map(row).collect()
    }
}

/// Whether a patch shows its front, on the two surfaces.
#[derive(Clone, Copy, Debug)]
struct Fronts {
    quantised: bool,
    single: bool,
}

impl Fronts {
    fn of(patch: &Patch, single: &[[f32; 4]; 16], view: &View) -> Self {
        let front = if patch.reversed { -view.facing } else { view.facing } as f64;
        let raw = patch.points.map(|[x, y, _, w]| [x as f64, y as f64, w as f64]);
        let exact = single.map(|[x, y, _, w]| [x.into(), y.into(), w.into()]);
        Self { quantised: faces_viewer(&raw, front), single: faces_viewer(&exact, front) }
    }
}

/// The patch behind the port, and its control points before it.
fn quantised(seen: &Seen<'_>, frame: &FrameState, config: &Config) -> (Patch, [[f32; 4]; 16]) {
    let matrix: &Mat4 = &frame.clip_from_world;
    let single = seen.points.map(|p| control_point::transform(matrix, p));
    let (rounding, overflow) = (config.position.rounding, config.position.overflow);
    let (points, saturated) = dispatch(rounding, overflow, Port(&single, frame.view.position));
    let patch = Patch { id: 0, points, saturated, cull: true, reversed: seen.reversed };
    (patch, single)
}

#[cfg(test)]
mod tests;
