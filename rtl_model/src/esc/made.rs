//! Made: what the shader did with a patch, in counts.

/// What a patch cost. Points are counted as often as they are evaluated, which [`super::Reuse`]
/// says; the function is the same for all of its values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Made {
    /// `[N][B][M]^T` formed in clip space, four components each.
    pub nets: u64,
    /// The same in object space.
    pub object_nets: u64,
    /// Candidates tested.
    pub tests: u64,
    /// Of these, inserted.
    pub inserted: u64,
    /// Points for the mesh that are corners of the patch: copied.
    pub corners: u64,
    /// Points for the mesh on the patch's boundary.
    pub boundary: u64,
    /// Points for the mesh on coarse edges inside, their ends included.
    pub coarse: u64,
    /// Points for the mesh inside coarse triangles.
    pub interior: u64,
    /// Points evaluated for tests only: not inserted, or not kept for the mesh, or in object space.
    pub tested: u64,
    /// Of these, on the patch's boundary.
    pub tested_boundary: u64,
    /// Distinct points of the mesh: vertices.
    pub distinct: u64,
    /// Vertices of the strips' lists as the paper writes them.
    pub strip_vertices: u64,
    /// Slots of the strips.
    pub slots: u64,
    /// Inserted vertices of the patch's edges that stand elsewhere than the slot that carries them.
    pub moved: u64,
    /// Coordinates that did not fit their format.
    pub overflows: u64,
    /// Boundary vertices, but corners, of which the patch turned another way would give other bits.
    pub cracks: u64,
    /// Points held at once, at most.
    pub buffer: u64,
    /// What the invocations did.
    pub sections: Phases,
}

impl Made {
    /// Points evaluated, for the mesh and for tests, corners among them.
    #[must_use]
    pub const fn points(&self) -> u64 {
        self.corners + self.boundary + self.coarse + self.interior + self.tested
    }
}

/// Invocations, by phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Phases {
    /// Invocations; without [`super::Output`] one.
    pub sections: u32,
    /// The largest of any invocation, each phase on its own.
    pub most: Phase,
    /// Over all invocations.
    pub sum: Phase,
}

impl Phases {
    /// Takes in what an invocation did.
    pub(super) fn add(&mut self, phase: Phase) {
        let Self { most, sum, .. } = self;
        let pairs = [
            (&mut most.nets, &mut sum.nets, phase.nets),
            (&mut most.tests, &mut sum.tests, phase.tests),
            (&mut most.points, &mut sum.points, phase.points),
            (&mut most.slots, &mut sum.slots, phase.slots),
        ];
        for (most, sum, count) in pairs {
            *most = count.max(*most);
            *sum += count;
        }
    }
}

/// What an invocation does, phase by phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Phase {
    /// Nets formed, in clip and in object space.
    pub nets: u32,
    /// Candidates tested.
    pub tests: u32,
    /// Points evaluated, for the mesh and for tests; corners, which are copied, among them.
    pub points: u32,
    /// Slots of strips.
    pub slots: u32,
}
