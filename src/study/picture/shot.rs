//! A frame as a unit made it: a trace in, one shot out.

use super::piece::{Camera, Corner, Piece};
use super::{Style, Values};
use crate::config::{Config, Engine, Unit};
use crate::error::{Error, Result};
use crate::golden::Real;
use crate::gpu::render::{Facet, Lens};
use crate::output::space;
use crate::sink::{FrameInfo, PatchMesh, Sink};
use crate::study::walk::Walk;
use crate::trace::command::Command;
use crate::trace::open::Trace;
use crate::unit::{FrameState, simulate};
use glam::{DMat4, DVec4};
use rayon::prelude::*;
use rtl_model::patch::Depth;
use std::cell::RefCell;

/// A frame's triangles and surfaces, and where they are seen from.
#[derive(Clone, Debug)]
pub struct Shot {
    /// What the trace is called.
    pub title: String,
    /// The unit that made the triangles.
    pub unit: Unit,
    /// The frame's number from 0.
    pub frame: u64,
    camera: Camera,
    pieces: Vec<Piece>,
}

impl Shot {
    /// Runs a trace as far as frame `frame`; of the frames before, nothing is drawn.
    ///
    /// # Errors
    /// [`Error::Usage`] where the trace has no such frame; those of the trace and of [`simulate`].
    pub fn take(trace: &mut Trace, config: &Config, frame: u64) -> Result<Self> {
        let config = Config { engine: Engine::None, ..config.clone() };
        let mut eye = Eye { walk: Walk::new(&config), title: String::new(), frames: 0, frame };
        let truth = RefCell::new(Vec::new());
        let state = RefCell::new(None);
        let commands = trace.by_ref().map_while(|located| {
            let seen = located.and_then(|located| {
                let command = located.command;
                eye.see(&command, &mut truth.borrow_mut(), &mut state.borrow_mut(), &config)?;
                Ok(command)
            });
            match seen {
                Ok(Command::Frame(_)) if eye.frames > frame + 1 => None,
                Ok(Command::Draw(_)) if eye.frames != frame + 1 => Some(None),
                seen => Some(Some(seen)),
            }
        });
        let mut meshes = Meshes { frame, info: None, pieces: Vec::new() };
        simulate(commands.flatten(), &config, &mut meshes)?;
        let Some(state) = state.into_inner() else { return Err(missing(frame, eye.frames)) };
        let camera = camera(&state);
        let to_clip = config.unit.in_object_space().then(|| camera.to_world.inverse());
        let truth = truth.into_inner();
        let piece = |mesh: Mesh| mesh.piece(&truth, to_clip);
        let pieces = meshes.pieces.into_iter().map(piece).collect();
        Ok(Self { title: eye.title, unit: config.unit, frame, camera, pieces })
    }

    /// Width and height of the frame in pixels.
    #[must_use]
    pub fn viewport(&self) -> [u32; 2] {
        self.camera.viewport
    }

    /// Patches and triangles that the unit emitted.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        [self.pieces.len(), self.pieces.iter().map(|piece| piece.triangles.len()).sum()]
    }

    /// A value a triangle, patch after patch in draw order, of what a heat map shows: pixels are
    /// the frame's own. 0 for other pictures, and behind the eye.
    #[must_use]
    pub fn values(&self, style: Style) -> Vec<f64> {
        let values = self.pieces.par_iter().map(|piece| piece.values(style, &self.camera));
        values.collect::<Vec<_>>().concat()
    }

    /// What a legend says of [`Self::values`]: of areas that are there at all.
    #[must_use]
    pub fn measured(&self, style: Style) -> Values {
        let mut values = self.values(style);
        values.retain(|value| style != Style::Area || *value > 0.0);
        Values::of(&values)
    }

    /// The facets of a picture of `size` pixels.
    #[must_use]
    pub fn facets(&self, style: Style, size: [u32; 2]) -> Vec<Facet> {
        let lens = Lens::new(self.camera.viewport, size);
        let facets = self.pieces.par_iter().map(|piece| {
            let mut facets = Vec::new();
            piece.facets(style, &self.camera, &lens, &mut facets);
            facets
        });
        facets.collect::<Vec<_>>().concat()
    }
}

fn missing(frame: u64, frames: u64) -> Error {
    let numbered = match frames {
        0 => "the trace has none".to_owned(),
        1 => "the trace has frame 0 only".to_owned(),
        _ => format!("the trace has frames 0 to {}", frames - 1),
    };
    Error::Usage(format!("--frame {frame}: no such frame: {numbered}"))
}

fn camera(state: &FrameState) -> Camera {
    let symmetric = state.view.depth == Depth::MinusOneToOne;
    Camera::new(DMat4::from_cols_array(&state.to_world), state.view.viewport, symmetric)
}

/// Sees every command before the unit does.
struct Eye<'a> {
    walk: Walk<'a>,
    title: String,
    frames: u64,
    frame: u64,
}

impl Eye<'_> {
    fn see(
        &mut self,
        command: &Command,
        truth: &mut Vec<[Real; 16]>,
        state: &mut Option<FrameState>,
        config: &Config,
    ) -> Result<()> {
        match command {
            Command::Header(header) => self.title.clone_from(&header.title),
            Command::Frame(frame) => {
                self.frames += 1;
                if self.frames == self.frame + 1 {
                    *state = Some(FrameState::new(frame, config)?);
                }
            }
            Command::Draw(_) if self.frames != self.frame + 1 => return Ok(()),
            _ => {}
        }
        self.walk.command(command, &mut |_, drawn| truth.push(drawn.exact))
    }
}

/// A patch as the sink gets it.
struct Mesh {
    patch: usize,
    to_world: DMat4,
    piece: Piece,
}

impl Mesh {
    fn piece(self, truth: &[[Real; 16]], to_clip: Option<DMat4>) -> Piece {
        let mut piece = Piece { truth: truth[self.patch], ..self.piece };
        if let Some(to_clip) = to_clip {
            let matrix = to_clip * self.to_world;
            for vertex in &mut piece.vertices {
                vertex.clip = (matrix * DVec4::from(vertex.clip)).to_array();
            }
        }
        piece
    }
}

/// Keeps the meshes of the one frame.
struct Meshes {
    frame: u64,
    info: Option<FrameInfo>,
    pieces: Vec<Mesh>,
}

impl Sink for Meshes {
    fn wants(&self, frame: u64) -> bool {
        frame == self.frame
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.info = Some(*frame);
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let info = self.info.expect("a frame begins before its patches");
        let ulp = space::ulp(info.view.position);
        let vertices = mesh.vertices.iter().map(|vertex| Corner {
            clip: space::real(vertex.position, ulp),
            at: [vertex.u, vertex.v].map(|raw| space::parameter(raw, info.grid)),
        });
        let piece = Piece {
            truth: [[0.0; 4]; 16],
            reversed: mesh.reversed,
            vertices: vertices.collect(),
            triangles: mesh.triangles.to_vec(),
        };
        let to_world = DMat4::from_cols_array(mesh.to_world);
        self.pieces.push(Mesh { patch: mesh.patch as usize, to_world, piece });
        Ok(())
    }
}
