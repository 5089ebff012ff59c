//! Midpoint subdivision against its definition: decision by decision, wherever rounding cannot be
//! what decides.

use super::blocks;
use super::ledger::Ledger;
use super::table::Quantity as Q;
use rtl_model::emit;
use rtl_model::evaluate::Settings;
use rtl_model::level::{self, Criterion, State, Subdivide, Subdivision, Termination};
use rtl_model::patch::{Dyadic, EDGES, Level, Lists, Patch, View};
use rtl_model::place::DyadicPlacement;
use rtl_model::stitch::Stitch;
use tessim::golden;
use tessim::golden::level::{Piece, Verdict, verdict};

/// Rows 1 and 2 of the net, columns 1 and 2.
const INNER: [[usize; 4]; 4] = [[4, 5, 6, 7], [8, 9, 10, 11], [1, 5, 9, 13], [2, 6, 10, 14]];

/// The lists of a patch, compared.
pub(crate) fn level(
    ledger: &mut Ledger,
    patch: &Patch,
    view: &View,
    state: &State,
    termination: Termination,
) -> Lists {
    let (lists, events) = level::subdivide(patch, view, state, termination);
    if let (Criterion::Flatness { pixels }, Termination::EightCurves) =
        (state.criterion, termination)
    {
        let points = golden::level::project(&patch.points, view);
        let near = EDGES.iter().filter(|edge| edge.iter().any(|&k| points[k].is_none())).count();
        ledger.equal(Q::LevelNear, events.near as usize, near);
        let depths = [state.min, state.max].map(depth);
        let rule = Subdivide { view, pixels, depths };
        let curves = [EDGES, INNER].concat();
        let curves: Vec<Subdivision> = curves
            .iter()
            .map(|line| Tree::compare(ledger, &rule, &line.map(|k| patch.points[k])))
            .collect();
        let union =
            |of: [usize; 4]| Dyadic::of(of.iter().fold(0, |m, &k| m | curves[k].list.mask()));
        let edges: Vec<Dyadic> = curves[..4].iter().map(|curve| curve.list).collect();
        ledger.equal(Q::LevelLists, &lists.edges()[..], &edges[..]);
        // v0, v1 and the rows run along u.
        ledger.equal(
            Q::LevelLists,
            &[lists.u(), lists.v()][..],
            &[[0, 2, 4, 5], [1, 3, 6, 7]].map(union)[..],
        );
        ledger.equal(Q::LevelSplits, events.splits, curves.iter().map(|c| c.splits).sum());
        let cut = |of: &[usize]| u32::from(of.iter().any(|&k| curves[k].clamped));
        let cut = [&[0][..], &[1], &[2], &[3], &[4, 5], &[6, 7]].map(cut).iter().sum();
        ledger.equal(Q::LevelSplits, events.clamped, cut);
    } else {
        let (levels, want) = level::accept(patch, view, state);
        let segments = |list: Dyadic| list.segments() as f64;
        let power = |level: Level| f64::from(level.fx16()).log2().ceil().exp2() / 65536.0;
        for (list, level) in lists.edges().iter().zip(levels.edges) {
            ledger.equal(Q::LevelPowers, segments(*list), power(level));
            ledger.equal(Q::LevelPowers, list.mask(), uniform(segments(*list)));
        }
        let [u, v] = levels.interior.map(power);
        // Inner points are evaluated along both directions or not at all.
        let [v0, u1, v1, u0] = lists.edges().map(segments);
        let least = if u > v0.max(v1) || v > u0.max(u1) { 2.0 } else { 1.0 };
        ledger.equal(Q::LevelPowers, segments(lists.u()), u.max(least));
        ledger.equal(Q::LevelPowers, segments(lists.v()), v.max(least));
        ledger.equal(Q::LevelSplits, (events.splits, events.clamped), (0, want.clamped));
    }
    lists
}

/// The list of so many equal segments.
fn uniform(segments: f64) -> u128 {
    let step = (128.0 / segments) as usize;
    (step..128).step_by(step).fold(0, |mask, k| mask | 1 << k)
}

