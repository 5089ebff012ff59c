//! Fast: long `points` lines, nearly all the bytes of a large trace, read in one pass.
//!
//! [`super::parse`] takes a line apart by its raw values, which costs three passes over its numbers and tells exactly what is
//! wrong with it. Here `serde_json` goes straight from digits to coordinates. What is accepted here means the same
//! there; what is refused here, for whatever reason, is left to the other to accept or explain.

use super::command::{Command, Points};
use super::points::PointSource;
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::sync::Arc;

/// The command of a `points` line with inline points, or `None` where a closer look is needed.
pub(crate) fn points(line: &str) -> Option<Command> {
    if !line.starts_with(r#"{"points":{"#) {
        return None;
    }
    let Line { points: body } = serde_json::from_str(line).ok()?;
    let source = match (body.xyz, body.xyzw) {
        (Some(Rows(rows)), None) => PointSource::Xyz(rows),
        (None, Some(Rows(rows))) => PointSource::Xyzw(rows),
        _ => return None,
    };
    Some(Command::Points(Points { id: body.id, source: Arc::new(source), resident: body.resident }))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    points: Body,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Body {
    id: u32,
    #[serde(default, deserialize_with = "present")]
    xyz: Option<Rows<3>>,
    #[serde(default, deserialize_with = "present")]
    xyzw: Option<Rows<4>>,
    #[serde(default)]
    resident: bool,
}

/// `Option` alone would take `null` for an absent field.
fn present<'de, D: Deserializer<'de>, const N: usize>(
    json: D,
) -> Result<Option<Rows<N>>, D::Error> {
    Rows::deserialize(json).map(Some)
}

/// Points of `N` finite numbers, at least one; a fourth number is a weight, above 0.
struct Rows<const N: usize>(Vec<[f32; N]>);

impl<'de, const N: usize> Deserialize<'de> for Rows<N> {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        json.deserialize_seq(RowsVisitor)
    }
}

struct RowsVisitor<const N: usize>;

impl<'de, const N: usize> Visitor<'de> for RowsVisitor<N> {
    type Value = Rows<N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("points")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Rows<N>, A::Error> {
        let mut rows = Vec::new();
        while let Some(Row(row)) = seq.next_element()? {
            rows.push(row);
        }
        if rows.is_empty() { Err(A::Error::custom("no points")) } else { Ok(Rows(rows)) }
    }
}

struct Row<const N: usize>([f32; N]);

impl<'de, const N: usize> Deserialize<'de> for Row<N> {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        json.deserialize_seq(RowVisitor)
    }
}

struct RowVisitor<const N: usize>;

impl<'de, const N: usize> Visitor<'de> for RowVisitor<N> {
    type Value = Row<N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a point")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Row<N>, A::Error> {
        let mut row = [0.0; N];
        for (i, number) in row.iter_mut().enumerate() {
            let read: Option<f32> = seq.next_element()?;
            *number = read.ok_or_else(|| A::Error::custom("too few"))?;
            if !number.is_finite() || i == 3 && *number <= 0.0 {
                return Err(A::Error::custom("not a coordinate or weight"));
            }
        }
        // One number more than a point has is an error of `serde_json` when the array is closed.
        Ok(Row(row))
    }
}
