//! `precision`: a trace and a grid of formats in, what each does to the picture out.

use super::config::Layered;
use super::print;
use super::progress::Steps;
use super::run::{pool, provenance};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use tessim::config::{Config, Overflow, Rounding};
use tessim::error::{Error, Result};
use tessim::output::folder::ResultFolder;
use tessim::output::summary::Provenance;
use tessim::study::precision::{self, Axes, CSV_HEADER, Options, Study, evaluators};
use tessim::study::precision::{overflow_name, rounding_name};
use tessim::trace::command::Command;
use tessim::trace::open::Trace;

/// Measure how many bits a datapath needs: position errors against f64 over a grid of formats
///
/// Runs the trace through unit hybrid or sfarti at every point of the grid, which is the product of
/// the lists below, and prints each format by itself, the Pareto front of bits, area and error, and
/// the narrowest formats within --max-error. A list has commas between its values: N, A..B with
/// both ends, or A..B:S by steps of S. With --out writes precision.csv, config.toml, summary.json
/// and precision.svg; docs/precision.md defines every column.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim precision traces/teapot.jsonl\n  \
                        tessim precision traces/teapot.jsonl --width 12..32 --guard 4,8,12 \
                        --search --evaluators --out result")]
pub(crate) struct Args {
    /// The trace; - for standard input
    trace: PathBuf,
    #[command(flatten)]
    layered: Layered,
    /// Bits of a position, 8..=48; above 40 give --guard, too [default: 12..32:2]
    #[arg(long, value_name = "LIST", value_parser = list)]
    width: Option<List>,
    /// Guard bits of the accumulators, 1..=52 [default: 1,4,8,12,20; none to sweep in sfarti]
    #[arg(long, value_name = "LIST", value_parser = list)]
    guard: Option<List>,
    /// Fraction bits of a level's reciprocal, 8..=32 [default: 12,16,20,32; none in sfarti]
    #[arg(long, value_name = "LIST", value_parser = list)]
    reciprocal: Option<List>,
    /// Fraction bits of a screen coordinate, 0..=12 [default: 4,8]
    #[arg(long, value_name = "LIST", value_parser = list)]
    subpixel: Option<List>,
    /// How port, evaluate and emit round: floor, nearest_up, nearest_even, nearest_away [default:
    /// each as configured]
    #[arg(long, value_name = "MODE,..", value_delimiter = ',', value_parser = rounding)]
    rounding: Vec<Rounding>,
    /// What port and evaluate do with what does not fit: wrap, saturate [default: as configured]
    #[arg(long, value_name = "MODE,..", value_delimiter = ',', value_parser = overflow)]
    overflow: Vec<Overflow>,
    /// The largest position error of formats that serve
    #[arg(long, value_name = "PIXELS", default_value = "0.25px", value_parser = pixels)]
    max_error: f64,
    /// Measure only what it takes to find the narrowest formats
    #[arg(long)]
    search: bool,
    /// Samples of the true surface along each direction of a patch are one more; 0: none
    #[arg(long, value_name = "N", default_value_t = 8)]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=256))]
    samples: u32,
    /// Also compare the evaluators by themselves; with --out writes evaluators.csv and .svg
    #[arg(long)]
    evaluators: bool,
    /// Threads, any number of which give the same bytes [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Write the results into this folder; one that exists is replaced only if precision wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Values of an axis.
#[derive(Clone, Debug)]
struct List(Vec<u32>);

/// Longer lists than any axis has values.
const VALUES_MAX: u32 = 128;

fn list(text: &str) -> Result<List, String> {
    let mut values = Vec::new();
    for part in text.split(',') {
        let wrong = || {
            let part: String = part.chars().take(200).collect();
            format!("found `{part}`, expected N, A..B or A..B:S with A <= B below {VALUES_MAX}")
        };
        let number =
            |text: &str| text.parse::<u32>().ok().filter(|n| *n < VALUES_MAX).ok_or_else(wrong);
        let (range, step) = part.split_once(':').map_or((part, None), |(a, b)| (a, Some(b)));
        let step = step.map_or(Ok(1), number)?;
        let (least, most) = match range.split_once("..") {
            Some((least, most)) => (number(least)?, number(most)?),
            None if part == range => (number(range)?, number(range)?),
            None => return Err(wrong()),
        };
        if least > most || step == 0 {
            return Err(wrong());
        }
        values.extend((least..=most).step_by(step as usize));
    }
    let mut sorted = values.clone();
    sorted.sort_unstable();
    sorted.dedup();
    if sorted.len() < values.len() {
        return Err("found a value twice, expected each once".to_owned());
    }
    Ok(List(sorted))
}

fn rounding(text: &str) -> Result<Rounding, String> {
    named(text, Rounding::ALL, rounding_name)
}

fn overflow(text: &str) -> Result<Overflow, String> {
    named(text, Overflow::ALL, overflow_name)
}

fn named<T: Copy, const N: usize>(
    text: &str,
    all: [T; N],
    name: impl Fn(T) -> &'static str + Copy,
) -> Result<T, String> {
    let known = || all.map(name).join(", ");
    all.into_iter().find(|mode| name(*mode) == text).ok_or_else(|| format!("expected {}", known()))
}

/// A number of pixels, with or without its unit.
fn pixels(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix("px").unwrap_or(text).trim().parse::<f64>();
    let inside = number.ok().filter(|pixels| *pixels > 0.0 && *pixels <= 65536.0);
    inside.ok_or_else(|| "expected a number of pixels above 0, such as 0.25px".to_owned())
}

/// What the folder holds, and what it may hold besides.
const FILES: [&str; 4] = ["precision.csv", "config.toml", "summary.json", "precision.svg"];
const EVALUATORS: [&str; 2] = ["evaluators.csv", "evaluators.svg"];

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    let base = args.layered.configuration()?;
    let options = args.options(&base)?;
    let points = options.axes.grid(&base)?.len();
    let pool = pool(args.threads)?;
    let folder = args.out.as_deref();
    let begin = |out| ResultFolder::of_study_with(out, &FILES, &EVALUATORS, &CSV_HEADER);
    let folder = folder.map(begin).transpose()?;
    let mut reader = Trace::open(&args.trace)?;
    let commands = reader.by_ref().map(|located| Ok(located?.command));
    let commands = commands.collect::<Result<Vec<Command>>>()?;
    // First, for it is the shorter, and may find that there is nothing to compare on.
    let compare = || args.compare(&commands, &base, quiet);
    let compared = args.evaluators.then(|| pool.install(compare)).transpose()?;
    let steps = Steps::new(quiet, "points", points as u64);
    let study = pool.install(|| precision::run(&commands, &base, &options, &|| steps.step()))?;
    drop(steps);
    let header = commands.into_iter().find_map(|command| match command {
        Command::Header(header) => Some(header),
        _ => None,
    });
    let provenance = provenance(header.unwrap_or_default(), &reader)?;
    if let Some(folder) = folder {
        write(&folder, &study, compared.as_deref(), &provenance)?;
        folder.commit()?;
    }
    if quiet {
        return Ok(());
    }
    let mut text = precision::text(&study, &provenance.title);
    if let Some(rows) = &compared {
        text += &format!("\n{}", evaluators::text(rows, args.max_error));
    }
    print::print(&text)
}

