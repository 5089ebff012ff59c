//! Arithmetic: how many additions, multiplications and comparisons each block needs, and how wide,
//! from the counters of a frame and the formats of the configuration.
//!
//! Counted is what the blocks define, not what the simulator happens to do: no early exit, no
//! shortcut of an estimate. A value that a definition needs twice is computed once. Free are what
//! wires and carry inputs do: shifts, negation before an addition, rounding where a sum or product
//! is formed anyway, and seeing from the top bits that a result does not fit. A multiplication by a
//! small constant is its additions (3 x = 2 x + x). Addresses and loop counts are control.
//!
//! Divisions and roots are those of a multiplier and an 8-bit table, whose bits Newton's iteration
//! doubles step by step: `reciprocal`, `quotient`, `root`.

pub mod backface;
mod d3d11;
pub mod datapath;
mod esc;
mod level;

use crate::config::{Arithmetic, BackfaceMethod, Config, Form, Scheme, Termination, Unit};
use crate::shader::domain::ops::Widths;
use rtl_model::counter::standard::Ops;
use rtl_model::counter::{Block, Counter as C, Counters};

/// A piece of arithmetic: what is counted, how often a frame does it, and what once costs.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// The block.
    pub block: Block,
    /// What is counted, with its operations.
    pub meaning: &'static str,
    times: fn(&Frame<'_>) -> u64,
    once: fn(Formats) -> Ops,
}

impl Piece {
    /// What it costs to do it once.
    #[must_use]
    pub fn once(&self, config: &Config) -> Ops {
        (self.once)(Formats::of(config))
    }
}

/// Widths in bits.
#[derive(Clone, Copy, Debug)]
struct Formats {
    /// A position.
    w: u64,
    /// A forward-difference register.
    register: u64,
    /// A level's reciprocal, without the bit before the point.
    reciprocal: u64,
    /// A component of an attribute.
    attribute: u64,
    /// A screen coordinate.
    screen: u64,
    /// A coefficient of the surface shader, and its parameter.
    net: u64,
    parameter: u64,
    /// The order of operations of the domain shader, and its numbers.
    form: Form,
    domain: Widths,
}

impl Formats {
    fn of(config: &Config) -> Self {
        let w = u64::from(config.position.width);
        Self {
            w,
            register: w + u64::from(config.guard()) + 3,
            reciprocal: config.place.reciprocal_bits.into(),
            attribute: config.attributes.width.into(),
            screen: 16 + u64::from(config.emit.subpixel_bits),
            net: config.net_bits().into(),
            parameter: u64::from(config.esc.parameter_bits) + 1,
            form: config.form(),
            domain: match config.domain.arithmetic {
                Arithmetic::F32 => Widths::F32,
                Arithmetic::Fixed => {
                    Widths::Fixed { width: w, weight_bits: config.domain.weight_bits.into() }
                }
            },
        }
    }
}

/// A frame's counters and the configuration that they were counted under.
struct Frame<'a> {
    counters: &'a Counters,
    config: &'a Config,
}

impl Frame<'_> {
    fn get(&self, counter: C) -> u64 {
        self.counters.get(counter)
    }

    /// The back-face tests, if they go by this method.
    fn tested(&self, method: BackfaceMethod) -> u64 {
        if self.config.backface.method == method { self.get(C::BackfaceTested) } else { 0 }
    }

    /// Patches of which eight curves were divided until they were flat.
    fn eight_curves(&self) -> u64 {
        let divides = self.divides() && self.config.level.termination == Termination::EightCurves;
        if divides { self.get(C::LevelFlatness) } else { 0 }
    }

    /// Whether lists come from midpoints.
    fn divides(&self) -> bool {
        self.config.unit == Unit::Sfarti
    }

    /// What is done in units with fractional lists only.
    fn fractional(&self, counter: C) -> u64 {
        if self.divides() { 0 } else { self.get(counter) }
    }

    /// Curve points by de Casteljau. Boundary vertices are 2 V - T - 2 in each patch
    /// (T = 2 V - B - 2), and only the rest is his in the mixed scheme.
    fn curve_points(&self) -> u64 {
        let [vertices, triangles] = [C::EvaluateVertices, C::StitchTriangles].map(|c| self.get(c));
        let boundary = 2 * vertices - triangles - 2 * self.get(C::LevelPatches);
        match self.config.scheme() {
            Scheme::Forward => 0,
            Scheme::Mixed => self.get(C::EvaluateInvocations) - boundary,
            Scheme::DeCasteljau => self.get(C::EvaluateSteps),
        }
    }

    /// Middles of curves: of the points evaluated, those that are neither corners, which are
    /// copied, nor steps.
    fn centres(&self) -> u64 {
        let corners = 4 * self.get(C::LevelPatches);
        self.get(C::EvaluateInvocations) - corners - self.get(C::EvaluateSteps)
    }
}

