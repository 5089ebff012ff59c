//! What each block costs in time: its cycles, its lanes and the FIFO before it, as keys
//! `block.NAME.*`. Assumptions all, each with its reason in the meaning of its key.
//!
//! The rules that these numbers enter are those of `rtl_model::time`: a lane accepts an item every
//! `interval` cycles, its result is there `latency` cycles later, and up to `in_flight` tokens are
//! under way in a lane at once. A block takes at most one token a cycle and gives one a cycle,
//! however many lanes it has.

use super::{BackfaceMethod, Config, Domain, DomainKind};
use rtl_model::counter::Block;
use rtl_model::time::{LaneOrder, Shape};
use serde::{Deserialize, Serialize};

/// Greatest interval and latency in cycles.
pub const CYCLES_MAX: u32 = 1_000_000;
/// Most entries of a FIFO, and most tokens in flight in a lane.
pub const ENTRIES_MAX: u32 = 1 << 16;
/// Most lanes of a block.
pub const LANES_MAX: u32 = 1 << 12;

/// The blocks that have costs, in the order of the data.
pub const TIMED: [Block; 18] = [
    Block::Transform,
    Block::Port,
    Block::Assemble,
    Block::Hull,
    Block::Clip,
    Block::Backface,
    Block::Level,
    Block::Place,
    Block::Factors,
    Block::Points,
    Block::Connect,
    Block::Evaluate,
    Block::Stitch,
    Block::Domain,
    Block::Group,
    Block::Surface,
    Block::Emit,
    Block::VertexShader,
];

/// Cycles from a tested patch's last product to its verdict: a three-deep tree of multipliers, each
/// of two cycles, and a register before and behind it.
const BACKFACE_DRAIN: u32 = 8;
/// What a patch costs that back-face removal passes on untested: it goes by the multipliers.
const UNTESTED: (u32, u32) = (1, 1);

/// Cycles a point of a domain shader that reads 16 control points of 16 bytes for each, 64 bytes a
/// cycle.
const NAIVE_CYCLES: u32 = 4;

/// The costs of a block.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlockCosts {
    /// Cycles a work item, from one to the next on the same lane, 1..=[`CYCLES_MAX`].
    pub interval: u32,
    /// Cycles from a work item's acceptance to its result, 0..=[`CYCLES_MAX`].
    pub latency: u32,
    /// Tokens under way in a lane at once, 1..=[`ENTRIES_MAX`]; floor(latency / interval) + 1 when
    /// absent, which is what hides the latency, and a few where a token is several items
    /// ([`Config::costs`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_flight: Option<u32>,
    /// Lanes, 1..=[`LANES_MAX`].
    pub lanes: u32,
    /// Which lane takes the next token.
    pub lane_order: LaneOrder,
    /// Entries of the FIFO before the block, 1..=[`ENTRIES_MAX`].
    pub fifo: u32,
}

/// The costs of back-face removal. Interval and latency are those of a patch that is tested, and
/// follow from the method when absent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BackfaceCosts {
    /// As [`BlockCosts::interval`]; by method when absent: 18 (`net_facets`), 81
    /// (`tangent_plane`), 36 (`normal_cone`) or 560 (`hull_literal`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<u32>,
    /// As [`BlockCosts::latency`]; interval + 8 when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency: Option<u32>,
    /// As [`BlockCosts::in_flight`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_flight: Option<u32>,
    /// As [`BlockCosts::lanes`].
    pub lanes: u32,
    /// As [`BlockCosts::lane_order`].
    pub lane_order: LaneOrder,
    /// As [`BlockCosts::fifo`].
    pub fifo: u32,
}

/// The costs of the domain shader. The interval is that of a wave.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DomainCosts {
    /// As [`BlockCosts::interval`]; a cycle a point when absent, or four under
    /// [`DomainKind::Naive`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<u32>,
    /// As [`BlockCosts::latency`].
    pub latency: u32,
    /// As [`BlockCosts::in_flight`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_flight: Option<u32>,
    /// As [`BlockCosts::lanes`].
    pub lanes: u32,
    /// As [`BlockCosts::lane_order`].
    pub lane_order: LaneOrder,
    /// As [`BlockCosts::fifo`].
    pub fifo: u32,
}

/// The costs of the surface shader. Its program is counted in instructions of a vec4 each; the
/// interval is that of an instruction.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SurfaceCosts {
    /// Those that all blocks have: the interval is that of an instruction of a wave, the latency
    /// that from a wave's last instruction to its output; as many waves are under way as registers
    /// hold.
    #[serde(flatten)]
    pub costs: BlockCosts,
    /// Instructions of a product `[N][B][M]^T`, 0..=[`CYCLES_MAX`].
    pub net: u32,
    /// Instructions of a test, without the point that it takes.
    pub test: u32,
    /// Instructions of a point.
    pub point: u32,
    /// Instructions of a slot of a strip.
    pub slot: u32,
}

