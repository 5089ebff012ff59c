//! Publishing: a folder in which all points are settled in; out, in it, the study, its tables and
//! their picture.

use super::outcome::{columns, outcomes};
use super::plan::Plan;
use super::store::{Claim, Store};
use super::{picture, table};
use crate::error::{Error, Result};
use std::io::Write;

/// The file of the study.
pub(super) const STUDY: &str = "study.toml";

/// Writes the study and its tables, and puts them in their places.
///
/// # Errors
/// A result that cannot be read, a table that cannot be written.
///
/// # Panics
/// When a point is not settled.
pub(super) fn publish(plan: &Plan, store: &Store) -> Result<()> {
    let claim = store.claim_tables()?;
    study(plan, &claim)?;
    let outcomes = outcomes(plan, store)?;
    claim.draft("points.csv", |file| table::points(plan, store, &outcomes, file))?;
    let picture = picture::svg(&columns(plan), &outcomes)?;
    text(&claim, picture::FILE, &picture)?;
    claim.draft("sweep.csv", |file| table::counters(plan, store, file))?;
    #[cfg(feature = "parquet")]
    claim.draft("sweep.parquet", |file| super::parquet::write(plan, store, file))?;
    let parquet: &[_] = if cfg!(feature = "parquet") { &["sweep.parquet"] } else { &[] };
    // The last says that all are there.
    claim.publish(&[&[STUDY, "points.csv", picture::FILE], parquet, &["sweep.csv"]].concat())
}

/// Writes the study as it was read.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn study(plan: &Plan, claim: &Claim) -> Result<()> {
    text(claim, STUDY, &plan.study.text)
}

fn text(claim: &Claim, name: &str, text: &str) -> Result<()> {
    claim.draft(name, |file| {
        file.write_all(text.as_bytes()).map_err(|error| Error::system(name, error))
    })
}
