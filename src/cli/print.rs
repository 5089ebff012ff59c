//! Standard output: written in one place, so that every command fails and ends the same way.

use std::io::{self, ErrorKind, StdoutLock, Write};
use std::path::Path;
use tessim::error::{Error, Result};
use tessim::output::file::AtomicFile;

const STDOUT: &str = "standard output";

/// Prints `text`, its colours only on a terminal that wants them (`NO_COLOR`).
pub(crate) fn print(text: &str) -> Result<()> {
    with(|out| out.write_all(text.as_bytes()))
}

/// Writes a text to the file at `path`, which appears when it is complete, or to standard output
/// for none and for `-`.
pub(crate) fn to_file_or_stdout(
    path: Option<&Path>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let Some(path) = path.filter(|path| *path != Path::new("-")) else { return with(write) };
    let mut file = AtomicFile::create(path)?;
    write(&mut file).map_err(|error| Error::system(path, error))?;
    file.commit()
}

/// Writes bytes, which nobody takes for text with colours, to the file at `path`, which appears
/// when it is complete, or to standard output for `-`.
pub(crate) fn bytes_to_file_or_stdout(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    if path != Path::new("-") {
        return to_file_or_stdout(Some(path), write);
    }
    let mut out = io::BufWriter::new(io::stdout().lock());
    write(&mut out).and_then(|()| out.flush()).map_err(error)
}

/// Writes to standard output through a buffer.
pub(crate) fn with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = io::BufWriter::new(stdout());
    write(&mut out).and_then(|()| out.flush()).map_err(error)
}

/// Standard output without a buffer of its own.
pub(crate) fn stdout() -> anstream::AutoStream<StdoutLock<'static>> {
    anstream::AutoStream::auto(io::stdout().lock())
}

/// What went wrong with standard output.
pub(crate) fn error(source: io::Error) -> Error {
    Error::system(STDOUT, source)
}

/// Whether standard output's reader has left: no failure of ours.
pub(crate) fn is_closed(error: &Error) -> bool {
    matches!(error, Error::System { path, source }
        if path == Path::new(STDOUT) && source.kind() == ErrorKind::BrokenPipe)
}
