//! The one comparison: errors come in under a quantity, are held against its row, and the account
//! is settled at the end. An exact row counts every difference as an error of 1.

use super::table::{At, KERNELS, Quantity, RANDOM, Row, TABLE};

/// The share of its budget that the largest error must reach.
const LEAST_USE: f64 = 0.25;

/// Failures shown for each row.
const SHOWN: usize = 3;

#[derive(Default)]
pub(crate) struct Ledger {
    tallies: Vec<Tally>,
    /// Decisions of subdivision that rounding may take either way: seen, and not compared.
    pub(crate) undecided: u64,
    /// Distance tests that rounding may take either way: seen, and not compared.
    pub(crate) untested: u64,
    /// Patches whose levels by size on the screen rounding may take either way.
    pub(crate) unsized_edges: u64,
    /// The same of the surface shader's.
    pub(crate) unclear: u64,
}

#[derive(Clone, Default)]
struct Tally {
    compared: u64,
    /// Error and budget of the item that used most of its budget.
    worst: (f64, f64),
    failures: u64,
    shown: Vec<String>,
}

impl Ledger {
    pub(crate) fn new() -> Self {
        Self {
            tallies: vec![Tally::default(); TABLE.len()],
            undecided: 0,
            untested: 0,
            unsized_edges: 0,
            unclear: 0,
        }
    }

    /// Takes in one item of a row with a budget.
    pub(crate) fn error(&mut self, quantity: Quantity, at: &At, error: f64) {
        let (row, tally) = self.find(quantity);
        let budget = row.budget.expect("an exact row takes equal items")(at);
        tally.compared += 1;
        if error * tally.worst.1 >= tally.worst.0 * budget {
            tally.worst = (error, budget);
        }
        if error.is_nan() || error > budget {
            tally.fail(|| format!("{error:e} of {budget:e} at {at:?}"));
        }
    }

    /// Takes in one item of an exact row.
    #[allow(clippy::needless_pass_by_value, reason = "called as `assert_eq!` is")]
    pub(crate) fn equal<T: PartialEq + std::fmt::Debug>(
        &mut self,
        quantity: Quantity,
        got: T,
        want: T,
    ) {
        let (row, tally) = self.find(quantity);
        assert!(row.budget.is_none(), "{quantity:?} has a budget");
        tally.compared += 1;
        if got != want {
            tally.fail(|| format!("{got:?}, want {want:?}"));
        }
    }

    /// Takes in words of an exact row that were compared elsewhere, and what of them differs.
    #[cfg(feature = "gpu")]
    pub(crate) fn words(&mut self, quantity: Quantity, row: &tessim::study::check::Row) {
        let (_, tally) = self.find(quantity);
        tally.compared += row.values;
        for first in &row.first {
            tally.fail(|| format!("{first:?}"));
        }
    }

    fn find(&mut self, quantity: Quantity) -> (&'static Row, &mut Tally) {
        let index = quantity as usize;
        (&TABLE[index], &mut self.tallies[index])
    }

    /// Prints every row and returns what is wrong; rows of kernels only where there are some.
    pub(crate) fn settle(&self, kernels: bool) -> Vec<String> {
        let mut wrong = Vec::new();
        for (row, tally) in TABLE.iter().zip(&self.tallies) {
            if row.what == RANDOM || row.what == KERNELS && !kernels {
                continue;
            }
            let name = format!("{}: {}", row.block, row.what);
            let (error, budget) = tally.worst;
            let n = tally.compared;
            let result = match row.budget {
                None => format!("{} differ, of budget 0", tally.failures),
                Some(_) => format!("largest error {error:.4e} of budget {budget:.4e}"),
            };
            println!("{name:<66} compared {n} items, {result}");
            if n < row.floor {
                wrong.push(format!("{name}: compared {n} items, expected {}", row.floor));
            }
            if tally.failures > 0 {
                let shown = tally.shown.join("\n    ");
                wrong.push(format!(
                    "{name}: {} of {n} fail ({}):\n    {shown}",
                    tally.failures, row.reason
                ));
            }
            if row.budget.is_some() && error < LEAST_USE * budget {
                wrong.push(format!(
                    "{name}: budget {budget:e} is more than four times the largest error {error:e}"
                ));
            }
        }
        for (quantity, open) in [
            (Quantity::LevelDivided, self.undecided),
            (Quantity::HullDecision, self.untested),
            (Quantity::EscScreen, self.unsized_edges),
            (Quantity::EscDecision, self.unclear),
        ] {
            let (row, decided) =
                (&TABLE[quantity as usize], self.tallies[quantity as usize].compared);
            println!("{}: {}, within rounding of the threshold: {open}", row.block, row.what);
            // Small patches, and positions of few bits, are all rounding.
            if 10 * open > decided {
                wrong.push(format!("{}: {open} {} left open of {decided}", row.block, row.what));
            }
        }
        wrong
    }
}

impl Tally {
    fn fail(&mut self, what: impl FnOnce() -> String) {
        self.failures += 1;
        if self.shown.len() < SHOWN {
            self.shown.push(what().chars().take(400).collect());
        }
    }
}
