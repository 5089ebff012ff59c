//! D3d11: factors as real numbers in, a pattern's points as real numbers and its triangles as a
//! set out.
//!
//! Direct3D 11.3 functional specification, chapter 11. Placement is the definition itself: a point
//! lies between its places in two partitions into equal segments. Which points a partition has, and
//! which come in between, follows from one order of all points of a half-edge: the corner, then
//! 1/2, then 1/4 and 3/4, then the odd eighths, and so on. The hardware has bit operations for the
//! one and a table for the other; here both are ranks in that order.

mod join;

use crate::config::Partitioning;

/// Factors of a quad, of a triangle and of an isoline domain, which tell them apart.
const QUAD: usize = 6;
const TRI: usize = 4;
const ISOLINE: usize = 2;

/// Factors that belong to edges.
fn edges(factors: usize) -> usize {
    match factors {
        QUAD => 4,
        TRI => 3,
        ISOLINE => 2,
        other => panic!("{other} factors, of no domain"),
    }
}

/// A processed factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// A multiple of 2^-16, 1 to 64.
    pub value: f64,
    /// Whether it has an odd number of segments.
    pub odd: bool,
}

/// Clamps, rounds and gives every factor its parity; `None`: culled. Six factors are a quad's, four
/// a triangle's, two of an isoline domain.
///
/// # Panics
/// Where there are as many as no domain has.
#[must_use]
pub fn process(partitioning: Partitioning, given: &[f32]) -> Option<Vec<Factor>> {
    let (edges, isoline) = (edges(given.len()), given.len() == ISOLINE);
    if !given[..edges].iter().all(|&f| f > 0.0) {
        return None; // also where one is no number
    }
    let [least, most] = match partitioning {
        Partitioning::Integer | Partitioning::Pow2 => [1.0, 64.0],
        Partitioning::Odd => [1.0, 63.0],
        Partitioning::Even => [2.0, 64.0],
    };
    let framed =
        partitioning == Partitioning::Odd && given.iter().any(|&f| f > 1.0 + 2f32.powi(-17));
    let least_inside = if framed { 1.0 + 2f64.powi(-16) } else { least };
    let factor = |(place, &given): (usize, &f32)| {
        let least = if place < edges { least } else { least_inside };
        let clamped = f64::from(given).max(least).min(most); // a NaN is the least
        match partitioning {
            _ if isoline && place == 0 => whole(f64::from(given).clamp(1.0, 64.0)),
            Partitioning::Integer | Partitioning::Pow2 => whole(clamped),
            _ => Factor {
                value: (clamped * 65536.0).round_ties_even() / 65536.0,
                odd: partitioning == Partitioning::Odd,
            },
        }
    };
    let mut factors: Vec<Factor> = given.iter().enumerate().map(factor).collect();
    if !isoline && !factors.iter().all(|f| f.value == 1.0) {
        for inside in factors[edges..].iter_mut().filter(|f| f.value == 1.0) {
            inside.odd = false; // two segments: one could not be joined to the edges
        }
    }
    Some(factors)
}

fn whole(clamped: f64) -> Factor {
    let value = clamped.ceil();
    Factor { value, odd: value % 2.0 == 1.0 }
}

/// Where a point of a half-edge is in the order of appearance, as a place on the half-edge: 0, then
/// 1/2, then 1/4, 3/4, then the odd eighths.
fn place_in_order(number: usize) -> f64 {
    if number == 0 {
        return 0.0;
    }
    let row = 2f64.powi(number.ilog2() as i32); // 1, 2, 4, ... points
    (2.0 * (number as f64 - row) + 1.0) / (2.0 * row)
}

/// A parameter, and how many segments it is away from the nearer end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// 0 to 1.
    pub parameter: f64,
    /// 0 to 32.
    pub steps: u32,
}

/// The points of a factor, both ends included.
#[must_use]
pub fn list(factor: Factor) -> Vec<Entry> {
    // An odd list's half goes to its last point before the middle, an even one's to the middle.
    let odd = usize::from(factor.odd);
    let half = (factor.value / 2.0 + 0.5 * odd as f64).max(1.0);
    let (floor, t) = (half.floor() as usize, half.fract());
    let [before, after] = [floor - odd, half.ceil() as usize - odd];
    let segments = |points: usize| (2 * points + odd) as f64;
    let rank = |place: f64, among: usize| {
        (0..among).filter(|&other| place_in_order(other) < place).count() as f64
    };
    let mut places: Vec<f64> = (0..after).map(place_in_order).collect();
    places.push(1.0);
    places.sort_by(f64::total_cmp);
    let near: Vec<f64> = places
        .iter()
        .map(|&place| {
            let [old, new] = [before, after].map(|among| rank(place, among) / segments(among));
            old * (1.0 - t) + new * t
        })
        .collect();
    let entry = |(k, &parameter): (usize, &f64)| Entry { parameter, steps: k as u32 };
    let near: Vec<Entry> = near.iter().enumerate().map(entry).collect();
    let far = near.iter().rev().skip(1 - odd).map(|entry| mirrored(*entry));
    near.iter().copied().chain(far).collect()
}

fn mirrored(entry: Entry) -> Entry {
    Entry { parameter: 1.0 - entry.parameter, ..entry }
}

/// A point, u and v each with the entries of a list that it depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// u and v.
    pub at: [f64; 2],
    /// Steps of the lists behind it, the greatest, to u and to v.
    pub steps: [u32; 2],
    /// Whether it is set off the edges of a triangle, which takes more roundings.
    pub set_off: bool,
}

/// A pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// Points in order.
    pub sites: Vec<Site>,
    /// Triangles, v up: clockwise, each from its least number, sorted; none in an isoline domain.
    pub triangles: Vec<[usize; 3]>,
}

