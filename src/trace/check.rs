//! Check: what every command of a trace must satisfy, whichever form it was read from. A command
//! and what came before it in; why it is refused out, in words that say what was found and what was
//! expected.
//!
//! The reader of the binary form hands whole commands to [`command`]. The reader of the text form,
//! which refuses each number where it stands in its line, asks the same predicates one by one.

use super::command::{Command, Draw, Frame, IDENTITY, Primitive, Tessellation};
use super::field::has_inverse;
use super::indices::Indices;
use super::points::PointSource;
use super::state::{State, ids};
use crate::attribute::{AttributeFormat, AttributeTable, COMPONENTS_MAX};
use rtl_model::level::Criterion;
use std::ops::RangeInclusive;

/// The longest side of a viewport, in pixels.
pub(crate) const VIEWPORT_MAX: u32 = 16384;
/// Powers of two that a range may be: 2^-64 to 2^64.
pub(crate) const RANGE_LOG2_MAX: i32 = 64;
/// The most patches of one instance.
pub(crate) const PATCHES_MAX: u64 = 1 << 24;
/// The most bytes of an attribute's name.
pub(crate) const NAME_MAX: usize = 64;
/// Levels, UQ8.16.
const LEVELS_FX16: RangeInclusive<u32> = 1 << 16..=128 << 16;

/// Results of a check: the reason, where it fails.
pub(crate) type Checked = Result<(), String>;

/// Why a draw cannot use the points or the attributes under an id.
#[derive(Debug)]
pub(crate) enum Lack {
    /// There are none under this id; in words that follow "expected".
    Unknown(String),
    /// There are too few; the whole reason.
    Few(String),
}

impl Lack {
    /// The whole reason, where `id` is the one that was found.
    fn reason(self, id: u32) -> String {
        match self {
            Self::Unknown(expected) => format!("found {id}, expected {expected}"),
            Self::Few(reason) => reason,
        }
    }
}

/// Checks all of a command that does not depend on its place in the trace, and that what it names
/// is there.
pub(crate) fn command(command: &Command, state: &State) -> Checked {
    match command {
        Command::Header(_) | Command::End => Ok(()),
        Command::Frame(command) => frame(command),
        Command::Points(command) => points(&command.source).map_err(|e| format!("points: {e}")),
        Command::Attributes(command) => table(&command.table),
        Command::Tessellation(command) => tessellation(command),
        Command::Draw(command) => draw(command, state),
    }
}

fn frame(frame: &Frame) -> Checked {
    let sides = 1..=VIEWPORT_MAX;
    if let Some(side) = frame.viewport.into_iter().find(|side| !sides.contains(side)) {
        return Err(format!("viewport: found {side}, expected 1 to {VIEWPORT_MAX}"));
    }
    for (name, matrix) in [("view", &frame.view), ("projection", &frame.projection)] {
        finite(matrix).map_err(|e| format!("{name}: {e}"))?;
        if !has_inverse(matrix) {
            return Err(format!("{name}: found a singular matrix, expected one with an inverse"));
        }
    }
    let powers = -RANGE_LOG2_MAX..=RANGE_LOG2_MAX;
    match [frame.range.clip, frame.range.object].into_iter().flatten().find(|n| !powers.contains(n))
    {
        Some(log2) => Err(format!("range: found 2^{log2}, expected 2^-64 to 2^64")),
        None => Ok(()),
    }
}

fn finite(numbers: &[f32]) -> Checked {
    match numbers.iter().position(|n| !n.is_finite()) {
        None => Ok(()),
        Some(k) => Err(format!("found {} as number {k}, expected a finite number", numbers[k])),
    }
}

fn points(source: &PointSource) -> Checked {
    if source.is_empty() {
        return Err("found none, expected at least one point".into());
    }
    match source {
        PointSource::Xyz(points) => finite(points.as_flattened()),
        PointSource::Xyzw(points) => {
            finite(points.as_flattened())?;
            match points.iter().position(|point| point[3] <= 0.0) {
                None => Ok(()),
                Some(k) => Err(format!(
                    "found the weight {} of point {k}, expected a weight above 0",
                    points[k][3]
                )),
            }
        }
        // A file's numbers are checked as they are read.
        PointSource::File(_) => Ok(()),
    }
}

