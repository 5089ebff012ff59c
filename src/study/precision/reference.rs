//! Reference: the commands of a trace in, what f64 makes of them out, once for all formats: the
//! true surfaces, whether a patch is to be seen, which lists its criterion asks for, and which
//! edges patches share.
//!
//! Decisions are those of the golden models on control points in f64, rounded to positions of 48
//! bits: 24 more than the shader's f32 has, and all that the golden models of quantised points can
//! be asked about. Where those of midpoint subdivision are not sure, there is no list to compare
//! with.

use super::seam::{self, Seam};
use crate::config::{Config, Termination, Unit, WIDTH_MAX};
use crate::error::Result;
use crate::golden::level::{self, Piece, Verdict};
use crate::golden::{Real, backface, clip, place};
use crate::study::walk::{Drawn, Walk};
use crate::trace::command::Command;
use crate::unit::state;
use rtl_model::level::{Criterion, State};
use rtl_model::patch::{DEPTH_MAX, Dyadic, EDGES, Level, Levels, Lists, Patch, View};

/// What stands for one list, so that two can be compared: segments, or a dyadic list's bits.
pub(super) type Key = u128;

/// Of the edges v0, u1, v1, u0 and of the interior along u and v.
pub(super) type Keys = [Option<Key>; 6];

/// A patch as f64 has it.
#[derive(Clone, Debug)]
pub(super) struct Truth {
    /// Control points in clip space.
    pub(super) points: [Real; 16],
    /// Whether it is neither clipped nor culled.
    pub(super) kept: bool,
    /// Its lists; `None` where f64 cannot tell.
    pub(super) lists: Keys,
    /// The tessellation state of its draw, by which edges agree.
    pub(super) state: State,
}

/// A frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub(super) patches: Vec<Truth>,
    pub(super) seams: Vec<Seam>,
}

/// All frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Reference {
    pub(super) frames: Vec<Scene>,
}

impl Reference {
    /// Of the commands of a trace.
    pub(super) fn of(commands: &[Command], base: &Config) -> Result<Self> {
        let mut config = base.clone();
        (config.position.width, config.evaluate.guard) = (WIDTH_MAX, None);
        let mut reference = Self::default();
        let mut walk = Walk::new(&config);
        for command in commands {
            if let Command::Frame(_) = command {
                reference.frames.push(Scene::default());
            }
            walk.command(command, &mut |_, drawn| {
                let scene = reference.frames.last_mut().expect("a draw is in a frame");
                scene.patches.push(truth(&drawn, &config));
            })?;
        }
        for scene in &mut reference.frames {
            let patches: Vec<_> = scene.patches.iter().map(|t| (&t.points, &t.state)).collect();
            scene.seams = seam::seams(&patches);
        }
        Ok(reference)
    }

    /// Patches of all frames.
    pub(super) fn patches(&self) -> usize {
        self.frames.iter().map(|scene| scene.patches.len()).sum()
    }
}

fn truth(drawn: &Drawn, config: &Config) -> Truth {
    let (view, points) = (&drawn.frame.view, drawn.exact);
    let state = state::under(&drawn.state, config);
    let patch = quantised(drawn);
    let clipped = config.clip.enabled && clip::outside_real(&points, view.depth);
    let culled = || backface::culled(&patch, view, config.backface.method) == Some(true);
    let kept = !clipped && !culled();
    let lists = if kept { lists(&patch, view, &state, config) } else { [None; 6] };
    Truth { points, kept, lists, state }
}

/// The patch in the widest positions.
fn quantised(drawn: &Drawn) -> Patch {
    let position = drawn.frame.view.position;
    let (scale, max) = (f64::from(position.fraction).exp2(), position.max() as f64);
    let scaled = drawn.exact.map(|p| p.map(|c| (c * scale).round_ties_even()));
    let saturated = scaled.iter().flatten().any(|c| c.abs() > max);
    let points = scaled.map(|p| p.map(|c| c.clamp(-max, max) as i64));
    Patch { points, saturated, ..drawn.patch }
}

fn lists(patch: &Patch, view: &View, state: &State, config: &Config) -> Keys {
    let divides = config.unit == Unit::Sfarti;
    match state.criterion {
        Criterion::Flatness { pixels }
            if divides && config.level.termination == Termination::EightCurves =>
        {
            eight_curves(patch, view, state, f64::from(pixels) / 65536.0)
        }
        _ => {
            let levels = levels(patch, view, state);
            if divides { uniform(&levels) } else { segments(&place::place(&levels, 32)) }
        }
    }
}

