//! `convert`: a trace in either form in, the same trace in the other, or in the same, out.

use super::print;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tessim::error::{Error, Result};
use tessim::trace::command::Command;
use tessim::trace::open::{Trace, folder};
use tessim::trace::points::{PointFile, PointSource};
use tessim::trace::{binary, write};

/// Convert a trace between its text and its binary form, losing nothing
///
/// The input's form is told from its content, the output's from its name: .jsonl is text, .tsb is
/// binary.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim convert traces/teapot.jsonl teapot.tsb\n  \
                        tessim convert teapot.tsb - --to text | head -1")]
pub(crate) struct Args {
    /// The trace; - for standard input
    input: PathBuf,
    /// The trace to write, which appears when it is complete; - for standard output
    output: PathBuf,
    /// The form to write, whatever the output is called
    #[arg(long, value_name = "FORM", value_enum)]
    to: Option<Form>,
    /// Put points that are in files of their own into the trace
    #[arg(long)]
    inline: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Form {
    /// JSON Lines
    Text,
    /// Checksummed, compressed blocks
    Binary,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let form = args.form()?;
    let stdout = args.output == Path::new("-");
    if form == Form::Binary && stdout && io::stdout().is_terminal() {
        let message = "a binary trace is not for a terminal: name a file or pipe it on";
        return Err(Error::Usage(message.into()));
    }
    let trace = Trace::open(&args.input)?;
    // What is wrong with the input is no failure of the output: it is kept for afterwards.
    let mut outcome = Ok(());
    let written = print::bytes_to_file_or_stdout(&args.output, |out| {
        outcome = args.convert(trace, form, out);
        if outcome.is_ok() { Ok(()) } else { Err(io::Error::other("the conversion failed")) }
    });
    // A reader that leaves early is told from standard output's own error.
    match outcome {
        Err(Error::System { path, source }) if path == args.output && stdout => {
            Err(print::error(source))
        }
        outcome => outcome.and(written),
    }
}

impl Args {
    fn form(&self) -> Result<Form> {
        let extension = self.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match (self.to, extension) {
            (Some(form), _) => Ok(form),
            (None, "jsonl") => Ok(Form::Text),
            (None, "tsb") => Ok(Form::Binary),
            (None, _) => Err(Error::Usage(format!(
                "{}: found neither .jsonl (text) nor .tsb (binary): give --to text or --to binary",
                self.output.display()
            ))),
        }
    }

    fn convert(&self, trace: Trace, form: Form, out: &mut dyn Write) -> Result<()> {
        match form {
            Form::Text => {
                let mut writer = write::Writer::new(out);
                self.commands(trace, |command| writer.write(command))
            }
            Form::Binary => {
                let writer = binary::write::Writer::new(out);
                let mut writer = writer.map_err(|error| Error::system(&self.output, error))?;
                self.commands(trace, |command| writer.write(command))
            }
        }
    }

    /// Hands every command to `write`.
    fn commands(
        &self,
        trace: Trace,
        mut write: impl FnMut(&Command) -> io::Result<()>,
    ) -> Result<()> {
        for located in trace {
            let mut command = located?.command;
            if let Command::Points(points) = &mut command
                && let Some(file) = points.source.file()
            {
                if self.inline {
                    points.source = Arc::new(inlined(&points.source)?);
                } else {
                    self.keeps(file)?;
                }
            }
            write(&command).map_err(|error| self.failed(error))?;
        }
        Ok(())
    }

    /// Makes sure that the output names the same file of points as the input does.
    fn keeps(&self, file: &PointFile) -> Result<()> {
        let [from, to] = [&self.input, &self.output].map(|path| folder(path).canonicalize());
        if from.is_ok() && from.ok() == to.ok() {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "{}: the trace has points in the file {:?} of its folder {}: write it into that \
             folder, or give --inline to put them into the trace",
            self.output.display(),
            file.data().name,
            folder(&self.input).display()
        )))
    }

    /// A writer's error: a command that the form cannot hold is no failure of the system.
    fn failed(&self, error: io::Error) -> Error {
        match error.kind() {
            ErrorKind::InvalidInput => Error::Usage(format!("{}: {error}", self.output.display())),
            _ => Error::system(&self.output, error),
        }
    }
}

/// The points of a file, in memory.
fn inlined(source: &PointSource) -> Result<PointSource> {
    let bytes = source.len().saturating_mul(4 * u64::from(source.components()));
    if bytes > binary::CONTENT_BYTES_MAX as u64 {
        let most = binary::CONTENT_BYTES_MAX;
        return Err(Error::Usage(format!(
            "--inline: found {bytes} bytes of points under an id, expected at most {most}"
        )));
    }
    let mut points = Vec::new();
    let count = usize::try_from(source.len()).expect("they fit a block");
    source.read(0, count, &mut points)?;
    Ok(match source.components() {
        3 => PointSource::Xyz(points.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()),
        _ => PointSource::Xyzw(points),
    })
}
