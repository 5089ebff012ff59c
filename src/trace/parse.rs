//! Parse: the text of a line in, a checked command out. One function a command, in the order of the
//! format.
//!
//! Numbers that a unit compares with others are quantised here, once: pixels to UQ16.16, levels to
//! UQ8.16, both to nearest-even.

use super::check::{RANGE_LOG2_MAX, VIEWPORT_MAX};
use super::command::{Attributes, Command, Frame, Header, Points, Range, Tessellation};
use super::field::{Object, choice, flag, integer, integer32, invertible, real32, real64, unknown};
use super::json::{Found, Value};
use super::points::{DataFile, Layout, PointFile, PointSource};
use super::state::State;
use super::{attributes, draw};
use rtl_model::level::Criterion;
use rtl_model::patch::{Depth, Level};
use std::sync::Arc;

/// The version of the format.
pub(crate) const VERSION: u64 = 1;

const HEADER: &[&str] = &["tessim", "title", "source", "licence"];
const COMMANDS: &[&str] = &["frame", "points", "attributes", "tessellation", "draw", "end"];

/// The command of the first line, which must be the header.
pub(crate) fn first(line: &str) -> Found<Command> {
    let (key, _) = only_entry(line, true)?;
    if COMMANDS.contains(&&*key.string("a name")?) {
        return Err(key.expected("the header, {\"tessim\":1,...}, on the first line"));
    }
    let object = Object::read(Value::line(line), HEADER)?;
    let version = object.require("tessim", "the version of the format, 1")?;
    if integer(version, 0, u64::MAX).ok() != Some(VERSION) {
        return Err(version.expected("1, the only version of the format known here"));
    }
    let text = |name| match object.get(name) {
        Some(value) => value.string("a string").map(String::from),
        None => Ok(String::new()),
    };
    let header =
        Header { title: text("title")?, source: text("source")?, licence: text("licence")? };
    Ok(Command::Header(header))
}

/// The command of any line but the first.
pub(crate) fn command(line: &str, state: &mut State) -> Found<Command> {
    let (key, value) = only_entry(line, false)?;
    let name = key.string("a name")?;
    match &*name {
        "frame" => frame(value, state),
        "points" => points(value, state),
        "tessellation" => tessellation(value),
        "draw" => draw::draw(value, state),
        "end" => Object::read(value, &[]).map(|_| Command::End),
        "attributes" => attributes(value, state),
        header if HEADER.contains(&header) => {
            Err(key.expected("a command; the header stands on the first line and only there"))
        }
        _ => Err(unknown("command", key, &name, COMMANDS)),
    }
}

/// The first entry of the line's object, and its only one unless `several` are allowed. Reads all
/// of the line, so that what follows need not care for its syntax.
fn only_entry(line: &str, several: bool) -> Found<(Value<'_>, Value<'_>)> {
    let whole = Value::line(line);
    let mut entry = None;
    let mut second = None;
    whole.entries("a command, which is an object such as {\"end\":{}}", |key, value| {
        if entry.is_none() {
            entry = Some((key, value));
        } else if !several && second.is_none() {
            second = Some(key);
        }
        Ok(())
    })?;
    if let Some(key) = second {
        return Err(key.expected("the end of the object, as a line holds one command"));
    }
    entry.ok_or_else(|| whole.expected("an object with one command"))
}

fn frame(value: Value<'_>, state: &mut State) -> Found<Command> {
    let object = Object::read(value, &["viewport", "view", "projection", "depth", "range"])?;
    let viewport = viewport(object.require("viewport", "[width, height] in pixels")?)?;
    let view = invertible(object.require("view", "a matrix of 16 numbers, column-major")?)?;
    let projection =
        invertible(object.require("projection", "a matrix of 16 numbers, column-major")?)?;
    let depths = [("zero_to_one", Depth::ZeroToOne), ("minus_one_to_one", Depth::MinusOneToOne)];
    let depth = object.get("depth").map(|v| choice(v, &depths)).transpose()?.unwrap_or_default();
    let range = object.get("range").map(range).transpose()?.unwrap_or_default();
    let command = Command::Frame(Frame { viewport, view, projection, depth, range });
    state.define(&command);
    Ok(command)
}

fn viewport(value: Value<'_>) -> Found<[u32; 2]> {
    const WHAT: &str = "[width, height] in pixels";
    let mut sides = [0; 2];
    let mut count = 0;
    value.elements(WHAT, |i, element| {
        let side = sides.get_mut(i).ok_or_else(|| element.expected("width and height only"))?;
        *side = integer32(element, 1, VIEWPORT_MAX)?;
        count = i + 1;
        Ok(())
    })?;
    if count < 2 { Err(value.expected(WHAT)) } else { Ok(sides) }
}

fn range(value: Value<'_>) -> Found<Range> {
    let object = Object::read(value, &["clip", "object"])?;
    let power = |name| object.get(name).map(power_of_two).transpose();
    Ok(Range { clip: power("clip")?, object: power("object")? })
}

/// The logarithm of a power of two.
fn power_of_two(value: Value<'_>) -> Found<i32> {
    const WHAT: &str = "a power of two from 2^-64 to 2^64";
    let number = real64(value, WHAT, |n| n > 0.0)?;
    (-RANGE_LOG2_MAX..=RANGE_LOG2_MAX)
        .find(|log2| number == 2f64.powi(*log2))
        .ok_or_else(|| value.expected(WHAT))
}

const POINT_FIELDS: &[&str] = &["id", "xyz", "xyzw", "file", "layout", "count", "resident"];

