//! One surface drawn as patches, as a mesh, as a strip and as an indexed mesh, and a fan beside its
//! patches: the same triangles, vertices and attributes to the bit, and the counts that section 6
//! of Sfarti et al. 2005 gives for any size.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/random.rs"]
mod random;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "support/run.rs"]
mod run;

use glam::Vec3;
use random::Random;
use rtl_model::counter::{Counter as C, Counters, DECLARATIONS};
use rtl_model::patch::{Triangle, Vertex};
use std::sync::Arc;
use tessim::attribute::{Attribute, AttributeFormat, AttributeTable};
use tessim::config::{Config, Unit};
use tessim::error::Result;
use tessim::sink::{FrameInfo, PatchMesh, Sink};
use tessim::trace::command::{
    Attributes, Command, Draw, FanEncoding, IDENTITY, Points, Primitive, Tessellation,
};
use tessim::trace::indices::{IndexFormat, Indices};
use tessim::trace::points::PointSource;
use tessim::unit::simulate;

/// Components of a corner, and their bytes.
const COMPONENTS: usize = 3;
const CORNER_BYTES: u64 = 4 + 4;

/// Control points of patches, row-major, and their corners' attributes.
struct Surface {
    points: Vec<[f32; 3]>,
    corners: Vec<[f32; COMPONENTS]>,
}

/// The mesh of a patch.
#[derive(PartialEq)]
struct Mesh {
    patch: u32,
    vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
    attributes: Vec<i64>,
}

/// All meshes, as they come.
#[derive(Default, PartialEq)]
struct Meshes(Vec<Mesh>);

impl Sink for Meshes {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, _frame: &FrameInfo) -> Result<()> {
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let (vertices, triangles) = (mesh.vertices.to_vec(), mesh.triangles.to_vec());
        assert_eq!(mesh.attributes.len(), COMPONENTS * vertices.len());
        assert_eq!(mesh.layout.len(), 2);
        let attributes = mesh.attributes.to_vec();
        self.0.push(Mesh { patch: mesh.patch, vertices, triangles, attributes });
        Ok(())
    }
}

impl Surface {
    /// Some of its points and corners, in this order.
    fn of(
        &self,
        points: impl IntoIterator<Item = u64>,
        corners: impl IntoIterator<Item = u64>,
    ) -> Self {
        Self {
            points: points.into_iter().map(|i| self.points[i as usize]).collect(),
            corners: corners.into_iter().map(|i| self.corners[i as usize]).collect(),
        }
    }

    fn draw(&self, draw: Draw, resident: bool, config: &Config) -> (Meshes, Counters) {
        let attribute = |name: &str, format: &str| Attribute {
            name: name.into(),
            format: AttributeFormat::named(format).expect("a format"),
        };
        let layout = vec![attribute("a", "unorm16x2"), attribute("b", "float32")];
        let unorm = layout[0].format;
        let value = |[a, b, c]: &[f32; 3]| [unorm.nearest(*a), unorm.nearest(*b), *c];
        let table =
            AttributeTable { layout, values: self.corners.iter().flat_map(value).collect() };
        let source = Arc::new(PointSource::Xyz(self.points.clone()));
        let commands = [
            Command::Tessellation(Tessellation { max_level: 9 << 16, ..Tessellation::default() }),
            Command::Frame(run::camera(Vec3::new(3.0, 2.0, 9.0), 0.5, 40.0)),
            Command::Points(Points { id: 0, source, resident }),
            Command::Attributes(Attributes { id: 4, table: Arc::new(table), resident }),
            Command::Draw(Draw { attributes: Some(4), ..draw }),
        ];
        let mut meshes = Meshes::default();
        let report = simulate(commands.into_iter().map(Ok), config, &mut meshes);
        (meshes, report.expect("a surface").totals())
    }
}

/// A bumpy lattice with as many points and corners as the primitive has.
fn surface(random: &mut Random, primitive: Primitive) -> Surface {
    let points = primitive.points().expect("not indexed");
    let side = (points as f32).sqrt().ceil();
    let point = |k: u64, z: f32| {
        [(k as f32 % side) / side * 4.0, (k as f32 / side).floor() / side * 4.0, z]
    };
    Surface {
        points: (0..points).map(|k| point(k, random.real(0.0, 1.0) as f32)).collect(),
        corners: (0..primitive.corners().expect("not indexed"))
            .map(|_| [0, 1, 2].map(|_| random.real(0.0, 1.0) as f32))
            .collect(),
    }
}

fn models(count: u64) -> Vec<[f32; 16]> {
    let model = |k: u64| {
        let mut model = IDENTITY;
        model[12] = k as f32 / 4.0;
        model
    };
    (0..count).map(model).collect()
}

