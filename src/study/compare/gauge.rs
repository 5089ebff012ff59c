//! Gauge: a unit's meshes in, what they look like on the screen out, frame by frame: classes of
//! triangles, pixels and quads, and how far the true surfaces are from them.
//!
//! A unit that does not divide leaves that to a vertex program and a clipper: here its vertices are
//! projected in f64 and put on the same sub-pixel grid, to the nearest.

use crate::config::Config;
use crate::error::Result;
use crate::golden::{Real, emit};
use crate::output::space;
use crate::sink::{FrameInfo, PatchMesh, Sink};
use crate::study::distance::{self, Deviation, Mesh, Place, Samples};
use crate::study::raster::{self, Cover, Target, Triangles};
use crate::study::walk::Walk;
use crate::trace::command::Command;
use crate::unit::FrameState;
use glam::{DMat4, DVec4};
use rayon::prelude::*;
use rtl_model::emit::Screen;
use rtl_model::patch::{Triangle, Vertex};
use std::cell::RefCell;
use std::collections::VecDeque;

/// What a frame's triangles look like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Classes of triangles, samples and quads.
    pub triangles: Triangles,
    /// Pixels that some triangle covers.
    pub pixels: u64,
    /// How far the surfaces of tessellated patches are from their triangles; without samples where
    /// none were asked for.
    pub deviation: Deviation,
}

impl Seen {
    /// With another frame.
    #[must_use]
    pub fn with(self, other: &Self) -> Self {
        Self {
            triangles: self.triangles.with(&other.triangles),
            pixels: self.pixels + other.pixels,
            deviation: self.deviation.with(&other.deviation),
        }
    }
}

/// Patches that are gathered before they are measured side by side.
const BATCH: usize = 1024;

/// A frame as the trace has it.
struct Scene {
    to_world: DMat4,
    /// Control points of its patches in clip space, where errors are wanted.
    truth: Vec<[Real; 16]>,
}

/// What the commands have said of frames that have not been measured yet.
pub(super) struct Scenes<'a> {
    config: &'a Config,
    walk: Option<Walk<'a>>,
    /// The number of the first that is kept.
    first: u64,
    frames: VecDeque<Scene>,
}

impl<'a> Scenes<'a> {
    /// Before the first command; with the surfaces themselves if errors are wanted.
    pub(super) fn new(config: &'a Config, surfaces: bool) -> Self {
        let walk = surfaces.then(|| Walk::new(config));
        Self { config, walk, first: 0, frames: VecDeque::new() }
    }

    /// Takes in the next command.
    ///
    /// # Errors
    /// Those of [`FrameState::new`], and points that cannot be read.
    pub(super) fn command(&mut self, command: &Command) -> Result<()> {
        if let Command::Frame(frame) = command {
            let state = FrameState::new(frame, self.config)?;
            let to_world = DMat4::from_cols_array(&state.to_world);
            self.frames.push_back(Scene { to_world, truth: Vec::new() });
        }
        let Some(walk) = &mut self.walk else { return Ok(()) };
        let frames = &mut self.frames;
        walk.command(command, &mut |_, drawn| {
            let frame = frames.back_mut().expect("a draw is in a frame");
            frame.truth.push(drawn.exact);
        })
    }

    fn frame(&self, number: u64) -> &Scene {
        let kept = number.checked_sub(self.first).and_then(|k| self.frames.get(k as usize));
        kept.expect("a frame is commanded before its meshes come, and kept until they have")
    }

    /// Forgets a frame, and those before it.
    fn forget(&mut self, number: u64) {
        while self.first <= number && self.frames.pop_front().is_some() {
            self.first += 1;
        }
    }
}

/// The sink that measures.
pub(super) struct Gauge<'a> {
    config: &'a Config,
    scenes: &'a RefCell<Scenes<'a>>,
    /// Samples of a patch along each direction; 0: none.
    samples: u32,
    open: Option<Open>,
    frames: Vec<Seen>,
}

/// The frame whose patches arrive.
struct Open {
    info: FrameInfo,
    cover: Cover,
    batch: Vec<Piece>,
    seen: Seen,
}

/// A patch's mesh, kept until its batch is full.
struct Piece {
    patch: u32,
    reversed: bool,
    vertices: Vec<Vertex>,
    screen: Vec<Screen>,
    triangles: Vec<Triangle>,
    /// From the mesh's space to the world, which is that of all patches but in a unit that works in
    /// object space.
    to_world: DMat4,
}

impl<'a> Gauge<'a> {
    pub(super) fn new(config: &'a Config, scenes: &'a RefCell<Scenes<'a>>, samples: u32) -> Self {
        Self { config, scenes, samples, open: None, frames: Vec::new() }
    }

    /// What was seen, frame by frame.
    pub(super) fn finish(mut self) -> Vec<Seen> {
        self.close();
        self.frames
    }

