// What a vertex in a buffer `vertices` is told apart by. Stands before the texts of kernels that
// look for degenerate triangles.

// Whether two have the same clip position: eight words, w among them.
fn same_position(a: u32, b: u32) -> bool {
    var unlike = 0u;
    for (var k = 0u; k < 8u; k += 1u) {
        unlike |= vertices[VERTEX * a + k] ^ vertices[VERTEX * b + k];
    }
    return unlike == 0u;
}
