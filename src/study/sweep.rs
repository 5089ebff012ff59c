//! Sweep: many runs, over traces, presets, units and any keys of the configuration.
//!
//! In comes a study, out come a folder with the result of every point and, when all of them are
//! settled, two tables: a row a point, and a row a point and counter, as CSV and (with the feature
//! `parquet`) as Parquet; and a picture of the first. A point's result is renamed into place under
//! the hash of what it is made of, so that a sweep that was stopped at any moment goes on where it
//! was, several machines can share one, and an equal point is computed once.

mod outcome;
#[cfg(feature = "parquet")]
mod parquet;
mod picture;
mod plan;
mod point;
mod publish;
mod status;
mod store;
mod study;
mod table;
mod text;
mod work;

use crate::error::Result;
use std::num::NonZeroUsize;

pub use plan::{Plan, Point, TraceFile};
pub use status::{Failure, Status};
pub use store::{State, Store};
pub use study::{POINTS_MAX, Study};
pub use work::{Event, Shard, Work};

/// Settles the points of a shard, and writes the tables when with them all points are settled.
///
/// # Errors
/// A folder that is no sweep's; what is the system's fault. A point that fails is none.
pub fn run(
    plan: &Plan,
    store: &Store,
    shard: Shard,
    threads: NonZeroUsize,
    watch: &(dyn Fn(Event) + Sync),
) -> Result<(Work, Status)> {
    store.make()?;
    let all_settled = |status: &Status| status.running + status.never_run == 0;
    if !all_settled(&Status::of(plan, store)?) {
        // Tables of other points must not pass for those of this study.
        let claim = store.claim_tables()?;
        claim.remove_tables()?;
        publish::study(plan, &claim)?;
        claim.publish(&[publish::STUDY])?;
    }
    let work = work::work(plan, store, shard, threads, watch)?;
    let status = Status::of(plan, store)?;
    if all_settled(&status) {
        publish::publish(plan, store)?;
        store.tidy()?;
    }
    Ok((work, status))
}
