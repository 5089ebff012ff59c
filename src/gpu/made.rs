//! What a unit made of a batch of patches, read back from the device.

/// A counter as `counters.csv` names it: block, counter.
pub type Name = (&'static str, &'static str);

/// What became of a batch: buffers as the kernels left them, and what was counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Made {
    /// Four words a patch: 0 clipped, 1 culled, 2 kept; whether backface tested it; what that
    /// looked at; the planes that all its points are outside of. Empty in units without culling.
    pub fates: Vec<u32>,
    /// What the level kernel said: [`super::LEVELS`] words a patch, or
    /// [`super::LISTS`]. Empty in units that choose otherwise.
    pub levels: Vec<u32>,
    /// Where each patch's vertices begin, and behind the last one their number.
    pub vertex_starts: Vec<u32>,
    /// Where each patch's triangles begin, and behind the last one their number.
    pub triangle_starts: Vec<u32>,
    /// [`super::VERTEX`] words a vertex.
    pub vertices: Vec<u32>,
    /// Three words a vertex: x, y, whether it was divided. Empty where the unit does not divide.
    pub screen: Vec<u32>,
    /// Three words a triangle: numbers of vertices within the patch.
    pub triangles: Vec<u32>,
    /// What was counted.
    pub counts: Vec<(Name, u64)>,
}
