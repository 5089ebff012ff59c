//! Datapath: the operators on the path from levels to screen positions, which is what formats are
//! chosen for: place, evaluate and emit, one of each lane.
//!
//! The pieces are those of the parent's list, so that what is counted as work and what is estimated
//! as area are one and the same arithmetic.

use super::{Formats, centre, curve_point, divide, level_reciprocal, set_up, step};
use crate::config::{Config, Scheme, Unit};
use rtl_model::counter::standard::Ops;

/// A group of operators that works on one item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operator {
    /// What it makes.
    pub name: &'static str,
    /// Its operations for one item.
    pub ops: Ops,
    /// Cycles in which it makes one: over so many its operators are shared.
    pub cycles: u64,
}

/// The operators of the configured unit's path, in the order of the data. Units whose points come
/// from shaders have only the last of them.
#[must_use]
pub fn operators(config: &Config) -> Vec<Operator> {
    let f = Formats::of(config);
    let each = |name, ops| Operator { name, ops, cycles: 1 };
    let mut operators = Vec::new();
    let fractional = matches!(config.unit, Unit::Hybrid | Unit::Triangles | Unit::Moreton);
    if fractional {
        operators.push(each("reciprocal of a level", level_reciprocal(f)));
    }
    let differences = fractional && config.scheme() != Scheme::DeCasteljau;
    if differences {
        let cycles = u64::from(config.block.evaluate.setup).max(1);
        operators.push(Operator { name: "set-up of a curve", ops: set_up(f), cycles });
        operators.push(each("step", step(f)));
        operators.push(each("middle of a curve", centre(f)));
    }
    if config.scheme() != Scheme::Forward && (fractional || config.unit == Unit::Sfarti) {
        operators.push(each("curve point", curve_point(f)));
    }
    if config.divides() {
        operators.push(each("divide", divide(f)));
    }
    operators
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(unit: Unit, scheme: Scheme) -> Vec<&'static str> {
        let mut config = Config { unit, ..Config::default() };
        config.evaluate.scheme = scheme;
        operators(&config).iter().map(|operator| operator.name).collect()
    }

    #[test]
    fn each_unit_has_the_operators_of_its_evaluator() {
        let all = ["reciprocal of a level", "set-up of a curve", "step", "middle of a curve"];
        assert_eq!(of(Unit::Hybrid, Scheme::Forward), [&all[..], &["divide"]].concat());
        let mixed = [&all[..], &["curve point", "divide"]].concat();
        assert_eq!(of(Unit::Hybrid, Scheme::Mixed), mixed);
        assert_eq!(of(Unit::Moreton, Scheme::Forward), all);
        assert_eq!(of(Unit::Sfarti, Scheme::Forward), ["curve point", "divide"]);
        assert_eq!(of(Unit::D3d11, Scheme::Forward), ["divide"]);
    }

    #[test]
    fn a_wider_format_costs_more() {
        let cells = |change: fn(&mut Config)| -> u64 {
            let mut config = Config::default();
            change(&mut config);
            operators(&config).iter().map(|o| (o.ops.add_bits + o.ops.mul_bits) / o.cycles).sum()
        };
        let base = cells(|_| {});
        assert!(cells(|c| c.position.width = 33) > base);
        assert!(cells(|c| c.evaluate.guard = Some(21)) > base);
        assert!(cells(|c| c.place.reciprocal_bits = 31) < base);
        assert!(cells(|c| c.emit.subpixel_bits = 9) > base);
        assert!(cells(|c| c.block.evaluate.setup = 1) > base);
    }
}
