//! The surface shader against its definition: samples, decisions, meshes and counts.

use super::ledger::Ledger;
use super::random::{Kind, Random, patch};
use super::table::budget::{guard_matters, half_run, horner, parameter_matters, rounding};
use super::table::{At, Quantity as Q};
use super::walk::Drawn;
use rtl_model::esc::{
    Boundary, ControlMesh, Input, LEVEL_MAX, Levels, Made, Reuse, Settings, Surface, Threshold,
    fraction,
};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{EDGES, Patch, Point, Vertex, View};
use std::collections::{BTreeMap, BTreeSet};
use tessim::golden::esc::surface::{self, Candidate, Site, UNIT};
use tessim::golden::{Real, evaluate, real};

/// A patch in a shader's hands.
struct Case<'a> {
    settings: Settings,
    view: &'a View,
    levels: Levels,
    patch: &'a Patch,
    object: [Point; 16],
}

/// One patch under random settings.
pub(crate) fn random(ledger: &mut Ledger, random: &mut Random, view: &View) {
    let kind = random.of(Kind::ALL);
    let subject = patch(random, kind, view.position.max());
    let object = Format::of_range(random.integer(8, 48), random.integer(0, 4) as i32);
    let kind = random.of([Kind::Wild, Kind::Sheet, Kind::Sheet]);
    let mut net = patch(random, kind, object.max()).points;
    if random.integer(0, 2) > 0 {
        let one = (1_i64 << object.fraction).min(object.max());
        net = net.map(|[x, y, z, _]| [x, y, z, one]);
    }
    let settings = settings(random, view.position, object);
    let levels = levels(random);
    compare(ledger, &Case { settings, view, levels, patch: &subject, object: net });
}

/// A patch of a shipped trace.
pub(crate) fn trace(ledger: &mut Ledger, drawn: &Drawn) {
    let mut random = Random::new(0xe5c_0011 + u64::from(drawn.patch.id));
    let view = &drawn.frame.view;
    let object = Format::of_range(32, 6);
    let raw = |c: f64| (c * 2f64.powi(object.fraction)).round() as i64;
    let net = std::array::from_fn(|k| drawn.object[k].map(raw));
    for _ in 0..2 {
        let settings = settings(&mut random, view.position, object);
        let levels = levels(&mut random);
        compare(ledger, &Case { settings, view, levels, patch: &drawn.patch, object: net });
    }
}

fn settings(random: &mut Random, position: Format, object: Format) -> Settings {
    let room = Settings::guard_max(position.width.max(object.width));
    let (guard, bits) = (random.integer(0, room), random.integer(16, 46));
    let pixels = (random.octaves(0.02, 500.0) * 65536.0) as u32;
    let ulps = random.octaves(1e-4, 0.5) * 2f64.powi(object.width as i32 + 7);
    Settings {
        position,
        object,
        guard: random.of([0, room, guard]),
        parameter_bits: random.of([16, 46, bits]),
        rounding: random.of(Rounding::ALL),
        overflow: random.of(Overflow::ALL),
        mesh: random.of(ControlMesh::ALL),
        threshold: random.of([
            Threshold::Uniform,
            Threshold::pixels(pixels),
            Threshold::object(ulps as u64),
        ]),
        boundary: random.of([Boundary::Symmetric, Boundary::Symmetric, Boundary::Plain]),
        reuse: random.of(Reuse::ALL),
        output: None,
    }
}

fn levels(random: &mut Random) -> Levels {
    let most = random.of([2, 4, 7, LEVEL_MAX]);
    let interior = random.integer(0, most.into()) as u8;
    let mut edge = || random.integer(0, interior.into()) as u8;
    let edges = [edge(), edge(), edge(), edge()];
    Levels { edges: random.of([[interior; 4], edges]), interior }
}

fn compare(ledger: &mut Ledger, case: &Case<'_>) {
    let Case { settings, view, levels, patch, object } = case;
    let mut shader = Surface::new(*settings);
    let mut vertices = Vec::new();
    let input = Input { patch, object: Some(object), view, levels: *levels };
    let made = shader.accept(&input, &mut vertices);
    let sites: Vec<Site> = vertices.iter().map(exact).collect();
    if made.overflows == 0 {
        let points = real(&patch.points);
        for (vertex, site) in vertices.iter().zip(&sites) {
            sample(ledger, case, &points, vertex.position, *site);
        }
    }
    let there: BTreeSet<Site> = sites.iter().copied().collect();
    let candidates = surface::candidates(levels.edges, levels.interior);
    if made.overflows == 0 {
        decisions(ledger, case, &candidates, &there);
    }
    let inserted: Vec<Candidate> =
        candidates.into_iter().filter(|candidate| there.contains(&candidate.site)).collect();
    let want = surface::mesh(&inserted, levels.interior);
    let got: Vec<[Site; 3]> =
        shader.triangles().iter().map(|t| least_first(t.map(|k| sites[usize::from(k)]))).collect();
    let triangles: Vec<[Site; 3]> = want.triangles.iter().copied().map(least_first).collect();
    ledger.equal(Q::EscMesh, got, triangles);
    ledger.equal(Q::EscSites, there, want.vertices.clone());
    counts(ledger, case, &made, &want, &inserted);
}

