//! Random runs: strips of random patches, sources and sinks that stall in phases.

use crate::reference::Run;
use rtl_model::patch::{Level, Levels, ONE};
use rtl_model::place::Placement;
use rtl_model::strip::{Strip, Topology};

/// Random numbers (splitmix64), the same on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below `bound`.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (x ^ x >> 31) % bound
    }

    fn level(&mut self, below: u64) -> Level {
        Level::clamped(u64::from(ONE) + self.below((below - 1) * u64::from(ONE)))
    }

    /// Who stalls in 0, 1, 4, 7 or 8 of 8 cycles, in phases of up to 1024 cycles.
    fn willing(&mut self, cycles: usize) -> Vec<bool> {
        let mut willing = Vec::new();
        while willing.len() < cycles {
            let stalls = [0, 1, 4, 7, 8][self.below(5) as usize];
            // Always stalling is short, or nothing would happen in most cycles.
            let phase = self.below(if stalls == 8 { 128 } else { 1024 });
            willing.extend((0..phase).map(|_| self.below(8) >= stalls));
        }
        willing.truncate(cycles);
        willing
    }

    fn levels(&mut self, below: u64) -> Levels {
        let mut level = || self.level(below);
        Levels { edges: [level(), level(), level(), level()], interior: [level(), level()] }
    }

    /// Appends the strips of one kind of patches.
    fn patches(&mut self, out: &mut Vec<Strip>) {
        let uniform = |edge, interior| Levels { edges: [edge; 4], interior: [interior; 2] };
        let kind = self.below(6);
        let (levels, repeat, part) = match kind {
            0 => (uniform(Level::MIN, Level::TWO), self.below(32), false), // strips of one triangle
            1 => (uniform(Level::MIN, Level::MIN), self.below(8), false),
            2 => (self.levels(2), 1, false),
            3 => (self.levels(9), 1, false),
            4 => (self.levels(128), 1, true),
            _ => (uniform(Level::MAX, Level::MAX), 1, true),
        };
        let mut placement = Placement::default();
        placement.set(&levels);
        let all: Vec<Strip> = placement.segments().strips().collect();
        for _ in 0..repeat {
            out.extend(&all);
        }
        if part {
            // Of a patch of thousands of triangles some strips in a row, from anywhere, and the
            // last ones: sides are few among many.
            let surplus = out.len() - all.len();
            out.truncate(surplus);
            let from = self.below(all.len() as u64) as usize;
            out.extend(all[from..].iter().take(3));
            out.extend(&all[all.len().saturating_sub(self.below(9) as usize)..]);
        }
    }

    /// A run of `cycles`, with as many strips as it can take at most.
    pub(crate) fn run(&mut self, cycles: usize) -> Run {
        let mut strips = Vec::new();
        let triangles = |strips: &[Strip]| strips.iter().map(Strip::count).sum::<u32>() as usize;
        let mut enough = 0;
        while enough < cycles {
            let before = strips.len();
            self.patches(&mut strips);
            enough += triangles(&strips[before..]);
        }
        let depth = 2 + self.below(15) as usize;
        Run { strips, source: self.willing(cycles), sink: self.willing(cycles), depth }
    }
}
