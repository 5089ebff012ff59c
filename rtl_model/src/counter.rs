//! The declarations of counters: every number that a run reports, with its measure, meaning and
//! conservation law.
//!
//! Declared once, here; a block adds to them by name and cannot invent one. Values are `u64`. Names
//! that end in `.peak` aggregate by maximum, all others by sum. What every block of a timed chain
//! has alike (tokens, arithmetic, its FIFO, its cycles) is declared once for all in [`standard`].

pub mod standard;

use std::fmt;

/// What a counter measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Bytes.
    Bytes,
    /// Clock cycles.
    Cycles,
    /// Things counted.
    Count,
    /// Entries of an on-chip store.
    Entries,
    /// Bits.
    Bits,
}

impl Measure {
    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Cycles => "cycles",
            Self::Count => "count",
            Self::Entries => "entries",
            Self::Bits => "bits",
        }
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Where a counter belongs, in the order of the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Block {
    /// The command stream itself.
    Trace,
    /// The link from the host.
    Link,
    /// Device memory.
    Memory,
    /// The control-point shader.
    Transform,
    /// The input port.
    Port,
    /// Primitives to patches.
    Assemble,
    /// The hull shader.
    Hull,
    /// Trivial clipping.
    Clip,
    /// Back-face removal.
    Backface,
    /// Tessellation levels.
    Level,
    /// Parameter lists.
    Place,
    /// Tessellation factors.
    Factors,
    /// Domain points.
    Points,
    /// What joins them.
    Connect,
    /// Points of the surface.
    Evaluate,
    /// Triangles.
    Stitch,
    /// The domain shader.
    Domain,
    /// Patches to waves.
    Group,
    /// The surface shader.
    Surface,
    /// Perspective divide and output.
    Emit,
    /// Index fetch, and the cache of shaded vertices.
    VertexCache,
    /// The vertex shader.
    VertexShader,
    /// The unit as a whole.
    Unit,
}

impl Block {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trace => "trace",
            Self::Link => "link",
            Self::Memory => "memory",
            Self::Transform => "transform",
            Self::Port => "port",
            Self::Assemble => "assemble",
            Self::Hull => "hull",
            Self::Clip => "clip",
            Self::Backface => "backface",
            Self::Level => "level",
            Self::Place => "place",
            Self::Factors => "factors",
            Self::Points => "points",
            Self::Connect => "connect",
            Self::Evaluate => "evaluate",
            Self::Stitch => "stitch",
            Self::Domain => "domain",
            Self::Group => "group",
            Self::Surface => "surface",
            Self::Emit => "emit",
            Self::VertexCache => "vertex_cache",
            Self::VertexShader => "vertex_shader",
            Self::Unit => "unit",
        }
    }
}

/// The declaration of a counter.
#[derive(Clone, Copy, Debug)]
pub struct Declaration {
    /// The counter.
    pub counter: Counter,
    /// The block that it belongs to.
    pub block: Block,
    /// Its name within the block.
    pub name: &'static str,
    /// Its measure.
    pub measure: Measure,
    /// What exactly is counted.
    pub meaning: &'static str,
    /// The conservation law that it takes part in; empty where it has none.
    pub law: &'static str,
}

