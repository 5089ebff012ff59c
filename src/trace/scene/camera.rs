//! Camera: where to stand and what to look at in, the matrices of a frame out.
//!
//! World coordinates are right-handed with z up; the eye looks along its -z; depth is 0 at the near
//! plane and 1 at the far one, which is finite, so that the range of clip space follows from the
//! frame.

use super::super::command::{Frame, Range};
use glam::{DMat3, DMat4, DVec3};
use rtl_model::patch::Depth;

/// The picture of all scenes, in pixels.
const VIEWPORT: [u32; 2] = [1280, 1024];
/// Cotangent of half the vertical angle of view: 53 degrees.
const FOCAL: f64 = 2.0;
/// How much of the picture's sides a fitted model may fill.
const FILL: f64 = 0.92;

/// A perspective camera.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    eye: DVec3,
    /// Columns: right, up and back, in world space.
    axes: DMat3,
    near: f64,
    far: f64,
}

impl Camera {
    /// At `eye`, looking at `target`, seeing what is between the distances `near` and `far`.
    #[must_use]
    pub fn at(eye: [f64; 3], target: [f64; 3], near: f64, far: f64) -> Self {
        let eye = DVec3::from(eye);
        Self { eye, axes: axes(eye - DVec3::from(target)), near, far }
    }

    /// Looking at `points` from the direction `from`, as near as all of them are seen.
    #[must_use]
    pub fn on(points: &[[f32; 3]], from: [f64; 3]) -> Self {
        let axes = axes(DVec3::from(from));
        let world = points.iter().map(|p| DVec3::from(p.map(f64::from)));
        let seen: Vec<DVec3> = world.map(|p| axes.transpose() * p).collect();
        let low = seen.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = seen.iter().copied().reduce(DVec3::max).unwrap_or_default();
        let mut middle = (low + high) / 2.0;
        // A model of no size gets one, in proportion to where it is.
        let size = (high - low).max_element().max(1e-6 * middle.abs().max_element()).max(1e-6);
        let depth = (high.z - low.z) / 2.0;
        let fitted = |middle: DVec3| {
            seen.iter().map(|p| room(*p - middle)).fold(depth + size / 16.0, f64::max)
        };
        // What is near looks larger, so the middle of the picture is not that of the box: a few
        // steps find it.
        for _ in 0..8 {
            let distance = fitted(middle);
            let shown = |p: &DVec3| (*p - middle) / (distance - (p.z - middle.z));
            let least = seen.iter().map(shown).reduce(DVec3::min).unwrap_or_default();
            let most = seen.iter().map(shown).reduce(DVec3::max).unwrap_or_default();
            let shift = (least + most) / 2.0 * distance;
            middle += DVec3::new(shift.x, shift.y, 0.0);
        }
        let distance = fitted(middle);
        Self {
            eye: axes * (middle + DVec3::Z * distance),
            axes,
            near: (distance - depth) / 2.0,
            far: (distance + depth) * 2.0,
        }
    }

    /// The frame that this camera takes.
    #[must_use]
    pub fn frame(&self) -> Frame {
        let turn = DMat4::from_mat3(self.axes.transpose());
        let view = turn * DMat4::from_translation(-self.eye);
        let Self { near, far, .. } = *self;
        let projection = [
            [FOCAL / aspect(), 0.0, 0.0, 0.0],
            [0.0, FOCAL, 0.0, 0.0],
            [0.0, 0.0, far / (near - far), -1.0],
            [0.0, 0.0, near * far / (near - far), 0.0],
        ];
        let single = |n: f64| n as f32 + 0.0; // + 0.0 turns -0 to 0, which reads better
        Frame {
            viewport: VIEWPORT,
            view: view.to_cols_array().map(single),
            projection: DMat4::from_cols_array_2d(&projection).to_cols_array().map(single),
            depth: Depth::ZeroToOne,
            range: Range::default(),
        }
    }
}

fn aspect() -> f64 {
    f64::from(VIEWPORT[0]) / f64::from(VIEWPORT[1])
}

/// How far from the eye the middle must be for the point at `offset` from it, in eye axes, to be
/// seen.
fn room(offset: DVec3) -> f64 {
    let side = (offset.x.abs() * FOCAL / aspect()).max(offset.y.abs() * FOCAL);
    offset.z + side / FILL
}

/// Right, up and back for an eye that stands in the direction `back`, not straight above.
fn axes(back: DVec3) -> DMat3 {
    let back = back.normalize();
    let right = DVec3::Z.cross(back).normalize();
    DMat3::from_cols(right, back.cross(right), back)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fitted_model_is_seen_whole_and_large() {
        let points: Vec<[f32; 3]> =
            (0..8).map(|i| [(i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32]).collect();
        let frame = Camera::on(&points, [0.4, -1.0, 0.5]).frame();
        let matrix = DMat4::from_cols_array(&frame.projection.map(f64::from))
            * DMat4::from_cols_array(&frame.view.map(f64::from));
        let seen: Vec<DVec3> =
            points.iter().map(|p| matrix.project_point3(DVec3::from(p.map(f64::from)))).collect();
        let most = seen.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
        assert!((0.75..0.95).contains(&most), "{most}");
        assert!(seen.iter().all(|p| (0.0..=1.0).contains(&p.z)), "{seen:?}");
        assert!(seen[4].y > seen[0].y, "z is up");
        assert!(seen[1].x > seen[0].x, "x is to the right");
    }
}
