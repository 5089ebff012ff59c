//! Waves: patches of a draw in, in their order; out go the same patches, the last of each SIMD wave
//! with what the wave takes (unit `esc`).
//!
//! An invocation of the surface shader is a lane of a wave, and a wave runs until its last lane is
//! done. The program has four parts (the coefficients, the tests, the points, the slots of the
//! strips); lanes go through each together, so a part takes as long as its longest lane:
//!
//! ```text
//!              net    tests      points          slots
//!   lane 0     ████   ██████     ██████████      █████         █ busy   · idle
//!   lane 1     ████   ██····     ████······      ███··
//!   no lane    ····   ······     ··········      ·····
//! ```
//!
//! A wave is of one draw, whose instances it may span, and of one batch of patches. It leaves when
//! the next patch's invocations have no lane left, or its draw ends. A patch with more sections
//! than a wave has lanes takes several rounds, each as long as its longest.

use super::chain::{Flow, Invocations, Work};
use super::clock::Fetch;
use super::host::Hosted;
use crate::config::Config;
use rtl_model::counter::{Counter, Counters};
use rtl_model::esc::Phase;

/// A patch that waits for its wave to be complete: what brings it, what became of it, and what the
/// host knows of it where that tessellates.
pub(super) type Waiting<T> = (Fetch, Work<T>, Hosted);

/// Instructions of each part of the program, and cycles of one.
#[derive(Clone, Copy, Debug)]
struct Program {
    interval: u64,
    net: u64,
    test: u64,
    point: u64,
    slot: u64,
}

impl Program {
    fn cycles(&self, phase: &Phase) -> u64 {
        let Self { interval, net, test, point, slot } = *self;
        let parts =
            [(net, phase.nets), (test, phase.tests), (point, phase.points), (slot, phase.slots)];
        interval * parts.iter().map(|&(each, count)| each * u64::from(count)).sum::<u64>()
    }
}

/// Gathers patches until their wave is complete.
#[derive(Clone, Debug)]
pub(super) struct Former<T> {
    program: Program,
    /// Lanes of a wave.
    width: u64,
    /// The draw of the patches that wait.
    draw: u32,
    waiting: Vec<Waiting<T>>,
    /// Where the wave's last patch waits, if any.
    last: Option<usize>,
    /// Invocations of the wave so far; the longest of each part; busy cycles of all lanes.
    invocations: u64,
    longest: Phase,
    busy: u64,
    wave: Invocations,
    /// What all waves took.
    pub(super) counters: Counters,
}

impl<T: Flow> Former<T> {
    pub(super) fn new(config: &Config) -> Self {
        let costs = &config.block.surface;
        let program = Program {
            interval: costs.costs.interval.into(),
            net: costs.net.into(),
            test: costs.test.into(),
            point: costs.point.into(),
            slot: costs.slot.into(),
        };
        Self {
            program,
            width: config.esc.width.into(),
            draw: 0,
            waiting: Vec::new(),
            last: None,
            invocations: 0,
            longest: Phase::default(),
            busy: 0,
            wave: Invocations::default(),
            counters: Counters::default(),
        }
    }

    /// Whether a patch of `draw` must wait until those that wait have gone.
    pub(super) fn ends_at(&self, draw: u32) -> bool {
        !self.waiting.is_empty() && self.draw != draw
    }

    /// Takes in a patch of `draw`. Those whose wave is complete go to `send`.
    pub(super) fn accept(
        &mut self,
        draw: u32,
        patch: Waiting<T>,
        send: &mut dyn FnMut(Waiting<T>),
    ) {
        self.draw = draw;
        let Some(lane) = patch.1.lane() else {
            // It joins no wave, and waits for those before it only.
            return if self.last.is_none() { send(patch) } else { self.waiting.push(patch) };
        };
        let sections = u64::from(lane.phases.sections);
        if self.invocations + sections > self.width {
            self.finish(send);
        }
        self.invocations += sections;
        self.longest = longest(self.longest, lane.phases.most);
        self.busy += self.program.cycles(&lane.phases.sum);
        self.wave.vertices += u64::from(lane.vertices);
        self.wave.triangles += u64::from(lane.triangles);
        self.last = Some(self.waiting.len());
        self.waiting.push(patch);
    }

    /// Ends the wave, if there is one, and sends all that wait.
    pub(super) fn finish(&mut self, send: &mut dyn FnMut(Waiting<T>)) {
        if let Some(last) = self.last.take() {
            let wave = self.close();
            self.waiting[last].1.lists.close(wave);
        }
        self.waiting.drain(..).for_each(send);
    }

