// Rows and strips of a coarse triangle (Concheiro, Amor, Boo, Padron 2014, section 3): which
// candidates are inserted, in; what stands at a place of a row, and the triangle of a slot, out.
// Stands between the pattern and the texts of the mesh, which declare `decisions`.

struct Insertion {
    // Inserted positions of the three edges, with both corners: 17 bits.
    left: u32,
    right: u32,
    bottom: u32,
    // 1 to 16; also the number of the last row.
    segments: u32,
}

// The positions of an edge, counted as the coarse triangle does.
fn chain_of(at_patch: u32, edge: u32, turns: bool, segments: u32) -> u32 {
    var mask = decisions[DECISION * (COARSE_EDGES * at_patch + edge)];
    if (turns) {
        // Position p goes to R - p; bit p of 32 goes to 31 - p.
        mask = reverseBits(mask) >> (31u - segments);
    }
    return mask | 1u | 1u << segments;
}

fn insertion_of(at_patch: u32, triangle: u32, segments: u32) -> Insertion {
    let edges = edges_of(triangle);
    let turns = (triangle & 1u) != 0u;
    return Insertion(
        chain_of(at_patch, edges.x, turns, segments),
        chain_of(at_patch, edges.y, turns, segments),
        chain_of(at_patch, edges.z, turns, segments),
        segments,
    );
}

// A row has vertices of its own where one of its ends is inserted.
fn has_row(insertion: Insertion, row: u32) -> bool {
    return ((insertion.left | insertion.right) >> row & 1u) != 0u;
}

// The closest row above that has vertices; the apex has.
fn row_above(insertion: Insertion, row: u32) -> u32 {
    return firstLeadingBit((insertion.left | insertion.right) & ((1u << row) - 1u));
}

// The inserted position that is nearest, of two the later one. Both ends are inserted.
fn nearest(chain: u32, position: u32) -> u32 {
    let after = firstTrailingBit(chain & ~((1u << position) - 1u));
    let before = firstLeadingBit(chain & ((2u << position) - 1u));
    return select(before, after, after - position <= position - before);
}

// What stands at a place of a row that has vertices: a site, as row and place.
fn entry(insertion: Insertion, row: u32, place: u32) -> vec2<u32> {
    if (row == insertion.segments) {
        return vec2(row, nearest(insertion.bottom, place));
    }
    if (place == 0u) {
        return vec2(nearest(insertion.left, row), 0u);
    }
    if (place == row) {
        return vec2(nearest(insertion.right, row));
    }
    return vec2(row, place);
}

// What stands at place h of a row that is spread over `places` places: a virtual vertex takes one
// at its end, and of the v others place j has the row's own vertex floor(j m / v).
fn spread(insertion: Insertion, row: u32, places: u32, h: u32) -> vec2<u32> {
    let missing = vec2(
        1u - (insertion.left >> row & 1u),
        1u - (insertion.right >> row & 1u),
    );
    if (missing.x == 1u && h == 0u) {
        return entry(insertion, row, 0u);
    }
    if (missing.y == 1u && h == places - 1u) {
        return entry(insertion, row, row);
    }
    let own = row + 1u - missing.x - missing.y;
    let others = places - missing.x - missing.y;
    return entry(insertion, row, missing.x + (h - missing.x) * own / max(others, 1u));
}

// The three sites of slot k of the strip above a row.
fn slot_of(insertion: Insertion, upper: u32, lower: u32, k: u32) -> array<vec2<u32>, 3> {
    let left = entry(insertion, lower, (k + 1u) / 2u);
    let above = spread(insertion, upper, lower, k / 2u);
    if ((k & 1u) == 0u) {
        return array<vec2<u32>, 3>(left, entry(insertion, lower, k / 2u + 1u), above);
    }
    return array<vec2<u32>, 3>(above, left, spread(insertion, upper, lower, k / 2u + 1u));
}

fn is_dropped(three: array<vec2<u32>, 3>) -> bool {
    let a = three[0];
    let b = three[1];
    let c = three[2];
    return all(a == b) || all(b == c) || all(c == a);
}
