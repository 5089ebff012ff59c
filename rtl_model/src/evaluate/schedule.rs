//! Schedule: what a patch's evaluation takes, and when each of its strips is complete.
//!
//! One curve runs after another, a point every `interval` cycles: the four edges, the four columns
//! of the net, then the interior rows. While a curve runs, the differences of the next one are set
//! up; so a curve takes the longer of the two, and only the first one of a patch is waited for.
//!
//! ```text
//!   set up  │ v0 │ u1 │ v1 │ u0 │ col │ .. │ row 0 │ row 1 │
//!   run          │ v0 │ u1 │ v1 │ u0  │ .. │ col   │ row 0 │ row 1 │
//!   strips                                                 ▲ 0─1    ▲ 1─2, sides
//! ```
//!
//! De Casteljau has nothing to set up: its points come out of a pipeline of linear interpolations.

use super::Scheme;
use crate::strip::{Strip, Topology};
use crate::time::{Cost, Emit};

/// What evaluation costs, in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// From one point to the next, at least 1.
    pub interval: u32,
    /// From a point's last operand to the point.
    pub latency: u32,
    /// To set up a curve's differences, its two half-runs together.
    pub setup: u32,
    /// Which curves have differences.
    pub scheme: Scheme,
}

impl Schedule {
    /// Emits the strips of a patch, each when its rows are complete.
    pub fn accept(&self, lists: impl Topology, out: &mut impl Emit<Strip>) -> Cost {
        let boundary = (0..4).map(|edge| self.edge(lists.edge(edge))).sum::<u64>();
        let [columns, rows] = lists.interior();
        let differences = self.scheme == Scheme::Forward;
        // Without an interior there are neither columns nor rows.
        let column = if columns > 0 { 4 * self.curve(rows, differences) } else { 0 };
        let row = self.curve(columns, differences);
        // A patch is either without an interior, or no edge is without interior rows to wait for.
        let first = if self.scheme == Scheme::DeCasteljau { 0 } else { u64::from(self.setup) };
        let before = first + u64::from(self.latency);
        for strip in lists.strips() {
            let complete = match u64::from(strip.rows_needed) {
                0 => boundary,
                rows => boundary + column + rows * row,
            };
            out.emit(strip, before + complete);
        }
        let interval = boundary + column + rows as u64 * row;
        Cost { interval: interval.max(1), latency: before + interval }
    }

    /// An edge: its first corner, which is copied, and the points between.
    fn edge(&self, segments: usize) -> u64 {
        self.curve(segments, self.scheme != Scheme::DeCasteljau && segments > 1)
    }

    /// A curve of so many points.
    fn curve(&self, points: usize, differences: bool) -> u64 {
        let run = points as u64 * u64::from(self.interval);
        if differences { run.max(self.setup.into()) } else { run }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Level, Levels};
    use crate::place::Placement;

    struct Offsets(Vec<(Strip, u64)>);

    impl Emit<Strip> for Offsets {
        fn emit(&mut self, strip: Strip, offset: u64) {
            self.0.push((strip, offset));
        }
    }

    fn schedule(level: u64, schedule: Schedule) -> (Vec<u64>, Cost) {
        let level = Level::clamped(level << 16);
        let mut placement = Placement::default();
        placement.set(&Levels { edges: [level; 4], interior: [level; 2] });
        let mut out = Offsets(Vec::new());
        let cost = schedule.accept(placement.segments(), &mut out);
        assert!(out.0.iter().map(|(strip, _)| strip.count()).sum::<u32>() > 0);
        (out.0.iter().map(|&(_, offset)| offset).collect(), cost)
    }

    #[test]
    fn a_patch_of_level_4_by_hand() {
        let forward = Schedule { interval: 1, latency: 4, setup: 16, scheme: Scheme::Forward };
        // Eleven curves (four edges of 4, four columns of 3, three rows of 3), each bound by its
        // set-up of 16. Two grid strips behind rows 1 and 2; eight half sides behind row 2.
        let (offsets, cost) = schedule(4, forward);
        let rows = [10 * 16 + 20, 11 * 16 + 20];
        assert_eq!(offsets[..2], rows);
        assert_eq!(offsets[2..], [rows[1]; 8]);
        assert_eq!(cost, Cost { interval: 11 * 16, latency: rows[1] });
        // Bound by the points: 16 on the boundary, 12 on columns, 9 in the interior.
        let (offsets, cost) = schedule(4, Schedule { setup: 2, ..forward });
        assert_eq!(offsets[..2], [16 + 12 + 6 + 6, 16 + 12 + 9 + 6]);
        assert_eq!(cost.interval, 37);
        let (_, cost) = schedule(4, Schedule { scheme: Scheme::DeCasteljau, ..forward });
        assert_eq!(cost, Cost { interval: 37, latency: 41 });
        // Mixed: the edges alone have differences.
        let (_, cost) = schedule(4, Schedule { scheme: Scheme::Mixed, ..forward });
        assert_eq!(cost.interval, 4 * 16 + 12 + 9);
    }

    #[test]
    fn a_patch_of_level_1_copies_its_corners() {
        let forward = Schedule { interval: 2, latency: 4, setup: 16, scheme: Scheme::Forward };
        let (offsets, cost) = schedule(1, forward);
        assert_eq!((offsets, cost.interval), (vec![8 + 20], 8));
    }
}
