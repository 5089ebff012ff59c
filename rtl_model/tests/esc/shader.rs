//! Shaders and patches for the tests of the surface shader, and what comes out, in one piece.

use crate::random::{Kind, Random, patch};
use rtl_model::esc::{
    Boundary, ControlMesh, Input, LEVEL_MAX, Levels, Made, Reuse, Settings, Surface, Threshold,
    fraction,
};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Patch, Point, Triangle, Vertex, View};

/// A multiple of every 3 R, R to 16: parameters are integers over it.
pub(crate) const UNIT: i64 = 3 * 720_720;

pub(crate) const POSITION: Format = Format { width: 32, fraction: 26 };

pub(crate) const VIEW: View = View {
    position: POSITION,
    viewport: [1280, 1024],
    depth: Depth::ZeroToOne,
    near: 1 << 10,
    facing: 1,
};

pub(crate) fn settings(threshold: Threshold) -> Settings {
    Settings {
        position: POSITION,
        object: Format { width: 36, fraction: 30 },
        guard: 12,
        parameter_bits: 24,
        rounding: Rounding::NearestEven,
        overflow: Overflow::Saturate,
        mesh: ControlMesh::Net,
        threshold,
        boundary: Boundary::Symmetric,
        reuse: Reuse::Patch,
        output: None,
    }
}

/// Any formats and policies; thresholds such that some candidates of most patches are inserted.
pub(crate) fn any_settings(random: &mut Random) -> Settings {
    let width = random.integer(8, 48);
    let object = random.integer(8, 48);
    let room = Settings::guard_max(width.max(object));
    let threshold = match random.integer(0, 2) {
        0 => Threshold::Uniform,
        1 => Threshold::pixels((random.octaves(0.05, 400.0) * 65536.0) as u32),
        _ => Threshold::object(
            random.octaves(0.001, 0.5).mul_add(2f64.powi(object as i32 + 7), 1.0) as u64,
        ),
    };
    Settings {
        position: Format::of_range(width, 0),
        object: Format::of_range(object, random.integer(0, 4) as i32),
        guard: random.integer(0, room),
        parameter_bits: random.integer(16, 46),
        rounding: random.of(Rounding::ALL),
        overflow: random.of(Overflow::ALL),
        mesh: random.of(ControlMesh::ALL),
        threshold,
        ..settings(threshold)
    }
}

pub(crate) fn view(random: &mut Random, position: Format) -> View {
    let near = (position.max() as f64 * random.real(0.0, 0.3)) as i64;
    let viewport = [random.integer(1, 4096), random.integer(1, 16384)];
    View { position, viewport, near, ..VIEW }
}

/// Levels of edges at most the interior's, more often than not different ones.
pub(crate) fn levels(random: &mut Random, most: u8) -> Levels {
    let interior = random.integer(0, most.into()) as u8;
    let mut edge = || random.integer(0, interior.into()) as u8;
    let edges = [edge(), edge(), edge(), edge()];
    let even = Levels { edges: [interior; 4], interior };
    random.of([even, Levels { edges, interior }, Levels { edges, interior }])
}

pub(crate) fn any_levels(random: &mut Random) -> Levels {
    let most = random.of([2, 4, 7, LEVEL_MAX]);
    levels(random, most)
}

/// A patch and an object-space net, which need not be the same surface.
pub(crate) fn subject(random: &mut Random, settings: &Settings) -> (Patch, [Point; 16]) {
    let kind = random.of([Kind::Wild, Kind::Sheet, Kind::Sheet, Kind::EqualRows, Kind::Planar]);
    let clip = patch(random, kind, settings.position.max());
    let kind = random.of([Kind::Wild, Kind::Sheet, Kind::Sheet]);
    let mut object = patch(random, kind, settings.object.max()).points;
    if random.bits() & 1 == 0 {
        let one = (1_i64 << settings.object.fraction).min(settings.object.max());
        object = object.map(|[x, y, z, _]| [x, y, z, one]);
    }
    (clip, object)
}

/// All that a shader makes of a patch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Result {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) made: Made,
}

pub(crate) fn run(
    shader: &mut Surface,
    (patch, object): &(Patch, [Point; 16]),
    view: &View,
    levels: Levels,
) -> Result {
    let mut vertices = vec![Vertex::default(); 3]; // what they hold does not matter
    let input = Input { patch, object: Some(object), view, levels };
    let made = shader.accept(&input, &mut vertices);
    Result { vertices, triangles: shader.triangles().to_vec(), made }
}

/// `[u, v]` over UNIT.
pub(crate) fn exact(vertex: &Vertex) -> [i64; 2] {
    [vertex.u, vertex.v].map(|fx16| {
        let (i, n) = fraction(fx16);
        assert_eq!(UNIT % i64::from(n), 0, "{i} / {n}");
        i64::from(i) * (UNIT / i64::from(n))
    })
}
