//! Attributes on their way through the unit: a table in, its components in the attribute format;
//! a patch's corners and vertices in, the values of the vertices out.

use crate::attribute::AttributeTable;
use crate::config::Config;
use crate::trace::command::Attributes;
use rtl_model::attribute;
use rtl_model::number::{Format, Modal, OverflowMode, RoundingMode, dispatch};
use rtl_model::number::{Overflow, Rounding, from_f32_bits};
use rtl_model::patch::Vertex;
use std::sync::Arc;

/// The corners of a patch without attributes.
pub(super) const NO_CORNERS: [u32; 4] = [0; 4];

/// Attributes of corners, as the unit holds them.
#[derive(Debug)]
pub(super) struct Corners {
    /// As the trace has them.
    pub(super) table: Arc<AttributeTable>,
    pub(super) resident: bool,
    /// Components in the attribute format, corner after corner.
    raw: Vec<i64>,
    /// How many of them did not fit.
    pub(super) saturated: u64,
}

impl Corners {
    pub(super) fn new(attributes: &Attributes, config: &Config) -> Self {
        let table = attributes.table.clone();
        let format =
            Format { width: config.attributes.width, fraction: config.attributes.fraction as i32 };
        let work = CornerWork { values: &table.values, format };
        let (raw, saturated) = dispatch(config.attributes.rounding, Overflow::Saturate, work);
        Self { table, resident: attributes.resident, raw, saturated }
    }

    /// Appends the attributes of a patch's vertices to `out`, vertex after vertex.
    pub(super) fn interpolate(
        &self,
        corners: [u32; 4],
        vertices: &[Vertex],
        rounding: Rounding,
        out: &mut Vec<i64>,
    ) {
        let components = self.table.components();
        let corners = corners.map(|c| &self.raw[components * c as usize..][..components]);
        dispatch(rounding, Overflow::Saturate, Interpolation { corners, vertices, out });
    }
}

struct CornerWork<'a> {
    values: &'a [f32],
    format: Format,
}

impl Modal for CornerWork<'_> {
    type Output = (Vec<i64>, u64);

    fn run<R: RoundingMode, O: OverflowMode>(self) -> Self::Output {
        let mut saturated = 0;
        let quantise = |value: &f32| {
            let exact = from_f32_bits::<R>(value.to_bits(), self.format.fraction);
            let (raw, overflowed) = self.format.fit::<O>(exact.unwrap_or(0));
            saturated += u64::from(overflowed);
            raw
        };
        (self.values.iter().map(quantise).collect(), saturated)
    }
}

struct Interpolation<'a> {
    corners: [&'a [i64]; 4],
    vertices: &'a [Vertex],
    out: &'a mut Vec<i64>,
}

impl Modal for Interpolation<'_> {
    type Output = ();

    fn run<R: RoundingMode, O: OverflowMode>(self) {
        let [a, b, c, d] = self.corners;
        for vertex in self.vertices {
            let at =
                |k: usize| attribute::accept::<R>([a[k], b[k], c[k], d[k]], vertex.u, vertex.v);
            self.out.extend((0..a.len()).map(at));
        }
    }
}
