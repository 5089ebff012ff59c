//! Evaluate: vertices and their overflows on every width, in all schemes and policies.

use crate::batch::Batch;
use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use rtl_model::evaluate::tangent_plane;
use tessim::gpu::surface::{self, EVENTS, Source};
use tessim::gpu::{VERTEX, words};

#[test]
fn vertices_are_evaluated_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(74);
    let (mut overflows, mut batches) = (0, [0; 3]);
    for width in 8..=48 {
        for source in [Source::Levels, Source::EdgeLevels, Source::Masks] {
            let most = random.of([4, 16, 128, 128]);
            let count = (300 / most as usize).max(4) * support::effort();
            let batch = Batch::draw(&mut random, width, source, count, most);
            let uploaded = batch.place(device);
            let (placed, all) = (&uploaded.placed, 0..count);
            let events = device.empty(EVENTS).unwrap();
            let settings = &batch.settings;
            let vertices =
                surface::evaluate(device, settings, &uploaded.patches, placed, &all, &events)
                    .unwrap();
            let got = device.read(&vertices, 0, VERTEX * placed.vertices.items(&all)).unwrap();
            let expected = batch.expected();
            for (k, made) in expected.iter().enumerate() {
                let (first, end) = (placed.vertices.words[k], placed.vertices.words[k + 1]);
                let got = got.get(VERTEX * first as usize..VERTEX * end as usize);
                let want = made.vertex_words();
                let got = got.unwrap_or_default();
                let differs = want.chunks(VERTEX).zip(got.chunks(VERTEX)).position(|(a, b)| a != b);
                for (n, (want, got)) in want.chunks(VERTEX).zip(got.chunks(VERTEX)).enumerate() {
                    ledger.compare(
                        ("evaluate", "vertices"),
                        want,
                        got,
                        || format!("{width} bits, patch {k}, vertex {n}, first {differs:?}"),
                        || format!("{:?}, {:?}", batch.config.evaluate, batch.divisions[k]),
                    );
                }
                assert_eq!(want.len(), got.len(), "patch {k}: vertices");
            }
            let want = expected.iter().map(|made| made.cost.overflows).sum::<u64>();
            let got = device.read(&events, 0, 1).unwrap();
            ledger.compare(
                ("evaluate", "overflows"),
                &[want as u32],
                &got,
                || format!("{width} bits, {:?}", batch.config.evaluate),
                String::new,
            );
            overflows += want;
            batches[settings.scheme as usize] += 1;
        }
    }
    println!("{overflows} overflows; batches by scheme {batches:?}");
    assert!(overflows > 100, "points leave the range");
    assert!(batches.iter().all(|&n| n > 10), "every scheme");
    support::settle(&ledger, Quantity::KernelEvaluateRandom);
}

#[test]
fn tangent_planes_are_evaluated_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(77);
    let mut vanished = 0;
    for width in 8..=48 {
        let count = 8 * support::effort();
        let mut batch = Batch::draw(&mut random, width, Source::Levels, count, 5);
        // Sums of a few powers of two, whose ties are common.
        for patch in batch.patches.iter_mut().step_by(2) {
            let mut power = || random.of([-1, 0, 1]) << random.integer(0, width - 2);
            patch.points = patch.points.map(|p| p.map(|_| power()));
        }
        let uploaded = batch.place(device);
        let (placed, all) = (&uploaded.placed, 0..count);
        let expected = batch.expected();
        let vertices: Vec<u32> = expected.iter().flat_map(|made| made.vertex_words()).collect();
        let (vertices, events) = (device.upload(&vertices).unwrap(), device.empty(EVENTS).unwrap());
        let buffers = [&uploaded.patches, &vertices, &events];
        let planes = surface::planes(device, &batch.settings, placed, &all, buffers).unwrap();
        let got = device.read(&planes, 0, 8 * placed.vertices.items(&all)).unwrap();
        let both = batch.patches.iter().zip(&expected);
        let points = both.flat_map(|(patch, made)| made.vertices.iter().map(move |v| (patch, v)));
        let before = vanished;
        for ((patch, vertex), got) in points.zip(got.chunks(8)) {
            let plane = tangent_plane(patch, vertex.u, vertex.v);
            vanished += u32::from(plane == [0; 4]);
            let want: Vec<u32> = plane.into_iter().flat_map(words).collect();
            let place = || format!("{width} bits, at {:x}, {:x}", vertex.u, vertex.v);
            let inputs = || format!("{:x?}", patch.points);
            ledger.compare(("evaluate", "planes"), &want, got, place, inputs);
        }
        let got = device.read(&events, 3, 1).unwrap();
        let place = || format!("{width} bits");
        let want = [vanished - before];
        ledger.compare(("evaluate", "planes that vanish"), &want, &got, place, String::new);
    }
    assert!(vanished > 100, "only {vanished} planes vanish");
    support::settle(&ledger, Quantity::KernelPlaneRandom);
}
