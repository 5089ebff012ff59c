//! `counters.csv`: one row a frame and counter, zeros written, in the order of frames and then of
//! the data.
//!
//! No totals and no rates: whoever needs them can add, and a file that says a thing once cannot
//! contradict itself.

use crate::config::Unit;
use crate::report::Report;
use std::io::Write;

/// Writes the counters of `report`.
///
/// # Errors
/// Those of `out`.
pub fn write(report: &Report, out: impl Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(["frame", "unit", "block", "counter", "value", "measure"])?;
    let unit = unit_name(report.config.unit);
    for (number, frame) in report.frames.iter().enumerate() {
        let number = number.to_string();
        for declared in report.declarations() {
            csv.write_record([
                &number,
                unit,
                declared.block.name(),
                declared.name,
                &frame.get(declared.counter).to_string(),
                &declared.measure.to_string(),
            ])?;
        }
    }
    csv.flush()
}

/// The unit's name in reports: as in the configuration.
#[must_use]
pub const fn unit_name(unit: Unit) -> &'static str {
    match unit {
        Unit::Hybrid => "hybrid",
        Unit::Triangles => "triangles",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use rtl_model::counter::{Block, Counter, Counters};

    #[test]
    fn every_counter_of_the_units_blocks_is_a_row_in_every_frame() {
        let mut second = Counters::default();
        second.add(Counter::TracePatches, 32);
        let report = Report {
            config: Config::default(),
            blocks: &[Block::Trace, Block::Clip],
            frames: vec![Counters::default(), second],
            host_link_bytes: 0,
        };
        let mut text = Vec::new();
        write(&report, &mut text).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "frame,unit,block,counter,value,measure\n\
             0,hybrid,trace,frames,0,count\n\
             0,hybrid,trace,draws,0,count\n\
             0,hybrid,trace,patches,0,count\n\
             0,hybrid,clip,patches.in,0,count\n\
             0,hybrid,clip,patches.culled,0,count\n\
             1,hybrid,trace,frames,0,count\n\
             1,hybrid,trace,draws,0,count\n\
             1,hybrid,trace,patches,32,count\n\
             1,hybrid,clip,patches.in,0,count\n\
             1,hybrid,clip,patches.culled,0,count\n"
        );
    }

    #[test]
    fn a_unit_is_named_as_in_the_configuration() {
        for unit in [Unit::Hybrid, Unit::Triangles] {
            let printed = serde_json::to_value(unit).unwrap();
            assert_eq!(printed.as_str(), Some(unit_name(unit)));
        }
    }
}
