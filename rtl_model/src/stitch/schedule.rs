//! Schedule: a strip in, its triangles and the cycles they cost out.
//!
//! The walk's state is registered when a strip is accepted; from the cycle after, a triangle is
//! read off it each cycle. So the walk of a strip of T triangles takes T cycles, and the next strip
//! can be accepted while the last triangle leaves.

use crate::patch::Triangle;
use crate::strip::Strip;
use crate::time::{Cost, Emit};

/// What the stitcher costs, in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// From one triangle to the next, at least 1.
    pub interval: u32,
    /// From a strip's acceptance to its first triangle.
    pub latency: u32,
}

impl Schedule {
    /// Strips that the block holds at once: one is walked while the next one waits, so that no
    /// cycle is lost between them.
    pub const IN_FLIGHT: u32 = 2;

    /// Emits the triangles of `strip`.
    #[inline]
    pub fn accept(&self, strip: &Strip, out: &mut impl Emit<Triangle>) -> Cost {
        let mut offset = u64::from(self.latency);
        strip.for_each(|triangle| {
            out.emit(triangle, offset);
            offset += u64::from(self.interval);
        });
        let interval = u64::from(strip.count()) * u64::from(self.interval);
        Cost { interval, latency: self.latency.into() }
    }
}

impl Default for Schedule {
    /// One triangle a cycle, as the paper has it; the registers of the walk are one cycle.
    fn default() -> Self {
        Self { interval: 1, latency: 1 }
    }
}