/// The costs of evaluate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvaluateCosts {
    /// Those that all blocks have.
    #[serde(flatten)]
    pub costs: BlockCosts,
    /// Cycles to set up a curve's differences, its two half-runs together, 0..=[`CYCLES_MAX`];
    /// overlapped with the run of the curve before.
    pub setup: u32,
}

/// The costs of all blocks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Blocks {
    /// The control-point shader.
    pub transform: BlockCosts,
    /// The input port.
    pub port: BlockCosts,
    /// Primitives to patches.
    pub assemble: BlockCosts,
    /// The hull shader.
    pub hull: BlockCosts,
    /// Trivial clipping.
    pub clip: BlockCosts,
    /// Back-face removal.
    pub backface: BackfaceCosts,
    /// Tessellation levels.
    pub level: BlockCosts,
    /// Parameter lists.
    pub place: BlockCosts,
    /// Tessellation factors.
    pub factors: BlockCosts,
    /// Domain points.
    pub points: BlockCosts,
    /// What joins them.
    pub connect: BlockCosts,
    /// Points of the surface.
    pub evaluate: EvaluateCosts,
    /// Triangles.
    pub stitch: BlockCosts,
    /// The domain shader.
    pub domain: DomainCosts,
    /// Patches to waves.
    pub group: BlockCosts,
    /// The surface shader.
    pub surface: SurfaceCosts,
    /// Perspective divide and output.
    pub emit: BlockCosts,
    /// The vertex shader.
    pub vertex_shader: BlockCosts,
}

impl Default for Blocks {
    /// The reasons stand in [`KEYS`](super::keys::KEYS).
    fn default() -> Self {
        let (lanes, lane_order) = (1, LaneOrder::FirstFree);
        let costs = |interval, latency, fifo| BlockCosts {
            interval,
            latency,
            in_flight: None,
            lanes,
            lane_order,
            fifo,
        };
        Self {
            transform: costs(1, 200, 32),
            port: costs(1, 1, 32),
            assemble: costs(1, 1, 32),
            hull: costs(1, 200, 4),
            clip: costs(4, 5, 4),
            backface: BackfaceCosts {
                interval: None,
                latency: None,
                in_flight: None,
                lanes,
                lane_order,
                fifo: 4,
            },
            level: costs(1, 16, 4),
            place: costs(1, 16, 4),
            factors: costs(1, 8, 4),
            points: costs(1, 4, 4),
            connect: costs(1, 2, 4),
            evaluate: EvaluateCosts { costs: costs(1, 4, 4), setup: 16 },
            stitch: costs(1, 1, 2),
            domain: DomainCosts {
                interval: None,
                latency: 200,
                in_flight: None,
                lanes,
                lane_order,
                fifo: 4,
            },
            group: costs(1, 1, 4),
            surface: SurfaceCosts {
                costs: costs(4, 200, 2),
                net: 64,
                test: 24,
                point: 16,
                slot: 4,
            },
            emit: costs(1, 16, 16),
            vertex_shader: costs(1, 200, 32),
        }
    }
}

impl BlockCosts {
    /// Tokens under way in a lane at once: as configured, else as many as hide the latency.
    #[must_use]
    pub fn in_flight(&self) -> u32 {
        self.in_flight.unwrap_or_else(|| (self.latency / self.interval.max(1)).saturating_add(1))
    }

    /// The same, of a block that holds so many tokens where nothing else is said.
    fn holding(&self, in_flight: u32) -> Self {
        Self { in_flight: self.in_flight.or(Some(in_flight)), ..self.clone() }
    }

    /// How the block stands in the chain of the engines.
    #[must_use]
    pub fn shape(&self) -> Shape {
        Shape {
            depth: self.fifo,
            in_flight: self.in_flight(),
            lanes: self.lanes,
            order: self.lane_order,
            shares_port: false,
        }
    }
}

impl BackfaceCosts {
    /// The costs of a patch that is tested by `method`; of one that is not under `off`.
    fn of_method(&self, method: BackfaceMethod) -> BlockCosts {
        let by_method = match method {
            BackfaceMethod::Off => None,
            // The net has 9 quadrilaterals of two facets each.
            BackfaceMethod::NetFacets => Some(18),
            // The tangent plane of a bicubic patch has 9 x 9 coefficients.
            BackfaceMethod::TangentPlane => Some(81),
            // Its normal has 6 x 6; the points go by beside them.
            BackfaceMethod::NormalCone => Some(36),
            // Any three of 16 points may be a facet.
            BackfaceMethod::HullLiteral => Some(560),
        };
        let (interval, latency) = by_method.map_or(UNTESTED, |facets| {
            let interval = self.interval.unwrap_or(facets);
            (interval, self.latency.unwrap_or(interval.saturating_add(BACKFACE_DRAIN)))
        });
        BlockCosts {
            interval,
            latency,
            in_flight: self.in_flight,
            lanes: self.lanes,
            lane_order: self.lane_order,
            fifo: self.fifo,
        }
    }

