//! The files of a run's result, each under its name, as bytes: whoever writes them decides where
//! and how they appear.

use super::summary::Provenance;
use super::{counters, occupancy, summary};
use crate::report::Report;

/// `config.toml`, `counters.csv`, `summary.json` and, where an engine ran, `occupancy.csv`.
#[must_use]
pub fn files(report: &Report, provenance: &Provenance) -> Vec<(&'static str, Vec<u8>)> {
    let mut rows = Vec::new();
    counters::write(report, &mut rows).expect("memory takes everything");
    let mut files = vec![
        ("config.toml", report.config.to_commented_toml().into_bytes()),
        ("counters.csv", rows),
        ("summary.json", summary::text(report, provenance).into_bytes()),
    ];
    if !report.occupancy.is_empty() {
        let mut cycles = Vec::new();
        occupancy::write(report, &mut cycles).expect("memory takes everything");
        files.push(("occupancy.csv", cycles));
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{folder, timed_report};

    #[test]
    fn a_result_has_what_every_result_has_and_the_occupancy_of_an_engine() {
        let names = |report: &Report| -> Vec<_> {
            let files = files(report, &Provenance::default());
            assert!(files.iter().all(|(_, bytes)| !bytes.is_empty()));
            files.into_iter().map(|(name, _)| name).collect()
        };
        let mut report = timed_report();
        assert_eq!(names(&report)[..3], folder::ALWAYS);
        assert_eq!(names(&report)[3], "occupancy.csv");
        report.frames.iter_mut().for_each(|frame| frame.times = None);
        report.occupancy.clear();
        assert_eq!(names(&report), folder::ALWAYS);
    }
}
