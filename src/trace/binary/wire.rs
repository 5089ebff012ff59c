//! Wire: commands in, the bytes that stand for them out, and back.
//!
//! The types here are the format. They mirror the commands so that neither can change the other
//! behind its back: what is written is what stands here, in this order. Lists of numbers are their
//! little-endian bytes, which a reader takes over without looking at each.

use crate::attribute::{Attribute, AttributeFormat, AttributeTable, COMPONENTS_MAX};
use crate::trace::command::{
    Attributes, Command, Draw, FanEncoding, Frame, Header, IDENTITY, Points, Primitive, Range,
    Tessellation,
};
use crate::trace::indices::{IndexFormat, Indices};
use crate::trace::json::snippet;
use crate::trace::points::{DataFile, Layout, PointFile, PointSource};
use crate::trace::state::State;
use rtl_model::level::Criterion;
use rtl_model::patch::{Depth, Level};
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

#[derive(Debug, Serialize, Deserialize)]
enum Wire<'a> {
    Header {
        title: &'a str,
        source: &'a str,
        licence: &'a str,
    },
    Frame {
        viewport: [u32; 2],
        view: [f32; 16],
        projection: [f32; 16],
        minus_one_to_one: bool,
        clip_log2: Option<i32>,
        object_log2: Option<i32>,
    },
    Points {
        id: u32,
        resident: bool,
        #[serde(borrow)]
        source: WireSource<'a>,
    },
    Attributes {
        id: u32,
        resident: bool,
        #[serde(borrow)]
        layout: WireLayout<'a>,
        #[serde(borrow)]
        values: Numbers<'a>,
    },
    Tessellation {
        criterion: WireCriterion,
        min_level: u32,
        max_level: u32,
    },
    Draw {
        primitive: WirePrimitive,
        points: u32,
        first: u64,
        #[serde(borrow)]
        indices: Option<WireIndices<'a>>,
        attributes: Option<u32>,
        /// None where the trace gives none.
        #[serde(borrow)]
        models: Option<Numbers<'a>>,
        reversed: bool,
        cull: bool,
    },
    End,
}

#[derive(Debug, Serialize, Deserialize)]
enum WireSource<'a> {
    Xyz(#[serde(borrow)] Numbers<'a>),
    Xyzw(#[serde(borrow)] Numbers<'a>),
    File { name: &'a str, homogeneous: bool, count: u64 },
}

#[derive(Debug, Serialize, Deserialize)]
enum WireCriterion {
    /// Pixels, UQ16.16.
    Flatness(u32),
    /// Pixels, UQ16.16.
    EdgeLength(u32),
    /// A level, UQ8.16.
    Fixed(u32),
}

#[derive(Debug, Serialize, Deserialize)]
enum WirePrimitive {
    Patches(u64),
    Mesh(u32, u32),
    Strip(u64),
    FanCompact(u64),
    FanFull(u64),
    Indexed(u64),
}

#[derive(Debug, Serialize, Deserialize)]
struct WireIndices<'a> {
    four_bytes: bool,
    #[serde(borrow)]
    points: Numbers<'a>,
    #[serde(borrow)]
    corners: Numbers<'a>,
}

/// Names and formats of attributes.
#[derive(Debug)]
struct WireLayout<'a>(Vec<(&'a str, &'a str)>);

impl Serialize for WireLayout<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for WireLayout<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Few;

        impl<'de> Visitor<'de> for Few {
            type Value = Vec<(&'de str, &'de str)>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "at most {COMPONENTS_MAX} attributes")
            }

            /// Keeps one more than there may be, for the check to see, and never more.
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut kept = Vec::new();
                while let Some(attribute) = list.next_element()? {
                    if kept.len() <= COMPONENTS_MAX {
                        kept.push(attribute);
                    }
                }
                Ok(kept)
            }
        }

        deserializer.deserialize_seq(Few).map(Self)
    }
}

/// Numbers of 32 bits as their little-endian bytes.
#[derive(Debug)]
struct Numbers<'a>(Cow<'a, [u8]>);

impl Serialize for Numbers<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for Numbers<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        <&[u8]>::deserialize(deserializer).map(|bytes| Self(Cow::Borrowed(bytes)))
    }
}

