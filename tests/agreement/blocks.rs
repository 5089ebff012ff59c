//! One function a block: its output on one token against its golden model's, into the ledger.

use super::ledger::Ledger;
use super::table::budget::{drifts, forward_surface};
use super::table::{At, Quantity as Q};
use ethnum::I256;
use rtl_model::assemble::{Cache, FanEncoding, Primitive};
use rtl_model::attribute;
use rtl_model::backface::{self, Verdict};
use rtl_model::evaluate::{Evaluate, Settings};
use rtl_model::number::{Format, Modal, Overflow, OverflowMode, Rounding, RoundingMode, dispatch};
use rtl_model::patch::{EDGES, Levels, ONE, Patch, Triangle, Vertex, View};
use rtl_model::place::{Numbering, Parameters, Placement};
use rtl_model::stitch::{Degenerate, Stitch};
use rtl_model::{clip, emit, port};
use tessim::config::{BackfaceMethod, Scheme};
use tessim::golden::{self, Real};

struct Quantise(f32, Format);

impl Modal for Quantise {
    type Output = (i64, bool);

    fn run<R: RoundingMode, O: OverflowMode>(self) -> (i64, bool) {
        let got = port::accept::<R, O>([self.0.to_bits(), 0, 0, 0], self.1);
        (got.point[0], got.overflows == 0)
    }
}

pub(crate) fn port(ledger: &mut Ledger, value: f32, format: Format, modes: (Rounding, Overflow)) {
    let got = dispatch(modes.0, modes.1, Quantise(value, format));
    let shape = (format.width, format.fraction);
    let want = golden::port::quantise(value, shape, modes.0, modes.1);
    ledger.equal(Q::PortValue, got.0, want.0);
    ledger.equal(Q::PortFits, got.1, want.1);
}

pub(crate) fn assemble(ledger: &mut Ledger, primitive: Primitive) {
    let cells = match primitive {
        Primitive::Patches { count } => golden::assemble::patches(count as u32),
        Primitive::Mesh { rows, columns } => golden::assemble::mesh(rows, columns),
        Primitive::Strip { count } => golden::assemble::strip(count as u32),
        Primitive::Fan { count, encoding } => {
            golden::assemble::fan(count as u32, encoding == FanEncoding::Compact)
        }
        Primitive::Indexed { .. } => unreachable!("its indices say"),
    };
    assert_eq!(cells.len() as u64, primitive.patches());
    for (n, cell) in (0..).zip(&cells) {
        ledger.equal(Q::AssemblePoints, primitive.indices(n), cell.points);
        ledger.equal(Q::AssembleNew, primitive.received(n), cell.new);
    }
    let held = golden::assemble::held_peak(&cells);
    let spare = primitive.edge_entries_peak() as f64 - held as f64;
    // Fewer entries than points that are still needed is no rounding but a loss.
    ledger.error(Q::AssembleHeld, &At::default(), if spare < 0.0 { f64::INFINITY } else { spare });
}

pub(crate) fn cache(ledger: &mut Ledger, indices: &[u32], entries: u32) {
    let mut cache = Cache::new(entries);
    let lacking = golden::assemble::lacking(indices, entries as usize);
    for (&index, want) in indices.iter().zip(lacking) {
        ledger.equal(Q::AssembleCached, !cache.fetch(index), want);
    }
}

struct Attribute([i64; 4], [u32; 2]);

impl Modal for Attribute {
    type Output = i64;

    fn run<R: RoundingMode, O: OverflowMode>(self) -> i64 {
        attribute::accept::<R>(self.0, self.1[0], self.1[1])
    }
}

pub(crate) fn attribute(ledger: &mut Ledger, corners: [i64; 4], at: [u32; 2], rounding: Rounding) {
    let got = dispatch(rounding, Overflow::Saturate, Attribute(corners, at));
    let [u, v] = at.map(|t| f64::from(t) / f64::from(ONE));
    let want = golden::attribute::bilinear(corners.map(|c| c as f64), u, v);
    let at = At { rounding, ..At::default() };
    ledger.error(Q::Attribute, &at, (got as f64 - want).abs());
}

pub(crate) fn clip(ledger: &mut Ledger, patch: &Patch, view: &View) {
    let want = golden::clip::outside(&patch.points, view.depth);
    ledger.equal(Q::ClipVerdict, clip::outside(patch, view.depth), want);
}

