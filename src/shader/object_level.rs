//! Object level: the control points of a draw in object space in, one level of resolution for the
//! whole draw out. The driver does this, before anything is sent.
//!
//! Concheiro et al. 2014, section 2.2: "the level of resolution of each object depends on the
//! camera position". What the driver looks at is the axis-aligned box of the points: eight corners
//! are transformed, however many patches there are. A rational point is divided first, for the
//! surface lies in the hull of the divided points while weights are positive. The box is larger
//! than the object, so the level is at least what the object itself would ask for.
//!
//! With N = `level_max` + 1 segments of a coarse edge at full detail, L + 1 = ceil(N full / w) for
//! the smallest w of the corners, or ceil(N side / pixels) for the larger side of the corners' box
//! on the screen; at least 1 and at most N, formed as the hardware forms them, by comparisons.
//! Operations are f32, in this order, none fused. A corner without projection, or beyond what f32
//! holds, asks for full detail.

use super::control_point::transform;
use glam::{Mat4, Vec2, Vec3, Vec4, Vec4Swizzles};

/// The axis-aligned box of points, at first empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    least: Vec3,
    most: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { least: Vec3::INFINITY, most: Vec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// The box with one more point in it, `[x w, y w, z w, w]` in object space with positive w.
    pub fn include(&mut self, point: [f32; 4]) {
        let point = Vec4::from_array(point);
        let divided = point.xyz() / point.w;
        self.least = self.least.min(divided);
        self.most = self.most.max(divided);
    }

    /// Whether no point is in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.least.x > self.most.x
    }

    /// The corners, x the fastest: corner k has the greater x, y, z where bit 0, 1, 2 of k is set.
    #[must_use]
    pub fn corners(&self) -> [[f32; 3]; 8] {
        std::array::from_fn(|k| {
            let side = |axis: usize| [self.least, self.most][k >> axis & 1][axis];
            [side(0), side(1), side(2)]
        })
    }
}

/// How the level follows from the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Policy {
    /// Full detail up to a distance from the eye plane, and inversely proportional beyond.
    Distance {
        /// The greatest w at full detail, at least 0.
        full: f32,
    },
    /// In proportion to the size on the screen.
    ScreenSize {
        /// The least size at full detail, above 0 pixels.
        pixels: f32,
    },
}

/// What the driver knows besides the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the level follows from the box.
    pub policy: Policy,
    /// The greatest level, which is full detail.
    pub level_max: u8,
    /// Width and height in pixels.
    pub viewport: [u32; 2],
    /// A corner whose w is below this, or not above 0, has no projection.
    pub near: f32,
}

/// The level of a draw with these bounds; 0 where they are empty.
///
/// # Panics
/// When the policy's distance or size is out of its range.
#[must_use]
pub fn level(bounds: &Bounds, clip_from_object: &Mat4, settings: &Settings) -> u8 {
    if bounds.is_empty() {
        return 0;
    }
    let corners =
        bounds.corners().map(|[x, y, z]| Vec4::from(transform(clip_from_object, [x, y, z, 1.0])));
    let projected = |p: &Vec4| p.w >= settings.near && p.w > 0.0 && p.is_finite();
    if !corners.iter().all(projected) {
        return settings.level_max;
    }
    let segments = f32::from(settings.level_max + 1);
    let (all, unit) = match settings.policy {
        Policy::Distance { full } => {
            assert!(full >= 0.0, "a distance of {full} is below 0");
            let nearest = corners.map(|p| p.w).into_iter().fold(f32::INFINITY, f32::min);
            (segments * full, nearest)
        }
        Policy::ScreenSize { pixels } => {
            assert!(pixels > 0.0, "a size of {pixels} pixels is not above 0");
            (segments * side(&corners, settings.viewport), pixels)
        }
    };
    (1..=settings.level_max).filter(|&k| f32::from(k) * unit < all).count() as u8
}

