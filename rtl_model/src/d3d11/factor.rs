//! Factor processing: the bits of f32 factors in, 16.16 factors with their parities out.
//!
//! Direct3D 11.3 functional specification, 11.7.4 and what follows it; where it is silent, as
//! drivers do it. Culling, clamping and rounding up come before the conversion, on the float's own
//! bits: positive floats are ordered as their bits are, so no arithmetic is needed for them.

use super::{Domain, Output, Partitioning};
use fixed::types::U16F16;

/// 1.0, the least factor of all, in f32.
const ONE_BITS: u32 = 0x3f80_0000;
/// 1 + 2^-17: a factor above it is not 1 any more once it is in 16.16.
const ABOVE_ONE_BITS: u32 = ONE_BITS + (1 << 6);
/// 1 + 2^-16: the least odd inside factor beside any factor above 1 (the "picture frame").
const FRAME_BITS: u32 = ONE_BITS + (1 << 7);
/// 2.0, 63.0 and 64.0 in f32.
const TWO_BITS: u32 = 0x4000_0000;
const BITS_63: u32 = 0x427c_0000;
const BITS_64: u32 = 0x4280_0000;
const INFINITY_BITS: u32 = 0x7f80_0000;

/// A half-edge of one half: 1 in even parity, which has the two segments of 2.
const HALF: U16F16 = U16F16::from_bits(1 << 15);

/// One processed factor: 1 to 64 in 16.16, and whether it has an odd number of segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Factor {
    pub(super) value: U16F16,
    pub(super) odd: bool,
}

impl Default for Factor {
    /// One segment.
    fn default() -> Self {
        Self { value: U16F16::ONE, odd: true }
    }
}

impl Factor {
    /// The factor in half-edges, of which an odd one has half a segment more: 1 to 32.5.
    pub(super) fn half(self) -> U16F16 {
        // Half of the factor, up: 17 bits with the carry, never more.
        let half = (self.value + U16F16::DELTA) >> 1_u32;
        if self.odd || half == HALF { half + HALF } else { half }
    }

    /// Points, both ends included: 2 to 65.
    fn points(self) -> usize {
        let ceil: usize = self.half().ceil().to_num();
        2 * ceil + usize::from(!self.odd)
    }
}

/// Processed factors: everything that a pattern depends on.
///
/// Integer and pow2 factors that process alike are equal. By default those of a quad of ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Factors {
    domain: Domain,
    /// Whether every factor is 1, none of an even parity: one triangle or two.
    least: bool,
    /// Edges in D3D's order, then the inside; unused places keep their default.
    factors: [Factor; 6],
    /// Points along each, both ends included: 2 to 65.
    counts: [u8; 6],
}

impl Default for Factors {
    fn default() -> Self {
        Self { domain: Domain::Quad, least: true, factors: [Factor::default(); 6], counts: [2; 6] }
    }
}

impl Factors {
    /// Processes factors, given as f32 bits in the order of [`Domain`]; `None`: the patch is
    /// culled, an edge's factor (or any of an isoline's) being 0, negative or NaN.
    ///
    /// # Panics
    /// Where `bits` has another length than [`Domain::factors`].
    #[must_use]
    pub fn process(domain: Domain, partitioning: Partitioning, bits: &[u32]) -> Option<Self> {
        assert_eq!(bits.len(), domain.factors(), "as many factors as the domain has");
        let edges = domain.edges();
        // Above infinity are the NaNs, and everything with a sign.
        if bits[..edges].iter().any(|&bits| bits == 0 || bits > INFINITY_BITS) {
            return None;
        }
        let mut factors = [Factor::default(); 6];
        for (factor, &bits) in factors.iter_mut().zip(&bits[..edges]) {
            *factor = convert(partitioning, least(partitioning), bits);
        }
        if domain == Domain::Isoline {
            factors[0] = convert(Partitioning::Integer, ONE_BITS, bits[0]);
        }
        let inside_least = inside_least(partitioning, bits);
        for (factor, &bits) in factors[edges..].iter_mut().zip(&bits[edges..]) {
            *factor = convert(partitioning, inside_least, bits);
        }
        let used = &mut factors[..bits.len()];
        let least = domain != Domain::Isoline && used.iter().all(|&f| f == Factor::default());
        if !least {
            // An inside of 1 is two segments: a single one could not be joined to the edges.
            let ones = used[edges..].iter_mut().filter(|f| **f == Factor::default());
            ones.for_each(|f| f.odd = false);
        }
        let counts = factors.map(|f| f.points() as u8);
        Some(Self { domain, least, factors, counts })
    }

    /// [`Self::process`] for a quad, whose factors are six.
    #[must_use]
    pub fn quad(partitioning: Partitioning, bits: [u32; 6]) -> Option<Self> {
        Self::process(Domain::Quad, partitioning, &bits)
    }

    /// The domain.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// Points of an edge, both ends included: 2 to 65. The edges of a quad are U = 0, V = 0, U = 1
    /// and V = 1, of a tri U = 0, V = 0 and W = 0. An isoline domain has two: edge 0 is U = 0, one
    /// point a line and the corner that has no line; edge 1 is a line.
    ///
    /// # Panics
    /// Where the domain has no such edge.
    #[must_use]
    pub fn edge_points(&self, edge: usize) -> usize {
        self.counts[..self.domain.edges()][edge].into()
    }