fn write(
    folder: &ResultFolder,
    study: &Study,
    compared: Option<&[evaluators::Row]>,
    provenance: &Provenance,
) -> Result<()> {
    folder.write("precision.csv", precision::csv(study).as_bytes())?;
    folder.write("config.toml", study.base.to_commented_toml().as_bytes())?;
    folder.write("summary.json", precision::summary(study, provenance).as_bytes())?;
    folder.write("precision.svg", precision::svg_of_widths(study)?.as_bytes())?;
    if let Some(rows) = compared {
        folder.write("evaluators.csv", evaluators::csv(rows).as_bytes())?;
        folder.write("evaluators.svg", precision::svg_of_evaluators(rows)?.as_bytes())?;
    }
    Ok(())
}

impl Args {
    /// The grid, and how it is looked at.
    fn options(&self, base: &Config) -> Result<Options> {
        let mut axes = Axes::of(base);
        set("--guard", &self.guard, &mut axes.guard, base)?;
        set("--reciprocal", &self.reciprocal, &mut axes.reciprocal, base)?;
        if let Some(List(width)) = &self.width {
            axes.width.clone_from(width);
        }
        if let Some(List(subpixel)) = &self.subpixel {
            axes.subpixel.clone_from(subpixel);
        }
        once("--rounding", &self.rounding, rounding_name)?;
        once("--overflow", &self.overflow, overflow_name)?;
        if !self.rounding.is_empty() {
            axes.rounding = self.rounding.iter().copied().map(Some).collect();
        }
        if !self.overflow.is_empty() {
            axes.overflow.clone_from(&self.overflow);
        }
        Ok(Options { axes, max_error: self.max_error, segments: self.samples, search: self.search })
    }

    fn compare(
        &self,
        commands: &[Command],
        base: &Config,
        quiet: bool,
    ) -> Result<Vec<evaluators::Row>> {
        let options = evaluators::Options::default();
        let steps = Steps::new(quiet, "formats of evaluators", evaluators::count(&options) as u64);
        evaluators::run(commands, base, &options, &|| steps.step())
    }
}

/// Refuses a mode that is given twice: its points would be, too.
fn once<T: Copy + PartialEq>(name: &str, modes: &[T], of: fn(T) -> &'static str) -> Result<()> {
    let twice = (1..modes.len()).find(|&k| modes[..k].contains(&modes[k]));
    twice.map_or(Ok(()), |k| {
        let mode = of(modes[k]);
        Err(Error::Usage(format!("{name}: found {mode} twice, expected each mode once")))
    })
}

/// Sets an axis that only some units have, of which the others have one value.
fn set(name: &str, given: &Option<List>, axis: &mut Vec<u32>, base: &Config) -> Result<()> {
    let Some(List(values)) = given else { return Ok(()) };
    if axis.len() == 1 {
        let unit = base.unit.name();
        return Err(Error::Usage(format!(
            "{name}: found it with unit {unit}, expected it only where the unit and its \
             evaluate.scheme have something of that width"
        )));
    }
    axis.clone_from(values);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_values_ranges_and_steps_in_order() {
        let of = |text: &str| list(text).map(|list| list.0);
        assert_eq!(of("12..15"), Ok(vec![12, 13, 14, 15]));
        assert_eq!(of("20,12..16:2,1"), Ok(vec![1, 12, 14, 16, 20]));
        assert_eq!(of("0"), Ok(vec![0]));
        for wrong in ["", "4..2", "4..", "a", "1,,2", "4:2", "1..9:0", "1..200", "-1", "3,1..4"] {
            let message = of(wrong).unwrap_err();
            assert!(message.contains("expected"), "{wrong}: {message}");
        }
    }

    #[test]
    fn pixels_may_bear_their_unit() {
        assert_eq!(pixels("0.25px"), Ok(0.25));
        assert_eq!(pixels("2"), Ok(2.0));
        for wrong in ["0", "-1px", "nan", "inf", "px", "1cm"] {
            assert!(pixels(wrong).is_err(), "{wrong}");
        }
    }
}