impl Numbers<'_> {
    fn of_reals(numbers: &[f32]) -> Self {
        Self(Cow::Owned(numbers.iter().flat_map(|n| n.to_le_bytes()).collect()))
    }

    fn of_integers(numbers: &[u32]) -> Self {
        Self(Cow::Owned(numbers.iter().flat_map(|n| n.to_le_bytes()).collect()))
    }

    /// Rows of `N` numbers, each made of its four bytes.
    fn rows<const N: usize, T>(
        &self,
        number: impl Fn([u8; 4]) -> T,
        what: &str,
    ) -> Result<Vec<[T; N]>, String> {
        let (words, rest) = self.0.as_chunks::<4>();
        let (rows, more) = words.as_chunks::<N>();
        if !rest.is_empty() || !more.is_empty() {
            let (found, row) = (self.0.len(), 4 * N);
            return Err(format!("{what}: found {found} bytes, expected a multiple of {row}"));
        }
        Ok(rows.iter().map(|row| row.each_ref().map(|word| number(*word))).collect())
    }

    fn reals<const N: usize>(&self, what: &str) -> Result<Vec<[f32; N]>, String> {
        self.rows(f32::from_le_bytes, what)
    }

    fn integers<const N: usize>(&self, what: &str) -> Result<Vec<[u32; N]>, String> {
        self.rows(u32::from_le_bytes, what)
    }
}

/// Replaces `out` by the bytes of a command.
pub(super) fn encode(command: &Command, out: &mut Vec<u8>) {
    out.clear();
    let bytes = postcard::to_extend(&wire(command), std::mem::take(out));
    *out = bytes.expect("memory takes all");
}

fn wire(command: &Command) -> Wire<'_> {
    match command {
        Command::Header(Header { title, source, licence }) => {
            Wire::Header { title, source, licence }
        }
        Command::Frame(frame) => Wire::Frame {
            viewport: frame.viewport,
            view: frame.view,
            projection: frame.projection,
            minus_one_to_one: frame.depth == Depth::MinusOneToOne,
            clip_log2: frame.range.clip,
            object_log2: frame.range.object,
        },
        Command::Points(Points { id, source, resident }) => {
            Wire::Points { id: *id, resident: *resident, source: wire_source(source) }
        }
        Command::Attributes(Attributes { id, table, resident }) => Wire::Attributes {
            id: *id,
            resident: *resident,
            layout: WireLayout(
                table.layout.iter().map(|a| (a.name.as_str(), a.format.name())).collect(),
            ),
            values: Numbers::of_reals(&table.values),
        },
        Command::Tessellation(state) => Wire::Tessellation {
            criterion: match state.criterion {
                Criterion::Flatness { pixels } => WireCriterion::Flatness(pixels),
                Criterion::EdgeLength { pixels } => WireCriterion::EdgeLength(pixels),
                Criterion::Fixed { level } => WireCriterion::Fixed(level.fx16()),
            },
            min_level: state.min_level,
            max_level: state.max_level,
        },
        Command::Draw(draw) => wire_draw(draw),
        Command::End => Wire::End,
    }
}

fn wire_source(source: &PointSource) -> WireSource<'_> {
    match source {
        PointSource::Xyz(points) => WireSource::Xyz(Numbers::of_reals(points.as_flattened())),
        PointSource::Xyzw(points) => WireSource::Xyzw(Numbers::of_reals(points.as_flattened())),
        PointSource::File(file) => WireSource::File {
            name: &file.data().name,
            homogeneous: file.layout() == Layout::Xyzw,
            count: source.len(),
        },
    }
}

fn wire_draw(draw: &Draw) -> Wire<'_> {
    let indices = draw.indices.as_deref().map(|indices| WireIndices {
        four_bytes: indices.format == IndexFormat::Uint32,
        points: Numbers::of_integers(indices.points.as_flattened()),
        corners: Numbers::of_integers(indices.corners.as_flattened()),
    });
    Wire::Draw {
        primitive: match draw.primitive {
            Primitive::Patches { count } => WirePrimitive::Patches(count),
            Primitive::Mesh { rows, columns } => WirePrimitive::Mesh(rows, columns),
            Primitive::Strip { count } => WirePrimitive::Strip(count),
            Primitive::Fan { count, encoding: FanEncoding::Compact } => {
                WirePrimitive::FanCompact(count)
            }
            Primitive::Fan { count, encoding: FanEncoding::Full } => WirePrimitive::FanFull(count),
            Primitive::Indexed { count } => WirePrimitive::Indexed(count),
        },
        points: draw.points,
        first: draw.first,
        indices,
        attributes: draw.attributes,
        models: draw.models_sent.then(|| Numbers::of_reals(draw.models.as_flattened())),
        reversed: draw.reversed,
        cull: draw.cull,
    }
}

/// The command at the start of `bytes`, and how many of them it has. Files that it names are found
/// in the state's folder and noted there; the command itself is still to be checked.
///
/// # Errors
/// In words that say what was found and expected.
pub(super) fn decode(bytes: &[u8], state: &mut State) -> Result<(Command, usize), String> {
    let (wire, rest) = postcard::take_from_bytes::<Wire<'_>>(bytes)
        .map_err(|reason| format!("found bytes that are no command, expected one: {reason}"))?;
    Ok((command(wire, state)?, bytes.len() - rest.len()))
}

