//! Back-face removal: verdicts of every method, and facets looked at, on every width.

use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use rtl_model::backface::{self, Verdict};
use rtl_model::patch::{Patch, View};
use tessim::config::{BackfaceMethod, Config};
use tessim::gpu::{PATCH, Settings, backface as on_device, push_patch};

/// Patches, beside the common kinds, whose determinants are 0 or next to it.
fn draw(random: &mut Random, width: u32) -> Patch {
    let max = (1 << (width - 1)) - 1;
    let kind = random.of(Kind::ALL);
    let mut patch = random::patch(random, kind, max);
    match random.integer(0, 9) {
        // The ends of the range and their neighbours: the widest numbers.
        0 => patch.points = patch.points.map(|p| p.map(|_| extreme(random, max))),
        // Nearly edge-on: some points an ulp beside the plane of the viewer.
        1 => {
            let rare = random.integer(1, 8);
            patch.points = patch.points.map(|[x, y, z, _]| {
                let off = i64::from(random.integer(0, rare) == 0);
                [x, y, z, ((x + y) / 2 + off).clamp(-max, max)]
            });
        }
        // Round the viewer.
        2 => {
            let size = (max >> 2).max(1);
            let at = |c: i64| (c % size).clamp(-max, max);
            patch.points = patch.points.map(|p| p.map(at));
            for k in 0..4 {
                patch.points[5 * k] = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
                    .map(|[x, y, w]| [x * size, y * size, 0, w * size])[k];
            }
        }
        // A curve: no normal anywhere.
        3 if random.bits() & 1 == 0 => {
            let row = [0, 1, 2, 3].map(|k| patch.points[k]);
            patch.points = std::array::from_fn(|k| row[k % 4]);
        }
        _ => {}
    }
    patch.saturated = random.integer(0, 15) == 0;
    patch.cull = random.integer(0, 15) > 0;
    patch
}

/// A sheet seen from one side but for a fold at an edge: of all coefficients of det[S, Su, Sv] one
/// alone is towards the other side, at its ends the second or the last but one.
fn fold(random: &mut Random, width: u32) -> Patch {
    let max = (1_i64 << (width - 1)) - 1;
    let mut patch = random::patch(random, Kind::Planar, max);
    let unit = (max / 64).max(1);
    let side = random.of([-1, 1]);
    patch.points = std::array::from_fn(|k| {
        let [i, j] = [k as i64 / 4, k as i64 % 4];
        // Steps along u of the first row: none, one forward, many back.
        let x = if i == 0 { [0, 0, 1, -13][j as usize] } else { -13 * j };
        [side * unit * x, 13 * unit * i, 0, max / 2]
    });
    if random.bits() & 1 == 0 {
        patch.points.reverse();
    }
    patch
}

/// A patch whose fate is another as soon as it moves by an ulp or so: on the way between two.
fn boundary(random: &mut Random, view: &View, method: BackfaceMethod) -> Patch {
    const STEPS: u32 = 24;
    let width = view.position.width;
    let [from, to] =
        [(); 2].map(|()| Patch { cull: true, saturated: false, ..draw(random, width) });
    let to = Patch { reversed: from.reversed, ..to };
    let at = |t: i64| {
        let between = |a: i64, b: i64| {
            ((i128::from(a) * i128::from((1 << STEPS) - t) + i128::from(b) * i128::from(t))
                >> STEPS) as i64
        };
        let points = std::array::from_fn(|k| {
            std::array::from_fn(|axis| between(from.points[k][axis], to.points[k][axis]))
        });
        Patch { points, ..from }
    };
    let [mut low, mut high] = [0, 1 << STEPS];
    let first = fate(&from, view, method);
    while high - low > 1 {
        let middle = i64::midpoint(low, high);
        if fate(&at(middle), view, method) == first { low = middle } else { high = middle }
    }
    at(random.of([low, high]))
}

