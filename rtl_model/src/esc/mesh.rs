//! Mesh: the decisions of a patch's 33 coarse edges in, its triangles and the places of its
//! vertices out, and what an invocation does on the way.
//!
//! Coarse triangles come one after another, each strip by strip; a vertex gets its number where it
//! is used first. Everything here is a function of the levels and the decisions.

use super::pattern::{COARSE_EDGES, CoarseEdge, CoarseTriangle, LINES_MAX, Place, slot};
use super::section::{Part, Sections};
use super::{Levels, Made, Phase, Reuse, Site};
use crate::patch::Triangle;

/// What the counts depend on besides levels and decisions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counting {
    pub(super) reuse: Reuse,
    pub(super) tests: Tests,
    /// Whether a test looks at the ends of its edge too.
    pub(super) ends: bool,
}

/// What the tests evaluate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tests {
    /// Nothing is tested.
    None,
    /// Points that the mesh may use.
    Mesh,
    /// Points of another space.
    Apart,
}

/// A patch's decisions: of each coarse edge, bit s for slot s.
pub(super) type Masks = [u16; COARSE_EDGES];

/// The mesh of levels and decisions.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    /// What it is the mesh of.
    pub(super) of: Option<(Levels, Masks)>,
    pub(super) triangles: Vec<Triangle>,
    /// Where its vertices are, by number.
    pub(super) places: Vec<Place>,
    /// All counts but overflows and cracks.
    pub(super) made: Made,
}

/// Where a place of the grid lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    Corner,
    Boundary,
    Coarse,
    Interior,
}

fn class([i, j]: Place, segments: u8) -> Class {
    let last = 3 * segments;
    let outer = |line| line == 0 || line == last;
    // Diagonals are where i + j is a third, to 6 R.
    let third = |line: u8| [1, 2, 3, 4, 5].iter().any(|k| line == k * segments);
    match (outer(i), outer(j)) {
        (true, true) => Class::Corner,
        (true, false) | (false, true) => Class::Boundary,
        _ if third(i) || third(j) || third(i + j) => Class::Coarse,
        _ => Class::Interior,
    }
}

fn index([i, j]: Place) -> usize {
    usize::from(j) * LINES_MAX + usize::from(i)
}

/// What is known of a place.
#[derive(Clone, Copy, Debug, Default)]
struct Spot {
    /// The last scope that saw it.
    stamp: u32,
    /// Its vertex's number and one, or 0.
    number: u16,
}

/// Makes meshes, in stores that it keeps.
#[derive(Clone, Debug)]
pub(super) struct Walker {
    counting: Counting,
    sections: Sections,
    /// By place of the grid.
    spots: Vec<Spot>,
    /// Within a scope a point is evaluated once.
    scope: u32,
    levels: Levels,
    masks: Masks,
}

impl Walker {
    pub(super) fn new(counting: Counting, sections: Sections) -> Self {
        Self {
            counting,
            sections,
            spots: vec![Spot::default(); LINES_MAX * LINES_MAX],
            scope: 0,
            levels: Levels { edges: [0; 4], interior: 0 },
            masks: [0; COARSE_EDGES],
        }
    }

    /// Makes the mesh of `levels` and `masks`.
    pub(super) fn walk(&mut self, levels: Levels, masks: &Masks, mesh: &mut Mesh) {
        (self.levels, self.masks) = (levels, *masks);
        self.spots.fill(Spot::default());
        self.scope = 0;
        mesh.of = Some((levels, *masks));
        mesh.triangles.clear();
        mesh.places.clear();
        mesh.made = Made { moved: self.moved(), ..Made::default() };
        mesh.made.sections.sections = self.sections.count;
        let parts = self.sections.parts(levels.interior).to_vec();
        for parts in parts.chunk_by(|a, b| a.section == b.section) {
            let before = mesh.made;
            let held = self.section(parts, mesh);
            let made = &mut mesh.made;
            made.buffer = made.buffer.max(held);
            made.nets += 1;
            made.object_nets += u64::from(self.counting.tests == Tests::Apart);
            let phase = Phase {
                nets: (made.nets + made.object_nets - before.nets - before.object_nets) as u32,
                tests: (made.tests - before.tests) as u32,
                points: (made.points() - before.points()) as u32,
                slots: (made.slots - before.slots) as u32,
            };
            made.sections.add(phase);
        }
        mesh.made.distinct = mesh.places.len() as u64;
    }

    /// Vertices that stand elsewhere than their slot.
    fn moved(&self) -> u64 {
        let interior = self.levels.interior;
        let edges = CoarseEdge::ALL.iter().zip(&self.masks);
        let of = |(edge, mask): (&CoarseEdge, &u16)| {
            let level = edge.level(self.levels);
            let elsewhere = |k: &u8| {
                let slot = slot(*k, level, interior);
                let [own, carried] = [k * (interior + 1), slot * (level + 1)];
                mask >> slot & 1 == 1 && own != carried
            };
            (1..=level).filter(elsewhere).count() as u64
        };
        edges.map(of).sum()
    }

