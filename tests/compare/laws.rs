//! Laws that hold in every unit on every trace.

use super::{Numbers, TRACES, compared, config, trace};
use tessim::config::{Engine, Unit};
use tessim::study::compare::{Series, Value};

const CLASSES: [&str; 5] = ["to_clipper", "zero_area", "outside", "front", "back"];

#[test]
fn triangles_and_pixels_are_conserved_in_every_unit() {
    let mut seen = [0; CLASSES.len()];
    for name in TRACES {
        for unit in Unit::ALL {
            let runs = compared(&trace(name), &[config(unit, Engine::None)], 3);
            let numbers = Numbers::of(&runs[0]);
            let screen = |name: &str| numbers.count("screen", name);
            let classes = CLASSES.map(|class| screen(&format!("triangles.{class}")));
            let what = format!("{name}, {}", unit.name());
            assert_eq!(classes.iter().sum::<u64>(), numbers.count("emit", "triangles"), "{what}");
            let facing = classes[3] + classes[4];
            let areas = numbers.0.iter().filter(|s| s.whole.name.starts_with("area."));
            let areas: Vec<u64> = areas.map(|s| s.whole.value.unwrap().real() as u64).collect();
            assert_eq!(areas.iter().sum::<u64>(), facing, "{what}");
            assert_eq!(areas[..4].iter().sum::<u64>(), screen("triangles.sub_pixel"), "{what}");
            let [samples, quads, pixels] = ["samples", "quads", "pixels"].map(screen);
            assert!(quads <= samples && samples <= 4 * quads, "{what}: {samples} {quads}");
            assert!(pixels <= samples && pixels > 0, "{what}: {samples} {pixels}");
            assert!(screen("triangles.no_sample") + quads >= facing, "{what}");
            let [largest, mean] = ["largest", "mean"].map(|name| numbers.real("error", name));
            assert!(mean > 0.0 && mean < largest, "{what}: {mean} {largest}");
            let parts = ["operations", "chip", "memory", "link"];
            let energy: f64 = parts.iter().map(|part| numbers.real("energy", part)).sum();
            assert!((energy / numbers.real("energy", "total") - 1.0).abs() < 1e-12, "{what}");
            for (sum, class) in seen.iter_mut().zip(classes) {
                *sum += class;
            }
        }
    }
    assert!(seen[1..].iter().all(|class| *class > 0), "nearly every class is met: {seen:?}");
}

#[test]
fn frames_add_up_to_the_run_and_lie_between_their_least_and_their_most() {
    for unit in [Unit::Hybrid, Unit::Moreton, Unit::Esc] {
        let runs = compared(&trace("zoom"), &[config(unit, Engine::Timed)], 5);
        assert!(runs[0].seen.len() > 2);
        let real = |value: &Option<Value>| value.map(Value::real);
        for series in Numbers::of(&runs[0]).0 {
            let Series { whole, frames } = &series;
            let [least, median, most] = series.spread().unwrap().map(Value::real);
            let held = frames.iter().filter_map(real).all(|v| least <= v && v <= most);
            assert!(held && least <= median && median <= most, "{series:?}");
            let counted = matches!(whole.value, Some(Value::Count(_)));
            if counted && !whole.name.ends_with(".peak") && whole.name != "footprint" {
                let sum: f64 = frames.iter().filter_map(real).sum();
                assert_eq!(sum, whole.value.unwrap().real(), "{series:?}");
            }
        }
        // Its largest error is that of some frame, and the run's.
        let numbers = Numbers::of(&runs[0]);
        let [.., most] = numbers.series("error", "largest").spread().unwrap();
        assert_eq!(most.real(), numbers.real("error", "largest"));
    }
}

/// What the host tessellates for `triangles` is what `hybrid` makes.
#[test]
fn units_with_equal_patterns_show_equal_triangles() {
    for name in TRACES {
        let configs = [Unit::Hybrid, Unit::Triangles].map(|unit| config(unit, Engine::None));
        let runs = compared(&trace(name), &configs, 4);
        assert_eq!(runs[0].seen, runs[1].seen, "{name}");
    }
    // At fixed factors the tessellator of d3d11 makes as many, and they cover the same but for its
    // diagonals: as far from the surface, on the same pixels.
    let mut configs = [Unit::Hybrid, Unit::D3d11].map(|unit| config(unit, Engine::None));
    for config in &mut configs {
        config.level.pixels = None;
        config.level.criterion = Some(tessim::config::Criterion::Fixed);
        config.level.level = Some(16.0);
        config.tessellator.partitioning = tessim::config::Partitioning::Integer;
    }
    let runs = compared(&trace("teapot"), &configs, 7);
    let [a, b] = [0, 1].map(|k| Numbers::of(&runs[k]));
    assert_eq!(a.count("emit", "triangles"), b.count("emit", "triangles"));
    let apart = a.count("screen", "pixels").abs_diff(b.count("screen", "pixels"));
    assert!(100 * apart < a.count("screen", "pixels"), "{apart}");
    let ratio = a.real("error", "mean") / b.real("error", "mean");
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}
