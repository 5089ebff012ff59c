//! What the first implementation makes of a batch, and counts as unit `esc` does.

use super::*;
use rtl_model::backface::{self, Verdict};
use rtl_model::emit;
use rtl_model::esc::Made as Cost;
use rtl_model::patch::Vertex;

/// What becomes of a patch.
pub(super) struct Became {
    pub(super) fate: u32,
    /// Of edges and interior; clamped, near, overflows.
    pub(super) levels: [u32; 8],
    pub(super) inserted: u32,
    pub(super) vertices: Vec<u32>,
    pub(super) triangles: Vec<u32>,
}

/// What becomes of a batch.
pub(super) struct Expected {
    pub(super) patches: Vec<Became>,
    pub(super) counts: Vec<((&'static str, &'static str), u64)>,
}

fn scaled(value: f64, scale: f64) -> u64 {
    if value > 0.0 { ((value * scale).round() as u64).max(1) } else { 0 }
}

fn pixels(value: f64) -> u32 {
    scaled(value, 65536.0).min(u32::MAX.into()) as u32
}

/// mu, where candidates are tested.
pub(super) fn threshold(batch: &Batch) -> Option<Threshold> {
    let esc = &batch.config.esc;
    let threshold = if esc.tests_in_object_space() {
        let ulps = f64::from(batch.object_format.fraction + 8).exp2();
        Threshold::object(scaled(esc.mu, ulps))
    } else {
        Threshold::pixels(pixels(esc.mu))
    };
    (threshold != Threshold::Uniform).then_some(threshold)
}

/// What a patch's levels depend on.
pub(super) fn policy(batch: &Batch, at: usize) -> Policy {
    let esc = &batch.config.esc;
    if let Some(given) = &batch.given {
        return Policy::Object(given[at] as u8);
    }
    match esc.level {
        LevelPolicy::Criterion => Policy::Criterion,
        LevelPolicy::Fixed => Policy::Fixed(esc.fixed_level as u8),
        LevelPolicy::Distance => {
            let format = batch.view.position;
            let raw = (esc.full_distance * f64::from(format.fraction).exp2()).round();
            Policy::Distance { full: raw.clamp(1.0, format.max() as f64) as i64 }
        }
        LevelPolicy::ScreenSize => Policy::ScreenSize { pixels: pixels(esc.full_pixels) },
    }
}

fn shader(batch: &Batch) -> Surface {
    let Config { esc, evaluate, position, .. } = &batch.config;
    Surface::new(Shader {
        position: batch.view.position,
        object: batch.object_format,
        guard: esc.guard,
        parameter_bits: esc.parameter_bits,
        rounding: evaluate.rounding,
        overflow: position.overflow,
        mesh: esc.control_mesh,
        threshold: threshold(batch).unwrap_or(Threshold::Uniform),
        boundary: esc.boundary,
        reuse: esc.reuse,
        output: batch.config.output(),
    })
}

/// Sums of what patches cost.
#[derive(Default)]
struct Sums {
    patches: u64,
    clipped: u64,
    tested: u64,
    facets: u64,
    culled: u64,
    homogeneous: u64,
    cost: Cost,
    clamped: u64,
    near: u64,
    overflows: u64,
    kept: u64,
    flatness: u64,
    length: u64,
    sections: u64,
    leave: u64,
    attributes: u64,
    corners: u64,
    triangles: u64,
    degenerate: u64,
}

impl Expected {
    pub(super) fn of(batch: &Batch) -> Self {
        let mut surface = shader(batch);
        let mut sums = Sums::default();
        let patches =
            (0..batch.patches.len()).map(|at| became(batch, at, &mut surface, &mut sums)).collect();
        let counts = sums.level().into_iter().chain(sums.shader()).chain(sums.data(batch));
        let counts = counts.chain(sums.emitted(batch)).chain(sums.culls()).collect();
        Self { patches, counts }
    }
}

