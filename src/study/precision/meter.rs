//! Meter: the meshes of a run in, how far they are from f64 out.
//!
//! Positions are those that leave emit, divided and snapped; a vertex that was not divided has no
//! place on the screen and is counted, not measured. Distances of the true surface from the
//! triangles are taken as study `esc error` takes them, from the snapped positions put back at
//! their depth.

use super::reference::{Keys, Reference, Scene, Truth, bits, segments};
use super::seam::{self, Strand};
use crate::config::{Config, Unit};
use crate::error::Result;
use crate::golden::{Real, emit, evaluate, place};
use crate::output::space;
use crate::sink::{Arrived, FrameInfo, PatchMesh, Sink};
use crate::study::distance::{self, Deviation, Mesh, Place, Samples};
use glam::DMat4;
use rtl_model::level;
use rtl_model::patch::{ONE, View};

/// Twice the area of a triangle, in square pixels, up to which f64 does not say which way it is
/// turned round.
const AREA_MIN: f64 = 1e-6;

/// Distances in pixels between positions and where they should be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PositionError {
    /// The largest.
    pub largest: f64,
    squares: f64,
    count: u64,
}

impl PositionError {
    /// The root of the mean square; 0 of none.
    #[must_use]
    pub fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    /// With another distance.
    pub(super) fn take(&mut self, distance: f64) {
        self.largest = self.largest.max(distance);
        self.squares += distance * distance;
        self.count += 1;
    }

    /// How many distances there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }
}

/// What was measured of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Against the true surface at the parameters that the unit reports.
    pub reported: PositionError,
    /// Against the true surface at the exact parameters of the unit's own lists.
    pub exact: PositionError,
    /// Vertices that f64 puts on the screen and the unit does not divide.
    pub unplaced: u64,
    /// How far the true surface is from the triangles.
    pub surface: Deviation,
    /// Vertices compared along edges that patches share.
    pub boundary: u64,
    /// Of these, those that are not at the same place on both sides.
    pub cracks: u64,
    /// Triangles.
    pub triangles: u64,
    /// Of these, those that are turned the other way round than in f64.
    pub flipped: u64,
    /// Of these, those without area on the screen that have one in f64.
    pub flat: u64,
    /// Of these, those of which two corners have the same clip position.
    pub equal_corners: u64,
    /// Patches drawn.
    pub patches: u64,
    /// Of these, those that the unit removes and f64 does not.
    pub lost: u64,
    /// Of these, those that f64 removes and the unit does not.
    pub kept: u64,
    /// Lists of parameters compared, six a patch at most.
    pub lists: u64,
    /// Of these, those that are not f64's.
    pub lists_differing: u64,
    /// Control points of which a coordinate did not fit.
    pub saturated: u64,
    /// Coordinates of evaluated points that did not fit.
    pub evaluate_overflows: u64,
    /// Projections of control points that did not fit.
    pub level_overflows: u64,
    /// Vertices that were not divided.
    pub to_clipper: u64,
}

impl Measured {
    /// The largest position error of either kind, in pixels.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.reported.largest.max(self.exact.largest)
    }

    /// Whether formats serve that come to this: something is drawn, nothing is lost, no vertex is
    /// without its place or farther from it than so many pixels, and there are no cracks.
    #[must_use]
    pub fn serves(&self, max_error: f64) -> bool {
        self.reported.count > 0 && self.may_serve(max_error)
    }

    /// Whether nothing that was measured speaks against them.
    pub(super) fn may_serve(&self, max_error: f64) -> bool {
        self.lost == 0 && self.unplaced == 0 && self.cracks == 0 && self.largest() <= max_error
    }
}

/// The sink of a run.
pub(super) struct Meter<'a> {
    config: &'a Config,
    reference: &'a Reference,
    segments: u32,
    frame: Option<FrameInfo>,
    /// The patch that arrived last.
    arrived: Option<Arrived>,
    /// The edges of the frame's patches; `None` of those that were removed.
    strands: Vec<Option<[Strand; 4]>>,
    measured: Measured,
}

