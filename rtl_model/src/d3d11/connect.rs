//! Connect: the counts of a pattern's factors in, its indices out: the transitions between edges
//! and the inner partition, and then, as long as it is in no table (`inside`), ring by ring what
//! lies within (`stitch`).

use super::inside::{self, BLOCK, Insides};
use super::stitch::{Ring, SLACK, Stitch};
use super::{Domain, Factors, Output};

/// Writes the indices of the pattern to `out`, which has [`SLACK`] places more than indices.
///
/// # Panics
/// Where triangles are asked of an isoline domain.
pub(super) fn write(factors: &Factors, output: Output, out: &mut [u16]) {
    let count = out.len() - SLACK;
    match output {
        Output::Point => (0..).zip(&mut out[..count]).for_each(|(k, out)| *out = k),
        Output::Line if factors.domain() == Domain::Isoline => lines(factors, &mut out[..count]),
        Output::Line => {
            let (pairs, _) = out[..count].as_chunks_mut();
            (0..).zip(pairs).for_each(|(k, pair)| *pair = [k, k + 1]);
        }
        Output::Cw => Stitch::<true> { out, at: 0 }.pattern(factors),
        Output::Ccw => Stitch::<false> { out, at: 0 }.pattern(factors),
    }
}

fn lines(factors: &Factors, out: &mut [u16]) {
    let points = factors.edge_points(1);
    let lines = out.chunks_exact_mut(2 * (points - 1));
    for (first, line) in (0..).step_by(points).zip(lines) {
        let (pairs, _) = line.as_chunks_mut();
        (first..).zip(pairs).for_each(|(k, pair)| *pair = [k, k + 1]);
    }
}

impl<const CLOCKWISE: bool> Stitch<'_, CLOCKWISE> {
    fn pattern(&mut self, factors: &Factors) {
        let segments = |edge: usize| factors.edge_points(edge) - 1;
        match (factors.domain(), factors.least()) {
            (Domain::Isoline, _) => panic!("an isoline domain has no triangles"),
            (Domain::Tri, true) => self.put([0, 2, 1]),
            (Domain::Quad, true) => {
                self.put([0, 3, 1]);
                self.put([1, 3, 2]);
            }
            (Domain::Tri, false) => {
                let inner = factors.inner_points(0) - 1;
                let edges = Ring { first: 0, segments: [0, 1, 2].map(segments) };
                let ring = self.transitions(&edges, [inner; 3]);
                self.inside(ring, &inside::TRIS[usize::from(CLOCKWISE)]);
            }
            (Domain::Quad, false) => {
                let [u, v] = [0, 1].map(|axis| factors.inner_points(axis) - 1);
                let edges = Ring { first: 0, segments: [0, 1, 2, 3].map(segments) };
                let ring = self.transitions(&edges, [v, u, v, u]);
                self.inside(ring, &inside::QUADS[usize::from(CLOCKWISE)]);
            }
        }
    }

    /// Everything inside a ring: strip by strip as long as it is in no table.
    #[inline(always)]
    fn inside<const SIDES: usize>(&mut self, mut ring: Ring<SIDES>, insides: &Insides) {
        loop {
            if let Some((numbers, count)) = insides.find(&ring) {
                return self.copy(numbers, count, ring.first as u16);
            }
            match self.ring(ring) {
                Some(inside) => ring = inside,
                None => return,
            }
        }
    }

    /// Copies numbers that count from `first`.
    #[inline(always)]
    fn copy(&mut self, numbers: &[u16], count: usize, first: u16) {
        let (blocks, _) = numbers.as_chunks::<BLOCK>();
        let (out, _) = self.out[self.at..].as_chunks_mut::<BLOCK>();
        for (out, &block) in out.iter_mut().zip(blocks).take(count.div_ceil(BLOCK)) {
            // All are read before any is written, so that they can be added as vectors.
            *out = block.map(|number| number.wrapping_add(first));
        }
        self.at += count;
    }
}
