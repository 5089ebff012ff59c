//! Evaluate: to come.

use serde::{Deserialize, Serialize};

/// How points are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Forward differencing in half-runs, boundary and interior.
    Forward,
    /// Forward differencing on the boundary, de Casteljau inside.
    Mixed,
    /// De Casteljau throughout.
    DeCasteljau,
}

/// What the vertex shader gets to light with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Normals {
    /// Nothing.
    Off,
    /// The tangent plane, four coefficients.
    TangentPlane,
}
