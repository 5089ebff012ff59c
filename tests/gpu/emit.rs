//! Emit: screen positions of random vertices: every width, sub-pixel grid and mode; also ties, and
//! the ends of the band.

use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use rtl_model::emit;
use rtl_model::number::Rounding;
use rtl_model::patch::{Vertex, View};
use tessim::config::Config;
use tessim::gpu::surface::{self, EVENTS};
use tessim::gpu::{Settings, words};

/// A vertex: w of any size and sign; x and y anywhere, or so that the quotient is a tie, or at an
/// end of the band.
fn vertex(random: &mut Random, max: i64) -> Vertex {
    let raw = |random: &mut Random| (random.real(-1.0, 1.0) * max as f64) as i64;
    let shift = random.integer(0, 46);
    let w = (raw(random).abs() >> shift).max(i64::from(random.integer(0, 1)));
    let mut draw = || -> i64 {
        let near = match random.integer(0, 3) {
            0 => raw(random),
            // Some multiple of w, or of a part of it.
            1 => (i64::from(random.integer(0, 64)) - 32) * (w / 16) - w,
            2 => (i64::from(random.integer(0, 256)) - 128).saturating_mul(w) / 2,
            _ => raw(random) >> random.integer(0, 40),
        };
        let off = i64::from(random.integer(0, 2)) - 1;
        (near + off).clamp(-max, max)
    };
    let [x, y, z] = [draw(), draw(), draw()];
    let sign = if random.integer(0, 19) == 0 { -1 } else { 1 };
    Vertex { position: [x, y, z, sign * w], u: 0, v: 0 }
}

#[test]
fn vertices_are_divided_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(76);
    let mut divided = [0; 2];
    for width in 8..=48 {
        for rounding in Rounding::ALL {
            let mut config = Config::default();
            config.emit.subpixel_bits = random.integer(0, 12);
            config.emit.rounding = rounding;
            let sizes = [1, 16384, 1280, random.integer(1, 16384)];
            let viewport = [random.of(sizes), random.of(sizes)];
            let view = View { viewport, ..support::view(width) };
            let count = 300 * support::effort();
            let max = view.position.max();
            let vertices: Vec<_> = (0..count).map(|_| vertex(&mut random, max)).collect();
            let mut want = Vec::new();
            let subpixel_bits = config.emit.subpixel_bits;
            let own = emit::Settings { subpixel_bits, rounding };
            let homogeneous = emit::accept(&vertices, &view, own, &mut want);
            let flat = |v: &Vertex| {
                let position = v.position.iter().flat_map(|&c| words(c));
                position.chain([v.u, v.v]).collect::<Vec<_>>()
            };
            let buffer =
                device.upload(&vertices.iter().flat_map(flat).collect::<Vec<_>>()).unwrap();
            let events = device.empty(EVENTS).unwrap();
            let settings = Settings::new(&config, &view, view.position);
            let screen = surface::emit(device, &settings, &buffer, count, &events).unwrap();
            let got = device.read(&screen, 0, 3 * count).unwrap();
            for ((vertex, want), got) in vertices.iter().zip(&want).zip(got.chunks(3)) {
                divided[usize::from(want.divided)] += 1;
                ledger.compare(
                    ("emit", "screen"),
                    &[want.x as u32, want.y as u32, want.divided.into()],
                    got,
                    || format!("{width} bits, {viewport:?}, {:?}", config.emit),
                    || format!("{:x?}", vertex.position),
                );
            }
            let got = device.read(&events, 1, 1).unwrap();
            let place = || format!("{width} bits");
            ledger.compare(
                ("emit", "homogeneous"),
                &[homogeneous as u32],
                &got,
                place,
                String::new,
            );
        }
    }
    println!("not divided, divided: {divided:?}");
    assert!(divided.iter().all(|&n| n > 5_000), "both outcomes are common: {divided:?}");
    support::settle(&ledger, Quantity::KernelEmitRandom);
}
