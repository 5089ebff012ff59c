//! The rows that every block of a timed chain has besides its own counters: tokens, arithmetic, the
//! FIFO before it, and where its cycles went.
//!
//! A table of the same form as the counters' own, with one line for all blocks; [`rows`] says which
//! of them a block has at its place in the chain, and what its neighbours make of their names.
//! [`check`] holds the laws.

use super::{Block, Measure};
use crate::time::{FrameTimes, Shape, StageTimes};

/// A block of the timed chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// The block.
    pub block: Block,
    /// How it stands in the chain.
    pub shape: Shape,
}

/// Arithmetic operations, and what they cost: an adder and a comparator grow with the width of
/// their operands, a multiplier with the product of both widths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ops {
    /// Additions and subtractions.
    pub add: u64,
    /// Their widths, added up.
    pub add_bits: u64,
    /// Multiplications.
    pub mul: u64,
    /// The products of their operands' widths, added up.
    pub mul_bits: u64,
    /// Comparisons, and tests of a sign.
    pub compare: u64,
    /// Their widths, added up.
    pub compare_bits: u64,
}

impl Ops {
    /// With `n` more additions of `width` bits.
    #[must_use]
    pub fn adds(self, n: u64, width: u64) -> Self {
        Self { add: self.add + n, add_bits: self.add_bits + n * width, ..self }
    }

    /// With `n` more multiplications of `a` by `b` bits.
    #[must_use]
    pub fn muls(self, n: u64, a: u64, b: u64) -> Self {
        Self { mul: self.mul + n, mul_bits: self.mul_bits + n * a * b, ..self }
    }

    /// With `n` more comparisons of `width` bits.
    #[must_use]
    pub fn compares(self, n: u64, width: u64) -> Self {
        Self { compare: self.compare + n, compare_bits: self.compare_bits + n * width, ..self }
    }

    /// With those of `other`, `n` times.
    ///
    /// # Panics
    /// When a sum exceeds 64 bits.
    #[must_use]
    pub fn with(self, n: u64, other: Self) -> Self {
        let sum = |a: u64, b: u64| {
            b.checked_mul(n).and_then(|b| a.checked_add(b)).expect("a row stays within 64 bits")
        };
        Self {
            add: sum(self.add, other.add),
            add_bits: sum(self.add_bits, other.add_bits),
            mul: sum(self.mul, other.mul),
            mul_bits: sum(self.mul_bits, other.mul_bits),
            compare: sum(self.compare, other.compare),
            compare_bits: sum(self.compare_bits, other.compare_bits),
        }
    }
}

/// What a block of the chain did, whichever engine ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Tokens accepted.
    pub tokens_in: u64,
    /// Tokens emitted.
    pub tokens_out: u64,
    /// Its arithmetic; `None` where the block has none of its own.
    pub ops: Option<Ops>,
}

/// What a standard row holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// [`Work::tokens_in`].
    TokensIn,
    /// [`Work::tokens_out`].
    TokensOut,
    /// [`Ops::add`].
    Add,
    /// [`Ops::add_bits`].
    AddBits,
    /// [`Ops::mul`].
    Mul,
    /// [`Ops::mul_bits`].
    MulBits,
    /// [`Ops::compare`].
    Compare,
    /// [`Ops::compare_bits`].
    CompareBits,
    /// [`StageTimes::fifo_peak`].
    FifoPeak,
    /// [`StageTimes::busy`].
    Busy,
    /// Starved for either reason.
    Starved,
    /// [`StageTimes::starved`]: the name ends in the block upstream, or `host`.
    StarvedByUpstream,
    /// [`StageTimes::starved_by_port`].
    StarvedByPort,
    /// Blocked for either reason.
    Blocked,
    /// [`StageTimes::blocked`]: the name ends in the block downstream.
    BlockedByDownstream,
    /// [`StageTimes::blocked_by_order`].
    BlockedByOrder,
    /// [`StageTimes::total`].
    Total,
    /// [`StageTimes::used`].
    Used,
}