/// Draws `primitive` as itself, as patches, and as an indexed mesh: all the same. Returns its
/// counters, the patches' and the indexed mesh's.
fn same(
    random: &mut Random,
    primitive: Primitive,
    instances: u64,
    config: &Config,
) -> [Counters; 3] {
    let surface = surface(random, primitive);
    let resident = random.integer(0, 2) == 0;
    let draw = |primitive| Draw {
        models: models(instances),
        models_sent: true,
        cull: false,
        ..Draw::new(primitive, 0)
    };
    let (own, own_counters) = surface.draw(draw(primitive), resident, config);
    let count = primitive.patches();
    let patches = surface.of(
        (0..count).flat_map(|n| primitive.indices(n)),
        (0..count).flat_map(|n| primitive.corner_indices(n)),
    );
    let (apart, apart_counters) =
        patches.draw(draw(Primitive::Patches { count }), resident, config);
    assert!(own == apart, "{primitive:?} is other than its patches");
    let indices = Indices {
        format: IndexFormat::Uint32,
        points: (0..count).map(|n| primitive.indices(n).map(|i| i as u32)).collect(),
        corners: (0..count).map(|n| primitive.corner_indices(n).map(|i| i as u32)).collect(),
    };
    let indexed = Draw { indices: Some(Arc::new(indices)), ..draw(Primitive::Indexed { count }) };
    let (indexed, indexed_counters) = surface.draw(indexed, resident, config);
    assert!(own == indexed, "{primitive:?} is other than its indexed mesh");
    let made = own.0.iter().map(|mesh| mesh.vertices.len()).sum::<usize>() as u64;
    let interpolated = [C::EvaluateAttributes, C::DomainAttributes, C::SurfaceAttributes];
    let interpolated = interpolated.map(|c| own_counters.get(c));
    assert_eq!(interpolated.iter().sum::<u64>(), COMPONENTS as u64 * made);
    [own_counters, apart_counters, indexed_counters]
}

/// In a unit that knows nothing but patches, a primitive is the indexed mesh that it stands for.
fn check_indexed(random: &mut Random, primitive: Primitive, instances: u64) -> u64 {
    let mut config = Config { unit: Unit::D3d11, ..Config::default() };
    config.assemble.cache_entries = random.of([0, 5, 16, 32, 1000]);
    let [own, apart, indexed] = same(random, primitive, instances, &config);
    let (points, corners) = paper(primitive);
    let patches = primitive.patches();
    let known = [
        (own.get(C::LinkControlPoints), 12 * points),
        (own.get(C::LinkAttributes), CORNER_BYTES * corners),
        (2 * own.get(C::LinkIndices), indexed.get(C::LinkIndices)), // of 2 bytes, where 4 are asked
        (apart.get(C::LinkIndices), 0),
        (own.get(C::AssembleEdgePeak), 0),
        (own.get(C::HullThreads), 16 * patches * instances),
    ];
    for (k, (got, want)) in known.iter().enumerate() {
        assert_eq!(got, want, "count {k} of {primitive:?}, {instances} instances");
    }
    let links = [C::LinkIndices, C::LinkOverhead, C::LinkTotal];
    let others = DECLARATIONS.iter().map(|d| d.counter).filter(|c| !links.contains(c));
    let mut compared = 0;
    for counter in others {
        assert_eq!(own.get(counter), indexed.get(counter), "{counter:?} of {primitive:?}");
        compared += 1;
    }
    known.len() as u64 + compared
}

/// Points and corners of a primitive by the paper's sums, not by ours.
fn paper(primitive: Primitive) -> (u64, u64) {
    match primitive {
        Primitive::Strip { count: n } => (16 + 12 * (n - 1), 4 + 2 * (n - 1)),
        Primitive::Fan { count: n, encoding: FanEncoding::Compact } => {
            (1 + 11 + 8 * (n - 1), 1 + 2 + (n - 1))
        }
        Primitive::Fan { count: n, encoding: FanEncoding::Full } => {
            (1 + 12 + 9 * (n - 1), 1 + 2 + (n - 1))
        }
        Primitive::Mesh { rows, columns } => {
            let (m, n) = (u64::from(rows), u64::from(columns));
            let inner = (m - 1) * (n - 1);
            (16 + 12 * (m - 1 + n - 1) + 9 * inner, 4 + 2 * (m - 1 + n - 1) + inner)
        }
        _ => unreachable!("the paper's primitives"),
    }
}

