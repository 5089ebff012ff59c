//! Emit: to come.

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Screen {
    /// Pixels from the left edge, Q16.`subpixel_bits`.
    pub x: i32,
    /// Pixels from the upper edge, Q16.`subpixel_bits`.
    pub y: i32,
    /// Whether the vertex was divided; if not, `x` and `y` are 0 and the clipper gets it homogeneous.
    pub divided: bool,
}
