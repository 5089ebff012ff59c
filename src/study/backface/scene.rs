//! What is looked at, and from where.

use super::Options;
use crate::error::Result;
use crate::study::random::Random;
use crate::trace::command::Frame;
use crate::trace::scene::camera::Camera;
use crate::trace::scene::newell::Newell;
use glam::DVec3;
use std::ops::Range;

/// Nearest and farthest viewer outside, in radii of what he looks at.
const NEAREST: f64 = 1.5;
const FARTHEST: f64 = 8.0;

/// How far, per axis, points of random patches are off a unit square's regular net. Not at all, for
/// flat ones, to farther than the net is wide, for some that fold over.
const BULGES: [f64; 4] = [0.0, 0.02, 0.3, 1.0];

/// Patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// One of Newell's models.
    Model(Newell),
    /// Random patches over a square, every fourth with weights from 1/4 to 1.
    Random,
}

impl Source {
    /// All that the study looks at.
    pub const ALL: [Self; 4] = [
        Self::Model(Newell::Teapot),
        Self::Model(Newell::Teacup),
        Self::Model(Newell::Teaspoon),
        Self::Random,
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Model(Newell::Teapot) => "teapot",
            Self::Model(Newell::Teapot28) => "teapot_28",
            Self::Model(Newell::Teacup) => "teacup",
            Self::Model(Newell::Teaspoon) => "teaspoon",
            Self::Random => "random",
        }
    }
}

/// Where a viewer stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Outside the sphere round everything, so outside every hull.
    Outside,
    /// At the mean of a patch's control points, so within its hull.
    Within,
}

impl Place {
    pub(super) const ALL: [Self; 2] = [Self::Outside, Self::Within];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Outside => "outside",
            Self::Within => "within",
        }
    }
}

/// A patch under a view.
pub(super) struct Seen<'a> {
    pub(super) frame: &'a Frame,
    /// x, y, z, w in world space.
    pub(super) points: [[f32; 4]; 16],
    pub(super) reversed: bool,
}

type Visit<'a> = &'a mut dyn FnMut(Seen<'_>) -> Result<()>;

impl Source {
    /// Numbers of the cases: views, or patches that each have their own.
    pub(super) fn cases(self, place: Place, options: Options) -> Range<usize> {
        match (self, place) {
            (Self::Random, _) => 0..options.random,
            (Self::Model(_), Place::Outside) => 0..options.views,
            (Self::Model(model), Place::Within) => 0..model.points().len() / 16,
        }
    }

    /// Shows the patches of a case.
    pub(super) fn see(self, place: Place, case: usize, visit: Visit<'_>) -> Result<()> {
        let part = 2 * Self::ALL.iter().position(|s| *s == self).unwrap_or(Self::ALL.len()) as u32;
        let mut random = Random::of(part + u32::from(place == Place::Within), case);
        match self {
            Self::Model(model) => {
                let points = model.points();
                let patches: Vec<_> = points.chunks_exact(16).map(whole).collect();
                let seen = match place {
                    Place::Outside => &patches[..],
                    Place::Within => &patches[case..=case],
                };
                let frame = camera(seen, place, &mut random).frame();
                let reversed = model.faces_inward();
                seen.iter().try_for_each(|&points| visit(Seen { frame: &frame, points, reversed }))
            }
            Self::Random => {
                let points = patch(&mut random);
                let reversed = random.one_of([false, true]);
                let frame = camera(&[points], place, &mut random).frame();
                visit(Seen { frame: &frame, points, reversed })
            }
        }
    }
}

fn whole(points: &[[f32; 3]]) -> [[f32; 4]; 16] {
    std::array::from_fn(|k| [points[k][0], points[k][1], points[k][2], 1.0])
}

fn patch(random: &mut Random) -> [[f32; 4]; 16] {
    let bulge = random.one_of(BULGES);
    let rational = random.one_of([false, false, false, true]);
    std::array::from_fn(|k| {
        let net = DVec3::new((k % 4) as f64 / 3.0, (k / 4) as f64 / 3.0, 0.0);
        let off = DVec3::from([(); 3].map(|()| random.real(-bulge, bulge)));
        let weight = if rational { random.real(0.25, 1.0) } else { 1.0 };
        let DVec3 { x, y, z } = weight * (net + off);
        [x, y, z, weight].map(|c| c as f32)
    })
}

fn camera(patches: &[[[f32; 4]; 16]], place: Place, random: &mut Random) -> Camera {
    let euclidean =
        |&[x, y, z, w]: &[f32; 4]| DVec3::new(x.into(), y.into(), z.into()) / f64::from(w);
    let points: Vec<DVec3> = patches.iter().flatten().map(euclidean).collect();
    let centre = match place {
        Place::Outside => {
            let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            (low + high) / 2.0
        }
        Place::Within => points.iter().sum::<DVec3>() / points.len() as f64,
    };
    let radius = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let direction = random.direction();
    let (eye, near, far) = match place {
        Place::Outside => {
            let distance = radius * random.real(NEAREST, FARTHEST);
            (centre + direction * distance, (distance - radius) / 2.0, distance + 2.0 * radius)
        }
        // Far enough for the range of positions, which follows from it, to hold all points.
        Place::Within => (centre, radius / 16.0, 8.0 * radius),
    };
    Camera::at(eye.to_array(), (eye - direction).to_array(), near, far)
}
