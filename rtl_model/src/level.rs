//! Level: patches in, a tessellation level for each edge and for the interior out.

use crate::patch::Level;

/// How levels are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The surface stays within `pixels` of its triangles: pixels in UQ16.16, at least 1 ulp.
    Flatness {
        /// UQ16.16.
        pixels: u32,
    },
    /// Length of the edge's projected control polygon / `pixels`.
    EdgeLength {
        /// UQ16.16.
        pixels: u32,
    },
    /// The same level everywhere.
    Fixed {
        /// The level.
        level: Level,
    },
}
