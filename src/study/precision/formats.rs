//! Formats: one point of a grid, what configuration it stands for, how wide that makes the signals,
//! and what it costs.
//!
//! The area is an estimate: the operators of the path from levels to screen positions, each as
//! `unit::arithmetic` counts it, in full-adder cells. A multiplier of v by w bits is v w of them:
//! so many bits have the partial products of an array (Baugh and Wooley 1973, abstract), each with
//! an AND gate and a full adder (EP 0 152 046, 1985, on arrays of n by n). That an adder or
//! comparator of w bits is w cells (carries ripple) is assumed; registers, wires, tables and
//! control are left out. An operator that a curve needs only once is shared over
//! the cycles of the set-up.

use super::POINTS_MAX;
use crate::config::{Config, Overflow, Rounding, Scheme, Unit};
use crate::error::{Error, Result};
use crate::unit::arithmetic::datapath;

/// A point of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// Bits of a position.
    pub width: u32,
    /// Guard bits of the accumulators.
    pub guard: u32,
    /// Fraction bits of a level's reciprocal.
    pub reciprocal: u32,
    /// Fraction bits of a screen coordinate.
    pub subpixel: u32,
    /// How port, evaluate and emit round; each as configured where it is `None`.
    pub rounding: Option<Rounding>,
    /// What port and evaluate do with what does not fit.
    pub overflow: Overflow,
}

/// What is swept: each list has at least one value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axes {
    /// Bits of a position.
    pub width: Vec<u32>,
    /// Guard bits of the accumulators.
    pub guard: Vec<u32>,
    /// Fraction bits of a level's reciprocal.
    pub reciprocal: Vec<u32>,
    /// Fraction bits of a screen coordinate.
    pub subpixel: Vec<u32>,
    /// How port, evaluate and emit round.
    pub rounding: Vec<Option<Rounding>>,
    /// What port and evaluate do with what does not fit.
    pub overflow: Vec<Overflow>,
}

impl Axes {
    /// A grid that shows where each format of this unit begins to matter. A unit that has no
    /// accumulators has no guard bits to sweep, and one of dyadic lists no reciprocals.
    #[must_use]
    pub fn of(base: &Config) -> Self {
        let steps = base.scheme() != Scheme::DeCasteljau;
        let divides = base.unit == Unit::Hybrid;
        Self {
            width: (12..=32).step_by(2).collect(),
            guard: if steps { vec![1, 4, 8, 12, 20] } else { vec![1] },
            reciprocal: if divides { vec![12, 16, 20, 32] } else { vec![32] },
            subpixel: vec![4, 8],
            rounding: vec![None],
            overflow: vec![base.position.overflow],
        }
    }

    /// All points: the product of the lists, the first axis slowest.
    ///
    /// # Errors
    /// [`Error::Usage`] for an empty list, for too many points, and for formats that the unit could
    /// not be built with.
    pub fn grid(&self, base: &Config) -> Result<Vec<Formats>> {
        let lists = [
            self.width.len(),
            self.guard.len(),
            self.reciprocal.len(),
            self.subpixel.len(),
            self.rounding.len(),
            self.overflow.len(),
        ];
        let points = lists.iter().try_fold(1_usize, |all, &n| all.checked_mul(n)).unwrap_or(0);
        if !(1..=POINTS_MAX).contains(&points) {
            return Err(Error::Usage(format!(
                "the grid: found {lists:?} values an axis, expected 1 to {POINTS_MAX} points"
            )));
        }
        let mut grid = Vec::with_capacity(points);
        for k in 0..points {
            let mut rest = k;
            let places = [5, 4, 3, 2, 1, 0].map(|axis: usize| {
                let place = rest % lists[axis];
                rest /= lists[axis];
                place
            });
            let [overflow, rounding, subpixel, reciprocal, guard, width] = places;
            let formats = Formats {
                width: self.width[width],
                guard: self.guard[guard],
                reciprocal: self.reciprocal[reciprocal],
                subpixel: self.subpixel[subpixel],
                rounding: self.rounding[rounding],
                overflow: self.overflow[overflow],
            };
            formats.config(base).check()?;
            grid.push(formats);
        }
        Ok(grid)
    }
}

