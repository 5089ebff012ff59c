//! Judge: the commands of a trace in, what the golden models say of every patch out.

use crate::config::{BackfaceMethod, Config};
use crate::error::Result;
use crate::golden::backface::{ROUNDING, culled, faces_viewer, in_sight, margin};
use crate::golden::{clip, real};
use crate::study::walk::{Drawn, Walk};
use crate::trace::command::Command;
use rayon::prelude::*;

/// Patches that wait to be judged together, on all threads.
const TOGETHER: usize = 4096;

/// What is to become of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    Clipped,
    Culled,
    /// By cones that are no farther apart than the block's roundings, so that it may keep it.
    CulledWithinRounding,
    Kept,
}

impl Fate {
    pub(super) fn is_culled(self) -> bool {
        matches!(self, Self::Culled | Self::CulledWithinRounding)
    }

    /// Whether a unit that left a patch, or did not, decided something else.
    pub(super) fn disagrees(self, left: bool) -> bool {
        match self {
            Self::Clipped | Self::Culled => left,
            Self::CulledWithinRounding => false,
            Self::Kept => !left,
        }
    }
}

/// What is said of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    pub(super) fate: Fate,
    /// All unquantised points are outside one plane.
    pub(super) clipped_exact: bool,
    /// It comes to back-face removal, may be culled, and shows no front.
    pub(super) away: bool,
    /// The quantised surface is in sight.
    pub(super) in_sight: bool,
    /// The surface in f64 is.
    pub(super) in_sight_exact: bool,
}

/// Judges patches as they are drawn.
pub(super) struct Judge<'a> {
    config: &'a Config,
    walk: Walk<'a>,
    waiting: Vec<Drawn>,
    frames: Vec<Vec<Judged>>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(config: &'a Config) -> Self {
        Self { config, walk: Walk::new(config), waiting: Vec::new(), frames: Vec::new() }
    }

    pub(super) fn command(&mut self, command: &Command) -> Result<()> {
        if let Command::Frame(_) = command {
            settle(&mut self.waiting, &mut self.frames, self.config);
            self.frames.push(Vec::new());
        }
        let Self { config, walk, waiting, frames } = self;
        walk.command(command, &mut |_, drawn| {
            waiting.push(drawn);
            if waiting.len() == TOGETHER {
                settle(waiting, frames, config);
            }
        })
    }

    /// Patches in draw order, frame by frame.
    pub(super) fn finish(mut self) -> Vec<Vec<Judged>> {
        settle(&mut self.waiting, &mut self.frames, self.config);
        self.frames
    }
}

/// Judges those that wait; they belong to the frame that began last.
fn settle(waiting: &mut Vec<Drawn>, frames: &mut [Vec<Judged>], config: &Config) {
    if let Some(frame) = frames.last_mut() {
        frame.par_extend(waiting.par_drain(..).map(|drawn| judge(&drawn, config)));
    }
}

fn judge(drawn: &Drawn, config: &Config) -> Judged {
    let Drawn { patch, frame, exact, .. } = drawn;
    let (view, method) = (&frame.view, config.backface.method);
    let front = if patch.reversed { -view.facing } else { view.facing };
    let shown = patch.cull.then_some(front as f64);
    let outside = clip::outside(&patch.points, view.depth);
    let clipped_exact = clip::outside_real(exact, view.depth);
    // Nothing of a hull that is outside a plane is inside all of them.
    let points = real(&patch.points);
    let in_sight_quantised = !outside && in_sight(&points, shown, view.depth);
    let clipped = outside && config.clip.enabled;
    let fate = if clipped {
        Fate::Clipped
    } else if culled(patch, view, method) != Some(true) {
        Fate::Kept
    } else if method == BackfaceMethod::NormalCone
        && margin(&patch.points, front).is_some_and(|margin| margin <= ROUNDING)
    {
        Fate::CulledWithinRounding
    } else {
        Fate::Culled
    };
    let rows = || points.map(|[x, y, _, w]| [x, y, w]);
    Judged {
        fate,
        clipped_exact,
        away: !clipped && patch.cull && !in_sight_quantised && !faces_viewer(&rows(), front as f64),
        in_sight: in_sight_quantised,
        in_sight_exact: !clipped_exact && in_sight(exact, shown, view.depth),
    }
}
