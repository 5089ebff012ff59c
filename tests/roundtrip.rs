//! What the writer writes, the reader reads: the same commands, to the bit, for random traces.

use proptest::prelude::*;
use rtl_model::level::Criterion;
use rtl_model::patch::{Depth, Level};
use std::sync::Arc;
use tessim::trace::command::{
    Command, Draw, Frame, Header, IDENTITY, Points, Primitive, Range, Tessellation,
};
use tessim::trace::points::PointSource;
use tessim::trace::read::Reader;
use tessim::trace::write::Writer;

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

/// Points under an id, and a draw that uses all of them.
fn surface() -> impl Strategy<Value = Vec<Command>> {
    let primitive = prop_oneof![
        (1u64..3).prop_map(|count| Primitive::Patches { count }),
        (1u32..3, 1u32..3).prop_map(|(rows, columns)| Primitive::Mesh { rows, columns }),
    ];
    (primitive, 0u64..3, any::<(u32, bool, bool, bool)>(), any::<bool>()).prop_flat_map(
        |(primitive, first, (id, resident, reversed, cull), rational)| {
            let count = (primitive.points() + first) as usize;
            let matrix = prop::array::uniform16(number());
            let models = prop::collection::vec(matrix, 0..3);
            let xyz = prop::array::uniform3(number());
            let xyzw =
                (prop::array::uniform3(number()), weight()).prop_map(|([x, y, z], w)| [x, y, z, w]);
            let source = if rational {
                prop::collection::vec(xyzw, count).prop_map(PointSource::Xyzw).boxed()
            } else {
                prop::collection::vec(xyz, count).prop_map(PointSource::Xyz).boxed()
            };
            (source, models).prop_map(move |(source, mut models)| {
                let models_sent = !models.is_empty();
                if !models_sent {
                    models.push(IDENTITY);
                }
                let draw =
                    Draw { primitive, points: id, first, models, models_sent, reversed, cull };
                let points = Points { id, source: Arc::new(source), resident };
                vec![Command::Points(points), Command::Draw(draw)]
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

fn trace() -> impl Strategy<Value = Vec<Command>> {
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

proptest! {
    #[test]
    fn reading_undoes_writing(commands in trace()) {
        let mut writer = Writer::new(Vec::new());
        for command in &commands {
            writer.write(command).expect("memory takes all");
        }
        let text = writer.into_inner();
        let read: Result<Vec<Command>, _> =
            Reader::new(&text[..], "t", ".").map(|c| c.map(|c| c.command)).collect();
        let read = read.expect("what is written is well-formed");
        prop_assert_eq!(read.len(), commands.len());
        prop_assert_eq!(&read, &commands);
        // Equality takes -0 for 0; what is shown does not.
        prop_assert_eq!(format!("{read:?}"), format!("{commands:?}"));
    }
}
