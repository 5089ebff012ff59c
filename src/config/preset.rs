//! Presets: the documented assumptions about one machine each. In goes a name, out a configuration.
//!
//! A preset says how fast the clock, the link and the memory are, how link and memory pack bytes,
//! and what the shaders cost. What the proposed blocks cost is the same in all of them.

use super::{Blocks, Bus, Config, Link, Memory};

/// A machine whose numbers are assumed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// GeForce3 on AGP 4x, 2001.
    Gf3_2001,
    /// Radeon HD 5870 on PCIe 2 x16, 2009.
    Hd5870,
    /// Radeon HD 6970 on PCIe 2 x16, 2010.
    Hd6970,
    /// A present-day card on PCIe 4 x16.
    #[default]
    Modern,
}

impl Preset {
    /// All of them, by age.
    pub const ALL: [Self; 4] = [Self::Gf3_2001, Self::Hd5870, Self::Hd6970, Self::Modern];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gf3_2001 => "gf3-2001",
            Self::Hd5870 => "hd5870",
            Self::Hd6970 => "hd6970",
            Self::Modern => "modern",
        }
    }

    /// The preset of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Its configuration.
    #[must_use]
    pub fn config(self) -> Config {
        Config {
            clock_mhz: self.clock_mhz(),
            link: Link::of(self.bus(), self.clock_mhz()),
            memory: self.memory(),
            block: self.blocks(),
            ..Config::default()
        }
    }

    /// The bus of its time; what a bus stands for, with reasons, says [`Link::take`].
    const fn bus(self) -> Bus {
        match self {
            Self::Gf3_2001 => Bus::AGP4X,
            Self::Hd5870 | Self::Hd6970 => Bus::PCIE2X16,
            Self::Modern => Bus::PCIE4X16,
        }
    }

    /// Bandwidths as sold: width x rate. A read takes 200 ns at every age: DRAM arrays have hardly
    /// become faster, and what controllers gained, caches and queues took. Reads under way: the
    /// power of two that covers bandwidth x latency.
    fn memory(self) -> Memory {
        let (bandwidth_mb_s, burst, outstanding) = match self {
            // 128 bits x 460 MHz. 16 bytes is assumed: a crossbar of four 32-bit DDR channels,
            // bursts of 4.
            Self::Gf3_2001 => (7_360, 16, 128),
            // 256 bits x 4.8 Gb/s. GDDR5: a 32-bit channel, bursts of 8.
            Self::Hd5870 => (153_600, 32, 1024),
            // 256 bits x 5.5 Gb/s.
            Self::Hd6970 => (176_000, 32, 2048),
            // 256 bits x 14 Gb/s. GDDR6: a 16-bit channel, bursts of 16.
            Self::Modern => (448_000, 32, 4096),
        };
        let latency = self.clock_mhz() / 5;
        Memory { burst, bandwidth_mb_s, latency, outstanding, ..Memory::default() }
    }

    /// Core clocks as sold; what `modern` stands for boosts to about 2 GHz.
    const fn clock_mhz(self) -> u32 {
        match self {
            Self::Gf3_2001 => 200,
            Self::Hd5870 => 850,
            Self::Hd6970 => 880,
            Self::Modern => 2000,
        }
    }

    /// The fixed-function blocks are the proposal and cost the same everywhere; what differs is
    /// what stands around them: the shaders.
    fn blocks(self) -> Blocks {
        let mut blocks = Blocks::default();
        match self {
            // The vertex FIFO is as deep as the chip's cache of transformed vertices. One vertex a
            // cycle is left as it is, so that the tessellator shows before the shader: the chip
            // issued one vec4 instruction a clock, so the length of a program is its interval.
            Self::Gf3_2001 => blocks.vertex_shader.fifo = 24,
            // 20 SIMDs of 16 lanes.
            Self::Hd5870 => shader_array(&mut blocks, 20),
            // 24 SIMDs of 16 lanes.
            Self::Hd6970 => shader_array(&mut blocks, 24),
            // The shaders are a port to an array of cores that together outrun it: one vertex a
            // cycle goes in and comes out, which is what a geometry front end hands over. Latency
            // 200: a wave of 64 takes 64 cycles to gather, then some 34 dependent instructions of
            // four cycles each (a wave of 64 on 16 lanes).
            Self::Modern => {}
        }
        blocks
    }
}

