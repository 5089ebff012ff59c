//! `tessim check`: both implementations on the shipped traces, and what it says when they differ.
//!
//! By default every trace through every unit, each in one of five formats, on Vulkan, and some on
//! OpenGL; `TESSIM_LONG=1` takes all formats on both.

#![cfg_attr(
    feature = "gpu",
    expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")
)]
#![cfg_attr(not(feature = "gpu"), allow(dead_code, unused_imports, reason = "nothing to check"))]

use assert_cmd::Command;
use predicates::prelude::*;
use std::path::{Path, PathBuf};

#[cfg(not(feature = "gpu"))]
#[test]
fn both_implementations_agree() {
    println!("SKIPPED check: built without the feature gpu");
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{name}.jsonl"))
}

#[cfg(feature = "gpu")]
mod with_a_device {
    use super::*;
    use tessim::config::layers::Layers;
    use tessim::config::preset::Preset;
    use tessim::config::{Config, Engine, Unit};
    use tessim::gpu::{Backend, Device, Sources};
    use tessim::study::check::{self, Checked};
    use tessim::trace::replay::Replay;

    const TRACES: [&str; 9] =
        ["teapot", "teacup", "teaspoon", "mesh", "rational", "strip", "fan", "indexed", "zoom"];

    /// Formats: from the least that traces stand to the widest.
    const FORMATS: [&[&str]; 5] = [
        &["position.width=32"],
        &["position.width=16", "evaluate.rounding=floor", "place.reciprocal_bits=12"],
        &[
            "position.width=24",
            "evaluate.scheme=mixed",
            "evaluate.rounding=nearest_up",
            "place.reciprocal_bits=17",
        ],
        &["position.width=40", "evaluate.guard=12", "backface.method=net_facets"],
        &["position.width=48", "evaluate.scheme=de_casteljau", "evaluate.rounding=nearest_away"],
    ];

    /// All but `triangles`, whose triangles are those of `hybrid`.
    const UNITS: [Unit; 5] = [Unit::Hybrid, Unit::Sfarti, Unit::Moreton, Unit::D3d11, Unit::Esc];

    fn open(backend: Backend, sources: Sources) -> Option<Device> {
        match Device::open(backend, sources) {
            Ok(device) => Some(device),
            Err(reason) => {
                println!("SKIPPED check: {reason}");
                None
            }
        }
    }

    fn config(unit: Unit, settings: &[&str]) -> Config {
        let mut layers = Layers::new(Preset::default());
        let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
        layers.set(&settings).unwrap();
        Config { engine: Engine::None, ..layers.for_unit(unit).unwrap() }
    }

    fn checked(device: &Device, trace: &str, config: &Config) -> Checked {
        let mut replay = Replay::open(&path(trace)).unwrap();
        check::run(&mut replay, config, device, |_| {}).unwrap()
    }

    /// Checks a trace, and adds to the sum of values.
    fn agrees(device: &Device, trace: &str, config: &Config, sum: &mut u64) {
        let Checked { ledger, gpu, rest, .. } = checked(device, trace, config);
        let [values, different] = ledger.totals();
        let (unit, width) = (config.unit.name(), config.position.width);
        println!(
            "{trace} {unit} {width} bits: {values} values, {different} differ, kernels {gpu:.1?}, \
             rest {rest:.1?}"
        );
        for row in ledger.rows().iter().filter(|row| row.different > 0) {
            println!("  {} {}: {} differ: {:?}", row.block, row.what, row.different, row.first);
        }
        assert_eq!(different, 0, "{trace}, unit {unit}, {width} bits");
        assert!(values > 1000, "{trace}, unit {unit}: {values} values");
        *sum += values;
    }

    #[test]
    fn both_implementations_agree_on_every_shipped_trace() {
        let Some(device) = open(Backend::Vulkan, Sources::default()) else { return };
        let long = std::env::var_os("TESSIM_LONG").is_some();
        let mut sum = 0;
        for (t, trace) in TRACES.into_iter().enumerate() {
            for (u, unit) in UNITS.into_iter().enumerate() {
                for (f, settings) in FORMATS.into_iter().enumerate() {
                    if long || (t + u) % FORMATS.len() == f {
                        agrees(&device, trace, &config(unit, settings), &mut sum);
                    }
                }
            }
        }
        println!("{sum} values");
        assert!(sum > 5_000_000, "{sum} values");
    }