/// 0 clipped, 1 culled, 2 kept.
fn fate(batch: &Batch, at: usize, sums: &mut Sums) -> u32 {
    let (patch, view, config) = (&batch.patches[at], &batch.view, &batch.config);
    sums.patches += 1;
    if config.clip.enabled && clip::outside(patch, view.depth) {
        sums.clipped += 1;
        return 0;
    }
    let (verdict, facets) = backface::accept(patch, view, config.backface.method);
    sums.tested += u64::from(verdict != Verdict::Untested);
    sums.facets += u64::from(facets);
    let culled = verdict == Verdict::Culled;
    sums.culled += u64::from(culled);
    if culled { 1 } else { 2 }
}

/// How a patch is left by clip and back-face removal.
pub(super) fn is_kept(batch: &Batch, at: usize) -> bool {
    fate(batch, at, &mut Sums::default()) == 2
}

fn became(batch: &Batch, at: usize, surface: &mut Surface, sums: &mut Sums) -> Became {
    let (patch, view) = (&batch.patches[at], &batch.view);
    let fate = fate(batch, at, sums);
    if fate < 2 {
        return Became {
            fate,
            levels: [0; 8],
            inserted: 0,
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
    }
    let (state, policy) = (&batch.states[at], policy(batch, at));
    let level_max = batch.config.esc.level_max as u8;
    let (levels, events) =
        resolution::accept(patch, view, state, &Resolution { policy, level_max });
    let input = Input { patch, object: Some(&batch.objects[at]), view, levels };
    let mut vertices = Vec::new();
    let made = surface.accept(&input, &mut vertices);
    let [v0, u1, v1, u0] = levels.edges.map(u32::from);
    sums.kept += 1;
    sums.clamped += u64::from(events.clamped);
    sums.near += u64::from(events.near);
    sums.overflows += u64::from(events.overflows);
    let criterion = match policy {
        Policy::Criterion => state.criterion,
        Policy::ScreenSize { pixels } => Criterion::EdgeLength { pixels },
        _ => Criterion::Fixed { level: Level::MIN },
    };
    sums.flatness += u64::from(matches!(criterion, Criterion::Flatness { .. }));
    sums.length += u64::from(matches!(criterion, Criterion::EdgeLength { .. }));
    let triangles = surface.triangles();
    let Config { emit: e, .. } = &batch.config;
    let divide = emit::Settings { subpixel_bits: e.subpixel_bits, rounding: e.rounding };
    sums.homogeneous += emit::accept(&vertices, view, divide, &mut Vec::new());
    sums.take(batch, at, &made);
    sums.triangles += triangles.len() as u64;
    sums.degenerate += stitch::degenerate(&vertices, triangles);
    Became {
        fate: 2,
        levels: [
            v0,
            u1,
            v1,
            u0,
            levels.interior.into(),
            events.clamped,
            events.near,
            events.overflows,
        ],
        inserted: made.inserted as u32,
        vertices: vertices.iter().flat_map(flat).collect(),
        triangles: triangles.iter().flatten().map(|&k| k.into()).collect(),
    }
}

fn flat(vertex: &Vertex) -> Vec<u32> {
    let mut flat: Vec<u32> = vertex.position.iter().flat_map(|&c| words(c)).collect();
    flat.extend([vertex.u, vertex.v]);
    flat
}

impl Sums {
    fn take(&mut self, batch: &Batch, at: usize, made: &Cost) {
        let leave = match batch.config.esc.reuse {
            Reuse::None => made.strip_vertices,
            Reuse::CoarseTriangle | Reuse::Patch => {
                made.corners + made.boundary + made.coarse + made.interior
            }
        };
        let (sum, sections) = (&mut self.cost, u64::from(made.sections.sections));
        let components = u64::from(batch.components[at]);
        sum.nets += made.nets;
        sum.object_nets += made.object_nets;
        sum.tests += made.tests;
        sum.inserted += made.inserted;
        sum.corners += made.corners;
        sum.boundary += made.boundary;
        sum.coarse += made.coarse;
        sum.interior += made.interior;
        sum.tested += made.tested;
        sum.tested_boundary += made.tested_boundary;
        sum.distinct += made.distinct;
        sum.strip_vertices += made.strip_vertices;
        sum.slots += made.slots;
        sum.moved += made.moved;
        sum.overflows += made.overflows;
        sum.cracks += made.cracks;
        sum.buffer = sum.buffer.max(made.buffer);
        self.sections += sections;
        self.leave += leave;
        self.attributes += leave * components;
        self.corners += sections * 4 * components;
    }

    fn level(&self) -> [((&'static str, &'static str), u64); 7] {
        [
            ("patches", self.kept),
            ("patches.flatness", self.flatness),
            ("patches.edge_length", self.length),
            ("splits", 0),
            ("levels.clamped", self.clamped),
            ("edges.near", self.near),
            ("overflows", self.overflows),
        ]
        .map(|(name, count)| (("level", name), count))
    }

    fn shader(&self) -> [((&'static str, &'static str), u64); 19] {
        let made = &self.cost;
        [
            ("nets", made.nets),
            ("nets.object", made.object_nets),
            ("tests", made.tests),
            ("tests.inserted", made.inserted),
            ("evaluations", made.points() - made.corners),
            ("evaluations.boundary", made.boundary),
            ("evaluations.coarse_edges", made.coarse),
            ("evaluations.interior", made.interior),
            ("evaluations.tests", made.tested),
            ("evaluations.tests.boundary", made.tested_boundary),
            ("corners", made.corners),
            ("points", made.distinct),
            ("strip_vertices", made.strip_vertices),
            ("slots", made.slots),
            ("triangles", self.triangles),
            ("triangles.degenerate", self.degenerate),
            ("vertices.moved", made.moved),
            ("cracks", made.cracks),
            ("overflows", made.overflows),
        ]
        .map(|(name, count)| (("surface", name), count))
    }

    fn data(&self, batch: &Batch) -> [((&'static str, &'static str), u64); 8] {
        let Config { esc, attributes, position, evaluate, .. } = &batch.config;
        let component = attributes.component_bytes();
        let object = if self.cost.object_nets > 0 { 192 } else { 0 };
        let bits = position.width + 8 + esc.guard;
        let registers = 64 * u64::from(bits) + 32 * u64::from(esc.registers);
        let normals = evaluate.normals == Normals::TangentPlane;
        [
            ("invocations", self.sections),
            ("control_points", 16 * self.sections),
            ("bytes.in", self.sections * (256 + object) + self.corners * component),
            ("buffer.bits.peak", self.cost.buffer * 4 * u64::from(position.width)),
            ("registers.bits.peak", if self.kept > 0 { registers } else { 0 }),
            ("attributes", self.attributes),
            ("bytes.out", self.leave * u64::from(esc.bytes_out) + self.attributes * component),
            ("normals", if normals { self.leave } else { 0 }),
        ]
        .map(|(name, count)| (("surface", name), count))
    }

    fn culls(&self) -> [((&'static str, &'static str), u64); 6] {
        [
            (("clip", "patches.in"), self.patches),
            (("clip", "patches.culled"), self.clipped),
            (("backface", "patches.in"), self.patches - self.clipped),
            (("backface", "patches.tested"), self.tested),
            (("backface", "facets.tested"), self.facets),
            (("backface", "patches.culled"), self.culled),
        ]
    }

    fn emitted(&self, batch: &Batch) -> [((&'static str, &'static str), u64); 5] {
        let Config { esc, attributes, emit, .. } = &batch.config;
        let component = attributes.component_bytes();
        let indexed = esc.reuse != Reuse::None;
        let indices = if indexed { 3 * self.triangles * u64::from(emit.index_bytes) } else { 0 };
        let records = self.leave * u64::from(emit.vertex_bytes);
        [
            ("vertices", self.leave),
            ("triangles", self.triangles),
            ("bytes.attributes", self.attributes * component),
            ("bytes", records + self.attributes * component + indices),
            ("vertices.to_clipper", self.homogeneous),
        ]
        .map(|(name, count)| (("emit", name), count))
    }
}
