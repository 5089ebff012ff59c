//! Evaluators: de Casteljau, forward differences and the power basis `[N][B][M]^T` by themselves,
//! at equal segments. The patches of a trace come in, out comes how far from the true surface each
//! evaluator puts their points, by bits of a position.
//!
//! Control points are those in f64, rounded once to the position format; what comes out is
//! projected in f64 and not snapped: so errors are those of control points and evaluator alone.
//! Segments are powers of two, whose parameters and reciprocals are exact in every evaluator.
//! Beside an evaluator's fewest guard bits stand more of them, with which all three come to the
//! error of the position format itself; the bits of the widest register say what that costs.

mod table;

use super::meter::PositionError;
use super::reference::Reference;
use crate::config::Config;
use crate::error::{Error, Result};
use crate::golden::{Real, emit, evaluate};
use crate::output::space;
use crate::study::walk::Walk;
use crate::trace::command::Command;
use rayon::prelude::*;
use rtl_model::esc::{NET_BITS, PowerBasis};
use rtl_model::evaluate::{Evaluate, Scheme, Settings};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Level, Levels, ONE, Patch, Vertex, View};
use rtl_model::place::Placement;

pub use table::{CSV_HEADER, csv, text};

/// Decibels that a bit is worth: 20 log10 2.
pub const BIT_DB: f64 = 6.020_599_913_279_624;

/// Parameters of the power basis have so many fraction bits: those of U1.16.
const PARAMETER_BITS: u32 = 16;

/// How points are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluator {
    /// De Casteljau's triangle.
    DeCasteljau,
    /// Forward differences in half-runs.
    Forward,
    /// The power basis by Horner's rule.
    PowerBasis,
}

impl Evaluator {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::DeCasteljau, Self::Forward, Self::PowerBasis];

    /// The name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DeCasteljau => "de_casteljau",
            Self::Forward => "forward",
            Self::PowerBasis => "nbm",
        }
    }

    /// Bits of the widest register, with so many of a position and so many guard bits: a position
    /// itself, D2 and D3, or a coefficient of the surface.
    #[must_use]
    pub const fn register(self, width: u32, guard: u32) -> u32 {
        match self {
            Self::DeCasteljau => width,
            Self::Forward => width + 6 + guard,
            Self::PowerBasis => width + NET_BITS + guard,
        }
    }

    /// The fewest guard bits that it has.
    #[must_use]
    pub const fn guard_min(self) -> u32 {
        match self {
            Self::Forward => 1,
            Self::DeCasteljau | Self::PowerBasis => 0,
        }
    }

    /// Whether guard bits change anything.
    #[must_use]
    pub const fn has_guard(self) -> bool {
        !matches!(self, Self::DeCasteljau)
    }
}

/// How much is looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Segments along each direction: powers of two from 4 to 128.
    pub segments: Vec<u32>,
    /// Bits of a position, 8..=40.
    pub width: Vec<u32>,
    /// Guard bits besides the fewest that an evaluator has.
    pub guard: Vec<u32>,
}

impl Default for Options {
    /// Half-runs of 4 to 64 steps; widths at which the slope shows.
    fn default() -> Self {
        Self { segments: vec![8, 16, 32, 64, 128], width: (10..=36).collect(), guard: vec![8, 16] }
    }
}

/// An evaluator in one format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Segments of a patch along each direction.
    pub segments: u32,
    /// Bits of a position.
    pub width: u32,
    /// Guard bits.
    pub guard: u32,
    /// How far its points are from the true surface, in pixels.
    pub error: PositionError,
    /// Points behind the eye, which are not measured.
    pub behind: u64,
}

impl Row {
    /// Bits of the widest register.
    #[must_use]
    pub const fn register(&self) -> u32 {
        self.evaluator.register(self.width, self.guard)
    }

    /// The RMS error in decibels of a pixel; `None` where there is no error.
    #[must_use]
    pub fn decibels(&self) -> Option<f64> {
        let rms = self.error.rms();
        (rms > 0.0).then(|| 20.0 * rms.log10())
    }
}

/// A patch that is to be seen, and its frame.
struct Seen {
    points: [Real; 16],
    view: View,
}

/// Places on the screen, patch by patch, row by row: `None` behind the eye.
struct Wanted {
    segments: u32,
    pixels: Vec<Vec<Option<[f64; 2]>>>,
}

