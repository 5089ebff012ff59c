//! One lane of a timeline, and one end of a FIFO: what happened, in the order of time, goes in;
//! what of it is within the window is kept.

use crate::report::timeline::{Change, State};
use std::collections::VecDeque;
use std::ops::Range;

/// What is to be kept, and how much is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds {
    /// No cycle before this one is in the window.
    pub(super) floor: u64,
    /// Nor is this one or any after it, once that is known.
    pub(super) end: Option<u64>,
    /// Changes, pushes, pops and transfers that are kept.
    pub(super) kept: usize,
}

impl Bounds {
    fn is_behind(&self, at: u64) -> bool {
        self.end.is_some_and(|end| at >= end)
    }
}

/// What a lane did.
#[derive(Debug, Default)]
pub(super) struct Lane {
    changes: VecDeque<Change>,
    /// The cycle up to which that is known.
    pub(super) covered: u64,
    /// When its oldest token was held up.
    held: Vec<(State, u64, u64)>,
}

impl Lane {
    /// Its oldest token is held up, `from` being no earlier than the last time's `to`.
    pub(super) fn hold(&mut self, state: State, from: u64, to: u64) {
        match self.held.last_mut() {
            Some(last) if last.0 == state && last.2 == from => last.2 = to,
            _ => self.held.push((state, from, to)),
        }
    }

    /// Its oldest token, accepted at `accept`, has waited for the port since `waited`; from `over`
    /// on it is not in flight.
    pub(super) fn close(&mut self, accept: u64, waited: u64, over: u64, bounds: &mut Bounds) {
        self.until(waited.min(accept), State::Starved, bounds);
        self.until(accept, State::StarvedByPort, bounds);
        let mut held = std::mem::take(&mut self.held);
        for (state, from, to) in held.drain(..) {
            self.until(from, State::Busy, bounds);
            self.until(to, state, bounds);
        }
        self.held = held; // empty, and its memory
        self.until(over, State::Busy, bounds);
    }

    /// From where its past ends until before cycle `to` it is in `state`.
    fn until(&mut self, to: u64, state: State, bounds: &mut Bounds) {
        if to <= self.covered {
            return;
        }
        let at = std::mem::replace(&mut self.covered, to);
        if bounds.is_behind(at) {
            return;
        }
        if self.changes.back().is_none_or(|last| last.state != state) {
            self.changes.push_back(Change { at, state });
            bounds.kept += 1;
        }
        self.forget(bounds);
    }

    /// Drops what was over before the window.
    fn forget(&mut self, bounds: &mut Bounds) {
        while self.changes.get(1).is_some_and(|second| second.at <= bounds.floor) {
            self.changes.pop_front();
            bounds.kept -= 1;
        }
    }

    /// What it did in the window, idle at the end.
    pub(super) fn finish(mut self, window: &Range<u64>, bounds: &mut Bounds) -> Vec<Change> {
        self.until(window.end, State::Starved, bounds);
        self.forget(bounds);
        self.changes.retain(|change| change.at < window.end);
        if let Some(first) = self.changes.front_mut() {
            first.at = window.start;
        }
        self.changes.into()
    }
}

/// The times of one end of a FIFO, ascending.
#[derive(Debug, Default)]
pub(super) struct Times {
    /// How many were before the window.
    before: u64,
    at: VecDeque<u64>,
}

impl Times {
    pub(super) fn push(&mut self, at: u64, bounds: &mut Bounds) {
        self.forget(bounds.floor, &mut bounds.kept);
        if !bounds.is_behind(at) {
            self.at.push_back(at);
            bounds.kept += 1;
        }
    }

    fn forget(&mut self, floor: u64, kept: &mut usize) {
        while self.at.front().is_some_and(|&at| at < floor) {
            self.at.pop_front();
            self.before += 1;
            *kept -= 1;
        }
    }

    /// How many were before the window, and those within.
    pub(super) fn finish(mut self, window: &Range<u64>) -> (u64, Vec<u64>) {
        let mut kept = self.at.len();
        self.forget(window.start, &mut kept);
        self.at.retain(|&at| at < window.end);
        (self.before, self.at.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_cover_the_window_and_only_it_is_kept() {
        use State::{Blocked, BlockedByOrder, Busy, Starved, StarvedByPort};
        let record = |floor, end: Option<u64>| {
            let (mut lane, mut bounds) = (Lane::default(), Bounds { floor, end, kept: 0 });
            lane.close(2, 2, 5, &mut bounds);
            lane.hold(BlockedByOrder, 6, 7);
            lane.hold(Blocked, 7, 8);
            lane.hold(Blocked, 8, 9);
            lane.close(4, 4, 10, &mut bounds);
            lane.close(15, 12, 20, &mut bounds);
            let kept = bounds.kept;
            let window = floor..end.unwrap_or(22).min(22);
            (lane.finish(&window, &mut bounds), kept)
        };
        let change = |(at, state)| Change { at, state };
        let all = [
            (0, Starved),
            (2, Busy),
            (6, BlockedByOrder),
            (7, Blocked),
            (9, Busy),
            (10, Starved),
            (12, StarvedByPort),
            (15, Busy),
            (20, Starved),
        ];
        assert_eq!(record(0, None), (all.map(change).to_vec(), 8));
        assert_eq!(
            record(8, Some(13)).0,
            [(8, Blocked), (9, Busy), (10, Starved), (12, StarvedByPort)].map(change)
        );
        assert_eq!(record(16, None), ([(16, Busy), (20, Starved)].map(change).to_vec(), 1));
        assert_eq!(record(0, Some(7)), (all[..3].iter().copied().map(change).collect(), 3));
    }

    #[test]
    fn times_before_the_window_are_counted_and_those_in_it_kept() {
        let (mut times, mut bounds) = (Times::default(), Bounds { floor: 4, ..Bounds::default() });
        for at in [1, 3, 4, 6, 9] {
            times.push(at, &mut bounds);
        }
        assert_eq!(bounds.kept, 3);
        assert_eq!(times.finish(&(4..9)), (2, vec![4, 6]));
    }
}