pub(crate) fn backface(ledger: &mut Ledger, patch: &Patch, view: &View) {
    let front = if patch.reversed { -view.facing } else { view.facing };
    let margin = golden::backface::margin(&patch.points, front);
    let close = margin.is_some_and(|margin| margin.abs() < golden::backface::ROUNDING);
    let mut culled = false;
    for (quantity, method) in [
        (Q::FacetsVerdict, BackfaceMethod::NetFacets),
        (Q::TangentVerdict, BackfaceMethod::TangentPlane),
        (Q::ConeVerdict, BackfaceMethod::NormalCone),
        (Q::HullVerdict, BackfaceMethod::HullLiteral),
    ] {
        let (verdict, facets) = backface::accept(patch, view, method);
        let got = (verdict != Verdict::Untested).then_some(verdict == Verdict::Culled);
        if method != BackfaceMethod::NormalCone || !close {
            ledger.equal(quantity, got, golden::backface::culled(patch, view, method));
        }
        if let Some(want) = golden::backface::looked_at(patch, view, method) {
            ledger.equal(Q::FacetsTested, facets, want);
        }
        let conservative =
            matches!(method, BackfaceMethod::TangentPlane | BackfaceMethod::NormalCone);
        culled |= conservative && got == Some(true);
    }
    let rows = patch.points.map(|[x, y, _, w]| [x, y, w]);
    let got = backface::coefficients::<I256>(&rows).map(|row| row.map(|c| c * I256::new(9)));
    ledger.equal(Q::TangentCoefficients, got, golden::backface::bernstein(&patch.points));
    for k in (0..121).filter(|_| culled) {
        let (u, v) = (f64::from(k % 11) / 10.0, f64::from(k / 11) / 10.0);
        ledger.equal(Q::FalseCulls, golden::backface::facing(patch, view, u, v) > 0.0, false);
    }
}

/// Place and stitch. Returns the placements of both sides.
pub(crate) fn place(
    ledger: &mut Ledger,
    levels: &Levels,
    reciprocal_bits: u32,
) -> (Placement, golden::place::Placed) {
    let mut got = Placement::of_reciprocal(reciprocal_bits);
    got.set(levels);
    let want = golden::place::place(levels, reciprocal_bits);
    let spread = 2f64.powi(16 - reciprocal_bits as i32);
    let counts =
        |edges: [usize; 4], columns, rows, reciprocals| (edges, columns, rows, reciprocals);
    let edges = got.edges.each_ref().map(|list| list.parameters().len());
    let [columns, rows] = got.interior();
    ledger.equal(
        Q::PlaceCounts,
        counts(edges, columns, rows, got.reciprocals() as usize),
        counts(
            want.edges.each_ref().map(Vec::len),
            want.columns.len(),
            want.rows.len(),
            want.reciprocals,
        ),
    );
    let inner = |list: &rtl_model::place::List| list.parameters()[1..list.segments()].to_vec();
    let lists = got.edges.each_ref().map(|list| list.parameters().to_vec());
    let lists = lists.into_iter().chain([inner(&got.u), inner(&got.v)]);
    let wanted = want.edges.iter().chain([&want.columns, &want.rows]);
    for (list, entries) in lists.zip(wanted) {
        for (&parameter, entry) in list.iter().zip(entries) {
            let error = (f64::from(parameter) - entry.parameter.real() * 65536.0).abs();
            let at = At { steps: [entry.steps, 0], spread, ..At::default() };
            ledger.error(Q::PlaceParameter, &at, error);
        }
    }
    (got, want)
}

pub(crate) fn stitch(
    ledger: &mut Ledger,
    placement: &Placement,
    placed: &golden::place::Placed,
) -> Vec<Triangle> {
    let triangles = Stitch::default().accept(placement.segments()).to_vec();
    let numbers = triangles.iter().map(|t| t.map(usize::from)).collect();
    let got = golden::stitch::canonical(numbers);
    ledger.equal(Q::StitchTriangles, got, golden::stitch::triangles(placed));
    triangles
}

pub(crate) fn degenerate(
    ledger: &mut Ledger,
    placement: &impl Numbering,
    vertices: &[Vertex],
    triangles: &[Triangle],
) {
    let got = Degenerate::default().count(placement, vertices, triangles);
    let want = golden::stitch::degenerate(vertices, triangles);
    ledger.equal(Q::StitchDegenerate, got, want);
}

