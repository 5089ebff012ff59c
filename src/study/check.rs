//! Check: two implementations beside each other, value by value.

mod ledger;

pub use ledger::{Difference, Ledger, Row};
