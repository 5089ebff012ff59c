//! Pieces: what a thread made of a few patches, held until its turn comes in draw order.

use super::{DrawState, Pending, Tally};
use crate::attribute::AttributeTable;
use crate::error::Result;
use crate::sink::{Arrived, PatchMesh, Sink};
use crate::unit::chain::{Flow, Work as Done};
use crate::unit::pipeline::{Make, Pipeline};
use rtl_model::counter::Counters;
use rtl_model::emit::Screen;
use rtl_model::number::Rounding;
use rtl_model::patch::{Triangle, Vertex};
use std::sync::Arc;

/// What a thread made of a few patches.
#[derive(Default)]
pub(super) struct Pieces<T> {
    patches: Vec<Piece>,
    vertices: Vec<Vertex>,
    screen: Vec<Screen>,
    triangles: Vec<Triangle>,
    attributes: Vec<i64>,
    tallies: Vec<Tally>,
    /// The patches themselves, where the sink wants them.
    pub(super) arrived: Vec<Arrived>,
    pub(super) done: Vec<Done<T>>,
    pub(super) counters: Counters,
}

/// A patch's ends within [`Pieces`].
struct Piece {
    id: u32,
    reversed: bool,
    vertices: usize,
    screen: usize,
    triangles: usize,
    to_world: [f64; 16],
    table: Option<Arc<AttributeTable>>,
}

impl<T: Flow> Pieces<T> {
    pub(super) fn tally<M: Make>(&mut self, draw: u32, made: &Pipeline<'_, M>) {
        let tally = Tally {
            draw,
            vertices: made.vertices.len() as u64,
            triangles: made.triangles().len() as u64,
        };
        add(&mut self.tallies, tally);
    }

    pub(super) fn keep<M: Make>(
        &mut self,
        pending: &Pending,
        draw: &DrawState,
        made: &Pipeline<'_, M>,
        rounding: Rounding,
    ) {
        if let Some(attributes) = &draw.attributes {
            let out = &mut self.attributes;
            attributes.interpolate(pending.corners, &made.vertices, rounding, out);
        }
        self.vertices.extend_from_slice(&made.vertices);
        self.screen.extend_from_slice(&made.screen);
        self.triangles.extend_from_slice(made.triangles());
        self.patches.push(Piece {
            id: pending.id,
            reversed: draw.reversed,
            vertices: self.vertices.len(),
            screen: self.screen.len(),
            triangles: self.triangles.len(),
            to_world: draw.to_world,
            table: draw.attributes.as_ref().map(|corners| corners.table.clone()),
        });
    }

    pub(super) fn send(&self, sink: &mut dyn Sink) -> Result<()> {
        let mut arrived = self.arrived.iter().peekable();
        let (mut v, mut s, mut t) = (0, 0, 0);
        let mut values = &self.attributes[..];
        for piece in &self.patches {
            while let Some(patch) = arrived.next_if(|arrived| arrived.patch.id <= piece.id) {
                sink.arrived(patch)?;
            }
            let components = piece.table.as_ref().map_or(0, |table| table.components());
            let (attributes, later) = values.split_at(components * (piece.vertices - v));
            values = later;
            sink.patch(&PatchMesh {
                patch: piece.id,
                reversed: piece.reversed,
                vertices: &self.vertices[v..piece.vertices],
                screen: &self.screen[s..piece.screen],
                triangles: &self.triangles[t..piece.triangles],
                layout: piece.table.as_ref().map_or(&[], |table| &table.layout),
                attributes,
                to_world: &piece.to_world,
            })?;
            (v, s, t) = (piece.vertices, piece.screen, piece.triangles);
        }
        arrived.try_for_each(|patch| sink.arrived(patch))
    }

    pub(super) fn account(self, counters: &mut Counters, tallies: &mut Vec<Tally>) {
        counters.merge(&self.counters);
        for tally in self.tallies {
            add(tallies, tally);
        }
    }
}

/// Adds to the last tally, if it is of the same draw.
pub(in crate::unit) fn add(tallies: &mut Vec<Tally>, tally: Tally) {
    match tallies.last_mut() {
        Some(last) if last.draw == tally.draw => {
            last.vertices += tally.vertices;
            last.triangles += tally.triangles;
        }
        _ => tallies.push(tally),
    }
}