impl Wanted {
    fn of(segments: u32, seen: &[Seen]) -> Self {
        let at = |k: u32| f64::from(k) / f64::from(segments);
        let pixels = seen.par_iter().map(|Seen { points, view }| {
            let all = (0..=segments).flat_map(|i| (0..=segments).map(move |j| (i, j)));
            let screen =
                |(i, j)| emit::screen(evaluate::surface(points, at(j), at(i)), view.viewport);
            all.map(screen).collect()
        });
        Self { segments, pixels: pixels.collect() }
    }

    /// The place of a vertex's parameters.
    fn index(&self, vertex: &Vertex) -> usize {
        let line = |t: u32| (u64::from(t) * u64::from(self.segments) / u64::from(ONE)) as usize;
        line(vertex.v) * (self.segments as usize + 1) + line(vertex.u)
    }
}

/// An evaluator, its segments, bits of a position and guard bits.
type Case<'a> = (Evaluator, &'a Wanted, u32, u32);

/// Patches that are looked at, at most; of more, as many at equal distances.
const PATCHES_MAX: usize = 64;

/// Carries out the comparison on the patches that f64 neither clips nor culls and that are wholly
/// before the near plane, in the current rayon pool.
///
/// # Errors
/// [`Error::Usage`] for segments and widths outside what [`Options`] says, and for a trace that
/// shows no patch; those of the trace.
pub fn run(
    commands: &[Command],
    base: &Config,
    options: &Options,
    each: &(dyn Fn() + Sync),
) -> Result<Vec<Row>> {
    check(options)?;
    let seen = patches(commands, base)?;
    if seen.is_empty() {
        return Err(Error::Usage("the trace shows no patch: expected some before the eye".into()));
    }
    let wanted: Vec<Wanted> = options.segments.iter().map(|&n| Wanted::of(n, &seen)).collect();
    let mut cases: Vec<Case<'_>> = Vec::new();
    for evaluator in Evaluator::ALL {
        let more = options.guard.iter().copied().filter(|_| evaluator.has_guard());
        let mut guards: Vec<u32> = [evaluator.guard_min()].into_iter().chain(more).collect();
        guards.sort_unstable();
        guards.dedup();
        for wanted in &wanted {
            for &guard in &guards {
                let fits = |width: &&u32| **width + guard + NET_BITS <= 63;
                let widths = options.width.iter().filter(fits);
                cases.extend(widths.map(|&width| (evaluator, wanted, width, guard)));
            }
        }
    }
    let row = |case| {
        let row = measure(case, &seen);
        each();
        row
    };
    Ok(cases.into_par_iter().map(row).collect())
}

/// How many rows there will be.
#[must_use]
pub fn count(options: &Options) -> usize {
    let guards = 1 + 2 * (1 + options.guard.len());
    guards * options.segments.len() * options.width.len()
}

fn check(options: &Options) -> Result<()> {
    let segments = |n: &&u32| !(4..=128).contains(*n) || !n.is_power_of_two();
    if let Some(wrong) = options.segments.iter().find(segments) {
        let message = format!("--segments: found {wrong}, expected powers of two from 4 to 128");
        return Err(Error::Usage(message));
    }
    if let Some(wrong) = options.width.iter().find(|width| !(8..=40).contains(*width)) {
        let message = format!("--width: found {wrong}, expected 8..=40 bits for evaluators");
        return Err(Error::Usage(message));
    }
    if let Some(wrong) = options.guard.iter().find(|guard| !(1..=20).contains(*guard)) {
        let message = format!("--guard: found {wrong}, expected 1..=20 bits for evaluators");
        return Err(Error::Usage(message));
    }
    if options.segments.is_empty() || options.width.is_empty() {
        return Err(Error::Usage("evaluators: expected some segments and widths".to_owned()));
    }
    Ok(())
}

/// The patches of all frames.
fn patches(commands: &[Command], base: &Config) -> Result<Vec<Seen>> {
    let reference = Reference::of(commands, base)?;
    let kept = reference.frames.iter().flat_map(|scene| &scene.patches).map(|truth| truth.kept);
    let mut kept = kept.collect::<Vec<_>>().into_iter();
    let mut seen = Vec::new();
    let mut walk = Walk::new(base);
    for command in commands {
        walk.command(command, &mut |_, drawn| {
            let (view, points) = (drawn.frame.view, drawn.exact);
            let near = view.near as f64 * space::ulp(view.position);
            let before = points.iter().all(|p| p[3] >= near && p[3] > 0.0);
            if kept.next() == Some(true) && before {
                seen.push(Seen { points, view });
            }
        })?;
    }
    let apart = seen.len().div_ceil(PATCHES_MAX).max(1);
    Ok(seen.into_iter().step_by(apart).collect())
}

