//! What columns mean, and numbers that are no counters: the tables of docs/{compare,precision,
//! sweep}.md once more, for the page explains itself.

/// What the numbers of a comparison are not.
pub const CAVEATS: &str = "\
Energy is an estimate: 45 nm prices (Horowitz, ISSCC 2014), and 5 pJ a bit over the link, assumed;
work of the host is free. Textures and the frame buffer are not counted: their traffic is that of
the pixels.";

/// Numbers that `compare` derives; a name that ends in `*` is a beginning.
const DERIVED: &[(&str, &str)] = &[
    ("unit.time", "elapsed cycles at clock_mhz, in ms"),
    ("unit.frames", "frames a second, at clock_mhz"),
    (
        "memory.footprint",
        "bytes of device memory that hold resident data: points and attributes written up to the \
         end of this frame, and the most that triangle meshes took at once",
    ),
    (
        "screen.triangles.to_clipper",
        "triangles with a vertex that has w <= 0 or lies outside the sub-pixel format's band",
    ),
    ("screen.triangles.zero_area", "of the rest, those without area on the sub-pixel grid"),
    ("screen.triangles.outside", "of the rest, those wholly to one side of the viewport"),
    ("screen.triangles.front", "of the rest, those that face the eye, by the draw's `front`"),
    ("screen.triangles.back", "of the rest, those that face away"),
    ("screen.triangles.sub_pixel", "front or back, with an area below a square pixel"),
    ("screen.triangles.no_sample", "front or back, that cover no pixel's centre"),
    ("screen.area.below.*", "front or back, with less area than that, in square pixels, exactly"),
    (
        "screen.area.from.*",
        "front or back, with from so many up to four times as many square pixels, exactly",
    ),
    (
        "screen.samples",
        "pixels of the viewport covered, once for each triangle, by the top-left rule",
    ),
    ("screen.quads", "aligned 2x2 quads with a pixel covered, once for each triangle"),
    ("screen.pixels", "pixels that any triangle covers"),
    (
        "screen.quad_efficiency",
        "samples / (4 quads): what part of the pixels shaded in quads is of the triangle",
    ),
    ("screen.samples_per_pixel", "samples over pixels"),
    ("screen.triangles_per_pixel", "emitted triangles over pixels"),
    (
        "error.samples",
        "middles of cells of the true surfaces of tessellated patches that lie in the viewport",
    ),
    (
        "error.largest",
        "the greatest distance on the screen, in pixels, between a sample of the true surface and \
         the nearest point in space of its patch's triangles",
    ),
    ("error.mean", "the mean of the same distances, in pixels"),
    ("energy.operations", "an estimate, in pJ: additions, multiplications and comparisons"),
    ("energy.chip", "an estimate, in pJ: bytes read and written on the chip"),
    ("energy.memory", "an estimate, in pJ: bursts of device memory"),
    ("energy.link", "an estimate, in pJ: bits over the link, 5 pJ each (assumed)"),
    ("energy.total", "an estimate, in pJ: operations, chip, memory and link together"),
];

