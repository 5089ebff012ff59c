//! Walk: the commands of a trace in, every patch that they draw out, as the unit gets it: its own
//! frame state, control-point shader and port; and beside it the same patch in real numbers.
//!
//! Patches are assembled here from the definition of each primitive, point by point, without the
//! batches and caches of a run. Clip space only: of `moreton`, which works in object space, a walk
//! says nothing.

use crate::config::Config;
use crate::error::Result;
use crate::golden::{Real, control_point};
use crate::shader::control_point as shader;
use crate::trace::command::{Command, Draw, Points, Tessellation};
use crate::unit::FrameState;
use glam::Mat4;
use rtl_model::level::State;
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::patch::Patch;
use rtl_model::port;
use std::collections::HashMap;

/// A patch of a trace.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its control points behind the port; numbered over the frame.
    pub patch: Patch,
    /// Its frame.
    pub frame: FrameState,
    /// Its draw's tessellation state, the configuration's overrides not included.
    pub state: State,
    /// Control points in object space.
    pub object: [Real; 16],
    /// Object to clip space as the shader has it, column-major.
    pub matrix: [f32; 16],
    /// Control points in clip space as the shader made them.
    pub shaded: [[f32; 4]; 16],
    /// Control points in clip space, f64 from the trace's numbers on.
    pub exact: [Real; 16],
}

/// What the commands so far have left behind.
#[derive(Clone, Debug)]
pub struct Walk<'a> {
    config: &'a Config,
    points: HashMap<u32, Points>,
    tessellation: Tessellation,
    /// The frame, and its world to clip space in f64.
    camera: Option<(FrameState, [f64; 16])>,
    /// Patches of the frame so far.
    patches: u32,
}

impl<'a> Walk<'a> {
    /// Before the first command.
    #[must_use]
    pub fn new(config: &'a Config) -> Self {
        let tessellation = Tessellation::default();
        Self { config, points: HashMap::new(), tessellation, camera: None, patches: 0 }
    }

    /// Takes the next command, and shows the patches that it draws.
    ///
    /// # Errors
    /// A frame whose far plane is infinite needs a range; points that cannot be read.
    ///
    /// # Panics
    /// When commands break what a reader of traces guarantees.
    pub fn command(&mut self, command: &Command, each: &mut dyn FnMut(&Draw, Drawn)) -> Result<()> {
        match command {
            Command::Points(p) => drop(self.points.insert(p.id, p.clone())),
            Command::Tessellation(t) => self.tessellation = *t,
            Command::Frame(f) => {
                let frame = FrameState::new(f, self.config)?;
                let [projection, view] = [f.projection, f.view].map(|m| m.map(f64::from));
                self.camera = Some((frame, control_point::concatenate(&projection, &view)));
                self.patches = 0;
            }
            Command::Draw(draw) => self.draw(draw, each)?,
            Command::Header(_) | Command::Attributes(_) | Command::End => {}
        }
        Ok(())
    }

    fn draw(&mut self, draw: &Draw, each: &mut dyn FnMut(&Draw, Drawn)) -> Result<()> {
        let (frame, camera) = self.camera.expect("the reader refuses a draw before any frame");
        let source = &self.points.get(&draw.points).expect("the reader refuses unknown ids").source;
        let state = self.tessellation.state();
        let mut own = Vec::new();
        for model in &draw.models {
            let matrix = shader::concatenate(&frame.clip_from_world, &Mat4::from_cols_array(model));
            let to_clip = control_point::concatenate(&camera, &model.map(f64::from));
            for n in 0..draw.primitive.patches() {
                let mut points = [[0.0; 4]; 16];
                for (point, index) in points.iter_mut().zip(indices(draw, n)) {
                    source.read(draw.first + index, 1, &mut own)?;
                    *point = own[0];
                }
                let shaded = points.map(|p| shader::transform(&matrix, p));
                let object = points.map(|p| p.map(f64::from));
                let exact = object.map(|p| control_point::transform(&to_clip, p));
                let patch = self.patch(&shaded, frame.view.position, draw);
                self.patches += 1;
                let matrix = matrix.to_cols_array();
                each(draw, Drawn { patch, frame, state, object, matrix, shaded, exact });
            }
        }
        Ok(())
    }

    fn patch(&self, shaded: &[[f32; 4]; 16], position: Format, draw: &Draw) -> Patch {
        let (rounding, overflow) = (self.config.position.rounding, self.config.position.overflow);
        let (points, saturated) = dispatch(rounding, overflow, Port(shaded, position));
        let Draw { cull, reversed, .. } = *draw;
        Patch { id: self.patches, points, saturated, cull, reversed }
    }
}

/// Which points patch `n` of a draw has, counted from the draw's first.
fn indices(draw: &Draw, n: u64) -> [u64; 16] {
    match &draw.indices {
        Some(indices) => indices.points[n as usize].map(u64::from),
        None => draw.primitive.indices(n),
    }
}

/// The port over the control points of a patch.
pub(super) struct Port<'a>(pub(super) &'a [[f32; 4]; 16], pub(super) Format);

impl Modal for Port<'_> {
    /// The points, and whether one of them did not fit.
    type Output = ([[i64; 4]; 16], bool);

    fn run<R: RoundingMode, O: OverflowMode>(self) -> Self::Output {
        let quantised = self.0.map(|p| port::accept::<R, O>(p.map(f32::to_bits), self.1));
        (quantised.map(|q| q.point), quantised.iter().any(|q| q.overflows > 0))
    }
}
