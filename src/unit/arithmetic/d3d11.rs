//! The arithmetic of unit `d3d11`. Its hull shader does besides what clip, backface and level do
//! elsewhere: their lines are counted as its own.
//!
//! Widths: a factor in 16.16 has 32 bits, a parameter 17, a reciprocal from the table 17 with its
//! index of 7, an index of a point 13; shaders work in f32, 24-bit significands, or as configured.

use super::{Frame, Piece, plane, reciprocal, transformation};
use crate::config::{DomainKind, FactorPolicy, Unit};
use crate::shader::domain::ops::{naive_point, patch, point};
use crate::shader::hull::{self, RECIPROCALS};
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C};

/// Bits of a significand.
const SIGNIFICAND: u64 = 24;
/// Bits of a factor.
const FACTOR: u64 = 32;
/// Bits of a parameter, and of 1 / n.
const PARAMETER: u64 = 17;
/// Bits of a count of segments.
const COUNT: u64 = 7;
/// Bits of a point's index.
const INDEX: u64 = 13;

pub(super) const THREAD: Piece = Piece {
    block: Block::Hull,
    meaning: "a control-point thread: its point times a 4 x 4 matrix in f32, 16 multiplications \
              and 12 additions of 24-bit significands",
    times: |f| f.get(C::HullThreads),
    once: transformation,
};

pub(super) const DISTANCE: Piece = Piece {
    block: Block::Hull,
    meaning: "hull.policy adaptive, a distance test: a point of the control polygon and one of the \
              curve in x, y and w, two reciprocals of w, both projected, and the square of their \
              distance",
    times: |f| f.get(C::HullDistanceTests),
    once: |_| hull::test().with(RECIPROCALS, reciprocal(SIGNIFICAND)),
};

pub(super) const GRANTED: Piece = Piece {
    block: Block::Hull,
    meaning: "hull.policy adaptive, a patch: its six factors against min and max, 24 bits, and the \
              greatest of four of 6 bits along each direction",
    times: |f| if f.adaptive() { f.get(C::LevelPatches) } else { 0 },
    once: |_| Ops::default().compares(12, SIGNIFICAND).compares(2 * 3, 6),
};

pub(super) const FACTORS: Piece = Piece {
    block: Block::Factors,
    meaning: "a factor: rounded to 16.16, held against 0 and two bounds, halved upwards, half a \
              segment added by parity, floor and ceiling",
    times: |f| f.get(C::FactorsProcessed),
    once: |_| Ops::default().adds(1, SIGNIFICAND).compares(3, FACTOR).adds(3, FACTOR),
};

pub(super) const POINTS: Piece = Piece {
    block: Block::Points,
    meaning: "a parameter: its number against the half and the split, that number times 1 / n of \
              both partitions, times the fraction and its complement, their sum, rounded, and 1 \
              minus it",
    times: |f| f.get(C::PointsParameters),
    once: |_| {
        let places = Ops::default().compares(2, COUNT).adds(2, COUNT);
        let products = places.muls(2, COUNT, PARAMETER).muls(2, PARAMETER, PARAMETER);
        products.adds(2, 2 * PARAMETER).adds(1, PARAMETER)
    },
};

pub(super) const CONNECT: Piece = Piece {
    block: Block::Connect,
    meaning: "a triangle: a row's place in the table of positions against its count, and the next \
              index",
    times: |f| f.get(C::ConnectTriangles),
    once: |_| Ops::default().compares(1, COUNT).adds(1, INDEX),
};

pub(super) const DOMAIN_POINT: Piece = Piece {
    block: Block::Domain,
    meaning: "domain.shader basis, a point by domain.form: Bernstein weights of u and v and five \
              weighted sums of a vec4, or five cubics by Horner",
    times: |f| f.shaded(DomainKind::Basis),
    once: |f| point(f.form, f.domain),
};

pub(super) const DOMAIN_PATCH: Piece = Piece {
    block: Block::Domain,
    meaning: "domain.shader basis, a patch by domain.form: the power basis's [N][B][M]^T of a \
              vec4; nothing in the others",
    times: |f| match f.config.domain.shader {
        DomainKind::Basis => f.get(C::LevelPatches),
        DomainKind::Naive => 0,
    },
    once: |f| patch(f.form, f.domain),
};

pub(super) const NAIVE_POINT: Piece = Piece {
    block: Block::Domain,
    meaning: "domain.shader naive, a point by domain.form: the whole product",
    times: |f| f.shaded(DomainKind::Naive),
    once: |f| naive_point(f.form, f.domain),
};

pub(super) const ATTRIBUTES: Piece = Piece {
    block: Block::Domain,
    meaning: "a component of an attribute: 3 interpolations, each 2 multiplications by 17 bits \
              and an addition, of attributes.width bits",
    times: |f| f.get(C::DomainAttributes),
    once: |f| Ops::default().muls(6, f.attribute, PARAMETER).adds(3, f.attribute + 18),
};

pub(super) const NORMALS: Piece = Piece {
    block: Block::Domain,
    meaning: "a tangent plane, as in evaluate",
    times: |f| f.get(C::DomainNormals),
    once: plane,
};

impl Frame<'_> {
    /// Whether factors come from distance tests.
    pub(super) fn adaptive(&self) -> bool {
        self.config.unit == Unit::D3d11 && self.config.hull.policy == FactorPolicy::Adaptive
    }

    /// Points shaded by a shader of that kind.
    fn shaded(&self, kind: DomainKind) -> u64 {
        if self.config.domain.shader == kind { self.get(C::DomainInvocations) } else { 0 }
    }
}
