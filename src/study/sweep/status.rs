//! Status: how many points have which state, and why those that failed did.

use super::plan::Plan;
use super::store::{State, Store};
use crate::error::Result;
use std::collections::HashMap;
use std::fmt::Write;

/// Failures that are told in full; of more there is their number.
const TOLD: usize = 20;

/// The states of a plan's points, equal points counted as often as the study has them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Points with a result.
    pub completed: usize,
    /// Points without, in the study's order.
    pub failed: Vec<Failure>,
    /// Points that a process is at work on.
    pub running: usize,
    /// Others: never begun, or stopped before their end.
    pub never_run: usize,
}

/// A point without a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Which of the plan's points.
    pub point: usize,
    /// Why.
    pub reason: String,
}

impl Status {
    /// The states of a plan's points now.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn of(plan: &Plan, store: &Store) -> Result<Self> {
        let mut status = Self::default();
        // Equal points have one state, whatever happens while we look at the others.
        let mut known = HashMap::new();
        for (point, planned) in plan.points.iter().enumerate() {
            let state = match &planned.hash {
                Err(reason) => State::Failed(reason.clone()),
                Ok(hash) => {
                    if !known.contains_key(hash) {
                        known.insert(hash, store.state(hash)?);
                    }
                    known[hash].clone()
                }
            };
            match state {
                State::Completed => status.completed += 1,
                State::Failed(reason) => status.failed.push(Failure { point, reason }),
                State::Running => status.running += 1,
                State::NeverRun => status.never_run += 1,
            }
        }
        Ok(status)
    }

    /// How many points there are.
    #[must_use]
    pub fn all(&self) -> usize {
        self.completed + self.failed.len() + self.running + self.never_run
    }

    /// The numbers, a line each.
    #[must_use]
    pub fn text(&self) -> String {
        let lines = [
            ("completed", self.completed),
            ("failed", self.failed.len()),
            ("running", self.running),
            ("never run", self.never_run),
        ];
        lines.map(|(name, count)| format!("{name:<9} {count:>7}\n")).concat()
    }

    /// The failures, a line each; of very many the first.
    #[must_use]
    pub fn failures(&self, plan: &Plan) -> String {
        let mut text = String::new();
        for Failure { point, reason } in self.failed.iter().take(TOLD) {
            let line = writeln!(text, "{}: {}", plan.describe(*point), reason.replace('\n', " "));
            line.expect("a String takes everything");
        }
        if self.failed.len() > TOLD {
            let more = self.failed.len() - TOLD;
            writeln!(text, "and {more} more").expect("a String takes everything");
        }
        text
    }
}
