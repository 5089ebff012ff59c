//! Records of dispatches, with what was in every buffer before and after: for another machine, or
//! another driver, to do again.

use serde::Serialize;

/// One dispatch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Dispatch {
    /// Names of the texts in `src/gpu` that make the kernel, in order.
    pub files: Vec<&'static str>,
    /// The entry point.
    pub entry: &'static str,
    /// Groups along both axes.
    pub groups: [u32; 2],
    /// The words of binding 0.
    pub settings: Vec<u32>,
    /// The words of the other bindings before it.
    pub before: Vec<Vec<u32>>,
    /// And after it.
    pub after: Vec<Vec<u32>>,
}
