//! Stitch: triangles and degenerate ones of random lists, fractional and dyadic.

use crate::batch::Batch;
use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use tessim::gpu::surface::{self, EVENTS, Source};

#[test]
fn triangles_are_stitched_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(75);
    let mut degenerate = 0;
    for round in 0..60 * support::effort() {
        let source = [Source::Levels, Source::EdgeLevels, Source::Masks][round % 3];
        let most = random.of([2, 4, 9, 32, 128]);
        let count = (400 / most as usize).max(4);
        let width = random.integer(8, 48);
        let batch = Batch::draw(&mut random, width, source, count, most);
        let uploaded = batch.place(device);
        let (placed, all) = (&uploaded.placed, 0..count);
        let triangles = surface::stitch(device, &batch.settings, placed, &all).unwrap();
        let got = device.read(&triangles, 0, 3 * placed.triangles.items(&all)).unwrap();
        let expected = batch.expected();
        for (k, made) in expected.iter().enumerate() {
            let (first, end) = (placed.triangles.words[k], placed.triangles.words[k + 1]);
            let got = &got[3 * first as usize..3 * end as usize];
            let want = made.triangle_words();
            let differs = want.chunks(3).zip(got.chunks(3)).position(|(a, b)| a != b);
            let at = 3 * differs.unwrap_or(0);
            assert!(
                want == got,
                "{source:?}, patch {k}: {} words and {}, first {at}: {:?} {:?} of {:?}",
                want.len(),
                got.len(),
                &want[at..],
                &got[at..],
                batch.divisions[k]
            );
            ledger.compare(("stitch", "triangles"), &want, got, String::new, String::new);
        }
        let vertices: Vec<u32> = expected.iter().flat_map(|made| made.vertex_words()).collect();
        let vertices = device.upload(&vertices).unwrap();
        let events = device.empty(EVENTS).unwrap();
        let buffers = [&vertices, &triangles, &events];
        surface::degenerate(device, &batch.settings, placed, &all, buffers).unwrap();
        let want = expected.iter().map(|made| made.degenerate).sum::<u64>();
        let got = device.read(&events, 2, 1).unwrap();
        let place = || format!("{width} bits");
        ledger.compare(("stitch", "degenerate"), &[want as u32], &got, place, String::new);
        degenerate += want;
    }
    assert!(degenerate > 1000, "only {degenerate} triangles are degenerate");
    support::settle(&ledger, Quantity::KernelStitchRandom);
}
