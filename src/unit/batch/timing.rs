//! Timing: patches that are done in, in the order of the trace, with the commands that stand among
//! them; on the clock they go out, those of a surface shader wave by wave.

use super::Batch;
use crate::config::Config;
use crate::unit::chain::{Fate, Flow, Work as Done};
use crate::unit::clock::{Clock, Fetch};
use crate::unit::edges::{EdgeDatabase, Held};
use crate::unit::wave::Former;

/// Puts patches and commands on the clock, in the order of the trace.
pub(super) struct Timing<'a, T: Flow> {
    batch: &'a Batch,
    clock: &'a mut Clock<T>,
    edges: &'a mut EdgeDatabase,
    /// What the database did for all patches, and the most that it held.
    pub(super) held: Held,
    pub(super) waves: Former<T>,
    patches: usize,
    commands: usize,
}

impl<'a, T: Flow> Timing<'a, T> {
    pub(super) fn new(
        batch: &'a Batch,
        config: &Config,
        clock: &'a mut Clock<T>,
        edges: &'a mut EdgeDatabase,
    ) -> Self {
        let (held, waves) = (Held::default(), Former::new(config));
        Self { batch, clock, edges, held, waves, patches: 0, commands: 0 }
    }

    pub(super) fn patches(&mut self, done: &[Done<T>]) {
        for &work in done {
            let patch = &self.batch.patches[self.patches];
            let draw = &self.batch.draws[patch.draw as usize];
            if self.waves.ends_at(draw.number) {
                self.complete();
            }
            self.commands();
            if let (true, Some(size)) = (T::SHARES_EDGES, draw.edges) {
                let kept = (work.fate == Fate::Kept).then(|| work.lists.edges());
                let held = self.edges.pass(size, patch.site, kept);
                self.held.shared += held.shared;
                self.held.entries = self.held.entries.max(held.entries);
            }
            let fetch = Fetch { patch: patch.id, measured: draw.measures(), ..patch.fetch };
            let waiting = (fetch, work, draw.hosted);
            let clock = &mut *self.clock;
            self.waves
                .accept(draw.number, waiting, &mut |(f, w, hosted)| clock.patch(f, w, hosted));
            self.patches += 1;
        }
    }

    /// No patch follows that the last wave could take in.
    fn complete(&mut self) {
        let clock = &mut *self.clock;
        self.waves.finish(&mut |(fetch, work, hosted)| clock.patch(fetch, work, hosted));
    }

    /// Nothing follows.
    pub(super) fn finish(&mut self) {
        self.complete();
        self.commands();
    }

    /// Those that come before the next patch.
    fn commands(&mut self) {
        while let Some(command) = self.batch.commands.get(self.commands)
            && command.before <= self.patches
        {
            self.clock.command(command.payload, command.written);
            self.commands += 1;
        }
    }
}