/// The pattern of processed factors.
///
/// # Panics
/// Where there are as many as no domain has.
#[must_use]
pub fn pattern(factors: &[Factor]) -> Pattern {
    let lists: Vec<Vec<Entry>> = factors.iter().map(|&factor| list(factor)).collect();
    if factors.len() == ISOLINE {
        let lines = &lists[0][..lists[0].len() - 1];
        let line = |&v: &Entry| lists[1].iter().map(move |&u| grid(u, v));
        return Pattern { sites: lines.iter().flat_map(line).collect(), triangles: Vec::new() };
    }
    let least = factors.iter().all(|factor| factor.value == 1.0 && factor.odd);
    let rings: Vec<Ring<Site>> = match (factors.len(), least) {
        // The one pattern that begins at (0, 0).
        (QUAD, true) => {
            let corner = |u: f64, v: f64| {
                let end = |parameter| Entry { parameter, steps: 0 };
                vec![grid(end(u), end(v))]
            };
            let corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            vec![Vec::from(corners)]
        }
        (QUAD, false) => quad_rings(&lists),
        _ => tri_rings(&lists, least),
    };
    let sites = rings.iter().flatten().flatten().copied().collect();
    let counts: Vec<Vec<usize>> =
        rings.iter().map(|ring| ring.iter().map(Vec::len).collect()).collect();
    let inner: Vec<usize> = lists[edges(factors.len())..].iter().map(Vec::len).collect();
    Pattern { sites, triangles: join::triangles(&counts, &inner, least) }
}

fn grid(u: Entry, v: Entry) -> Site {
    Site { at: [u.parameter, v.parameter], steps: [u.steps, v.steps], set_off: false }
}

/// A ring: its sides, each without its last point. A line or a point is one side.
type Ring<T> = Vec<Vec<T>>;

const ZERO: Entry = Entry { parameter: 0.0, steps: 0 };
const ONE: Entry = Entry { parameter: 1.0, steps: 0 };

fn quad_rings(lists: &[Vec<Entry>]) -> Vec<Ring<Site>> {
    let down = |list: &[Entry]| list.iter().rev().copied().collect::<Vec<_>>();
    let [left, low, right, high, us, vs] = [0, 1, 2, 3, 4, 5].map(|k| &lists[k][..]);
    let side = |list: &[Entry], site: &dyn Fn(Entry) -> Site| -> Vec<Site> {
        list[..list.len() - 1].iter().map(|&entry| site(entry)).collect()
    };
    let mut rings = vec![vec![
        side(&down(left), &|v| grid(ZERO, v)),
        side(low, &|u| grid(u, ZERO)),
        side(right, &|v| grid(ONE, v)),
        side(&down(high), &|u| grid(u, ONE)),
    ]];
    let (mut us, mut vs) = (&us[1..us.len() - 1], &vs[1..vs.len() - 1]);
    while us.len() > 1 && vs.len() > 1 {
        let [u0, u1, v0, v1] = [us[0], us[us.len() - 1], vs[0], vs[vs.len() - 1]];
        rings.push(vec![
            side(&down(vs), &|v| grid(u0, v)),
            side(us, &|u| grid(u, v0)),
            side(vs, &|v| grid(u1, v)),
            side(&down(us), &|u| grid(u, v1)),
        ]);
        (us, vs) = (&us[1..us.len() - 1], &vs[1..vs.len() - 1]);
    }
    if vs.len() == 1 && !us.is_empty() {
        rings.push(vec![us.iter().map(|&u| grid(u, vs[0])).collect()]);
    } else if us.len() == 1 && !vs.is_empty() {
        rings.push(vec![down(vs).into_iter().map(|v| grid(us[0], v)).collect()]);
    }
    rings
}

/// Corner r of the inner list goes to the place on the median that is as far off the edge as two
/// thirds of it: then the middle of an even list is the centroid.
fn tri_rings(lists: &[Vec<Entry>], least: bool) -> Vec<Ring<Site>> {
    let inner = &lists[3];
    let site = |u: f64, v: f64, steps: [u32; 2], set_off| Site { at: [u, v], steps, set_off };
    let edge = |list: &[Entry], at: fn(f64) -> [f64; 2]| -> Vec<Site> {
        let point = |entry: &Entry| {
            let [u, v] = at(entry.parameter);
            site(u, v, [entry.steps; 2], false)
        };
        list[..list.len() - 1].iter().map(point).collect()
    };
    let mut rings = vec![vec![
        edge(&lists[0], |t| [0.0, 1.0 - t]),
        edge(&lists[1], |t| [t, 0.0]),
        edge(&lists[2], |t| [1.0 - t, t]),
    ]];
    let mut ring = 1;
    while !least && 2 * ring < inner.len() - 1 {
        let off = inner[ring].parameter * 2.0 / 3.0;
        let along = &inner[ring..inner.len() - 1 - ring];
        let side = |at: fn(f64, f64) -> [f64; 2]| -> Vec<Site> {
            let point = |entry: &Entry| {
                let [u, v] = at(off, entry.parameter - off / 2.0);
                site(u, v, [entry.steps.max(ring as u32); 2], true)
            };
            along.iter().map(point).collect()
        };
        rings.push(vec![
            side(|off, t| [off, 1.0 - t - off]),
            side(|off, t| [t, off]),
            side(|off, t| [1.0 - t - off, t]),
        ]);
        ring += 1;
    }
    if inner.len() % 2 == 1 {
        rings.push(vec![vec![site(1.0 / 3.0, 1.0 / 3.0, [0; 2], true)]]);
    }
    rings
}