    /// Points of the inner partition along U (0) or V (1) of a quad, both ends on the edges
    /// included: 3 to 65, or 2 where all factors are 1. A tri has axis 0 only.
    ///
    /// # Panics
    /// Where the domain has no such axis.
    #[must_use]
    pub fn inner_points(&self, axis: usize) -> usize {
        self.counts[self.domain.edges()..self.domain.factors()][axis].into()
    }

    /// Whether every factor is 1, and odd: the pattern is one triangle or two.
    pub(super) fn least(&self) -> bool {
        self.least
    }

    /// The factor at a place of the domain's order.
    pub(super) fn factor(&self, place: usize) -> Factor {
        self.factors[place]
    }

    /// Points of the pattern: at most 4225.
    #[must_use]
    pub fn points(&self) -> usize {
        let on_edges =
            || (0..self.domain.edges()).map(|edge| self.edge_points(edge)).sum::<usize>();
        match self.domain {
            Domain::Quad => {
                on_edges() - 4 + (self.inner_points(0) - 2) * (self.inner_points(1) - 2)
            }
            Domain::Tri => {
                let rings = self.inner_points(0) / 2 - 1;
                let odd = self.inner_points(0).is_multiple_of(2);
                let inside = 3 * rings * if odd { rings } else { rings + 1 } + usize::from(!odd);
                on_edges() - 3 + inside
            }
            Domain::Isoline => self.lines() * self.edge_points(1),
        }
    }

    /// Indices of the pattern: at most 24576.
    ///
    /// # Panics
    /// Where triangles are asked of an isoline domain, which has none.
    #[must_use]
    pub fn indices(&self, output: Output) -> usize {
        match (output, self.domain) {
            (Output::Point, _) => self.points(),
            (Output::Line, Domain::Isoline) => 2 * self.lines() * (self.edge_points(1) - 1),
            (Output::Line, _) => 2 * (self.points() - 1),
            (Output::Cw | Output::Ccw, Domain::Isoline) => {
                panic!("an isoline domain has points and lines, no triangles")
            }
            (Output::Cw | Output::Ccw, _) => 3 * self.triangles(),
        }
    }

    /// Lines of an isoline domain: 1 to 64.
    pub(super) fn lines(&self) -> usize {
        self.edge_points(0) - 1
    }

    fn triangles(&self) -> usize {
        if self.least {
            return self.domain.edges() - 2;
        }
        let strip = |edge: usize, inner: usize| self.edge_points(edge) + inner - 4;
        if self.domain == Domain::Quad {
            let [u, v] = [0, 1].map(|axis| self.inner_points(axis));
            let strips: usize = (0..4).map(|edge| strip(edge, [v, u][edge % 2])).sum();
            strips + 2 * (u - 3) * (v - 3)
        } else {
            let inner = self.inner_points(0);
            let strips: usize = (0..3).map(|edge| strip(edge, inner)).sum();
            let side = inner - 3; // segments of the second ring
            strips
                + if side.is_multiple_of(2) {
                    3 * side * side / 2
                } else {
                    3 * (side * side - 1) / 2 + 1
                }
        }
    }
}

/// The least factor of a partitioning.
fn least(partitioning: Partitioning) -> u32 {
    if partitioning == Partitioning::Even { TWO_BITS } else { ONE_BITS }
}

/// The least inside factor. An odd edge of three segments or more needs a ring inside, so that it
/// is not joined to an edge across: any factor above 1 makes one, however thin.
fn inside_least(partitioning: Partitioning, bits: &[u32]) -> u32 {
    let above = |&bits: &u32| bits > ABOVE_ONE_BITS && bits <= INFINITY_BITS;
    if partitioning == Partitioning::Odd && bits.iter().any(above) {
        FRAME_BITS
    } else {
        least(partitioning)
    }
}

/// Clamps, rounds up where the partitioning says so, and converts to 16.16.
fn convert(partitioning: Partitioning, least: u32, bits: u32) -> Factor {
    let most = if partitioning == Partitioning::Odd { BITS_63 } else { BITS_64 };
    let bits = if bits > INFINITY_BITS { least } else { bits.clamp(least, most) };
    // 1.23, and 2^17 to 2^23 of it are one: exponents are 0 to 6.
    let significand = bits & 0x7f_ffff | 0x80_0000;
    let exponent = (bits >> 23) - 127;
    match partitioning {
        Partitioning::Integer | Partitioning::Pow2 => {
            let one = 0x80_0000 >> exponent;
            let ceil = (significand + (one - 1)) >> (23 - exponent); // 1 to 64
            Factor { value: U16F16::from_bits(ceil << 16), odd: ceil % 2 == 1 }
        }
        Partitioning::Odd | Partitioning::Even => {
            let drop = 7 - exponent; // 1 to 7 bits below 2^-16
            let even = significand >> drop & 1; // ties go to it
            let nearest = (significand + ((1 << (drop - 1)) - 1) + even) >> drop; // 17 to 23 bits
            Factor { value: U16F16::from_bits(nearest), odd: partitioning == Partitioning::Odd }
        }
    }
}
