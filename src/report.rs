//! What a run reports: frame by frame the counters, what each block of the timed chain did, and,
//! where an engine ran, its cycles. A leaf.

pub mod timeline;

use crate::config::Config;
use crate::error::Error;
use rtl_model::counter::standard::{self, ELAPSED, Stage, Work};
use rtl_model::counter::{Block, Counter, Counters, DECLARATIONS, Declaration, Measure};
use rtl_model::time::{FrameTimes, StageTimes};

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// The effective configuration, the trace's overrides not included.
    pub config: Config,
    /// The blocks of the unit, in the order of the data.
    pub blocks: &'static [Block],
    /// The blocks that are timed, in the order of the data.
    pub chain: Vec<Stage>,
    /// What happened in each frame.
    pub frames: Vec<Frame>,
    /// For each block of the chain, how many cycles of the run began with 0, 1, .. tokens in the
    /// FIFO before it; empty for the first block. Empty altogether without an engine.
    pub occupancy: Vec<Vec<u64>>,
    /// Bytes that would have crossed the link, framing included, had the host sent the same
    /// triangles.
    pub host_link_bytes: u64,
}

/// What happened in a frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The blocks' own counters.
    pub counters: Counters,
    /// What each block of the chain did.
    pub work: Vec<Work>,
    /// Where the cycles went; `None` without an engine.
    pub times: Option<FrameTimes>,
}

/// A frame is asked for, by `--frame`, of a trace with so many.
#[must_use]
pub fn no_such_frame(number: u64, frames: usize) -> Error {
    let numbered = match frames {
        0 => "the trace has none".to_owned(),
        1 => "the trace has frame 0 only".to_owned(),
        _ => format!("the trace has frames 0 to {}", frames - 1),
    };
    Error::Usage(format!("--frame {number}: no such frame: {numbered}"))
}

/// What became of the patches of a frame or a run, each counted once: where those of a primitive
/// are measured before they are drawn, clip and backface remove a patch twice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fates {
    /// Wholly outside a clip plane.
    pub clipped: u64,
    /// Removed as back-facing.
    pub culled: u64,
    /// Tessellated.
    pub tessellated: u64,
}

impl Fates {
    /// From a unit's counters.
    #[must_use]
    pub fn of(counters: &Counters) -> Self {
        let once = |all, measured| counters.get(all) - counters.get(measured);
        Self {
            clipped: once(Counter::ClipCulled, Counter::ClipMeasured),
            culled: once(Counter::BackfaceCulled, Counter::BackfaceMeasured),
            tessellated: counters.get(Counter::LevelPatches),
        }
    }
}

/// A number of a report: a row of `counters.csv`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The block.
    pub block: Block,
    /// The name within the block.
    pub name: String,
    /// The measure.
    pub measure: Measure,
    /// The value.
    pub value: u64,
}

impl Frame {
    /// A frame, whose times, if any, are held against what the blocks did.
    ///
    /// # Panics
    /// When an engine's times break a law ([`standard::check`]).
    #[must_use]
    pub fn new(
        chain: &[Stage],
        counters: Counters,
        work: Vec<Work>,
        times: Option<FrameTimes>,
    ) -> Self {
        assert_eq!(work.len(), chain.len(), "every block of the chain has its work counted");
        if let Some(times) = &times {
            standard::check(chain, &work, times);
        }
        Self { counters, work, times }
    }

    /// Takes in a frame that follows.
    fn merge(&mut self, other: &Self) {
        self.counters.merge(&other.counters);
        self.work.resize(other.work.len(), Work::default());
        for (sum, work) in self.work.iter_mut().zip(&other.work) {
            sum.tokens_in += work.tokens_in;
            sum.tokens_out += work.tokens_out;
            sum.ops = work.ops.map(|ops| sum.ops.unwrap_or_default().with(1, ops));
        }
        if let Some(times) = &other.times {
            add_times(self.times.get_or_insert_default(), times);
        }
    }
}

fn add_times(sum: &mut FrameTimes, times: &FrameTimes) {
    sum.elapsed += times.elapsed;
    sum.stages.resize(times.stages.len(), StageTimes::default());
    for (sum, stage) in sum.stages.iter_mut().zip(&times.stages) {
        sum.busy += stage.busy;
        sum.starved += stage.starved;
        sum.starved_by_port += stage.starved_by_port;
        sum.blocked += stage.blocked;
        sum.blocked_by_order += stage.blocked_by_order;
        sum.total += stage.total;
        sum.used += stage.used;
        sum.tokens_in += stage.tokens_in;
        sum.tokens_out += stage.tokens_out;
        sum.fifo_peak = sum.fifo_peak.max(stage.fifo_peak);
    }
}

