//! Cache: indices of an indexed mesh in, which of their points must be fetched out.
//!
//! A strict FIFO of transformed points, tagged by index, as the vertex caches of the paper's time
//! were: a hit changes nothing, a miss replaces the oldest entry.

use std::collections::{HashSet, VecDeque};

/// The cache.
#[derive(Clone, Debug)]
pub struct Cache {
    entries: usize,
    order: VecDeque<u32>,
    /// The same indices, to be found.
    held: HashSet<u32>,
}

impl Cache {
    /// An empty cache of so many entries, possibly none.
    #[must_use]
    pub fn new(entries: u32) -> Self {
        Self { entries: entries as usize, order: VecDeque::new(), held: HashSet::new() }
    }

    /// Looks a point up, and holds it from now on. Whether it was held already.
    pub fn fetch(&mut self, index: u32) -> bool {
        if self.held.contains(&index) {
            return true;
        }
        if self.entries > 0 {
            if self.order.len() == self.entries
                && let Some(oldest) = self.order.pop_front()
            {
                self.held.remove(&oldest);
            }
            self.order.push_back(index);
            self.held.insert(index);
        }
        false
    }
}
