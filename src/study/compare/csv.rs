//! The CSVs of a comparison.

use super::Run;
use super::series::{Series, Value, series};
use std::fmt::Write;

/// The columns of `compare.csv`. `value` is over the whole run, `first` the first unit's value of
/// the same counter; `min`, `median` and `max` are over the frames. Empty is what there is not.
pub const CSV_HEADER: [&str; 9] =
    ["unit", "block", "counter", "value", "measure", "first", "min", "median", "max"];

/// The columns of `frames.csv`.
pub const FRAMES_HEADER: [&str; 6] = ["unit", "frame", "block", "counter", "value", "measure"];

/// `compare.csv`: every number of every unit, in the order of the units and then of the data.
#[must_use]
pub fn csv(runs: &[Run]) -> String {
    let mut text = CSV_HEADER.join(",") + "\n";
    let all: Vec<Vec<Series>> = runs.iter().map(series).collect();
    for (run, own) in runs.iter().zip(&all) {
        let unit = run.report.config.unit.name();
        for line in own {
            let whole = &line.whole;
            let same = |other: &&Series| {
                (other.whole.block, &other.whole.name) == (whole.block, &whole.name)
            };
            let first = all[0].iter().find(same).and_then(|first| first.whole.value);
            let spread = line.spread().map_or([None; 3], |spread| spread.map(Some));
            let (block, name, measure) = (whole.block, &whole.name, whole.measure);
            let [value, first] = [whole.value, first].map(cell);
            let [least, median, most] = spread.map(cell);
            let line = format!("{unit},{block},{name},{value},{measure},{first}");
            writeln!(text, "{line},{least},{median},{most}").expect("a String takes everything");
        }
    }
    text
}

/// `frames.csv`: the same numbers of each frame.
#[must_use]
pub fn frames(runs: &[Run]) -> String {
    let mut text = FRAMES_HEADER.join(",") + "\n";
    for run in runs {
        let all = series(run);
        let unit = run.report.config.unit.name();
        for frame in 0..run.seen.len() {
            for Series { whole, frames } in &all {
                let (block, name, measure) = (whole.block, &whole.name, whole.measure);
                let value = cell(frames[frame]);
                writeln!(text, "{unit},{frame},{block},{name},{value},{measure}")
                    .expect("a String takes everything");
            }
        }
    }
    text
}

fn cell(value: Option<Value>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::super::tests::pair;
    use super::*;

    #[test]
    fn every_row_of_every_unit_is_in_the_csv_beside_the_first_units() {
        let runs = pair();
        let text = csv(&runs);
        let rows: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(rows.len(), series(&runs[0]).len() + series(&runs[1]).len());
        for row in [
            "hybrid,link,bytes.total,1000,bytes,1000,0,0,1000",
            "triangles,link,bytes.total,3000,bytes,1000,0,0,3000",
            "hybrid,evaluate,invocations,9,count,9,0,0,9",
            "triangles,unit,cycles.total,200,cycles,200,100,100,100",
            "hybrid,unit,time,0.000100,ms,0.000100,0.000050,0.000050,0.000050",
            "hybrid,error,mean,,pixels,,,,",
        ] {
            assert!(rows.contains(&row), "{row}: {text}");
        }
        let backwards = csv(&[runs[1].clone(), runs[0].clone()]);
        assert!(
            backwards.contains("\nhybrid,evaluate,invocations,9,count,,0,0,9\n"),
            "{backwards}"
        );
    }

    #[test]
    fn frames_stand_one_after_another() {
        let runs = pair();
        let text = frames(&runs);
        let lines = 2 * (series(&runs[0]).len() + series(&runs[1]).len());
        assert_eq!(text.lines().count(), 1 + lines);
        assert!(text.contains("\nhybrid,0,link,bytes.total,1000,bytes\n"), "{text}");
        assert!(text.contains("\nhybrid,1,link,bytes.total,0,bytes\n"), "{text}");
    }
}
