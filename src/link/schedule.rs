//! What the host sends and device memory brings, in cycles: the first two blocks of every chain.
//!
//! ```text
//!   host ─► link ─► memory ─► points, one a cycle
//!           parcel: a command, or     resident points are read in bursts; others are on chip
//!           a read request's share    from when their command crossed the link
//! ```
//!
//! A parcel holds the link while its bytes cross and is complete when the last one has; under
//! `pull` it comes the link's latency after its request, and requests hold the way up.

use super::wire::Wire;
use crate::config::{Channels, Config, TransferMode};
use rtl_model::time::{Cost, LaneOrder, Shape};

/// What crosses the link at once, and what memory does for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parcel {
    /// Bytes towards the device, framing included.
    pub down: u64,
    /// Bytes of read requests towards the host.
    pub up: u32,
    /// Control points of a patch to be handed on, at most 16.
    pub points: u8,
    /// Bytes of the bursts to be read for them, where they are resident.
    pub read: u32,
    /// Bytes of the bursts to be written: an upload.
    pub written: u32,
}

/// The link's cycles.
#[derive(Clone, Debug)]
pub struct LinkSchedule {
    down: Wire,
    up: Wire,
    latency: u64,
    shape: Shape,
}

impl LinkSchedule {
    /// The link of a configuration.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        let link = &config.link;
        let (latency, in_flight) = match link.transfer {
            TransferMode::Push => (0, 2), // one crosses, one is handed on
            TransferMode::Pull => (link.latency.into(), link.outstanding),
        };
        Self {
            down: Wire::new(link.bandwidth_mb_s, config.clock_mhz),
            up: Wire::new(link.upstream_mb_s, config.clock_mhz),
            latency,
            shape: one_lane(1, in_flight),
        }
    }

    /// How it stands in the chain.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// A parcel: until the next can start, and until this one has arrived. What has no bytes, the
    /// fetch of a patch, takes a cycle of the command processor.
    pub fn accept(&mut self, parcel: &Parcel) -> Cost {
        let down = self.down.occupy(parcel.down);
        let up = self.up.occupy(parcel.up.into());
        let latency = if parcel.up > 0 { self.latency } else { 0 };
        Cost { interval: down.max(up).max(1), latency: latency + down }
    }
}

/// Memory's cycles.
#[derive(Clone, Debug)]
pub struct MemorySchedule {
    reads: Wire,
    writes: Wire,
    /// The link's, for an upload is written as it arrives.
    arrives: Wire,
    latency: u64,
    shape: Shape,
}

impl MemorySchedule {
    /// The memory of a configuration, and the FIFO of commands before it.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        let memory = &config.memory;
        let wire = Wire::new(memory.bandwidth_mb_s, config.clock_mhz);
        // `outstanding` counts bursts; a patch takes those of 16 points of 16 bytes.
        let bursts = 256_u32.div_ceil(memory.burst);
        let shape = one_lane(memory.fifo, (memory.outstanding / bursts).max(1));
        Self {
            reads: wire,
            writes: wire,
            arrives: Wire::new(config.link.bandwidth_mb_s, config.clock_mhz),
            latency: memory.latency.into(),
            shape: Shape { shares_port: memory.channels == Channels::Shared, ..shape },
        }
    }

    /// How it stands in the chain.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The cycles for which a parcel holds the port, where reads and writes share it.
    #[must_use]
    pub fn port(&self, parcel: &Parcel) -> Option<u64> {
        let bytes = parcel.read.max(parcel.written);
        (bytes > 0).then(|| self.reads.whole_cycles(bytes.into()))
    }

    /// A parcel: until the next can be accepted; when its points leave says [`Points::offset`]. An
    /// upload is posted: where reads have a channel of their own, it holds up what follows only as
    /// far as memory is slower than the link.
    pub fn accept(&mut self, parcel: &Parcel) -> Points {
        let shared = self.shape.shares_port;
        let cycles = if parcel.read > 0 { self.reads.occupy(parcel.read.into()) } else { 0 };
        let written = self.writes.occupy(parcel.written.into());
        let arrives = self.arrives.occupy(parcel.down);
        let upload = if shared { 0 } else { written.saturating_sub(arrives) };
        let count = u64::from(parcel.points);
        let latency = if parcel.read > 0 { self.latency } else { 0 };
        Points { latency, cycles, count, interval: cycles.max(count).max(upload).max(1) }
    }
}