    fn close(&mut self) -> Invocations {
        let invocations = std::mem::take(&mut self.invocations);
        let rounds = invocations.div_ceil(self.width);
        let cycles = rounds * self.program.cycles(&std::mem::take(&mut self.longest));
        let (lanes, busy) = (self.width * cycles, std::mem::take(&mut self.busy));
        let counters = &mut self.counters;
        counters.add(Counter::GroupWaves, 1);
        counters.add(Counter::GroupInvocations, invocations);
        counters.add(Counter::GroupRounds, rounds);
        counters.add(Counter::GroupIdle, rounds * self.width - invocations);
        counters.add(Counter::SurfaceLaneCycles, lanes);
        counters.add(Counter::SurfaceUsedCycles, busy);
        counters.add(Counter::SurfaceIdleCycles, lanes - busy);
        Invocations { cycles, ..std::mem::take(&mut self.wave) }
    }
}

/// The longer of both, part by part.
fn longest(a: Phase, b: Phase) -> Phase {
    Phase {
        nets: a.nets.max(b.nets),
        tests: a.tests.max(b.tests),
        points: a.points.max(b.points),
        slots: a.slots.max(b.slots),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::unit::chain::{Fate, Lane, Meshed};
    use rtl_model::esc::Phases;

    /// A cycle an instruction, and an instruction each.
    fn former(width: u32) -> Former<Meshed> {
        let mut config = Config::default();
        config.esc.width = width;
        let surface = &mut config.block.surface;
        (surface.costs.interval, surface.net, surface.test, surface.point, surface.slot) =
            (2, 1, 1, 1, 1);
        Former::new(&config)
    }

    /// A patch of so many sections, of which the longest and all together have so many points.
    fn patch(sections: u32, most: u32, sum: u32) -> Waiting<Meshed> {
        let points = |points| Phase { nets: 0, tests: 0, points, slots: 0 };
        let phases = Phases { sections, most: points(most), sum: points(sum) };
        let lane = Lane { phases, vertices: sum, triangles: 1 };
        let work = Work {
            fate: Fate::Kept,
            lists: Meshed { lane, ..Meshed::default() },
            ..Work::clipped(Meshed::default())
        };
        (Fetch::default(), work, Hosted::default())
    }

    fn culled() -> Waiting<Meshed> {
        (Fetch::default(), Work::clipped(Meshed::default()), Hosted::default())
    }

    /// What the patches are sent as: the vertices of each, and its wave's cycles.
    fn sent(former: &mut Former<Meshed>, patches: &[(u32, Waiting<Meshed>)]) -> Vec<(u64, u64)> {
        let mut out = Vec::new();
        let mut send = |(_, work, _): Waiting<Meshed>| {
            out.push((work.made()[0], work.lists.wave.map_or(0, |wave| wave.cycles)));
        };
        for &(draw, patch) in patches {
            if former.ends_at(draw) {
                former.finish(&mut send);
            }
            former.accept(draw, patch, &mut send);
        }
        former.finish(&mut send);
        out
    }

    #[test]
    fn a_wave_is_as_long_as_its_longest_lane_and_ends_when_it_is_full_or_its_draw_ends() {
        let mut former = former(2);
        let patches = [
            (0, culled()),
            (0, patch(1, 5, 5)),
            (0, culled()),
            (0, patch(1, 3, 3)),
            (0, culled()), // waits with the wave before it
            (0, patch(1, 7, 7)),
            (1, patch(1, 2, 2)),
        ];
        // Two cycles a point.
        let expected = [(0, 0), (5, 0), (0, 0), (3, 10), (0, 0), (7, 14), (2, 4)];
        assert_eq!(sent(&mut former, &patches), expected);
        let get = |counter| former.counters.get(counter);
        assert_eq!((get(Counter::GroupWaves), get(Counter::GroupInvocations)), (3, 4));
        assert_eq!((get(Counter::GroupRounds), get(Counter::GroupIdle)), (3, 2));
        assert_eq!(get(Counter::SurfaceLaneCycles), 2 * (10 + 14 + 4));
        assert_eq!(get(Counter::SurfaceUsedCycles), 2 * (5 + 3 + 7 + 2));
        assert_eq!(get(Counter::SurfaceIdleCycles), 2 * (10 + 14 + 4) - 2 * 17);
    }

    #[test]
    fn sections_are_lanes_of_one_wave_and_of_several_rounds_where_they_are_more() {
        let mut former = former(4);
        let patches = [(0, patch(2, 5, 9)), (0, patch(3, 4, 12)), (0, patch(9, 3, 27))];
        assert_eq!(sent(&mut former, &patches), [(9, 10), (12, 8), (27, 3 * 6)]);
        let get = |counter| former.counters.get(counter);
        assert_eq!((get(Counter::GroupWaves), get(Counter::GroupRounds)), (3, 5));
        assert_eq!(get(Counter::GroupIdle), 5 * 4 - 14);
        assert_eq!(get(Counter::SurfaceLaneCycles), 4 * (10 + 8 + 18));
    }
}
