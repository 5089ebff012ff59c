//! `occupancy.csv`: for each FIFO of the timed chain, how many cycles of the run began with how
//! many tokens in it. A row for every number of entries; the rows of a FIFO add up to the elapsed
//! cycles.
//!
//! A FIFO that is seldom more than half full is too deep; one that is mostly full stands before
//! what binds the run.

use crate::report::Report;
use std::io::Write;

/// Writes the occupancy of the FIFOs, each named by the block that it stands before.
///
/// # Errors
/// Those of `out`.
pub fn write(report: &Report, out: impl Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(["block", "entries", "cycles"])?;
    for (stage, occupancy) in report.chain.iter().zip(&report.occupancy) {
        for (entries, cycles) in occupancy.iter().enumerate() {
            let (entries, cycles) = (entries.to_string(), cycles.to_string());
            csv.write_record([stage.block.name(), &entries, &cycles])?;
        }
    }
    csv.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::timed_report;

    #[test]
    fn each_fifo_has_a_row_an_entry_and_the_first_block_has_none() {
        let report = timed_report();
        report.check();
        let mut text = Vec::new();
        write(&report, &mut text).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "block,entries,cycles\n\
             stitch,0,50\n\
             stitch,1,0\n\
             stitch,2,150\n\
             vertex_shader,0,190\n\
             vertex_shader,1,10\n"
        );
    }
}
