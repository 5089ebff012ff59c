//! Midpoint subdivision: lists are trees within their depths, mirrored where a curve is walked
//! backwards; and patches that share a bit-equal edge share its vertices.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../../tests/support/random.rs"]
mod random;

use random::{Kind, Random, patch};
use rtl_model::evaluate::{Evaluate, Scheme, Settings};
use rtl_model::level::{Criterion, State, Subdivide, Termination, subdivide};
use rtl_model::number::{Format, Overflow, Rounding};
use rtl_model::patch::{Depth, Dyadic, EDGES, Level, Lists, ONE, Patch, Point, Vertex, View};
use rtl_model::place::{DyadicPlacement, Numbering};

fn view(random: &mut Random) -> View {
    let position = Format::of_range(random.integer(8, 48), 0);
    View {
        position,
        viewport: [random.integer(1, 4096), random.integer(1, 16384)],
        depth: Depth::ZeroToOne,
        near: (position.max() as f64 * random.of([0.0, 1e-4, 0.1, 0.5])) as i64,
        facing: 1,
    }
}

fn pixels(random: &mut Random) -> u32 {
    (random.octaves(2f64.powi(-10), 64.0) * 65536.0) as u32
}

/// Whether every entry stands on its parents: no midpoint without the piece that it divides.
fn is_tree(list: Dyadic) -> bool {
    (1..128_u32).filter(|&k| list.contains(k)).all(|k| {
        let length = 1 << k.trailing_zeros();
        list.contains(k - length) && list.contains(k + length)
    })
}

#[test]
fn a_reversed_curve_has_the_mirrored_list() {
    let mut random = Random::new(0x5bd1);
    let (mut curves, mut entries, mut uneven, mut clamped, mut partly) = (0, 0, 0, 0, 0);
    for n in 0..40_000 {
        let view = view(&mut random);
        let patch = patch(&mut random, Kind::ALL[n % 7], view.position.max());
        let curve = random.of(EDGES).map(|k| patch.points[k]);
        let (a, b) = (random.integer(0, 7), random.integer(0, 7));
        let depths = random.of([[0, 7], [0, 7], [a.min(b), a.max(b)]]);
        let rule = Subdivide { view: &view, pixels: pixels(&mut random), depths };
        let [a, b, c, d] = curve;
        let (one, other) = (rule.accept(&curve), rule.accept(&[d, c, b, a]));
        assert_eq!(one.list.reversed(), other.list, "{curve:?} in {view:?}");
        assert_eq!((one.splits, one.clamped), (other.splits, other.clamped));
        assert_eq!(one.splits as usize, one.list.inner(), "a split makes an entry");
        assert!(is_tree(one.list), "{:?}", one.list);
        let [least, most] = depths.map(Dyadic::uniform);
        assert_eq!(one.list.union(least), one.list, "the least depth is reached");
        assert_eq!(one.list.union(most), most, "the greatest depth is kept");
        curves += 1;
        entries += one.list.inner();
        uneven += usize::from((0..8).all(|depth| one.list != Dyadic::uniform(depth)));
        clamped += usize::from(one.clamped);
        let near = curve.iter().filter(|p| p[3] < view.near || p[3] <= 0).count();
        partly += usize::from(near > 0 && near < 4 && one.list != most && one.list != least);
    }
    println!(
        "compared {curves} curves, {entries} entries; {uneven} uneven, {clamped} clamped, {partly} \
         adaptive through the near plane"
    );
    assert!(uneven > 3_000 && clamped > 1_000 && partly > 300 && curves - clamped > 1_000);
}

/// A patch of which each side is drawn by hand: straight, and bent by 8 pixels at its second point.
#[test]
fn pieces_are_divided_where_the_curve_bends() {
    let position = Format::of_range(32, 0);
    let view = View { position, viewport: [1024; 2], depth: Depth::ZeroToOne, near: 1, facing: 1 };
    let w = 1 << 30;
    let pixel = w / 512; // w is 512 pixels
    let point = |x: i64, y: i64| [x * pixel, y * pixel, 0, w];
    let straight = [0, 1, 2, 3].map(|k| point(100 * k, 0));
    let bent = [point(0, 0), point(8, 8), point(200, 0), point(300, 0)];
    let list = |curve: &[Point; 4], pixels: u32, depths| {
        Subdivide { view: &view, pixels, depths }.accept(curve)
    };
    let one = list(&straight, 1, [0, 7]);
    assert_eq!((one.list, one.splits, one.clamped), (Dyadic::NONE, 0, false));
    assert_eq!(list(&straight, 1, [3, 7]).list, Dyadic::uniform(3));
    // 8 pixels are the second point's height: flat at that, and not at one ulp less.
    assert_eq!(list(&bent, 8 << 16, [0, 7]).list, Dyadic::NONE);
    assert!(list(&bent, (8 << 16) - 1, [0, 7]).list.contains(64));
    // Near the bend only.
    let fine = list(&bent, 1 << 16, [0, 7]).list;
    assert!(fine.contains(32) && !fine.contains(96), "{fine:?}");
    let clamped = list(&bent, 1 << 10, [0, 2]);
    assert_eq!((clamped.list, clamped.clamped), (Dyadic::uniform(2), true));
    // A loop: both ends at one point, so that distances count.
    let closed = [point(0, 0), point(3, 4), point(-3, 4), point(0, 0)];
    assert_eq!(list(&closed, 5 << 16, [0, 7]).list, Dyadic::NONE);
    assert!(list(&closed, (5 << 16) - 1, [0, 7]).list.contains(64));
}