/// How often a whole is halved until there are as many parts as the level says.
fn depth(level: Level) -> u32 {
    (f64::from(level.fx16()) / 65536.0).log2().ceil() as u32
}

/// The tree of decisions that the block took.
struct Tree<'a> {
    rule: &'a Subdivide<'a>,
    curve: &'a [[i64; 4]; 4],
    got: Subdivision,
    /// Whether a piece of the greatest depth is bent; `None`: rounding may decide.
    bent: Option<bool>,
}

impl<'a> Tree<'a> {
    fn compare(
        ledger: &mut Ledger,
        rule: &'a Subdivide<'_>,
        curve: &'a [[i64; 4]; 4],
    ) -> Subdivision {
        let got = rule.accept(curve);
        let mut tree = Tree { rule, curve, got, bent: Some(false) };
        let entries = tree.walk(ledger, 0, 0);
        ledger.equal(Q::LevelSplits, got.splits, entries);
        ledger.equal(Q::LevelSplits, got.list.inner() as u32, entries);
        if let Some(bent) = tree.bent {
            ledger.equal(Q::LevelCut, got.clamped, bent);
        }
        got
    }

    /// Compares the decisions on a piece and on its parts. Returns how often it was divided.
    fn walk(&mut self, ledger: &mut Ledger, first: u32, depth: u32) -> u32 {
        let [least, most] = self.rule.depths;
        let d = f64::from(self.rule.pixels) / 65536.0;
        let verdict = verdict(Piece { curve: self.curve, first, depth }, self.rule.view, d);
        let half = 64 >> depth;
        if depth == most {
            self.bent = match (self.bent, verdict) {
                (Some(true), _) | (_, Verdict::Bent) => Some(true),
                (bent, Verdict::Flat | Verdict::NoProjection) => bent,
                (_, Verdict::Unsure) => None,
            };
            return 0;
        }
        let divided = self.got.list.contains(first + half);
        if depth < least {
            ledger.equal(Q::LevelDivided, divided, true);
        } else if verdict != Verdict::Unsure {
            ledger.equal(Q::LevelDivided, divided, verdict != Verdict::Flat);
        }
        ledger.undecided += u64::from(depth >= least && verdict == Verdict::Unsure);
        if !divided {
            return 0;
        }
        1 + self.walk(ledger, first, depth + 1) + self.walk(ledger, first + half, depth + 1)
    }
}

/// Place, evaluate, stitch and emit on dyadic lists.
pub(crate) fn pipeline(
    ledger: &mut Ledger,
    patch: &Patch,
    view: &View,
    lists: &Lists,
    settings: Settings,
    emit: emit::Settings,
) {
    let mut placement = DyadicPlacement::default();
    placement.set_lists(lists);
    let placed = golden::place::dyadic(lists);
    let parameters = |entries: &[golden::place::Entry]| -> Vec<f64> {
        entries.iter().map(|entry| entry.parameter.real() * 65536.0).collect()
    };
    for (list, entries) in placement.edges.iter().zip(&placed.edges) {
        ledger.equal(Q::PlaceDyadic, blocks::reals(list), parameters(entries));
    }
    if !placed.columns.is_empty() {
        for (list, entries) in [(&placement.u, &placed.columns), (&placement.v, &placed.rows)] {
            let all = blocks::reals(list);
            ledger.equal(Q::PlaceDyadic, &all[1..all.len() - 1], &parameters(entries)[..]);
        }
    }
    let triangles = Stitch::default().accept(*lists).to_vec();
    let numbers = triangles.iter().map(|t| t.map(usize::from)).collect();
    let got = golden::stitch::canonical(numbers);
    ledger.equal(Q::StitchZipped, got, golden::stitch::zipped(&placed));
    let vertices = blocks::evaluate(ledger, patch, settings, (&placement, &placed));
    blocks::degenerate(ledger, &placement, &vertices, &triangles);
    blocks::emit(ledger, &vertices, view, emit);
}