macro_rules! counters {
    ($($(#[$block_doc:meta])* $block:ident { $($counter:ident $name:literal $measure:ident $meaning:literal, $law:literal;)* })*) => {
        /// Every counter. The order is the order of reports.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(usize)]
        pub enum Counter { $($(#[doc = $meaning] $counter,)*)* }

        /// All declarations, in the order of [`Counter`].
        pub const DECLARATIONS: &[Declaration] = &[$($(Declaration {
            counter: Counter::$counter,
            block: Block::$block,
            name: $name,
            measure: Measure::$measure,
            meaning: $meaning,
            law: $law,
        },)*)*];
    };
}

counters! {
    Trace {
        TraceFrames "frames" Count "frame commands", "";
        TraceDraws "draws" Count "draw commands, instances not multiplied", "";
        TracePatches "patches" Count "patches drawn, over all instances", "= assemble patches";
    }
    Link {
        LinkCommands "bytes.commands" Bytes "command headers, 8 bytes a command other than the trace's header and end", "";
        LinkMatrices "bytes.matrices" Bytes "matrices, 64 bytes each: view and projection of a frame, model or instances of a draw", "";
        LinkControlPoints "bytes.control_points" Bytes "control points, 12 bytes (xyz) or 16 (xyzw), where their command stands", "";
        LinkAttributes "bytes.attributes" Bytes "attributes of corners, each component by its format, where their command stands", "";
        LinkFactors "bytes.factors" Bytes "levels that the driver chose: 4 floats a patch (unit `moreton`), or 4 bytes an instance (unit `esc`, `esc.scope` object)", "= 16 x trace patches, 4 x instances, or 0";
        LinkVertices "bytes.vertices" Bytes "tessellated vertices with all their attributes (unit `triangles`): once where they are streamed, at their upload where they are resident", "";
        LinkIndices "bytes.indices" Bytes "indices of indexed meshes, 2 or 4 bytes each: 16 a patch, and 4 of its corners' attributes; in unit `triangles` those of triangles, likewise, of 2 or 4 bytes (`triangles.index`)", "";
        LinkOverhead "bytes.overhead" Bytes "packet framing: one header for each started packet of a command's payload; under pull for each completion of its reads", "";
        LinkRequests "bytes.requests" Bytes "read requests, upstream: one for each started `link.request` bytes of a command under pull; 0 under push", "";
        LinkTotal "bytes.total" Bytes "all bytes that crossed the link, in both directions", "= sum of the other link bytes";
    }
    Memory {
        MemoryReadControlPoints "bytes.read.control_points" Bytes "resident control points, read by each instance of each draw that uses them", "<= bytes.uncached.control_points where a mesh is indexed";
        MemoryUncachedControlPoints "bytes.uncached.control_points" Bytes "what the reads of resident control points would be without the cache of an indexed mesh's points", ">= bytes.read.control_points";
        MemoryReadAttributes "bytes.read.attributes" Bytes "resident attributes, read by each instance of each draw that uses them", "";
        MemoryWrittenControlPoints "bytes.written.control_points" Bytes "resident control points, written once where their command stands", "<= link bytes.control_points";
        MemoryWrittenAttributes "bytes.written.attributes" Bytes "resident attributes, written once where their command stands", "<= link bytes.attributes";
        MemoryReadPatches "bytes.read.patches" Bytes "what hull shaders wrote, read by domain shaders, once for each patch that is tessellated (`hull.to_memory`; unit `d3d11`)", "<= bytes.written.patches";
        MemoryWrittenPatches "bytes.written.patches" Bytes "what hull shaders wrote for domain shaders (`hull.to_memory`; unit `d3d11`)", "= hull bytes.out, or 0";
        MemoryReadVertices "bytes.read.vertices" Bytes "vertices of triangles, read for each invocation of the vertex shader (unit `triangles`, where they are resident or a cache may ask for them again)", "= vertex_cache misses x bytes of a vertex, or 0";
        MemoryWrittenVertices "bytes.written.vertices" Bytes "vertices of triangles, written as they cross the link (unit `triangles`)", "= link bytes.vertices, or 0";
        MemoryReadIndices "bytes.read.indices" Bytes "indices of triangles, read by each instance of each draw (unit `triangles`)", "= vertex_cache indices x 2 or 4, or 0";
        MemoryWrittenIndices "bytes.written.indices" Bytes "indices of triangles, written as they cross the link (unit `triangles`)", "= link bytes.indices, or 0";
        MemoryMeshesPeak "bytes.meshes.peak" Bytes "most bytes that vertices and indices of triangles take in memory at once (unit `triangles`): of all meshes that are resident, or of the greatest draw", "<= bytes written, over the run";
        MemoryPatchBursts "bursts.patches" Count "of the bursts, those of what hull shaders wrote; each patch starts a burst of its own", "<= bursts";
        MemoryBursts "bursts" Count "memory bursts, read and written; each instance of a draw, each upload, and each point or vertex of an indexed mesh that does not follow the one before starts a burst of its own", "bursts x burst = bytes read + written + wasted";
        MemoryWasted "bytes.wasted" Bytes "bytes of bursts that nothing asked for", "";
    }
    Transform {
        TransformInvocations "invocations" Count "control points transformed", "= assemble control_points.received = port points";
        TransformBytesIn "bytes.in" Bytes "what the control-point shader reads: a point, 12 or 16 bytes", "";
        TransformBytesOut "bytes.out" Bytes "what it writes: a vec4, 16 bytes", "= 16 x invocations";
    }
    Port {
        PortPoints "points" Count "control points quantised", "= transform invocations";
        PortSaturated "saturated" Count "control points of which a coordinate did not fit the position format", "<= port points";
        PortObjectSaturated "saturated.object" Count "control points of which a coordinate did not fit the format of object space, where they are wanted beside those in clip space (unit `esc`, `esc.space` object)", "<= port points";
        PortAttributesSaturated "attributes.saturated" Count "components of attributes that did not fit the attribute format, once where their command stands", "";
        PortOverflows "overflows" Count "coordinates that did not fit the position format", "saturated <= overflows <= 4 x saturated";
    }
    Assemble {
        AssembleReceived "control_points.received" Count "control points that entered, once for each instance", "= port points";
        AssembleReused "control_points.reused" Count "control points of patches taken from on-chip state instead of the stream", "received + reused = 16 x patches";
        AssembleWhole "patches.whole" Count "patches of an indexed mesh of which every control point was on chip", "<= patches";
        AssembleCorners "corners.received" Count "corners of patches with attributes that entered, once for each instance", "";
        AssembleCornersReused "corners.reused" Count "corners with attributes taken from on-chip state instead of the stream", "received + reused = 4 x trace patches with attributes";
        AssemblePatches "patches" Count "patches assembled", "= trace patches + patches.measured = clip patches.in";
        AssembleMeasured "patches.measured" Count "of those, patches of a first pass, which only measures them (`level.union`; unit `sfarti`)", "= trace patches of strips, fans and meshes, or 0";
        AssembleEdgePeak "edge_entries.peak" Entries "most control points of shared edges held at once: a mesh's last row and the last patch's column, a strip's or fan's last edge", "";
        AssembleEdgeLifetime "edge_entries.lifetime.peak" Count "most patches between the one that brings a shared control point and the last that uses it", "";
        AssembleCornerPeak "corner_entries.peak" Entries "most corners whose attributes are held at once for a later patch", "";
    }
    Hull {
        HullInvocations "invocations" Count "patches whose patch-constant function ran, once each", "= assemble patches = factors tokens.in";
        HullThreads "threads" Count "control-point threads, one for each of a patch's 16 points: each transforms its point to clip space", "= 16 x invocations";
        HullBytesIn "bytes.in" Bytes "what they read: of each patch 16 control points, 12 or 16 bytes each, and its corners' attributes", "";
        HullBytesOut "bytes.out" Bytes "what they hand to the domain shader: of each patch 16 vec4 and 6 factors, 280 bytes, and its corners' attributes", ">= 280 x invocations";
        HullBytesOnChip "bytes.out.on_chip" Bytes "of that, what stays on chip", "= bytes.out, or 0 (`hull.to_memory`)";
        HullDistanceTests "distance_tests" Count "candidate positions at which the policy `adaptive` compared surface and control polygon", "0 under `criterion`";
    }
    Clip {
        ClipIn "patches.in" Count "patches tested (unit `d3d11`: by the patch-constant function, which culls by a factor of zero)", "= assemble patches";
        ClipCulled "patches.culled" Count "patches wholly outside one clip plane", "in - culled = backface patches.in";
        ClipMeasured "patches.culled.measured" Count "of those, patches of a first pass, which are removed again in the second (`level.union`; unit `sfarti`)", "<= patches.culled; this + backface patches.culled.measured + place patches.measured = assemble patches.measured";
    }
    Backface {
        BackfaceIn "patches.in" Count "patches that reached back-face removal, tested or not", "= clip patches.in - patches.culled";
        BackfaceTested "patches.tested" Count "patches tested: the draw culls, the method is not off and no point was saturated", "culled <= tested <= in";
        BackfaceFacets "facets.tested" Count "facets, coefficients or directions, by method, that a test in order looks at until one keeps the patch; all of them where none does", "patches.tested <= facets.tested <= patches.tested x those of the method";
        BackfaceCulled "patches.culled" Count "patches removed as back-facing", "in - culled = level patches + place patches.measured";
        BackfaceMeasured "patches.culled.measured" Count "of those, patches of a first pass, which are removed again in the second (`level.union`; unit `sfarti`)", "<= patches.culled";
    }
    Level {
        LevelPatches "patches" Count "patches given levels; once, where they pass twice", "= backface patches.in - patches.culled - place patches.measured";
        LevelFlatness "patches.flatness" Count "patches whose levels keep a flatness", "flatness + edge_length <= patches; the rest have fixed levels";
        LevelEdgeLength "patches.edge_length" Count "patches whose levels come from the lengths of edges", "flatness + edge_length <= patches";
        LevelSplits "splits" Count "de Casteljau subdivisions of boundary and internal curves (unit `sfarti`); 0 where levels come from bounds", "<= 8 x 127 x patches";
        LevelClamped "levels.clamped" Count "levels, of four edges and two interior directions, of which the criterion asked more than max_level", "<= 6 x patches";
        LevelNear "edges.near" Count "edges given max_level because one of their points is nearer than the near threshold", "<= 4 x patches";
        LevelOverflows "overflows" Count "projected control points that did not fit the projection's format", "";
    }
    Place {
        PlaceMeasured "patches.measured" Count "patches whose lists were taken into the unions of their primitive's columns and rows, and which come again (`level.union`; unit `sfarti`)", "= level patches of strips, fans and meshes, or 0; <= assemble patches.measured";
        PlaceListsPeak "lists.peak" Entries "most lists of a primitive held at once: one for each column and each row (`level.union`; unit `sfarti`)", "";
        PlaceReciprocals "reciprocals" Count "reciprocals formed: one for each distinct level of a patch above 1", "<= 6 x patches";
        PlaceParameters "parameters" Count "parameters placed: the segments of the four edges, and the inner entries of the two interior lists", "";
    }
    Factors {
        FactorsProcessed "factors" Count "tessellation factors converted and clamped: six a patch", "= 6 x hull invocations";
        FactorsCulled "patches.culled" Count "patches culled for an outer factor of zero", "= clip patches.culled + backface patches.culled";
    }
    Points {
        PointsGenerated "points" Count "domain points generated, once each", "= emit vertices, where every point is kept (`domain.cache_entries` absent)";
        PointsParameters "parameters" Count "parameters placed: those of the four edges and of the interior's two directions", ">= 8 x level patches";
        PointsNonMonotone "points.non_monotone" Count "points of edges that lie before the point before them: rounded reciprocals, fractional even, factors just above 6 and 30", "<= points";
    }
    Connect {
        ConnectTriangles "triangles" Count "triangles made", "= 2 x points - edge points - 2, summed over patches; = emit triangles";
        ConnectInverted "triangles.inverted" Count "triangles turned round in the domain: they belong to points that are not monotone", "<= triangles";
        ConnectZeroArea "triangles.zero_area" Count "triangles without area in the domain: normal where a factor is near an integer", "<= triangles";
        ConnectDegenerate "triangles.degenerate" Count "triangles with two equal clip positions; they stay in the mesh", "<= triangles";
    }
    Evaluate {
        EvaluateInvocations "invocations" Count "points evaluated: boundary and interior vertices, and the control points of interior rows", "";
        EvaluateVertices "vertices" Count "distinct parameters within the patch", "= emit vertices";
        EvaluateShared "vertices.shared" Count "vertices on edges that an earlier patch of the same primitive has evaluated too: what its edge database could spare, and does not", "<= vertices";
        EvaluateHeldPeak "edge_vertices.peak" Entries "most vertices of a primitive's shared edges, each edge with both its ends, that later patches will meet", "";
        EvaluateStrips "strips" Count "strips of triangles handed to the stitcher: the gaps between interior rows, the half-sides, the segments across a centre", "= stitch tokens.in";
        EvaluateCurves "curves" Count "curves set up for forward differencing, a half-run each; 0 under de Casteljau", "";
        EvaluateSteps "steps" Count "forward-difference steps of a vec4, or de Casteljau curve points", "";
        EvaluateAttributes "attributes" Count "components of attributes interpolated: a draw's, at each of its vertices", "";
        EvaluateNormals "normals" Count "tangent planes evaluated", "= vertices or 0";
        EvaluateNormalsDegenerate "normals.degenerate" Count "vertices where the tangent plane vanishes", "<= normals";
        EvaluateOverflows "overflows" Count "coordinates of evaluated points that did not fit the position format", "";
    }
    Stitch {
        StitchTriangles "triangles" Count "triangles made", "= 2 x vertices - boundary vertices - 2, summed over patches; = emit triangles";
        StitchDegenerate "triangles.degenerate" Count "triangles with two equal clip positions; they stay in the mesh", "<= triangles";
    }
    Domain {
        DomainInvocations "invocations" Count "points shaded: once for each time that the cache of shaded points lacks one", "points <= invocations <= 3 x connect triangles; = emit vertices";
        DomainRepeated "invocations.repeated" Count "of those, points that were shaded for the same patch before", "= invocations - points";
        DomainWaves "waves" Count "SIMD waves: full ones, and the last of a patch", "= connect tokens.out";
        DomainIdle "lanes.idle" Count "SIMD lanes of waves that have no point to shade", "waves x domain.width = invocations + lanes.idle";
        DomainIdleCycles "lane_cycles.idle" Cycles "cycles that those lanes last: of each wave, its interval", "= lanes.idle x interval";
        DomainBytesControlPoints "bytes.in.control_points" Bytes "control points read: 16 vec4 for every invocation (naive), or for every patch (basis)", "= 256 x invocations, or 256 x level patches";
        DomainBytesParameters "bytes.in.parameters" Bytes "parameters read", "= invocations x domain.bytes_in";
        DomainBytesAttributes "bytes.in.attributes" Bytes "attributes of corners read: four corners, as often as control points are", "";
        DomainBytesOut "bytes.out" Bytes "shaded points with their attributes", "= invocations x domain.bytes_out + emit bytes.attributes";
        DomainAttributes "attributes" Count "components of attributes interpolated: a draw's, at each invocation", "";
        DomainNormals "normals" Count "tangent planes evaluated", "= invocations or 0";
        DomainCracks "cracks" Count "points of edges, corners left out, that come out otherwise for a neighbour that walks the edge from its other end or has it on another side: 0 under `paired`", "<= points";
        DomainOverflows "overflows" Count "coordinates of shaded points that did not fit the position format", "";
    }
    Group {
        GroupWaves "waves" Count "SIMD waves of invocations: full ones, and those that end with their draw or batch", "= tokens.out";
        GroupInvocations "invocations" Count "invocations that joined a wave", "= surface invocations";
        GroupIdle "lanes.idle" Count "SIMD lanes of waves without an invocation", "rounds x esc.width = invocations + lanes.idle";
        GroupRounds "rounds" Count "waves, those of a patch with more sections than lanes counted as often as it fills them", ">= waves";
    }
    Surface {
        SurfaceInvocations "invocations" Count "surface-shader invocations: one a patch, or one a section of it (`esc.output_values`)", ">= level patches";
        SurfaceControlPoints "control_points" Count "control points read, 16 an invocation", "= 16 x invocations";
        SurfaceBytesIn "bytes.in" Bytes "what they read: 16 vec4 an invocation, as many again of three components where the test is in object units, and attributes of four corners", ">= 256 x invocations";
        SurfaceNets "nets" Count "products `[N][B][M]^T` of four components: none where a section has no strip at its patch's level (`esc.output_values`)", "<= invocations; = invocations where a patch is one";
        SurfaceObjectNets "nets.object" Count "the same of control points in object space, for tests in object units", "= nets or 0";
        SurfaceTests "tests" Count "distance tests of candidates", "0 where `esc.mu` is 0";
        SurfaceInserted "tests.inserted" Count "of those, where the vertex was inserted", "<= tests";
        SurfaceEvaluations "evaluations" Count "points evaluated, corners of patches not counted: they are copied", "= evaluations.boundary + coarse_edges + interior + tests";
        SurfaceBoundary "evaluations.boundary" Count "of those, on the patch's boundary", "";
        SurfaceCoarse "evaluations.coarse_edges" Count "of those, on coarse edges within the patch", "";
        SurfaceInterior "evaluations.interior" Count "of those, within coarse triangles", "";
        SurfaceTested "evaluations.tests" Count "of those, for a test alone: not inserted, or not kept, or in object space", "";
        SurfaceTestedBoundary "evaluations.tests.boundary" Count "of these, on the patch's boundary", "<= evaluations.tests";
        SurfaceCorners "corners" Count "corners of patches, copied", "";
        SurfacePoints "points" Count "distinct points of the mesh", "<= emit vertices";
        SurfaceStripVertices "strip_vertices" Count "vertices of the triangle strips, as lists (section 3 of the paper)", ">= points";
        SurfaceSlots "slots" Count "slots of the strips: triangles, or nothing", "triangles <= slots";
        SurfaceTriangles "triangles" Count "triangles made", "= emit triangles";
        SurfaceDegenerate "triangles.degenerate" Count "triangles with two equal clip positions; they stay in the mesh", "<= triangles";
        SurfaceMoved "vertices.moved" Count "vertices on edges of a lower level than their patch's that stand beside the pattern's place", "<= points";
        SurfaceBufferPeak "buffer.bits.peak" Bits "what an invocation keeps of points that it evaluated: a position each", "";
        SurfaceRegistersPeak "registers.bits.peak" Bits "registers of an invocation: 64 coefficients, and `esc.registers` words", "= 64 x (position.width + 8 + guard) + 32 x registers, or 0";
        SurfaceLaneCycles "lane_cycles" Cycles "lanes of the waves x the cycles that each wave takes", "= lane_cycles.used + lane_cycles.idle";
        SurfaceUsedCycles "lane_cycles.used" Cycles "of those, in which a lane has something to do", "";
        SurfaceIdleCycles "lane_cycles.idle" Cycles "of those, in which it waits for another lane, or has no invocation", "";
        SurfaceAttributes "attributes" Count "components of attributes interpolated: a draw's, at each vertex that leaves", "";
        SurfaceBytesOut "bytes.out" Bytes "vertices with their attributes", "= emit vertices x esc.bytes_out + emit bytes.attributes";
        SurfaceNormals "normals" Count "tangent planes evaluated", "= emit vertices or 0";
        SurfaceCracks "cracks" Count "points of edges, corners left out, that come out otherwise for a neighbour that walks the edge from its other end or has it on another side: 0 under `symmetric`", "<= points";
        SurfaceOverflows "overflows" Count "coordinates of evaluated points that did not fit the position format", "";
    }
    Emit {
        EmitVertices "vertices" Count "vertices that left the unit", "= evaluate vertices, or domain invocations; unit `esc`: strip_vertices without reuse, else the points that each invocation or coarse triangle gives";
        EmitTriangles "triangles" Count "triangles that left the unit", "= stitch, connect or surface triangles";
        EmitAttributeBytes "bytes.attributes" Bytes "interpolated attributes that left the unit with its vertices", "= evaluate, domain or surface attributes x bytes of a component";
        EmitBytes "bytes" Bytes "vertex records, attributes and triangle indices that left the unit", "= vertices x vertex_bytes + bytes.attributes + 3 x triangles x index_bytes, these not where strips leave (`esc.reuse` none)";
        EmitToClipper "vertices.to_clipper" Count "vertices left homogeneous: w <= 0, or outside the sub-pixel format's band", "<= vertices";
    }
    VertexCache {
        VertexCacheIndices "indices" Count "indices that draws name their triangles by (unit `triangles`)", "= 3 x emit triangles (lists), or emit triangles + 2 x strips + indices.repeated + indices.restarts";
        VertexCacheRestarts "indices.restarts" Count "of those, the greatest index, which ends a strip (`triangles.topology` strip_restart)", "= strips - batches, or 0";
        VertexCacheRepeated "indices.repeated" Count "of those, indices that begin no triangle with an area: they turn strips, or join them", "0 in lists";
        VertexCacheStrips "strips" Count "strips of triangles", "0 in lists";
        VertexCacheBatches "batches" Count "draws of the device: one for each instance that is drawn (resident meshes) or each draw with triangles (streamed), and one more each time that 2-byte indices reach no further", "";
        VertexCacheHits "hits" Count "indices whose vertex was shaded already", "hits + misses + indices.restarts = indices";
        VertexCacheMisses "misses" Count "indices whose vertex must be shaded", "= vertex_shader invocations; = emit vertices where `triangles.cache` is unlimited";
    }
    VertexShader {
        VertexShaderInvocations "invocations" Count "vertices shaded; every distinct vertex of a patch once, or as often as a cache lacks it (unit `triangles`)", "= emit vertices, or vertex_cache misses";
        VertexShaderBytesIn "bytes.in" Bytes "what the vertex shader reads", "";
        VertexShaderBytesOut "bytes.out" Bytes "what it writes", "";
    }
}

/// How many counters there are.
pub const COUNT: usize = DECLARATIONS.len();

/// Which counters aggregate by maximum: a table, for every addition asks it.
const PEAKS: [bool; COUNT] = {
    let mut peaks = [false; COUNT];
    let mut i = 0;
    while i < COUNT {
        peaks[i] = matches!(DECLARATIONS[i].name.as_bytes(), [.., b'.', b'p', b'e', b'a', b'k']);
        i += 1;
    }
    peaks
};

impl Counter {
    /// Its declaration.
    #[must_use]
    pub fn declaration(self) -> &'static Declaration {
        &DECLARATIONS[self as usize]
    }

    /// Whether it aggregates by maximum.
    #[must_use]
    pub const fn is_peak(self) -> bool {
        PEAKS[self as usize]
    }
}

/// The values of all counters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counters([u64; COUNT]);

impl Default for Counters {
    fn default() -> Self {
        Self([0; COUNT])
    }
}

impl Counters {
    /// Adds `n`; for a peak, keeps the larger.
    ///
    /// # Panics
    /// When a sum exceeds 64 bits.
    #[inline]
    pub fn add(&mut self, counter: Counter, n: u64) {
        let value = &mut self.0[counter as usize];
        *value = if counter.is_peak() {
            (*value).max(n)
        } else {
            value.checked_add(n).expect("a counter stays within 64 bits")
        };
    }

    /// The value.
    #[must_use]
    pub fn get(&self, counter: Counter) -> u64 {
        self.0[counter as usize]
    }

    /// Takes in the counters of another part of the same run.
    pub fn merge(&mut self, other: &Self) {
        for declaration in DECLARATIONS {
            self.add(declaration.counter, other.get(declaration.counter));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_stand_in_the_order_of_the_enum_and_have_distinct_names() {
        for (i, d) in DECLARATIONS.iter().enumerate() {
            assert_eq!(d.counter as usize, i);
            assert!(!d.meaning.is_empty());
        }
        let mut names: Vec<_> = DECLARATIONS.iter().map(|d| (d.block, d.name)).collect();
        assert!(names.is_sorted_by_key(|n| n.0), "blocks stand in the order of the data");
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), COUNT);
    }

    #[test]
    fn peaks_aggregate_by_maximum_and_the_rest_by_sum() {
        let mut a = Counters::default();
        a.add(Counter::AssembleEdgePeak, 7);
        a.add(Counter::StitchTriangles, 7);
        let mut b = a.clone();
        b.merge(&a);
        assert_eq!(b.get(Counter::AssembleEdgePeak), 7);
        assert_eq!(b.get(Counter::StitchTriangles), 14);
    }
}
