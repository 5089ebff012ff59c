//! What a run reports: counters by frame. A leaf.

use crate::config::Config;
use rtl_model::counter::{Block, Counter, Counters, DECLARATIONS, Declaration};

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// The effective configuration, the trace's overrides not included.
    pub config: Config,
    /// The blocks of the unit, in the order of the data.
    pub blocks: &'static [Block],
    /// Counters of each frame.
    pub frames: Vec<Counters>,
    /// Bytes that would have crossed the link, framing included, had the host sent the same
    /// triangles.
    pub host_link_bytes: u64,
}

impl Report {
    /// Counters over all frames.
    #[must_use]
    pub fn totals(&self) -> Counters {
        let mut totals = Counters::default();
        for frame in &self.frames {
            totals.merge(frame);
        }
        totals
    }

    /// The counters that this unit has, in the order of reports.
    pub fn declarations(&self) -> impl Iterator<Item = &'static Declaration> + '_ {
        DECLARATIONS.iter().filter(|d| self.blocks.contains(&d.block))
    }

    /// One counter over all frames.
    #[must_use]
    pub fn total(&self, counter: Counter) -> u64 {
        self.totals().get(counter)
    }
}
