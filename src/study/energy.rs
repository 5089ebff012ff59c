//! Energy: what an operation and a byte cost in, what a run costs out, in picojoules.
//!
//! The prices are those of 45 nm at 0.9 V (M. Horowitz, "Computing's energy problem (and what we
//! can do about it)", ISSCC 2014): integer additions of 8 and 32 bits 0.03 and 0.1 pJ,
//! multiplications 0.2 and 3.1 pJ; in singles 0.9 and 3.7 pJ; 64 bits out of an 8 KB memory 10 pJ,
//! out of DRAM 1.3 to 2.6 nJ. Integer prices grow with the width of an adder and the area of a
//! multiplier, as these do within a fifth. A comparison is a subtraction. What an instruction costs
//! to fetch and an invocation to start is not in there: that price is 0 unless set. Nor is a byte
//! over a link: 5 pJ a bit are assumed.

use crate::config::{Arithmetic, Config};
use crate::error::{Error, Result};
use crate::report::{Frame, Report};
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C, Counters};
use serde::{Deserialize, Serialize};

/// Prices in picojoules.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Prices {
    /// An integer addition, a bit of its width.
    pub integer_add_bit: f64,
    /// An integer multiplication, a bit of one factor times a bit of the other.
    pub integer_mul_bit2: f64,
    /// An integer comparison, a bit of its width.
    pub integer_compare_bit: f64,
    /// An addition of singles.
    pub single_add: f64,
    /// A multiplication of singles.
    pub single_mul: f64,
    /// A comparison of singles.
    pub single_compare: f64,
    /// A byte to or from memory on the chip.
    pub chip_byte: f64,
    /// A byte to or from device memory.
    pub memory_byte: f64,
    /// A byte over the link.
    pub link_byte: f64,
    /// An invocation of a shader, apart from its operations and bytes.
    pub invocation: f64,
}

impl Default for Prices {
    fn default() -> Self {
        Self {
            integer_add_bit: 0.1 / 32.0,
            integer_mul_bit2: 3.1 / (32.0 * 32.0),
            integer_compare_bit: 0.1 / 32.0,
            single_add: 0.9,
            single_mul: 3.7,
            single_compare: 0.9,
            chip_byte: 10.0 / 8.0,
            memory_byte: (1300.0 + 2600.0) / 2.0 / 8.0,
            link_byte: 40.0,
            invocation: 0.0,
        }
    }
}

impl Prices {
    /// From the text of a TOML file; what it does not name keeps its default.
    ///
    /// # Errors
    /// [`Error::Usage`] that names `file` and what is wrong.
    pub fn read(file: &str, text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("{file}: {what}"));
        let prices: Self = toml::from_str(text).map_err(|e| wrong(e.to_string().trim().into()))?;
        if prices.all().iter().all(|p| p.is_finite() && *p >= 0.0) {
            return Ok(prices);
        }
        Err(wrong("expected prices in picojoules, finite and not negative".into()))
    }

    fn all(&self) -> [f64; 10] {
        [
            self.integer_add_bit,
            self.integer_mul_bit2,
            self.integer_compare_bit,
            self.single_add,
            self.single_mul,
            self.single_compare,
            self.chip_byte,
            self.memory_byte,
            self.link_byte,
            self.invocation,
        ]
    }

    /// Of operations on integers, by their widths.
    #[must_use]
    pub fn integers(&self, ops: &Ops) -> f64 {
        ops.add_bits as f64 * self.integer_add_bit
            + ops.mul_bits as f64 * self.integer_mul_bit2
            + ops.compare_bits as f64 * self.integer_compare_bit
    }

    /// Of as many operations on singles, whatever their widths.
    #[must_use]
    pub fn singles(&self, ops: &Ops) -> f64 {
        ops.add as f64 * self.single_add
            + ops.mul as f64 * self.single_mul
            + ops.compare as f64 * self.single_compare
    }
}

/// Operations of all blocks, their energy as they are built, and in singles.
#[must_use]
pub fn operations(report: &Report, frame: &Frame, prices: &Prices) -> (Ops, f64, f64) {
    let (mut sum, mut built, mut singles) = (Ops::default(), 0.0, 0.0);
    for (stage, work) in report.chain.iter().zip(&frame.work) {
        let Some(ops) = work.ops else { continue };
        sum = sum.with(1, ops);
        let price = if is_of_singles(stage.block, &report.config) {
            prices.singles(&ops)
        } else {
            prices.integers(&ops)
        };
        built += price;
        singles += prices.singles(&ops);
    }
    (sum, built, singles)
}

/// Whether a block computes in singles.
fn is_of_singles(block: Block, config: &Config) -> bool {
    match block {
        Block::Transform | Block::Hull | Block::VertexShader => true,
        Block::Domain => config.domain.arithmetic == Arithmetic::F32,
        _ => false,
    }
}

/// What shaders read and write: what stands between them is on the chip.
#[must_use]
pub fn chip_bytes(totals: &Counters) -> u64 {
    [
        C::TransformBytesIn,
        C::TransformBytesOut,
        C::HullBytesIn,
        C::HullBytesOut,
        C::DomainBytesControlPoints,
        C::DomainBytesParameters,
        C::DomainBytesOut,
        C::SurfaceBytesIn,
        C::SurfaceBytesOut,
        C::VertexShaderBytesIn,
        C::VertexShaderBytesOut,
    ]
    .into_iter()
    .map(|counter| totals.get(counter))
    .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_scale_to_the_published_prices() {
        let prices = Prices::default();
        let price = |ops: Ops| prices.integers(&ops);
        for (ops, published) in [
            (Ops::default().adds(1, 8), 0.03),
            (Ops::default().adds(1, 32), 0.1),
            (Ops::default().muls(1, 8, 8), 0.2),
            (Ops::default().muls(1, 32, 32), 3.1),
        ] {
            let off = price(ops) / published;
            assert!((0.8..1.001).contains(&off), "{ops:?}: {off}");
        }
        let three = Ops::default().adds(2, 24).muls(1, 24, 24).compares(1, 24);
        assert!((prices.singles(&three) - (2.0 * 0.9 + 3.7 + 0.9)).abs() < 1e-12);
        assert_eq!([prices.chip_byte, prices.memory_byte], [1.25, 243.75]);
    }

    #[test]
    fn a_file_changes_what_it_names_and_must_make_sense() {
        let read = |text| Prices::read("e.toml", text);
        let changed = read("invocation = 70.0\n").unwrap();
        assert_eq!(changed, Prices { invocation: 70.0, ..Prices::default() });
        for (text, says) in [
            ("invocation = -1.0", "negative"),
            ("joules = 1.0", "joules"),
            ("chip_byte = nan", "fin"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.starts_with("e.toml: ") && message.contains(says), "{message}");
        }
        let printed = toml::to_string(&Prices::default()).unwrap();
        assert_eq!(read(&printed).unwrap(), Prices::default());
    }
}
