//! The meshes of dyadic lists: what each promises, over all lists of few segments and random ones
//! of many.

#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../../tests/support/random.rs"]
mod random;

use random::Random;
use rtl_model::patch::{Dyadic, Lists, ONE, Triangle};
use rtl_model::place::{DyadicPlacement, Numbering, Parameters};
use rtl_model::stitch::{self, Stitch};
use rtl_model::strip::{Kind, Topology};

/// Vertices' parameters and triangles of lists.
fn pattern(lists: Lists) -> (Vec<[u32; 2]>, Vec<Triangle>) {
    let mut placement = DyadicPlacement::default();
    placement.set_lists(&lists);
    let starts = placement.starts();
    let mut points = vec![[u32::MAX; 2]; placement.vertices()];
    for (edge, list) in placement.edges.iter().enumerate() {
        for (k, &t) in list.parameters().iter().enumerate() {
            let point = [[t, 0], [ONE, t], [t, ONE], [0, t]][edge];
            points[placement.boundary_vertex(&starts, edge, k)] = point;
        }
    }
    let [columns, rows] = placement.interior();
    for (k, point) in points[starts[4]..].iter_mut().enumerate() {
        let (i, j) = (k % columns, k / columns);
        assert!(j < rows);
        *point = [placement.u.parameters()[i + 1], placement.v.parameters()[j + 1]];
    }
    let mut triangles = Vec::new();
    stitch::accept(lists, &mut triangles);
    (points, triangles)
}