/// Everything counted. Blocks without a line have no arithmetic of their own: link, memory and
/// assemble move what they get.
pub const PIECES: &[Piece] = &[
    Piece {
        block: Block::Transform,
        meaning: "a control point times a 4 x 4 matrix in f32: 16 multiplications and 12 additions \
                  of 24-bit significands",
        times: |f| f.get(C::TransformInvocations),
        once: transformation,
    },
    d3d11::THREAD,
    d3d11::DISTANCE,
    d3d11::GRANTED,
    Piece {
        block: Block::Port,
        meaning: "a control point rounded to the position format: 4 increments of W bits, for want \
                  of a sum that could take them; unit esc with tests in object units: as many \
                  again for the same point there",
        times: |f| f.get(C::PortPoints) * if f.wants_object() { 2 } else { 1 },
        once: |f| Ops::default().adds(4, f.w),
    },
    Piece {
        block: Block::Clip,
        meaning: "a patch against the clip volume: 16 points with 6 comparisons of W bits",
        times: |f| if f.config.clip.enabled { f.get(C::ClipIn) } else { 0 },
        once: |f| Ops::default().compares(16 * 6, f.w),
    },
    backface::TANGENT_PLANE,
    backface::NET_FACETS,
    backface::NORMAL_CONE,
    backface::HULL_LITERAL,
    level::GRANT,
    level::PROJECT,
    level::FLATNESS,
    level::EDGE_LENGTH,
    level::POWERS,
    level::SPLIT,
    level::FLAT,
    esc::THIRDS,
    esc::DISTANCE,
    Piece {
        block: Block::Place,
        meaning: "a patch's six levels, 24 bits: 8 comparisons to raise the interior's, 15 to find \
                  those that are equal (not in unit moreton, or in sfarti: there they are wires)",
        times: |f| {
            if f.config.unit == Unit::Moreton { 0 } else { f.fractional(C::LevelPatches) }
        },
        once: |_| Ops::default().compares(8 + 15, 24),
    },
    Piece {
        block: Block::Place,
        meaning: "unit moreton: a patch's four levels, 24 bits: 2 comparisons for the interior's, \
                  6 to find those that are equal",
        times: |f| if f.config.unit == Unit::Moreton { f.get(C::LevelPatches) } else { 0 },
        once: |_| Ops::default().compares(2 + 6, 24),
    },
    Piece {
        block: Block::Place,
        meaning: "a distinct level: its reciprocal, place.reciprocal_bits + 1 bits of quotient \
                  over 24, and the addition that rounds level / 2 up",
        times: |f| f.get(C::PlaceReciprocals),
        once: level_reciprocal,
    },
    Piece {
        block: Block::Place,
        meaning: "a parameter: one addition of the reciprocal's bits, the reciprocal again or \
                  1 - u (not in unit sfarti)",
        times: |f| f.fractional(C::PlaceParameters),
        once: |f| Ops::default().adds(1, f.reciprocal + 1),
    },
    d3d11::FACTORS,
    d3d11::POINTS,
    d3d11::CONNECT,
    Piece {
        block: Block::Evaluate,
        meaning: "a forward-difference step: 3 additions of a vec4, W + guard + 3 bits",
        times: |f| f.get(C::EvaluateSteps) - f.curve_points(),
        once: step,
    },
    Piece {
        block: Block::Evaluate,
        meaning: "a curve's two half-runs set up together: R^2 and R^3; for x y z w the cubic \
                  coefficient and its product, and from each end two more coefficients, their \
                  products and the sums D1, D2",
        times: |f| f.get(C::EvaluateCurves) / 2,
        once: set_up,
    },
    Piece {
        block: Block::Evaluate,
        meaning: "the middle of a curve, (a + d) + 3 (b + c): 4 additions of a vec4, W + 3 bits",
        times: |f| f.centres(),
        once: centre,
    },
    Piece {
        block: Block::Evaluate,
        meaning: "a curve point by de Casteljau: 1 - t, and 6 interpolations of a vec4, each 2 \
                  multiplications by 17 bits and an addition",
        times: |f| f.curve_points(),
        once: curve_point,
    },
    Piece {
        block: Block::Evaluate,
        meaning: "a component of an attribute: 3 interpolations, each 2 multiplications by 17 bits \
                  and an addition, of attributes.width bits; 1 - u and 1 - v are in the lists",
        times: |f| f.get(C::EvaluateAttributes),
        once: |f| Ops::default().muls(6, f.attribute, 17).adds(3, f.attribute + 18),
    },
    Piece {
        block: Block::Evaluate,
        meaning: "a tangent plane: 10 de Casteljau triangles, Su and Sv, and four 3 x 3 minors \
                  that share their 2 x 2 ones",
        times: |f| f.get(C::EvaluateNormals),
        once: plane,
    },
    Piece {
        block: Block::Stitch,
        meaning: "a triangle: the walk's error tested and moved, 8 bits each",
        times: |f| f.fractional(C::StitchTriangles),
        once: |_| Ops::default().adds(1, 8).compares(1, 8),
    },
    Piece {
        block: Block::Stitch,
        meaning: "unit sfarti, a triangle: the two rows' next parameters compared, 8 bits",
        times: |f| f.get(C::StitchTriangles) - f.fractional(C::StitchTriangles),
        once: |_| Ops::default().compares(1, 8),
    },
    d3d11::DOMAIN_POINT,
    d3d11::DOMAIN_PATCH,
    d3d11::NAIVE_POINT,
    d3d11::ATTRIBUTES,
    d3d11::NORMALS,
    esc::NET,
    esc::RUNS,
    esc::POINT,
    esc::BOUNDARY,
    esc::PIXELS,
    esc::OBJECT,
    esc::SLOT,
    esc::ATTRIBUTES,
    esc::NORMALS,
    Piece {
        block: Block::Emit,
        meaning: "a vertex divided: w > 0, x + w and w - y, both times the viewport's size (15 \
                  bits), one reciprocal of w, and two quotients",
        times: |f| if f.config.divides() { f.get(C::EmitVertices) } else { 0 },
        once: divide,
    },
    Piece {
        block: Block::VertexShader,
        meaning: "unit moreton: a vertex times a 4 x 4 matrix in f32, as a control point is \
                  elsewhere; what else a vertex shader computes is its program's",
        times: |f| f.get(C::VertexShaderInvocations),
        once: transformation,
    },
];