/// The larger side of the box of the projected corners, in pixels.
fn side(corners: &[Vec4; 8], viewport: [u32; 2]) -> f32 {
    let half = Vec2::from(viewport.map(|side| side as f32 / 2.0));
    let projected = corners.map(|p| p.xy() / p.w * half);
    let least = projected.into_iter().fold(Vec2::INFINITY, Vec2::min);
    let most = projected.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max);
    let sides = most - least;
    // Infinite ones of one sign differ by no number.
    if sides.is_finite() { sides.max_element() } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(points: &[[f32; 4]]) -> Bounds {
        let mut bounds = Bounds::default();
        points.iter().for_each(|&p| bounds.include(p));
        bounds
    }

    /// Looks along -z from the origin: w = -z, a half right angle to either side.
    fn projection() -> Mat4 {
        Mat4::from_cols_array(&[
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0, -0.5, 0.0,
        ])
    }

    fn settings(policy: Policy) -> Settings {
        Settings { policy, level_max: 3, viewport: [200, 100], near: 0.5 }
    }

    #[test]
    fn bounds_are_those_of_the_divided_points() {
        let bounds = bounds(&[[2.0, 4.0, 6.0, 2.0], [0.0, 3.0, -1.0, 1.0], [2.0, -8.0, 0.0, 4.0]]);
        assert_eq!(bounds.corners()[0], [0.0, -2.0, -1.0]);
        assert_eq!(bounds.corners()[5], [1.0, -2.0, 3.0]);
        assert_eq!(bounds.corners()[7], [1.0, 3.0, 3.0]);
    }

    #[test]
    fn distance_is_the_nearest_corner_s() {
        // ceil(4 10 / w) segments.
        for (w, level) in [(0.5, 3), (10.0, 3), (13.25, 3), (13.5, 2), (20.0, 1), (40.0, 0)] {
            let bounds = bounds(&[[-1.0, 1.0, -w, 1.0], [1.0, 3.0, -w - 50.0, 1.0]]);
            let settings = settings(Policy::Distance { full: 10.0 });
            assert_eq!(super::level(&bounds, &projection(), &settings), level, "{w}");
        }
    }

    #[test]
    fn screen_size_is_the_larger_side_of_the_corners_box() {
        // At w = 8, 4 wide and 2 high: 50 pixels by 12.5; the far corners are inside.
        let wide = bounds(&[[0.0, 0.0, -8.0, 1.0], [4.0, 2.0, -20.0, 1.0]]);
        // 1 wide and 6 high, about the axis: 12.5 by 37.5.
        let high = bounds(&[[-0.5, -3.0, -8.0, 1.0], [0.5, 3.0, -8.0, 1.0]]);
        let level =
            |bounds, pixels| level(bounds, &projection(), &settings(Policy::ScreenSize { pixels }));
        let levels = [25.0, 50.0, 66.0, 67.0, 100.0, 199.0, 200.0].map(|p| level(&wide, p));
        assert_eq!(levels, [3, 3, 3, 2, 1, 1, 0]);
        assert_eq!([37.5, 49.0, 51.0, 75.0, 150.0].map(|p| level(&high, p)), [3, 3, 2, 1, 0]);
    }

    #[test]
    fn what_is_too_near_or_too_large_has_full_detail_and_nothing_has_none() {
        let far = Policy::Distance { full: 0.0 };
        let level =
            |bounds: &Bounds, matrix: &Mat4, policy| level(bounds, matrix, &settings(policy));
        let near = bounds(&[[0.0, 0.0, -0.25, 1.0], [1.0, 1.0, -9.0, 1.0]]);
        assert_eq!(level(&near, &projection(), far), 3);
        let behind = bounds(&[[0.0, 0.0, 1.0, 1.0], [1.0, 1.0, -9.0, 1.0]]);
        assert_eq!(level(&behind, &projection(), far), 3);
        let whole = bounds(&[[0.0, 0.0, -1.0, 1.0], [1.0, 1.0, -9.0, 1.0]]);
        assert_eq!(level(&whole, &projection(), far), 0);
        let beyond = Mat4::from_scale(Vec3::new(f32::MAX, 1.0, 1.0)) * 4.0;
        assert_eq!(level(&whole, &(projection() * beyond), far), 3, "x is infinite");
        // Finite in clip space, and infinite on the screen, all on one side.
        let wide = bounds(&[[1e38, 0.0, -0.5, 1.0], [2e38, 1.0, -0.5, 1.0]]);
        let size = Policy::ScreenSize { pixels: 1e30 };
        assert_eq!(level(&wide, &projection(), size), 3, "the side is infinite");
        assert_eq!(level(&Bounds::default(), &projection(), far), 0);
    }
}