    /// Interval and latency, in cycles, of a patch that is not tested.
    #[must_use]
    pub const fn untested() -> (u32, u32) {
        UNTESTED
    }
}

impl DomainCosts {
    /// The costs of a wave of so many points.
    fn of(&self, domain: &Domain) -> BlockCosts {
        let cycles = match domain.shader {
            DomainKind::Basis => 1,
            DomainKind::Naive => NAIVE_CYCLES,
        };
        BlockCosts {
            interval: self.interval.unwrap_or(cycles * domain.width),
            latency: self.latency,
            in_flight: self.in_flight,
            lanes: self.lanes,
            lane_order: self.lane_order,
            fifo: self.fifo,
        }
    }
}

impl Config {
    /// What `block` costs, with what is absent derived; of [`Block::Backface`], what a patch costs
    /// that the configured method tests. `None` for what is no block of the unit: the trace, the
    /// link and memory; and for index fetch, which hands over as many vertices as memory does.
    #[must_use]
    pub fn costs(&self, block: Block) -> Option<BlockCosts> {
        let blocks = &self.block;
        Some(match block {
            Block::Trace | Block::Link | Block::Memory => return None,
            Block::VertexCache | Block::Unit => return None,
            Block::Transform => blocks.transform.clone(),
            Block::Port => blocks.port.clone(),
            Block::Assemble => blocks.assemble.clone(),
            Block::Hull => blocks.hull.holding(16),
            Block::Clip => blocks.clip.clone(),
            Block::Backface => blocks.backface.of_method(self.backface.method),
            // Their tokens are patches of several items: so few fill the pipeline.
            Block::Level => blocks.level.holding(4),
            Block::Place => blocks.place.holding(4),
            Block::Factors => blocks.factors.holding(4),
            Block::Points => blocks.points.holding(2),
            Block::Connect => blocks.connect.holding(2),
            Block::Evaluate => blocks.evaluate.costs.holding(2),
            Block::Stitch => blocks.stitch.clone(),
            Block::Domain => blocks.domain.of(&self.domain),
            Block::Group => blocks.group.clone(),
            Block::Surface => blocks.surface.costs.holding(self.esc.waves_in_flight()),
            Block::Emit => blocks.emit.clone(),
            Block::VertexShader => blocks.vertex_shader.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_absent_follows_from_what_is_there() {
        let mut config = Config::default();
        let costs = |config: &Config, block| {
            let costs = config.costs(block).unwrap();
            (costs.interval, costs.latency, costs.in_flight())
        };
        assert_eq!(costs(&config, Block::VertexShader), (1, 200, 201));
        assert_eq!(costs(&config, Block::Clip), (4, 5, 2));
        // 81 + 8 cycles at one in 81 keep two patches in flight.
        assert_eq!(costs(&config, Block::Backface), (81, 89, 2));
        config.backface.method = BackfaceMethod::NormalCone;
        assert_eq!(costs(&config, Block::Backface), (36, 44, 2));
        config.backface.method = BackfaceMethod::HullLiteral;
        assert_eq!(costs(&config, Block::Backface), (560, 568, 2));
        config.backface.method = BackfaceMethod::NetFacets;
        assert_eq!(costs(&config, Block::Backface), (18, 26, 2));
        config.block.backface.interval = Some(2);
        assert_eq!(costs(&config, Block::Backface), (2, 10, 6));
        config.block.backface.latency = Some(2);
        assert_eq!(costs(&config, Block::Backface), (2, 2, 2));
        config.backface.method = BackfaceMethod::Off;
        assert_eq!(costs(&config, Block::Backface), (1, 1, 2));
        let held = |block| costs(&config, block).2;
        assert_eq!([Block::Level, Block::Place, Block::Evaluate].map(held), [4, 4, 2]);
        config.block.emit.in_flight = Some(3);
        let shape = config.costs(Block::Emit).unwrap().shape();
        assert_eq!((shape.in_flight, shape.depth, shape.lanes), (3, 16, 1));
    }

    #[test]
    fn every_block_behind_memory_has_costs() {
        let after_memory = rtl_model::counter::DECLARATIONS
            .iter()
            .map(|declared| declared.block)
            .filter(|&block| block > Block::Memory && block != Block::VertexCache);
        for block in after_memory {
            assert!(TIMED.contains(&block) && Config::default().costs(block).is_some());
        }
        for block in [Block::Trace, Block::Link, Block::Memory, Block::VertexCache] {
            assert!(!TIMED.contains(&block) && Config::default().costs(block).is_none());
        }
        assert!(TIMED.is_sorted());
    }
}
