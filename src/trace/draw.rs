//! Draw: the text of a draw in, the draw out, checked against the frame and the points that came
//! before.

use super::command::{Command, Draw, Primitive};
use super::field::unsupported;
use super::field::{Object, choice, flag, integer, integer32, matrix};
use super::json::{Found, Value};
use super::state::State;

/// The most patches of one instance.
const PATCHES_MAX: u64 = 1 << 24;

const FIELDS: &[&str] = &[
    "primitive",
    "points",
    "first",
    "count",
    "rows",
    "columns",
    "model",
    "instances",
    "front",
    "cull",
];

/// Fields that the format knows and this version does not.
const LATER: &[&str] = &["attributes", "encoding", "indices", "index_format", "attribute_indices"];

#[derive(Clone, Copy)]
enum Kind {
    Patches,
    Mesh,
    Later,
}

const KINDS: [(&str, Kind); 5] = [
    ("patches", Kind::Patches),
    ("mesh", Kind::Mesh),
    ("strip", Kind::Later),
    ("fan", Kind::Later),
    ("indexed_mesh", Kind::Later),
];

pub(crate) fn draw(value: Value<'_>, state: &State) -> Found<Command> {
    let object = Object::read_with(value, FIELDS, LATER)?;
    refuse_later(&object)?;
    if !state.in_frame {
        return Err(value.refuse("found a draw before any frame, expected a frame first"));
    }
    let primitive = primitive(&object)?;
    let points = integer32(object.require("points", "the id of points")?, 0, u32::MAX)?;
    let first = object.get("first").map_or(Ok(0), |v| integer(v, 0, u64::MAX))?;
    check_points(&object, primitive, points, first, state)?;
    let (models, models_sent) = models(&object)?;
    let front = object.get("front").map(|v| choice(v, &[("normal", false), ("reversed", true)]));
    let cull = object.get("cull").map_or(Ok(true), flag)?;
    let reversed = front.transpose()?.unwrap_or(false);
    Ok(Command::Draw(Draw { primitive, points, first, models, models_sent, reversed, cull }))
}

/// Says of a draw that a later version can do that it is that.
fn refuse_later(object: &Object<'_>) -> Found<()> {
    match object.get("primitive") {
        Some(value) if matches!(choice(value, &KINDS), Ok(Kind::Later)) => Err(unsupported(value)),
        _ => match LATER.iter().find_map(|name| object.key(name)) {
            Some(key) => Err(unsupported(key)),
            None => Ok(()),
        },
    }
}

fn primitive(object: &Object<'_>) -> Found<Primitive> {
    let size = |name| integer(object.require(name, "how many patches")?, 1, PATCHES_MAX);
    let kind = object.require("primitive", "\"patches\" or \"mesh\"")?;
    match choice(kind, &KINDS)? {
        Kind::Patches => {
            object.forbid("rows", "which the primitive \"patches\" has not")?;
            object.forbid("columns", "which the primitive \"patches\" has not")?;
            Ok(Primitive::Patches { count: size("count")? })
        }
        Kind::Mesh => {
            object.forbid("count", "which the primitive \"mesh\" has not")?;
            let (rows, columns) = (size("rows")?, size("columns")?);
            if rows * columns > PATCHES_MAX {
                let message = format!(
                    "found {rows} rows of {columns} patches, expected at most {PATCHES_MAX} \
                     patches a draw"
                );
                return Err(object.require("columns", "")?.refuse(message));
            }
            // Both are at most 2^24.
            Ok(Primitive::Mesh { rows: rows as u32, columns: columns as u32 })
        }
        Kind::Later => Err(unsupported(kind)),
    }
}

fn check_points(
    object: &Object<'_>,
    primitive: Primitive,
    id: u32,
    first: u64,
    state: &State,
) -> Found<()> {
    let value = object.require("points", "the id of points")?;
    let Some(&held) = state.points.get(&id) else {
        return Err(value.expected(format_args!("the id of points ({})", state.ids())));
    };
    let used = primitive.points();
    if first.checked_add(used).is_some_and(|end| end <= held) {
        return Ok(());
    }
    let from = if first == 0 { String::new() } else { format!(" from point {first} on") };
    Err(value.refuse(format!(
        "found {held} points under id {id}, expected at least {used}{from} for {} patches",
        primitive.patches()
    )))
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