fn state(random: &mut Random) -> State {
    let mut level = || Level::clamped((65536.0 * random.octaves(1.0, 128.0)) as u64);
    let (a, b, c) = (level(), level(), level());
    let pixels = pixels(random);
    let criterion = match random.integer(0, 9) {
        0 => Criterion::Fixed { level: c },
        1 => Criterion::EdgeLength { pixels },
        _ => Criterion::Flatness { pixels },
    };
    let (min, max) = random.of([(Level::MIN, Level::MAX), (a.min(b), a.max(b))]);
    State { criterion, min, max }
}

/// Vertices along an edge, in the direction of its growing parameter.
fn row(lists: &Lists, vertices: &[Vertex], edge: usize) -> Vec<(Point, u32)> {
    let starts = lists.starts();
    let along = |v: &Vertex| (v.position, if edge.is_multiple_of(2) { v.u } else { v.v });
    let at = |k| along(&vertices[lists.boundary_vertex(&starts, edge, k)]);
    (0..=lists.edge(edge)).map(at).collect()
}

#[test]
fn patches_that_share_an_edge_share_its_vertices() {
    let mut random = Random::new(0xed6e);
    let (mut edges, mut vertices, mut uneven, mut other) = (0, 0, 0, 0);
    for n in 0..6_000 {
        let (view, state) = (view(&mut random), state(&mut random));
        let termination = random.of([Termination::EightCurves, Termination::Bounded]);
        let [a, mut b] =
            [(); 2].map(|()| patch(&mut random, Kind::ALL[n % 7], view.position.max()));
        let [i, j] = [(); 2].map(|()| random.integer(0, 3) as usize);
        let reversed = random.integer(0, 1) == 1;
        for k in 0..4 {
            b.points[EDGES[j][if reversed { 3 - k } else { k }]] = a.points[EDGES[i][k]];
        }
        let width = view.position.width;
        let settings = Settings {
            position: view.position,
            guard: 1 + random.integer(0, 11.min(59 - width)),
            scheme: random.of([Scheme::Forward, Scheme::Mixed, Scheme::DeCasteljau]),
            rounding: random.of(Rounding::ALL),
            overflow: random.of(Overflow::ALL),
        };
        let tessellate = |patch: &Patch| {
            let (lists, events) = subdivide(patch, &view, &state, termination);
            let mut placement = DyadicPlacement::default();
            placement.set_lists(&lists);
            let mut out = Vec::new();
            let cost = Evaluate::new(settings).accept(patch, &placement, &mut out);
            assert_eq!(cost.curves, 0, "no forward differences on dyadic lists");
            (lists, out, events)
        };
        let ((la, va, ea), (lb, vb, _)) = (tessellate(&a), tessellate(&b));
        let (ra, mut rb) = (row(&la, &va, i), row(&lb, &vb, j));
        if reversed {
            rb.reverse();
            rb.iter_mut().for_each(|(_, t)| *t = ONE - *t);
        }
        assert_eq!(ra, rb, "edges {i} and {j}, {reversed}: {a:?} {b:?} {view:?} {state:?}");
        let list = la.edges()[i];
        uneven += usize::from((0..8).all(|depth| list != Dyadic::uniform(depth)));
        other += usize::from(
            la.edges().iter().chain(lb.edges()).any(|l| l.segments() != list.segments()),
        );
        let literal = matches!(state.criterion, Criterion::Flatness { .. })
            && termination == Termination::EightCurves;
        assert!(literal || ea.splits == 0);
        (edges, vertices) = (edges + 1, vertices + ra.len());
    }
    println!("compared {edges} edge pairs, {vertices} vertices");
    println!("{uneven} of uneven lists, {other} beside another list");
    assert!(edges == 6_000 && uneven > 500 && other > 2_000);
}

/// A twist: straight edges and straight rows, so that only the bound sees it (LITERATURE: second
/// derivatives of a surface).
#[test]
fn a_twist_is_flat_to_eight_curves_and_not_to_the_bound() {
    let position = Format::of_range(32, 0);
    let view = View { position, viewport: [1024; 2], depth: Depth::ZeroToOne, near: 1, facing: 1 };
    let w = 1 << 30;
    let points = std::array::from_fn(|k| {
        let (u, v) = (k as i64 % 4, k as i64 / 4);
        [(100 * u) * w / 1536, (100 * v + 200 * u * v / 9) * w / 1536, 0, w]
    });
    let patch = Patch { id: 0, points, saturated: false, cull: true, reversed: false };
    let criterion = Criterion::Flatness { pixels: 1 << 15 };
    let state = State { criterion, min: Level::MIN, max: Level::MAX };
    let segments = |termination| {
        let (lists, events) = subdivide(&patch, &view, &state, termination);
        (lists.edges().map(Dyadic::segments), lists.u().segments(), events.splits)
    };
    assert_eq!(segments(Termination::EightCurves), ([1; 4], 1, 0));
    let (edges, u, _) = segments(Termination::Bounded);
    assert_eq!(edges, [1; 4]);
    assert!(u >= 4, "{u}");
}
