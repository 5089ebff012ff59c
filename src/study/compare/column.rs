//! Column: what the table knows of one unit.

use super::Run;
use super::cell::Cell;
use super::series::{self, Series};
use crate::output::summary::ratio;
use crate::output::table::bound;
use crate::report::Frame;
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter, Declaration};
use rtl_model::time::StageTimes;

/// One of three frames: [`Series::spread`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Which {
    Least,
    Median,
    Most,
}

/// Where a block stands.
#[derive(Clone, Copy, Debug)]
pub(super) enum Side {
    Before,
    Behind,
}

/// A run, and the sums of its frames.
pub(super) struct Column<'a> {
    pub(super) run: &'a Run,
    pub(super) whole: Frame,
    all: Vec<Series>,
}

impl<'a> Column<'a> {
    pub(super) fn of(run: &'a Run) -> Self {
        Self { run, whole: run.report.whole(), all: series::series(run) }
    }

    pub(super) fn has(&self, block: Block) -> bool {
        self.run.report.blocks.contains(&block)
    }

    pub(super) fn total(&self, block: Block, counter: Counter) -> Option<Cell> {
        self.has(block).then(|| Cell::Number(self.whole.counters.get(counter)))
    }

    /// The sum of the block's counters whose names begin like this.
    pub(super) fn sum(&self, block: Block, start: &str) -> Option<Cell> {
        let named = |d: &&Declaration| d.block == block && d.name.starts_with(start);
        let counters = self.run.report.declarations().filter(named).map(|d| d.counter);
        self.has(block).then(|| Cell::Number(counters.map(|c| self.whole.counters.get(c)).sum()))
    }

    /// Operations of all blocks; none where no block's are known.
    pub(super) fn ops(&self, of: impl Fn(&Ops) -> u64) -> Option<Cell> {
        let known = || self.whole.work.iter().filter_map(|work| work.ops.as_ref());
        known().next()?;
        Some(Cell::Number(known().map(of).sum()))
    }

    /// The mean of a width over all operations of a kind.
    pub(super) fn mean_bits(&self, of: impl Fn(&Ops) -> [u64; 2]) -> Option<Cell> {
        let works = self.whole.work.iter().filter_map(|work| work.ops.as_ref());
        let sums = works.map(of).fold([0; 2], |[a, b], [c, d]| [a + c, b + d]);
        ratio(sums[0], sums[1]).map(Cell::Rate)
    }

    /// Where nothing is removed, every patch that is drawn is tessellated.
    pub(super) fn tessellated(&self) -> Option<Cell> {
        let all = || {
            self.has(Block::Evaluate)
                .then_some(())
                .and(self.total(Block::Trace, Counter::TracePatches))
        };
        self.total(Block::Level, Counter::LevelPatches).or_else(all)
    }

    pub(super) fn elapsed(&self) -> Option<u64> {
        self.whole.times.as_ref().map(|times| times.elapsed)
    }

    pub(super) fn per_triangle(&self, value: u64) -> Option<Cell> {
        ratio(value, self.whole.counters.get(Counter::EmitTriangles)).map(Cell::Rate)
    }

    /// A number over the whole run.
    pub(super) fn number(&self, block: &str, name: &str) -> Option<Cell> {
        self.series(block, name)?.whole.value.map(Cell::from)
    }

    /// Of what it was in the frames the least, the median or the most.
    pub(super) fn spread(&self, block: &str, name: &str, which: Which) -> Option<Cell> {
        Some(Cell::from(self.series(block, name)?.spread()?[which as usize]))
    }

    fn series(&self, block: &str, name: &str) -> Option<&Series> {
        self.all.iter().find(|s| s.whole.block == block && s.whole.name == name)
    }

    /// What binds the run, and by how much it is used.
    pub(super) fn binds(&self) -> [Option<Cell>; 2] {
        let Some(bound) = bound(&self.run.report, &self.whole) else { return [None, None] };
        let what = if bound.binds { bound.block.name() } else { "latency" };
        let used = bound.binds.then(|| percent(bound.used));
        [Some(Cell::Word(what.to_owned())), used]
    }

    /// A share of the cycles of the block that is used most.
    pub(super) fn share(&self, of: impl Fn(&StageTimes) -> u64) -> Option<Cell> {
        let (k, stages) = self.busiest()?;
        ratio(of(&stages[k]), stages[k].total).map(percent)
    }

    /// Of the blocks before and behind the one that is used most, the one that is held up for the
    /// greatest part of its cycles, and that part.
    pub(super) fn waits(&self, side: Side) -> Option<[Cell; 2]> {
        let (k, stages) = self.busiest()?;
        let (range, of): (_, fn(&StageTimes) -> u64) = match side {
            Side::Before => (0..k, |t| t.blocked + t.blocked_by_order),
            Side::Behind => (k + 1..stages.len(), |t| t.starved + t.starved_by_port),
        };
        let shares = range.filter_map(|i| Some((i, ratio(of(&stages[i]), stages[i].total)?)));
        let (i, share) = shares.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
        let name = self.run.report.chain[i].block.name();
        Some([Cell::Word(name.to_owned()), percent(share)])
    }

    /// Which block is used most, and the times of all.
    fn busiest(&self) -> Option<(usize, &[StageTimes])> {
        let binds = bound(&self.run.report, &self.whole)?.block;
        let k = self.run.report.chain.iter().position(|stage| stage.block == binds)?;
        Some((k, &self.whole.times.as_ref()?.stages))
    }
}

fn percent(share: f64) -> Cell {
    Cell::Word(format!("{:.1} %", 100.0 * share))
}
