//! The arithmetic of unit `esc`: its levels of resolution and its surface shader.
//!
//! Widths: a coefficient W + 8 + guard, a parameter as configured and its integer bit, a pixel
//! Q24.16 40 bits, a number of segments 5, a site 9.

use super::level::point;
use super::{Formats, Frame, Piece, plane};
use crate::config::{Boundary, LevelPolicy, LevelScope, Space, Unit};
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C};

const PIXEL: u64 = 40;
const LEVEL: u64 = 24;
const COUNT: u64 = 5;
const SITE: u64 = 9;
/// Curves on the boundary, each from both of its ends.
const HALF_RUNS: u64 = 8;

pub(super) const THIRDS: Piece = Piece {
    block: Block::Level,
    meaning: "unit esc under a criterion: six levels held against the 15 multiples of 3, and the \
              greatest of them",
    times: |f| f.levels_by(LevelPolicy::Criterion),
    once: |_| Ops::default().compares(6 * 15, LEVEL).compares(5, COUNT),
};

pub(super) const DISTANCE: Piece = Piece {
    block: Block::Level,
    meaning: "unit esc by distance: each w against the near threshold, the least of four edges and \
              of 16 points, its 15 multiples, of which 7 are sums, against a distance, and the \
              greatest of the levels",
    times: |f| f.levels_by(LevelPolicy::Distance),
    once: |f| {
        let multiple = f.w + COUNT - 1;
        let level = Ops::default().adds(7, multiple).compares(15, multiple);
        Ops::default().compares(16 + 4 * 3 + 15, f.w).with(5, level).compares(4, COUNT)
    },
};

pub(super) const NET: Piece = Piece {
    block: Block::Surface,
    meaning: "a component of [N][B][M]^T, four of a net or three of one in object space: 8 \
              curves along u and v, each 3 p and its differences, 8 additions of W + 4 and W + 8 \
              bits",
    times: |f| 4 * f.get(C::SurfaceNets) + 3 * f.get(C::SurfaceObjectNets),
    once: |f| Ops::default().adds(4 * 8, f.w + 4).adds(4 * 8, f.w + 8),
};

pub(super) const RUNS: Piece = Piece {
    block: Block::Surface,
    meaning: "esc.boundary symmetric: the coefficients of four boundary curves from both of their \
              ends, 8 additions of a vec4 each",
    times: |f| if f.symmetric() { f.get(C::SurfaceNets) } else { 0 },
    once: |f| Ops::default().adds(HALF_RUNS * 8 * 4, f.w + 4),
};

pub(super) const POINT: Piece = Piece {
    block: Block::Surface,
    meaning: "a point by [U][NBM][V]: 15 steps of Horner of a vec4, and its rounding: those on \
              coarse edges, within coarse triangles and for tests alone, and under \
              esc.boundary plain those on the boundary",
    times: |f| f.get(C::SurfaceEvaluations) - f.by_half_runs(),
    once: |f| horner(f, 15),
};

pub(super) const BOUNDARY: Piece = Piece {
    block: Block::Surface,
    meaning: "esc.boundary symmetric, a point of the boundary: 3 steps of Horner of a vec4 from \
              the nearer corner, and its rounding",
    times: |f| f.by_half_runs(),
    once: |f| horner(f, 3),
};

pub(super) const PIXELS: Piece = Piece {
    block: Block::Surface,
    meaning: "a test in pixels, besides its point: a vec4 interpolated on the control mesh, both \
              projected, and their squared distance against mu squared",
    times: |f| f.tested_in(Space::Pixels),
    once: |f| {
        let ends = Ops::default().muls(2 * 4, f.w, COUNT).adds(4, f.w + COUNT);
        ends.muls(4, f.w + COUNT, f.w).with(2, point(f.w)).with(1, distance(2, PIXEL))
    },
};

pub(super) const OBJECT: Piece = Piece {
    block: Block::Surface,
    meaning: "a test in object units, besides its point: a point interpolated on the control mesh, \
              and their squared distance in x y z against mu squared",
    times: |f| f.tested_in(Space::Object),
    once: |f| {
        let ends = Ops::default().muls(2 * 3, f.w, COUNT).adds(3, f.w + COUNT);
        ends.muls(3, f.w + COUNT, f.w).with(1, distance(3, f.w))
    },
};

pub(super) const SLOT: Piece = Piece {
    block: Block::Surface,
    meaning: "a slot of a strip: its three vertices held against one another, 9 bits, and the \
              counter of a spread row",
    times: |f| f.get(C::SurfaceSlots),
    once: |_| Ops::default().compares(3, SITE).adds(1, COUNT),
};

pub(super) const ATTRIBUTES: Piece = Piece {
    block: Block::Surface,
    meaning: "a component of an attribute, as in evaluate",
    times: |f| f.get(C::SurfaceAttributes),
    once: |f| Ops::default().muls(6, f.attribute, 17).adds(3, f.attribute + 18),
};

pub(super) const NORMALS: Piece = Piece {
    block: Block::Surface,
    meaning: "a tangent plane, as in evaluate",
    times: |f| f.get(C::SurfaceNormals),
    once: plane,
};

/// So many steps of Horner: a vec4 times the parameter, rounded, and the next coefficient added.
fn horner(f: Formats, steps: u64) -> Ops {
    let product = Ops::default().muls(4 * steps, f.net, f.parameter);
    product.adds(4 * steps, f.net).adds(4, f.w)
}

/// The squared distance of two points in so many dimensions, compared.
fn distance(dimensions: u64, width: u64) -> Ops {
    let difference = width + 1;
    Ops::default()
        .adds(dimensions, difference)
        .muls(dimensions, difference, difference)
        .adds(dimensions - 1, 2 * difference + 1)
        .compares(1, 2 * difference + 2)
}

impl Frame<'_> {
    /// Patches whose levels each edge has by such a policy.
    fn levels_by(&self, policy: LevelPolicy) -> u64 {
        let esc = &self.config.esc;
        let by_edge = self.config.unit == Unit::Esc && esc.scope == LevelScope::Patch;
        if by_edge && esc.level == policy { self.get(C::LevelPatches) } else { 0 }
    }

    /// Whether levels come neither from a criterion nor from what one measures.
    pub(super) fn without_criterion(&self) -> bool {
        let esc = &self.config.esc;
        let level = matches!(esc.level, LevelPolicy::Fixed | LevelPolicy::Distance);
        self.config.unit == Unit::Esc && (level || esc.scope == LevelScope::Object)
    }

    fn symmetric(&self) -> bool {
        self.config.esc.boundary == Boundary::Symmetric
    }

    /// Points that are evaluated from the nearer corner.
    fn by_half_runs(&self) -> u64 {
        let boundary = self.get(C::SurfaceBoundary) + self.get(C::SurfaceTestedBoundary);
        if self.symmetric() { boundary } else { 0 }
    }

    /// Whether control points are wanted in object space beside clip space.
    pub(super) fn wants_object(&self) -> bool {
        self.config.unit == Unit::Esc && self.config.esc.tests_in_object_space()
    }

    fn tested_in(&self, space: Space) -> u64 {
        if self.config.esc.space == space { self.get(C::SurfaceTests) } else { 0 }
    }
}
