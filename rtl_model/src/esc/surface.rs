//! Surface: a patch and its levels in, its vertices and triangles out: one shader invocation, or a
//! few, do all of it.
//!
//! Concheiro et al. 2014, figure 2: the pattern says where candidates are, the local test which of
//! them are inserted, the tessellation procedure connects what is there. A patch that is taken
//! twice gives the same bits; what one patch gave does not matter to the next.

use super::mesh::{Counting, Masks, Mesh, Tests, Walker};
use super::path::Datapath;
use super::pattern::{COARSE_EDGES, CoarseEdge, Parameters, slot, uniform};
use super::power::NET_BITS;
use super::sample::{Grid, Line, Sampler};
use super::section::Sections;
use super::test::Test;
use super::{LEVEL_MAX, Levels, Made, Output};
use crate::number::{Format, Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch};
use crate::patch::{Patch, Point, Triangle, Vertex, View};
use serde::{Deserialize, Serialize};

/// Where V_S, the sampling point on the control mesh, is taken to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControlMesh {
    /// On the control net, whose points stand at thirds: on the line between the two that the
    /// coarse edge joins.
    #[default]
    Net,
    /// On the chord between the surface's points at the coarse edge's ends.
    Chord,
}

/// How points of the patch's boundary are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// From the edge's own four points, from the nearer corner: the same from either end.
    #[default]
    Symmetric,
    /// As all others: a neighbour may compute other bits.
    Plain,
}

/// How far an evaluated point is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reuse {
    /// Not at all: each vertex of a strip is evaluated where it is listed, each test on its own.
    None,
    /// Within a coarse triangle, for its tests and its mesh.
    CoarseTriangle,
    /// Within the patch, as far as one invocation has it.
    #[default]
    Patch,
}

impl ControlMesh {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Net, Self::Chord];

    /// As in a configuration.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Net => "net",
            Self::Chord => "chord",
        }
    }
}

impl Boundary {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Symmetric, Self::Plain];

    /// As in a configuration.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Symmetric => "symmetric",
            Self::Plain => "plain",
        }
    }
}

impl Reuse {
    /// All, the least first.
    pub const ALL: [Self; 3] = [Self::None, Self::CoarseTriangle, Self::Patch];

    /// As in a configuration.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::CoarseTriangle => "coarse_triangle",
            Self::Patch => "patch",
        }
    }
}

/// mu: how far the surface may be from the control mesh where no vertex is inserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threshold {
    /// Every candidate is inserted and none tested.
    Uniform,
    /// On screen, in pixels, UQ16.16; above 0.
    Pixels(u32),
    /// In object space, in 1/256 ulp of the object format; above 0.
    Object(u64),
}

impl Threshold {
    /// UQ16.16 pixels; 0 is uniform.
    #[must_use]
    pub const fn pixels(fx16: u32) -> Self {
        if fx16 == 0 { Self::Uniform } else { Self::Pixels(fx16) }
    }

    /// 1/256 ulp of the object format; 0 is uniform.
    #[must_use]
    pub const fn object(ulps_256: u64) -> Self {
        if ulps_256 == 0 { Self::Uniform } else { Self::Object(ulps_256) }
    }
}

/// Formats and policies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The position format.
    pub position: Format,
    /// The format of the object-space net; 0 to width - 1 fraction bits. Used under
    /// [`Threshold::Object`].
    pub object: Format,
    /// Guard bits, 0 to 20; width + 8 + guard <= 63 for either format that is used.
    pub guard: u32,
    /// Fraction bits of a parameter, 16 to 46.
    pub parameter_bits: u32,
    /// How products, samples and points of the control mesh are rounded.
    pub rounding: Rounding,
    /// What a coordinate does that does not fit.
    pub overflow: Overflow,
    /// Where V_S is.
    pub mesh: ControlMesh,
    /// mu.
    pub threshold: Threshold,
    /// How boundary points are computed.
    pub boundary: Boundary,
    /// What is kept, and so what is counted.
    pub reuse: Reuse,
    /// How much an invocation may emit; none: anything.
    pub output: Option<Output>,
}

