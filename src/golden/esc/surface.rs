//! The surface shader, from its definition: levels of a patch in, candidates out; decisions in, the
//! triangles out, as fractions of the unit square.
//!
//! Concheiro, Amor, Boo, Padron 2014, sections 2.2 and 3. Points of the square are integers over
//! [`UNIT`], which every level's divide, so that they are exact; there is no grid and there are no
//! numbers. A coarse triangle is three corners; its mesh is [`Coarse`]'s, lists and all.
//!
//! Where the paper is silent: diagonals run from (1, 0) to (0, 1) of a cell; an edge of the patch
//! may have fewer candidates than the interior, each of which then takes the part of the nearest
//! one that the interior's level has, the further from the edge's start where two are as near.

use super::Coarse;
use std::collections::{BTreeMap, BTreeSet};

/// What a parameter of 1 is: a multiple of 3 R for every R to 16.
pub const UNIT: i64 = 3 * 720_720;

/// A point of the unit square, `[u, v]` over [`UNIT`].
pub type Site = [i64; 2];

/// A third of the square's side.
const THIRD: i64 = UNIT / 3;

/// A place where a vertex may be inserted on a coarse edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// Where it is.
    pub site: Site,
    /// Which place of the interior's pattern it takes.
    pub slot: Site,
    /// Its number from the edge's start, and how many segments the edge has.
    pub part: [i64; 2],
    /// The ends of the coarse edge.
    pub ends: [Site; 2],
}

/// The candidates of all coarse edges. Levels of the patch's edges v0, u1, v1, u0, then inside.
#[must_use]
pub fn candidates(edges: [u8; 4], interior: u8) -> Vec<Candidate> {
    let corners = (0..16).map(|k| [k % 4 * THIRD, k / 4 * THIRD]);
    let steps = [[THIRD, 0], [0, THIRD], [-THIRD, THIRD]];
    let lines = corners.flat_map(|[u, v]| steps.map(|[du, dv]| [[u, v], [u + du, v + dv]]));
    let inside = |site: &Site| site.iter().all(|t| (0..=UNIT).contains(t));
    let lines = lines.filter(|ends| ends.iter().all(inside));
    lines.flat_map(|ends| on(ends, level(ends, edges, interior), interior)).collect()
}

/// How many candidates a coarse edge has.
fn level(ends: [Site; 2], edges: [u8; 4], interior: u8) -> u8 {
    let sides: [fn(&Site) -> bool; 4] =
        [|s| s[1] == 0, |s| s[0] == UNIT, |s| s[1] == UNIT, |s| s[0] == 0];
    let side = sides.iter().position(|side| ends.iter().all(side));
    side.map_or(interior, |side| edges[side])
}

fn on(ends: [Site; 2], level: u8, interior: u8) -> Vec<Candidate> {
    let [own, inner] = [level, interior].map(|level| i64::from(level) + 1);
    let candidate = |k: i64| {
        let nearest = (1..inner).min_by_key(|s| ((k * inner - s * own).abs(), -s));
        let slot = between(ends, nearest.expect("an interior as fine as its edges"), inner);
        Candidate { site: between(ends, k, own), slot, part: [k, own], ends }
    };
    (1..own).map(candidate).collect()
}

/// `k` of `segments` on the way.
fn between([a, b]: [Site; 2], k: i64, segments: i64) -> Site {
    [0, 1].map(|axis| (a[axis] * (segments - k) + b[axis] * k) / segments)
}

/// A patch's mesh, and what it takes to list and to evaluate it.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Triangles by their corners, counter-clockwise with u right and v up, in the order of cells,
    /// strips and lists.
    pub triangles: Vec<[Site; 3]>,
    /// Vertices in all lists.
    pub listed: usize,
    /// Distinct vertices, coarse triangle by coarse triangle.
    pub apart: usize,
    /// Distinct vertices.
    pub vertices: BTreeSet<Site>,
}

/// The mesh where these candidates are inserted.
#[must_use]
pub fn mesh(inserted: &[Candidate], interior: u8) -> Mesh {
    let at: BTreeMap<Site, Site> = inserted.iter().map(|c| (c.slot, c.site)).collect();
    let mut mesh = Mesh::default();
    for cell in 0..9 {
        let [u, v] = [cell % 3 * THIRD, cell / 3 * THIRD];
        let [a, b, c, d] =
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [u + x * THIRD, v + y * THIRD]);
        for corners in [[a, b, c], [d, c, b]] {
            coarse(corners, interior, &at, &mut mesh);
        }
    }
    mesh
}

/// Apex, left and right corner.
fn coarse(
    [apex, left, right]: [Site; 3],
    interior: u8,
    at: &BTreeMap<Site, Site>,
    mesh: &mut Mesh,
) {
    let segments = i64::from(interior) + 1;
    let edge = |ends| {
        (1..segments).map(|k| at.contains_key(&between(ends, k, segments))).collect::<Vec<bool>>()
    };
    let coarse = Coarse::new(&[edge([apex, left]), edge([apex, right]), edge([left, right])]);
    // By number: row r, place i is r steps down, i of them to the right.
    let mut sites = vec![[0; 2]];
    for row in 0..=segments {
        for place in 0..=row {
            let axis = |k: usize| {
                let (down, across) = (left[k] - apex[k], right[k] - left[k]);
                apex[k] + (down * row + across * place) / segments
            };
            let slot = [0, 1].map(axis);
            sites.push(at.get(&slot).copied().unwrap_or(slot));
        }
    }
    mesh.listed += coarse.lists().iter().map(Vec::len).sum::<usize>();
    let vertices = coarse.vertices();
    mesh.apart += vertices.len();
    mesh.vertices.extend(vertices.into_iter().map(|vertex| sites[vertex]));
    mesh.triangles.extend(coarse.triangles().into_iter().map(|t| t.map(|k| sites[k])));
}
