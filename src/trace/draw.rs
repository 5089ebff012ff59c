//! Draw: the text of a draw in, the draw out, checked against the frame, the points and the
//! attributes that came before.

use super::check::{self, Lack, PATCHES_MAX};
use super::command::{Command, Draw, FanEncoding, Primitive};
use super::field::{Object, choice, flag, integer, integer32, matrix};
use super::indices::{Indices, indices};
use super::json::{Fault, Found, Value};
use super::state::State;
use std::sync::Arc;

const FIELDS: &[&str] = &[
    "primitive",
    "points",
    "first",
    "count",
    "rows",
    "columns",
    "encoding",
    "indices",
    "index_format",
    "attributes",
    "attribute_indices",
    "model",
    "instances",
    "front",
    "cull",
];

#[derive(Clone, Copy)]
enum Kind {
    Patches,
    Strip,
    Fan,
    Mesh,
    IndexedMesh,
}

const KINDS: [(&str, Kind); 5] = [
    ("patches", Kind::Patches),
    ("strip", Kind::Strip),
    ("fan", Kind::Fan),
    ("mesh", Kind::Mesh),
    ("indexed_mesh", Kind::IndexedMesh),
];

/// The fields that only some primitives have, and which those are.
const OWN: [(&str, &[&str]); 7] = [
    ("count", &["patches", "strip", "fan"]),
    ("rows", &["mesh"]),
    ("columns", &["mesh"]),
    ("encoding", &["fan"]),
    ("indices", &["indexed_mesh"]),
    ("index_format", &["indexed_mesh"]),
    ("attribute_indices", &["indexed_mesh"]),
];

pub(crate) fn draw(value: Value<'_>, state: &State) -> Found<Command> {
    let object = Object::read(value, FIELDS)?;
    if !state.in_frame {
        return Err(value.refuse("found a draw before any frame, expected a frame first"));
    }
    let (primitive, indices) = primitive(&object)?;
    let buffer = object.require("points", "the id of points")?;
    let points = integer32(buffer, 0, u32::MAX)?;
    let first = object.get("first").map_or(Ok(0), |v| integer(v, 0, u64::MAX))?;
    let indices = indices.as_ref();
    check::enough_points(primitive, indices, (points, first), state)
        .map_err(|l| lack(buffer, l))?;
    let attributes = attributes(&object, primitive, indices, state)?;
    let (models, models_sent) = models(&object)?;
    let front = object.get("front").map(|v| choice(v, &[("normal", false), ("reversed", true)]));
    let cull = object.get("cull").map_or(Ok(true), flag)?;
    let reversed = front.transpose()?.unwrap_or(false);
    let indices = indices.cloned().map(Arc::new);
    Ok(Command::Draw(Draw {
        primitive,
        points,
        first,
        indices,
        attributes,
        models,
        models_sent,
        reversed,
        cull,
    }))
}

fn primitive(object: &Object<'_>) -> Found<(Primitive, Option<Indices>)> {
    let expected = "\"patches\", \"strip\", \"fan\", \"mesh\" or \"indexed_mesh\"";
    let named = object.require("primitive", expected)?;
    let kind = choice(named, &KINDS)?;
    let name = named.string(expected)?;
    for (field, owners) in OWN {
        if !owners.contains(&&*name) {
            object.forbid(field, &format!("which the primitive \"{name}\" has not"))?;
        }
    }
    let size = |name| integer(object.require(name, "how many patches")?, 1, PATCHES_MAX);
    Ok((
        match kind {
            Kind::Patches => Primitive::Patches { count: size("count")? },
            Kind::Strip => Primitive::Strip { count: size("count")? },
            Kind::Fan => {
                let encodings = [("compact", FanEncoding::Compact), ("full", FanEncoding::Full)];
                let encoding = object.get("encoding").map(|v| choice(v, &encodings)).transpose()?;
                Primitive::Fan { count: size("count")?, encoding: encoding.unwrap_or_default() }
            }
            Kind::Mesh => {
                let (rows, columns) = (size("rows")?, size("columns")?);
                if rows * columns > PATCHES_MAX {
                    let message = format!(
                        "found {rows} rows of {columns} patches, expected at most {PATCHES_MAX} \
                         patches a draw"
                    );
                    return Err(object.require("columns", "")?.refuse(message));
                }
                // Both are at most 2^24.
                Primitive::Mesh { rows: rows as u32, columns: columns as u32 }
            }
            Kind::IndexedMesh => {
                let indices = indices(object, PATCHES_MAX)?;
                let count = indices.points.len() as u64;
                return Ok((Primitive::Indexed { count }, Some(indices)));
            }
        },
        None,
    ))
}

/// A lack, at the value that names the id.
fn lack(value: Value<'_>, lack: Lack) -> Fault {
    match lack {
        Lack::Unknown(expected) => value.expected(expected),
        Lack::Few(reason) => value.refuse(reason),
    }
}

/// The id of the draw's attributes, of which it has enough.
fn attributes(
    object: &Object<'_>,
    primitive: Primitive,
    indices: Option<&Indices>,
    state: &State,
) -> Found<Option<u32>> {
    let Some(value) = object.get("attributes") else {
        object.forbid("attribute_indices", "which go with `attributes`")?;
        return Ok(None);
    };
    let id = integer32(value, 0, u32::MAX)?;
    check::known_corners(id, state).map_err(|l| lack(value, l))?;
    if let Some(indices) = indices {
        let list = object.require("attribute_indices", "four corners a patch")?;
        check::enough_corner_rows(indices).map_err(|reason| list.refuse(reason))?;
    }
    check::enough_corners(primitive, indices, id, state).map_err(|l| lack(value, l))?;
    Ok(Some(id))
}

/// The models, and whether the trace gave them.
fn models(object: &Object<'_>) -> Found<(Vec<[f32; 16]>, bool)> {
    if let Some(list) = object.get("instances") {
        object.forbid("model", "which `instances` excludes")?;
        if let Some(models) =
            serde_json::from_str::<Vec<_>>(list.text).ok().filter(|m| !m.is_empty())
        {
            return Ok((models, true));
        }
        // What is wrong with them, element by element.
        let mut models = Vec::new();
        list.elements("an array of matrices", |_, element| {
            models.push(matrix(element)?);
            Ok(())
        })?;
        if models.is_empty() {
            return Err(list.expected("at least one matrix"));
        }
        return Ok((models, true));
    }
    match object.get("model") {
        Some(model) => Ok((vec![matrix(model)?], true)),
        None => Ok((vec![super::command::IDENTITY], false)),
    }
}
