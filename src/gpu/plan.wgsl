// How a plan lies in its buffer: what place decides for a patch, and evaluate and stitch go by. It
// stands before their texts; no kernel of its own.

// Words of a plan. What is counted stands first, in the order in
// which the host names it; then what rows of vertices it has; then its six lists, of the edges v0,
// u1, v1, u0 and of the interior along u and v: of each its segments, and four words, the level and
// its reciprocal, or the mask of a dyadic list, low word first.
const PLAN = 56u;
const KEPT = 0u;
const CLIPPED = 1u;
const CULLED = 2u;
const TESTED = 3u;
const FACETS = 4u;
const FLATNESS = 5u;
const EDGE_LENGTH = 6u;
const EVENTS = 7u; // clamped, near, overflows, splits
const RECIPROCALS = 11u;
const PARAMETERS = 12u;
const INVOCATIONS = 13u;
const VERTICES = 14u;
const STRIPS = 15u;
const CURVES = 16u;
const STEPS = 17u;
const ATTRIBUTES = 18u;
const TRIANGLES = 19u;
const LINES = 20u; // curves whose control points are kept: edges, the net's columns, rows
const BOUNDARY = 21u; // vertices of it
const COLUMNS = 22u; // of interior vertices
const ROWS = 23u;
const SEGMENTS = 24u;
const LISTS = 30u;

// The parameters 1 and 2 in fixed point of 16 fraction bits.
const ONE = 65536u;
const TWO = 131072u;