/// Over UNIT.
fn exact(vertex: &Vertex) -> Site {
    [vertex.u, vertex.v].map(|fx16| {
        let (i, n) = fraction(fx16);
        i64::from(i) * (UNIT / i64::from(n))
    })
}

/// Keeps the winding.
fn least_first(mut triangle: [Site; 3]) -> [Site; 3] {
    let least = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
    triangle.rotate_left(least);
    triangle
}

/// How often points are evaluated for the mesh, and what the strips list.
fn counts(
    ledger: &mut Ledger,
    case: &Case<'_>,
    made: &Made,
    want: &surface::Mesh,
    inserted: &[Candidate],
) {
    let Settings { reuse, .. } = case.settings;
    let points = match reuse {
        Reuse::None => want.listed,
        Reuse::CoarseTriangle => want.apart,
        Reuse::Patch => want.vertices.len(),
    };
    let moved = inserted.iter().filter(|candidate| candidate.site != candidate.slot).count();
    ledger.equal(
        Q::EscEvaluated,
        [
            made.corners + made.boundary + made.coarse + made.interior,
            made.strip_vertices,
            made.distinct,
            made.moved,
        ],
        [points, want.listed, want.vertices.len(), moved].map(|count| count as u64),
    );
}

/// The edge of the patch on which a site is.
fn edge(site: Site) -> Option<usize> {
    [site[1] == 0, site[0] == UNIT, site[1] == UNIT, site[0] == 0].iter().position(|&on| on)
}

fn is_corner(site: Site) -> bool {
    site.iter().all(|t| t % UNIT == 0)
}

fn reals(site: Site) -> [f64; 2] {
    site.map(|t| t as f64 / UNIT as f64)
}

/// The point at a site, and for each coordinate what the sample's budget depends on.
fn definition(
    points: &[Real; 16],
    format: Format,
    settings: &Settings,
    site: Site,
) -> (Real, [At; 4]) {
    let [u, v] = reals(site);
    let [du, dv] = evaluate::derivatives(points, u, v);
    // A parameter is off by half an ulp; the second derivatives are at most 24 times, the mixed one
    // at most 36 times the largest coordinate.
    let off = 2f64.powi(-(settings.parameter_bits as i32) - 1);
    let largest = points.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()));
    let at = |axis: usize| {
        let slope = |d: &Real, t: f64| if t == 0.0 || t == 1.0 { 0.0 } else { d[axis].abs() };
        let spread = off * (slope(&du, u) + slope(&dv, v)) + 60.0 * largest * off * off;
        let Settings { guard, rounding, .. } = *settings;
        At { width: format.width, guard, rounding, spread, ..At::default() }
    };
    let want = match (edge(site), settings.boundary) {
        (Some(edge), Boundary::Symmetric) => {
            evaluate::curve(&EDGES[edge].map(|k| points[k]), if edge % 2 == 0 { u } else { v })
        }
        _ => evaluate::surface(points, u, v),
    };
    (want, [0, 1, 2, 3].map(at))
}

fn sample(ledger: &mut Ledger, case: &Case<'_>, points: &[Real; 16], got: Point, site: Site) {
    if is_corner(site) {
        let [column, row] = site.map(|t| (t / UNIT * 3) as usize);
        ledger.equal(Q::EscCorner, got, case.patch.points[4 * row + column]);
        return;
    }
    let (want, at) = definition(points, case.settings.position, &case.settings, site);
    let half = edge(site).is_some() && case.settings.boundary == Boundary::Symmetric;
    for axis in 0..4 {
        let error = (got[axis] as f64 - want[axis]).abs();
        let at = &at[axis];
        let quantity = match half {
            _ if parameter_matters(at) => Q::EscParameter,
            true => Q::EscBoundary,
            false if guard_matters(at) => Q::EscUnguarded,
            false => Q::EscInside,
        };
        ledger.error(quantity, at, error);
    }
}

/// Every decision that rounding cannot turn.
fn decisions(
    ledger: &mut Ledger,
    case: &Case<'_>,
    candidates: &[Candidate],
    there: &BTreeSet<Site>,
) {
    let Settings { threshold, position, object, .. } = case.settings;
    let (points, format) = match threshold {
        Threshold::Uniform => {
            let all = candidates.iter().all(|candidate| there.contains(&candidate.site));
            return ledger.equal(Q::EscDecision, all, true);
        }
        Threshold::Pixels(_) => (real(&case.patch.points), position),
        Threshold::Object(_) => (real(&case.object), object),
    };
    let mut known = BTreeMap::new();
    for candidate in candidates {
        let mut at = |site| *known.entry(site).or_insert_with(|| near(case, &points, format, site));
        let surface = at(candidate.site);
        let ends = candidate.ends.map(|end| match case.settings.mesh {
            ControlMesh::Chord => at(end),
            ControlMesh::Net => {
                let [column, row] = end.map(|t| (3 * t / UNIT) as usize);
                (points[4 * row + column], [0.0; 4])
            }
        });
        let mesh = on_mesh(case, ends, candidate.part);
        let (distance, most) = match threshold {
            Threshold::Pixels(most) => {
                (on_screen(mesh, surface, case.view), f64::from(most) / 65536.0)
            }
            Threshold::Object(most) => {
                (in_object(mesh, surface, 2f64.powi(object.fraction)), most as f64 / 256.0)
            }
            Threshold::Uniform => unreachable!("tests nothing"),
        };
        let want = match distance {
            Distance::None => true,
            Distance::Known(distance, band) if (distance - most).abs() > band => distance > most,
            _ => {
                ledger.unclear += 1;
                continue;
            }
        };
        ledger.equal(Q::EscDecision, there.contains(&candidate.site), want);
    }
}

