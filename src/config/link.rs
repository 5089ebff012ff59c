//! The link from the host and device memory, as data: bandwidths, latencies, and how bytes are cut
//! into packets, requests and bursts. A bus by its name stands for the numbers that belong to it.
//!
//! Rates of AGP are those of AGP 2.0 and 3.0 (32 bits at 66.67 MHz, 1 to 8 times a clock); those of
//! PCIe follow from transfers a second and the line code. Sizes of packets are assumptions about
//! what hosts of the time set up.

use crate::error::nearest;
use serde::{Deserialize, Serialize};

/// Greatest bandwidth in 10^6 bytes a second.
pub const BANDWIDTH_MAX: u32 = 10_000_000;

/// The link from the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Link {
    /// The bus that the numbers were taken from, a label only: the numbers say what holds.
    /// Where a configuration is read, naming a bus sets them all ([`Self::take`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bus: Option<Bus>,
    /// Bandwidth towards the device, 10^6 bytes a second, 1..=[`BANDWIDTH_MAX`].
    pub bandwidth_mb_s: u32,
    /// Bandwidth towards the host, which carries read requests, likewise.
    pub upstream_mb_s: u32,
    /// Largest payload of a packet in bytes; 0: the link is not packetised.
    pub payload: u32,
    /// Framing of a packet in bytes.
    pub header: u32,
    /// Who moves the data.
    pub transfer: TransferMode,
    /// Most bytes that one read asks for.
    pub request: u32,
    /// Bytes of a read request, upstream.
    pub request_header: u32,
    /// Most bytes that one completion of a read brings; 0: completions are not packetised.
    pub completion: u32,
    /// Framing of a completion in bytes.
    pub completion_header: u32,
    /// Cycles from a read request to its first data, under `pull`.
    pub latency: u32,
    /// Read requests under way at once, under `pull`.
    pub outstanding: u32,
}

/// Who moves data from the host's memory to the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TransferMode {
    /// The host writes: posted, each packet with its header, nothing comes back.
    #[default]
    Push,
    /// The device reads: requests go upstream, completions bring the data.
    Pull,
}

/// Device memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Memory {
    /// Bytes of a burst.
    pub burst: u32,
    /// Bandwidth of a channel, 10^6 bytes a second, 1..=[`BANDWIDTH_MAX`].
    pub bandwidth_mb_s: u32,
    /// Cycles from a read to its data.
    pub latency: u32,
    /// Reads under way at once, of a burst each.
    pub outstanding: u32,
    /// Whether reads and writes have a channel each.
    pub channels: Channels,
    /// Commands in the FIFO before memory.
    pub fifo: u32,
}

/// Which channels reads and writes of memory have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channels {
    /// One each, of the full bandwidth.
    #[default]
    Separate,
    /// One port: the stages that use it take turns.
    Shared,
}

impl Default for Link {
    /// PCIe 4 x16 at 2 GHz.
    fn default() -> Self {
        Self::of(Bus::PCIE4X16, 2000)
    }
}

impl Default for Memory {
    /// That of the preset `modern`.
    fn default() -> Self {
        Self {
            burst: 32,
            bandwidth_mb_s: 448_000,
            latency: 400,
            outstanding: 4096,
            channels: Channels::Separate,
            fifo: 4,
        }
    }
}

/// A link by its name: an AGP rate, or a generation of PCIe and its lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Bus(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Agp { rate: u32 },
    Pcie { generation: u32, lanes: u32 },
}

impl Bus {
    /// AGP 4x, 2001.
    pub const AGP4X: Self = Self(Kind::Agp { rate: 4 });
    /// PCIe 2 x16, 2007.
    pub const PCIE2X16: Self = Self(Kind::Pcie { generation: 2, lanes: 16 });
    /// PCIe 4 x16, 2017.
    pub const PCIE4X16: Self = Self(Kind::Pcie { generation: 4, lanes: 16 });

    /// Every bus: AGP at its four rates, PCIe of six generations with 1 to 16 lanes.
    pub fn all() -> impl Iterator<Item = Self> {
        let agp = [1, 2, 4, 8].map(|rate| Self(Kind::Agp { rate }));
        let pcie = (1..=6).flat_map(|generation| {
            [1, 2, 4, 8, 16].map(|lanes| Self(Kind::Pcie { generation, lanes }))
        });
        agp.into_iter().chain(pcie)
    }

    /// Its name: `agp4x`, `pcie4x16`.
    #[must_use]
    pub fn name(self) -> String {
        match self.0 {
            Kind::Agp { rate } => format!("agp{rate}x"),
            Kind::Pcie { generation, lanes } => format!("pcie{generation}x{lanes}"),
        }
    }

    /// The bus of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|bus| bus.name() == name)
    }

    /// The name that comes nearest to `name`.
    #[must_use]
    pub fn nearest(name: &str) -> String {
        nearest(name, Self::all().map(Self::name)).expect("there are buses")
    }

    /// Bandwidth towards the device, 10^6 bytes a second, to the nearest below (AGP, as it is
    /// always quoted) or the nearest (PCIe: within 0.05 %).
    #[must_use]
    pub const fn bandwidth_mb_s(self) -> u32 {
        match self.0 {
            // 4 bytes, `rate` times in each cycle of 66 2/3 MHz.
            Kind::Agp { rate } => rate * 800 / 3,
            Kind::Pcie { generation, lanes } => {
                // 10^6 transfers a second of a lane, a bit each; what of it the line code leaves.
                let (rate, used, sent) = match generation {
                    1 => (2_500, 8, 10),
                    2 => (5_000, 8, 10),
                    3 => (8_000, 128, 130),
                    4 => (16_000, 128, 130),
                    5 => (32_000, 128, 130),
                    // Flits of 256 bytes, of which link layer, check and error correction take 20.
                    _ => (64_000, 236, 256),
                };
                let (over, under) = (lanes * rate * used, 8 * sent);
                (over + under / 2) / under
            }
        }
    }
}

