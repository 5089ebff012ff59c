//! `d3d11`: what ships today, as Direct3D 11, OpenGL 4 and Vulkan define it. A hull shader chooses
//! tessellation factors, or culls by a factor of zero; fixed functions make points of the domain
//! and join them; a domain shader evaluates each point by itself.
//!
//! ```text
//!   patch ─► hull shader ─► factors ─► points ─► connect ─► domain shader ─► emit
//!            16 control-point threads            cache      waves
//!            1 patch-constant function
//! ```
//!
//! The control-point threads transform their points to clip space. The patch-constant function
//! culls and chooses levels by the definitions that the other units' blocks have, so that units
//! differ in what they do and not in how fine they are asked to be; or by the distance test of
//! Concheiro et al. 2014 (`hull.policy`). The greatest factor is 64, under odd partitioning 63.

mod shape;

use super::chain::Pattern;
use super::frame::FrameState;
use super::pipeline::{Input, Make, Placed, Placing};
use crate::config::{Config, FactorPolicy, Partitioning};
use crate::shader::hull::{self, Adaptive};
use rtl_model::counter::{Counter, Counters};
use rtl_model::d3d11::Factors;
use rtl_model::level::{self, Criterion, Events, State};
use rtl_model::patch::{Level, Levels, Triangle, Vertex};

use shape::Shape;

/// Bytes that a hull shader hands on for a patch: 16 vec4 and six factors.
const HULL_BYTES: u64 = 16 * 16 + 6 * 4;

/// Bytes that the hull shader hands on for a patch whose vertices have attributes of so many
/// components: those of four corners too.
pub(super) fn hull_bytes(components: u64, config: &Config) -> u64 {
    HULL_BYTES + 4 * components * config.attributes.component_bytes()
}

/// The shaders and fixed functions of a frame.
pub(super) struct D3d11 {
    partitioning: Partitioning,
    adaptive: Option<Adaptive>,
    shape: Shape,
}

impl Make for D3d11 {
    type Lists = Pattern;
    const CULLS: bool = true;

    fn new(config: &Config, frame: &FrameState) -> Self {
        let adaptive = || {
            Adaptive::new(hull::Settings {
                candidates: config.hull.candidates,
                pixels: config.hull.pixels as f32,
                viewport: frame.view.viewport,
                near: frame.near(),
            })
        };
        Self {
            partitioning: config.tessellator.partitioning,
            adaptive: (config.hull.policy == FactorPolicy::Adaptive).then(adaptive),
            shape: Shape::new(config, frame),
        }
    }

    fn enter(&self, input: &Input<'_>) -> Pattern {
        Pattern { hull_bytes: input.hull_bytes, ..Pattern::default() }
    }

    fn cull(&self, counters: &mut Counters) {
        counters.add(Counter::FactorsCulled, 1);
    }

    fn place(&mut self, work: Placing<'_>, counters: &mut Counters) -> Placed<Pattern> {
        let Input { seen, view, .. } = *work.input;
        let input = work.input;
        let state = reachable(input.state, self.partitioning);
        let (factors, events, criterion) = match &self.adaptive {
            None => {
                let (levels, events) = level::accept(seen, view, &state);
                (in_order(&levels), events, state.criterion)
            }
            Some(adaptive) => {
                let hull::Factors { factors, tests } = adaptive.factors(input.shaded);
                counters.add(Counter::HullDistanceTests, tests.into());
                let (factors, clamped) = granted(factors, &state);
                let events = Events { clamped, ..Events::default() };
                (factors, events, Criterion::Fixed { level: Level::MIN })
            }
        };
        let bits = written(factors, self.partitioning);
        let factors = Factors::quad(self.partitioning, bits).expect("factors are at least 1");
        let lists = Pattern { factors, hull_bytes: input.hull_bytes };
        Placed { lists, events, criterion, levels: 0, reciprocals: 0 }
    }

    fn shape(
        &mut self,
        lists: &mut Pattern,
        input: &Input<'_>,
        vertices: &mut Vec<Vertex>,
        counters: &mut Counters,
    ) -> u64 {
        self.shape.accept(lists, input, vertices, counters)
    }

    fn triangles(&self) -> &[Triangle] {
        self.shape.triangles()
    }
}

/// The tessellation state, within what a partitioning reaches.
fn reachable(state: &State, partitioning: Partitioning) -> State {
    let most = match partitioning {
        Partitioning::Odd => 63,
        Partitioning::Integer | Partitioning::Pow2 | Partitioning::Even => 64,
    };
    let most = Level::clamped(most << 16);
    State { min: state.min.min(most), max: state.max.min(most), ..*state }
}