    /// What one invocation does; returns how many points it holds at most.
    fn section(&mut self, parts: &[Part], mesh: &mut Mesh) -> u64 {
        let reuse = self.counting.reuse;
        let mut tested = 0_u64; // coarse edges of the scope, by bit
        let mut held = 0;
        self.scope += 1;
        for part in parts {
            let triangle = CoarseTriangle::ALL[usize::from(part.triangle)];
            if reuse != Reuse::Patch {
                tested = 0;
                self.scope += 1;
            }
            if self.counting.tests != Tests::None {
                for edge in triangle.edges.into_iter().filter(|&edge| tested >> edge & 1 == 0) {
                    mesh.made.tests += u64::from(CoarseEdge::ALL[edge].level(self.levels));
                    mesh.made.inserted += u64::from(self.masks[edge].count_ones());
                }
                triangle.edges.iter().for_each(|edge| tested |= 1 << edge);
            }
            self.strips(triangle, *part, mesh);
            if reuse != Reuse::Patch {
                self.settle(tested, &mut mesh.made);
            }
            if reuse == Reuse::CoarseTriangle {
                let [first, last] = part.strips.map(u64::from);
                held = held.max((last + 1) * (last + 2) / 2 - first * (first - 1) / 2);
            }
        }
        if reuse == Reuse::Patch {
            self.settle(tested, &mut mesh.made);
            held = self.places_of(parts);
        }
        held
    }

    /// The strips of a coarse triangle.
    fn strips(&mut self, triangle: CoarseTriangle, part: Part, mesh: &mut Mesh) {
        let interior = self.levels.interior;
        let insertion = triangle.insertion(interior, &self.masks);
        let [first, last] = part.strips;
        let own = insertion.strips().filter(|strip| (first..=last).contains(&strip.lower()));
        for strip in own {
            mesh.made.slots += u64::from(strip.slot_count());
            for site in strip.list() {
                mesh.made.strip_vertices += 1;
                if self.counting.reuse == Reuse::None {
                    self.count(triangle.place(site, interior + 1), &mut mesh.made);
                }
            }
            for sites in strip.slots().flatten() {
                let [a, b, c] = sites;
                let mut number = |site| self.number(triangle.place(site, interior + 1), mesh);
                let numbered = [number(a), number(b), number(c)];
                mesh.triangles.push(numbered);
            }
        }
    }

    fn count(&self, place: Place, made: &mut Made) {
        *match class(place, self.levels.interior + 1) {
            Class::Corner => &mut made.corners,
            Class::Boundary => &mut made.boundary,
            Class::Coarse => &mut made.coarse,
            Class::Interior => &mut made.interior,
        } += 1;
    }

    /// Whether the scope sees a place for the first time.
    fn is_new(&mut self, place: Place) -> bool {
        let stamp = &mut self.spots[index(place)].stamp;
        let new = *stamp != self.scope;
        *stamp = self.scope;
        new
    }

    /// The number of the vertex at a place, a new one where it has none.
    #[inline(always)]
    fn number(&mut self, place: Place, mesh: &mut Mesh) -> u16 {
        let index = index(place);
        if self.spots[index].stamp != self.scope {
            self.spots[index].stamp = self.scope;
            if self.counting.reuse != Reuse::None {
                self.count(place, &mut mesh.made);
            }
            if self.spots[index].number == 0 {
                mesh.places.push(place);
                self.spots[index].number = mesh.places.len() as u16; // at most 2401
            }
        }
        self.spots[index].number - 1
    }

    /// Counts what the tests of the scope evaluated and the mesh did not get.
    fn settle(&mut self, tested: u64, made: &mut Made) {
        let Counting { reuse, tests, ends } = self.counting;
        let interior = self.levels.interior;
        let segments = interior + 1;
        // In another space, no point of the mesh is of use.
        self.scope += u32::from(tests == Tests::Apart);
        for (number, edge) in CoarseEdge::ALL.iter().enumerate() {
            let level = edge.level(self.levels);
            if tested >> number & 1 == 0 || level == 0 {
                continue;
            }
            self.scope += u32::from(reuse == Reuse::None); // each test on its own
            let candidates = (1..=level).map(|k| slot(k, level, interior));
            let ends = [0, segments].into_iter().filter(|_| ends);
            for position in candidates.chain(ends) {
                let place = edge.place(position, segments);
                let class = class(place, segments);
                if class != Class::Corner && self.is_new(place) {
                    made.tested += 1;
                    made.tested_boundary += u64::from(class == Class::Boundary);
                }
            }
        }
    }

    /// Places of the uniform pattern that strips of an invocation have, each once.
    fn places_of(&mut self, parts: &[Part]) -> u64 {
        self.scope += 1;
        let segments = self.levels.interior + 1;
        let mut places = 0;
        for part in parts {
            let triangle = CoarseTriangle::ALL[usize::from(part.triangle)];
            let [first, last] = part.strips;
            for row in first - 1..=last {
                for place in 0..=row {
                    places += u64::from(self.is_new(triangle.place(Site { row, place }, segments)));
                }
            }
        }
        places
    }
}
