//! The timeline of a run as plain data: what each lane of each block did and when, what went into
//! and out of each FIFO and when, what had crossed the link by when. The units record it
//! (`unit::timeline`), [`output`](crate::output::timeline) writes it.
//!
//! All cycles are those of the frame, or of the run where frames overlap. A lane's changes are
//! kept, not its slices: each lasts until the next, so that they cover the window without a gap.

use rtl_model::counter::standard::{self, Quantity, Stage};
use std::ops::Range;
use std::str::FromStr;

/// Which part of a run a timeline shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The frame, from 0. Where frames overlap, time is the run's, and only patches are a frame's.
    pub frame: u64,
    /// The part of it.
    pub window: Window,
}

/// A part of a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Window {
    /// All of it.
    #[default]
    Whole,
    /// These cycles.
    Cycles(Range<u64>),
    /// The cycles from when the link takes the first of these patches until all that the last
    /// became has left the unit. Patches are numbered over the frame, before culling, in draw
    /// order.
    Patches(Range<u32>),
}

impl FromStr for Window {
    type Err = String;

    /// `cycles:A..B` or `patches:A..B`, from A to before B.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "expected cycles:A..B or patches:A..B, A < B".to_owned();
        let (kind, range) = text.split_once(':').ok_or_else(wrong)?;
        let (from, to) = range.split_once("..").ok_or_else(wrong)?;
        let number = |text: &str| {
            let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
            digits.then(|| text.parse::<u64>().ok()).flatten().ok_or_else(wrong)
        };
        let (from, to) = (number(from)?, number(to)?);
        if from >= to {
            return Err(wrong());
        }
        let patch = |number: u64| u32::try_from(number).map_err(|_| wrong());
        match kind {
            "cycles" => Ok(Self::Cycles(from..to)),
            "patches" => Ok(Self::Patches(patch(from)?..patch(to)?)),
            _ => Err(wrong()),
        }
    }
}

/// What a lane does in a cycle: one of those that `counters.csv` adds up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// A token is in flight that nothing holds up.
    Busy,
    /// Nothing is in flight, and nothing has arrived.
    Starved,
    /// Nothing is in flight; a token waits for the shared memory port.
    StarvedByPort,
    /// A finished output has no room downstream.
    Blocked,
    /// A finished output waits for tokens of other lanes.
    BlockedByOrder,
}

impl State {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Busy, Self::Starved, Self::StarvedByPort, Self::Blocked, Self::BlockedByOrder];

    /// `busy`, `starved` or `blocked`.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Busy => "busy",
            Self::Starved | Self::StarvedByPort => "starved",
            Self::Blocked | Self::BlockedByOrder => "blocked",
        }
    }

    /// What it is called in stage `k` of a chain: the name of its counter behind `cycles.`, with
    /// blanks for points (`blocked by stitch`).
    #[must_use]
    pub fn name(self, chain: &[Stage], k: usize) -> String {
        let wanted = match self {
            Self::Busy => Quantity::Busy,
            Self::Starved => Quantity::StarvedByUpstream,
            Self::StarvedByPort => Quantity::StarvedByPort,
            Self::Blocked => Quantity::BlockedByDownstream,
            Self::BlockedByOrder => Quantity::BlockedByOrder,
        };
        let mut rows = standard::rows(chain, k);
        // A block that cannot be in a state has no row of it.
        let row = rows.find(|(_, row)| row.quantity == wanted);
        let name = row.map_or_else(|| self.kind().to_owned(), |(name, _)| name);
        name.trim_start_matches("cycles.").replacen(".by.", " by ", 1)
    }
}

/// A lane does something else from a cycle on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// The cycle.
    pub at: u64,
    /// What it does from then on.
    pub state: State,
}

/// What went into and out of a FIFO.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Queue {
    /// Entries at the start of the window.
    pub before: u64,
    /// The cycles in which a token was pushed, ascending. It is held from the next one on.
    pub pushed: Vec<u64>,
    /// The cycles in which a token was taken, ascending. The room is seen in the next one.
    pub popped: Vec<u64>,
}

impl Queue {
    /// The cycles at the start of which it held another number of entries than at that of the one
    /// before, and how many; first those at the start of the window.
    pub fn levels(&self, window: &Range<u64>) -> impl Iterator<Item = (u64, u64)> {
        let mut pushed = self.pushed.iter().map(|at| at + 1).peekable();
        let mut popped = self.popped.iter().map(|at| at + 1).peekable();
        let (mut level, end) = (self.before, window.end);
        let changes = std::iter::from_fn(move || {
            loop {
                let next = [pushed.peek(), popped.peek()].into_iter().flatten().min();
                let at = next.copied().filter(|&at| at < end)?;
                let before = level;
                level += u64::from(pushed.next_if_eq(&at).is_some());
                level -= u64::from(popped.next_if_eq(&at).is_some());
                if level != before {
                    return Some((at, level));
                }
            }
        });
        std::iter::once((window.start, self.before)).chain(changes)
    }
}

/// A block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Track {
    /// What each of its lanes did; the first change of each is at the start of the window.
    pub lanes: Vec<Vec<Change>>,
    /// The FIFO before it; `None` for the first block.
    pub queue: Option<Queue>,
}

/// Bytes that had been sent over the link since the frame began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crossed {
    /// The cycle in which the last of the transfers began.
    pub at: u64,
    /// Towards the device, framing included.
    pub down: u64,
    /// Towards the host.
    pub up: u64,
}

/// The timeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// The frame; `None` where frames overlap, and it is one of the run.
    pub frame: Option<u64>,
    /// Cycles of the frame, or the run.
    pub elapsed: u64,
    /// The cycles that are shown.
    pub window: Range<u64>,
    /// The blocks that are timed, in the order of the data.
    pub chain: Vec<Stage>,
    /// What each of them did.
    pub tracks: Vec<Track>,
    /// What had crossed the link at the start of the window, and each time more did.
    pub link: Vec<Crossed>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_is_two_numbers_of_one_kind() {
        assert_eq!("cycles:0..10".parse(), Ok(Window::Cycles(0..10)));
        assert_eq!("patches:7..8".parse(), Ok(Window::Patches(7..8)));
        for wrong in [
            "",
            "cycles",
            "cycles:",
            "cycles:1",
            "cycles:1..",
            "cycles:..5",
            "cycles:5..5",
            "cycles:6..5",
            "cycles:+1..5",
            "cycles:-1..5",
            "cycles:1.0..5",
            "frames:1..5",
            "cycles:1..=5",
            "cycles:0..18446744073709551616",
            "patches:0..4294967296",
            "cycles: 1..5",
        ] {
            assert!(wrong.parse::<Window>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_queue_holds_what_was_pushed_a_cycle_later() {
        let queue = Queue { before: 1, pushed: vec![3, 4, 7, 9], popped: vec![4, 5, 9] };
        let levels: Vec<_> = queue.levels(&(2..10)).collect();
        // At 5 one has come and one has gone; what happens in 9 is seen in 10, which is outside.
        assert_eq!(levels, [(2, 1), (4, 2), (6, 1), (8, 2)]);
    }
}
