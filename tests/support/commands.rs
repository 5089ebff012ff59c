//! Random traces: commands that a reader takes, of every kind.

use proptest::prelude::*;
use rtl_model::level::Criterion;
use rtl_model::patch::{Depth, Level};
use std::sync::Arc;
use tessim::attribute::{Attribute, AttributeFormat, AttributeTable};
use tessim::trace::command::{
    Attributes, Command, Draw, FanEncoding, Frame, Header, IDENTITY, Points, Primitive, Range,
    Tessellation,
};
use tessim::trace::indices::{IndexFormat, Indices};
use tessim::trace::points::PointSource;

/// A finite number of any size.
fn number() -> impl Strategy<Value = f32> {
    use prop::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn weight() -> impl Strategy<Value = f32> {
    use prop::num::f32::{NORMAL, POSITIVE, SUBNORMAL};
    (POSITIVE | NORMAL | SUBNORMAL).prop_map(f32::abs).prop_filter("above 0", |w| *w > 0.0)
}

fn header() -> impl Strategy<Value = Command> {
    let text = "\\PC*|[\u{0}-\u{7f}]*";
    (text, text, text)
        .prop_map(|(title, source, licence)| Command::Header(Header { title, source, licence }))
}

/// A matrix that has an inverse: a triangle with a diagonal far from 0.
fn invertible() -> impl Strategy<Value = [f32; 16]> {
    (prop::array::uniform16(-4f32..4.0), prop::array::uniform4(0.5f32..9.0)).prop_map(|(m, d)| {
        let entry = |i: usize| match (i / 4).cmp(&(i % 4)) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => d[i / 4],
            std::cmp::Ordering::Greater => m[i],
        };
        std::array::from_fn(entry)
    })
}

fn frame() -> impl Strategy<Value = Command> {
    let range = prop::option::of(-64..=64);
    let depth = prop_oneof![Just(Depth::ZeroToOne), Just(Depth::MinusOneToOne)];
    let viewport = prop::array::uniform2(1u32..=16384);
    (viewport, invertible(), invertible(), depth, (range.clone(), range)).prop_map(
        |(viewport, view, projection, depth, (clip, object))| {
            let range = Range { clip, object };
            Command::Frame(Frame { viewport, view, projection, depth, range })
        },
    )
}

fn primitive() -> impl Strategy<Value = Primitive> {
    let encoding = prop_oneof![Just(FanEncoding::Compact), Just(FanEncoding::Full)];
    prop_oneof![
        (1u64..3).prop_map(|count| Primitive::Patches { count }),
        (1u64..4).prop_map(|count| Primitive::Strip { count }),
        (1u64..4, encoding).prop_map(|(count, encoding)| Primitive::Fan { count, encoding }),
        (1u32..3, 1u32..3).prop_map(|(rows, columns)| Primitive::Mesh { rows, columns }),
        (1u64..4).prop_map(|count| Primitive::Indexed { count }),
    ]
}

/// Points that a draw needs from its first on, or corners, where indices below 20 say which.
fn needed(count: Option<u64>) -> u64 {
    count.unwrap_or(20)
}

fn points(id: u32, resident: bool, count: usize) -> impl Strategy<Value = Command> {
    let xyz = prop::array::uniform3(number());
    let xyzw = (prop::array::uniform3(number()), weight()).prop_map(|([x, y, z], w)| [x, y, z, w]);
    prop_oneof![
        prop::collection::vec(xyzw, count).prop_map(PointSource::Xyzw),
        prop::collection::vec(xyz, count).prop_map(PointSource::Xyz),
    ]
    .prop_map(move |source| Command::Points(Points { id, source: Arc::new(source), resident }))
}

