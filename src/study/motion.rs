//! Motion: what is clipped, what is back-facing and what is tessellated from frame to frame, and
//! whether the golden models decide the same (Sfarti et al. 2005, section 3: "We produced five
//! different animations in order to prove" the two tests).
//!
//! The commands of a trace come in; they go through the configured unit as in a run, and patch by
//! patch through the golden models of clip and backface. Out come counts for each frame. A
//! *disagreement* is a patch of which only one of the two is left; there must be none. Apart from
//! that, a patch is *in sight* if one of 65 x 65 samples of it lies inside the visible volume and
//! faces the viewer (or the draw does not cull); a *false removal* is one that is in sight and was
//! removed: on the quantised surface, and on the one that the trace's numbers span in f64, of which
//! the unit knows only what shader and port leave. Samples can miss some.

mod judge;
mod table;

use crate::config::{Config, Engine};
use crate::error::{Error, Result};
use crate::report::Fates;
use crate::sink::{FrameInfo, PatchMesh, Sink};
use crate::trace::command::Command;
use crate::trace::read::Reader;
use crate::trace::scene::motion::Motion;
use crate::unit::{blocks, simulate};
use judge::{Fate, Judge, Judged};
use rtl_model::counter::{Block, Counter as C, Counters};

pub use table::{CSV_HEADER, csv, text};

/// Counts of patches of a frame, or of several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Drawn.
    pub patches: u64,
    /// Clipped: all 16 points outside one plane.
    pub clipped: u64,
    /// The same by the golden model on the same quantised points.
    pub clipped_golden: u64,
    /// Of the unquantised points in f64.
    pub clipped_exact: u64,
    /// Came to back-face removal.
    pub reached: u64,
    /// Of these, those that may be culled and of which no sample faces the viewer.
    pub away: u64,
    /// Removed as back-facing.
    pub culled: u64,
    /// The same by the method's golden model.
    pub culled_golden: u64,
    /// Tessellated.
    pub tessellated: u64,
    /// Their triangles.
    pub triangles: u64,
    /// Patches about which unit and golden model disagree.
    pub disagreements: u64,
    /// Removed, and in sight: the quantised surface.
    pub false_quantised: u64,
    /// Removed, and in sight: the surface in f64.
    pub false_exact: u64,
}

impl Counts {
    /// With names, in the order of tables.
    fn fields(&self) -> [u64; 13] {
        [
            self.patches,
            self.clipped,
            self.clipped_golden,
            self.clipped_exact,
            self.reached,
            self.away,
            self.culled,
            self.culled_golden,
            self.tessellated,
            self.triangles,
            self.disagreements,
            self.false_quantised,
            self.false_exact,
        ]
    }

    fn merge(&mut self, other: &Self) {
        self.patches += other.patches;
        self.clipped += other.clipped;
        self.clipped_golden += other.clipped_golden;
        self.clipped_exact += other.clipped_exact;
        self.reached += other.reached;
        self.away += other.away;
        self.culled += other.culled;
        self.culled_golden += other.culled_golden;
        self.tessellated += other.tessellated;
        self.triangles += other.triangles;
        self.disagreements += other.disagreements;
        self.false_quantised += other.false_quantised;
        self.false_exact += other.false_exact;
    }

    /// A frame: what the golden models say of each patch, which patches the run left, in their
    /// order, and what it counted.
    fn of(judged: &[Judged], kept: &[u32], counters: &Counters) -> Self {
        let get = |counter| counters.get(counter);
        let Fates { clipped, culled, tessellated } = Fates::of(counters);
        let patches = get(C::TracePatches);
        let mut counts = Self {
            patches,
            clipped,
            reached: patches - clipped,
            culled,
            tessellated,
            triangles: get(C::StitchTriangles),
            ..Self::default()
        };
        let (mut apart, mut open) = (0, 0);
        let mut kept = kept.iter().copied().peekable();
        for (patch, golden) in (0..).zip(judged) {
            let left = kept.next_if_eq(&patch).is_some();
            counts.clipped_golden += u64::from(golden.fate == Fate::Clipped);
            counts.clipped_exact += u64::from(golden.clipped_exact);
            counts.away += u64::from(golden.away);
            counts.culled_golden += u64::from(golden.fate.is_culled());
            counts.false_quantised += u64::from(!left && golden.in_sight);
            counts.false_exact += u64::from(!left && golden.in_sight_exact);
            open += u64::from(golden.fate == Fate::CulledWithinRounding && left);
            apart += u64::from(golden.fate.disagrees(left));
        }
        // A patch may be removed by the wrong one of the two blocks.
        let clips = counts.clipped.abs_diff(counts.clipped_golden);
        let culls = (counts.culled + open).abs_diff(counts.culled_golden);
        let missing = counts.patches.abs_diff(judged.len() as u64) + kept.count() as u64;
        counts.disagreements = missing + apart.max(clips).max(culls);
        counts
    }
}

