//! Place: levels in, the parameters of the vertices out, as exact fractions.
//!
//! Moreton 2001 by way of Munkberg et al. 2008, section 2. With f = level / 2 segments a
//! half-edge: n = floor(f) steps of size 1 / level from either corner, then the midpoint. Below
//! level 2, where the one step from a corner passes the midpoint, there is none: {0, 1 - 1/s,
//! 1/s, 1}. The parameters form a set, so coinciding ones need no case.

use rtl_model::patch::{Dyadic, EDGES, Level, Levels, Lists};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// A fraction; equal and ordered by value.
#[derive(Clone, Copy, Debug)]
pub struct Fraction(pub u64, pub u64);

impl Fraction {
    /// The middle of an edge.
    pub const HALF: Self = Self(1, 2);

    /// As a real number.
    #[must_use]
    pub fn real(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        (u128::from(self.0) * u128::from(other.1)).cmp(&(u128::from(other.0) * u128::from(self.1)))
    }
}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Fraction {}

/// A place on an edge, or along one direction of the interior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Its parameter.
    pub parameter: Fraction,
    /// The parameter at which a half-run evaluates it, exact: k R from its corner, R being 1 /
    /// level truncated to its fraction bits.
    pub run: f64,
    /// Steps k of that half-run; 0 at corners and centre, which need none.
    pub steps: u32,
}

/// The places of a level, ascending; a reciprocal has so many fraction bits, at most 32.
#[must_use]
pub fn list(level: Level, reciprocal_bits: u32) -> Vec<Entry> {
    let fx16 = u64::from(level.fx16());
    let step = ((1_u64 << (16 + reciprocal_bits)) / fx16) as f64;
    let step = step / (1_u64 << reciprocal_bits) as f64;
    let mut set = BTreeMap::new();
    let fixed = |parameter: Fraction| Entry { parameter, run: parameter.real(), steps: 0 };
    let mut corners_and_centre = vec![Fraction(0, 1), Fraction(1, 1)];
    let mut steps = 1;
    if level >= Level::TWO {
        corners_and_centre.push(Fraction::HALF);
        steps = fx16 / (2 << 16); // floor(f)
    }
    for parameter in corners_and_centre {
        set.insert(parameter, fixed(parameter));
    }
    for k in 1..=steps {
        let run = k as f64 * step;
        for (numerator, run) in [(k << 16, run), (fx16 - (k << 16), 1.0 - run)] {
            let parameter = Fraction(numerator, fx16);
            set.entry(parameter).or_insert(Entry { parameter, run, steps: k as u32 });
        }
    }
    set.into_values().collect()
}

/// The places of a patch's vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Along the edges v0, u1, v1, u0.
    pub edges: [Vec<Entry>; 4],
    /// Columns of the interior, without the edges.
    pub columns: Vec<Entry>,
    /// Rows of the interior, without the edges.
    pub rows: Vec<Entry>,
    /// Distinct levels above 1.
    pub reciprocals: usize,
}

/// One vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// The edge along which it is evaluated; `None` inside.
    pub edge: Option<usize>,
    /// Along u.
    pub u: Entry,
    /// Along v.
    pub v: Entry,
}

/// Places the vertices of a patch. The interior has at least level min(m, 2), m the greatest of
/// all levels. A reciprocal has so many fraction bits, at most 32.
#[must_use]
pub fn place(levels: &Levels, reciprocal_bits: u32) -> Placed {
    let all = levels.edges.into_iter().chain(levels.interior);
    let least = all.max().map_or(Level::TWO, |most| most.min(Level::TWO));
    let interior = levels.interior.map(|level| level.max(least));
    let inner = |level: Level| {
        let list = list(level, reciprocal_bits);
        list[1..list.len() - 1].to_vec()
    };
    let distinct: BTreeSet<Level> = levels.edges.into_iter().chain(interior).collect();
    Placed {
        edges: levels.edges.map(|level| list(level, reciprocal_bits)),
        columns: inner(interior[0]),
        rows: inner(interior[1]),
        reciprocals: distinct.iter().filter(|&&level| level > Level::MIN).count(),
    }
}

/// Places the vertices of a patch that is subdivided at midpoints. Without inner entries along
/// both directions it has no interior.
#[must_use]
pub fn dyadic(lists: &Lists) -> Placed {
    let inner = |list: Dyadic| -> Vec<Entry> {
        let k = (1..128_u64).filter(|&k| list.mask() >> k & 1 == 1);
        let entry = |parameter: Fraction| Entry { parameter, run: parameter.real(), steps: 0 };
        k.map(|k| entry(Fraction(k, 128))).collect()
    };
    let end = |k| Entry { parameter: Fraction(k, 1), run: k as f64, steps: 0 };
    let edge = |list: Dyadic| [vec![end(0)], inner(list), vec![end(1)]].concat();
    let union = |a: usize, b: usize, list: Dyadic| {
        let mask = lists.edges()[a].mask() | lists.edges()[b].mask() | list.mask();
        inner(Dyadic::of(mask))
    };
    let (mut columns, mut rows) = (union(0, 2, lists.u()), union(1, 3, lists.v()));
    if columns.is_empty() || rows.is_empty() {
        (columns, rows) = (Vec::new(), Vec::new());
    }
    Placed { edges: lists.edges().map(edge), columns, rows, reciprocals: 0 }
}

impl Placed {
    /// The vertices by number: the boundary counter-clockwise from (0, 0), then the interior row
    /// by row.
    #[must_use]
    pub fn sites(&self) -> Vec<Site> {
        let [zero, one] = [Fraction(0, 1), Fraction(1, 1)].map(|parameter| Entry {
            parameter,
            run: parameter.real(),
            steps: 0,
        });
        let mut sites = Vec::new();
        for (edge, entries) in self.edges.iter().enumerate() {
            let site = |&t: &Entry| {
                let (u, v) = [(t, zero), (one, t), (t, one), (zero, t)][edge];
                Site { edge: Some(edge), u, v }
            };
            let last = entries.len() - 1; // each edge leaves its last corner to the next one
            match edge {
                0 | 1 => sites.extend(entries[..last].iter().map(site)),
                _ => sites.extend(entries[1..].iter().rev().map(site)),
            }
        }
        let row = |&v: &Entry| self.columns.iter().map(move |&u| Site { edge: None, u, v });
        sites.extend(self.rows.iter().flat_map(row));
        sites
    }
}

impl Site {
    /// The place along its edge: which of the edge's points, and where between them.
    #[must_use]
    pub fn on_edge(&self) -> Option<([usize; 4], Entry)> {
        self.edge.map(|edge| (EDGES[edge], if edge % 2 == 0 { self.u } else { self.v }))
    }
}
