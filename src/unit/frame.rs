//! What is constant over a frame, derived once from its camera: the position format, the near
//! threshold, which sign of a determinant faces the viewer, and the way back to world space.

use crate::config::{Config, Unit};
use crate::error::{Error, Result};
use crate::shader::control_point;
use crate::trace::command::Frame;
use glam::{DMat4, DVec3, DVec4, Mat4};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, View};

/// A camera's w is known to a few units of the last place of an f32: it may exceed a power of two
/// by that much.
const TOLERANCE: f64 = 1e-5;

/// A frame ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct FrameState {
    /// What the blocks need.
    pub view: View,
    /// World to clip space, in f32 as the shader has it.
    pub clip_from_world: Mat4,
    /// The format of positions in object space.
    pub object: Format,
    /// Clip to world space, column-major.
    pub to_world: [f64; 16],
}

impl FrameState {
    /// Derives the state of a frame.
    ///
    /// # Errors
    /// [`Error::Usage`] when the far plane is infinite and neither the trace nor the configuration
    /// gives a range; when unit `esc` tests in an object space whose range has no 1, or too few
    /// bits for it.
    pub fn new(frame: &Frame, config: &Config) -> Result<Self> {
        let projection = Mat4::from_cols_array(&frame.projection);
        let view = Mat4::from_cols_array(&frame.view);
        let depths = Depths::of(projection.as_dmat4(), frame.depth);
        let given = config.position.clip_range_log2.or(frame.range.clip);
        let range_log2 = given.or_else(|| depths.range_log2()).ok_or_else(|| {
            Error::Usage(
                "the far plane is infinite: expected \"range\":{\"clip\":..} in the frame, or \
                 position.clip_range_log2"
                    .into(),
            )
        })?;
        let position = Format::of_range(config.position.width, range_log2);
        let object_log2 = frame.range.object.unwrap_or(config.position.object_range_log2);
        let object = Format::of_range(config.position.width, object_log2);
        let wanted = config.unit == Unit::Esc && config.esc.tests_in_object_space();
        if wanted && !(0..object.width as i32).contains(&object.fraction) {
            return Err(Error::Usage(format!(
                "a range of 2^{object_log2} in object space: esc.space object has a w of 1 beside \
                 coordinates of {} bits, so expected 0..={}",
                object.width,
                object.width - 1
            )));
        }
        let near = config.level.near.unwrap_or(depths.nearest * (1.0 - TOLERANCE));
        let clip_from_world = control_point::concatenate(&projection, &view);
        let exact = projection.as_dmat4() * view.as_dmat4();
        let view = View {
            position,
            viewport: frame.viewport,
            depth: frame.depth,
            near: raw(near, position),
            facing: facing(exact, frame.depth),
        };
        Ok(Self { view, clip_from_world, object, to_world: exact.inverse().to_cols_array() })
    }

    /// The near threshold as a shader or the driver has it. Rounding moves a threshold, and no
    /// vertex.
    #[must_use]
    pub(super) fn near(&self) -> f32 {
        let View { near, position, .. } = self.view;
        (near as f64 * f64::from(-position.fraction).exp2()) as f32
    }

    /// The format of what the unit works on.
    #[must_use]
    pub fn position(&self, config: &Config) -> Format {
        if config.unit.in_object_space() { self.object } else { self.view.position }
    }
}

/// A real number in a format, rounded down.
fn raw(value: f64, format: Format) -> i64 {
    let max = format.max();
    (value * f64::from(format.fraction).exp2()).floor().clamp(0.0, max as f64) as i64
}

/// w of the visible volume's corners.
struct Depths {
    /// Smallest w.
    nearest: f64,
    /// Largest w, unless the volume is infinite.
    farthest: Option<f64>,
}

impl Depths {
    fn of(projection: DMat4, depth: Depth) -> Self {
        let inverse = projection.inverse();
        let mut depths = Self { nearest: f64::INFINITY, farthest: Some(0.0) };
        for corner in 0..8 {
            let side = |bit: i32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let z = if corner & 4 == 0 { first(depth) } else { 1.0 };
            let eye = inverse * DVec4::new(side(0), side(1), z, 1.0);
            // The corner's eye-space point is eye / eye.w, of which the projection has w = 1 /
            // eye.w.
            if eye.w > TOLERANCE * 1e-4 * eye.abs().max_element() {
                depths.nearest = depths.nearest.min(1.0 / eye.w);
                depths.farthest = depths.farthest.map(|w| w.max(1.0 / eye.w));
            } else {
                depths.farthest = None;
            }
        }
        depths
    }

    /// log2 of the smallest power of two that is at least 1 and above the largest w. Above, not
    /// equal: a format of range 2^k ends one ulp below it, so w = 1 of a parallel projection would
    /// saturate in a range of 1, and mark every patch.
    fn range_log2(&self) -> Option<i32> {
        let w = self.farthest? * (1.0 + TOLERANCE);
        Some(if w < 1.0 { 0 } else { w.log2().floor() as i32 + 1 })
    }
}