fn extreme(random: &mut Random, max: i64) -> i64 {
    random.of([-max - 1, -max, 1 - max, -1, 0, 1, max - 1, max])
}

/// The words of a fate that was 2, or stays 0.
fn fate(patch: &Patch, view: &View, method: BackfaceMethod) -> [u32; 3] {
    let (verdict, facets) = backface::accept(patch, view, method);
    [if verdict == Verdict::Culled { 1 } else { 2 }, (verdict != Verdict::Untested).into(), facets]
}

/// How often each outcome was seen.
#[derive(Debug, Default)]
struct Seen {
    untested: u32,
    culled: u32,
    kept_early: u32,
    kept_late: u32,
}

impl Seen {
    fn add(&mut self, [fate, tested, facets]: [u32; 3]) {
        let which = match (tested, fate, facets) {
            (0, ..) => &mut self.untested,
            (_, 1, _) => &mut self.culled,
            (_, _, 0..=4) => &mut self.kept_early,
            _ => &mut self.kept_late,
        };
        *which += 1;
    }
}

fn input(random: &mut Random, view: &View, method: BackfaceMethod) -> Patch {
    match random.integer(0, 31) {
        0..=3 if method == BackfaceMethod::NormalCone => boundary(random, view, method),
        0 => boundary(random, view, method),
        4 => fold(random, view.position.width),
        _ => draw(random, view.position.width),
    }
}

fn compare(method: BackfaceMethod, what: &'static str, patches: usize) {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(73);
    let mut seen = Seen::default();
    for width in 8..=48 {
        let view = View { facing: random.of([-1, 1]), ..support::view(width) };
        let mut config = Config::default();
        config.backface.method = method;
        let inputs: Vec<_> =
            (0..patches * support::effort()).map(|_| input(&mut random, &view, method)).collect();
        let clipped: Vec<_> = inputs.iter().map(|_| random.integer(0, 15) == 0).collect();
        let mut flat = Vec::with_capacity(PATCH * inputs.len());
        inputs.iter().for_each(|patch| push_patch(&mut flat, patch, [0; 4], [0; 3]));
        let fates: Vec<_> =
            clipped.iter().flat_map(|&c| [if c { 0 } else { 2 }, 0, 0, 9]).collect();
        let flat = device.upload(&flat).unwrap();
        let fates = device.upload(&fates).unwrap();
        let settings = Settings::new(&config, &view, view.position).of(inputs.len());
        on_device(device, &settings, &flat, &fates).unwrap();
        let got = device.read(&fates, 0, 4 * inputs.len()).unwrap();
        for ((patch, &clipped), got) in inputs.iter().zip(&clipped).zip(got.chunks(4)) {
            let want = if clipped { [0; 3] } else { fate(patch, &view, method) };
            if !clipped {
                seen.add(want);
            }
            ledger.compare(
                ("backface", what),
                &[&want[..], &[9]].concat(),
                got,
                || format!("{width} bits, facing {}", view.facing),
                || format!("{patch:x?}"),
            );
        }
    }
    println!("{what}: {seen:?}");
    support::settle(&ledger, Quantity::KernelBackfaceRandom);
    let least = if method == BackfaceMethod::Off { 0 } else { 100 };
    assert!(seen.untested >= 100, "{seen:?}");
    assert!(seen.culled.min(seen.kept_early).min(seen.kept_late) >= least, "{seen:?}");
}

#[test]
fn nothing_is_tested_where_the_method_is_off() {
    compare(BackfaceMethod::Off, "off", 100);
}

#[test]
fn net_facets_agree() {
    compare(BackfaceMethod::NetFacets, "net_facets", 200);
}

#[test]
fn tangent_planes_agree() {
    compare(BackfaceMethod::TangentPlane, "tangent_plane", 200);
}

#[test]
fn normal_cones_agree() {
    compare(BackfaceMethod::NormalCone, "normal_cone", 200);
}

#[test]
fn hulls_agree() {
    compare(BackfaceMethod::HullLiteral, "hull_literal", 100);
}
