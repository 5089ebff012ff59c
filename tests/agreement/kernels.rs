//! The second implementation on the shipped traces, in every unit. Random inputs, of every width,
//! are in tests/gpu.

use super::ledger::Ledger;
use super::table::Quantity as Q;
use super::walk;
use std::path::Path;
use tessim::config::{Config, Engine, Unit};
use tessim::gpu::{Backend, Device, Sources};
use tessim::study::check;
use tessim::trace::replay::Replay;

/// Whether there was a device to compare on.
pub(crate) fn traces(ledger: &mut Ledger) -> bool {
    let device = match Device::open(Backend::Auto, Sources::default()) {
        Ok(device) => device,
        Err(reason) => {
            println!("SKIPPED kernels: {reason}");
            return false;
        }
    };
    for name in walk::SHIPPED {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{name}.jsonl"));
        for unit in Unit::ALL {
            let config = Config { unit, engine: Engine::None, ..Config::default() };
            let mut trace = Replay::open(&path).expect("a shipped trace");
            let checked = check::run(&mut trace, &config, &device, |_| {}).expect("a whole trace");
            for row in checked.ledger.rows() {
                ledger.words(quantity(row.block, row.what, unit), row);
            }
        }
    }
    true
}

/// The row that a comparison belongs to.
fn quantity(block: &str, what: &str, unit: Unit) -> Q {
    match block {
        "clip" => Q::KernelClip,
        "backface" => Q::KernelBackface,
        "level" => Q::KernelLevel,
        "place" => Q::KernelPlace,
        "evaluate" => Q::KernelEvaluate,
        "stitch" => Q::KernelStitch,
        "emit" => Q::KernelEmit,
        "points" | "domain" | "connect" => Q::KernelD3d11,
        "surface" => Q::KernelEsc,
        // Counters are of all blocks: with the last one of the unit.
        "unit" if unit == Unit::Esc => Q::KernelEsc,
        "unit" if unit == Unit::D3d11 => Q::KernelD3d11,
        "unit" => Q::KernelStitch,
        _ => panic!("{block}, {what}: expected a row of the table"),
    }
}