/// A unified shader array, given whole to each of the shaders: they do not compete, which
/// flatters a run in which several are busy. A lane (VLIW of 5 or 4) issues an instruction word a
/// cycle; a program of 20 words is assumed, and 200 cycles for it with its waits, hidden by the 11
/// threads that a lane then holds.
fn shader_array(blocks: &mut Blocks, simds: u32) {
    let lanes = simds * 16;
    for shader in [&mut blocks.transform, &mut blocks.hull, &mut blocks.vertex_shader] {
        shader.lanes = lanes;
        shader.interval = WORDS;
        shader.latency = 200;
    }
    // A wave takes as many cycles as it has points; so many waves side by side take as many points
    // a cycle as the lanes do.
    blocks.domain.lanes = lanes / WORDS;
    // The surface shader counts its instructions; a wave of 64 takes 4 cycles for one on 16 lanes.
    (blocks.surface.costs.lanes, blocks.surface.point) = (simds, WORDS);
}

/// Instruction words of a shader program.
const WORDS: u32 = 20;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_pass_their_own_check_and_modern_is_the_default() {
        for preset in Preset::ALL {
            assert!(preset.config().check().is_ok(), "{preset:?}");
            assert_eq!(Preset::named(preset.name()), Some(preset));
        }
        assert_eq!(Preset::default().config(), Config::default());
        assert_eq!(Preset::named("gf3"), None);
    }

    #[test]
    fn presets_have_the_machines_published_numbers_and_the_fifos_their_depths() {
        let numbers = Preset::ALL.map(|preset| {
            let Config { clock_mhz, link, memory, block, .. } = preset.config();
            let wires = [link.bandwidth_mb_s, link.payload, memory.bandwidth_mb_s, memory.burst];
            (clock_mhz, wires, block.vertex_shader.fifo)
        });
        let expected = [
            (200, [1066, 0, 7360, 16], 24),
            (850, [8000, 128, 153_600, 32], 32),
            (880, [8000, 128, 176_000, 32], 32),
            (2000, [31_508, 256, 448_000, 32], 32),
        ];
        assert_eq!(numbers, expected);
        let block = Preset::Modern.config().block;
        // Patches, rows, triangles, vertices.
        let depths = [block.clip.fifo, block.stitch.fifo, block.emit.fifo, block.transform.fifo];
        assert_eq!(depths, [4, 2, 16, 32]);
    }

    #[test]
    fn reads_under_way_cover_the_latency_and_are_not_many_more() {
        for preset in Preset::ALL {
            let Config { clock_mhz, link, memory, .. } = preset.config();
            // Bytes that the wire moves during the latency: MB/s x cycles / MHz.
            let moved = |mb_s: u32, latency: u32| {
                u64::from(mb_s) * u64::from(latency) / u64::from(clock_mhz)
            };
            let link_bytes = u64::from(link.outstanding) * u64::from(link.request);
            let link_moved = moved(link.bandwidth_mb_s, link.latency);
            assert!(link_moved <= link_bytes && link_bytes < 5 * link_moved, "{preset:?}");
            let memory_bytes = u64::from(memory.outstanding) * u64::from(memory.burst);
            let memory_moved = moved(memory.bandwidth_mb_s, memory.latency);
            assert!(memory_moved <= memory_bytes && memory_bytes < 2 * memory_moved, "{preset:?}");
        }
    }

    #[test]
    fn a_lane_of_a_shader_array_hides_its_latency() {
        for (preset, lanes) in [(Preset::Hd5870, 320), (Preset::Hd6970, 384)] {
            let config = preset.config();
            let costs = config.costs(rtl_model::counter::Block::VertexShader).unwrap();
            assert_eq!((costs.lanes, costs.in_flight()), (lanes, 11));
            assert!(costs.in_flight() * costs.interval > costs.latency);
        }
    }
}
