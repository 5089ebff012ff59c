//! Program: how long shader programs are, counted the same way for ESC and for a domain shader, and
//! how processors run them.
//!
//! An instruction is one of a vec4: an addition, a multiplication, or a multiplication with the
//! addition that follows it. What is scalar is packed four to an instruction.
//!
//! ```text
//!   [N][B][M]^T    8 curves, each three products by 3 and five differences        64
//!   [U][NBM][V]    5 cubics by Horner, 3 multiply-adds each, and rounding         16
//!   Bernstein      weights of u and v, 9 scalars each; 5 paired sums of 5; out    31
//!   a slot         the walk, a comparison, the output                              4
//!   a test         an interpolation, two projections, a squared length            24
//!   a matrix       4 multiply-adds                                                 4
//! ```
//!
//! A naive domain shader forms the whole product for each point: 64 + 16. One that works by basis
//! functions has nothing that a patch could share: 31. ESC forms the product once an invocation,
//! and has a slot for each triangle of a strip: joining points is the tessellator's for `d3d11`,
//! and takes no shader there.
//!
//! A processor has 16 lanes and runs waves of 64, so an instruction takes 4 cycles, and another 200
//! pass from a wave's last instruction to its output, hidden by other waves. The processors are
//! given whole to each shader: they do not compete. Control-point threads are of a matrix each.

use crate::config::{Config, DomainKind};

/// Instructions of `[N][B][M]^T`.
pub const NET: u32 = 64;
/// Instructions of a point from it.
pub const POINT: u32 = 16;
/// Instructions of a point by Bernstein polynomials.
pub const BERNSTEIN: u32 = 31;
/// Instructions of a slot of a strip.
pub const SLOT: u32 = 4;
/// Instructions of a test besides its point.
pub const TEST: u32 = 24;
/// Instructions of a control-point thread.
const MATRIX: u32 = 4;
/// Lanes of a processor.
const LANES: u32 = 16;
/// Invocations of a wave.
const WAVE: u32 = 64;
/// Cycles behind a program.
const LATENCY: u32 = 200;

/// Instructions of a point in a domain shader.
#[must_use]
pub const fn domain(shader: DomainKind) -> u32 {
    match shader {
        DomainKind::Naive => NET + POINT,
        DomainKind::Basis => BERNSTEIN,
    }
}

/// The same processors for either unit.
pub(super) fn equal_cores(config: &mut Config, processors: u32) {
    let instruction = WAVE / LANES;
    config.esc.width = WAVE;
    config.domain.width = WAVE;
    let waves = config.esc.waves_in_flight();
    let surface = &mut config.block.surface;
    (surface.net, surface.point, surface.slot, surface.test) = (NET, POINT, SLOT, TEST);
    (surface.costs.interval, surface.costs.latency) = (instruction, LATENCY);
    (surface.costs.lanes, surface.costs.in_flight) = (processors, Some(waves));
    let interval = instruction * domain(config.domain.shader);
    let shader = &mut config.block.domain;
    (shader.interval, shader.latency) = (Some(interval), interval + LATENCY);
    (shader.lanes, shader.in_flight) = (processors, Some(waves));
    for threads in [&mut config.block.transform, &mut config.block.hull] {
        (threads.interval, threads.latency) = (MATRIX, LATENCY);
        threads.lanes = processors * LANES;
        threads.in_flight = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Form;
    use crate::shader::domain::ops::{Widths, naive_point, patch, point};
    use rtl_model::counter::standard::Ops;

    /// No fewer instructions than the additions or the multiplications need, and not twice as many
    /// as both.
    #[track_caller]
    fn fits(instructions: u32, ops: Ops) {
        let (n, add, mul) = (4 * u64::from(instructions), ops.add, ops.mul);
        assert!(n >= add.max(mul) && n <= add + mul + 4, "{n} for {add} + {mul}");
    }

    #[test]
    fn programs_are_as_long_as_the_operations_that_are_counted_need() {
        let f32 = Widths::F32;
        fits(NET, patch(Form::Power, f32));
        fits(POINT, point(Form::Power, f32));
        fits(BERNSTEIN, point(Form::Paired, f32));
        fits(domain(DomainKind::Naive), naive_point(Form::Power, f32));
        assert_eq!((domain(DomainKind::Naive), domain(DomainKind::Basis)), (80, 31));
    }

    #[test]
    fn both_shaders_have_the_same_processors() {
        let mut config = Config::default();
        equal_cores(&mut config, 20);
        let [surface, domain] =
            [rtl_model::counter::Block::Surface, rtl_model::counter::Block::Domain]
                .map(|block| config.costs(block).unwrap());
        assert_eq!((surface.lanes, domain.lanes), (20, 20));
        assert_eq!(surface.in_flight(), domain.in_flight());
        assert_eq!(domain.interval, 4 * 31);
        assert!(config.check().is_ok());
    }
}
