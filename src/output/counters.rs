//! `counters.csv`: one row a frame and counter, zeros written, in the order of frames and then of
//! the data.
//!
//! No totals and no rates: whoever needs them can add, and a file that says a thing once cannot
//! contradict itself.

use crate::report::Report;
use std::io::Write;

/// Writes the counters of `report`.
///
/// # Errors
/// Those of `out`.
pub fn write(report: &Report, out: impl Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(["frame", "unit", "block", "counter", "value", "measure"])?;
    let unit = report.config.unit.name();
    for (number, frame) in report.frames.iter().enumerate() {
        let number = number.to_string();
        for row in report.rows(frame) {
            csv.write_record([
                &number,
                unit,
                row.block.name(),
                &row.name,
                &row.value.to_string(),
                &row.measure.to_string(),
            ])?;
        }
    }
    csv.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::output::timed_report;
    use crate::report::Frame;
    use rtl_model::counter::{Block, Counter, Counters};

    fn csv(report: &Report) -> String {
        let mut text = Vec::new();
        write(report, &mut text).unwrap();
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn every_counter_of_the_units_blocks_is_a_row_in_every_frame() {
        let mut second = Counters::default();
        second.add(Counter::TracePatches, 32);
        let frame = |counters| Frame { counters, ..Frame::default() };
        let report = Report {
            config: Config::default(),
            blocks: &[Block::Trace, Block::Clip],
            chain: Vec::new(),
            frames: vec![frame(Counters::default()), frame(second)],
            occupancy: Vec::new(),
            host_link_bytes: 0,
        };
        assert_eq!(
            csv(&report),
            "frame,unit,block,counter,value,measure\n\
             0,hybrid,trace,frames,0,count\n\
             0,hybrid,trace,draws,0,count\n\
             0,hybrid,trace,patches,0,count\n\
             0,hybrid,clip,patches.in,0,count\n\
             0,hybrid,clip,patches.culled,0,count\n\
             0,hybrid,clip,patches.culled.measured,0,count\n\
             1,hybrid,trace,frames,0,count\n\
             1,hybrid,trace,draws,0,count\n\
             1,hybrid,trace,patches,32,count\n\
             1,hybrid,clip,patches.in,0,count\n\
             1,hybrid,clip,patches.culled,0,count\n\
             1,hybrid,clip,patches.culled.measured,0,count\n"
        );
    }

    #[test]
    fn a_block_of_the_chain_has_its_standard_rows_after_its_own() {
        let rows = csv(&timed_report());
        let of = |start: &str| -> Vec<String> {
            let rows = rows.lines().filter_map(|row| row.strip_prefix(start));
            rows.map(str::to_owned).collect()
        };
        assert_eq!(
            of("1,hybrid,stitch,"),
            [
                "triangles,0,count",
                "triangles.degenerate,0,count",
                "tokens.in,1,count",
                "tokens.out,4,count",
                "ops.add,4,count",
                "ops.add.bits,32,bits",
                "ops.mul,2,count",
                "ops.mul.bits,30,bits",
                "ops.compare,1,count",
                "ops.compare.bits,8,bits",
                "fifo.peak,1,entries",
                "cycles.busy,95,cycles",
                "cycles.starved,4,cycles",
                "cycles.starved.by.link,4,cycles",
                "cycles.blocked,1,cycles",
                "cycles.blocked.by.vertex_shader,1,cycles",
                "cycles.total,100,cycles",
                "cycles.used,94,cycles",
            ]
        );
        assert!(rows.ends_with("1,hybrid,unit,cycles.total,100,cycles\n"));
        assert_eq!(
            of("0,hybrid,vertex_shader,cycles.blocked"),
            [",60,cycles", ".by.order,60,cycles"]
        );
        assert_eq!(of("0,hybrid,vertex_shader,cycles.starved.by.memory_port"), [",15,cycles"]);
        assert!(of("0,hybrid,link,ops").is_empty() && of("0,hybrid,link,fifo").is_empty());
    }

    #[test]
    fn without_an_engine_exactly_the_rows_of_time_are_missing() {
        let timed = timed_report();
        let mut untimed = timed.clone();
        untimed.frames.iter_mut().for_each(|frame| frame.times = None);
        untimed.occupancy.clear();
        untimed.check();
        let of_time = |row: &&str| row.contains(",cycles.") || row.contains(",fifo.peak,");
        let timed = csv(&timed);
        let rest: Vec<_> = timed.lines().filter(|row| !of_time(row)).collect();
        assert!(rest.len() + 2 * 10 < timed.lines().count());
        assert_eq!(csv(&untimed).lines().collect::<Vec<_>>(), rest);
    }
}