/// Everything that a mesh promises. Returns its triangles' number.
fn promises(lists: Lists) -> usize {
    let (points, triangles) = pattern(lists);
    let boundary = lists.boundary();
    assert_eq!(triangles.len(), 2 * points.len() - boundary - 2, "Euler: {lists:?}");
    assert_eq!(triangles.len(), lists.triangles());
    let (mut area, mut edges) = (0, Vec::with_capacity(3 * triangles.len()));
    let mut used = vec![false; points.len()];
    for t in &triangles {
        let [a, b, c] = t.map(|k| points[usize::from(k)].map(i64::from));
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        assert!(twice > 0, "a triangle turned over or without area: {lists:?}");
        area += twice;
        edges.extend([[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        t.iter().for_each(|&k| used[usize::from(k)] = true);
    }
    assert_eq!(area, 2 * i64::from(ONE) * i64::from(ONE), "area: {lists:?}");
    assert!(used.iter().all(|&used| used), "a vertex without triangle: {lists:?}");
    edges.sort_unstable();
    assert!(edges.windows(2).all(|e| e[0] != e[1]), "a directed edge twice: {lists:?}");
    // What has no other side is the boundary, vertex by vertex as the edges' lists have it.
    let open: Vec<_> =
        edges.iter().filter(|[a, b]| edges.binary_search(&[*b, *a]).is_err()).collect();
    assert_eq!(open.len(), boundary, "the boundary: {lists:?}");
    assert!(open.iter().all(|[a, b]| usize::from(*b) == (usize::from(*a) + 1) % boundary));
    let [v0, u1, v1, u0] = lists.edges().map(|list| list.parameters().collect::<Vec<_>>());
    let turned = |list: &[u32]| list.iter().rev().copied().collect::<Vec<_>>();
    let (top, left) = (turned(&v1), turned(&u0));
    let walk = v0.iter().map(|&t| [t, 0]).chain(u1[1..].iter().map(|&t| [ONE, t]));
    let walk = walk.chain(top[1..].iter().map(|&t| [t, ONE]));
    let walk = walk.chain(left[1..left.len() - 1].iter().map(|&t| [0, t]));
    assert!(walk.eq(points[..boundary].iter().copied()), "the edges' lists: {lists:?}");
    triangles.len()
}

/// All lists that midpoint subdivision can make with at most `depth` levels.
fn trees(depth: u32) -> Vec<Dyadic> {
    fn within(first: u32, length: u32, depth: u32) -> Vec<u128> {
        let mut all = vec![0];
        if depth > 0 {
            let half = length / 2;
            for a in within(first, half, depth - 1) {
                for b in within(first + half, half, depth - 1) {
                    all.push(a | b | 1 << (first + half));
                }
            }
        }
        all
    }
    within(0, 128, depth).into_iter().map(Dyadic::of).collect()
}

#[test]
fn all_lists_of_depth_two_make_discs() {
    let all = trees(2);
    assert_eq!(all.len(), 5);
    let (mut meshes, mut triangles, mut kinds) = (0, 0, [0; 3]);
    for n in 0..5_usize.pow(6) {
        let list = |k: u32| all[n / 5_usize.pow(k) % 5];
        let lists = Lists::new([list(0), list(1), list(2), list(3)], list(4), list(5));
        triangles += promises(lists);
        let ladder = usize::from(lists.boundary() > 4);
        kinds[if lists.interior() == [0; 2] { ladder } else { 2 }] += 1;
        meshes += 1;
    }
    println!("compared {meshes} meshes, {triangles} triangles; cells, ladders, grids: {kinds:?}");
    assert_eq!(meshes, 15_625);
    assert!(kinds.iter().all(|&n| n > 0));
}

#[test]
fn all_pairs_of_lists_of_depth_three_are_zipped_on_every_side() {
    let all = trees(3);
    assert_eq!(all.len(), 26);
    let (mut meshes, mut triangles) = (0, 0);
    for side in 0..4 {
        for &outer in &all {
            for &inner in &all {
                for across in [Dyadic::NONE, Dyadic::uniform(1), Dyadic::uniform(3)] {
                    let mut edges = [Dyadic::NONE; 4];
                    edges[side] = outer;
                    let along = [inner, across];
                    let (u, v) = (along[side % 2], along[1 - side % 2]);
                    triangles += promises(Lists::new(edges, u, v));
                    // A ladder with entries on both rails.
                    edges[(side + 2) % 4] = inner;
                    triangles += promises(Lists::new(edges, Dyadic::NONE, Dyadic::NONE));
                    meshes += 2;
                }
            }
        }
    }
    println!("compared {meshes} meshes, {triangles} triangles");
    assert_eq!(meshes, 4 * 26 * 26 * 3 * 2);
}

/// Any subset, or a tree grown at random.
fn list(random: &mut Random) -> Dyadic {
    let any = u128::from(random.bits()) << 64 | u128::from(random.bits());
    match random.integer(0, 5) {
        0 => Dyadic::uniform(random.integer(0, 7)),
        1 => Dyadic::of(any),
        2 => Dyadic::of(any & any.rotate_left(random.integer(1, 127))),
        3 => Dyadic::NONE,
        _ => {
            let mut tree = Dyadic::NONE;
            for level in 0..random.integer(0, 7) {
                for k in 0..1 << level {
                    let (first, length) = ((128 >> level) * k, 128 >> level);
                    let parent = tree.contains(first) && tree.contains(first + length);
                    if parent && random.integer(0, 3) > 0 {
                        tree.insert(first + length / 2);
                    }
                }
            }
            tree
        }
    }
}

fn lists(random: &mut Random) -> Lists {
    let mut list = || list(random);
    Lists::new([list(), list(), list(), list()], list(), list())
}

#[test]
fn random_lists_make_discs() {
    let mut random = Random::new(0xd1ad);
    let (mut triangles, mut most) = (0, 0);
    for _ in 0..2_000 {
        let lists = lists(&mut random);
        let made = promises(lists);
        let unified = promises(Lists::unified(lists.u(), lists.v()));
        assert!(unified >= made);
        triangles += made + unified;
        most = most.max(made);
    }
    let all = Dyadic::uniform(7);
    assert_eq!(promises(Lists::unified(all, all)), 2 * 128 * 128);
    println!("compared 4000 meshes, {triangles} triangles; {most} in one of them");
    assert!(triangles > 10_000_000 && most > 10_000);
}

#[test]
fn a_transposed_patch_has_the_transposed_mesh() {
    let mut random = Random::new(0x7a);
    let shape = |lists, map: fn([u32; 2]) -> [u32; 2]| {
        let (points, triangles) = pattern(lists);
        let mut shape: Vec<_> =
            triangles.iter().map(|t| t.map(|k| map(points[usize::from(k)]))).collect();
        shape.iter_mut().for_each(|t| t.sort_unstable());
        shape.sort_unstable();
        shape
    };
    let mut compared = 0;
    for _ in 0..500 {
        let lists = lists(&mut random);
        let [v0, u1, v1, u0] = *lists.edges();
        let turned = Lists::new([u0, v1, u1, v0], lists.v(), lists.u());
        let plain = shape(lists, |p| p);
        compared += plain.len();
        assert_eq!(plain, shape(turned, |[u, v]| [v, u]), "{lists:?}");
    }
    println!("compared {compared} triangles");
    assert!(compared > 500_000);
}

/// By hand: one list of three segments outside, 0 1/4 1/2 1, and of 1/4 1/2 3/4 inside.
#[test]
fn the_outer_row_goes_first_where_parameters_tie() {
    let (quarter, half) = (1 << 32, 1 << 64);
    let edge = Dyadic::of(quarter | half);
    let lists = Lists::new(
        [edge, Dyadic::NONE, Dyadic::NONE, Dyadic::NONE],
        Dyadic::uniform(2),
        Dyadic::uniform(1),
    );
    let side = lists.strips().find(|strip| strip.kind != Kind::Cells { lower: true });
    let triangles: Vec<Triangle> = side.expect("it has sides").triangles().collect();
    // Vertices 0 1 2 3 on v0, 4 and 5 the other corners, 6 7 8 inside.
    let want = [[0, 1, 6], [1, 2, 6], [6, 2, 7], [7, 2, 8], [2, 3, 8]];
    assert_eq!(triangles, want);
}

#[test]
fn strips_are_what_they_say() {
    let mut random = Random::new(0x57_21b5);
    let (mut strips, mut cut, mut triangles) = (0, 0, 0);
    for _ in 0..2_000 {
        let lists = lists(&mut random);
        let [columns, rows] = lists.interior();
        let (mut made, mut count, mut needed) = (0, 0, 0);
        let mut all = Vec::new();
        for strip in lists.strips() {
            assert_eq!(strip.first, made == 0);
            made += 1;
            count += strip.count() as usize;
            assert_eq!(strip.last, made == lists.strip_count());
            assert!(strip.count() > 0, "a strip without triangles");
            if let Kind::Zipper { steps } = strip.kind {
                assert!(
                    strip.count() <= 64 && steps.count_ones() == u32::from(strip.inner_segments)
                );
                cut += usize::from(strip.count() == 64);
                assert_eq!(usize::from(strip.rows_needed), rows);
            }
            assert!(strip.rows_needed >= needed, "rows are not given back");
            needed = strip.rows_needed;
            let mut out = vec![[0; 3]; strip.count() as usize];
            strip.fill(&mut out);
            assert!(strip.triangles().eq(out.iter().copied()), "{strip:?}");
            let mut taken = Vec::new();
            strip.for_each(|t| taken.push(t));
            assert_eq!(taken, out, "{strip:?}");
            let end = lists.boundary() + usize::from(strip.rows_needed) * columns;
            assert!(out.iter().flatten().all(|&k| usize::from(k) < end), "{strip:?}");
            all.extend(out);
        }
        assert_eq!((made, count), (lists.strip_count(), lists.triangles()), "{lists:?}");
        let mut stitch = Stitch::default();
        stitch.accept(Lists::default());
        assert_eq!(stitch.accept(lists), all, "no stale triangles");
        (strips, triangles) = (strips + made, triangles + count);
    }
    println!("compared {strips} strips, {cut} of them full zippers, {triangles} triangles");
    assert!(strips > 20_000 && cut > 1_000);
}
