//! Work: the open points of a plan shared out among threads, and among processes that know nothing
//! of each other but the folder's locks.
//!
//! Threads of the system, and not of rayon's: a rayon thread that waits for a part of its point
//! takes up other work, such as waiting for a lock, while it holds one. Two processes could so wait
//! for each other for ever.

use super::plan::Plan;
use super::point;
use super::store::{State, Store};
use crate::error::{Error, Result};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashSet;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Which part of the points a machine computes: number `part` of `parts`, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    part: u64,
    parts: u64,
}

impl Shard {
    /// All points.
    pub const WHOLE: Self = Self { part: 1, parts: 1 };

    /// The shard `i/n`.
    ///
    /// # Errors
    /// In words: no two numbers, 1 <= i <= n.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(part, parts)| {
            Some(Self { part: part.parse().ok()?, parts: parts.parse().ok()? })
        });
        let fits = numbers.filter(|shard| 1 <= shard.part && shard.part <= shard.parts);
        fits.ok_or_else(|| "expected i/n with 1 <= i <= n, such as 1/4".to_owned())
    }

    /// Whether a point is of it: by its hash, so that equal points are of the same shard, and new
    /// points in the study move none of the others.
    fn has(self, hash: &str) -> bool {
        let head = u64::from_str_radix(&hash[..16], 16).expect("a hash is hexadecimal");
        head % self.parts == self.part - 1
    }
}

/// What happens while points are computed.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// So many different points are to be settled, of which so many are already.
    Begin {
        /// Points of the shard, equal ones counted once.
        all: usize,
        /// Settled before.
        found: usize,
    },
    /// One more is settled.
    Settled {
        /// Without a result.
        failed: bool,
    },
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Different points of the shard that have a configuration.
    pub all: usize,
    /// Those settled before.
    pub found: usize,
    /// Those computed here, with a result or without.
    pub computed: usize,
    /// Those that other processes settled meanwhile.
    pub by_others: usize,
}

/// Who did it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum By {
    Us,
    Others,
}

/// Settles the open points of a shard, on so many threads, each a point at a time.
///
/// # Errors
/// What is the system's fault: what was begun is ended first, and nothing else is begun.
pub(super) fn work(
    plan: &Plan,
    store: &Store,
    shard: Shard,
    threads: NonZeroUsize,
    watch: &(dyn Fn(Event) + Sync),
) -> Result<Work> {
    let mut seen = HashSet::new();
    let mut open = Vec::new();
    for (number, point) in plan.points.iter().enumerate() {
        let Ok(hash) = &point.hash else { continue };
        if shard.has(hash) && seen.insert(hash) {
            open.push((number, hash.as_str()));
        }
    }
    let all = open.len();
    let mut settled = Vec::with_capacity(all);
    for (_, hash) in &open {
        settled.push(store.settled(hash)?.is_some());
    }
    let mut settled = settled.into_iter();
    open.retain(|_| !settled.next().expect("one a point"));
    let found = all - open.len();
    watch(Event::Begin { all, found });
    let (mut us, mut others) = (0, 0);
    // First what nobody is at; then what others had, once they are through with it or gone.
    for wait in [false, true] {
        let state = Pass { plan, store, wait, open: &open, watch, next: AtomicUsize::new(0) };
        let done = state.go(threads)?;
        us += done.iter().filter(|by| **by == Some(By::Us)).count();
        others += done.iter().filter(|by| **by == Some(By::Others)).count();
        let mut done = done.into_iter();
        open.retain(|_| done.next().expect("one a point").is_none());
    }
    Ok(Work { all, found, computed: us, by_others: others })
}

/// One walk over the open points, by all threads together.
struct Pass<'a> {
    plan: &'a Plan,
    store: &'a Store,
    wait: bool,
    open: &'a [(usize, &'a str)],
    watch: &'a (dyn Fn(Event) + Sync),
    next: AtomicUsize,
}

impl Pass<'_> {
    /// For each point who settled it; none where another process is at it.
    fn go(&self, threads: NonZeroUsize) -> Result<Vec<Option<By>>> {
        let done = Mutex::new(vec![None; self.open.len()]);
        let failure = Mutex::new(None);
        std::thread::scope(|scope| {
            for _ in 0..threads.get().min(self.open.len()) {
                scope.spawn(|| {
                    if let Err(error) = self.thread(&done) {
                        // Nobody finds any more to do.
                        self.next.store(self.open.len(), Ordering::Relaxed);
                        failure.lock().expect("no thread panics").get_or_insert(error);
                    }
                });
            }
        });
        let failure = failure.into_inner().expect("no thread panics");
        failure.map_or(Ok(done.into_inner().expect("no thread panics")), Err)
    }

    fn thread(&self, done: &Mutex<Vec<Option<By>>>) -> Result<()> {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|error| Error::system("threads", std::io::Error::other(error)))?;
        loop {
            let turn = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(&(number, hash)) = self.open.get(turn) else { return Ok(()) };
            let by = self.settle(number, hash, &pool)?;
            done.lock().expect("no thread panics")[turn] = by;
        }
    }

    fn settle(&self, number: usize, hash: &str, pool: &ThreadPool) -> Result<Option<By>> {
        let settled = |state: &State, by| {
            (self.watch)(Event::Settled { failed: matches!(state, State::Failed(_)) });
            Ok(Some(by))
        };
        let Some(claim) = self.store.claim(hash, self.wait)? else { return Ok(None) };
        if let Some(state) = self.store.settled(hash)? {
            return settled(&state, By::Others);
        }
        let (point, place) = (&self.plan.points[number], self.store.point(hash));
        let state = match point::compute(self.plan, point, pool, &place)? {
            Ok(files) => {
                claim.complete(&files)?;
                State::Completed
            }
            Err(reason) => {
                claim.fail(&reason)?;
                State::Failed(reason)
            }
        };
        settled(&state, By::Us)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_two_numbers_and_every_point_is_of_one() {
        assert_eq!(Shard::parse("1/1"), Ok(Shard::WHOLE));
        for wrong in ["", "1", "0/4", "5/4", "1/0", "-1/4", "1/4/2", "a/b", "1 / 4"] {
            assert!(Shard::parse(wrong).unwrap_err().contains("1 <= i <= n"), "{wrong}");
        }
        let mut counts = [0; 3];
        for point in 0..300u64 {
            let hash = format!("{:032x}", u128::from(point) << 64 | 7);
            let of = [1, 2, 3].map(|part| Shard { part, parts: 3 }.has(&hash));
            assert_eq!(of.iter().filter(|of| **of).count(), 1);
            counts[of.iter().position(|of| *of).unwrap()] += 1;
        }
        assert_eq!(counts, [100; 3]);
    }
}
