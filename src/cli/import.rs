//! `import`: a model in another program's format in, a trace out.

use super::print;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use tessim::error::{Error, Result};
use tessim::trace::import::import_bpt;

/// Turn a BPT model (bicubic Bézier patches as text) into a trace
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim import model.bpt model.jsonl\n  \
                        tessim import model.bpt - | tessim run -")]
pub(crate) struct Args {
    /// The model; - for standard input
    input: PathBuf,
    /// The trace, which appears when it is complete; - for standard output
    output: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let input: Box<dyn BufRead> = if args.input == Path::new("-") {
        Box::new(io::stdin().lock())
    } else {
        let file = File::open(&args.input).map_err(|error| Error::system(&args.input, error))?;
        Box::new(BufReader::new(file))
    };
    let name = args.input.display().to_string();
    // What is wrong with the input is no failure of the output: it is kept for afterwards.
    let mut outcome = Ok(());
    let written = print::to_file_or_stdout(Some(&args.output), |out| {
        outcome = import_bpt(input, &name, out);
        if outcome.is_ok() { Ok(()) } else { Err(io::Error::other("the import failed")) }
    });
    outcome.and(written)
}