impl Settings {
    /// The most guard bits that the registers of a net have room for beside coordinates of `width`
    /// bits, at most 20.
    #[must_use]
    pub const fn guard_max(width: u32) -> u32 {
        let room = 63 - NET_BITS - width;
        if room < 20 { room } else { 20 }
    }
}

/// What the shader reads.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The patch in clip space.
    pub patch: &'a Patch,
    /// Its object-space net, homogeneous; needed under [`Threshold::Object`].
    pub object: Option<&'a [Point; 16]>,
    /// The frame.
    pub view: &'a View,
    /// Its levels.
    pub levels: Levels,
}

/// The shader and its stores.
#[derive(Clone, Debug)]
pub struct Surface {
    settings: Settings,
    parameters: Parameters,
    clip: Sampler,
    object: Sampler,
    grid: Grid,
    uniform: Masks,
    walker: Walker,
    /// Meshes of the uniform patterns by level, and the last other one.
    meshes: Vec<Mesh>,
    /// Which of them is the last patch's.
    current: usize,
}

/// The place of the mesh that is no uniform pattern's.
const OTHER: usize = LEVEL_MAX as usize + 1;

impl Surface {
    /// A shader of these settings.
    ///
    /// # Panics
    /// When a setting is outside what its field says, or a strip does not fit [`Output`].
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let Settings { position, object, guard, parameter_bits: bits, threshold, .. } = settings;
        assert!(guard <= Settings::guard_max(position.width), "guard bits that a net has room for");
        assert!((16..=46).contains(&bits), "16 to 46 fraction bits of a parameter");
        let tests = match threshold {
            Threshold::Uniform => Tests::None,
            Threshold::Pixels(_) => Tests::Mesh,
            Threshold::Object(_) => {
                assert!(guard <= Settings::guard_max(object.width), "guard bits in object space");
                assert!((0..object.width as i32).contains(&object.fraction), "a format with w = 1");
                Tests::Apart
            }
        };
        let ends = settings.mesh == ControlMesh::Chord;
        let counting = Counting { reuse: settings.reuse, tests, ends };
        let levels = Levels { edges: [0; 4], interior: 0 };
        let path = |format| Datapath { format, guard, bits, boundary: settings.boundary };
        Self {
            settings,
            parameters: Parameters::new(bits),
            clip: Sampler::new(path(position)),
            object: Sampler::new(path(object)),
            grid: Grid::new(levels),
            uniform: uniform(levels),
            walker: Walker::new(counting, Sections::new(settings.output)),
            meshes: vec![Mesh::default(); OTHER + 1],
            current: OTHER,
        }
    }

    /// Tessellates a patch: each distinct inserted point once into `vertices`, whatever they held,
    /// in the order in which the triangles first use them.
    ///
    /// # Panics
    /// When an edge's level is above the interior's, or that above 15 or the declared one, or the
    /// object-space net is missing.
    pub fn accept(&mut self, input: &Input<'_>, vertices: &mut Vec<Vertex>) -> Made {
        let levels = input.levels;
        assert!(levels.interior <= LEVEL_MAX, "a level of at most 15");
        assert!(levels.edges.iter().all(|&l| l <= levels.interior), "edges of at most its level");
        if self.grid.levels != levels {
            self.grid = Grid::new(levels);
            self.uniform = uniform(levels);
        }
        let Settings { rounding, overflow, .. } = self.settings;
        dispatch(rounding, overflow, Work { shader: self, input, vertices })
    }

    /// The last patch's triangles, as numbers of its vertices: counter-clockwise with u right and v
    /// up, coarse triangle by coarse triangle, strip by strip.
    #[must_use]
    pub fn triangles(&self) -> &[Triangle] {
        &self.meshes[self.current].triangles
    }

    /// Whether products fit 62 bits.
    fn is_narrow(&self) -> bool {
        let Settings { position, object, guard, parameter_bits, .. } = self.settings;
        position.width.max(object.width) + NET_BITS + guard + parameter_bits < 62
    }
}

struct Work<'a, 'b> {
    shader: &'a mut Surface,
    input: &'a Input<'b>,
    vertices: &'a mut Vec<Vertex>,
}