    fn close(&mut self) {
        self.measure();
        if let Some(open) = self.open.take() {
            let pixels = open.cover.pixels();
            self.frames.push(Seen { pixels, ..open.seen });
            self.scenes.borrow_mut().forget(open.info.number);
        }
    }

    /// Measures the patches of the batch.
    fn measure(&mut self) {
        let Some(open) = &mut self.open else { return };
        let batch = std::mem::take(&mut open.batch);
        let scenes = self.scenes.borrow();
        let scene = scenes.frame(open.info.number);
        let lens = Lens::new(open, scene, self.config, self.samples);
        let each: Vec<_> = batch.into_par_iter().map(|piece| lens.measure(&piece)).collect();
        // In the order of the patches: sums of f64 are the same at any number of threads.
        let seen = each.iter().fold(open.seen, |seen, (triangles, deviation)| Seen {
            triangles: seen.triangles.with(triangles),
            deviation: seen.deviation.with(deviation),
            ..seen
        });
        open.seen = seen;
    }
}

impl Sink for Gauge<'_> {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, info: &FrameInfo) -> Result<()> {
        self.close();
        let cover = Cover::new(info.view.viewport);
        self.open = Some(Open { info: *info, cover, batch: Vec::new(), seen: Seen::default() });
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let open = self.open.as_mut().expect("a frame begins before its patches");
        open.batch.push(Piece {
            patch: mesh.patch,
            reversed: mesh.reversed,
            vertices: mesh.vertices.to_vec(),
            screen: mesh.screen.to_vec(),
            triangles: mesh.triangles.to_vec(),
            to_world: DMat4::from_cols_array(mesh.to_world),
        });
        if open.batch.len() == BATCH {
            self.measure();
        }
        Ok(())
    }
}

/// What all patches of a frame are measured with.
struct Lens<'a> {
    frame: &'a Open,
    scene: &'a Scene,
    subpixel_bits: u32,
    samples: u32,
    /// Units that work in object space: from the world to clip space.
    to_clip: Option<DMat4>,
    ulp: f64,
}

impl<'a> Lens<'a> {
    fn new(frame: &'a Open, scene: &'a Scene, config: &Config, samples: u32) -> Self {
        let to_clip = config.unit.in_object_space().then(|| scene.to_world.inverse());
        let ulp = space::ulp(frame.info.view.position);
        Self { frame, scene, subpixel_bits: config.emit.subpixel_bits, samples, to_clip, ulp }
    }

    fn measure(&self, piece: &Piece) -> (Triangles, Deviation) {
        let clip = || piece.vertices.iter().map(|vertex| self.clip(piece, vertex));
        let projected: Vec<Screen>;
        let screen = if piece.screen.is_empty() {
            projected = clip().map(|point| self.project(point)).collect();
            &projected
        } else {
            &piece.screen
        };
        let triangles = self.triangles(piece, screen);
        let deviation = if self.samples == 0 || piece.triangles.is_empty() {
            Deviation::default()
        } else {
            let mesh = Mesh { vertices: clip().collect(), triangles: piece.triangles.clone() };
            let viewport = self.frame.info.view.viewport;
            let to_world = self.scene.to_world;
            let samples = Samples::Middles(self.samples);
            let place = Place { to_world, viewport, samples };
            distance::patch(&self.scene.truth[piece.patch as usize], &mesh, &place)
        };
        (triangles, deviation)
    }

    fn triangles(&self, piece: &Piece, screen: &[Screen]) -> Triangles {
        let info = &self.frame.info;
        let target = Target {
            viewport: info.view.viewport,
            subpixel_bits: self.subpixel_bits,
            front_is_counter_clockwise: (info.eye.facing > 0) != piece.reversed,
        };
        let mut triangles = Triangles::default();
        for triangle in &piece.triangles {
            let corners = triangle.map(|vertex| screen[usize::from(vertex)]);
            raster::triangle(&target, corners, &self.frame.cover, &mut triangles);
        }
        triangles
    }

    /// A vertex in clip space.
    fn clip(&self, piece: &Piece, vertex: &Vertex) -> Real {
        let point = space::real(vertex.position, self.ulp);
        let Some(to_clip) = self.to_clip else { return point };
        (to_clip * (piece.to_world * DVec4::from(point))).to_array()
    }

    /// Where the divide of a vertex program's output would put it.
    fn project(&self, point: Real) -> Screen {
        let Some(pixels) = emit::screen(point, self.frame.info.view.viewport) else {
            return Screen::default();
        };
        let raw = pixels.map(|p| (p * f64::from(1_u32 << self.subpixel_bits)).round());
        let band = emit::BAND * f64::from(1_u32 << self.subpixel_bits);
        if raw.iter().all(|r| (-band..band).contains(r)) {
            Screen { x: raw[0] as i32, y: raw[1] as i32, divided: true }
        } else {
            Screen::default()
        }
    }
}