fn attributes(id: u32, resident: bool, corners: usize) -> impl Strategy<Value = Command> {
    let format = prop::sample::select(AttributeFormat::ALL);
    prop::collection::vec(("_?[a-z][a-z0-9_]{0,5}", format), 1..4).prop_flat_map(move |layout| {
        let attribute = |(k, (name, format)): (usize, (String, AttributeFormat))| Attribute {
            name: format!("{name}{k}"),
            format,
        };
        let layout: Vec<Attribute> = layout.into_iter().enumerate().map(attribute).collect();
        let repeated = |a: &Attribute| vec![a.format; a.format.components()];
        let formats: Vec<AttributeFormat> = layout.iter().flat_map(repeated).collect();
        let unit = 0f32..=1.0;
        prop::collection::vec(unit, corners * formats.len()).prop_map(move |mut values| {
            for (value, format) in values.iter_mut().zip(formats.iter().cycle()) {
                *value = format.nearest(*value);
            }
            let table = Arc::new(AttributeTable { layout: layout.clone(), values });
            Command::Attributes(Attributes { id, table, resident })
        })
    })
}

fn indices(count: usize) -> impl Strategy<Value = Indices> {
    let points = prop::collection::vec(prop::array::uniform16(0u32..20), count);
    let corners = prop::collection::vec(prop::array::uniform4(0u32..20), count);
    let format = prop_oneof![Just(IndexFormat::Uint16), Just(IndexFormat::Uint32)];
    (format, points, corners).prop_map(|(format, points, corners)| Indices {
        format,
        points,
        corners,
    })
}

/// Points under an id, attributes, and a draw that uses them.
fn surface() -> impl Strategy<Value = Vec<Command>> {
    let flags = any::<(u32, bool, bool, bool, bool)>();
    (primitive(), 0u64..3, flags).prop_flat_map(
        |(primitive, first, (id, resident, reversed, cull, bare))| {
            let count = (needed(primitive.points()) + first) as usize;
            let corners = needed(primitive.corners()) as usize;
            let models = prop::collection::vec(prop::array::uniform16(number()), 0..3);
            let parts = (
                points(id, resident, count),
                attributes(id / 2, !resident, corners),
                indices(primitive.patches() as usize),
                models,
            );
            parts.prop_map(move |(points, attributes, mut indices, mut models)| {
                let models_sent = !models.is_empty();
                if !models_sent {
                    models.push(IDENTITY);
                }
                if bare {
                    indices.corners.clear();
                }
                let indexed = matches!(primitive, Primitive::Indexed { .. });
                let draw = Draw {
                    first,
                    indices: indexed.then(|| Arc::new(indices)),
                    attributes: (!bare).then_some(id / 2),
                    models,
                    models_sent,
                    reversed,
                    cull,
                    ..Draw::new(primitive, id)
                };
                vec![points, attributes, Command::Draw(draw)]
            })
        },
    )
}

fn tessellation() -> impl Strategy<Value = Command> {
    let level = 1u32 << 16..=128 << 16;
    let criterion = prop_oneof![
        (1..=u32::MAX).prop_map(|pixels| Criterion::Flatness { pixels }),
        (1..=u32::MAX).prop_map(|pixels| Criterion::EdgeLength { pixels }),
        level.clone().prop_map(|l| Criterion::Fixed { level: Level::clamped(l.into()) }),
    ];
    (criterion, level.clone(), level).prop_map(|(criterion, a, b)| {
        let (min_level, max_level) = (a.min(b), a.max(b));
        Command::Tessellation(Tessellation { criterion, min_level, max_level })
    })
}

/// A whole trace.
pub(crate) fn trace() -> impl Strategy<Value = Vec<Command>> {
    let one = prop_oneof![
        frame().prop_map(|c| vec![c]),
        tessellation().prop_map(|c| vec![c]),
        surface(),
    ];
    (header(), frame(), prop::collection::vec(one, 0..5)).prop_map(|(header, frame, rest)| {
        let mut all = vec![header, frame];
        all.extend(rest.into_iter().flatten());
        all.push(Command::End);
        all
    })
}
