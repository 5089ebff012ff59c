//! Fast: long `points` lines, nearly all the bytes of a large trace, read in one pass.
//!
//! [`super::parse`] takes a line apart by its raw values, which costs three passes over its numbers
//! and tells exactly what is wrong with it. Here `serde_json` goes straight from digits to
//! coordinates. What is accepted here means the same there; what is refused here, for whatever
//! reason, is left to the other to accept or explain.

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

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::super::state::State;
    use super::*;
    use proptest::prelude::*;

    fn slow(line: &str) -> Option<Command> {
        parse::command(line, &mut State::new(".".into())).ok()
    }

    /// Numbers and what is nearly one, as text.
    fn number() -> impl Strategy<Value = String> {
        prop_oneof![
            8 => any::<f32>().prop_map(|n| format!("{n:e}")),
            8 => any::<f64>().prop_map(|n| format!("{n:e}")),
            8 => (-99i32..99).prop_map(|n| n.to_string()),
            1 => "(null|\"1\"|1e39|-0|1e-60|01|[1])",
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_fast_way_and_the_thorough_one_agree(
            rows in prop::collection::vec(prop::collection::vec(number(), 3..=4), 1..4),
            name in "(xyz|xyzw)",
            rest in r#"(|,"resident":(true|null)|,"(id|count)":1|} |,"xyz":null)"#,
        ) {
            let rows: Vec<_> = rows.iter().map(|r| format!("[{}]", r.join(","))).collect();
            let line = format!(r#"{{"points":{{"id":0,"{name}":[{}]{rest}}}}}"#, rows.join(","));
            prop_assert_eq!(points(&line), slow(&line), "{}", line);
        }
    }

    #[test]
    fn a_plain_line_goes_the_fast_way() {
        let line = r#"{"points":{"id":3,"xyzw":[[1,-2.5,3e4,0.1],[0,0,0,1]],"resident":true}}"#;
        assert!(points(line).is_some());
        assert_eq!(points(line), slow(line));
    }

    #[test]
    fn what_is_out_of_the_ordinary_does_not() {
        for line in [
            r#"{"points":{"id":3,"xyz":[]}}"#,
            r#"{"points":{"id":3,"xyz":null,"xyzw":[[0,0,0,1]]}}"#,
            r#"{"points":{"id":3,"xyzw":[[0,0,0,0]]}}"#,
            r#"{"points":{"id":3,"file":"a","layout":"xyz","count":1}}"#,
            r#"{"points":{"id":3,"xyz":[[0,0,1e39]]}}"#,
            r#"{"points":{"id":3,"xyz":[[0,0,1]]},"end":{}}"#,
        ] {
            assert_eq!(points(line), None, "{line}");
        }
    }
}