/// Whether an attribute may be called so.
pub(crate) fn is_attribute_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    let word = name.starts_with(letter) && name.chars().all(|c| letter(c) || c.is_ascii_digit());
    word && name.len() <= NAME_MAX
}

fn table(table: &AttributeTable) -> Checked {
    let (layout, values) = (&table.layout, &table.values);
    let components = table.components();
    if !(1..=COMPONENTS_MAX).contains(&components) {
        return Err(format!("layout: found {components} components, expected 1 to 64"));
    }
    for (k, attribute) in layout.iter().enumerate() {
        let name = &attribute.name;
        if !is_attribute_name(name) || layout[..k].iter().any(|before| before.name == *name) {
            let shown = super::json::snippet(name);
            return Err(format!(
                "layout: found the name {shown:?}, expected letters, digits and underscores, not \
                 starting with a digit, at most {NAME_MAX}, that no other attribute has"
            ));
        }
    }
    if values.is_empty() || !values.len().is_multiple_of(components) {
        let found = values.len();
        return Err(format!("values: found {found}, expected {components} for each corner"));
    }
    let repeated = |format: AttributeFormat| std::iter::repeat_n(format, format.components());
    let formats: Vec<_> = layout.iter().flat_map(|a| repeated(a.format)).collect();
    for (corner, row) in values.chunks_exact(components).enumerate() {
        for (value, format) in row.iter().zip(&formats) {
            if !format.has(*value) {
                let name = format.name();
                return Err(format!(
                    "values: found {value} in corner {corner}, expected a value of {name}"
                ));
            }
        }
    }
    Ok(())
}

fn tessellation(state: &Tessellation) -> Checked {
    let (least, most) = (state.min_level, state.max_level);
    if !LEVELS_FX16.contains(&least) || !LEVELS_FX16.contains(&most) || least > most {
        let [least, most] = [least, most].map(|fx16| f64::from(fx16) / 65536.0);
        return Err(format!(
            "found levels from {least} to {most}, expected 1 <= min_level <= max_level <= 128"
        ));
    }
    match state.criterion {
        Criterion::Flatness { pixels: 0 } | Criterion::EdgeLength { pixels: 0 } => {
            Err("pixels: found 0, expected a number of pixels above 0".into())
        }
        // A level is one from 1 to 128 by its type.
        _ => Ok(()),
    }
}

fn draw(draw: &Draw, state: &State) -> Checked {
    if !state.in_frame {
        return Err("found a draw before any frame, expected a frame first".into());
    }
    primitive(draw.primitive)?;
    let indices = draw.indices.as_deref();
    match (draw.primitive, indices) {
        (Primitive::Indexed { count }, Some(indices)) => index_rows(indices, count)?,
        (Primitive::Indexed { .. }, None) => {
            return Err("indices: found none, expected 16 a patch".into());
        }
        (_, Some(_)) => return Err("indices: found some, expected none with this primitive".into()),
        (_, None) => {}
    }
    enough_points(draw.primitive, indices, (draw.points, draw.first), state)
        .map_err(|lack| format!("points: {}", lack.reason(draw.points)))?;
    match (draw.attributes, indices) {
        (Some(id), _) => {
            if let Some(indices) = indices {
                enough_corner_rows(indices).map_err(|e| format!("attribute_indices: {e}"))?;
            }
            enough_corners(draw.primitive, indices, id, state)
                .map_err(|lack| format!("attributes: {}", lack.reason(id)))?;
        }
        (None, Some(indices)) if !indices.corners.is_empty() => {
            return Err("attribute_indices: found some, expected none without `attributes`".into());
        }
        (None, _) => {}
    }
    if draw.models.is_empty() || (!draw.models_sent && draw.models != [IDENTITY]) {
        return Err("model: found none, expected at least one matrix".into());
    }
    finite(draw.models.as_flattened()).map_err(|e| format!("model: {e}"))
}

