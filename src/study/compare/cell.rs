//! A cell of the table of a comparison: a value in, its text out.

use super::series::Value;
use crate::output::table::grouped;

/// What a cell says.
pub(super) enum Cell {
    Number(u64),
    Rate(f64),
    Word(String),
}

/// From here on nobody wants to read decimals.
const MANY: f64 = 1000.0;

impl From<Value> for Cell {
    fn from(value: Value) -> Self {
        match value {
            Value::Count(count) => Self::Number(count),
            Value::Real(real) => Self::Rate(real),
        }
    }
}

impl Cell {
    /// What ratios are made of.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(n) => Some(*n as f64),
            Self::Rate(rate) => Some(*rate),
            Self::Word(_) => None,
        }
    }

    /// As it stands in the table.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(n) => grouped(*n),
            Self::Rate(rate) if *rate >= MANY => grouped(rate.round() as u64),
            Self::Rate(rate) => format!("{rate:.3}"),
            Self::Word(word) => word.clone(),
        }
    }
}
