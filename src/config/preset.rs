//! Presets: the documented assumptions about one machine each. In goes a name, out a configuration.
//!
//! So far a preset says how the link packs bytes and how memory bursts. Clock rates, bandwidths and
//! the cycle costs of the blocks come with the engines, which are the first to need them.

use super::{Config, Link, Memory};

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
        Config { link, memory: Memory { burst }, ..Config::default() }
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
}