/// The sampling point of the control mesh.
fn on_mesh(case: &Case<'_>, [a, b]: [Near; 2], [k, segments]: [i64; 2]) -> Near {
    let t = k as f64 / segments as f64;
    let ulp = rounding(&At { rounding: case.settings.rounding, ..At::default() });
    let point = [0, 1, 2, 3].map(|axis| a.0[axis] * (1.0 - t) + b.0[axis] * t);
    let off = [0, 1, 2, 3].map(|axis| {
        let exact = a.0[axis] == b.0[axis] && a.1[axis] + b.1[axis] == 0.0;
        if exact { 0.0 } else { ulp + a.1[axis].max(b.1[axis]) }
    });
    (point, off)
}

/// A point and how far off each coordinate may be.
type Near = (Real, [f64; 4]);

/// A sample of the surface. What is constant over the net is exact.
fn near(case: &Case<'_>, points: &[Real; 16], format: Format, site: Site) -> Near {
    let (point, at) = definition(points, format, &case.settings, site);
    let half = edge(site).is_some() && case.settings.boundary == Boundary::Symmetric;
    let constant = |axis: usize| points.iter().all(|p| p[axis] == points[0][axis]);
    let off = std::array::from_fn(|axis| match half {
        _ if is_corner(site) || constant(axis) => 0.0,
        true => half_run(&at[axis]),
        false => horner(&at[axis]),
    });
    (point, off)
}

/// What is known of a distance.
enum Distance {
    /// A point has no projection.
    None,
    /// Rounding may decide whether one has.
    Unsure,
    /// It, and how far off it may be.
    Known(f64, f64),
}

/// `x / w` in units of which `w` has `one`, and how far off it may be; `ulp` is the rounding's.
fn quotient((p, off): Near, axis: usize, one: f64, ulp: f64) -> (f64, f64) {
    let q = p[axis] / p[3] * one;
    let band = (one * off[axis] + q.abs() * off[3]) / (p[3] - off[3]);
    (q, band + ulp / 2.0 + q.abs() * 1e-15)
}

fn distance<const N: usize>(a: [(f64, f64); N], b: [(f64, f64); N]) -> Distance {
    let pairs = || a.iter().zip(&b);
    let square: f64 = pairs().map(|(a, b)| (a.0 - b.0).powi(2)).sum();
    let band: f64 = pairs().map(|(a, b)| (a.1 + b.1).powi(2)).sum();
    Distance::Known(square.sqrt(), band.sqrt() + 1e-12 * square.sqrt())
}

/// In pixels.
fn on_screen(a: Near, b: Near, view: &View) -> Distance {
    let near = (view.near as f64).max(1.0); // raw: at least 1
    for (p, off) in [a, b] {
        if p[3] + off[3] < near {
            return Distance::None;
        }
    }
    let pixel = |p: Near| {
        [0, 1].map(|axis| quotient(p, axis, f64::from(view.viewport[axis]) / 2.0, 1.0 / 65536.0))
    };
    let [p, q] = [a, b].map(pixel);
    let sure = [a, b].iter().all(|(p, off)| p[3] - off[3] >= near);
    // Beyond 2^23 pixels there is no projection.
    if !sure || p.iter().chain(&q).any(|(q, band)| q.abs() + band > 8_388_607.0) {
        return Distance::Unsure;
    }
    distance(p, q)
}

/// In ulps.
fn in_object(a: Near, b: Near, one: f64) -> Distance {
    for (p, off) in [a, b] {
        if p[3] + off[3] < 0.5 {
            return Distance::None;
        }
    }
    let affine = |p: Near| {
        let exact = p.0[3] == one && p.1[3] == 0.0;
        [0, 1, 2].map(|axis| quotient(p, axis, one, if exact { 0.0 } else { 1.0 / 256.0 }))
    };
    let [p, q] = [a, b].map(affine);
    let sure = [a, b].iter().all(|(p, off)| p[3] - off[3] > 0.5);
    if !sure || p.iter().chain(&q).any(|(q, band)| q.abs() + band > 2f64.powi(52)) {
        return Distance::Unsure;
    }
    distance(p, q)
}
