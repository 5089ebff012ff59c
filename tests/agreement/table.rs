//! The table of error budgets: one row for each quantity that a block makes, its budget as a
//! formula, and why.
//!
//! A budget is a bound, so an error above it is a mistake somewhere. It is also a claim about how
//! good the block is: if the largest error seen is below a quarter of it, the claim is too modest
//! and fails too. Samples are seeded, so the largest error is the same on every machine;
//! `TESSIM_LONG=1` draws more, which can only raise it.

#[path = "budget.rs"]
pub(crate) mod budget;

use budget::{
    casteljau_curve, casteljau_surface, forward_curve, forward_surface, half_run, horner,
};
use budget::{reference, rounding, weighted};
use rtl_model::number::Rounding;

/// What a budget may depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    /// Bits of a position.
    pub(crate) width: u32,
    /// Guard bits.
    pub(crate) guard: u32,
    /// Steps of the half-runs that led here: along the curve, and along the column before it.
    pub(crate) steps: [u32; 2],
    /// How the output was rounded.
    pub(crate) rounding: Rounding,
    /// What the block's own, bounded errors become in the result, where that depends on the input.
    pub(crate) spread: f64,
}

impl Default for At {
    fn default() -> Self {
        Self { width: 32, guard: 20, steps: [0; 2], rounding: Rounding::NearestEven, spread: 0.0 }
    }
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    Transform,
    PortValue,
    PortFits,
    AssemblePoints,
    AssembleNew,
    AssembleHeld,
    AssembleCached,
    ClipVerdict,
    TangentCoefficients,
    TangentVerdict,
    FacetsVerdict,
    ConeVerdict,
    HullVerdict,
    FacetsTested,
    FalseCulls,
    LevelFixed,
    LevelNear,
    LevelFlatEdge,
    LevelFlatEdgeShort,
    LevelFlatInterior,
    LevelDeviation,
    LevelLength,
    LevelDivided,
    LevelCut,
    LevelLists,
    LevelSplits,
    LevelPowers,
    PlaceCounts,
    PlaceParameter,
    PlaceDyadic,
    ForwardBoundary,
    ForwardInterior,
    DriftBoundary,
    DriftInterior,
    CasteljauBoundary,
    CasteljauInterior,
    Corners,
    Centres,
    Plane,
    Attribute,
    StitchTriangles,
    StitchZipped,
    StitchDegenerate,
    EmitPixel,
    EmitDivided,
    D3d11Culled,
    D3d11Counts,
    D3d11Parameter,
    D3d11SetOff,
    D3d11Triangles,
    DomainPaired,
    DomainSequential,
    DomainPower,
    DomainFixed,
    DomainFixedWeights,
    DomainFixedPower,
    HullDecision,
    HullFactors,
    EscDistance,
    EscScreen,
    EscCriterion,
    EscClamped,
    EscVertices,
    EscLists,
    EscTriangles,
    EscCorner,
    EscBoundary,
    EscInside,
    EscUnguarded,
    EscParameter,
    EscDecision,
    EscSites,
    EscMesh,
    EscEvaluated,
    KernelClip,
    KernelBackface,
    KernelLevel,
    KernelPlace,
    KernelEvaluate,
    KernelStitch,
    KernelEmit,
    KernelD3d11,
    KernelEsc,
    KernelNumber,
    KernelSingle,
    KernelScan,
    KernelClipRandom,
    KernelBackfaceRandom,
    KernelLevelRandom,
    KernelPlaceRandom,
    KernelEvaluateRandom,
    KernelPlaneRandom,
    KernelStitchRandom,
    KernelEmitRandom,
    KernelUnitRandom,
    KernelPatternRandom,
    KernelD3d11Random,
    KernelLookedAt,
    KernelEscRandom,
    KernelResolution,
    KernelNear,
}

/// A row of the table.
pub(crate) struct Row {
    /// The quantity.
    pub(crate) quantity: Quantity,
    /// The block, a file of `rtl_model/src`, of `src/shader` or of `src/gpu`.
    pub(crate) block: &'static str,
    /// The quantity in words, with its unit.
    pub(crate) what: &'static str,
    /// The bound; `None`: exact, every item must be equal.
    pub(crate) budget: Option<fn(&At) -> f64>,
    /// Why.
    pub(crate) reason: &'static str,
    /// Fewer items than this, and the comparison has not taken place.
    pub(crate) floor: u64,
}

