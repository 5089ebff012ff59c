//! Without the feature `gpu` there is no second implementation.

use super::ledger::Ledger;

/// Whether there was anything to compare: there was not.
pub(crate) fn traces(_: &mut Ledger) -> bool {
    println!("SKIPPED kernels: built without the feature gpu");
    false
}
