//! Schedule: triangles in, the vertices that each brings out.
//!
//! A vertex is divided when the first triangle needs it; the vertex store keeps a mark for each
//! vertex of the patch, and a triangle of known vertices only passes by.

use crate::patch::Triangle;
use crate::time::{Cost, Emit};

/// What emitting costs, and the store's marks.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Cycles from one vertex to the next, or for a triangle that brings none; at least 1.
    interval: u32,
    /// Cycles from a vertex to its quotients.
    latency: u32,
    /// The number of the patch that saw each vertex last.
    marks: Vec<u32>,
    patch: u32,
}

impl Schedule {
    /// A block of these costs, in cycles: from a vertex to the next one, and to its quotients.
    #[must_use]
    pub fn new(interval: u32, latency: u32) -> Self {
        Self { interval, latency, marks: Vec::new(), patch: 0 }
    }

    /// Emits the vertices that `triangle` is the first to use. `first`: it is its patch's first.
    #[inline(always)]
    pub fn accept(&mut self, triangle: Triangle, first: bool, out: &mut impl Emit<u16>) -> Cost {
        if first {
            self.next_patch();
        }
        let most = usize::from(triangle[0].max(triangle[1]).max(triangle[2]));
        if most >= self.marks.len() {
            self.marks.resize(most + 1, 0);
        }
        let (interval, latency) = (u64::from(self.interval), u64::from(self.latency));
        let mut offset = latency;
        for vertex in triangle {
            if self.mark(vertex) {
                out.emit(vertex, offset);
                offset += interval;
            }
        }
        Cost { interval: (offset - latency).max(interval), latency }
    }

    #[inline(never)]
    fn next_patch(&mut self) {
        self.patch = self.patch.wrapping_add(1);
        if self.patch == 0 {
            self.marks.clear(); // marks of 2^32 patches ago
            self.patch = 1;
        }
    }

    /// Marks a vertex; whether it was new.
    #[inline(always)]
    fn mark(&mut self, vertex: u16) -> bool {
        let mark = &mut self.marks[usize::from(vertex)];
        std::mem::replace(mark, self.patch) != self.patch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Vertices(Vec<(u16, u64)>);

    impl Emit<u16> for Vertices {
        fn emit(&mut self, vertex: u16, offset: u64) {
            self.0.push((vertex, offset));
        }
    }

    #[test]
    fn a_vertex_leaves_with_the_first_triangle_that_uses_it() {
        let mut schedule = Schedule::new(2, 16);
        let mut out = Vertices(Vec::new());
        let triangles =
            [([0, 1, 2], true), ([0, 2, 3], false), ([2, 0, 3], false), ([0, 1, 2], true)];
        let intervals =
            triangles.map(|(triangle, first)| schedule.accept(triangle, first, &mut out).interval);
        assert_eq!(intervals, [6, 2, 2, 6]);
        let all = [(0, 16), (1, 18), (2, 20), (3, 16), (0, 16), (1, 18), (2, 20)];
        assert_eq!(out.0, all);
    }
}
