//! Comparisons: what the numbers of one unit must be to each other, and to those of another unit.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

mod laws;
mod roofline;
mod screen;

use std::path::{Path, PathBuf};
use tessim::config::{Config, Engine, Unit};
use tessim::study::compare::{self, Run, Series, Value, series};
use tessim::trace::replay::Replay;

/// Every trace that is shipped.
const TRACES: [&str; 9] =
    ["teapot", "teacup", "teaspoon", "mesh", "rational", "strip", "fan", "indexed", "zoom"];

fn trace(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("traces").join(format!("{name}.jsonl"))
}

fn config(unit: Unit, engine: Engine) -> Config {
    let mut config = Config { unit, engine, ..Config::default() };
    config.level.pixels = Some(4.0);
    config
}

fn compared(trace: &Path, configs: &[Config], samples: u32) -> Vec<Run> {
    let mut trace = Replay::open(trace).unwrap();
    compare::run(&mut trace, configs, samples, |_, _| {}).unwrap().runs
}

/// The numbers of a run, to be asked for by name.
struct Numbers(Vec<Series>);

impl Numbers {
    fn of(run: &Run) -> Self {
        Self(series(run))
    }

    #[track_caller]
    fn series(&self, block: &str, name: &str) -> &Series {
        let found = self.0.iter().find(|s| s.whole.block == block && s.whole.name == name);
        found.unwrap_or_else(|| panic!("no {block}.{name}"))
    }

    #[track_caller]
    fn count(&self, block: &str, name: &str) -> u64 {
        let Some(Value::Count(count)) = self.series(block, name).whole.value else {
            panic!("{block}.{name} is no count");
        };
        count
    }

    #[track_caller]
    fn real(&self, block: &str, name: &str) -> f64 {
        self.series(block, name).whole.value.unwrap().real()
    }
}