impl Quantity {
    /// The row's value; `None` where the block has no such row: no arithmetic, or no engine that
    /// could have timed it.
    #[must_use]
    pub fn value(self, work: &Work, times: Option<&StageTimes>) -> Option<u64> {
        Some(match self {
            Self::TokensIn => work.tokens_in,
            Self::TokensOut => work.tokens_out,
            Self::Add => work.ops?.add,
            Self::AddBits => work.ops?.add_bits,
            Self::Mul => work.ops?.mul,
            Self::MulBits => work.ops?.mul_bits,
            Self::Compare => work.ops?.compare,
            Self::CompareBits => work.ops?.compare_bits,
            Self::FifoPeak => times?.fifo_peak,
            Self::Busy => times?.busy,
            Self::Starved => times?.starved + times?.starved_by_port,
            Self::StarvedByUpstream => times?.starved,
            Self::StarvedByPort => times?.starved_by_port,
            Self::Blocked => times?.blocked + times?.blocked_by_order,
            Self::BlockedByDownstream => times?.blocked,
            Self::BlockedByOrder => times?.blocked_by_order,
            Self::Total => times?.total,
            Self::Used => times?.used,
        })
    }

    /// Whether it counts arithmetic.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        use Quantity::{Add, AddBits, Compare, CompareBits, Mul, MulBits};
        matches!(self, Add | AddBits | Mul | MulBits | Compare | CompareBits)
    }
}

/// The declaration of a standard row.
#[derive(Clone, Copy, Debug)]
pub struct Standard {
    /// What it holds.
    pub quantity: Quantity,
    /// Its name; where it ends in a point, the neighbour's name follows.
    pub name: &'static str,
    /// Its measure.
    pub measure: Measure,
    /// What exactly is counted.
    pub meaning: &'static str,
    /// The conservation law that it takes part in; empty where it has none.
    pub law: &'static str,
}

const fn row(
    quantity: Quantity,
    name: &'static str,
    measure: Measure,
    meaning: &'static str,
    law: &'static str,
) -> Standard {
    Standard { quantity, name, measure, meaning, law }
}

/// Every standard row, in the order of reports.
pub const STANDARD: &[Standard] = {
    use Measure::{Bits, Count, Cycles, Entries};
    use Quantity as Q;
    const TOTAL: &str = "busy + starved + blocked = total";
    &[
        row(
            Q::TokensIn,
            "tokens.in",
            Count,
            "tokens that the block accepted",
            "= tokens.out of the block upstream",
        ),
        row(
            Q::TokensOut,
            "tokens.out",
            Count,
            "tokens that the block emitted",
            "= tokens.in of the block downstream",
        ),
        row(Q::Add, "ops.add", Count, "additions and subtractions", ""),
        row(Q::AddBits, "ops.add.bits", Bits, "widths of the adders, added up", ">= ops.add"),
        row(Q::Mul, "ops.mul", Count, "multiplications", ""),
        row(
            Q::MulBits,
            "ops.mul.bits",
            Bits,
            "products of the widths of a multiplier's operands, added up",
            ">= ops.mul",
        ),
        row(Q::Compare, "ops.compare", Count, "comparisons, and tests of a sign", ""),
        row(
            Q::CompareBits,
            "ops.compare.bits",
            Bits,
            "widths of the comparators, added up",
            ">= ops.compare",
        ),
        row(
            Q::FifoPeak,
            "fifo.peak",
            Entries,
            "most tokens that the FIFO before the block held at once",
            "<= the FIFO's depth",
        ),
        row(
            Q::Busy,
            "cycles.busy",
            Cycles,
            "lane-cycles with a token in flight that nothing held up",
            TOTAL,
        ),
        row(
            Q::Starved,
            "cycles.starved",
            Cycles,
            "lane-cycles with nothing in flight",
            "= sum of cycles.starved.by.*",
        ),
        row(
            Q::StarvedByUpstream,
            "cycles.starved.by.",
            Cycles,
            "of those, no token had arrived from this block (host: from outside)",
            "",
        ),
        row(
            Q::StarvedByPort,
            "cycles.starved.by.memory_port",
            Cycles,
            "of those, a token had arrived and waited for the shared memory port",
            "",
        ),
        row(
            Q::Blocked,
            "cycles.blocked",
            Cycles,
            "lane-cycles with a finished output that could not leave",
            "= sum of cycles.blocked.by.*",
        ),
        row(
            Q::BlockedByDownstream,
            "cycles.blocked.by.",
            Cycles,
            "of those, the FIFO before this block had no room",
            "",
        ),
        row(
            Q::BlockedByOrder,
            "cycles.blocked.by.order",
            Cycles,
            "of those, earlier tokens in other lanes had to leave first",
            "",
        ),
        row(Q::Total, "cycles.total", Cycles, "elapsed cycles x lanes", TOTAL),
        row(
            Q::Used,
            "cycles.used",
            Cycles,
            "lane-cycles within the initiation interval of a token; over total, the utilisation",
            "<= busy + blocked; where frames overlap, over the run",
        ),
    ]
};

