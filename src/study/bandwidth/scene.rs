//! The commands that send a surface in a form: a sheet in front of a camera, fixed levels, nothing
//! culled.

use super::{Form, Size};
use crate::attribute::{Attribute, AttributeFormat, AttributeTable};
use crate::trace::command::{
    Attributes, Command, Draw, FanEncoding, IDENTITY, Points, Primitive, Tessellation,
};
use crate::trace::indices::{IndexFormat, Indices};
use crate::trace::points::PointSource;
use crate::trace::scene::camera::Camera;
use rtl_model::level::Criterion;
use rtl_model::patch::Level;
use std::sync::Arc;

/// Commands without header and end, which send nothing.
pub(super) fn commands(form: Form, size: &Size) -> Vec<Command> {
    let (primitive, [points, corners]) = primitive(form, size);
    let points = sheet(points);
    let camera = Camera::on(&points, [0.3, -1.0, 0.6]);
    let level = Level::clamped(size.level << 16);
    let tessellation = Tessellation {
        criterion: Criterion::Fixed { level },
        max_level: (size.level as u32) << 16,
        ..Tessellation::default()
    };
    let mut draw = Draw { cull: false, ..Draw::new(primitive, 0) };
    if form == Form::IndexedMesh {
        draw.indices = Some(Arc::new(indices(size, points.len() as u64)));
    }
    if size.instances > 1 {
        draw.models = vec![IDENTITY; size.instances as usize];
        draw.models_sent = true;
    }
    let source = Arc::new(PointSource::Xyz(points));
    let mut commands = vec![
        Command::Frame(camera.frame()),
        Command::Tessellation(tessellation),
        Command::Points(Points { id: 0, source, resident: false }),
    ];
    if size.corner_bytes > 0 {
        let table = Arc::new(attributes(corners));
        assert_eq!(table.corner_bytes(), size.corner_bytes, "one of the two kinds of corners");
        commands.push(Command::Attributes(Attributes { id: 0, table, resident: false }));
        draw.attributes = Some(0);
    }
    commands.push(Command::Draw(draw));
    commands
}

/// What is drawn, its points and its corners. A host that tessellates has a mesh.
fn primitive(form: Form, size: &Size) -> (Primitive, [u64; 2]) {
    let count = size.patches();
    let mesh = Primitive::Mesh { rows: size.rows as u32, columns: size.columns as u32 };
    let primitive = match form {
        Form::Patches => Primitive::Patches { count },
        Form::Strip => Primitive::Strip { count },
        Form::FanCompact => Primitive::Fan { count, encoding: FanEncoding::Compact },
        Form::FanFull => Primitive::Fan { count, encoding: FanEncoding::Full },
        Form::IndexedMesh => Primitive::Indexed { count },
        _ => mesh,
    };
    let lattice = if form == Form::IndexedMesh { mesh } else { primitive };
    let known = "neither is indexed";
    (primitive, [lattice.points().expect(known), lattice.corners().expect(known)])
}

/// So many points on a square; where patches take them from plays no part in what is sent.
fn sheet(points: u64) -> Vec<[f32; 3]> {
    let side = points.isqrt() + 1;
    let at = |k: u64| (k as f64 / side as f64) as f32;
    (0..points).map(|k| [at(k % side), at(k / side), 0.0]).collect()
}

fn attributes(corners: u64) -> AttributeTable {
    let attribute = |name: &str, format: &str| Attribute {
        name: name.into(),
        format: AttributeFormat::named(format).expect("a format"),
    };
    let layout = vec![attribute("color", "unorm8x4"), attribute("texcoord", "float32x2")];
    let corner = |k: u64| [1.0, 0.0, 0.0, 1.0, (k % 2) as f32, (k / 2 % 2) as f32];
    AttributeTable { layout, values: (0..corners).flat_map(corner).collect() }
}

/// The patches of a mesh, by their points and corners.
fn indices(size: &Size, points: u64) -> Indices {
    let format = if points > 1 << 16 { IndexFormat::Uint32 } else { IndexFormat::Uint16 };
    let mesh = Primitive::Mesh { rows: size.rows as u32, columns: size.columns as u32 };
    let patches = 0..size.patches();
    let corners = if size.corner_bytes == 0 { 0..0 } else { patches.clone() };
    Indices {
        format,
        points: patches.map(|n| mesh.indices(n).map(|i| i as u32)).collect(),
        corners: corners.map(|n| mesh.corner_indices(n).map(|i| i as u32)).collect(),
    }
}
