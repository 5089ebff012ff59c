//! A request in, its line of output out.

use super::request::{Domain, Factor, Partitioning, Request, Topology};
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
    points_fx16: Vec<[u32; 2]>,
    indices: Vec<u16>,
}

/// Writes the pattern that `request` asks for, and a newline.
pub(super) fn write(request: &Request, out: &mut impl Write) -> io::Result<()> {
    let pattern = fractional_quad(request.edges(), request.interior());
    let indices = indices(&pattern, request.topology);
    let shape = Shape {
        domain: request.domain,
        partitioning: request.partitioning,
        topology: request.topology,
        factors: &request.factors,
        points_fx16: pattern.points,
        indices,
    };
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
