//! The control-point shader: object-space points in, clip-space points out (Sfarti et al. 2005,
//! section 5).

use glam::{Mat4, Vec4, Vec4Swizzles};

/// `m * p`, columns added in order: ((m0 x + m1 y) + m2 z) + m3 w.
#[must_use]
#[inline]
pub fn transform(m: &Mat4, p: [f32; 4]) -> [f32; 4] {
    let p = Vec4::from_array(p);
    let sum = m.x_axis * p.xxxx() + m.y_axis * p.yyyy();
    ((sum + m.z_axis * p.zzzz()) + m.w_axis * p.wwww()).to_array()
}

/// `a * b`, each column of `b` as a point.
#[must_use]
pub fn concatenate(a: &Mat4, b: &Mat4) -> Mat4 {
    Mat4::from_cols_array_2d(&b.to_cols_array_2d().map(|column| transform(a, column)))
}