impl<'a> Meter<'a> {
    pub(super) fn new(config: &'a Config, reference: &'a Reference, segments: u32) -> Self {
        Self {
            config,
            reference,
            segments,
            frame: None,
            arrived: None,
            strands: Vec::new(),
            measured: Measured::default(),
        }
    }

    /// What was measured.
    pub(super) fn finish(mut self) -> Measured {
        self.settle();
        self.measured
    }

    fn scene(&self) -> Option<&'a Scene> {
        Some(&self.reference.frames[self.frame?.number as usize])
    }

    /// What can be said at the end of a frame only.
    fn settle(&mut self) {
        let Some(scene) = self.scene() else { return };
        let (strands, measured) = (&mut self.strands, &mut self.measured);
        measured.patches += scene.patches.len() as u64;
        strands.resize(scene.patches.len(), None);
        for (truth, strand) in scene.patches.iter().zip(strands.iter()) {
            measured.lost += u64::from(truth.kept && strand.is_none());
            measured.kept += u64::from(!truth.kept && strand.is_some());
        }
        for seam in &scene.seams {
            let [a, b] = [0, 1]
                .map(|k| strands[seam.patches[k]].as_ref().map(|strands| &strands[seam.edges[k]]));
            if let (Some(a), Some(b)) = (a, b) {
                let [compared, cracks] = seam::compare(a, b, seam.reversed);
                measured.boundary += compared;
                measured.cracks += cracks;
            }
        }
        strands.clear();
    }

    /// Where the vertices were to be, u and v, and the lists that say so; nothing where they report
    /// it exactly.
    fn lists(&self, view: &View) -> (Vec<[f64; 2]>, Keys) {
        let arrived = self.arrived.as_ref().expect("a patch arrives before its mesh");
        let (patch, state) = (&arrived.patch, &arrived.state);
        if self.config.unit == Unit::Sfarti {
            let termination = self.config.level.termination;
            return (Vec::new(), bits(&level::subdivide(patch, view, state, termination).0));
        }
        let (levels, _) = level::accept(patch, view, state);
        let placed = place::place(&levels, self.config.place.reciprocal_bits);
        let sites = placed.sites();
        let exact = sites.iter().map(|site| [site.u, site.v].map(|t| t.parameter.real()));
        (exact.collect(), segments(&placed))
    }

    fn positions(&mut self, mesh: &PatchMesh<'_>, truth: &Truth, at: &At<'_>) {
        for (k, screen) in mesh.screen.iter().enumerate() {
            let got = [screen.x, screen.y].map(|c| f64::from(c) * at.unit);
            let Some(want) = at.reported[k] else {
                // At the band's ends either may be right.
                let well_inside = got.iter().all(|c| c.abs() < 0.5 * emit::BAND);
                self.measured.unplaced += u64::from(screen.divided && well_inside);
                continue;
            };
            if !screen.divided {
                self.measured.unplaced += 1;
                continue;
            }
            let off = |want: [f64; 2]| (got[0] - want[0]).hypot(got[1] - want[1]);
            self.measured.reported.take(off(want));
            let exact = at.exact.get(k).map(|&[u, v]| at.pixel(truth, u, v));
            // Without a place, behind the eye or out of the band, there is nothing to be off.
            if let Some(exact) = exact.unwrap_or(Some(want)) {
                self.measured.exact.take(off(exact));
            }
        }
    }

    fn triangles(&mut self, mesh: &PatchMesh<'_>, at: &At<'_>) {
        for triangle in mesh.triangles {
            let corners = triangle.map(usize::from);
            let screen = corners.map(|k| mesh.screen[k]);
            let [Some(a), Some(b), Some(c)] = corners.map(|k| at.reported[k]) else { continue };
            let want = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            if screen.iter().any(|s| !s.divided) || want.abs() <= AREA_MIN {
                continue;
            }
            let [a, b, c] = screen.map(|s| [i64::from(s.x), i64::from(s.y)]);
            let got = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            self.measured.flat += u64::from(got == 0);
            self.measured.flipped += u64::from(got != 0 && (got > 0) != (want > 0.0));
        }
    }

    /// The distance of the surface from the triangles as they are on the screen.
    fn surface(&mut self, mesh: &PatchMesh<'_>, truth: &Truth, at: &At<'_>) {
        let ulp = space::ulp(at.view.position);
        let [width, height] = at.view.viewport.map(f64::from);
        let vertices = mesh.vertices.iter().zip(mesh.screen).map(|(vertex, screen)| {
            let [x, y, z, w] = space::real(vertex.position, ulp);
            if !screen.divided {
                return [x, y, z, w];
            }
            let [px, py] = [screen.x, screen.y].map(|c| f64::from(c) * at.unit);
            [(2.0 * px / width - 1.0) * w, (1.0 - 2.0 * py / height) * w, z, w]
        });
        let made = Mesh { vertices: vertices.collect(), triangles: mesh.triangles.to_vec() };
        let to_world = DMat4::from_cols_array(mesh.to_world);
        let viewport = at.view.viewport;
        let samples = Samples::Ends(self.segments);
        let place = Place { to_world, viewport, samples };
        let deviation = distance::patch(&truth.points, &made, &place);
        self.measured.surface = self.measured.surface.with(&deviation);
    }
}

