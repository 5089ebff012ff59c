//! How long bytes hold a wire of some bandwidth, in cycles of the clock. In go transfers one after
//! another, out come their cycles: exact in the long run, by integers only.
//!
//! A wire is one direction of the link, or a channel of memory. A transfer begins where the one
//! before ended, within a cycle if need be; the fraction of a cycle that it is late by is carried,
//! so that after any number of transfers the sum of cycles is the floor of the exact time.

/// A wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    bytes_per_second: u64,
    clock_hz: u64,
    /// What the wire is still busy with at the end of the cycles given so far: a time of
    /// `remainder / bytes_per_second` cycles, below 1.
    remainder: u64,
}

impl Wire {
    /// A wire of `bandwidth_mb_s` 10^6 bytes a second under a clock of `clock_mhz`.
    ///
    /// # Panics
    /// When one of them is 0, which the configuration refuses.
    #[must_use]
    pub fn new(bandwidth_mb_s: u32, clock_mhz: u32) -> Self {
        assert!(bandwidth_mb_s > 0 && clock_mhz > 0, "a wire moves");
        let million = |value: u32| u64::from(value) * 1_000_000;
        Self {
            bytes_per_second: million(bandwidth_mb_s),
            clock_hz: million(clock_mhz),
            remainder: 0,
        }
    }

    /// Cycles that `bytes` take on their own, rounded up.
    #[must_use]
    pub fn whole_cycles(&self, bytes: u64) -> u64 {
        let busy = u128::from(bytes) * u128::from(self.clock_hz);
        u64::try_from(busy.div_ceil(u128::from(self.bytes_per_second))).unwrap_or(u64::MAX)
    }

    /// Cycles until the wire can take the next transfer after one of `bytes`: 0 for no bytes, else
    /// at least 1, for whatever stands before the wire hands over one transfer a cycle. A transfer
    /// that is over within its cycle leaves the rest of the cycle unused: that time is not carried.
    ///
    /// # Panics
    /// When the transfer takes 2^64 cycles.
    pub fn occupy(&mut self, bytes: u64) -> u64 {
        if bytes == 0 {
            return 0;
        }
        // 64 + 37 bits: a configured clock is below 2^37 Hz.
        let busy = u128::from(bytes) * u128::from(self.clock_hz) + u128::from(self.remainder);
        let rate = u128::from(self.bytes_per_second);
        if busy < rate {
            self.remainder = 0;
            return 1;
        }
        self.remainder = (busy % rate) as u64; // below rate, which has 64 bits
        u64::try_from(busy / rate).expect("a transfer ends within 2^64 cycles")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Bus, Config, Link, TransferMode};
    use crate::link::framing::{Framed, Pieces};
    use proptest::prelude::*;

    /// Transfers a second, when `n` of `bytes` go over `bus` one after another.
    fn rate(bus: &str, clock_mhz: u32, bytes: u64) -> u64 {
        let n = 1_000_000;
        let link = Link::of(Bus::named(bus).unwrap(), clock_mhz);
        let mut wire = Wire::new(link.bandwidth_mb_s, clock_mhz);
        let framed = Framed::of(bytes, &link).downstream();
        let cycles: u64 = (0..n).map(|_| wire.occupy(framed)).sum();
        n * u64::from(clock_mhz) * 1_000_000 / cycles
    }

    #[test]
    fn agp_moves_vertices_and_patches_at_the_rates_worked_out_by_hand() {
        for clock_mhz in [200, 250, 500] {
            // 8x, a vertex of 32 bytes: 66.6 million a second.
            assert_eq!(rate("agp8x", clock_mhz, 32) / 100_000, 666, "{clock_mhz} MHz");
            assert_eq!(rate("agp4x", clock_mhz, 32) / 100_000, 333, "{clock_mhz} MHz");
            // 4x, a mesh's patch of 120 bytes: 8.9 million a second, rounded.
            let patches = rate("agp4x", clock_mhz, 120);
            assert_eq!((patches + 50_000) / 100_000, 89, "{clock_mhz} MHz");
        }
    }

    #[test]
    fn the_clock_bounds_what_the_wire_does_not() {
        // 32 bytes of AGP 8x take 0.75 cycles at 50 MHz: one transfer a cycle.
        assert_eq!(rate("agp8x", 50, 32), 50_000_000);
    }