/// What the block `unit` reports of time.
pub const ELAPSED: Standard = row(
    Quantity::Total,
    "cycles.total",
    Measure::Cycles,
    "cycles from the first acceptance to the last output; frames add up",
    "= cycles.total of a block with one lane",
);

/// The rows that stage `k` of a chain may have, with their full names, in the order of reports.
/// Those without a value ([`Quantity::value`]) are left out of a report.
pub fn rows(chain: &[Stage], k: usize) -> impl Iterator<Item = (String, &'static Standard)> {
    let name = |stage: &Stage| stage.block.name();
    let upstream = k.checked_sub(1).and_then(|k| chain.get(k)).map_or("host", name);
    let downstream = chain.get(k + 1).map(name);
    let shape = chain[k].shape;
    STANDARD.iter().filter_map(move |row| {
        let name = match row.quantity {
            Quantity::FifoPeak if k == 0 => return None,
            Quantity::StarvedByPort if !shape.shares_port => return None,
            Quantity::BlockedByOrder if shape.lanes == 1 => return None,
            Quantity::StarvedByUpstream => format!("{}{upstream}", row.name),
            Quantity::BlockedByDownstream => format!("{}{}", row.name, downstream?),
            _ => row.name.to_owned(),
        };
        Some((name, row))
    })
}