/// A 4 x 4 matrix in f32 times a vec4.
fn transformation(_: Formats) -> Ops {
    Ops::default().muls(16, 24, 24).adds(12, 24)
}

/// The arithmetic of `block` in a frame with these counters; `None` where it has none of its own.
pub(super) fn of(block: Block, counters: &Counters, config: &Config) -> Option<Ops> {
    let frame = Frame { counters, config };
    let formats = Formats::of(config);
    // Elsewhere a vertex shader has no arithmetic that is known here.
    let known = block != Block::VertexShader || config.unit.in_object_space();
    // A hull shader's program does what elsewhere are blocks.
    let program: &[Block] = match block {
        Block::Hull => &[Block::Hull, Block::Clip, Block::Backface, Block::Level],
        _ => &[block],
    };
    let pieces = PIECES.iter().filter(|piece| program.contains(&piece.block) && known);
    pieces.fold(None, |sum, piece| {
        let times = (piece.times)(&frame);
        Some(sum.unwrap_or_default().with(times, (piece.once)(formats)))
    })
}

/// Newton steps from the table's 8 bits to `bits`.
const fn newton_steps(bits: u64) -> u64 {
    bits.div_ceil(8).next_power_of_two().ilog2() as u64
}

/// 1 / d to `bits` bits: y (2 - d y), two multiplications and an addition a step.
fn reciprocal(bits: u64) -> Ops {
    let steps = newton_steps(bits);
    Ops::default().muls(2 * steps, bits, bits).adds(steps, bits)
}

/// What makes a quotient exact: it times the divisor, and the rest.
fn correction(quotient: u64, divisor: u64) -> Ops {
    Ops::default().muls(1, quotient, divisor).adds(1, quotient + divisor)
}

/// An exactly rounded quotient, from a reciprocal as wide as the divisor.
fn quotient(dividend: u64, divisor: u64, quotient: u64) -> Ops {
    Ops::default().muls(1, dividend, divisor).with(1, correction(quotient, divisor))
}

