//! Trivial clipping: fates and outcodes of random patches, on every width.

use crate::random::{self, Kind, Random};
use crate::support;
use rtl_model::clip;
use rtl_model::patch::{Depth, View};
use tessim::config::Config;
use tessim::gpu::{Kernel, PATCH, Settings, push_patch};
use tessim::study::check::Ledger;

#[test]
fn patches_are_clipped_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = Ledger::default();
    let mut random = Random::new(72);
    for width in 8..=48 {
        let depth = random.of([Depth::ZeroToOne, Depth::MinusOneToOne]);
        let view = View { depth, ..support::view(width) };
        let mut config = Config::default();
        config.clip.enabled = random.integer(0, 7) > 0;
        let mut draw = || {
            let kind = random.of(Kind::ALL);
            let mut patch = random::patch(&mut random, kind, view.position.max());
            // Beside the volume, or on its planes.
            let axis = random.integer(0, 2) as usize;
            let sign = i64::from(random.integer(0, 2)) - 1;
            for point in &mut patch.points {
                let beyond = i64::from(random.integer(0, 1));
                point[axis] =
                    (sign * (point[3] + beyond)).clamp(-view.position.max(), view.position.max());
            }
            patch
        };
        let patches: Vec<_> = (0..200 * support::effort()).map(|_| draw()).collect();
        let mut flat = Vec::with_capacity(PATCH * patches.len());
        patches.iter().for_each(|patch| push_patch(&mut flat, patch, [0; 4], [0; 3]));
        let settings = Settings::new(&config, &view, view.position).of(patches.len());
        let flat = device.upload(&flat).unwrap();
        let fates = device.empty(4 * patches.len()).unwrap();
        device.run(Kernel::Clip, "clip", &settings, &[&flat, &fates]).unwrap();
        let got = device.read(&fates, 0, 4 * patches.len()).unwrap();
        for (patch, got) in patches.iter().zip(got.chunks(4)) {
            let clipped = config.clip.enabled && clip::outside(patch, depth);
            let planes = patch.points.iter().fold(0x3f, |all, &p| all & clip::outcode(p, depth));
            ledger.compare(
                ("clip", "fate"),
                &[if clipped { 0 } else { 2 }, planes.into()],
                &[got[0], got[3]],
                || format!("{width} bits, {depth:?}"),
                || format!("{:x?}", patch.points),
            );
        }
    }
    support::settle(&ledger, 10_000);
}
