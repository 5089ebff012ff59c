//! What the domain shader of unit `d3d11` computes with: the form of the evaluation, and the
//! arithmetic. Plain data; what each does is in `shader::domain`.

use serde::{Deserialize, Serialize};

/// The order of operations in which a point of a bicubic is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Bernstein sums from u and 1 - u, paired from both ends, so that an edge gives the same bits
    /// from either.
    #[default]
    Paired,
    /// The same weights, summed from left to right as shader samples do. Cracks where sums round.
    Sequential,
    /// The power basis of paper 004, `[U][N][B][M]^T[V]`. Cracks.
    Power,
}

impl Form {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Paired, Self::Sequential, Self::Power];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paired => "paired",
            Self::Sequential => "sequential",
            Self::Power => "power",
        }
    }
}

/// What the domain shader's numbers are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Arithmetic {
    /// IEEE 754 singles, as today's shader cores have them.
    #[default]
    F32,
    /// Fixed point: positions in the position format, weights in a format of their own.
    Fixed,
}

impl Arithmetic {
    /// All of them, the default first.
    pub const ALL: [Self; 2] = [Self::F32, Self::Fixed];

    /// The name in configurations and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::Fixed => "fixed",
        }
    }
}
