//! A request in, its line of output out.

use super::request::{Domain, Factor, Partitioning, Request, Topology, Unit};
use rtl_model::d3d11::{Factors, Tessellator};
use serde::Serialize;
use std::io::{self, Write};
use tessim::output::edges;
use tessim::unit::pattern::{Pattern, fractional_quad};

#[derive(Serialize)]
struct Shape<'a> {
    domain: Domain,
    partitioning: Partitioning,
    topology: Topology,
    factors: &'a [Factor],
    points_fx16: &'a [[u32; 2]],
    indices: &'a [u16],
}

/// Makes patterns and writes them.
#[derive(Default)]
pub(super) struct Writer {
    tessellator: Tessellator,
}

impl Writer {
    /// Writes the pattern that `request` asks for, and a newline. Of culled factors the lists are
    /// empty.
    pub(super) fn write(&mut self, request: &Request, out: &mut impl Write) -> io::Result<()> {
        if request.unit != Unit::D3d11 {
            let pattern = fractional_quad(request.edges(), request.interior());
            let indices = indices(&pattern, request.topology);
            return write(request, &pattern.points, &indices, out);
        }
        let bits: Vec<u32> = request.factors.iter().map(|factor| factor.0.to_bits()).collect();
        let partitioning = request.partitioning.d3d11().expect("checked with the request");
        match Factors::process(request.domain.d3d11(), partitioning, &bits) {
            Some(factors) => {
                self.tessellator.accept(&factors, request.topology.d3d11());
                write(request, self.tessellator.points(), self.tessellator.indices(), out)
            }
            None => write(request, &[], &[], out),
        }
    }
}

fn write(
    request: &Request,
    points_fx16: &[[u32; 2]],
    indices: &[u16],
    out: &mut impl Write,
) -> io::Result<()> {
    let Request { domain, partitioning, topology, ref factors, .. } = *request;
    let shape = Shape { domain, partitioning, topology, factors, points_fx16, indices };
    serde_json::to_writer(&mut *out, &shape)?;
    out.write_all(b"\n")
}

fn indices(pattern: &Pattern, topology: Topology) -> Vec<u16> {
    match topology {
        Topology::Point => {
            let count = pattern.points.len();
            (0..count).map(|i| u16::try_from(i).expect("a pattern's points have u16s")).collect()
        }
        Topology::Line => {
            let edges = edges::distinct(&pattern.triangles, |_| Some(true));
            edges.into_iter().flat_map(|(edge, _)| edge).collect()
        }
        Topology::Ccw => pattern.triangles.iter().flatten().copied().collect(),
        Topology::Cw => pattern.triangles.iter().flat_map(|&[a, b, c]| [a, c, b]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topologies_index_the_same_pattern() {
        let points = vec![[0, 0]; 4];
        let pattern = Pattern { points, triangles: vec![[0, 1, 2], [2, 1, 3]] };
        assert_eq!(indices(&pattern, Topology::Point), [0, 1, 2, 3]);
        assert_eq!(indices(&pattern, Topology::Line), [0, 1, 1, 2, 2, 0, 1, 3, 3, 2]);
        assert_eq!(indices(&pattern, Topology::Ccw), [0, 1, 2, 2, 1, 3]);
        assert_eq!(indices(&pattern, Topology::Cw), [0, 2, 1, 2, 3, 1]);
    }
}
