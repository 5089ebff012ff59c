//! `check`: a trace through both implementations, and a table of what was compared.

use super::config::Layered;
use super::print;
use super::progress::Progress;
use super::run::pool;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::fmt::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use tessim::config::{Config, Engine};
use tessim::error::{Error, Result};
use tessim::gpu::{Backend, Device, Sources};
use tessim::output::table::grouped;
use tessim::study::check::{self, Checked, Difference, Row};
use tessim::trace::replay::Replay;

/// Compare a unit with its second implementation, which runs on a GPU
///
/// Each block and the whole unit run again as compute kernels, from the control points behind the
/// port on; vertices, triangles, screen positions and counters must be equal to the bit. Prints how
/// many values were compared, and the first that differ. A software adapter is enough.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim check traces/teapot.jsonl\n  \
                        tessim check traces/strip.jsonl --unit sfarti --backend gl --set \
                        position.width=44")]
pub(crate) struct Args {
    /// The trace; - for standard input
    trace: PathBuf,
    #[command(flatten)]
    layered: Layered,
    /// The interface to the GPU: auto takes vulkan, else gl
    #[arg(long, value_name = "B", value_parser = backends(), default_value = "auto")]
    backend: Backend,
    /// Threads of the first implementation [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
}

fn backends() -> impl TypedValueParser<Value = Backend> {
    PossibleValuesParser::new(Backend::ALL.map(Backend::name)).map(|name| {
        let found = Backend::ALL.into_iter().find(|backend| backend.name() == name);
        found.expect("only names of backends are possible values")
    })
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    let config = Config { engine: Engine::None, ..args.layered.configuration()? };
    let pool = pool(args.threads)?;
    let mut trace = Replay::open(&args.trace)?;
    let device = Device::open(args.backend, Sources::default())?;
    let mut progress = Progress::new(quiet, "");
    let watch = |command: &_| progress.command(command);
    let checked = pool.install(|| check::run(&mut trace, &config, &device, watch))?;
    drop(progress);
    let [values, different] = checked.ledger.totals();
    if !quiet {
        print::print(&text(&checked, &config, &device))?;
    }
    match different {
        0 if values > 0 => Ok(()),
        0 => Err(Error::Check(format!("{}: nothing to compare", args.trace.display()))),
        _ => Err(Error::Check(format!(
            "{}: {different} of {values} values differ",
            args.trace.display()
        ))),
    }
}

fn text(checked: &Checked, config: &Config, device: &Device) -> String {
    let Checked { header, ledger, frames, patches, gpu, rest } = checked;
    let mut out = String::new();
    let mut line = |text: String| writeln!(out, "{text}").expect("a String takes everything");
    line(format!(
        "{}: unit {}, {} bits, {frames} frame{}, {patches} patches, on {}",
        header.title,
        config.unit.name(),
        config.position.width,
        if *frames == 1 { "" } else { "s" },
        device.name()
    ));
    let numbers =
        |values: u64, different: u64| format!("{:>15} {:>10}", grouped(values), grouped(different));
    line(format!("  {:<10} {:<24} {:>14} {:>10}", "block", "of which", "values", "different"));
    for Row { block, what, values, different, .. } in ledger.rows() {
        line(format!("  {block:<10} {what:<23} {}", numbers(*values, *different)));
    }
    let [values, different] = ledger.totals();
    line(format!("  {:<34} {}", "in all", numbers(values, different)));
    line(format!(
        "  time: kernels {:.1} s, units and comparison {:.1} s",
        gpu.as_secs_f64(),
        rest.as_secs_f64()
    ));
    for row in ledger.rows() {
        for Difference { place, inputs, cpu, gpu } in &row.first {
            line(format!("{} {}: {place}", row.block, row.what));
            line(format!("  first  {}", words(cpu)));
            line(format!("  second {}", words(gpu)));
            line(format!("  of     {inputs}"));
        }
    }
    out
}

/// Words as unsigned numbers and in hexadecimal.
fn words(words: &[u32]) -> String {
    words.iter().map(|w| format!("{w} ({w:#x})")).collect::<Vec<_>>().join(" ")
}
