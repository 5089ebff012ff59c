//! Presets: the documented assumptions about one machine each. In goes a name, out a configuration.
//!
//! A preset says how fast the clock, the link and the memory are, how link and memory pack bytes,
//! and what the shaders cost. What the proposed blocks cost is the same in all of them.

use super::{Blocks, Config, Link, Memory};

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
        let (link, burst) = match self {
            // AGP moves data in bursts of quadwords without packets or framing (AGP 2.0, sec. 3).
            // 16 bytes is assumed: a crossbar of four 32-bit DDR channels, bursts of 4.
            Self::Gf3_2001 => (Link { payload: 0, header: 0 }, 16),
            // PCIe 2: root ports of the time settled on a 128-byte maximum payload. Header of a
            // write with a 64-bit address 16, sequence number and LCRC 6, framing
            // symbols 2. GDDR5: a 32-bit channel, bursts of 8.
            Self::Hd5870 | Self::Hd6970 => (Link { payload: 128, header: 24 }, 32),
            // PCIe 4: 256 bytes is what hosts offer; the transaction is framed as above (at
            // 128b/130b the framing token takes 4 bytes with the sequence number, and
            // the sum is the same). GDDR6: a 16-bit channel, bursts of 16.
            Self::Modern => (Link { payload: 256, header: 24 }, 32),
        };
        Config {
            clock_mhz: self.clock_mhz(),
            link,
            memory: Memory { burst },
            block: self.blocks(),
            ..Config::default()
        }
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
            Self::Hd5870 => shader_array(&mut blocks, 20 * 16),
            // 24 SIMDs of 16 lanes.
            Self::Hd6970 => shader_array(&mut blocks, 24 * 16),
            // The shaders are a port to an array of cores that together outrun it: one vertex a
            // cycle goes in and comes out, which is what a geometry front end hands over. Latency
            // 200: a wave of 64 takes 64 cycles to gather, then some 34 dependent instructions of
            // four cycles each (a wave of 64 on 16 lanes).
            Self::Modern => {}
        }
        blocks
    }
}

/// A unified shader array, given whole to each of the two shaders: they do not compete, which
/// flatters a run in which both are busy. A lane (VLIW of 5 or 4) issues an instruction word a
/// cycle; a program of 20 words is assumed, and 200 cycles for it with its waits, hidden by the 11
/// threads that a lane then holds.
fn shader_array(blocks: &mut Blocks, lanes: u32) {
    for shader in [&mut blocks.transform, &mut blocks.vertex_shader] {
        shader.lanes = lanes;
        shader.interval = 20;
        shader.latency = 200;
    }
}

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
    fn a_lane_of_a_shader_array_hides_its_latency() {
        for (preset, lanes) in [(Preset::Hd5870, 320), (Preset::Hd6970, 384)] {
            let config = preset.config();
            let costs = config.costs(rtl_model::counter::Block::VertexShader).unwrap();
            assert_eq!((costs.lanes, costs.in_flight()), (lanes, 11));
            assert!(costs.in_flight() * costs.interval > costs.latency);
        }
    }
}