/// Levels as factors in the order Ueq0 Veq0 Ueq1 Veq1 InU InV: exact, for a level has 24 bits.
fn in_order(levels: &Levels) -> [f32; 6] {
    let [v0, u1, v1, u0] = levels.edges;
    let [u, v] = levels.interior;
    [u0, v0, u1, v1, u, v].map(|level| level.fx16() as f32 / 65536.0)
}

/// What the hull shader writes: under pow2 it is the shader that rounds up to powers of two, and
/// the tessellator that trusts it.
fn written(factors: [f32; 6], partitioning: Partitioning) -> [u32; 6] {
    let rounded = |factor: f32| match partitioning {
        Partitioning::Pow2 => (factor.ceil() as u32).next_power_of_two() as f32,
        Partitioning::Integer | Partitioning::Odd | Partitioning::Even => factor,
    };
    factors.map(|factor| rounded(factor).to_bits())
}

/// Factors within the bounds of the state, and how many were above.
fn granted(factors: [f32; 6], state: &State) -> ([f32; 6], u32) {
    let [min, max] = [state.min, state.max].map(|level| level.fx16() as f32 / 65536.0);
    let clamped = factors.iter().filter(|&&factor| factor > max).count() as u32;
    (factors.map(|factor| factor.clamp(min, max)), clamped)
}

/// Counts what the hull shader does for patches of a draw, whatever becomes of them: what it reads
/// of each, and what it hands on.
pub(super) fn count_hull(
    patches: u64,
    bytes_in: u64,
    components: u64,
    config: &Config,
    counters: &mut Counters,
) {
    let out = hull_bytes(components, config);
    counters.add(Counter::HullInvocations, patches);
    counters.add(Counter::HullThreads, 16 * patches);
    counters.add(Counter::HullBytesIn, patches * bytes_in);
    counters.add(Counter::HullBytesOut, patches * out);
    counters.add(Counter::FactorsProcessed, 6 * patches);
    if config.hull.to_memory {
        counters.add(Counter::MemoryWrittenPatches, patches * out);
        count_bursts(patches, out, config, counters);
    } else {
        counters.add(Counter::HullBytesOnChip, patches * out);
    }
}

/// Counts the bursts of so many patches of so many bytes.
fn count_bursts(patches: u64, bytes: u64, config: &Config, counters: &mut Counters) {
    let burst = u64::from(config.memory.burst);
    let bursts = bytes.div_ceil(burst);
    counters.add(Counter::MemoryBursts, patches * bursts);
    counters.add(Counter::MemoryPatchBursts, patches * bursts);
    counters.add(Counter::MemoryWasted, patches * (bursts * burst - bytes));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(segments: f64) -> Level {
        Level::clamped((segments * 65536.0) as u64)
    }

    #[test]
    fn levels_stand_in_the_order_of_the_tessellator() {
        let edges = [1.5, 2.0, 3.25, 4.0].map(level); // v0 u1 v1 u0
        let levels = Levels { edges, interior: [5.0, 6.75].map(level) };
        assert_eq!(in_order(&levels), [4.0, 1.5, 2.0, 3.25, 5.0, 6.75]);
    }

    #[test]
    fn the_hull_shader_rounds_up_to_powers_of_two_where_the_tessellator_trusts_it_to() {
        let factors = [1.0, 1.25, 2.0, 4.5, 33.0, 64.0];
        let of = |partitioning| written(factors, partitioning).map(f32::from_bits);
        assert_eq!(of(Partitioning::Pow2), [1.0, 2.0, 2.0, 8.0, 64.0, 64.0]);
        for partitioning in [Partitioning::Integer, Partitioning::Odd, Partitioning::Even] {
            assert_eq!(of(partitioning), factors);
        }
    }

    #[test]
    fn what_the_tessellator_does_not_reach_is_clamped_and_counted() {
        let state = |min, max| State {
            criterion: Criterion::Fixed { level: Level::MIN },
            min: level(min),
            max: level(max),
        };
        let odd = reachable(&state(1.0, 128.0), Partitioning::Odd);
        assert_eq!((odd.min, odd.max), (level(1.0), level(63.0)));
        let even = reachable(&state(70.0, 128.0), Partitioning::Even);
        assert_eq!((even.min, even.max), (level(64.0), level(64.0)));
        let (factors, clamped) = granted([3.0, 9.0, 12.0, 12.0, 4.0, 12.5], &state(4.0, 12.0));
        assert_eq!((factors, clamped), ([4.0, 9.0, 12.0, 12.0, 4.0, 12.0], 1));
    }

    #[test]
    fn a_patch_is_handed_on_in_280_bytes_and_its_corners_attributes() {
        let config = Config::default(); // components of 32 bits
        assert_eq!([0, 1, 6].map(|n| hull_bytes(n, &config)), [280, 296, 376]);
    }
}
