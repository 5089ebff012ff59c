//! Cover: which pixels of a viewport some triangle covers. Threads mark side by side; what comes of
//! it does not depend on their order.

use std::sync::atomic::{AtomicU64, Ordering};

/// A bit a pixel.
#[derive(Debug)]
pub struct Cover {
    viewport: [u32; 2],
    /// Words of a row.
    words: usize,
    bits: Vec<AtomicU64>,
}

impl Cover {
    /// No pixel of so many columns and rows.
    #[must_use]
    pub fn new(viewport: [u32; 2]) -> Self {
        let words = (viewport[0] as usize).div_ceil(64);
        let bits = (0..words * viewport[1] as usize).map(|_| AtomicU64::new(0)).collect();
        Self { viewport, words, bits }
    }

    /// Width and height.
    #[must_use]
    pub const fn viewport(&self) -> [u32; 2] {
        self.viewport
    }

    /// Marks the pixels of row `y` from the first to the last column, both included.
    ///
    /// # Panics
    /// When they are not in the viewport.
    pub(super) fn mark(&self, y: u64, [first, last]: [u64; 2]) {
        let row = &self.bits[y as usize * self.words..][..self.words];
        for word in first / 64..=last / 64 {
            let from = first.saturating_sub(64 * word);
            let to = (last - 64 * word).min(63);
            let mask = (u64::MAX >> (63 - to)) & (u64::MAX << from);
            row[word as usize].fetch_or(mask, Ordering::Relaxed);
        }
    }

    /// Pixels that are marked.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        let ones = |word: &AtomicU64| u64::from(word.load(Ordering::Relaxed).count_ones());
        self.bits.iter().map(ones).sum()
    }
}
