//! Trivial clipping: fates and outcodes of random patches, on every width.

use crate::random::{self, Kind, Random};
use crate::support;
use crate::table::Quantity;
use rtl_model::clip;
use rtl_model::patch::{Depth, Point, View};
use tessim::config::Config;
use tessim::gpu::{Kernel, PATCH, Settings, push_patch};

#[test]
fn patches_are_clipped_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(72);
    // Patches outside of each plane, and those that one point keeps.
    let mut seen = [[0; 2]; 6];
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
            // All points beyond, all but one, or each as it comes.
            let (which, inside) = (random.integer(0, 2), random.integer(0, 15) as usize);
            for (k, point) in patch.points.iter_mut().enumerate() {
                let beyond = match which {
                    0 => i64::from(random.integer(0, 1)),
                    1 => 1,
                    _ => i64::from(k != inside),
                };
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
        // What was there before must not matter.
        let fates = device.upload(&[u32::MAX].repeat(4 * patches.len())).unwrap();
        device.run(Kernel::Clip, "clip", &settings, &[&flat, &fates]).unwrap();
        let got = device.read(&fates, 0, 4 * patches.len()).unwrap();
        for (patch, got) in patches.iter().zip(got.chunks(4)) {
            for (plane, seen) in seen.iter_mut().enumerate() {
                let outside = |&p: &Point| clip::outcode(p, depth) >> plane & 1 != 0;
                let count = patch.points.iter().filter(|p| outside(p)).count();
                *seen = [seen[0] + u32::from(count == 16), seen[1] + u32::from(count == 15)];
            }
            let clipped = config.clip.enabled && clip::outside(patch, depth);
            let planes = patch.points.iter().fold(0x3f, |all, &p| all & clip::outcode(p, depth));
            ledger.compare(
                ("clip", "fate"),
                &[if clipped { 0 } else { 2 }, 0, 0, planes.into()],
                got,
                || format!("{width} bits, {depth:?}"),
                || format!("{:x?}", patch.points),
            );
        }
    }
    assert!(seen.iter().flatten().all(|&count| count > 30), "{seen:?}");
    support::settle(&ledger, Quantity::KernelClipRandom);
}