/// Holds what the engine says of a frame against the laws, and against what the blocks did.
///
/// # Panics
/// When they do not agree: the engine, or the counting of tokens, is wrong.
pub fn check(chain: &[Stage], works: &[Work], times: &FrameTimes) {
    assert_eq!(times.stages.len(), chain.len(), "every block of the chain is timed");
    for (k, ((stage, work), t)) in chain.iter().zip(works).zip(&times.stages).enumerate() {
        let name = stage.block.name();
        let parts = [t.busy, t.starved, t.starved_by_port, t.blocked, t.blocked_by_order];
        let sum: u64 = parts.iter().sum();
        assert_eq!(sum, t.total, "{name}: busy + starved + blocked = total, {t:?}");
        assert_eq!(t.tokens_in, work.tokens_in, "{name}: tokens accepted, timed and counted");
        assert_eq!(t.tokens_out, work.tokens_out, "{name}: tokens emitted, timed and counted");
        // What has no row of its own would be missing from the sum of the rows.
        let Shape { depth, lanes, shares_port, .. } = stage.shape;
        assert!(shares_port || t.starved_by_port == 0, "{name} shares no memory port: {t:?}");
        assert!(lanes > 1 || t.blocked_by_order == 0, "{name} has one lane: {t:?}");
        assert!(k + 1 < chain.len() || t.blocked == 0, "{name}: nothing blocks the end: {t:?}");
        let room = if k == 0 { 0 } else { u64::from(depth) };
        assert!(t.fifo_peak <= room, "{name}: {} entries of {room}", t.fifo_peak);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::LaneOrder;

    fn stage(block: Block, lanes: u32, shares_port: bool) -> Stage {
        let order = LaneOrder::FirstFree;
        Stage { block, shape: Shape { depth: 4, in_flight: 2, lanes, order, shares_port } }
    }

    fn names(chain: &[Stage], k: usize, from: &str) -> Vec<String> {
        rows(chain, k).map(|(name, _)| name).filter(|name| name.starts_with(from)).collect()
    }

    fn chain() -> [Stage; 3] {
        [
            stage(Block::Link, 1, false),
            stage(Block::Memory, 1, true),
            stage(Block::Transform, 3, false),
        ]
    }

    #[test]
    fn rows_bear_the_names_of_the_neighbours_and_exist_where_they_can_count() {
        let chain = chain();
        assert_eq!(names(&chain, 0, "cycles.starved."), ["cycles.starved.by.host"]);
        assert_eq!(names(&chain, 0, "cycles.blocked."), ["cycles.blocked.by.memory"]);
        assert_eq!(
            names(&chain, 1, "cycles.starved."),
            ["cycles.starved.by.link", "cycles.starved.by.memory_port"]
        );
        assert_eq!(names(&chain, 2, "cycles.blocked."), ["cycles.blocked.by.order"]);
        assert_eq!(names(&chain, 0, "fifo"), Vec::<String>::new());
        assert_eq!(names(&chain, 1, "fifo"), ["fifo.peak"]);
        let mut all = names(&chain, 1, "");
        let count = all.len();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), count, "names are distinct");
    }

    #[test]
    fn values_are_those_of_the_work_and_of_the_times() {
        let ops = Ops::default().adds(2, 8).muls(3, 4, 5).compares(1, 7);
        assert_eq!((ops.add_bits, ops.mul_bits, ops.compare_bits), (16, 60, 7));
        let work = Work { tokens_in: 1, tokens_out: 2, ops: Some(Ops::default().with(10, ops)) };
        let times = StageTimes {
            busy: 3,
            starved: 4,
            starved_by_port: 5,
            blocked: 6,
            blocked_by_order: 7,
            total: 25,
            used: 2,
            tokens_in: 1,
            tokens_out: 2,
            fifo_peak: 8,
        };
        let values: Vec<_> =
            STANDARD.iter().map(|row| row.quantity.value(&work, Some(&times)).unwrap()).collect();
        assert_eq!(values, [1, 2, 20, 160, 30, 600, 10, 70, 8, 3, 9, 4, 5, 13, 6, 7, 25, 2]);
        let without = Work { ops: None, ..work };
        let left = STANDARD.iter().filter(|row| row.quantity.value(&without, None).is_some());
        assert_eq!(left.count(), 2, "tokens need neither arithmetic nor an engine");
    }

    fn lawful() -> ([Work; 3], FrameTimes) {
        let work = |tokens_in, tokens_out| Work { tokens_in, tokens_out, ops: None };
        let times = |work: Work, lanes: u64| StageTimes {
            busy: 6 * lanes,
            starved: 4 * lanes,
            total: 10 * lanes,
            tokens_in: work.tokens_in,
            tokens_out: work.tokens_out,
            ..StageTimes::default()
        };
        let works = [work(1, 2), work(2, 3), work(3, 3)];
        let stages = vec![times(works[0], 1), times(works[1], 1), times(works[2], 3)];
        (works, FrameTimes { elapsed: 10, stages })
    }

    #[test]
    fn what_keeps_the_laws_passes_and_each_violation_is_caught() {
        let (works, times) = lawful();
        check(&chain(), &works, &times);
        type Harm = fn(&mut FrameTimes);
        let harms: [Harm; 8] = [
            |t| t.stages[0].busy += 1,
            |t| t.stages[1].total -= 1,
            |t| t.stages[1].tokens_in += 1,
            |t| t.stages[2].tokens_out += 1,
            |t| (t.stages[0].starved, t.stages[0].starved_by_port) = (3, 1), // it shares no port
            |t| (t.stages[1].busy, t.stages[1].blocked_by_order) = (5, 1),   // it has one lane
            |t| (t.stages[2].busy, t.stages[2].blocked) = (17, 1),           // it is the last
            |t| t.stages[1].fifo_peak = 5,
        ];
        for (number, harm) in harms.iter().enumerate() {
            let (works, mut times) = lawful();
            harm(&mut times);
            let caught = std::panic::catch_unwind(|| check(&chain(), &works, &times));
            assert!(caught.is_err(), "violation {number} passes");
        }
    }
}