    #[test]
    fn both_implementations_agree_on_opengl() {
        let Some(device) = open(Backend::Gl, Sources::default()) else { return };
        let long = std::env::var_os("TESSIM_LONG").is_some();
        let mut sum = 0;
        for (t, trace) in TRACES.into_iter().enumerate() {
            for (u, unit) in UNITS.into_iter().enumerate() {
                for (f, settings) in FORMATS.into_iter().enumerate() {
                    if long || (t == u && (t + 3) % FORMATS.len() == f) {
                        agrees(&device, trace, &config(unit, settings), &mut sum);
                    }
                }
            }
        }
        println!("{sum} values");
        assert!(sum > 500_000, "{sum} values");
    }

    #[test]
    fn work_that_is_split_gives_the_same() {
        let Some(mut device) = open(Backend::Auto, Sources::default()) else { return };
        device.limit_words(300_000);
        let mut sum = 0;
        for unit in UNITS {
            agrees(&device, "teapot", &config(unit, &["level.level=32"]), &mut sum);
        }
    }

    #[test]
    fn a_kernel_that_is_wrong_is_named_with_patch_and_values() {
        for (file, from, to, unit, block) in [
            ("clip.wgsl", "planes |= outside << plane", "planes |= 0u", Unit::Hybrid, "clip"),
            ("emit.wgsl", "settings.viewport_y", "settings.viewport_x", Unit::Sfarti, "emit"),
        ] {
            let text = Sources::shipped(file).expect("a kernel");
            assert!(text.contains(from), "{file} has changed");
            let sources = Sources::default().with(file, text.replace(from, to));
            let Some(device) = open(Backend::Auto, sources) else { return };
            let trace = if block == "clip" { "zoom" } else { "teapot" };
            let Checked { ledger, .. } = checked(&device, trace, &config(unit, &[]));
            let wrong = ledger.rows().iter().find(|row| row.different > 0).expect("it is noticed");
            assert_eq!(wrong.block, block, "{file}");
            let first = &wrong.first[0];
            assert!(first.place.contains(", patch "), "{first:?}");
            assert!(first.inputs.contains("control points [0x"), "{first:?}");
            assert_ne!(first.cpu, first.gpu);
        }
    }

    /// What a check of the teapot says that cannot be made.
    fn fails(device: &Device) -> String {
        let mut replay = Replay::open(&path("teapot")).unwrap();
        let config = config(Unit::Hybrid, &["level.level=64"]);
        let error = check::run(&mut replay, &config, device, |_| {}).unwrap_err();
        assert_eq!(error.exit_code(), 3, "{error}");
        error.to_string()
    }

    #[test]
    fn a_device_that_fails_says_why() {
        let Some(mut small) = open(Backend::Auto, Sources::default()) else { return };
        small.limit_words(2_000);
        assert!(fails(&small).contains("larger than a binding may be, 8000 bytes"));
        let broken = Sources::default().with("clip.wgsl", "fn clip( {".to_owned());
        let Some(device) = open(Backend::Auto, broken) else { return };
        assert!(fails(&device).starts_with("clip.wgsl, clip: "));
        let Some(lost) = open(Backend::Auto, Sources::default()) else { return };
        lost.destroy();
        assert!(fails(&lost).contains("lost"), "{}", fails(&lost));
    }

    #[test]
    fn the_command_prints_a_table_and_the_adapter() {
        if open(Backend::Auto, Sources::default()).is_none() {
            return;
        }
        let mut command = Command::cargo_bin("tessim").unwrap();
        let out = command.arg("check").arg(path("fan")).args(["--unit", "sfarti"]).assert();
        out.success()
            .stdout(predicate::str::contains("unit sfarti, 32 bits, 1 frame,"))
            .stdout(predicate::str::contains("in all"))
            .stdout(predicate::str::contains("llvmpipe").or(predicate::str::contains("(")));
    }

    #[test]
    fn without_an_adapter_it_says_how_to_get_one() {
        let mut command = Command::cargo_bin("tessim").unwrap();
        command.args(["check", "--backend", "vulkan"]).arg(path("fan"));
        command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
        let out = command.assert().code(3).stdout("");
        out.stderr(predicate::str::contains("apt-get install mesa-vulkan-drivers"));
    }

    #[test]
    fn what_has_no_kernels_is_refused() {
        let mut command = Command::cargo_bin("tessim").unwrap();
        command.arg("check").arg(path("mesh"));
        command.args(["--unit", "sfarti", "--set", "level.union=primitive"]);
        command.assert().code(2).stderr(predicate::str::contains("level.union"));
        let mut command = Command::cargo_bin("tessim").unwrap();
        command.args(["check", "--backend", "metal"]).arg(path("mesh"));
        command.assert().code(2).stderr(predicate::str::contains("possible values: auto"));
    }
}