fn check(random: &mut Random, primitive: Primitive, instances: u64) -> u64 {
    let mut config = Config::default();
    config.assemble.cache_entries = random.of([0, 5, 16, 32, 1000]);
    config.unit = random.of([Unit::Hybrid, Unit::Sfarti, Unit::Moreton, Unit::Esc]);
    let [own, apart, indexed] = same(random, primitive, instances, &config);
    let transformed = if config.unit.in_object_space() { 0 } else { 1 };
    let (points, corners) = paper(primitive);
    let patches = primitive.patches();
    let cached = indexed.get(C::AssembleReceived);
    let known = [
        (own.get(C::LinkControlPoints), 12 * points),
        (own.get(C::LinkAttributes), CORNER_BYTES * corners),
        (own.get(C::LinkIndices), 0),
        (own.get(C::AssembleReceived), points * instances),
        (own.get(C::PortPoints), points * instances),
        (own.get(C::AssembleCorners), corners * instances),
        (own.get(C::AssembleReused), (16 * patches - points) * instances),
        (own.get(C::AssembleCornersReused), (4 * patches - corners) * instances),
        (own.get(C::TransformInvocations), points * instances * transformed),
        (own.get(C::MemoryWrittenControlPoints), own.get(C::MemoryReadControlPoints) / instances),
        (own.get(C::MemoryWrittenAttributes), own.get(C::MemoryReadAttributes) / instances),
        (apart.get(C::LinkControlPoints), 12 * 16 * patches),
        (apart.get(C::LinkAttributes), CORNER_BYTES * 4 * patches),
        (apart.get(C::AssembleReceived), 16 * patches * instances),
        (apart.get(C::AssembleReused), 0),
        (apart.get(C::AssembleEdgePeak), 0),
        (indexed.get(C::LinkControlPoints), 12 * points),
        (indexed.get(C::LinkIndices), 4 * 20 * patches),
        (indexed.get(C::AssembleReused), 16 * patches * instances - cached),
        (indexed.get(C::AssembleCorners), 4 * patches * instances),
        (indexed.get(C::PortPoints), cached),
        (indexed.get(C::AssemblePatches), patches * instances),
    ];
    for (k, (got, want)) in known.iter().enumerate() {
        assert_eq!(got, want, "count {k} of {primitive:?}, {instances} instances");
    }
    assert!(cached >= points * instances || config.assemble.cache_entries > 0);
    if config.assemble.cache_entries == 0 {
        assert_eq!(cached, 16 * patches * instances, "without a cache each point is fetched");
    }
    known.len() as u64
}

#[test]
fn every_primitive_is_its_patches_and_counts_as_the_paper_says() {
    let mut random = Random::new(0x5fa7);
    let mut compared = 0;
    for _ in 0..run::scale(40, 400) {
        let (count, instances) =
            (1 + random.integer(0, 20) as u64, 1 + random.integer(0, 3) as u64);
        let (rows, columns) = (1 + random.integer(0, 6), 1 + random.integer(0, 6));
        let encoding = random.of([FanEncoding::Compact, FanEncoding::Full]);
        compared += check(&mut random, Primitive::Strip { count }, instances);
        compared += check(&mut random, Primitive::Fan { count, encoding }, instances);
        compared += check(&mut random, Primitive::Mesh { rows, columns }, instances);
        for primitive in [
            Primitive::Strip { count },
            Primitive::Fan { count, encoding },
            Primitive::Mesh { rows, columns },
        ] {
            compared += check_indexed(&mut random, primitive, instances);
        }
    }
    println!("compared {compared} counts");
    assert!(compared >= 2000);
}

/// Larger than a batch: blocks begin where the block before ended.
#[test]
fn a_primitive_of_many_patches_is_its_patches() {
    let mut random = Random::new(0x1a56e);
    for primitive in [
        Primitive::Strip { count: 5000 },
        Primitive::Fan { count: 4500, encoding: FanEncoding::Compact },
        Primitive::Fan { count: 4500, encoding: FanEncoding::Full },
        Primitive::Mesh { rows: 3, columns: 1500 },
    ] {
        check(&mut random, primitive, 2);
        check_indexed(&mut random, primitive, 1);
    }
}

/// A patch that is drawn again at once needs no point of its own.
#[test]
fn a_patch_that_is_on_chip_as_a_whole_is_drawn_all_the_same() {
    let mut random = Random::new(3);
    let surface = surface(&mut random, Primitive::Patches { count: 1 });
    let indices = Indices {
        format: IndexFormat::Uint16,
        points: vec![std::array::from_fn(|k| k as u32); 3],
        corners: vec![[0, 1, 2, 3]; 3],
    };
    let draw = Draw {
        indices: Some(Arc::new(indices)),
        cull: false,
        ..Draw::new(Primitive::Indexed { count: 3 }, 0)
    };
    let (meshes, counters) = surface.draw(draw, true, &Config::default());
    assert_eq!(meshes.0.len(), 3);
    let known = [
        (C::AssembleReceived, 16),
        (C::AssembleReused, 32),
        (C::AssembleWhole, 2),
        (C::LevelPatches, 3),
        (C::MemoryReadControlPoints, 16 * 12),
        (C::MemoryUncachedControlPoints, 48 * 12),
        (C::MemoryReadAttributes, 12 * CORNER_BYTES),
        // Uploads: 192 bytes of points and 32 of corners; reads: 192, and three times 32.
        (C::MemoryBursts, 6 + 1 + 6 + 3),
    ];
    for (counter, value) in known {
        assert_eq!(counters.get(counter), value, "{counter:?}");
    }
}