/// z/w where the depth range begins.
fn first(depth: Depth) -> f64 {
    match depth {
        Depth::ZeroToOne => 0.0,
        Depth::MinusOneToOne => -1.0,
    }
}

/// The sign of det[S, Su, Sv] over x, y, w where Su x Sv, taken in world space, points to the
/// viewer.
///
/// With e the generalised cross product of the rows x, y, w (the camera's centre, homogeneous),
/// that determinant is det[e, S, Su, Sv] in world space: (e_xyz - e_w p) . N for a point p with
/// normal N. So it is positive towards the viewer where e_xyz - e_w p points there itself. Parallel
/// projections have e_w = 0 and need no case.
fn facing(clip_from_world: DMat4, depth: Depth) -> i64 {
    let [x, y, w] = [0, 1, 3].map(|k| clip_from_world.row(k));
    let minor = |i: usize, j: usize, k: usize| {
        DVec3::new(x[i], x[j], x[k])
            .dot(DVec3::new(y[i], y[j], y[k]).cross(DVec3::new(w[i], w[j], w[k])))
    };
    let e = DVec4::new(minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2));
    let inverse = clip_from_world.inverse();
    let at = |share: f64| {
        let z = first(depth) + (1.0 - first(depth)) * share;
        let p = inverse * DVec4::new(0.0, 0.0, z, 1.0);
        (p.truncate() / p.w, 1.0 / p.w)
    };
    // Two points of the line of sight at finite depths, whichever end of the range is infinite.
    let ((a, wa), (b, wb)) = (at(0.25), at(0.75));
    let towards_viewer = if wb >= wa { a - b } else { b - a };
    if (e.truncate() - e.w * a).dot(towards_viewer) >= 0.0 { 1 } else { -1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use glam::camera::rh::proj::{directx, opengl};
    use glam::camera::rh::view::look_at_mat4;

    fn state(projection: Mat4, view: Mat4, depth: Depth) -> FrameState {
        let frame = Frame {
            viewport: [640, 480],
            view: view.to_cols_array(),
            projection: projection.to_cols_array(),
            depth,
            range: Default::default(),
        };
        FrameState::new(&frame, &Config::default()).expect("a finite far plane")
    }

    /// A quad around the origin that faces +z, seen by a camera on +z or on -z.
    #[test]
    fn the_side_of_su_cross_sv_is_the_front_under_every_kind_of_camera() {
        let flip_x = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let cameras = [
            (directx::perspective(1.0, 1.5, 1.0, 20.0), Depth::ZeroToOne),
            (opengl::perspective(1.0, 1.5, 1.0, 20.0), Depth::MinusOneToOne),
            (directx::perspective(1.0, 1.5, 20.0, 1.0), Depth::ZeroToOne), // reversed depth
            (directx::orthographic(-2.0, 2.0, -2.0, 2.0, 1.0, 20.0), Depth::ZeroToOne),
            (flip_x * directx::perspective(1.0, 1.5, 1.0, 20.0), Depth::ZeroToOne),
        ];
        for (projection, depth) in cameras {
            for (eye, front) in [(Vec3::Z * 5.0, 1), (-Vec3::Z * 5.0, -1)] {
                let view = look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
                let state = state(projection, view, depth);
                let m = (projection * view).as_dmat4();
                let [s, su, sv] = [DVec4::W, DVec4::X, DVec4::Y].map(|p| m * p);
                let det = DVec3::new(s.x, s.y, s.w)
                    .dot(DVec3::new(su.x, su.y, su.w).cross(DVec3::new(sv.x, sv.y, sv.w)));
                assert_eq!(det.signum() as i64 * state.view.facing, front, "{projection} {eye}");
            }
        }
    }

    #[test]
    fn the_range_is_the_far_plane_and_the_threshold_the_near_plane() {
        for (far, log2) in [(0.5, 0), (15.9, 4), (16.0, 5), (16.1, 5), (100.0, 7)] {
            let projection = directx::perspective(1.0, 1.0, 0.25, far);
            let view = state(projection, Mat4::IDENTITY, Depth::ZeroToOne).view;
            assert_eq!(view.position.fraction, 31 - log2, "far {far}");
            let near = view.near as f64 / f64::from(view.position.fraction).exp2();
            assert!((near - 0.25).abs() < 1e-4 && near < 0.25, "near {near}");
        }
        let frame = Frame {
            viewport: [640, 480],
            view: Mat4::IDENTITY.to_cols_array(),
            projection: directx::perspective_infinite(1.0, 1.0, 0.25).to_cols_array(),
            depth: Depth::ZeroToOne,
            range: Default::default(),
        };
        let error = FrameState::new(&frame, &Config::default()).expect_err("no range");
        assert!(error.to_string().contains("far plane is infinite"), "{error}");
    }
}
