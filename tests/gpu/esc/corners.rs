//! Corners that random surfaces seldom reach: levels of resolution between their ends, and
//! distances on the threshold.

use super::*;
use crate::table::Quantity;

/// Levels alone, of many patches: some of them so near that projections do not fit.
#[test]
fn levels_of_resolution_are_chosen_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(0x1e7e1);
    for width in 8..=48 {
        for level in [LevelPolicy::Criterion, LevelPolicy::Criterion, LevelPolicy::Distance] {
            let mut batch = draw(&mut random, width, 50 * support::effort());
            let esc = &mut batch.config.esc;
            (esc.level, esc.scope, esc.mu) = (level, LevelScope::Patch, 0.0);
            esc.level_max = random.of([15, 15, 6]);
            esc.boundary = Boundary::Symmetric;
            batch.given = None;
            batch.view.viewport = random.of([[1280, 1024], [16384, 16384]]);
            batch.view.near = random.of([0, 1]);
            for patch in &mut batch.patches {
                let nearer = random.of([0, 0, 0, 6, 12]);
                patch.points = patch.points.map(|[x, y, z, w]| [x, y, z, w >> nearer]);
                // What is inside may be nearer than all of the boundary.
                patch.points[random.of([5, 6, 9, 10])][3] >>= random.integer(0, 3);
            }
            for state in &mut batch.states {
                let pixels = (random.octaves(0.01, 200.0) * 65536.0) as u32;
                state.criterion = random.of([
                    Criterion::Flatness { pixels },
                    Criterion::Flatness { pixels },
                    Criterion::EdgeLength { pixels },
                ]);
                (state.min, state.max) = (Level::MIN, Level::MAX);
            }
            if width >= 26 {
                halves(&mut random, &mut batch);
            }
            levels(&mut ledger, device, &batch);
        }
    }
    support::settle(&ledger, Quantity::KernelResolution);
}

/// Makes two patches of a few ulps, whose projections are halves of 2^-16 pixels: 1280 pixels are
/// 5 2^8, so x is multiplied by 5 2^23 and divided by w.
fn halves(random: &mut Random, batch: &mut Batch) {
    batch.view.viewport = [1280, 1280];
    batch.states[0].criterion = Criterion::EdgeLength { pixels: 1 };
    let mut coordinate = || i64::from(random.integer(0, 8)) - 4;
    for patch in &mut batch.patches[..2] {
        patch.points = [(); 16].map(|()| [coordinate(), coordinate(), 0, 1 << 24]);
    }
    // Bends of few ulps by tolerances of few: what is added for roundings decides.
    let pixels = random.integer(1, 8);
    batch.states[1].criterion = Criterion::Flatness { pixels };
}

fn levels(ledger: &mut Ledger, device: &Device, batch: &Batch) {
    let flat = batch.flat();
    let decided = decide(device, &batch.work(&flat)).unwrap();
    for (at, patch) in batch.patches.iter().enumerate() {
        let got = &decided.resolutions[12 * at..12 * at + 8];
        let policy = expected::policy(batch, at);
        let level_max = batch.config.esc.level_max as u8;
        let resolution = Resolution { policy, level_max };
        let (levels, events) =
            resolution::accept(patch, &batch.view, &batch.states[at], &resolution);
        let [v0, u1, v1, u0] = levels.edges.map(u32::from);
        let interior = levels.interior.into();
        let mut want =
            [v0, u1, v1, u0, interior, events.clamped, events.near, events.overflows].to_vec();
        if !is_kept(batch, at) {
            want = vec![0, 0, 0, 0, u32::MAX, 0, 0, 0];
        }
        let place = || format!("patch {at} of {:?}", batch.view);
        ledger.compare(("esc", "levels"), &want, got, place, || batch.describe(at));
    }
}

/// A batch that is tested in object space, of level 1.
fn in_space(width: u32, points: [Point; 16], mu: f64) -> Batch {
    let mut random = Random::new(5);
    let mut batch = draw(&mut random, width, 1);
    batch.config = Config { unit: Unit::Esc, ..Config::default() };
    batch.config.position.width = width;
    batch.config.clip.enabled = false;
    batch.patches[0].cull = false;
    let esc = &mut batch.config.esc;
    (esc.level, esc.fixed_level, esc.mu, esc.space) = (LevelPolicy::Fixed, 1, mu, Space::Object);
    batch.object_format = Format::of_range(width, 0);
    (batch.given, batch.objects) = (None, vec![points]);
    batch
}

/// Vertices of the mesh, which is the first implementation's.
fn vertices(ledger: &mut Ledger, device: &Device, batch: &Batch) -> u32 {
    compare(ledger, device, batch);
    let flat = batch.flat();
    esc(device, &batch.work(&flat)).unwrap().vertex_starts[1]
}

/// The edges along u bend so that their first and last third are 3 and 4 ulps off, 5 in all.
#[test]
fn a_distance_on_the_threshold_inserts_nothing() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    for width in [24, 32, 48] {
        let fraction = width - 1;
        let one = (1_i64 << fraction) - 1; // the format's greatest: divided by, as any other w
        let bent = std::array::from_fn(|k| {
            let bend = 12 * i64::from(k % 4 == 1 || k % 4 == 2);
            [200 * (k % 4) as i64, 3 * bend, 4 * bend, one]
        });
        let mu = |ulps: f64| ulps * f64::from(fraction).exp2().recip();
        let mut count = |ulps: f64| vertices(&mut ledger, device, &in_space(width, bent, mu(ulps)));
        let (within, on, beyond) = (count(4.9), count(5.0), count(5.1));
        assert!(within > on && on == beyond, "{within} {on} {beyond}");
        let half = in_space(width, bent.map(|[x, y, z, _]| [x, y, z, 1 << (fraction - 1)]), 1.0);
        vertices(&mut ledger, device, &half);
    }
    // Quotients of 2^61 and more have no distance, however large mu is.
    let mut count = |size: i64| {
        let far = std::array::from_fn(|k| [size + (k % 4) as i64, 0, 0, 1]);
        vertices(&mut ledger, device, &in_space(48, far, 65535.0))
    };
    let (near, far) = (count(40), count(64));
    assert!(near < far, "{near} {far}");
    support::settle(&ledger, Quantity::KernelNear);
}