impl TryFrom<String> for Bus {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        Self::named(&name).ok_or_else(|| format!("no bus is called {name}"))
    }
}

impl From<Bus> for String {
    fn from(bus: Bus) -> Self {
        bus.name()
    }
}

impl Link {
    /// A link over `bus`, pushed; its latency in cycles of a clock of `clock_mhz`.
    ///
    /// 500 ns is assumed from a read request to its data (host bridge, memory and back), and as
    /// many requests under way as the bus is commonly set up for: 32 in AGP's queue and with
    /// PCIe's 5-bit tags, 64 of the 256 of its 8-bit tags. At all of the named buses' full
    /// bandwidth but that of PCIe 6 x16 this covers the latency.
    #[must_use]
    pub fn of(bus: Bus, clock_mhz: u32) -> Self {
        let outstanding = match bus.0 {
            Kind::Agp { .. } | Kind::Pcie { generation: 1 | 2, .. } => 32,
            Kind::Pcie { .. } => 64,
        };
        let mut link = Self {
            bus: None,
            bandwidth_mb_s: 0,
            upstream_mb_s: 0,
            payload: 0,
            header: 0,
            transfer: TransferMode::Push,
            request: 0,
            request_header: 0,
            completion: 0,
            completion_header: 0,
            latency: clock_mhz / 2,
            outstanding,
        };
        link.take(bus);
        link
    }

    /// Takes all that `bus` says of a link: bandwidths, packets, requests and completions. What is
    /// left are the mode, and latency and outstanding reads, which are the two ends'.
    pub fn take(&mut self, bus: Bus) {
        self.bus = Some(bus);
        self.bandwidth_mb_s = bus.bandwidth_mb_s();
        match bus.0 {
            // Bursts of quadwords without packets or framing (AGP 2.0, sec. 3). A read asks for at
            // most 64 bytes, by at most four 16-bit commands on the sideband port: 8 of the 32 bits
            // beside the data, at the same rate.
            Kind::Agp { rate } => {
                self.upstream_mb_s = rate * 200 / 3;
                (self.payload, self.header) = (0, 0);
                (self.request, self.request_header) = (64, 8);
                (self.completion, self.completion_header) = (0, 0);
            }
            // Full duplex. Root ports settled on payloads of 128 bytes, from the third generation
            // on of 256; reads ask for 512, the default of the maximum read request, and come back
            // cut at 128, a read completion boundary. Header with a 64-bit address 16, of a
            // completion 12; sequence number and LCRC 6 and framing symbols 2, at 128b/130b a
            // framing token of 4 that holds the sequence number. In the flits of generation 6
            // those are the flit's, and were taken off the bandwidth.
            Kind::Pcie { generation, .. } => {
                let framing = if generation < 6 { 8 } else { 0 };
                self.upstream_mb_s = self.bandwidth_mb_s;
                self.payload = if generation < 3 { 128 } else { 256 };
                self.header = 16 + framing;
                (self.request, self.request_header) = (512, 16 + framing);
                (self.completion, self.completion_header) = (128, 12 + framing);
            }
        }
    }

    /// The bus that the numbers were taken from, if they still are that bus's.
    #[must_use]
    pub fn bus(&self) -> Option<Bus> {
        self.bus.filter(|&bus| {
            let mut of_bus = *self;
            of_bus.take(bus);
            of_bus == *self
        })
    }
}

/// The keys that a bus sets.
pub(super) const OF_BUS: [&str; 8] = [
    "link.bandwidth_mb_s",
    "link.upstream_mb_s",
    "link.payload",
    "link.header",
    "link.request",
    "link.request_header",
    "link.completion",
    "link.completion_header",
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn buses_have_the_bandwidths_that_are_quoted() {
        let quoted = [
            ("agp1x", 266),
            ("agp2x", 533),
            ("agp4x", 1066),
            ("agp8x", 2133),
            ("pcie1x1", 250),
            ("pcie1x16", 4000),
            ("pcie2x16", 8000),
            ("pcie3x1", 985),
            ("pcie3x16", 15754),
            ("pcie4x1", 1969),
            ("pcie4x16", 31508),
            ("pcie5x16", 63015),
            ("pcie6x1", 7375),
            ("pcie6x16", 118_000),
        ];
        for (name, bandwidth) in quoted {
            assert_eq!(Bus::named(name).expect(name).bandwidth_mb_s(), bandwidth, "{name}");
        }
        let names: HashSet<_> = Bus::all().map(Bus::name).collect();
        assert_eq!(names.len(), 34);
        for wrong in ["", "agp", "agp3x", "pcie7x16", "pcie4x32", "pcie4", "AGP4X"] {
            assert_eq!(Bus::named(wrong), None, "{wrong}");
        }
        assert_eq!(Bus::nearest("pci4x16"), "pcie4x16");
        assert_eq!(Bus::nearest("agp-4x"), "agp4x");
    }

    #[test]
    fn a_bus_is_a_label_while_the_numbers_are_its_own() {
        for bus in Bus::all() {
            let link = Link::of(bus, 1000);
            assert_eq!(link.bus(), Some(bus));
            assert_eq!((link.latency, link.transfer), (500, TransferMode::Push));
            assert_eq!(Link { latency: 7, outstanding: 1, ..link }.bus(), Some(bus));
            assert_eq!(Link { header: link.header + 1, ..link }.bus(), None);
            let covered = u64::from(link.outstanding) * u64::from(link.request) * 1000 / 500;
            assert_eq!(covered < u64::from(link.bandwidth_mb_s), bus.name() == "pcie6x16");
        }
    }
}