fn measure((evaluator, wanted, width, guard): Case<'_>, seen: &[Seen]) -> Row {
    let segments = wanted.segments;
    let (mut error, mut behind) = (PositionError::default(), 0);
    let mut points = Vec::new();
    for (Seen { points: truth, view }, pixels) in seen.iter().zip(&wanted.pixels) {
        let range_log2 = view.position.width as i32 - 1 - view.position.fraction;
        let format = Format::of_range(width, range_log2);
        let ulp = space::ulp(format);
        let max = format.max() as f64;
        let net = truth.map(|p| p.map(|c| (c / ulp).round_ties_even().clamp(-max, max) as i64));
        points.clear();
        match evaluator {
            Evaluator::PowerBasis => power_basis(&net, guard, segments, &mut points),
            _ => rows(&net, format, guard, (evaluator, segments), &mut points),
        }
        for vertex in &points {
            let got = emit::screen(space::real(vertex.position, ulp), view.viewport);
            match (got, pixels[wanted.index(vertex)]) {
                (Some(got), Some(want)) => {
                    error.take((got[0] - want[0]).hypot(got[1] - want[1]));
                }
                _ => behind += 1,
            }
        }
    }
    Row { evaluator, segments, width, guard, error, behind }
}

/// All vertices of a patch by the block of the units that evaluate row by row.
fn rows(
    net: &[[i64; 4]; 16],
    position: Format,
    guard: u32,
    (evaluator, segments): (Evaluator, u32),
    out: &mut Vec<Vertex>,
) {
    let scheme = match evaluator {
        Evaluator::Forward => Scheme::Forward,
        Evaluator::DeCasteljau | Evaluator::PowerBasis => Scheme::DeCasteljau,
    };
    let (rounding, overflow) = (Rounding::NearestEven, Overflow::Saturate);
    let guard = guard.max(1); // of which de Casteljau makes nothing
    let settings = Settings { position, guard, scheme, rounding, overflow };
    let level = Level::clamped(u64::from(segments) << 16);
    let mut placement = Placement::default();
    placement.set(&Levels { edges: [level; 4], interior: [level; 2] });
    let patch = Patch { id: 0, points: *net, saturated: false, cull: false, reversed: false };
    Evaluate::new(settings).accept(&patch, &placement, out);
}

/// The same places by the power basis, as unit `esc` computes what is inside a patch.
fn power_basis(net: &[[i64; 4]; 16], guard: u32, segments: u32, out: &mut Vec<Vertex>) {
    let basis = PowerBasis::of(net, guard, PARAMETER_BITS);
    let step = ONE / segments;
    for (i, j) in (0..=segments).flat_map(|i| (0..=segments).map(move |j| (i, j))) {
        let (u, v) = (j * step, i * step);
        out.push(Vertex { position: basis.at([u.into(), v.into()]), u, v });
    }
}

/// The fewest bits of a position from which on an evaluator stays within so many pixels, however
/// many more it is given; `None` where it does not at the most that was measured.
#[must_use]
pub fn bits_needed(
    rows: &[Row],
    evaluator: Evaluator,
    segments: u32,
    guard: u32,
    pixels: f64,
) -> Option<u32> {
    let of =
        |row: &&Row| row.evaluator == evaluator && row.segments == segments && row.guard == guard;
    let mut rows: Vec<&Row> = rows.iter().filter(of).collect();
    rows.sort_by_key(|row| row.width);
    let serves = |row: &&&Row| row.error.largest <= pixels && row.behind == 0;
    rows.iter().rev().take_while(serves).last().map(|row| row.width)
}

/// How many decibels the RMS error of an evaluator falls by a bit: the slope of the straight line
/// through the rows whose error is below a pixel. `None` of fewer than two.
#[must_use]
pub fn slope(rows: &[Row], evaluator: Evaluator, segments: u32, guard: u32) -> Option<f64> {
    let of = |row: &&Row| {
        (row.evaluator, row.segments, row.guard) == (evaluator, segments, guard)
            && row.error.largest < 1.0
            && row.behind == 0
    };
    let points = rows.iter().filter(of).filter_map(|row| Some((row.width.into(), row.decibels()?)));
    let points: Vec<(f64, f64)> = points.collect();
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let across: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let along: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (across > 0.0).then(|| -along / across)
}
