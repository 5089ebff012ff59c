//! Starts: counts of patches in rows on the device in; where each patch's items begin out, on the
//! device and here; and ranges of patches whose items fit a buffer.

use crate::error::Result;
use crate::gpu::{Buffer, Device, Kernel, Settings};
use std::ops::Range;

/// Where each patch's items begin, and behind the last one how many there are.
pub(super) struct Starts {
    /// On the device.
    pub(super) buffer: Buffer,
    /// The same words.
    pub(super) words: Vec<u32>,
}

impl Starts {
    /// The sums of column `column` of so many rows of `stride` words.
    ///
    /// # Errors
    /// What the device objects to.
    pub(super) fn of(
        device: &Device,
        rows: &Buffer,
        count: usize,
        [stride, column]: [usize; 2],
    ) -> Result<Self> {
        let mut settings = Settings { items: 64, ..Settings::default() };
        settings.own[..3].copy_from_slice(&[count as u32, stride as u32, column as u32]);
        let buffer = device.empty(count + 1)?;
        device.run(Kernel::Scan, "scan", &settings, &[rows, &buffer])?;
        let words = device.read(&buffer, 0, count + 1)?;
        Ok(Self { buffer, words })
    }

    /// The items of a range of patches.
    pub(super) fn items(&self, patches: &Range<usize>) -> Range<usize> {
        self.words[patches.start] as usize..self.words[patches.end] as usize
    }

    /// Appends to `all` where this batch's items begin behind what is there.
    pub(super) fn append_to(&self, all: &mut Vec<u32>) {
        let base = all.pop().unwrap_or(0);
        all.extend(self.words.iter().map(|&start| base + start));
    }
}

/// Ranges of patches, as long as may be, of which no list has more than `max` words; a patch that
/// has more by itself is a range by itself. A list is its starts, and words an item.
pub(super) fn ranges(max: usize, lists: &[(&Starts, usize)]) -> Vec<Range<usize>> {
    let patches = lists.first().map_or(0, |(starts, _)| starts.words.len() - 1);
    let fits = |range: &Range<usize>| {
        lists.iter().all(|(starts, words)| starts.items(range).len() * words <= max)
    };
    let mut ranges = Vec::new();
    let mut first = 0;
    for end in 1..=patches {
        if end - first > 1 && !fits(&(first..end)) {
            ranges.push(first..end - 1);
            first = end - 1;
        }
    }
    if first < patches {
        ranges.push(first..patches);
    }
    ranges
}