/// A trace under the study: its name and its frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    /// What tables call it.
    pub name: String,
    /// Frame by frame.
    pub frames: Vec<Counts>,
}

impl Film {
    /// Over all frames.
    #[must_use]
    pub fn totals(&self) -> Counts {
        let mut totals = Counts::default();
        self.frames.iter().for_each(|frame| totals.merge(frame));
        totals
    }
}

/// Carries out the study on the commands of a trace, in the current rayon pool.
///
/// # Errors
/// The first error of the commands or the configuration, and [`Error::Usage`] for a unit that
/// culls nothing.
///
/// # Panics
/// When commands break what a reader of traces guarantees.
pub fn run(
    name: &str,
    commands: impl Iterator<Item = Result<Command>>,
    config: &Config,
) -> Result<Film> {
    if !blocks(config).contains(&Block::Clip) {
        let unit = config.unit.name();
        return Err(Error::Usage(format!("unit {unit} culls nothing: expected one that does")));
    }
    let config = Config { engine: Engine::None, ..config.clone() };
    let mut judge = Judge::new(&config);
    let mut kept = Kept::default();
    let commands = commands.map(|command| {
        let command = command?;
        judge.command(&command)?;
        Ok(command)
    });
    let report = simulate(commands, &config, &mut kept)?;
    let judged = judge.finish();
    assert_eq!([judged.len(), kept.0.len()], [report.frames.len(); 2], "frames are frames");
    let frames = judged.iter().zip(&kept.0).zip(&report.frames);
    let frames = frames.map(|((j, k), frame)| Counts::of(j, k, &frame.counters)).collect();
    Ok(Film { name: name.to_owned(), frames })
}

/// Carries out the study on a scene.
///
/// # Errors
/// As [`run`].
pub fn scene(scene: Motion, config: &Config) -> Result<Film> {
    let name = scene.kind.name();
    let mut text = Vec::new();
    scene.write(&mut text).expect("memory takes everything");
    let reader = Reader::new(&text[..], name, ".");
    run(name, reader.map(|located| Ok(located?.command)), config)
}

/// That there are no disagreements.
///
/// # Errors
/// [`Error::Check`] that says how many there are, and where.
pub fn check(films: &[Film]) -> Result<()> {
    let mut places = Vec::new();
    for film in films {
        for (number, frame) in film.frames.iter().enumerate() {
            if frame.disagreements > 0 {
                let (name, n) = (&film.name, frame.disagreements);
                places.push(format!("{name}, frame {number}: {n}"));
            }
        }
    }
    if places.is_empty() {
        return Ok(());
    }
    let (more, all) = (places.len().saturating_sub(5), places.len());
    places.truncate(5);
    let more = if more > 0 { format!("; and {more} frames more") } else { String::new() };
    Err(Error::Check(format!(
        "unit and golden model disagree about patches of {all} frames: {}{more}",
        places.join("; ")
    )))
}

/// Numbers of the patches that a run leaves, frame by frame.
#[derive(Debug, Default)]
struct Kept(Vec<Vec<u32>>);

impl Sink for Kept {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, _frame: &FrameInfo) -> Result<()> {
        self.0.push(Vec::new());
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        self.0.last_mut().expect("patches belong to a frame").push(mesh.patch);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