/// Where the vertices of a patch are to be.
struct At<'a> {
    view: &'a View,
    /// Pixels a unit of a screen coordinate.
    unit: f64,
    /// In pixels, at the reported parameters.
    reported: Vec<Option<[f64; 2]>>,
    /// Exact parameters, where they are others.
    exact: Vec<[f64; 2]>,
}

impl At<'_> {
    fn pixel(&self, truth: &Truth, u: f64, v: f64) -> Option<[f64; 2]> {
        pixel(evaluate::surface(&truth.points, u, v), self.view)
    }
}

/// A place on the screen; `None` behind the eye, or outside of what emit's format holds.
fn pixel(point: Real, view: &View) -> Option<[f64; 2]> {
    let inside = |c: &f64| c.abs() < emit::BAND - 1.0;
    emit::screen(point, view.viewport).filter(|pixel| pixel.iter().all(inside))
}

impl Sink for Meter<'_> {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.settle();
        self.frame = Some(*frame);
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let frame = self.frame.expect("patches belong to a frame");
        let scene = self.scene().expect("patches belong to a frame");
        let (view, number) = (&frame.view, mesh.patch as usize);
        let truth = &scene.patches[number];
        let (exact, keys) = self.lists(view);
        let real = |t: u32| f64::from(t) / f64::from(ONE);
        let surface = |u, v| pixel(evaluate::surface(&truth.points, u, v), view);
        let reported = mesh.vertices.iter().map(|v| surface(real(v.u), real(v.v))).collect();
        let unit = (-f64::from(self.config.emit.subpixel_bits)).exp2();
        let at = At { view, unit, reported, exact };
        self.positions(mesh, truth, &at);
        self.triangles(mesh, &at);
        if self.segments > 0 {
            self.surface(mesh, truth, &at);
        }
        let compared = truth.lists.iter().zip(keys).filter(|(want, _)| want.is_some());
        for (want, got) in compared {
            self.measured.lists += 1;
            self.measured.lists_differing += u64::from(*want != got);
        }
        self.measured.triangles += mesh.triangles.len() as u64;
        self.strands.resize(number, None);
        self.strands.push(Some(seam::strands(mesh.vertices, mesh.screen)));
        Ok(())
    }

    fn taps(&self) -> bool {
        true
    }

    fn arrived(&mut self, patch: &Arrived) -> Result<()> {
        self.arrived = Some(patch.clone());
        Ok(())
    }
}