fn command(wire: Wire<'_>, state: &mut State) -> Result<Command, String> {
    Ok(match wire {
        Wire::Header { title, source, licence } => Command::Header(Header {
            title: title.into(),
            source: source.into(),
            licence: licence.into(),
        }),
        Wire::Frame { viewport, view, projection, minus_one_to_one, clip_log2, object_log2 } => {
            let depth = if minus_one_to_one { Depth::MinusOneToOne } else { Depth::ZeroToOne };
            let range = Range { clip: clip_log2, object: object_log2 };
            Command::Frame(Frame { viewport, view, projection, depth, range })
        }
        Wire::Points { id, resident, source } => {
            let source = Arc::new(point_source(&source, state)?);
            Command::Points(Points { id, source, resident })
        }
        Wire::Attributes { id, resident, layout, values } => {
            let layout = layout.0.into_iter().map(attribute).collect::<Result<_, _>>()?;
            let values = values.reals::<1>("values")?.into_flattened();
            let table = Arc::new(AttributeTable { layout, values });
            Command::Attributes(Attributes { id, table, resident })
        }
        Wire::Tessellation { criterion, min_level, max_level } => {
            let criterion = match criterion {
                WireCriterion::Flatness(pixels) => Criterion::Flatness { pixels },
                WireCriterion::EdgeLength(pixels) => Criterion::EdgeLength { pixels },
                WireCriterion::Fixed(fx16) => Criterion::Fixed { level: level(fx16)? },
            };
            Command::Tessellation(Tessellation { criterion, min_level, max_level })
        }
        Wire::Draw { primitive, points, first, indices, attributes, models, reversed, cull } => {
            let models_sent = models.is_some();
            Command::Draw(Draw {
                primitive: wired_primitive(&primitive),
                points,
                first,
                indices: indices.map(|i| wired_indices(&i)).transpose()?.map(Arc::new),
                attributes,
                models: models.map_or(Ok(vec![IDENTITY]), |models| models.reals("model"))?,
                models_sent,
                reversed,
                cull,
            })
        }
        Wire::End => Command::End,
    })
}

fn level(fx16: u32) -> Result<Level, String> {
    let level = Level::clamped(fx16.into());
    if level.fx16() == fx16 {
        return Ok(level);
    }
    let found = f64::from(fx16) / 65536.0;
    Err(format!("level: found {found}, expected a level from 1 to 128"))
}

fn attribute((name, format): (&str, &str)) -> Result<Attribute, String> {
    let unknown = || {
        let found = snippet(format);
        format!("layout: found the format {found:?}, expected one of wgpu's that interpolate")
    };
    let format = AttributeFormat::named(format).ok_or_else(unknown)?;
    Ok(Attribute { name: name.into(), format })
}

fn wired_primitive(primitive: &WirePrimitive) -> Primitive {
    match *primitive {
        WirePrimitive::Patches(count) => Primitive::Patches { count },
        WirePrimitive::Mesh(rows, columns) => Primitive::Mesh { rows, columns },
        WirePrimitive::Strip(count) => Primitive::Strip { count },
        WirePrimitive::FanCompact(count) => {
            Primitive::Fan { count, encoding: FanEncoding::Compact }
        }
        WirePrimitive::FanFull(count) => Primitive::Fan { count, encoding: FanEncoding::Full },
        WirePrimitive::Indexed(count) => Primitive::Indexed { count },
    }
}

fn wired_indices(wire: &WireIndices<'_>) -> Result<Indices, String> {
    let format = if wire.four_bytes { IndexFormat::Uint32 } else { IndexFormat::Uint16 };
    let (points, corners) =
        (wire.points.integers("indices")?, wire.corners.integers("attribute_indices")?);
    Ok(Indices { format, points, corners })
}

fn point_source(wire: &WireSource<'_>, state: &mut State) -> Result<PointSource, String> {
    match *wire {
        WireSource::Xyz(ref numbers) => numbers.reals("points.xyz").map(PointSource::Xyz),
        WireSource::Xyzw(ref numbers) => numbers.reals("points.xyzw").map(PointSource::Xyzw),
        WireSource::File { name, homogeneous, count } => {
            let refuse = |what: String| {
                let found = snippet(name);
                format!("points.file: found {found:?}, expected {what}")
            };
            let layout = if homogeneous { Layout::Xyzw } else { Layout::Xyz };
            let data = DataFile::find(&state.folder, name).map_err(refuse)?;
            state.files.insert(data.name.clone(), data.clone());
            PointFile::open(data, layout, count).map(PointSource::File).map_err(refuse)
        }
    }
}
