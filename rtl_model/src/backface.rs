//! Back-face removal: to come.

use serde::{Deserialize, Serialize};

/// The test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// No patch is removed.
    Off,
    /// The 36 facets of the control net, both diagonals: Sfarti's "faces of the hull". Not conservative.
    NetFacets,
    /// The 81 Bernstein coefficients of det[S, Su, Sv] all of one sign: conservative.
    TangentPlane,
}