/// When the points of a patch leave memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Points {
    latency: u64,
    /// Cycles that the reads take.
    cycles: u64,
    count: u64,
    interval: u64,
}

impl Points {
    /// The offset of point `k`: one a cycle, and each when its bytes have been read.
    #[must_use]
    pub fn offset(&self, k: u64) -> u64 {
        self.latency + (k + 1).max(((k + 1) * self.cycles).div_ceil(self.count.max(1)))
    }

    /// What the parcel cost.
    #[must_use]
    pub fn cost(&self) -> Cost {
        Cost { interval: self.interval, latency: self.latency + self.interval }
    }
}

fn one_lane(depth: u32, in_flight: u32) -> Shape {
    Shape { depth, in_flight, lanes: 1, order: LaneOrder::FirstFree, shares_port: false }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn config() -> Config {
        let mut config = Config { clock_mhz: 1000, ..Config::default() };
        config.link.bandwidth_mb_s = 8000; // 8 bytes a cycle
        config.memory.bandwidth_mb_s = 64_000; // 64 bytes a cycle
        config
    }

    #[test]
    fn a_parcel_arrives_when_its_last_byte_has() {
        let mut link = LinkSchedule::new(&config());
        let parcel = |down, up| Parcel { down, up, ..Parcel::default() };
        assert_eq!(link.accept(&parcel(80, 0)), Cost { interval: 10, latency: 10 });
        assert_eq!(link.accept(&Parcel::default()), Cost { interval: 1, latency: 0 });
        let mut pull = config();
        pull.link.transfer = TransferMode::Pull;
        (pull.link.upstream_mb_s, pull.link.latency, pull.link.outstanding) = (1000, 500, 7);
        let mut link = LinkSchedule::new(&pull);
        assert_eq!(link.shape().in_flight, 7);
        // 24 bytes of request take longer than 80 of data: 1 byte a cycle against 8.
        assert_eq!(link.accept(&parcel(80, 24)), Cost { interval: 24, latency: 510 });
    }

    #[test]
    fn points_come_one_a_cycle_and_no_sooner_than_they_are_read() {
        let mut memory = MemorySchedule::new(&config());
        let on_chip = memory.accept(&Parcel { points: 16, ..Parcel::default() });
        assert_eq!([0, 15].map(|k| on_chip.offset(k)), [1, 16]);
        assert_eq!(on_chip.cost().interval, 16);
        let fast = memory.accept(&Parcel { points: 16, read: 192, ..Parcel::default() });
        assert_eq!([0, 15].map(|k| fast.offset(k)), [401, 416]);
        let mut slow = config();
        slow.memory.bandwidth_mb_s = 4000;
        let slow = MemorySchedule::new(&slow).accept(&Parcel {
            points: 16,
            read: 192,
            ..Parcel::default()
        });
        // 48 cycles for 16 points: one every third.
        assert_eq!([0, 1, 15].map(|k| slow.offset(k)), [403, 406, 448]);
        assert_eq!(slow.cost(), Cost { interval: 48, latency: 448 });
    }

    #[test]
    fn an_upload_holds_up_what_follows_as_far_as_memory_is_slower_than_the_link() {
        let upload = Parcel { down: 800, written: 640, ..Parcel::default() };
        assert_eq!(MemorySchedule::new(&config()).accept(&upload).cost().interval, 1);
        let mut slow = config();
        slow.memory.bandwidth_mb_s = 1000;
        assert_eq!(MemorySchedule::new(&slow).accept(&upload).cost().interval, 640 - 100);
        slow.memory.channels = Channels::Shared;
        let mut shared = MemorySchedule::new(&slow);
        assert_eq!(shared.port(&upload), Some(640));
        assert_eq!(shared.port(&Parcel::default()), None);
        assert_eq!(shared.accept(&upload).cost().interval, 1, "the port is what it holds");
    }
}
