//! Surface: a patch's lists of parameters in, its points and triangles out, in the units whose
//! patches have such lists: what these have in common around what each has of its own (`Front`).
//!
//! ```text
//!   patch ─► [level ─► place] ─► evaluate ─► stitch
//!             a front's own: how
//! ```

use super::frame::FrameState;
use super::pipeline::{Input, Make, Placed, Placing};
use super::union::Pass;
use crate::config::{Config, Normals};
use rtl_model::counter::{Counter, Counters};
use rtl_model::evaluate::{self, Evaluate};
use rtl_model::patch::{Triangle, Vertex};
use rtl_model::place::{Numbering, Parameters, Placement};
use rtl_model::stitch::{Degenerate, Stitch};
use rtl_model::strip::Topology;

/// What a unit has of its own between culling and the evaluation of points.
pub(super) trait Front: Send + Sync + 'static {
    /// What the triangles of a patch depend on.
    type Lists: Topology + 'static;
    /// The parameters along one direction.
    type List: Parameters + Send;
    /// Whether patches are clipped and culled.
    const CULLS: bool;

    /// Where vertices are placed.
    fn placement(_config: &Config) -> Placement<Self::List> {
        Placement::default()
    }

    /// Chooses levels, places the vertices, and says what its blocks did for it.
    fn place(work: Placing<'_>, placement: &mut Placement<Self::List>) -> Placed<Self::Lists>;
}

/// The blocks behind culling, and what they made of the patch before.
pub(super) struct Surface<F: Front> {
    placement: Placement<F::List>,
    evaluate: Evaluate,
    stitch: Stitch<F::Lists>,
    degenerate: Degenerate,
    normals: Normals,
}

impl<F: Front> Make for Surface<F> {
    type Lists = F::Lists;
    const CULLS: bool = F::CULLS;

    fn new(config: &Config, frame: &FrameState) -> Self {
        Self {
            placement: F::placement(config),
            evaluate: Evaluate::new(evaluate::Settings {
                position: frame.position(config),
                guard: config.guard(),
                scheme: config.scheme(),
                rounding: config.evaluate.rounding,
                overflow: config.position.overflow,
            }),
            stitch: Stitch::default(),
            degenerate: Degenerate::default(),
            normals: config.evaluate.normals,
        }
    }

    fn place(&mut self, work: Placing<'_>, counters: &mut Counters) -> Placed<F::Lists> {
        let pass = work.input.share.map(|share| share.shared.pass);
        let placed = F::place(work, &mut self.placement);
        if pass != Some(Pass::Measure) {
            let [columns, rows] = placed.lists.interior();
            let parameters = placed.lists.boundary() + columns + rows;
            counters.add(Counter::PlaceReciprocals, placed.reciprocals.into());
            counters.add(Counter::PlaceParameters, parameters as u64);
        }
        placed
    }

    fn shape(
        &mut self,
        lists: &mut F::Lists,
        input: &Input<'_>,
        vertices: &mut Vec<Vertex>,
        counters: &mut Counters,
    ) -> u64 {
        let patch = input.patch;
        let cost = self.evaluate.accept(patch, &self.placement, vertices);
        let triangles = self.stitch.accept(*lists);
        let degenerate = self.degenerate.count(lists, vertices, triangles);
        let count = vertices.len() as u64;
        counters.add(Counter::EvaluateInvocations, cost.invocations);
        counters.add(Counter::EvaluateVertices, count);
        counters.add(Counter::EvaluateStrips, lists.strip_count() as u64);
        counters.add(Counter::EvaluateCurves, cost.curves);
        counters.add(Counter::EvaluateSteps, cost.steps);
        counters.add(Counter::EvaluateOverflows, cost.overflows);
        counters.add(Counter::EvaluateAttributes, input.components * count);
        counters.add(Counter::StitchTriangles, triangles.len() as u64);
        counters.add(Counter::StitchDegenerate, degenerate);
        if self.normals == Normals::TangentPlane {
            let planes = vertices.iter().map(|v| evaluate::tangent_plane(patch, v.u, v.v));
            let degenerate = planes.filter(|plane| *plane == [0; 4]).count() as u64;
            counters.add(Counter::EvaluateNormals, count);
            counters.add(Counter::EvaluateNormalsDegenerate, degenerate);
        }
        count
    }

    fn triangles(&self) -> &[Triangle] {
        self.stitch.triangles()
    }
}