    #[test]
    fn full_packets_leave_pcie_the_share_of_payload_over_payload_and_framing() {
        // Thousandths, rounded: 128 / 152 and 256 / 280.
        for (bus, thousandths) in [("pcie2x16", 842), ("pcie4x16", 914)] {
            let link = Link::of(Bus::named(bus).unwrap(), 1000);
            let (mut bare, mut framed) = (0, 0);
            let (mut bare_wire, mut framed_wire) =
                (Wire::new(link.bandwidth_mb_s, 1000), Wire::new(link.bandwidth_mb_s, 1000));
            let mut command = Pieces::new(&link);
            for _ in 0..100_000 {
                let piece = command.piece(link.payload.into());
                bare += bare_wire.occupy(piece.payload);
                framed += framed_wire.occupy(piece.downstream());
            }
            assert_eq!((1000 * bare + framed / 2) / framed, thousandths, "{bus}");
        }
    }

    #[test]
    fn what_is_late_is_carried_and_what_is_idle_is_not() {
        // 10 bytes a cycle.
        let mut wire = Wire::new(1000, 100);
        let cycles = [17, 1, 1, 17, 17, 0, 7, 10].map(|bytes| wire.occupy(bytes));
        // 1.7: 0.7 late; 0.8 and 0.1 are over within their cycles; 1.7: 0.7 late; 2.4: 0.4 late;
        // nothing; 1.1: 0.1 late; 1.1.
        assert_eq!(cycles, [1, 1, 1, 1, 2, 0, 1, 1]);
    }

    #[test]
    fn the_greatest_transfers_do_not_overflow() {
        let mut wire = Wire::new(10_000_000, 100_000);
        assert_eq!(wire.occupy(u64::MAX), u64::MAX / 100);
        assert_eq!(Wire::new(1, 100_000).occupy(1), 100_000);
    }

    #[test]
    fn reads_under_way_over_the_latency_bound_what_is_pulled() {
        // 64 reads of 512 bytes in 500 ns are 65 536 MB/s, of which the link takes 31 508.
        let link = Link { transfer: TransferMode::Pull, ..Config::default().link };
        let clock_mhz = Config::default().clock_mhz;
        let in_flight = u64::from(link.outstanding) * u64::from(link.request);
        assert_eq!(in_flight * u64::from(clock_mhz) / u64::from(link.latency), 65_536);
        // A read's data hold the wire for 38 cycles of 2 GHz (512 bytes and 4 headers of 20), its
        // request the way up for 1.5.
        let read = Framed::of(512, &link);
        let mut down = Wire::new(link.bandwidth_mb_s, clock_mhz);
        let mut up = Wire::new(link.upstream_mb_s, clock_mhz);
        let total = |wire: &mut Wire, bytes| (0..1000).map(|_| wire.occupy(bytes)).sum::<u64>();
        assert_eq!(total(&mut down, read.downstream()), 592 * 2000 * 1000 / 31_508);
        assert_eq!(total(&mut up, read.request_bytes), 24 * 2000 * 1000 / 31_508);
    }

    proptest! {
        #[test]
        fn the_long_run_is_exact(
            bandwidth in 1u32..2_000_000,
            clock in 1u32..10_000,
            extra in prop::collection::vec(0u64..10_000, 1..50),
        ) {
            let least = u64::from(bandwidth.div_ceil(clock)); // a cycle's bytes, so that none idles
            let mut wire = Wire::new(bandwidth, clock);
            let (mut bytes, mut cycles) = (0, 0);
            for extra in extra {
                bytes += least + extra;
                cycles += wire.occupy(least + extra);
                let exact = u128::from(bytes) * u128::from(clock) / u128::from(bandwidth);
                prop_assert_eq!(u128::from(cycles), exact);
            }
        }

        #[test]
        fn no_transfer_is_faster_than_the_wire_or_slower_by_a_cycle(
            bandwidth in 1u32..2_000_000,
            clock in 1u32..10_000,
            transfers in prop::collection::vec(1u64..2000, 1..50),
        ) {
            let mut wire = Wire::new(bandwidth, clock);
            let cycles: u64 = transfers.iter().map(|&bytes| wire.occupy(bytes)).sum();
            let bytes: u64 = transfers.iter().sum();
            let exact = bytes * u64::from(clock) / u64::from(bandwidth);
            prop_assert!(cycles >= exact && cycles <= exact + transfers.len() as u64);
        }
    }
}
