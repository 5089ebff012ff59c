//! Factors to test with: seeded, anywhere and around everything special.

use rtl_model::d3d11::{Domain, Factors, Output, Partitioning, Tessellator};

pub(crate) const DOMAINS: [Domain; 3] = [Domain::Quad, Domain::Tri, Domain::Isoline];

pub(crate) const PARTITIONINGS: [Partitioning; 4] =
    [Partitioning::Integer, Partitioning::Pow2, Partitioning::Odd, Partitioning::Even];

pub(crate) const ONE: u32 = 1 << 16;

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        (((self.bits() >> 32) * u64::from(bound)) >> 32) as u32
    }

    /// The bits of a factor that does not cull: below 20 mostly, to 65, around integers and 1.
    pub(crate) fn factor(&mut self) -> u32 {
        let uniform = |random: &mut Self, bound: f32| {
            (0.5 + random.below(1 << 24) as f32 / (1 << 24) as f32 * bound).to_bits()
        };
        match self.below(10) {
            0..4 => uniform(self, 20.0),
            4 => uniform(self, 65.0),
            5 => ((1 + self.below(65)) as f32).to_bits() + self.below(7) - 3,
            6 => 1f32.to_bits() + self.below(200) - 3,
            7 => ((1 + self.below(8)) as f32).to_bits(),
            _ => 1f32.to_bits(),
        }
    }
}

/// A pattern of its own.
pub(crate) fn pattern(factors: &Factors, output: Output) -> (Vec<[u32; 2]>, Vec<u16>) {
    let mut tessellator = Tessellator::default();
    tessellator.accept(factors, output);
    (tessellator.points().to_vec(), tessellator.indices().to_vec())
}

/// The points of an edge of a quad from u or v = 0 on, taken from the outer ring.
pub(crate) fn quad_edge(factors: &Factors, points: &[[u32; 2]], edge: usize) -> Vec<u32> {
    let first: usize = (0..edge).map(|e| factors.edge_points(e) - 1).sum();
    let ring: usize = (0..4).map(|e| factors.edge_points(e) - 1).sum();
    let along = 1 - edge % 2;
    let on_edge = (first..first + factors.edge_points(edge)).map(|k| points[k % ring]);
    let mut list: Vec<u32> = on_edge.map(|point| point[along]).collect();
    if edge == 0 || edge == 3 {
        list.reverse();
    }
    list
}
