//! The hull and the domain shader as the first implementation runs them on one patch.

use super::reachable;
use rtl_model::level::{self, State};
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::patch::{Levels, ONE, Patch, Vertex, View};
use rtl_model::port;
use tessim::config::{Arithmetic, Config, FactorPolicy};
use tessim::shader::domain::{self, Evaluator, Fixed, Orientations, Single};
use tessim::shader::hull::{self, Adaptive};

/// Factors as the hull shader writes them.
pub(super) fn factors(
    config: &Config,
    view: &View,
    patch: &Patch,
    state: &State,
    shaded: &[[f32; 4]; 16],
) -> [u32; 6] {
    let state = reachable(config, state);
    let [min, max] = [state.min, state.max].map(|level| level.fx16() as f32 / 65536.0);
    let factors = if config.hull.policy == FactorPolicy::Adaptive {
        let near = (view.near as f64 * f64::from(-view.position.fraction).exp2()) as f32;
        let settings = hull::Settings {
            candidates: config.hull.candidates,
            pixels: config.hull.pixels as f32,
            viewport: view.viewport,
            near,
        };
        Adaptive::new(settings).factors(shaded).factors.map(|factor| factor.clamp(min, max))
    } else {
        let Levels { edges: [v0, u1, v1, u0], interior: [u, v] } =
            level::accept(patch, view, &state).0;
        [u0, v0, u1, v1, u, v].map(|level| level.fx16() as f32 / 65536.0)
    };
    let pow2 = config.tessellator.partitioning == rtl_model::d3d11::Partitioning::Pow2;
    let up = |factor: f32| (factor.ceil() as u32).next_power_of_two() as f32;
    factors.map(|factor| if pow2 { up(factor) } else { factor }.to_bits())
}

/// What the domain shader makes of the sites: vertices, coordinates that did not fit, cracks.
pub(super) fn shade(
    config: &Config,
    view: &View,
    patch: &Patch,
    shaded: &[[f32; 4]; 16],
    sites: &[[u32; 2]],
) -> (Vec<Vertex>, u64, u64) {
    let boundary: Vec<[u32; 2]> = sites
        .iter()
        .copied()
        .filter(|[u, v]| [0, ONE].contains(u) != [0, ONE].contains(v))
        .collect();
    match config.domain.arithmetic {
        Arithmetic::F32 => {
            let single = Single::new(config.form());
            let net = single.net(shaded);
            let mut points = Vec::new();
            single.visit(&net, sites, &mut |p, _| points.push(p.map(f32::to_bits)));
            let accept = Accept { points, sites, format: view.position };
            let (rounding, overflow) = (config.position.rounding, config.position.overflow);
            let (vertices, over) = dispatch(rounding, overflow, accept);
            let turned = Orientations::new(&single, shaded);
            let cracks = boundary.iter().filter(|&&site| turned.crack(site)).count();
            (vertices, over, cracks as u64)
        }
        Arithmetic::Fixed => {
            let settings = domain::Settings {
                position: view.position,
                weight_bits: config.domain.weight_bits,
                rounding: config.evaluate.rounding,
                overflow: config.position.overflow,
            };
            let fixed = Fixed::new(config.form(), settings);
            let (mut vertices, mut over) = (Vec::new(), 0);
            fixed.visit(&fixed.net(&patch.points), sites, &mut |position, overflows| {
                let [u, v] = sites[vertices.len()];
                vertices.push(Vertex { position, u, v });
                over += u64::from(overflows);
            });
            let turned = Orientations::new(&fixed, &patch.points);
            let cracks = boundary.iter().filter(|&&site| turned.crack(site)).count();
            (vertices, over, cracks as u64)
        }
    }
}

struct Accept<'a> {
    points: Vec<[u32; 4]>,
    sites: &'a [[u32; 2]],
    format: Format,
}

impl Modal for Accept<'_> {
    type Output = (Vec<Vertex>, u64);

    fn run<R: RoundingMode, O: OverflowMode>(self) -> (Vec<Vertex>, u64) {
        let mut over = 0;
        let accept = |(bits, &[u, v]): (&[u32; 4], &[u32; 2])| {
            let quantised = port::accept::<R, O>(*bits, self.format);
            over += u64::from(quantised.overflows);
            Vertex { position: quantised.point, u, v }
        };
        (self.points.iter().zip(self.sites).map(accept).collect(), over)
    }
}