/// The root of a `2 bits` wide square, rounded up: 1 / sqrt by Newton, y (3 - x y y) / 2, three
/// multiplications and an addition a step; times x; and its square compared.
fn root(bits: u64) -> Ops {
    let steps = newton_steps(bits);
    Ops::default().muls(3 * steps + 2, bits, bits).adds(steps, bits).compares(1, 2 * bits)
}

/// 1 / level, and half a level rounded up.
fn level_reciprocal(f: Formats) -> Ops {
    let bits = f.reciprocal + 1;
    reciprocal(bits).with(1, correction(bits, 24)).adds(1, 24)
}

/// A step of forward differences.
fn step(f: Formats) -> Ops {
    Ops::default().adds(12, f.register)
}

/// (a + d) + 3 (b + c) of a vec4.
fn centre(f: Formats) -> Ops {
    Ops::default().adds(16, f.w + 3)
}

/// A curve point by de Casteljau.
fn curve_point(f: Formats) -> Ops {
    Ops::default().adds(1, 17).with(6, interpolation(f))
}

/// A vertex to the screen.
fn divide(f: Formats) -> Ops {
    let sides = Ops::default().compares(1, f.w).adds(2, f.w + 1).muls(2, f.w + 1, 15);
    sides.with(1, reciprocal(f.w)).with(2, quotient(f.w + 15, f.w, f.screen))
}

/// a (1 - t) + b t of a vec4.
fn interpolation(f: Formats) -> Ops {
    Ops::default().muls(8, f.w, 17).adds(4, f.w + 18)
}

/// `set_up` of `evaluate/forward.rs`: R has n bits, of 32; its powers 2 n and 3 n, at most 64;
/// coefficients W + 4, sums of products W + 7 and what the cubic's has.
fn set_up(f: Formats) -> Ops {
    let (first, second, third) = powers(f);
    let (coefficient, sum) = (f.w + 4, f.w + 7 + third);
    let end = Ops::default()
        .adds(3 + 2, coefficient) // b = 3 (p + s - 2 q), c = 3 (q - p)
        .muls(1, coefficient, second)
        .muls(1, coefficient, first)
        .adds(2 + 1, sum); // D1, D2; D3 is the cubic's own product
    let component = Ops::default()
        .adds(4, coefficient) // a = b3 - b0 + 3 (b1 - b2)
        .muls(1, coefficient, third)
        .adds(1, sum) // 6 a h3
        .with(2, end);
    Ops::default().muls(1, first, first).muls(1, second, first).with(4, component)
}

/// Bits of R, R^2 and R^3.
fn powers(f: Formats) -> (u64, u64, u64) {
    let bits = f.reciprocal;
    (bits, 2 * bits, (3 * bits).min(64))
}

/// `evaluate/normal.rs`: four rows and a column of points, four columns and a row of points.
fn plane(f: Formats) -> Ops {
    let (difference, minor) = (f.w + 1, 2 * f.w + 3);
    Ops::default()
        .adds(2, 17) // 1 - u, 1 - v
        .with(10 * 6, interpolation(f))
        .adds(2 * 4, difference)
        .muls(6 * 2, difference, difference)
        .adds(6, minor)
        .muls(4 * 3, f.w, minor)
        .adds(4 * 2, 3 * f.w + 5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newton_doubles_the_bits_of_a_table() {
        assert_eq!([8, 9, 16, 17, 32, 33, 64].map(newton_steps), [0, 1, 1, 2, 2, 3, 3]);
        // 32 bits: two steps of y (2 - d y)
        assert_eq!(reciprocal(32), Ops::default().muls(4, 32, 32).adds(2, 32));
    }

    #[test]
    fn a_set_up_costs_what_its_formulas_say_at_32_bits() {
        let once = set_up(Formats::of(&Config::default()));
        // x y z w: a (4), 6 a h3 (1), and from each end b (3), c (2), D1 (2), D2 (1)
        assert_eq!(once.add, 4 * (4 + 1 + 2 * (3 + 2 + 2 + 1)));
        // R^2, R^3; x y z w: a h3, and from each end b h2, c R
        assert_eq!(once.mul, 2 + 4 * (1 + 2 * 2));
        assert_eq!(once.mul_bits, 32 * 32 + 64 * 32 + 4 * (36 * 64 + 2 * (36 * 64 + 36 * 32)));
    }
}