fn points(value: Value<'_>, state: &mut State) -> Found<Command> {
    let object = Object::read(value, POINT_FIELDS)?;
    let id = integer32(object.require("id", "an integer that draws name")?, 0, u32::MAX)?;
    let resident = object.get("resident").map(flag).transpose()?.unwrap_or(false);
    let source = match (object.get("xyz"), object.get("xyzw"), object.get("file")) {
        (Some(rows), None, None) => PointSource::Xyz(inline(rows)?),
        (None, Some(rows), None) => PointSource::Xyzw(inline(rows)?),
        (None, None, Some(name)) => PointSource::File(point_file(name, &object, state)?),
        (None, None, None) => {
            return Err(value.refuse("the points are missing, expected `xyz`, `xyzw` or `file`"));
        }
        _ => return Err(value.refuse("found several of `xyz`, `xyzw` and `file`, expected one")),
    };
    if source.file().is_none() {
        object.forbid("layout", "which only points in a `file` have")?;
        object.forbid("count", "which only points in a `file` have")?;
    }
    let command = Command::Points(Points { id, source: Arc::new(source), resident });
    state.define(&command);
    Ok(command)
}

fn inline<const N: usize>(value: Value<'_>) -> Found<Vec<[f32; N]>> {
    let what = if N == 3 { "a point [x, y, z]" } else { "a point [x w, y w, z w, w]" };
    let mut rows = Vec::new();
    value.elements("an array of points", |_, row| {
        let mut point = [0.0; N];
        let mut count = 0;
        row.elements(what, |i, element| {
            let number = point.get_mut(i).ok_or_else(|| row.expected(format_args!("{what}")))?;
            *number = real32(element)?;
            if i == 3 && *number <= 0.0 {
                return Err(element.expected("a weight above 0"));
            }
            count = i + 1;
            Ok(())
        })?;
        if count < N {
            return Err(row.expected(what));
        }
        rows.push(point);
        Ok(())
    })?;
    if rows.is_empty() { Err(value.expected("at least one point")) } else { Ok(rows) }
}

fn point_file(name: Value<'_>, object: &Object<'_>, state: &mut State) -> Found<PointFile> {
    let layouts = [("xyz", Layout::Xyz), ("xyzw", Layout::Xyzw)];
    let text = name.string("the name of a file in the trace's folder")?;
    let layout = choice(object.require("layout", "\"xyz\" or \"xyzw\"")?, &layouts)?;
    let count = integer(object.require("count", "the number of points")?, 1, u64::MAX)?;
    let refuse = |what: String| name.expected(what);
    let data = DataFile::find(&state.folder, &text).map_err(refuse)?;
    state.files.insert(data.name.clone(), data.clone());
    PointFile::open(data, layout, count).map_err(refuse)
}

fn attributes(value: Value<'_>, state: &mut State) -> Found<Command> {
    let (id, table, resident) = attributes::attributes(value)?;
    let command = Command::Attributes(Attributes { id, table: Arc::new(table), resident });
    state.define(&command);
    Ok(command)
}

/// The state that `value` sets: all of it, with the defaults for what it leaves out.
fn tessellation(value: Value<'_>) -> Found<Command> {
    let fields = &["criterion", "pixels", "level", "min_level", "max_level"];
    let object = Object::read(value, fields)?;
    let default = Tessellation::default();
    let level_or = |name, default| object.get(name).map_or(Ok(default), level);
    let min_level = level_or("min_level", default.min_level)?;
    let max_level = level_or("max_level", default.max_level)?;
    if let (Some(least), true) = (object.get("min_level"), min_level > max_level) {
        return Err(least.expected(format_args!(
            "at most max_level, which is {}",
            f64::from(max_level) / 65536.0
        )));
    }
    let criterion = criterion(&object)?.unwrap_or(default.criterion);
    Ok(Command::Tessellation(Tessellation { criterion, min_level, max_level }))
}

#[derive(Clone, Copy)]
enum Kind {
    Flatness,
    EdgeLength,
    Fixed,
}

fn criterion(object: &Object<'_>) -> Found<Option<Criterion>> {
    let kinds =
        [("flatness", Kind::Flatness), ("edge_length", Kind::EdgeLength), ("fixed", Kind::Fixed)];
    let named = object.get("criterion").map(|v| choice(v, &kinds)).transpose()?;
    if let Some(Kind::Fixed) = named {
        object.forbid("pixels", "which the criterion \"fixed\" has not")?;
        let level = level(object.require("level", "a number from 1 to 128 with \"fixed\"")?)?;
        return Ok(Some(Criterion::Fixed { level: Level::clamped(level.into()) }));
    }
    object.forbid("level", "which only the criterion \"fixed\" has")?;
    let pixels = match (object.get("pixels"), named) {
        (None, None) => return Ok(None),
        (None, Some(_)) => object.require("pixels", "a number above 0 with this criterion")?,
        (Some(value), _) => value,
    };
    let pixels = pixels_fx16(pixels)?;
    Ok(Some(match named {
        Some(Kind::EdgeLength) => Criterion::EdgeLength { pixels },
        _ => Criterion::Flatness { pixels },
    }))
}

/// UQ16.16, at least 1 ulp, saturated at the greatest.
fn pixels_fx16(value: Value<'_>) -> Found<u32> {
    let pixels = real64(value, "a number of pixels above 0", |n| n > 0.0)?;
    Ok(((pixels * 65536.0).round_ties_even() as u32).max(1))
}

/// UQ8.16.
fn level(value: Value<'_>) -> Found<u32> {
    let level = real64(value, "a level from 1 to 128", |n| (1.0..=128.0).contains(&n))?;
    Ok((level * 65536.0).round_ties_even() as u32)
}
