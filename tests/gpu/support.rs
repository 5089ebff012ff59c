//! A device for tests, and the end of a comparison.

use crate::table::{Quantity, RANDOM, TABLE};
use rtl_model::number::Format;
use rtl_model::patch::{Depth, View};
use std::path::Path;
use std::sync::OnceLock;
use tessim::config::Config;
use tessim::gpu::{Backend, Device, Settings, Sources};
use tessim::study::check::Ledger;

/// The device of all tests; `None`, with a line that says so, where there is none.
pub(crate) fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    let device = DEVICE.get_or_init(|| match Device::open(backend(), sources()) {
        Ok(device) => Some(device),
        Err(reason) => {
            println!("SKIPPED the second implementation: {reason}");
            None
        }
    });
    device.as_ref()
}

/// A device that no other test dispatches on.
pub(crate) fn another(backend: Backend) -> tessim::error::Result<Device> {
    Device::open(backend, sources())
}

/// The one that `TESSIM_BACKEND` names.
pub(crate) fn backend() -> Backend {
    let name = std::env::var("TESSIM_BACKEND").unwrap_or_else(|_| "auto".to_owned());
    let found = Backend::ALL.into_iter().find(|backend| backend.name() == name);
    found.unwrap_or_else(|| panic!("TESSIM_BACKEND: found {name}, expected auto, vulkan or gl"))
}

/// The kernels that are compared.
pub(crate) fn sources() -> Sources {
    match std::env::var_os("TESSIM_KERNELS") {
        Some(folder) => Sources::from_folder(Path::new(&folder)).expect("a folder of kernels"),
        None => Sources::default(),
    }
}

/// How many times as many samples as usual.
pub(crate) fn effort() -> usize {
    if std::env::var_os("TESSIM_LONG").is_some() { 10 } else { 1 }
}

/// Settings of a default configuration with positions of this width.
pub(crate) fn settings(width: u32) -> Settings {
    let mut config = Config::default();
    config.position.width = width;
    let view = view(width);
    Settings::new(&config, &view, view.position)
}

/// A view of positions of this width.
pub(crate) fn view(width: u32) -> View {
    View {
        position: Format::of_range(width, 0),
        viewport: [1280, 1024],
        depth: Depth::ZeroToOne,
        near: 1,
        facing: 1,
    }
}

/// Where a test writes what it compares. Kernels that were changed on purpose are asked only
/// whether anything differs.
pub(crate) fn ledger() -> Ledger {
    match std::env::var_os("TESSIM_KERNELS") {
        Some(_) => Ledger::stopping(),
        None => Ledger::default(),
    }
}

/// Fails where anything differs, or where fewer words were compared than the quantity's row of the
/// table of budgets asks for.
pub(crate) fn settle(ledger: &Ledger, quantity: Quantity) {
    let budget = &TABLE[quantity as usize];
    assert_eq!((budget.what, budget.budget.is_some()), (RANDOM, false), "{quantity:?}");
    for row in ledger.rows() {
        println!("{} {}: {} values, {} differ", row.block, row.what, row.values, row.different);
        for first in &row.first {
            println!("  {}: cpu {:08x?} gpu {:08x?}", first.place, first.cpu, first.gpu);
            println!("    of {}", first.inputs);
        }
    }
    let [values, different] = ledger.totals();
    assert_eq!(different, 0, "words differ, of {}", budget.reason);
    assert!(values >= budget.floor, "{}: only {values} of {}", budget.block, budget.floor);
    assert!(ledger.rows().iter().all(|row| row.values > 0), "a comparison of nothing");
}
