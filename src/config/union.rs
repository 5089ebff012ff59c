//! `level.union`: which patches are divided alike. US 7,245,299, step 2, has all surfaces that
//! share an edge use the union of their subdivisions; lists of the edges' own need no such pass.

use serde::{Deserialize, Serialize};

/// Which patches use one union of their lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Union {
    /// None: each edge has its own list, which zippers join to the interior. Watertight across
    /// draws.
    #[default]
    Off,
    /// Those of a strip, fan or mesh that share edges: a list for each column and each row. Takes
    /// two passes; watertight within a primitive only.
    Primitive,
}
