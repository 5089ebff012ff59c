//! Walk: a shipped trace in, every patch that it draws out.

use std::path::PathBuf;
use tessim::config::Config;
use tessim::study::walk::Walk;
use tessim::trace::command::Draw;
use tessim::trace::open::Trace;

pub(crate) use tessim::study::walk::Drawn;

/// The traces in `traces/`, but those that move.
pub(crate) const SHIPPED: [&str; 8] =
    ["teapot", "teacup", "teaspoon", "mesh", "rational", "strip", "fan", "indexed"];

/// Calls `each` for every patch of a shipped trace.
pub(crate) fn walk(name: &str, config: &Config, mut each: impl FnMut(&Draw, &Drawn)) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{name}.jsonl"));
    let mut walk = Walk::new(config);
    for located in Trace::open(path).expect("a shipped trace") {
        let command = located.expect("a whole trace").command;
        let seen = walk.command(&command, &mut |draw, drawn| each(draw, &drawn));
        seen.expect("inline points and a finite far plane");
    }
}