impl Formats {
    /// The configuration of a unit with these formats.
    #[must_use]
    pub fn config(&self, base: &Config) -> Config {
        let mut config = base.clone();
        config.position.width = self.width;
        config.position.overflow = self.overflow;
        config.evaluate.guard = Some(self.guard);
        config.place.reciprocal_bits = self.reciprocal;
        config.emit.subpixel_bits = self.subpixel;
        if let Some(rounding) = self.rounding {
            config.position.rounding = rounding;
            config.evaluate.rounding = rounding;
            config.emit.rounding = rounding;
        }
        config
    }

    /// How it rounds, by its name in tables.
    #[must_use]
    pub fn rounding_name(&self) -> &'static str {
        self.rounding.map_or("configured", rounding_name)
    }

    /// What it does with what does not fit, by its name in tables.
    #[must_use]
    pub fn overflow_name(&self) -> &'static str {
        overflow_name(self.overflow)
    }
}

/// Widths of the signals of one coordinate in bits, as the blocks define them; 0 where the unit has
/// no such signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Widths {
    /// A position.
    pub position: u32,
    /// The widest product of evaluate, exact before its rounding.
    pub product: u32,
    /// The difference registers D0 to D3.
    pub accumulators: [u32; 4],
    /// A parameter.
    pub parameter: u32,
    /// A level's reciprocal.
    pub reciprocal: u32,
    /// A screen coordinate.
    pub screen: u32,
}

impl Widths {
    /// Those of a configuration.
    #[must_use]
    pub fn of(config: &Config) -> Self {
        let (w, guard, bits) =
            (config.position.width, config.guard(), config.place.reciprocal_bits);
        let differences = config.scheme() != Scheme::DeCasteljau;
        Self {
            position: w,
            // a h3, of W + 7 bits and the cube's; a (1 - t) and b t, of 17 bits more
            product: if differences { w + 7 + (3 * bits).min(64) } else { w + 17 },
            accumulators: if differences {
                [w + 1, w + 1, w + 6, w + 6].map(|bits| bits + guard)
            } else {
                [0; 4]
            },
            parameter: 17,
            reciprocal: if config.unit == Unit::Sfarti { 0 } else { bits + 1 },
            screen: 16 + config.emit.subpixel_bits,
        }
    }

    /// Bits of one coordinate's datapath: position, accumulators, parameter, reciprocal, screen
    /// coordinate, each once. Products are no registers.
    #[must_use]
    pub fn datapath(&self) -> u32 {
        let registers: u32 = self.accumulators.iter().sum();
        self.position + registers + self.parameter + self.reciprocal + self.screen
    }
}

/// The area estimate of a configuration in full-adder cells.
#[must_use]
pub(super) fn area(config: &Config) -> u64 {
    let operators = datapath::operators(config);
    let cells = |operator: &datapath::Operator| {
        let ops = &operator.ops;
        (ops.add_bits + ops.mul_bits + ops.compare_bits).div_ceil(operator.cycles)
    };
    operators.iter().map(cells).sum()
}

/// A mode as in a configuration.
#[must_use]
pub const fn rounding_name(rounding: Rounding) -> &'static str {
    match rounding {
        Rounding::Floor => "floor",
        Rounding::NearestUp => "nearest_up",
        Rounding::NearestEven => "nearest_even",
        Rounding::NearestAway => "nearest_away",
    }
}

/// A mode as in a configuration.
#[must_use]
pub const fn overflow_name(overflow: Overflow) -> &'static str {
    match overflow {
        Overflow::Wrap => "wrap",
        Overflow::Saturate => "saturate",
    }
}