pub(crate) fn evaluate<L: Parameters>(
    ledger: &mut Ledger,
    patch: &Patch,
    settings: Settings,
    (placement, placed): (&Placement<L>, &golden::place::Placed),
) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    Evaluate::new(settings).accept(patch, placement, &mut vertices);
    let sites = placed.sites();
    assert_eq!(vertices.len(), sites.len());
    let points = golden::real(&patch.points);
    let at = |steps| At {
        width: settings.position.width,
        guard: settings.guard,
        steps,
        rounding: settings.rounding,
        spread: 0.0,
    };
    let largest = patch.points.iter().flatten().map(|c| c.abs()).max().unwrap_or(0) as f64;
    // A row's control point that wraps is another row: the surface is compared where none can.
    let wraps = settings.overflow == Overflow::Wrap
        && largest + forward_surface(&at([64; 2])) > settings.position.max() as f64;
    for (vertex, site) in vertices.iter().zip(&sites) {
        let reported = [vertex.u, vertex.v].map(|t| f64::from(t) / 65536.0);
        let got = vertex.position.map(|c| c as f64);
        if let Some((edge, entry)) = site.on_edge() {
            let forward = settings.scheme != Scheme::DeCasteljau;
            let along = reported[if site.edge.is_some_and(|e| e % 2 == 0) { 0 } else { 1 }];
            let curve = edge.map(|k| points[k]);
            let t = if forward { entry.run } else { along };
            let want = golden::evaluate::curve(&curve, t);
            let at = at([entry.steps, 0]);
            let quantity = if forward { Q::ForwardBoundary } else { Q::CasteljauBoundary };
            let error = distance(got, want, settings.position.width);
            ledger.error(quantity, &at, error);
            if forward && drifts(&at) {
                ledger.error(Q::DriftBoundary, &at, error);
            }
            if forward && entry.parameter == golden::place::Fraction::HALF {
                // Exact in f64: at most 51 bits.
                let centre = want.map(|c| golden::port::rounded(c, settings.rounding));
                ledger.equal(Q::Centres, distance(got, centre, settings.position.width), 0.0);
            }
        } else if !wraps {
            let forward = settings.scheme == Scheme::Forward;
            let [u, v] = if forward { [site.u.run, site.v.run] } else { reported };
            let want = golden::evaluate::surface(&points, u, v);
            let at = at([site.u.steps, site.v.steps]);
            let quantity = if forward { Q::ForwardInterior } else { Q::CasteljauInterior };
            let error = distance(got, want, settings.position.width);
            ledger.error(quantity, &at, error);
            if forward && drifts(&at) {
                ledger.error(Q::DriftInterior, &at, error);
            }
        }
    }
    corners(ledger, patch, placement, &vertices);
    vertices
}

/// Parameters in U1.16.
pub(crate) fn reals(list: &impl Parameters) -> Vec<f64> {
    list.parameters().iter().map(|&t| t.into()).collect()
}

fn corners<L: Parameters>(
    ledger: &mut Ledger,
    patch: &Patch,
    placement: &Placement<L>,
    vertices: &[Vertex],
) {
    let mut first = 0;
    // Counter-clockwise, each edge begins at the corner that the one before it left.
    for (edge, corner) in placement.edges.iter().zip([0, 3, 15, 12]) {
        ledger.equal(Q::Corners, vertices[first].position, patch.points[corner]);
        first += edge.segments();
    }
    assert_eq!(EDGES[2][3], 15, "v1 ends where u1 does");
}

/// The greatest difference of a coordinate, modulo 2^width: a value that wrapped is as good as
/// one that did not.
fn distance(got: Real, want: Real, width: u32) -> f64 {
    let span = 2f64.powi(width as i32);
    let off = |k: usize| {
        let d = (got[k] - want[k]).rem_euclid(span);
        d.min(span - d)
    };
    (0..4).map(off).fold(0.0, f64::max)
}

pub(crate) fn emit(
    ledger: &mut Ledger,
    vertices: &[Vertex],
    view: &View,
    settings: emit::Settings,
) {
    let mut screen = Vec::new();
    let homogeneous = emit::accept(vertices, view, settings, &mut screen);
    assert_eq!(homogeneous, screen.iter().filter(|s| !s.divided).count() as u64);
    let scale = 2f64.powi(settings.subpixel_bits as i32);
    let at = At { rounding: settings.rounding, ..At::default() };
    for (vertex, got) in vertices.iter().zip(&screen) {
        let pixel = golden::emit::screen(vertex.position.map(|c| c as f64), view.viewport);
        let farthest = pixel.map_or(f64::MAX, |[x, y]| x.abs().max(y.abs()));
        // Within an ulp of the band's end, f64 does not know which way the quotient is rounded.
        if (farthest - golden::emit::BAND).abs() * scale > 1.0 {
            ledger.equal(Q::EmitDivided, got.divided, farthest < golden::emit::BAND);
        }
        if let (Some([x, y]), true) = (pixel, got.divided) {
            let error = |raw: i32, pixel: f64| (f64::from(raw) - pixel * scale).abs();
            ledger.error(Q::EmitPixel, &at, error(got.x, x).max(error(got.y, y)));
        }
    }
}