impl Modal for Work<'_, '_> {
    type Output = Made;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> Made {
        if self.shader.is_narrow() { self.go::<R, O, true>() } else { self.go::<R, O, false>() }
    }
}

impl Work<'_, '_> {
    fn go<R: RoundingMode, O: OverflowMode, const NARROW: bool>(mut self) -> Made {
        let levels = self.input.levels;
        self.shader.clip.load(&self.input.patch.points);
        let masks = self.decide::<R, O, NARROW>();
        let Surface { uniform, meshes, walker, current, .. } = self.shader;
        let even = levels.edges == [levels.interior; 4] && masks == *uniform;
        *current = if even { levels.interior.into() } else { OTHER };
        let mesh = &mut meshes[*current];
        if mesh.of != Some((levels, masks)) {
            walker.walk(levels, &masks, mesh);
        }
        self.evaluate::<R, O, NARROW>();
        let cracks = self.cracks::<R, O, NARROW>();
        let Surface { clip, object, meshes, current, .. } = self.shader;
        Made { cracks, overflows: clip.overflows + object.overflows, ..meshes[*current].made }
    }

    /// Which candidates are inserted.
    fn decide<R: RoundingMode, O: OverflowMode, const NARROW: bool>(&mut self) -> Masks {
        let Surface { settings, parameters, clip, object, grid, uniform, .. } = &mut *self.shader;
        let (test, sampler) = match settings.threshold {
            Threshold::Uniform => return *uniform,
            Threshold::Pixels(most) => (Test::Pixels { most, view: self.input.view }, clip),
            Threshold::Object(most) => {
                object.load(self.input.object.expect("an object-space net, where it is tested"));
                (Test::Object { most, fraction: settings.object.fraction as u32 }, object)
            }
        };
        let inner = grid.levels.interior;
        let mut masks = [0; COARSE_EDGES];
        for (mask, edge) in masks.iter_mut().zip(CoarseEdge::ALL) {
            let level = edge.level(grid.levels);
            if level == 0 {
                continue;
            }
            let [from, to] = match settings.mesh {
                ControlMesh::Net => [edge.from, edge.to].map(|corner| sampler.control(corner)),
                ControlMesh::Chord => [0, inner + 1].map(|end| {
                    sampler.fetch::<R, O, NARROW>(grid, parameters, edge.place(end, inner + 1))
                }),
            };
            let line = Line::new(from, to, level + 1);
            for k in 1..=level {
                let slot = slot(k, level, inner);
                let place = edge.place(slot, inner + 1);
                let surface = sampler.fetch::<R, O, NARROW>(grid, parameters, place);
                *mask |= u16::from(test.inserts(line.at::<R>(k), surface)) << slot;
            }
        }
        masks
    }

    /// The vertices, those that were tested on screen from there.
    fn evaluate<R: RoundingMode, O: OverflowMode, const NARROW: bool>(&mut self) {
        let Surface { settings, parameters, clip, grid, meshes, current, .. } = &mut *self.shader;
        let kept = matches!(settings.threshold, Threshold::Pixels(_));
        self.vertices.clear();
        self.vertices.extend(meshes[*current].places.iter().map(|&place| {
            let position = if kept {
                clip.fetch::<R, O, NARROW>(grid, parameters, place)
            } else {
                clip.at::<R, O, NARROW>(grid, parameters, place)
            };
            let [u, v] = grid.lines(place).map(|(level, line)| parameters.fx16(level, line));
            Vertex { position, u, v }
        }));
    }

    /// Boundary vertices that a neighbour could evaluate otherwise.
    fn cracks<R: RoundingMode, O: OverflowMode, const NARROW: bool>(&self) -> u64 {
        let Surface { settings, parameters, clip, grid, meshes, current, .. } = &*self.shader;
        if settings.boundary == Boundary::Symmetric {
            return 0; // by its form
        }
        let places = meshes[*current].places.iter().copied();
        let sites = places.filter(|place| grid.is_inside_an_edge(*place));
        clip.cracks::<R, O, NARROW>(grid, parameters, sites)
    }
}