impl Report {
    /// Holds the frames together against the laws that only a whole run keeps.
    ///
    /// # Panics
    /// When the engine is wrong: a block's cycles are not the elapsed ones in each of its lanes, it
    /// was used with nothing in flight, or a FIFO was not in one state in each of the cycles.
    pub fn check(&self) {
        let Some(times) = self.whole().times else { return };
        assert!(self.frames.iter().all(|f| f.times.is_some()), "all frames are timed, or none");
        for (stage, t) in self.chain.iter().zip(&times.stages) {
            let (name, lanes) = (stage.block.name(), u64::from(stage.shape.lanes));
            assert_eq!(t.total, times.elapsed * lanes, "{name}: elapsed cycles x {lanes} lanes");
            // Of frames that overlap, one may leave a lane in the cycle in which the next enters
            // it: in flight in that cycle is the one, used is the lane by the other.
            let in_flight = t.busy + t.blocked + t.blocked_by_order;
            assert!(t.used <= in_flight, "{name}: used {} of {in_flight} in flight", t.used);
        }
        assert_eq!(self.occupancy.len(), self.chain.len(), "every FIFO has its occupancy");
        for (k, (stage, cycles)) in self.chain.iter().zip(&self.occupancy).enumerate() {
            let (sum, elapsed) =
                (cycles.iter().sum::<u64>(), if k == 0 { 0 } else { times.elapsed });
            assert_eq!(sum, elapsed, "{}: cycles of its FIFO", stage.block.name());
        }
    }

    /// All frames as one: counters and cycles added up, peaks by their maximum.
    #[must_use]
    pub fn whole(&self) -> Frame {
        let mut whole = Frame::default();
        for frame in &self.frames {
            whole.merge(frame);
        }
        whole
    }

    /// Counters over all frames.
    #[must_use]
    pub fn totals(&self) -> Counters {
        let mut totals = Counters::default();
        for frame in &self.frames {
            totals.merge(&frame.counters);
        }
        totals
    }

    /// The blocks' own counters that this unit has, in the order of reports.
    pub fn declarations(&self) -> impl Iterator<Item = &'static Declaration> + '_ {
        DECLARATIONS.iter().filter(|d| self.blocks.contains(&d.block))
    }

    /// One counter over all frames.
    #[must_use]
    pub fn total(&self, counter: Counter) -> u64 {
        self.totals().get(counter)
    }

    /// Every number of a frame, or of [`Self::whole`]: block by block in the order of the data, its
    /// own counters first; last the unit.
    #[must_use]
    pub fn rows(&self, frame: &Frame) -> Vec<Row> {
        let mut rows = Vec::new();
        for &block in self.blocks {
            rows.extend(DECLARATIONS.iter().filter(|d| d.block == block).map(|d| Row {
                block,
                name: d.name.to_owned(),
                measure: d.measure,
                value: frame.counters.get(d.counter),
            }));
            if let Some(k) = self.chain.iter().position(|stage| stage.block == block) {
                rows.extend(self.standard_rows(k, frame));
            }
        }
        rows.extend(frame.times.as_ref().map(|times| Row {
            block: Block::Unit,
            name: ELAPSED.name.to_owned(),
            measure: ELAPSED.measure,
            value: times.elapsed,
        }));
        rows
    }

    fn standard_rows(&self, k: usize, frame: &Frame) -> impl Iterator<Item = Row> {
        // A run without frames did nothing at all.
        let work = frame.work.get(k).copied().unwrap_or_default();
        let times = frame.times.as_ref().map(|times| times.stages[k].clone());
        let block = self.chain[k].block;
        standard::rows(&self.chain, k).filter_map(move |(name, row)| {
            let value = row.quantity.value(&work, times.as_ref())?;
            Some(Row { block, name, measure: row.measure, value })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::timed_report;

    #[test]
    fn frames_add_up_and_peaks_do_not() {
        let whole = timed_report().whole();
        let times = whole.times.expect("it is timed");
        assert_eq!((times.elapsed, times.stages[1].busy, times.stages[2].total), (200, 190, 600));
        assert_eq!(times.stages[1].fifo_peak, 2);
        assert_eq!((whole.work[1].tokens_in, whole.work[1].tokens_out), (2, 8));
        assert_eq!(whole.work[1].ops.map(|ops| (ops.add, ops.mul_bits)), Some((8, 60)));
        assert_eq!(whole.work[0].ops, None, "link has no arithmetic in any frame");
    }

    #[test]
    fn a_run_that_breaks_a_law_is_not_reported() {
        timed_report().check();
        type Harm = fn(&mut Report);
        let harms: [Harm; 6] = [
            |r| r.frames[0].times.as_mut().expect("it is timed").stages[1].used += 9,
            |r| r.frames[1].times.as_mut().expect("it is timed").stages[2].total += 3,
            |r| r.frames[0].times.as_mut().expect("it is timed").elapsed += 1,
            |r| r.frames[0].times = None,
            |r| r.occupancy[2][0] -= 1,
            |r| r.occupancy.truncate(2),
        ];
        for (number, harm) in harms.iter().enumerate() {
            let mut report = timed_report();
            harm(&mut report);
            let caught = std::panic::catch_unwind(|| report.check());
            assert!(caught.is_err(), "violation {number} passes");
        }
        let frame = timed_report().frames.remove(0);
        let chain = timed_report().chain;
        let made =
            |work: Vec<Work>| Frame::new(&chain, Counters::default(), work, frame.times.clone());
        made(frame.work.clone());
        let mut work = frame.work.clone();
        work[1].tokens_out += 1;
        let caught = std::panic::catch_unwind(|| made(work));
        assert!(caught.is_err(), "an engine that lost a token passes");
    }
}