/// What a column is of, by file; `*` stands for every file. The first that fits is taken.
const COLUMNS: &[(&str, &str, &str)] = &[
    ("occupancy.csv", "block", "the block that the FIFO stands before"),
    ("occupancy.csv", "entries", "tokens in the FIFO"),
    ("occupancy.csv", "cycles", "cycles of the run that began with so many"),
    ("evaluators.csv", "evaluator", "how a curve is evaluated"),
    ("evaluators.csv", "segments", "segments of the curve"),
    ("evaluators.csv", "guard", "guard bits"),
    ("evaluators.csv", "width", "bits of a position, W"),
    ("evaluators.csv", "register_bits", "the widest register: W; W + 6 + guard; W + 8 + guard"),
    ("evaluators.csv", "points", "points evaluated"),
    ("evaluators.csv", "behind", "points behind the eye, not measured"),
    ("evaluators.csv", "largest_nanopixels", "the largest error, in 1e-9 pixels"),
    ("evaluators.csv", "rms_nanopixels", "the RMS error, in 1e-9 pixels"),
    ("evaluators.csv", "rms_millidecibels", "20000 log10 of the RMS error in pixels"),
    ("*", "unit", "the tessellation unit"),
    ("*", "frame", "the frame's number, from 0"),
    ("*", "block", "the part of the unit that counts"),
    ("*", "counter", "the number's own name in its block; defined below"),
    ("*", "value", "over the whole run, or of the frame where the row names one"),
    ("*", "measure", "what the value is a number of"),
    ("compare.csv", "first", "the value of the unit named first"),
    ("compare.csv", "min", "of the least frame"),
    ("compare.csv", "median", "of the median frame, the lower of the middle two"),
    ("compare.csv", "max", "of the greatest frame"),
    ("roofline.csv", "level", "the fixed level of the first frame"),
    ("roofline.csv", "triangles", "triangles emitted"),
    ("roofline.csv", "elapsed", "cycles from the first to the last"),
    ("roofline.csv", "cycles", "cycles that the block's tokens alone would occupy it"),
    ("roofline.csv", "binds", "1 for the block that binds the unit"),
    ("*", "point", "the point's number in the study's order, from 0"),
    ("*", "trace", "the trace, as the study names it"),
    ("*", "preset", "the bottom layer of the configuration"),
    ("points.csv", "state", "completed or failed"),
    ("points.csv", "reason", "why it failed"),
    ("points.csv", "hash", "its folder under points; empty where there is no such configuration"),
    ("points.csv", "clock", "in MHz"),
    ("points.csv", "time", "elapsed cycles at the clock, in ms"),
    ("precision.csv", "width", "position.width: bits of a coordinate"),
    ("precision.csv", "guard", "evaluate.guard: bits; 1 where the unit has none"),
    ("precision.csv", "reciprocal", "place.reciprocal_bits; 32 where the unit has none"),
    ("precision.csv", "subpixel", "emit.subpixel_bits"),
    ("precision.csv", "rounding", "of position, evaluate and emit; configured: each as configured"),
    ("precision.csv", "overflow", "position.overflow"),
    ("precision.csv", "position_bits", "a coordinate, W"),
    ("precision.csv", "product_bits", "the widest product of evaluate before its rounding"),
    ("precision.csv", "accumulator_*", "register D of the evaluator; 0 where there is none"),
    ("precision.csv", "parameter_bits", "a parameter, U1.16"),
    ("precision.csv", "reciprocal_bits", "the reciprocal, U1.n; 0 in sfarti"),
    ("precision.csv", "screen_bits", "a screen coordinate, Q16.s"),
    ("precision.csv", "datapath_bits", "these registers of one coordinate, each once; no products"),
    ("precision.csv", "area_cells", "an estimate of area, in full adders"),
    ("precision.csv", "vertices", "vertices measured"),
    ("precision.csv", "unplaced", "vertices that f64 puts on the screen and the unit does not"),
    ("precision.csv", "to_clipper", "vertices that the unit left to the clipper"),
    ("precision.csv", "*_exact_nanopixels", "position error from the surface at k / level"),
    ("precision.csv", "surface_samples", "samples of the true surface"),
    (
        "precision.csv",
        "surface_*",
        "from each sample to the nearest point of its patch's triangles, in 1e-9 pixels",
    ),
    ("precision.csv", "*_nanopixels", "position error from the surface at the reported parameters"),
    ("precision.csv", "boundary_vertices", "vertices compared along edges that two patches share"),
    ("precision.csv", "cracks", "of these, those that differ, and those without their like"),
    ("precision.csv", "triangles", "triangles"),
    ("precision.csv", "flipped", "of these, those turned round the other way than in f64"),
    ("precision.csv", "flat", "of these, those without area on the screen that have one in f64"),
    ("precision.csv", "equal_corners", "of these, those with two corners at one clip position"),
    ("precision.csv", "patches", "patches of the trace"),
    ("precision.csv", "patches_lost", "those that the unit clips or culls and f64 does not"),
    ("precision.csv", "patches_kept", "those that f64 removes and the unit does not"),
    ("precision.csv", "lists", "parameter lists compared"),
    ("precision.csv", "lists_differing", "those with another number of segments than f64's"),
    ("precision.csv", "*_saturated", "control points that did not fit"),
    ("precision.csv", "*_overflows", "evaluated coordinates, or projections, that did not fit"),
    ("precision.csv", "on_front", "1 on the Pareto front of bits, area and the larger error"),
    ("precision.csv", "serves", "1 where the format serves: within --max-error, nothing lost"),
];

/// The meaning of the first pattern that `name` is of.
pub(super) fn of(name: &str) -> Option<&'static str> {
    DERIVED.iter().find(|(pattern, _)| matches(pattern, name)).map(|(_, meaning)| *meaning)
}

/// The meaning of a column of a file.
pub(super) fn of_column(file: &str, name: &str) -> Option<&'static str> {
    let here = |of: &str| of == "*" || of == file;
    let mut known = COLUMNS.iter();
    let found = known.find(|(of, pattern, _)| here(of) && matches(pattern, name));
    found.map(|(_, _, meaning)| *meaning).or_else(|| of_sweep(file, name))
}

/// The other columns of a sweep: rates of `summary.json`, whose names say what they are, and keys.
fn of_sweep(file: &str, name: &str) -> Option<&'static str> {
    match file {
        "points.csv" if name.contains("_per_") => {
            Some("a rate of summary.json: one over the other")
        }
        "points.csv" | "sweep.csv" => Some("the configuration's key"),
        _ => None,
    }
}

/// Whether a name is of a pattern, which may have one `*` for anything.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, tail)) => {
            name.len() >= head.len() + tail.len() && name.starts_with(head) && name.ends_with(tail)
        }
    }
}
