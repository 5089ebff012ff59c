//! Dyadic lists written out: a mask in, its parameters in ascending order out.
//!
//! Nothing is rounded or divided: k/128 is k shifted by nine places in U1.16.

use super::{ENTRIES_MAX, List, Numbering, Parameters, Placement, grid};
use crate::patch::{Dyadic, Lists};

/// The parameters of a dyadic list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DyadicList {
    list: Dyadic,
    segments: usize,
    parameters: [u32; ENTRIES_MAX],
}

impl Default for DyadicList {
    fn default() -> Self {
        let mut all = Self { list: Dyadic::NONE, segments: 0, parameters: [0; ENTRIES_MAX] };
        all.fill();
        all
    }
}

impl DyadicList {
    /// Makes this the parameters of `list`; nothing to do where it is already.
    pub fn set(&mut self, list: Dyadic) {
        if list != self.list {
            self.list = list;
            self.fill();
        }
    }

    fn fill(&mut self) {
        self.segments = self.list.segments();
        for (place, parameter) in self.parameters.iter_mut().zip(self.list.parameters()) {
            *place = parameter;
        }
    }
}

impl Parameters for DyadicList {
    fn parameters(&self) -> &[u32] {
        &self.parameters[..=self.segments]
    }

    fn segments(&self) -> usize {
        self.segments
    }

    fn fractional(&self) -> Option<&List> {
        None
    }
}

/// Where a patch that is subdivided at midpoints gets its vertices. Where an interior list has no
/// entry between its ends, there is no interior.
pub type DyadicPlacement = Placement<DyadicList>;

impl DyadicPlacement {
    /// Places the vertices of a patch with these lists.
    pub fn set_lists(&mut self, lists: &Lists) {
        for (parameters, &list) in self.edges.iter_mut().zip(lists.edges()) {
            parameters.set(list);
        }
        self.u.set(lists.u());
        self.v.set(lists.v());
    }
}

impl Numbering for Lists {
    fn edge(&self, edge: usize) -> usize {
        self.edges()[edge].segments()
    }

    /// Both 0 where nothing is between the ends in one of the directions.
    fn interior(&self) -> [usize; 2] {
        grid(self.u().inner(), self.v().inner())
    }
}
