//! Walk: a shipped trace in, every patch that it draws out, as the unit gets it: the real reader,
//! frame state, control-point shader and port; and beside it the same patch in real numbers.

use glam::Mat4;
use rtl_model::level::State;
use rtl_model::number::{NearestEven, Saturate};
use rtl_model::patch::{Level, Patch};
use rtl_model::port;
use std::collections::HashMap;
use std::path::PathBuf;
use tessim::config::Config;
use tessim::golden::{Real, control_point};
use tessim::shader::control_point as shader;
use tessim::trace::command::{Command, Draw, Points, Tessellation};
use tessim::trace::open::Trace;
use tessim::unit::FrameState;

/// The traces in `traces/`.
pub(crate) const SHIPPED: [&str; 5] = ["teapot", "teacup", "teaspoon", "mesh", "rational"];

/// A patch of a trace.
pub(crate) struct Drawn {
    /// Its control points behind the port.
    pub(crate) patch: Patch,
    /// Its frame.
    pub(crate) frame: FrameState,
    /// Its draw's tessellation state.
    pub(crate) state: State,
    /// Control points in object space.
    pub(crate) object: [Real; 16],
    /// Object to clip space as the shader has it, column-major.
    pub(crate) matrix: [f32; 16],
    /// Control points in clip space as the shader made them.
    pub(crate) shaded: [[f32; 4]; 16],
    /// Control points in clip space, f64 from the trace's numbers on.
    pub(crate) exact: [Real; 16],
}

/// Calls `each` for every patch of a shipped trace.
pub(crate) fn walk(name: &str, config: &Config, mut each: impl FnMut(&Draw, &Drawn)) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{name}.jsonl"));
    let mut points: HashMap<u32, Points> = HashMap::new();
    let mut tessellation = Tessellation::default();
    let mut camera = None;
    for located in Trace::open(path).expect("a shipped trace") {
        match located.expect("a whole trace").command {
            Command::Points(p) => drop(points.insert(p.id, p)),
            Command::Tessellation(t) => tessellation = t,
            Command::Frame(f) => {
                let frame = FrameState::new(&f, config).expect("a finite far plane");
                let [projection, view] = [f.projection, f.view].map(|m| m.map(f64::from));
                camera = Some((frame, control_point::concatenate(&projection, &view)));
            }
            Command::Draw(draw) => {
                let (frame, exact) = camera.expect("the reader refuses a draw before any frame");
                let state = state(&tessellation);
                instances(&draw, &points[&draw.points], (frame, exact, state), &mut each);
            }
            _ => {}
        }
    }
}

fn state(t: &Tessellation) -> State {
    let [min, max] = [t.min_level, t.max_level].map(|fx16| Level::clamped(fx16.into()));
    State { criterion: t.criterion, min, max }
}

fn instances(
    draw: &Draw,
    points: &Points,
    (frame, camera, state): (FrameState, [f64; 16], State),
    each: &mut impl FnMut(&Draw, &Drawn),
) {
    let mut objects = Vec::new();
    let count = draw.primitive.points().expect("not indexed") as usize;
    points.source.read(draw.first, count, &mut objects).expect("inline points");
    for model in &draw.models {
        let matrix = shader::concatenate(&frame.clip_from_world, &Mat4::from_cols_array(model));
        let to_clip = control_point::concatenate(&camera, &model.map(f64::from));
        for n in 0..draw.primitive.patches() {
            let own = draw.primitive.indices(n).map(|k| objects[k as usize]);
            let shaded = own.map(|p| shader::transform(&matrix, p));
            let quantised = shaded.map(|p| {
                port::accept::<NearestEven, Saturate>(p.map(f32::to_bits), frame.view.position)
            });
            let patch = Patch {
                id: n as u32,
                points: quantised.map(|q| q.point),
                saturated: quantised.iter().any(|q| q.overflows > 0),
                cull: draw.cull,
                reversed: draw.reversed,
            };
            let object = own.map(|p| p.map(f64::from));
            let exact = object.map(|p| control_point::transform(&to_clip, p));
            let matrix = matrix.to_cols_array();
            each(draw, &Drawn { patch, frame, state, object, matrix, shaded, exact });
        }
    }
}