fn primitive(primitive: Primitive) -> Checked {
    let sides = match primitive {
        Primitive::Mesh { rows, columns } => [rows.into(), columns.into()],
        other => [other.patches(), 1],
    };
    let patches = sides[0].checked_mul(sides[1]);
    if patches.is_some_and(|patches| (1..=PATCHES_MAX).contains(&patches)) {
        return Ok(());
    }
    let [rows, columns] = sides;
    Err(format!("found {rows} rows of {columns} patches, expected 1 to {PATCHES_MAX} patches"))
}

fn index_rows(indices: &Indices, patches: u64) -> Checked {
    let found = indices.points.len() as u64;
    if found != patches {
        return Err(format!("indices: found those of {found} patches, expected of {patches}"));
    }
    let all = indices.points.as_flattened().iter().chain(indices.corners.as_flattened());
    let (most, format) = (all.copied().max().unwrap_or(0), indices.format);
    if most > format.max() {
        let (name, max) = (format.name(), format.max());
        return Err(format!("indices: found {most}, expected at most {max}, as {name} has"));
    }
    Ok(())
}

/// Entries of a buffer that a draw uses.
enum Used {
    /// So many from the first one on.
    Count(u64),
    /// Up to this index, which an indexed mesh names.
    UpTo(u32),
}

impl Used {
    /// By the primitive's own count, else by the greatest index.
    fn by(count: Option<u64>, indices: Option<&[u32]>) -> Self {
        match (count, indices.and_then(|list| list.iter().max())) {
            (Some(count), _) => Self::Count(count),
            (None, most) => Self::UpTo(most.copied().unwrap_or(0)),
        }
    }

    fn len(&self) -> u64 {
        match *self {
            Self::Count(count) => count,
            Self::UpTo(most) => u64::from(most) + 1,
        }
    }

    /// Why so many, for a message.
    fn reason(&self, patches: u64) -> String {
        match self {
            Self::Count(_) => format!("for {patches} patches"),
            Self::UpTo(most) => format!("for the index {most}"),
        }
    }
}

/// Whether the points of a draw, under an id and from a first one on, are there.
pub(crate) fn enough_points(
    primitive: Primitive,
    indices: Option<&Indices>,
    (id, first): (u32, u64),
    state: &State,
) -> Result<(), Lack> {
    let Some(&held) = state.points.get(&id) else {
        return Err(Lack::Unknown(format!("the id of points ({})", ids(&state.points))));
    };
    let used = Used::by(primitive.points(), indices.map(|i| i.points.as_flattened()));
    let needed = used.len();
    if first.checked_add(needed).is_some_and(|end| end <= held) {
        return Ok(());
    }
    let from = if first == 0 { String::new() } else { format!(" from point {first} on") };
    let reason = used.reason(primitive.patches());
    Err(Lack::Few(format!(
        "found {held} points under id {id}, expected at least {needed}{from} {reason}"
    )))
}

/// How many corners there are under an id of attributes.
pub(crate) fn known_corners(id: u32, state: &State) -> Result<u64, Lack> {
    let unknown = || Lack::Unknown(format!("the id of attributes ({})", ids(&state.corners)));
    state.corners.get(&id).copied().ok_or_else(unknown)
}

/// Whether the attributes of a draw's corners are there.
pub(crate) fn enough_corners(
    primitive: Primitive,
    indices: Option<&Indices>,
    id: u32,
    state: &State,
) -> Result<(), Lack> {
    let held = known_corners(id, state)?;
    let used = Used::by(primitive.corners(), indices.map(|i| i.corners.as_flattened()));
    let needed = used.len();
    if needed <= held {
        return Ok(());
    }
    let reason = used.reason(primitive.patches());
    Err(Lack::Few(format!(
        "found {held} corners under id {id}, expected at least {needed} {reason}"
    )))
}

/// Whether every patch of an indexed mesh has its corners.
pub(crate) fn enough_corner_rows(indices: &Indices) -> Checked {
    let [found, patches] = [indices.corners.len(), indices.points.len()];
    if found == patches {
        return Ok(());
    }
    Err(format!("found corners of {found} patches, expected those of {patches}"))
}