/// A row whose items must be equal.
const fn exact(
    quantity: Quantity,
    block: &'static str,
    what: &'static str,
    floor: u64,
    reason: &'static str,
) -> Row {
    Row { quantity, block, what, budget: None, reason, floor }
}

const fn within(
    quantity: Quantity,
    block: &'static str,
    what: &'static str,
    floor: u64,
    budget: fn(&At) -> f64,
    reason: &'static str,
) -> Row {
    Row { quantity, block, what, budget: Some(budget), reason, floor }
}

use Quantity as Q;

/// Rows of the second implementation, which need a GPU, or what stands in for one.
pub(crate) const KERNELS: &str = "words of the kernels' results";

/// The same on random inputs, of every width where there is one: compared in tests/gpu.
pub(crate) const RANDOM: &str = "words of the kernels' results, random inputs";

#[rustfmt::skip]
pub(crate) const TABLE: &[Row] = &[
    within(Q::Transform, "control_point", "coordinate, 2^-24 of its terms' magnitudes", 10_000,
        |_| 4.0,
        "one product and three sums in f32, each off by 2^-24 of a partial sum"),
    exact(Q::PortValue, "port", "raw coordinate", 50_000,
        "rounded once, from an exact product"),
    exact(Q::PortFits, "port", "coordinates that do not fit", 50_000,
        "a comparison of integers"),
    exact(Q::AssemblePoints, "assemble", "indices of a patch", 400,
        "a decision"),
    exact(Q::AssembleNew, "assemble", "points received", 400,
        "a decision"),
    within(Q::AssembleHeld, "assemble", "edge entries above the points alive", 60,
        |_| 4.0,
        "a store has its full length at once, and where the row and the column store cross, a \
         point stands in both"),
    exact(Q::AssembleCached, "assemble", "points that an indexed mesh's cache lacks", 20_000,
        "a decision"),
    exact(Q::ClipVerdict, "clip", "verdict", 2_000,
        "comparisons of integers"),
    exact(Q::TangentCoefficients, "backface", "81 coefficients", 1_000,
        "256-bit integers"),
    exact(Q::TangentVerdict, "backface", "tangent_plane verdict", 1_000,
        "exact wherever the estimate is not certain"),
    exact(Q::FacetsVerdict, "backface", "net_facets verdict", 1_000,
        "exact volumes"),
    exact(Q::ConeVerdict, "backface", "normal_cone verdict", 1_000,
        "where the cones' distance is more than their roundings, which only widen them, can add"),
    exact(Q::HullVerdict, "backface", "hull_literal verdict", 1_000,
        "exact volumes"),
    exact(Q::FacetsTested, "backface", "facets and coefficients looked at", 2_000,
        "a decision for each of them, in an order that is part of the definition"),
    exact(Q::FalseCulls, "backface", "samples of culled patches that face the viewer", 10_000,
        "no Bernstein coefficient above 0, or no pair of cones' directions at an acute angle: no \
         value above 0"),
    exact(Q::LevelFixed, "level", "fixed levels", 500,
        "a clamp"),
    exact(Q::LevelNear, "level", "edges without projection", 1_000,
        "comparisons of integers"),
    within(Q::LevelFlatEdge, "level", "flatness, edge level, 2^-16", 1_000,
        |at| at.spread + 1.01,
        "spread: a second difference is up to 6.83 / 65536 px too long (PIXELS_MOVED); then a \
         root rounded up"),
    exact(Q::LevelFlatEdgeShort, "level", "flatness, edge levels below the bound", 1_000,
        "every rounding is up, so that a bound stays a bound"),
    within(Q::LevelFlatInterior, "level", "flatness, interior level, 2^-16", 500,
        |at| at.spread + 1.01,
        "spread: the same through all three differences and the starting levels; then a root \
         rounded up"),
    within(Q::LevelDeviation, "level", "flatness, bound at the interior levels, tolerances", 500,
        |_| 1.0 + 1e-9,
        "the criterion itself, where no level was cut to the greatest"),
    within(Q::LevelLength, "level", "edge_length, level, 2^-16", 1_000,
        |at| at.spread + 1.01,
        "spread: three segments, each rounded up once and off by sqrt(2) for its rounded ends, \
         over `pixels`"),
    exact(Q::LevelDivided, "level", "decisions to divide a piece of a curve", 100_000,
        "the test is exact on rounded projections; where rounding could decide (of homogeneous \
         points 2^-12 ulps a division, of pixels 2^-17, of the chord's length 2^-16), none is \
         compared"),
    exact(Q::LevelCut, "level", "curves left bent at the greatest depth", 5_000,
        "a decision, compared where no last piece is within rounding"),
    exact(Q::LevelLists, "level", "lists of the edges and of the interior", 1_000,
        "unions of sets"),
    exact(Q::LevelSplits, "level", "splits, and levels cut to the greatest", 5_000,
        "counts"),
    exact(Q::LevelPowers, "level", "levels rounded up to powers of two", 5_000,
        "a logarithm of at most 23 bits, exact in f64 where it is whole"),
    exact(Q::PlaceCounts, "place", "numbers of entries and reciprocals", 1_000,
        "decisions"),
    within(Q::PlaceParameter, "place", "parameter, U1.16 ulps", 100_000,
        |at| 0.5 + f64::from(at.steps[0]) * at.spread,
        "rounded once; R is truncated to n bits, k R off by k 2^-n"),
    exact(Q::PlaceDyadic, "place", "dyadic lists", 5_000,
        "k/128 is a multiple of the ulp"),
    within(Q::ForwardBoundary, "evaluate", "forward, boundary, ulps", 100_000,
        forward_curve,
        "three coefficients rounded once, n steps; the output's rounding"),
    within(Q::ForwardInterior, "evaluate", "forward, interior, ulps", 100_000,
        forward_surface,
        "the same twice: a row's control points are convexly combined"),
    within(Q::DriftBoundary, "evaluate", "of these, drift above rounding, boundary, ulps", 1_000,
        forward_curve,
        "the same bound where the accumulator's part is the greater: few guard bits, many steps"),
    within(Q::DriftInterior, "evaluate", "of these, drift above rounding, interior, ulps", 1_000,
        forward_surface,
        "the same bound where the accumulators' part is the greater"),
    within(Q::CasteljauBoundary, "evaluate", "de Casteljau, boundary, ulps", 10_000,
        casteljau_curve,
        "three interpolations deep, each rounded once and convex"),
    within(Q::CasteljauInterior, "evaluate", "de Casteljau, interior, ulps", 100_000,
        casteljau_surface,
        "six deep"),
    exact(Q::Corners, "evaluate", "corners", 4_000,
        "copied"),
    exact(Q::Centres, "evaluate", "forward, centres of edges", 3_000,
        "one exact sum over 8, rounded once: also which way ties go"),
    within(Q::Plane, "evaluate", "normal of the tangent plane, radians", 2_000,
        |at| at.spread,
        "spread: 2/5 of what S within 3.5 ulps, Su/3 and Sv/3 within 6, and coefficients of 31 \
         bits make of the normal; that all these roundings conspire has not been seen"),
    within(Q::Attribute, "attribute", "component, ulps", 10_000,
        |at| 2.0 * rounding(at),
        "interpolated along u, then along v, rounded each time"),
    exact(Q::StitchTriangles, "stitch", "set of triangles", 1_000,
        "decisions"),
    exact(Q::StitchZipped, "stitch", "set of triangles between dyadic lists", 1_000,
        "decisions"),
    exact(Q::StitchDegenerate, "stitch", "degenerate triangles", 1_000,
        "comparisons of integers"),
    within(Q::EmitPixel, "emit", "screen coordinate, sub-pixel ulps", 100_000,
        |at| rounding(at) + 1e-6,
        "one quotient, rounded once; f64 within 2^-26"),
    exact(Q::EmitDivided, "emit", "vertices divided", 100_000,
        "comparisons of integers"),
    exact(Q::D3d11Culled, "d3d11", "whether factors cull", 5_000,
        "comparisons of floats"),
    exact(Q::D3d11Counts, "d3d11", "numbers of points and indices", 5_000,
        "closed formulas against what was made"),
    within(Q::D3d11Parameter, "d3d11", "parameter on an edge or of a grid, U1.16 ulps", 1_000_000,
        |at| 0.5 + 0.5 * f64::from(at.steps[0]) + 0.5,
        "rounded once; k steps of a reciprocal that is off by half an ulp; and half a factor is \
         rounded up to 16 bits, which moves t by half an ulp of at most one segment"),
    within(Q::D3d11SetOff, "d3d11", "parameter inside a triangle, U1.16 ulps", 500_000,
        |at| 2.5 * (1.0 + 0.5 * f64::from(at.steps[0])) + 1.5,
        "1 - along - off: off is two thirds of one parameter and a rounding and a truncated 2/3, \
         along another parameter less half of off, rounded up"),
    exact(Q::D3d11Triangles, "d3d11", "set of triangles", 5_000,
        "decisions"),
    within(Q::DomainPaired, "domain", "f32, paired, 2^-24 of its terms' magnitudes", 20_000,
        |_| 12.0,
        "along u and along v: a weight in three roundings, its product, two sums"),
    within(Q::DomainSequential, "domain", "f32, sequential, the same", 20_000,
        |_| 14.0,
        "the same with three sums"),
    within(Q::DomainPower, "domain", "f32, power, 2^-24 of all products' magnitudes", 20_000,
        |_| 0.3 * 18.0,
        "a coefficient in three roundings, twice; three products and three sums, twice. 3/10 of \
         that: terms of either sign cancel, and that all their roundings conspire has not been \
         seen"),
    within(Q::DomainFixed, "domain", "fixed point, paired and sequential, ulps", 20_000,
        weighted,
        "spread: the largest control point in ulps times 2^-weight_bits. Along u and along v the \
         four weights are off by 12 roundings of theirs together, and four products by one each"),
    within(Q::DomainFixedWeights, "domain", "of these, weights above the rest, ulps", 5_000,
        weighted,
        "the same bound where the weights' part is the greater: wide positions, few weight bits"),
    within(Q::DomainFixedPower, "domain", "fixed point, power, ulps", 20_000,
        |at| 15.0 * rounding(at) + reference(at),
        "exact coefficients; three products along u, in each of four coefficients, and three \
         along v"),
    exact(Q::HullDecision, "hull", "decisions to insert a vertex", 100_000,
        "compared where the distance from the threshold, and w from the near one, is more than \
         f32 can be off by"),
    exact(Q::HullFactors, "hull", "factors of patches", 300,
        "counts, compared where no decision is within rounding"),
    exact(Q::EscDistance, "esc", "levels by distance, edges too near", 5_000,
        "comparisons of integers"),
    exact(Q::EscScreen, "esc", "levels by size on the screen, edges too near, clamped", 5_000,
        "comparisons of integers; compared where a length does not decide by what its rounding \
         adds"),
    exact(Q::EscCriterion, "esc", "levels of a criterion in thirds, edges too near", 5_000,
        "comparisons of integers"),
    exact(Q::EscClamped, "esc", "levels of a criterion that are clamped", 2_000,
        "comparisons of integers, of lengths as above"),
    exact(Q::EscVertices, "esc", "numbers of vertices, and how many are on the edges", 10_000,
        "decisions; closed formulas against what was inserted"),
    exact(Q::EscLists, "esc", "strips as the paper lists them", 10_000,
        "decisions"),
    exact(Q::EscTriangles, "esc", "triangles in their order", 10_000,
        "decisions"),
    exact(Q::EscCorner, "esc", "corners of patches", 4_000,
        "copied"),
    within(Q::EscBoundary, "esc", "samples on a patch's boundary, ulps", 50_000,
        half_run,
        "exact coefficients; three products at t <= 1/2, of which two are multiplied by t and \
         t^2; the output's rounding"),
    within(Q::EscInside, "esc", "samples inside, ulps", 100_000,
        horner,
        "exact coefficients; three products along u, in each of four coefficients, and three \
         along v; the output's rounding"),
    within(Q::EscUnguarded, "esc", "of few guard bits, samples inside, ulps", 50_000,
        horner,
        "the same bound where the products' part is the greater"),
    within(Q::EscParameter, "esc", "of few parameter bits, samples, ulps", 50_000,
        horner,
        "spread: half an ulp of each parameter times the slope along it, where that is the \
         greater part"),
    exact(Q::EscDecision, "esc", "decisions to insert a vertex", 20_000,
        "compared where the distance from the threshold, and w from the near one, is more than \
         roundings add up to"),
    exact(Q::EscSites, "esc", "vertices of a patch as exact fractions", 1_000,
        "the levels' fractions, and decisions"),
    exact(Q::EscMesh, "esc", "triangles of a patch in their order", 1_000,
        "decisions"),
    exact(Q::EscEvaluated, "esc", "vertices evaluated, listed, distinct and moved", 1_000,
        "counts, from lists and sets"),
    exact(Q::KernelClip, "clip", KERNELS, 1_000,
        "comparisons of integers"),
    exact(Q::KernelBackface, "backface", KERNELS, 1_000,
        "exact volumes"),
    exact(Q::KernelLevel, "level", KERNELS, 5_000,
        "roots and quotients of integers, rounded the same way"),
    exact(Q::KernelPlace, "place", KERNELS, 500_000,
        "reciprocals and parameters rounded once"),
    exact(Q::KernelEvaluate, "evaluate", KERNELS, 2_000_000,
        "sums modulo 2^64, and roundings that are part of the definition"),
    exact(Q::KernelStitch, "stitch", KERNELS, 1_000_000,
        "decisions"),
    exact(Q::KernelEmit, "emit", KERNELS, 1_000_000,
        "one quotient, rounded once"),
    exact(Q::KernelD3d11, "d3d11", KERNELS, 1_000_000,
        "decisions, and singles by the rules of IEEE 754"),
    exact(Q::KernelEsc, "esc", KERNELS, 1_000_000,
        "decisions, and roundings that are part of the definition"),
    exact(Q::KernelNumber, "number", RANDOM, 1_000_000,
        "integers of 32 to 256 bits in limbs"),
    exact(Q::KernelSingle, "single", RANDOM, 50_000,
        "singles by the rules of IEEE 754"),
    exact(Q::KernelScan, "scan", RANDOM, 10_000,
        "sums of integers"),
    exact(Q::KernelClipRandom, "clip", RANDOM, 10_000,
        "comparisons of integers"),
    exact(Q::KernelBackfaceRandom, "backface", RANDOM, 10_000,
        "exact volumes"),
    exact(Q::KernelLevelRandom, "level", RANDOM, 50_000,
        "roots and quotients of integers, rounded the same way"),
    exact(Q::KernelPlaceRandom, "place", RANDOM, 10_000,
        "reciprocals and parameters rounded once"),
    exact(Q::KernelEvaluateRandom, "evaluate", RANDOM, 5_000_000,
        "sums modulo 2^64, and roundings that are part of the definition"),
    exact(Q::KernelPlaneRandom, "evaluate", RANDOM, 20_000,
        "minors of 256 bits, cut before they are rounded as the definition has it"),
    exact(Q::KernelStitchRandom, "stitch", RANDOM, 1_000_000,
        "decisions"),
    exact(Q::KernelEmitRandom, "emit", RANDOM, 100_000,
        "one quotient, rounded once"),
    exact(Q::KernelUnitRandom, "stitch", RANDOM, 2_000_000,
        "all blocks of hybrid, triangles, sfarti and moreton, one after the other"),
    exact(Q::KernelPatternRandom, "d3d11", RANDOM, 5_000_000,
        "decisions"),
    exact(Q::KernelD3d11Random, "d3d11", RANDOM, 200_000,
        "all of the unit: decisions, and singles by the rules of IEEE 754"),
    exact(Q::KernelLookedAt, "d3d11", RANDOM, 10_000,
        "signs of areas, equal words, first in and first out"),
    exact(Q::KernelEscRandom, "esc", RANDOM, 500_000,
        "decisions, and roundings that are part of the definition"),
    exact(Q::KernelResolution, "esc", RANDOM, 40_000,
        "levels of resolution: comparisons of integers"),
    exact(Q::KernelNear, "esc", RANDOM, 5_000,
        "decisions on the very threshold"),
];