/// The levels that the criterion asks for, up to the next 2^-16: as far as f64 is sure.
fn levels(patch: &Patch, view: &View, state: &State) -> Levels {
    let real = |level: Level| f64::from(level.fx16()) / 65536.0;
    let range = [real(state.min), real(state.max)];
    let criterion = match state.criterion {
        Criterion::Flatness { pixels } => level::Criterion::Flatness(f64::from(pixels) / 65536.0),
        Criterion::EdgeLength { pixels } => {
            level::Criterion::EdgeLength(f64::from(pixels) / 65536.0)
        }
        Criterion::Fixed { level } => level::Criterion::Fixed(real(level)),
    };
    let asked = level::asked(&level::project(&patch.points, view), criterion, range);
    let granted = |asked: Option<f64>| {
        asked.map_or(state.max, |level| {
            let fx16 = (level.clamp(range[0], range[1]) * 65536.0 - 1e-4).ceil();
            Level::clamped(fx16 as u64)
        })
    };
    let [v0, u1, v1, u0] = asked.edges.map(granted);
    let [u, v] = asked.interior.map(granted);
    let interior = match state.criterion {
        Criterion::Flatness { .. } => [u.max(v0).max(v1), v.max(u0).max(u1)],
        _ => [u, v],
    };
    Levels { edges: [v0, u1, v1, u0], interior }
}

/// Segments of fractional lists.
pub(super) fn segments(placed: &place::Placed) -> Keys {
    let [a, b, c, d] = placed.edges.each_ref().map(|edge| edge.len() - 1);
    let (u, v) = (placed.columns.len() + 1, placed.rows.len() + 1);
    [a, b, c, d, u, v].map(|segments| Some(segments as Key))
}

/// The bits of dyadic lists.
pub(super) fn bits(lists: &Lists) -> Keys {
    let [a, b, c, d] = *lists.edges();
    [a, b, c, d, lists.u(), lists.v()].map(|list| Some(list.mask()))
}

/// The edges' lists of as many equal segments as their levels, rounded up to powers of two. What
/// the interior has besides is not compared.
fn uniform(levels: &Levels) -> Keys {
    let list = |level: Level| Some(Dyadic::uniform(depth(level)).mask());
    let [a, b, c, d] = levels.edges.map(list);
    [a, b, c, d, None, None]
}

/// The logarithm of a level to base 2, rounded up.
fn depth(level: Level) -> u32 {
    (0..=DEPTH_MAX).find(|&depth| level.fx16() <= 65536 << depth).unwrap_or(DEPTH_MAX)
}

/// The lists of the edges, and the unions of the inner rows and columns with the edges along them.
fn eight_curves(patch: &Patch, view: &View, state: &State, d: f64) -> Keys {
    let depths = [state.min, state.max].map(depth);
    let list = |line: [usize; 4]| {
        let curve = line.map(|k| patch.points[k]);
        let mut list = Dyadic::NONE;
        let whole = Piece { curve: &curve, first: 0, depth: 0 };
        divide(whole, (view, depths, d), &mut list).then_some(list)
    };
    let edges = EDGES.map(list);
    let rows = [[4, 5, 6, 7], [8, 9, 10, 11]].map(list);
    let columns = [[1, 5, 9, 13], [2, 6, 10, 14]].map(list);
    let union = |lists: [Option<Dyadic>; 4]| {
        let all = lists.into_iter().try_fold(Dyadic::NONE, |all, list| Some(all.union(list?)));
        all.map(Dyadic::mask)
    };
    let [v0, u1, v1, u0] = edges;
    let [a, b, c, d] = edges.map(|list| list.map(Dyadic::mask));
    let along_u = union([rows[0], rows[1], v0, v1]);
    let along_v = union([columns[0], columns[1], u0, u1]);
    [a, b, c, d, along_u, along_v]
}

/// Divides a piece as often as it needs. Returns whether f64 was sure of all of it.
fn divide(piece: Piece<'_>, at: (&View, [u32; 2], f64), list: &mut Dyadic) -> bool {
    let (view, [least, most], d) = at;
    if piece.depth == most {
        return true;
    }
    if piece.depth >= least {
        match level::verdict(piece, view, d) {
            Verdict::Flat => return true,
            Verdict::Unsure => return false,
            Verdict::Bent | Verdict::NoProjection => {}
        }
    }
    let (middle, depth) = (piece.first + (64 >> piece.depth), piece.depth + 1);
    list.insert(middle);
    let halves = [piece.first, middle].map(|first| Piece { first, depth, ..piece });
    halves.into_iter().all(|half| divide(half, at, list))
}
