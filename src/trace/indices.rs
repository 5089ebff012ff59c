//! Indices: which points, and which corners' attributes, each patch of an indexed mesh has; and
//! their text in, them out.

use super::field::{Object, choice, integer32};
use super::json::{Found, Value};

/// The indices of an indexed mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Indices {
    /// How wide an index is on the link.
    pub format: IndexFormat,
    /// The sixteen points of each patch, row-major, counted from the draw's first point.
    pub points: Vec<[u32; 16]>,
    /// The attributes of each patch's corners P0 P3 P12 P15; empty where the draw has none.
    pub corners: Vec<[u32; 4]>,
}

impl Indices {
    /// Bytes on the link.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let count = 16 * self.points.len() as u64 + 4 * self.corners.len() as u64;
        count * u64::from(self.format.bytes())
    }
}

/// How wide an index is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IndexFormat {
    /// Two bytes: points 0 to 65535.
    #[default]
    Uint16,
    /// Four bytes.
    Uint32,
}

impl IndexFormat {
    /// The name in traces, which is wgpu's.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uint16 => "uint16",
            Self::Uint32 => "uint32",
        }
    }

    /// Bytes of an index.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Uint16 => 2,
            Self::Uint32 => 4,
        }
    }

    /// The greatest index.
    #[must_use]
    pub const fn max(self) -> u32 {
        match self {
            Self::Uint16 => u16::MAX as u32,
            Self::Uint32 => u32::MAX,
        }
    }
}

/// The indices of a draw of which the fields are `object`'s.
pub(crate) fn indices(object: &Object<'_>, patches_max: u64) -> Found<Indices> {
    let formats = [IndexFormat::Uint16, IndexFormat::Uint32].map(|format| (format.name(), format));
    let format = object.get("index_format").map(|v| choice(v, &formats)).transpose()?;
    let format = format.unwrap_or_default();
    let list = object.require("indices", "an array of 16 integers a patch")?;
    let points = rows(list, format, patches_max)?;
    let corners = match object.get("attribute_indices") {
        None => Vec::new(),
        Some(list) => rows(list, format, patches_max)?,
    };
    Ok(Indices { format, points, corners })
}

/// Rows of `N` indices, at least one row.
fn rows<const N: usize>(
    list: Value<'_>,
    format: IndexFormat,
    rows_max: u64,
) -> Found<Vec<[u32; N]>> {
    let what = format!("an array of {N} indices, a patch's");
    let mut rows = Vec::new();
    list.elements("an array of arrays of indices", |k, row| {
        if k as u64 == rows_max {
            return Err(row.expected(format_args!("at most {rows_max} patches a draw")));
        }
        let mut indices = [0; N];
        let mut count = 0;
        row.elements(&what, |i, index| {
            let place = indices.get_mut(i).ok_or_else(|| row.expected(&what))?;
            *place = integer32(index, 0, format.max())?;
            count = i + 1;
            Ok(())
        })?;
        if count < N {
            return Err(row.expected(&what));
        }
        rows.push(indices);
        Ok(())
    })?;
    if rows.is_empty() { Err(list.expected("at least one patch")) } else { Ok(rows) }
}
